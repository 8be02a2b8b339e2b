//! Functions shared by the end-to-end tests.

use std::fs::OpenOptions;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Reports why a test checks nothing on this machine: on standard error, and as a line appended to
/// the file that `JUGGLER_SKIPPED` names, which `check.sh` prints at its end.
///
/// `juggler_math::testing` has the same function. Its feature would make the libraries of these
/// tests differ from those of the Python module, and the check would compile all of them twice.
#[expect(clippy::print_stderr, reason = "a skipped test is reported to the person who runs it")]
pub fn skipped(reason: &str) {
    eprintln!("SKIPPED: {reason}");
    let Some(path) = std::env::var_os("JUGGLER_SKIPPED") else { return };
    let file = OpenOptions::new().create(true).append(true).open(path);
    if let Err(error) = file.and_then(|mut file| file.write_all(format!("{reason}\n").as_bytes())) {
        eprintln!("cannot write to the file that JUGGLER_SKIPPED names: {error}");
    }
}

/// Collects all Rust source files below a folder.
#[expect(clippy::unwrap_used, reason = "for tests, which fail by panicking")]
pub fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries
        .flat_map(|path| if path.is_dir() { rust_files(&path) } else { vec![path] })
        .filter(|path| path.extension().is_some_and(|ending| ending == "rs"))
        .collect()
}
