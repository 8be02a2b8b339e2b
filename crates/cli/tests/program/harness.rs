//! Test harness: a temporary folder with a small scene, in which the program runs.

use std::fs;
use std::path::PathBuf;
use std::process::{Child, Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// A red sphere over a floor; the sphere moves with the frame.
pub const SCENE: &str = r#"{
    "version": 1,
    "title": "Ball",
    "animation": {"frames": 4, "frames_per_second": 2},
    "render": {"size": [16, 9], "samples": 2},
    "cameras": {
        "main": {"perspective": {"eye": [0, 1, 6], "look_at": [0, 1, 0]}},
        "top": {"perspective": {"eye": [0, 6, 1], "look_at": [0, 0, 0]}},
    },
    "background": [0.2, 0.3, 0.5],
    "materials": {"red": {"phong": {"diffuse": [0.8, 0.1, 0.1]}}},
    "lights": [{"point": {"position": [4, 6, 4], "intensity": 60}}],
    "objects": [
        {"shape": "plane"},
        {"shape": {"sphere": {"radius": 1}}, "transform": [{"translate": ["=frame / 4", 1, 0]}], "material": "red"},
    ],
}"#;

/// Timeout of waiting, for busy machines.
const PATIENCE: Duration = Duration::from_secs(120);

/// Polls until the condition holds; panics after the timeout with the description `what`.
pub fn wait_until(what: &str, mut condition: impl FnMut() -> bool) {
    let start = Instant::now();
    while !condition() {
        assert!(start.elapsed() < PATIENCE, "waited two minutes in vain: {what}");
        sleep(Duration::from_millis(1));
    }
}

/// Sends a signal (`-INT`, `-KILL`, ...) to a process, unless it has ended already.
#[cfg(unix)]
pub fn signal(child: &Child, name: &str) {
    let _ = Command::new("kill").args([name, &child.id().to_string()]).stderr(Stdio::null()).status();
}

/// A temporary folder.
pub struct Folder(tempfile::TempDir);

/// Result of a run.
pub struct Run {
    pub status: i32,
    pub stdout: String,
    pub stderr: String,
    pub bytes: Vec<u8>,
}

impl Folder {
    /// Creates a folder with `ball.json`.
    pub fn new() -> Self {
        let folder = Self(tempfile::tempdir().unwrap());
        fs::write(folder.path("ball.json"), SCENE).unwrap();
        folder
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Names of all files except the scene, including hidden ones.
    pub fn files(&self) -> Vec<String> {
        let entries = fs::read_dir(self.0.path()).unwrap();
        let mut names: Vec<String> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.retain(|name| name != "ball.json");
        names.sort();
        names
    }

    pub fn command(&self, line: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_juggler"));
        command.args(line.split_whitespace()).current_dir(self.0.path()).stdin(Stdio::null());
        for variable in ["NO_COLOR", "CLICOLOR", "CLICOLOR_FORCE", "FORCE_COLOR"] {
            command.env_remove(variable);
        }
        command
    }

    pub fn run(&self, line: &str) -> Run {
        Run::of(self.command(line).output().unwrap())
    }

    /// Runs a command that must succeed without output on standard error.
    pub fn good(&self, line: &str) -> Run {
        let run = self.run(line);
        assert_eq!((run.status, run.stderr.as_str()), (0, ""), "{line}");
        run
    }

    /// Runs a command that must fail without output on standard output; returns its error message.
    pub fn bad(&self, line: &str, status: i32) -> String {
        let run = self.run(line);
        assert_eq!((run.status, run.stdout.as_str()), (status, ""), "{line}: {}", run.stderr);
        assert!(!run.stderr.contains('\x1b') && !run.stderr.contains("panicked"), "{line}: {}", run.stderr);
        run.stderr
    }

    /// Statistics of a render.
    pub fn stats(&self, line: &str) -> serde_json::Value {
        let run = self.run(&format!("render {line} --quiet --stats -"));
        assert_eq!(run.status, 0, "{line}: {}", run.stderr);
        serde_json::from_str(&run.stdout).unwrap()
    }

    /// Hash of a render's pixels.
    pub fn hash(&self, line: &str) -> String {
        self.stats(line)["film"]["hash"].as_str().unwrap().to_owned()
    }
}

impl Run {
    pub fn of(output: Output) -> Self {
        Self {
            status: output.status.code().unwrap_or(-1),
            stdout: String::from_utf8_lossy(&output.stdout).into_owned(),
            stderr: String::from_utf8_lossy(&output.stderr).into_owned(),
            bytes: output.stdout,
        }
    }
}
