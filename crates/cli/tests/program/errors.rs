//! Error messages: printed once, on standard error, with the right exit status, and without files
//! left behind.

use crate::harness::{Folder, Run};
use std::fs;

/// Asserts that each command fails with status 2 and leaves no files behind.
fn refused(lines: &[&str]) {
    let folder = Folder::new();
    for line in lines {
        let message = folder.bad(line, 2);
        assert!(!message.trim().is_empty(), "{line}");
        assert_eq!(folder.files(), [""; 0], "{line}");
    }
}

#[test]
fn invalid_tone_flags_are_rejected() {
    let folder = Folder::new();
    for line in [
        "render ball.json --white-balance warm",
        "render ball.json --primaries adobe",
        "render ball.json --primaries acescg",
        "render ball.json --primaries rec2020 -o a.jpg",
        "render ball.json --primaries rec2020 --noise 0.5 -o a.webp",
        "render ball.json --primaries display_p3 --look ham",
        "render ball.json --primaries display_p3 -o a.apng",
        "render ball.json --dither maybe",
    ] {
        let message = folder.bad(line, 2);
        let flag = line.split(' ').find(|word| word.starts_with("--")).unwrap();
        assert!(message.contains(flag.trim_start_matches('-')), "{line}: {message}");
        assert_eq!(folder.files(), [""; 0], "{line}");
    }
}

#[test]
fn invalid_command_lines_are_rejected() {
    refused(&[
        "",
        "rendr",
        "render",
        "render ball.json --no-such-flag",
        "render ball.json --size 5",
        "render ball.json --size 0x5",
        "render ball.json --samples 0",
        "render ball.json --samples -1",
        "render ball.json --threads 0",
        "render ball.json --crop 1,2,3",
        "render ball.json --crop 10,0,10,1",
        "render ball.json --frames 3..3",
        "render ball.json --frames 4..",
        "render ball.json --frames 0..4294967295",
        "render ball.json --time 1e20",
        "render ball.json --time -1",
        "render ball.json --frame 1 --at 2",
        "render ball.json --max-memory lots",
        "render ball.json --integrator clasic",
        "render ball.json --integrator normals --max-depth 3",
        "render ball.json --camera mian",
        "compare ball.json",
        "bench nothing",
    ]);
}

#[test]
fn invalid_colors_and_files_are_rejected() {
    refused(&[
        "render ball.json --tone sepia",
        "render ball.json --bits 12",
        "render ball.json --quality 90",
        "render ball.json -o a.tga",
        "render ball.json -o a",
        "render ball.json --output=",
        "render ball.json -o - --stats -",
        "render ball.json -o - --frames 0..2",
        "render ball.json -o a.webp --size 20000x1",
    ]);
}

#[test]
fn invalid_ray_benchmarks_are_rejected() {
    let folder = Folder::new();
    for line in ["blob:0", "blob:3 --kind primery", "blob:3 --kernel packet,none", "blob:3 --quality good"] {
        folder.bad(&format!("bench rays {line}"), 2);
    }
    for line in ["blob:3 --rays 1", "blob:3 --repeats 0", ".", "ball.json"] {
        assert!(!folder.bad(&format!("bench rays {line}"), 2).trim().is_empty(), "{line}");
    }
    let message = folder.bad("bench rays blbo", 2);
    assert_eq!(message, "error: unknown mesh `blbo`: neither a file nor a built-in mesh; did you mean `blob`?\n");
    assert!(folder.bad("bench rays blbo:7", 2).contains("did you mean `blob`?"));
    assert_eq!(folder.bad("bench rays none.ply", 3), "error: file not found: `none.ply`\n");
    assert!(folder.bad("bench rays blob:3 --kind primery", 2).contains("'primary'"));
}

#[test]
fn misspelled_scenes_get_suggestions() {
    let folder = Folder::new();
    let message = folder.bad("render jugler", 2);
    assert_eq!(
        message.trim(),
        "error: unknown scene `jugler`: neither a file nor a built-in scene; did you mean `juggler`?"
    );
    let empty = Run::of(folder.command("render").arg("").args(["-o", "a.png"]).output().unwrap());
    assert_eq!((empty.status, empty.stderr.trim()), (2, "error: the name of the scene is empty"));
    assert!(folder.bad("render bal.json", 3).contains("did you mean `ball.json`?"));
    assert!(folder.bad("render none/bal.json", 3).contains("`none/bal.json`"));
    assert!(folder.bad("render ball.json --integrator clasic", 2).contains("did you mean `classic`?"));
    assert!(folder.bad("render ball.json --camera mian", 2).contains("did you mean `main`?"));
    assert!(folder.bad("render ball.json --smaples 3", 2).contains("--samples"));
}

#[test]
fn unwritable_and_unreadable_files_are_reported() {
    let folder = Folder::new();
    fs::create_dir(folder.path("folder.png")).unwrap();
    fs::write(folder.path("junk.png"), "no picture").unwrap();
    let message = folder.bad("render ball.json -o none/there.png", 3);
    assert_eq!(message, "error: cannot write `none/there.png`: there is no folder `none`\n");
    folder.bad("render ball.json -o folder.png", 3);
    folder.bad("render ball.json -q -o a.png --stats none/there.json", 3);
    folder.bad("compare junk.png junk.png", 3);
    folder.bad("compare none.png none.png", 3);
    folder.bad("convert ball.json none/there.json", 3);
    folder.bad("render folder.png", 2);
    assert_eq!(folder.files(), ["a.png", "folder.png", "junk.png"]);
}

#[cfg(target_os = "linux")]
#[test]
fn full_disks_are_failures_of_the_system() {
    let folder = Folder::new();
    for format in ["png", "jpg", "exr", "hdr", "webp", "pfm"] {
        let message = folder.bad(&format!("render ball.json -q -o /dev/full --format {format}"), 3);
        assert_eq!(message, "error: cannot write `/dev/full`: no space left on the device\n", "{format}");
        let mut command = folder.command(&format!("render ball.json -q -o - --format {format}"));
        let full = fs::File::options().write(true).open("/dev/full").unwrap();
        assert_eq!(command.stdout(full).output().unwrap().status.code(), Some(3), "{format}");
    }
    folder.bad("render ball.json -q --stats /dev/full", 3);
    folder.bad("convert ball.json /dev/full", 3);
    folder.good("convert ball.json /dev/null");
    for line in ["scenes", "schema", "info ball.json", "render ball.json"] {
        let full = fs::File::options().write(true).open("/dev/full").unwrap();
        assert_eq!(folder.command(line).stdout(full).output().unwrap().status.code(), Some(3), "{line}");
    }
}

#[test]
fn scene_errors_are_reported_with_file_and_line() {
    let folder = Folder::new();
    fs::write(folder.path("bad.json"), "{\"version\": 1,\n \"objects\": [{\"shape\": {\"spere\": {}}}]}").unwrap();
    for (command, status) in [("render", 2), ("info", 2), ("check", 1)] {
        let message = folder.bad(&format!("{command} bad.json"), status);
        assert!(message.contains("bad.json:2:") && message.contains("sphere"), "{command}: {message}");
        assert_eq!(message.matches("spere").count(), message.lines().filter(|line| line.contains("spere")).count());
    }
    fs::write(folder.path("cut.json"), "{\"version\": 1, \"obj").unwrap();
    folder.bad("render cut.json", 2);
    fs::write(folder.path("binary.json"), [0xff, 0xfe, 0, 1]).unwrap();
    folder.bad("render binary.json", 2);
    for wrong in ["cut.json", "binary.json"] {
        folder.bad(&format!("check {wrong}"), 1);
    }
    assert_eq!(folder.files(), ["bad.json", "binary.json", "cut.json"]);
}

#[test]
fn too_little_memory_is_reported_before_rendering() {
    let folder = Folder::new();
    let message = folder.bad("render ball.json --size 20000x20000 -o a.jpg --max-memory 512M", 2);
    assert!(message.contains("512.0 MiB") && message.contains("GiB") && message.contains("JPEG"), "{message}");
    assert_eq!(folder.files(), [""; 0]);
    folder.good("render ball.json -q --max-memory 4G --threads 1");
}

#[test]
fn flags_that_cannot_act_are_refused_and_settings_warned_of() {
    let folder = Folder::new();
    for line in [
        "render ball.json --tone agx -o a.exr",
        "render ball.json --exposure 1 -o a.hdr",
        "render ball.json --white-balance 3200 -o a.pfm",
        "render ball.json --dither on --look ham",
        "render ball.json --integrator normals --max-depth 3",
        "render ball.json --denoise --samples 1",
        "probe ball.json --integrator normals --max-depth 3 1,1",
    ] {
        let message = folder.bad(line, 2);
        let flag = line.split(' ').rfind(|word| word.starts_with("--") && message.contains(word));
        assert!(flag.is_some() && !message.contains("panicked"), "{line}: {message}");
        assert_eq!(folder.files(), [""; 0], "{line}");
    }
    folder.bad("probe ball.json --fireflies --tree-depth 3", 2);
    folder.good("render cornell-box --max-depth 4 --size 8x8 --samples 1 -q -o box.png");
    let scene = fs::read_to_string(folder.path("ball.json")).unwrap();
    fs::write(folder.path("toned.json"), scene.replacen('{', r#"{"tone": {"exposure_stops": 1},"#, 1)).unwrap();
    let warning = "warning: `tone.exposure_stops` has no effect: OpenEXR files store linear radiance\n";
    let run = folder.run("render toned.json -o toned.exr");
    assert_eq!((run.status, run.stderr.as_str()), (0, warning));
    folder.good("render toned.json -q -o toned.exr");
    folder.good("render toned.json -o toned.png");
    folder.good("render toned.json -q -o toned.jfilm");
    assert_eq!(folder.run("merge toned.jfilm -o toned.exr").stderr, warning);
    assert!(folder.bad("merge toned.jfilm -o other.jfilm --aov-output a.exr", 2).contains("--aov-output"));
}

#[test]
fn errors_suggest_a_remedy() {
    let folder = Folder::new();
    for (line, said) in [
        ("render ball.json -o a.webm", ".mp4"),
        ("render ball.json -o a.ppm", "movies .apng"),
        ("render ball.json -o a.tif", "reads TIFF pictures but does not write them; use .png"),
        ("render ball.json --format avi", "movies apng"),
        ("render ball.json --size 65536x65536 -o a.png", "for '--size <WxH>': these are"),
        ("render ball.json --samples -4", "'-4'"),
        ("render ball.json --width 40", "--size WxH"),
        ("render ball.json -s 4", "--samples N"),
    ] {
        let message = folder.bad(line, 2);
        assert!(message.contains(said), "{line}: {message}");
    }
    let run = folder.run("render ball.json --frame 40 -o a.png");
    assert_eq!(run.stderr, "warning: frame 40 is beyond the end of the animation, which has 4 frames, 0 to 3\n");
    folder.good("render ball.json --frames 0..2 -q -o f_%04d.png");
    folder.good("render ball.json --frame 2 -q -o f_%04d.png");
    folder.good("render ball.json --aov Z,cryptomatte,beauty -q -o b.exr");
    assert_eq!(folder.files(), ["a.png", "b.exr", "f_0000.png", "f_0001.png", "f_0002.png"]);
    folder.good("render ball.json -q -o c.png --checkpoint c.jfilm");
    let message = folder.bad("render juggler --size 16x9 -o c.png --checkpoint c.jfilm", 2);
    assert!(
        message.contains("of the scene `ball.json`, not `juggler`") && message.contains("--checkpoint"),
        "{message}"
    );
    let is_hash = |word: &str| word.len() >= 32 && word.bytes().all(|byte| byte.is_ascii_hexdigit());
    assert!(!message.split_whitespace().any(is_hash), "{message}");
    for line in ["render ball.json --checkpoint no/folder/a.jfilm", "render ball.json --samples 9 -o no/folder/a.jfilm"]
    {
        assert!(folder.bad(line, 3).contains("there is no folder `no`"), "{line}");
    }
}

#[test]
fn long_names_are_shortened_and_terminals_obey_nothing() {
    let folder = Folder::new();
    let long = "y".repeat(20_000);
    let message = folder.bad(&format!("render {long}"), 2);
    assert!(message.contains("unknown scene `yyy") && message.contains('…'), "{message}");
    let message = folder.bad(&format!("render ball.json --size {long}"), 2);
    assert!(message.contains("--size") && message.contains('…') && message.len() < 10_000, "{message}");
    let message = folder.bad("render \u{1b}[31m\u{202e}", 2);
    assert!(message.contains("`\u{fffd}[31m\u{fffd}`"), "{message}");
    let scene = r#"{"version": 1, "title": "\u001b[31mred", "objects": [{"shape": "sphere"}]}"#;
    fs::write(folder.path("red.json"), scene).unwrap();
    assert!(folder.run("info red.json").stdout.starts_with("\u{fffd}[31mred\n"));
}
