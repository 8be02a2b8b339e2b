//! Several scenes of one command.

use crate::harness::{Folder, SCENE, wait_until};
use std::fs;

/// Folder `scenes` with the scenes `a`, `b` and `c`, which differ in their backgrounds.
fn three() -> Folder {
    let folder = Folder::new();
    fs::create_dir(folder.path("scenes")).unwrap();
    for (name, red) in [("a", "0.1"), ("b", "0.2"), ("c", "0.3")] {
        write(&folder, name, &SCENE.replace("[0.2, 0.3, 0.5]", &format!("[{red}, 0.3, 0.5]")));
    }
    folder
}

fn write(folder: &Folder, name: &str, text: &str) {
    fs::write(folder.path(&format!("scenes/{name}.json")), text).unwrap();
}

fn last_line(text: &str) -> &str {
    text.trim_end().rsplit('\n').next().unwrap_or_default()
}

#[test]
fn scenes_are_rendered_one_after_the_other_as_by_themselves() {
    let folder = three();
    let said =
        folder.good("render scenes/a.json scenes/b.json scenes/c.json one-sphere --size 16x9 --samples 1").stdout;
    assert!(last_line(&said).starts_with("4 scenes: 4 rendered, "), "{said}");
    assert_eq!(said.lines().count(), 5, "{said}");
    assert_eq!(folder.files(), ["a.png", "b.png", "c.png", "one-sphere.png", "scenes"]);
    folder.good("render scenes/b.json --size 16x9 --samples 1 -q -o alone.png");
    assert_eq!(fs::read(folder.path("b.png")).unwrap(), fs::read(folder.path("alone.png")).unwrap());
    let said = folder.good("render scenes -o pictures/deep -q --samples 1 --format exr").stdout;
    assert_eq!(said, "");
    assert!(folder.path("pictures/deep/c.exr").exists());
    folder.good("render scenes -o {}_##.png -q --samples 1 --frames 0..2 --stats {}.json");
    assert!(folder.path("c_01.png").exists() && folder.path("a_0001.json").exists());
    folder.good("render scenes -o {}.gif -q --samples 1");
    assert!(folder.path("a.gif").exists() && !folder.path("a.gif.frames").exists());
}

#[test]
fn a_scene_that_fails_does_not_stop_the_others_and_the_status_says_so() {
    let folder = three();
    write(&folder, "b", r#"{"version": 1, "objects": [{"shape": "spher"}]}"#);
    let run = folder.run("render scenes missing.json -o out --samples 1");
    assert_eq!(run.status, 2, "{}", run.stderr);
    assert!(run.stderr.contains("did you mean `sphere`") && run.stderr.contains("missing.json"), "{}", run.stderr);
    let summary = last_line(&run.stdout);
    assert!(summary.starts_with("4 scenes: 2 rendered, 2 failed (scenes/b.json, missing.json), "), "{summary}");
    assert!(folder.path("out/a.png").exists() && folder.path("out/c.png").exists());
    let run = folder.run("render missing.json scenes/b.json -q");
    assert_eq!((run.status, run.stdout.as_str()), (3, ""), "the first that failed");
    // A wrong command line stops all before the first scene.
    folder.bad("render scenes -o x.png", 2);
    folder.bad("render scenes scenes/a.json -o y", 2);
    folder.bad("render scenes -o z --integrator clasic", 2);
    assert!(!folder.files().iter().any(|file| ["x.png", "y", "z"].contains(&file.as_str())));
}

#[test]
fn resuming_skips_what_the_same_command_made_from_the_same_scene() {
    let folder = three();
    let summary = |flags: &str| {
        let said = folder.good(&format!("render scenes -o out --samples 1 --resume {flags}")).stdout;
        last_line(&said).rsplit_once(", ").unwrap().0.to_owned()
    };
    assert_eq!(summary(""), "3 scenes: 3 rendered");
    let modified = || fs::metadata(folder.path("out/b.png")).unwrap().modified().unwrap();
    let before = modified();
    assert_eq!(summary(""), "3 scenes: 0 rendered, 3 kept");
    fs::remove_file(folder.path("out/a.png")).unwrap();
    assert_eq!(summary(""), "3 scenes: 1 rendered, 2 kept");
    let scene = fs::read_to_string(folder.path("scenes/c.json")).unwrap();
    write(&folder, "c", &format!("// A comment.\n{scene}"));
    assert_eq!(summary(""), "3 scenes: 0 rendered, 3 kept", "the same scene");
    write(&folder, "c", &scene.replace("\"radius\": 1", "\"radius\": 0.9"));
    assert_eq!(summary(""), "3 scenes: 1 rendered, 2 kept");
    assert_eq!(modified(), before);
    assert_eq!(summary("--seed 1"), "3 scenes: 3 rendered", "another command");
    let one = "render scenes/a.json --samples 1 --resume -o one.png";
    folder.good(one);
    assert_eq!(folder.good(one).stdout, "one.png: exists already, made by the same command\n");
    for (flags, reason) in [("-o a.jpg", "PNG, EXR and HDR"), ("-o a.gif", "a movie"), ("-o a.jfilm", "--checkpoint")] {
        let message = folder.bad(&format!("render ball.json --resume {flags}"), 2);
        assert!(message.contains("--resume is for") && message.contains(reason), "{message}");
    }
}

#[cfg(unix)]
#[test]
fn a_series_that_is_killed_or_interrupted_resumes_to_the_same_files() {
    use crate::harness::signal;
    let folder = three();
    let line = |output: &str| format!("render scenes -o {output} --size 64x36 --samples 64 --threads 1 --resume");
    folder.good(&line("whole"));
    for (name, status) in [("-KILL", -1), ("-INT", 130)] {
        let mut child = folder.command(&line("out")).spawn().unwrap();
        wait_until("a picture", || folder.path("out/a.png").exists());
        signal(&child, name);
        let ended = child.wait().unwrap();
        // The series may have ended before the signal.
        assert!(ended.code().unwrap_or(-1) == status || ended.success(), "{ended}");
        let said = folder.good(&line("out")).stdout;
        assert!(said.contains("exists already") && last_line(&said).contains(" kept, "), "{said}");
        for scene in ["a", "b", "c"] {
            let bytes = |place: &str| fs::read(folder.path(&format!("{place}/{scene}.png"))).unwrap();
            assert!(bytes("out") == bytes("whole"), "{scene}");
        }
        fs::remove_dir_all(folder.path("out")).unwrap();
    }
}
