//! Functions shared by the end-to-end tests.

use std::path::{Path, PathBuf};

/// Collects all Rust source files below a folder.
#[expect(clippy::unwrap_used, reason = "for tests, which fail by panicking")]
pub fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries
        .flat_map(|path| if path.is_dir() { rust_files(&path) } else { vec![path] })
        .filter(|path| path.extension().is_some_and(|ending| ending == "rs"))
        .collect()
}
