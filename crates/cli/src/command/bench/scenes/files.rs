//! The temporary folder of a benchmark.

use crate::failure::Failure;
use std::fs;
use std::path::{Path, PathBuf};

/// A new folder, which is removed with all its files at the end.
pub struct TemporaryFolder(PathBuf);

impl TemporaryFolder {
    /// Creates the folder. Its name contains the number of the process.
    ///
    /// # Errors
    ///
    /// Fails if the folder exists or cannot be created.
    pub fn create() -> Result<Self, Failure> {
        let path = std::env::temp_dir().join(format!("juggler-bench-{}", std::process::id()));
        fs::create_dir(&path).map_err(|error| Failure::file("create", path.display(), &error))?;
        Ok(Self(path))
    }

    pub fn path(&self) -> &Path {
        &self.0
    }
}

impl Drop for TemporaryFolder {
    fn drop(&mut self) {
        // A folder that stays behind does no harm.
        let _ = fs::remove_dir_all(&self.0);
    }
}

pub fn write_file(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    fs::write(path, bytes).map_err(|error| Failure::file("write", path.display(), &error))
}
