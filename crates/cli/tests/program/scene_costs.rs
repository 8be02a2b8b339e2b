//! `juggler bench scenes`: costs of rendering, by instructions and by CPU time.

use crate::harness::{Folder, Run};
use juggler_math::testing::skipped;
use serde_json::Value;
use std::process::Command;

/// Runs `juggler bench scenes`, whose temporary folder is in the folder of the test.
fn bench(folder: &Folder, line: &str) -> Run {
    let mut command = folder.command(&format!("bench scenes {line}"));
    let run = Run::of(command.env("TMPDIR", folder.path("")).output().unwrap());
    assert_eq!(folder.files(), Vec::<String>::new(), "files are left");
    run
}

fn json(folder: &Folder, line: &str) -> Value {
    let run = bench(folder, &format!("{line} --json"));
    assert_eq!((run.status, run.stderr.as_str()), (0, ""), "{line}");
    serde_json::from_str(&run.stdout).unwrap()
}

#[test]
fn cpu_times_are_measured_beside_another_program() {
    let folder = Folder::new();
    let program = env!("CARGO_BIN_EXE_juggler");
    let report = json(&folder, &format!("juggler --measure cpu-time --repeats 2 --beside {program}"));
    assert_eq!(
        (&report["version"], &report["measure"], &report["valgrind"]),
        (&1.into(), &"cpu-time".into(), &Value::Null)
    );
    for measured in report["programs"].as_array().unwrap() {
        assert_eq!((&measured["program"], &measured["version"]), (&program.into(), &env!("CARGO_PKG_VERSION").into()));
        assert!(measured["compiler"].as_str().unwrap().starts_with("rustc ") && measured["simd"].is_string());
    }
    let [scene] = report["scenes"].as_array().unwrap().as_slice() else { panic!("{report}") };
    assert_eq!((&scene["scene"], &scene["samples"]), (&"juggler".into(), &(32 * 32 * 64).into()));
    let [own, other] = scene["results"].as_array().unwrap().as_slice() else { panic!("{report}") };
    assert!(own["cpu_seconds"].as_f64().unwrap() > 0.0 && other["cpu_seconds"].as_f64().unwrap() > 0.0, "{report}");
    assert!((0.2..5.0).contains(&scene["ratio"].as_f64().unwrap()), "{report}");
    assert!(own["rays"].as_u64().unwrap() >= 32 * 32 * 64 && own["rays"] == other["rays"], "{report}");
    assert!(own["hash"].as_str().unwrap().len() == 64 && own["hash"] == other["hash"], "{report}");
}

#[test]
fn instructions_are_counted_and_repeat() {
    if Command::new("valgrind").arg("--version").output().is_err() {
        return skipped("instructions of scenes: valgrind is not installed (apt-get install valgrind)");
    }
    let folder = Folder::new();
    let report = json(&folder, &format!("juggler --beside {}", env!("CARGO_BIN_EXE_juggler")));
    assert_eq!(report["measure"], "instructions");
    assert!(report["valgrind"].as_str().unwrap().contains('.'), "{report}");
    let scene = &report["scenes"][0];
    assert_eq!(scene["samples"], 32 * 32 * 4);
    let instructions = scene["results"][0]["instructions"].as_u64().unwrap();
    assert!((2_000_000..2_000_000_000).contains(&instructions), "{report}");
    let ratio = scene["ratio"].as_f64().unwrap();
    assert!((ratio - 1.0).abs() < 0.02, "{report}");
}

#[test]
fn mistakes_are_explained() {
    let folder = Folder::new();
    let bad = |line: &str, status: i32| {
        let run = bench(&folder, line);
        assert_eq!((run.status, run.stdout.as_str()), (status, ""), "{line}: {}", run.stderr);
        run.stderr
    };
    assert!(bad("jugler", 2).contains("'juggler'"), "no suggestion");
    assert!(bad("juggler --measure time", 2).contains("cpu-time"), "no list");
    bad("juggler --repeats 0", 2);
    assert_eq!(bad("juggler --beside ./none", 3), "error: there is no program `./none`\n");
    assert_eq!(bad("juggler --program ./none", 3), "error: there is no program `./none`\n");
    assert!(bad("juggler --beside ./ball.json", 3).starts_with("error: cannot run `./ball.json`") || cfg!(windows));
    assert!(bad("room --measure cpu-time", 3).contains("`scenes/models/room.glb`"), "no file");
}

#[test]
fn valgrind_is_needed_for_instructions_alone() {
    let folder = Folder::new();
    let without = |line: &str| {
        let mut command = folder.command(&format!("bench scenes juggler {line}"));
        Run::of(command.env("PATH", folder.path("")).output().unwrap())
    };
    let run = without("--measure instructions");
    assert_eq!((run.status, run.stdout.as_str()), (3, ""));
    assert!(run.stderr.contains("valgrind") && run.stderr.contains("--measure cpu-time"), "{}", run.stderr);
    let table = without("--repeats 1");
    assert_eq!((table.status, table.stderr.as_str()), (0, ""));
    let lines: Vec<&str> = table.stdout.lines().collect();
    assert_eq!(lines.len(), 4, "{}", table.stdout);
    assert!(lines[1].contains("CPU seconds") && lines[3].starts_with("juggler "), "{}", table.stdout);
}

#[cfg(unix)]
#[test]
fn other_programs_are_noticed() {
    use std::fs;
    use std::os::unix::fs::PermissionsExt;
    let folder = Folder::new();
    let other = tempfile::tempdir().unwrap();
    let script = other.path().join("other");
    let write = |text: &str| {
        fs::write(&script, format!("#!/bin/sh\n{text}\n")).unwrap();
        fs::set_permissions(&script, fs::Permissions::from_mode(0o755)).unwrap();
    };
    let bad = |status: i32| {
        let run = bench(&folder, &format!("juggler --measure cpu-time --program {}", script.display()));
        assert_eq!((run.status, run.stdout.as_str()), (status, ""), "{}", run.stderr);
        run.stderr
    };
    write("echo Python 3");
    assert!(bad(2).contains("is not the program juggler"));
    let version = "[ \"$1\" != --version ] || exec echo juggler 0.0.1";
    // An old version reports no CPU time.
    write(&format!(
        "{version}\necho '{{\"seconds\": {{\"render\": 1}}, \"rays\": {{\"total\": 5}}, \"film\": {{\"hash\": \"a\"}}}}'"
    ));
    assert!(bad(3).contains("reports no CPU time"));
    write(&format!("{version}\necho 'no memory' >&2\nexit 3"));
    let message = bad(3);
    assert!(message.contains("failed with exit status: 3") && message.contains("no memory"), "{message}");
}
