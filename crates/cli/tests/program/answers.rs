//! Commands that print answers: help, lists, checks and comparisons.

use crate::harness::{Folder, Run, SCENE};
use std::fs;
use std::io::{Read, Write};
use std::process::{Command, Stdio};

/// Beginning of a scene with an animated background.
const MOVING: &str = r##""version": 1,
    "background": {"animate": {"keys": [[0, "#203040"], [2, "#ffffff"]], "repeat": "loop"}},"##;

#[test]
fn help_tells_everything() {
    let folder = Folder::new();
    let help = folder.good("--help").stdout;
    let commands = ["render", "check", "info", "schema", "convert", "probe", "compare", "scenes", "bench"];
    for command in commands {
        assert!(help.contains(command), "{command}");
        let own = folder.good(&format!("{command} --help")).stdout;
        assert!(own.contains("Usage: juggler") && !own.contains('\x1b'), "{own}");
    }
    let render = folder.good("render --help").stdout;
    for flag in [
        "--output",
        "--size",
        "--samples",
        "--integrator",
        "--camera",
        "--frame",
        "--frames",
        "--at",
        "--crop",
        "--seed",
        "--threads",
        "--max-depth",
        "--max-memory",
        "--tone",
        "--exposure",
        "--bits",
        "--quality",
        "--stats",
        "--progress",
        "--quiet",
        "--format",
    ] {
        assert!(render.contains(flag), "{flag}");
    }
    assert!(folder.good("--version").stdout.starts_with("juggler "));
}

#[test]
fn short_help_fits_a_screen() {
    let folder = Folder::new();
    let lines = |line: &str| folder.good(line).stdout.lines().count();
    assert!((24..=40).contains(&lines("render -h")), "{}", folder.good("render -h").stdout);
    assert!(lines("render --help") > 100);
    for command in
        ["", "check", "info", "merge", "relight", "convert", "probe", "compare", "bench", "man", "completions"]
    {
        assert!(lines(&format!("{command} -h")) <= 40, "{command}");
    }
}

#[test]
fn shells_and_manuals_know_all_flags() {
    let folder = Folder::new();
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = folder.good(&format!("completions {shell}")).stdout;
        assert!(["render", "white-balance", "merge"].iter().all(|word| script.contains(word)), "{shell}");
    }
    folder.bad("completions csh", 2);
    assert!(folder.good("man").stdout.contains("juggler\\-render"));
    let page = folder.good("man render").stdout;
    assert!(page.contains(".TH") && page.contains("white\\-balance") && page.contains("SLURM_ARRAY_TASK_ID"), "{page}");
    assert!(folder.bad("man rendr", 2).contains("did you mean `render`?"));
    fs::create_dir(folder.path("man1")).unwrap();
    folder.good("man --folder man1");
    for name in ["juggler.1", "juggler-render.1", "juggler-merge.1"] {
        assert!(folder.path("man1").join(name).exists(), "{name}");
    }
}

#[test]
fn built_in_scenes_are_listed_and_render() {
    let folder = Folder::new();
    let list = folder.good("scenes").stdout;
    assert!(list.lines().any(|line| line.starts_with("juggler ")), "{list}");
    for line in list.lines() {
        let name = line.split_whitespace().next().unwrap();
        assert!(line.len() > name.len() + 2, "{line}");
        folder.good(&format!("check {name}"));
    }
}

#[test]
fn info_describes_a_scene() {
    let folder = Folder::new();
    let words = folder.good("info ball.json").stdout;
    assert!(words.starts_with("Ball") && words.contains("main, top") && words.contains("4 frames, 2 s"), "{words}");
    let json: serde_json::Value = serde_json::from_str(&folder.good("info ball.json --json").stdout).unwrap();
    assert_eq!((&json["geometry"]["shapes"], &json["animation"]["frames"]), (&2.into(), &4.into()));
    assert_eq!(json["cameras"], serde_json::json!(["main", "top"]));
    assert_eq!((&json["background"]["kind"], &json["far_lights"][0]["chance"]), (&"solid".into(), &1.0.into()));
    assert_eq!(json["geometry"]["emitting_shapes"], 0);
    let emitting = r#""material": {"emissive": {"radiance": 3}}"#;
    let balls = format!(
        r#"{{"shape": "sphere", {emitting}}}, {{"shape": {{"disk": {{}}}}, {emitting}}}, {{"shape": "sphere"}}"#
    );
    fs::write(folder.path("emitting.json"), format!(r#"{{"version": 1, "objects": [{balls}]}}"#)).unwrap();
    assert!(folder.good("info emitting.json").stdout.contains("\nemissive     2 shapes emit light\n"));
    let reason = "chosen because `classic` supports all lights and materials of the scene";
    assert_eq!((&json["integrator"], &json["integrator_reason"]), (&"classic".into(), &reason.into()));
    for said in [
        "background   solid, 0.2 0.3 0.5 on average\n",
        "infinite     solid 100 %\n",
        &format!("integrator   classic, {reason}\n"),
    ] {
        assert!(words.contains(said), "{words}");
    }
    fs::write(
        folder.path("film.json"),
        SCENE.replace("\"version\": 1,", MOVING).replace("\"background\": [0.2, 0.3, 0.5],", ""),
    )
    .unwrap();
    let words = folder.good("info film.json").stdout;
    let said =
        ["4 frames, 2 s, 2 frames a second", "tracks       1\n", "background: animate, 2 keys, 0 to 2 s, linear, loop"];
    assert!(said.iter().all(|said| words.contains(said)), "{words}");
    let json: serde_json::Value = serde_json::from_str(&folder.good("info film.json --json").stdout).unwrap();
    assert_eq!((&json["animation"]["tracks"], &json["animation"]["seconds"]), (&1.into(), &2.0.into()));
}

#[test]
fn a_picture_says_how_it_was_made() {
    let folder = Folder::new();
    let flags = "--seed 7 --samples 3 --frame 2";
    for name in ["a.png", "a.exr", "a.hdr"] {
        folder.good(&format!("render ball.json -q --threads 2 {flags} -o {name}"));
        let words = folder.good(&format!("info {name}")).stdout;
        let fingerprint = folder.stats(&format!("ball.json {flags}"))["fingerprint"].as_str().unwrap().to_owned();
        let program = concat!("Juggler ", env!("CARGO_PKG_VERSION"));
        let command = "juggler render ball.json --samples 3 --frame 2 --seed 7";
        for said in ["16x9", program, &fingerprint, "Seed         7\n", "Samples      3\n", command] {
            assert!(words.contains(said), "{name}: {said} in {words}");
        }
        let json: serde_json::Value =
            serde_json::from_str(&folder.good(&format!("info {name} --json")).stdout).unwrap();
        assert_eq!((&json["size"], &json["metadata"]["Command"]), (&serde_json::json!([16, 9]), &command.into()));
    }
    for name in ["a.jpg", "a.webp", "a.pfm"] {
        folder.good(&format!("render ball.json -q -o {name}"));
        assert!(folder.good(&format!("info {name}")).stdout.contains("16x9"), "{name}");
    }
    fs::write(folder.path("cut.png"), &fs::read(folder.path("a.png")).unwrap()[..20]).unwrap();
    folder.bad("info cut.png", 3);
}

#[test]
fn a_scene_comes_through_standard_input() {
    let folder = Folder::new();
    let piped = |line: &str, text: &[u8]| {
        let mut command = folder.command(line);
        let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        // The program may close its end before it has read everything.
        let _ = child.stdin.take().unwrap().write_all(text);
        Run::of(child.wait_with_output().unwrap())
    };
    let run = piped("render - -q", SCENE.as_bytes());
    assert_eq!((run.status, run.stderr.as_str(), folder.files()), (0, "", vec!["picture.png".to_owned()]));
    folder.good("render ball.json -q");
    folder.good("compare picture.png ball.png");
    assert!(piped("check -", SCENE.as_bytes()).stdout.contains("no mistakes"));
    let wrong = piped("check -", b"{\"version\": 1, \"objets\": []}");
    assert!(wrong.status == 1 && wrong.stderr.contains("standard input:1:"), "{}", wrong.stderr);
    assert_eq!(piped("render -", &[0xff, 0xfe, 0]).status, 2);
    assert_eq!(piped("render -", &[]).status, 2);
}

#[test]
fn the_schema_is_one_json_object() {
    let schema: serde_json::Value = serde_json::from_str(&Folder::new().good("schema").stdout).unwrap();
    assert!(schema["properties"]["objects"].is_object());
}

#[test]
fn closed_standard_output_is_no_error_for_text() {
    let folder = Folder::new();
    for line in ["schema", "--help", "scenes"] {
        let mut child = folder.command(line).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        drop(child.stdout.take());
        let run = child.wait_with_output().unwrap();
        assert_eq!((run.status.code(), String::from_utf8(run.stderr).unwrap().as_str()), (Some(0), ""), "{line}");
    }
}

#[test]
fn closed_standard_output_is_an_error_for_a_picture() {
    let folder = Folder::new();
    let mut command = folder.command("render ball.json --size 400x400 --samples 1 -q -o - --format pfm");
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    drop(child.stdout.take());
    let run = child.wait_with_output().unwrap();
    let message = String::from_utf8(run.stderr).unwrap();
    assert!(run.status.code() == Some(3) && !message.contains("panicked"), "{:?}: {message}", run.status);
}

/// Commands whose errors are colored on a terminal, by the program and by its command-line parser.
const COLORED: [&str; 2] = ["render jugler", "render ball.json --size 3"];

#[test]
fn output_without_a_terminal_has_no_color() {
    let folder = Folder::new();
    for line in [COLORED[0], COLORED[1], "render ball.json --progress bar"] {
        let output = folder.command(line).output().unwrap();
        assert!(!output.stderr.contains(&0x1b) && !output.stdout.contains(&0x1b), "{line}");
    }
}

#[cfg(unix)]
#[test]
fn output_on_a_terminal_has_color_unless_disabled() {
    let folder = Folder::new();
    for line in COLORED {
        for (variable, colored) in
            [(("TERM", "xterm"), true), (("NO_COLOR", ""), true), (("NO_COLOR", "1"), false), (("TERM", "dumb"), false)]
        {
            let text = on_a_terminal(folder.command(line).env("TERM", "xterm").env(variable.0, variable.1));
            assert!(text.contains("error"), "{line} {variable:?}: {text}");
            assert_eq!(text.contains('\x1b'), colored, "{line} {variable:?}: {text}");
        }
    }
}

#[cfg(unix)]
#[test]
fn pictures_are_not_written_to_a_terminal() {
    let folder = Folder::new();
    folder.good("render ball.json -q -o a.jfilm");
    for line in ["render ball.json -o -", "merge a.jfilm -o -"] {
        let (controller, terminal) = terminal();
        let run = folder.command(line).stdout(terminal).output().unwrap();
        let message = String::from_utf8_lossy(&run.stderr).into_owned();
        assert!(run.status.code() == Some(2) && message.contains("which is a terminal"), "{line}: {message}");
        drop(controller);
    }
}

/// Runs a command with standard error on a pseudo-terminal and returns its output there.
#[cfg(unix)]
fn on_a_terminal(command: &mut Command) -> String {
    let (controller, terminal) = terminal();
    let mut child = command.stdout(Stdio::null()).stderr(terminal).spawn().unwrap();
    // Close our copy of the terminal, so that reading ends with the child.
    command.stderr(Stdio::null());
    let mut bytes = Vec::new();
    let _ = fs::File::from(controller).read_to_end(&mut bytes);
    child.wait().unwrap();
    String::from_utf8_lossy(&bytes).into_owned()
}

/// Controller and terminal side of a pseudo-terminal.
#[cfg(unix)]
fn terminal() -> (std::os::fd::OwnedFd, std::os::fd::OwnedFd) {
    use rustix::fs::{Mode, OFlags};
    use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
    let controller = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).unwrap();
    grantpt(&controller).unwrap();
    unlockpt(&controller).unwrap();
    let name = ptsname(&controller, Vec::new()).unwrap();
    let terminal = rustix::fs::open(name, OFlags::RDWR | OFlags::NOCTTY, Mode::empty()).unwrap();
    (controller, terminal)
}

#[test]
fn schedulers_are_compared_in_a_table() {
    let folder = Folder::new();
    let table = folder.good("bench schedulers ball.json --size 20x20 --samples 1 --repeats 1 --threads 2").stdout;
    let lines: Vec<&str> = table.lines().collect();
    assert_eq!(lines.len(), 3, "{table}");
    assert!(lines[0].contains("stealing") && lines[1].starts_with("ball") && lines[2].contains(" 2 "), "{table}");
}

#[test]
fn rays_are_measured_on_built_in_meshes_and_on_files() {
    let folder = Folder::new();
    let sparing = "--rays 640 --repeats 1 --threads 2";
    let table = folder.good(&format!("bench rays blob:3 {sparing}")).stdout;
    let line = |start: &str| table.lines().find(|line| line.starts_with(start)).unwrap_or_default();
    assert!(table.starts_with("blob:3: 110 triangles\n"), "{table}");
    for kind in ["primary", "shadow", "ao", "diffuse", "diffuse2", "random"] {
        assert!(line("Mrays/s").contains(kind), "{table}");
    }
    for quality in ["fast", "balanced", "best"] {
        assert_eq!(table.lines().filter(|line| line.starts_with(&format!("{quality} tree"))).count(), 1, "{table}");
    }
    for test in ["watertight", "fast"] {
        for row in ["single, 1", "batch, 1", "packet, 1", "single, 2", "packet, 2"] {
            assert!(!line(&format!("{test} {row}")).is_empty(), "{test} {row}: {table}");
        }
    }

    // The default camera of a mesh file shows all of it: the bounding box fills the picture's
    // height.
    fs::write(folder.path("sheet.obj"), "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nf 1 2 3 4\n").unwrap();
    let json =
        folder.good(&format!("bench rays sheet.obj --json --kind primary,random --kernel batch {sparing}")).stdout;
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    let mesh = &json["meshes"][0];
    assert_eq!((&json["version"], &mesh["mesh"], &mesh["triangles"]), (&1.into(), &"sheet.obj".into(), &2.into()));
    let builds = mesh["builds"].as_array().unwrap().iter().map(|build| build["quality"].as_str().unwrap());
    assert_eq!(builds.collect::<Vec<_>>(), ["fast", "balanced", "best"]);
    let rates_by = |test: &str| -> Vec<serde_json::Value> {
        mesh["rates"].as_array().unwrap().iter().filter(|rate| rate["test"] == test).cloned().collect()
    };
    let rates = rates_by("watertight");
    assert_eq!(rates_by("fast").len(), rates.len());
    let named = rates.iter().map(|rate| (rate["kind"].as_str().unwrap(), rate["threads"].as_u64().unwrap()));
    assert_eq!(named.collect::<Vec<_>>(), [("primary", 1), ("primary", 2), ("random", 1), ("random", 2)]);
    let hits = rates[0]["hits"].as_u64().unwrap();
    assert!((30..320).contains(&hits) && rates[1]["hits"] == hits, "{hits}");
    assert!(rates[0]["mrays_per_second"].as_f64().unwrap() > 0.0);
    // No geometry lies above the sheet, so there is no second bounce.
    assert_eq!((&rates[2]["rays"], &rates[2]["mrays_per_cpu_second"]), (&0.into(), &serde_json::Value::Null));
    assert_eq!(folder.files(), ["sheet.obj"]);
}

#[test]
fn check_accepts_scenes_with_warnings() {
    let folder = Folder::new();
    fs::write(folder.path("plain.json"), r#"{"version": 1, "objects": [{"shape": "sphere"}]}"#).unwrap();
    assert!(folder.good("check plain.json").stdout.contains("no mistakes"));
}
