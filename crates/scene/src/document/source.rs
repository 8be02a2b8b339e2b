//! The texts that a scene was read from, and places in them.

use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A file's number in [`Sources`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct FileId(u32);

impl FileId {
    /// The main file of any scene.
    pub const MAIN: Self = Self(0);

    /// Position in the list of files.
    pub(crate) fn index(self) -> usize {
        self.0 as usize
    }
}

/// A range of bytes in one of the files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Place {
    /// The file.
    pub file: FileId,
    /// First byte.
    pub start: u32,
    /// The byte after the last.
    pub end: u32,
}

/// One text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Source {
    /// What messages call it.
    pub name: String,
    /// Where files that it names are looked for.
    pub folder: PathBuf,
    /// Its content.
    pub text: String,
}

/// All texts of a scene: the main file first, then what it includes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Sources {
    /// Shared: reports hold them too.
    files: Arc<Vec<Source>>,
}

impl Sources {
    /// Takes a text in; files that it names are relative to the folder of `name`.
    pub fn add(&mut self, name: impl Into<String>, text: String) -> FileId {
        let name = name.into();
        let folder = Path::new(&name).parent().map(Path::to_path_buf).unwrap_or_default();
        Arc::make_mut(&mut self.files).push(Source { name, folder, text });
        FileId(u32::try_from(self.files.len() - 1).unwrap_or(u32::MAX))
    }

    /// What messages call the texts.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.files.iter().map(|source| source.name.as_str())
    }

    /// A text by number.
    pub fn get(&self, id: FileId) -> Option<&Source> {
        self.files.get(id.0 as usize)
    }

    /// How many texts there are.
    pub fn len(&self) -> usize {
        self.files.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.files.is_empty()
    }

    /// Bytes that it takes to read all of them, see [`bytes_to_read`](super::bytes_to_read).
    pub fn bytes_to_read(&self) -> u64 {
        self.files.iter().map(|source| super::chunks::bytes_to_read(&source.text)).sum()
    }

    /// The folder of the file that `place` lies in.
    pub fn folder(&self, place: Option<Place>) -> &Path {
        let source = place.and_then(|place| self.get(place.file)).or_else(|| self.files.first());
        source.map_or(Path::new(""), |source| &source.folder)
    }
}

impl Place {
    /// Whether `other` lies inside this range.
    pub fn contains(&self, other: Self) -> bool {
        self.file == other.file && self.start <= other.start && other.end <= self.end
    }

    /// A part of this range: bytes `start..end` counted from its first byte, kept inside.
    #[must_use]
    pub fn part(&self, start: usize, end: usize) -> Self {
        let at = |offset: usize| u32::try_from(offset).map_or(self.end, |o| self.start.saturating_add(o).min(self.end));
        Self { file: self.file, start: at(start), end: at(end).max(at(start)) }
    }
}
