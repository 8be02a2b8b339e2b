//! Places of the bytes of a partial render: a file, or memory.

use juggler_imaging::atomic::AtomicFile;
use juggler_imaging::regular;
use std::fs::File;
use std::io::{self, BufWriter, Cursor, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Bytes of a complete partial render.
#[derive(Clone, Debug)]
pub(super) enum Storage {
    /// A file on disk.
    File(PathBuf),
    /// Bytes in memory.
    Memory(Arc<[u8]>),
}

/// Bytes that are being read.
#[derive(Debug)]
pub(super) enum StorageReader {
    /// A file on disk.
    File(File),
    /// Bytes in memory.
    Memory(Cursor<Arc<[u8]>>),
}

impl Storage {
    /// Opens the bytes for reading.
    pub fn open(&self) -> io::Result<StorageReader> {
        match self {
            Self::File(path) => regular::open(path).map(StorageReader::File),
            Self::Memory(bytes) => Ok(StorageReader::Memory(Cursor::new(Arc::clone(bytes)))),
        }
    }
}

impl StorageReader {
    /// Number of bytes.
    pub fn length(&self) -> io::Result<u64> {
        match self {
            Self::File(file) => Ok(file.metadata()?.len()),
            Self::Memory(bytes) => Ok(bytes.get_ref().len() as u64),
        }
    }
}

impl Read for StorageReader {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        match self {
            Self::File(file) => file.read(buffer),
            Self::Memory(bytes) => bytes.read(buffer),
        }
    }
}

impl Seek for StorageReader {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        match self {
            Self::File(file) => file.seek(to),
            Self::Memory(bytes) => bytes.seek(to),
        }
    }
}

/// Destination of a partial render that is being written.
#[derive(Debug)]
pub(super) enum Destination {
    /// A temporary file, which replaces the file on disk at the end.
    File(AtomicFile, BufWriter<File>),
    /// Bytes in memory.
    Memory(Vec<u8>),
}

impl Destination {
    /// Creates the temporary file beside `path`.
    pub fn create(path: &Path) -> io::Result<Self> {
        let file = AtomicFile::create(path)?;
        let out = BufWriter::with_capacity(1 << 16, file.handle()?);
        Ok(Self::File(file, out))
    }

    /// Appends bytes.
    pub fn append(&mut self, bytes: &[u8]) -> io::Result<()> {
        match self {
            Self::File(_, out) => out.write_all(bytes),
            Self::Memory(all) => {
                all.extend_from_slice(bytes);
                Ok(())
            }
        }
    }

    /// Replaces the first bytes and ends the writing: a file is synced to disk and moved to its
    /// destination. Returns the bytes of a destination in memory.
    pub fn finish(self, first: &[u8]) -> io::Result<Vec<u8>> {
        match self {
            Self::File(file, mut out) => {
                out.seek(SeekFrom::Start(0))?;
                out.write_all(first)?;
                out.flush()?;
                file.commit_durably()?;
                Ok(Vec::new())
            }
            Self::Memory(mut all) => {
                all.iter_mut().zip(first).for_each(|(byte, first)| *byte = *first);
                Ok(all)
            }
        }
    }
}
