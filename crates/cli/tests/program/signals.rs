//! Signals end a render cleanly: without incomplete files, and with the right exit status.
#![cfg(unix)]

use crate::harness::{self, Folder, Run, wait_until};
use serde_json::Value;
use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Starts a render of hours, and sends a signal once the output file has its first bytes.
fn interrupt(folder: &Folder, signal: &str) -> Run {
    let mut command = folder.command("render ball.json --samples 1000000 --size 200x200 -o out.png");
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let before = folder.files().len();
    wait_until("the first bytes of the picture", || folder.files().len() > before);
    harness::signal(&child, signal);
    let start = Instant::now();
    let run = Run::of(child.wait_with_output().unwrap());
    assert!(start.elapsed() < Duration::from_secs(20), "it took too long to stop");
    run
}

#[test]
fn interrupted_render_keeps_existing_files() {
    for (signal, status) in [("-INT", 130), ("-TERM", 143)] {
        let folder = Folder::new();
        fs::write(folder.path("out.png"), "old").unwrap();
        fs::write(folder.path("other.txt"), "").unwrap();
        let run = interrupt(&folder, signal);
        assert_eq!((run.status, run.stdout.as_str(), run.stderr.trim()), (status, "", "interrupted"));
        assert_eq!(folder.files(), ["other.txt", "out.png"]);
        assert_eq!(fs::read_to_string(folder.path("out.png")).unwrap(), "old");
    }
}

#[test]
fn progress_is_reported_during_the_render() {
    let folder = Folder::new();
    let line = "render ball.json --samples 1000000 --size 200x200 -o out.png --progress json";
    let mut child = folder.command(line).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    let mut lines = BufReader::new(child.stderr.take().unwrap());
    let mut next = || {
        let mut line = String::new();
        lines.read_line(&mut line).unwrap();
        serde_json::from_str::<Value>(&line).unwrap()
    };
    assert_eq!(next()["event"], "start");
    let progress = next();
    let keys: Vec<&String> = progress.as_object().unwrap().keys().collect();
    assert_eq!(keys, ["event", "fraction", "rays", "rays_per_second", "eta_seconds"]);
    let fraction = progress["fraction"].as_f64().unwrap();
    assert!(fraction > 0.0 && fraction < 1.0 && progress["rays"].as_f64().unwrap() > 0.0, "{progress}");
    harness::signal(&child, "-INT");
    assert_eq!(child.wait().unwrap().code(), Some(130));
    let mut rest = String::new();
    lines.read_to_string(&mut rest).unwrap();
    assert!(rest.ends_with("interrupted\n"), "{rest}");
}

#[test]
fn a_second_signal_ends_the_program_at_once() {
    let folder = Folder::new();
    // No process reads the pipe, so the program blocks in a write, during which the first signal is
    // only recorded.
    let mut command = folder.command("render ball.json --samples 1 --size 1000x1000 -o -");
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap();
    child.stdout.as_mut().unwrap().read_exact(&mut [0; 8]).unwrap();
    std::thread::sleep(Duration::from_millis(500));
    harness::signal(&child, "-INT");
    std::thread::sleep(Duration::from_millis(500));
    assert_eq!(child.try_wait().unwrap(), None, "the pipe was not full");
    let second = Instant::now();
    harness::signal(&child, "-INT");
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert!(second.elapsed() < Duration::from_secs(5), "{:?}", second.elapsed());
}

/// Whether this process, and thus its children, ignore SIGHUP, as under `nohup`.
#[cfg(target_os = "linux")]
fn ignores_hangups() -> bool {
    let status = fs::read_to_string("/proc/self/status").unwrap();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:")).unwrap();
    u64::from_str_radix(mask.trim(), 16).unwrap() & 1 == 1
}

#[cfg(target_os = "linux")]
#[test]
fn hangup_of_the_terminal_ends_a_render_cleanly() {
    if !ignores_hangups() {
        let folder = Folder::new();
        let run = interrupt(&folder, "-HUP");
        assert_eq!((run.status, run.stderr.trim()), (129, "interrupted"));
        assert_eq!(folder.files(), [""; 0]);
    }
}

#[test]
fn next_successful_render_removes_files_of_a_killed_render() {
    let folder = Folder::new();
    assert_eq!(interrupt(&folder, "-KILL").status, -1);
    assert_eq!(folder.files(), [".out.png.part"]);
    folder.good("render ball.json -q -o out.png");
    assert_eq!(folder.files(), ["out.png"]);
}

#[test]
fn an_interrupted_merge_leaves_nothing() {
    let folder = Folder::new();
    // Try a larger picture on fast machines.
    let interrupted = [700, 2000].into_iter().any(|side| {
        folder.good(&format!("render ball.json --integrator normals --samples 1 --size {side}x{side} -o a.jfilm -q"));
        let _ = fs::remove_file(folder.path("out.png"));
        let mut command = folder.command("merge a.jfilm -o out.png");
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let begun = || folder.files().len() > 1;
        wait_until("the first bytes of the picture", || begun() || child.try_wait().unwrap().is_some());
        harness::signal(&child, "-TERM");
        let run = Run::of(child.wait_with_output().unwrap());
        if run.status == 143 {
            assert_eq!((run.stderr.trim(), folder.files()), ("interrupted", vec!["a.jfilm".to_owned()]));
        }
        run.status == 143
    });
    assert!(interrupted, "all merges were done before the signal came");
}

#[test]
fn a_limit_of_file_sizes_leaves_no_incomplete_file() {
    let folder = Folder::new();
    for output in ["out.pfm", "out.jfilm", "out.exr --aov position"] {
        let render = folder.command(&format!("render ball.json -q --size 200x200 -o {output}"));
        // 8 blocks of 512 or 1,024 bytes.
        let mut limited = Command::new("sh");
        limited.args(["-c", r#"ulimit -f 8; exec "$0" "$@""#]).arg(render.get_program()).args(render.get_args());
        let run = Run::of(limited.current_dir(folder.path(".")).output().unwrap());
        assert_eq!((run.status, run.stdout.as_str()), (3, ""), "{output}: {}", run.stderr);
        assert!(run.stderr.contains("cannot write") && run.stderr.contains("out."), "{output}: {}", run.stderr);
        assert_eq!(folder.files(), [""; 0], "{output}");
    }
}
