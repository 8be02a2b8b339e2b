//! The texts of a scene's files, and ranges in them.

use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Index of a file in [`Sources`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct FileId(u32);

impl FileId {
    /// The main file of a scene.
    pub const MAIN: Self = Self(0);

    /// Index in the list of files.
    pub(crate) fn index(self) -> usize {
        self.0 as usize
    }
}

/// A range of bytes in one of the files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct SourceSpan {
    /// The file.
    pub file: FileId,
    /// First byte.
    pub start: u32,
    /// One past the last byte.
    pub end: u32,
}

/// The text of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Source {
    /// Name in messages.
    pub name: String,
    /// Folder to which file names in the text are relative.
    pub folder: PathBuf,
    /// Content of the file.
    pub text: String,
}

/// All texts of a scene: the main file first, then the included files.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Sources {
    /// Shared with reports.
    files: Arc<Vec<Source>>,
}

impl Sources {
    /// Adds a text. File names in it are relative to the folder of `name`.
    pub fn add(&mut self, name: impl Into<String>, text: String) -> FileId {
        let name = name.into();
        let folder = Path::new(&name).parent().map(Path::to_path_buf).unwrap_or_default();
        Arc::make_mut(&mut self.files).push(Source { name, folder, text });
        FileId(u32::try_from(self.files.len() - 1).unwrap_or(u32::MAX))
    }

    /// Names of the texts, as in messages.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.files.iter().map(|source| source.name.as_str())
    }

    /// The texts, the main one first.
    pub fn texts(&self) -> impl Iterator<Item = &Source> {
        self.files.iter()
    }

    /// Returns the text with this index.
    pub fn get(&self, id: FileId) -> Option<&Source> {
        self.files.get(id.0 as usize)
    }

    /// Number of texts.
    pub fn len(&self) -> usize {
        self.files.len()
    }

    /// Whether there are no texts.
    pub fn is_empty(&self) -> bool {
        self.files.is_empty()
    }

    /// Estimated memory to read all texts, in bytes; see [`bytes_to_read`](super::bytes_to_read).
    pub fn bytes_to_read(&self) -> u64 {
        self.files.iter().map(|source| super::chunks::bytes_to_read(&source.text)).sum()
    }

    /// Folder of the file that contains `place`; of the main file if `place` is `None`.
    pub fn folder(&self, place: Option<SourceSpan>) -> &Path {
        let source = place.and_then(|place| self.get(place.file)).or_else(|| self.files.first());
        source.map_or(Path::new(""), |source| &source.folder)
    }
}

impl SourceSpan {
    /// Whether `other` lies inside this range.
    pub fn contains(&self, other: Self) -> bool {
        self.file == other.file && self.start <= other.start && other.end <= self.end
    }

    /// The subrange of the bytes `start..end` relative to this range's start, clamped to this
    /// range.
    #[must_use]
    pub fn part(&self, start: usize, end: usize) -> Self {
        let at = |offset: usize| u32::try_from(offset).map_or(self.end, |o| self.start.saturating_add(o).min(self.end));
        Self { file: self.file, start: at(start), end: at(end).max(at(start)) }
    }
}
