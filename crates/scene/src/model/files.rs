//! Reading of the files that a model file names: buffers, images and libraries of materials.

use crate::picture_reading::PictureReading;
use std::collections::BTreeMap;

/// Why a file cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum FileError {
    /// There is no such file.
    #[error("no such file")]
    Missing,
    /// The file exceeds the limit.
    #[error("the file has {found} bytes, the limit is {limit}")]
    TooLarge {
        /// Size of the file in bytes.
        found: u64,
        /// Maximum size in bytes.
        limit: u64,
    },
    /// A symbolic link leads out of the folder of the model file.
    #[error("a symbolic link leads out of the folder of the model, and only files in it are read; copy the file there")]
    Outside,
    /// The system cannot read the file.
    #[error("cannot be read: {0}")]
    Read(String),
}

/// Source of the files that a model file names.
pub trait Files {
    /// Reads a file. `name` is relative to the folder of the model file, with the separators `/`,
    /// and does not leave that folder.
    ///
    /// # Errors
    ///
    /// The file does not exist, is a symbolic link that leaves the folder, has more than `limit`
    /// bytes (known before memory is reserved), or cannot be read.
    fn read(&self, name: &str, limit: u64) -> Result<Vec<u8>, FileError>;

    /// Length of a file in bytes, without reading it if possible; `None` if it cannot be read.
    fn length(&self, name: &str) -> Option<u64> {
        self.read(name, u64::MAX).ok().map(|bytes| bytes.len() as u64)
    }

    /// Whether pictures that are missing or broken are shown gray, with a warning, instead of being
    /// errors. Defaults to `false`.
    fn is_lenient(&self) -> bool {
        false
    }

    /// What is read of pictures. Defaults to all pixels.
    fn pictures(&self) -> PictureReading {
        PictureReading::Whole
    }
}

/// Files in memory by their names.
impl Files for BTreeMap<String, Vec<u8>> {
    fn read(&self, name: &str, limit: u64) -> Result<Vec<u8>, FileError> {
        let bytes = self.get(name).ok_or(FileError::Missing)?;
        let found = bytes.len() as u64;
        if found > limit {
            return Err(FileError::TooLarge { found, limit });
        }
        Ok(bytes.clone())
    }
}
