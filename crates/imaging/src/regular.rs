//! Opens input files. The whole workspace reads files through [`open`], which accepts regular files
//! only: a named pipe would block until another program writes, and a device may never end.

use std::fs::{self, File, Metadata};
use std::io::{self, ErrorKind, Read};
use std::path::Path;

/// Opens a regular file for reading and follows symbolic links.
///
/// # Errors
///
/// Folders, named pipes (FIFOs), devices, sockets and circular links are rejected before they are
/// opened, each with a message that says what it is.
pub fn open(path: &Path) -> io::Result<File> {
    check(&fs::metadata(path).map_err(|error| explain_link_error(path, error))?)?;
    let file = File::open(path)?;
    // Another program may have replaced the file after the check.
    check(&file.metadata()?)?;
    Ok(file)
}

/// Reads up to `count` bytes from the start of a regular file.
pub fn first_bytes(path: &Path, count: u64) -> io::Result<Vec<u8>> {
    let mut start = Vec::new();
    open(path)?.take(count).read_to_end(&mut start)?;
    Ok(start)
}

/// Error of [`read`].
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    /// The file cannot be opened or read.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// The file exceeds the limit.
    #[error("at least {found} bytes, the limit is {limit}")]
    TooLarge {
        /// Number of bytes known when reading stopped.
        found: u64,
        /// Maximum number of bytes.
        limit: u64,
    },
}

/// Reads a regular file of at most `limit` bytes. The size is checked before memory is allocated.
pub fn read(path: &Path, limit: u64) -> Result<Vec<u8>, ReadError> {
    let check = |found: u64| if found > limit { Err(ReadError::TooLarge { found, limit }) } else { Ok(()) };
    let file = open(path)?;
    let size = file.metadata()?.len();
    check(size)?;
    let mut bytes = Vec::new();
    bytes.try_reserve_exact(usize::try_from(size).unwrap_or(usize::MAX)).map_err(io::Error::other)?;
    // The file may have grown: one byte beyond the limit suffices to detect that.
    file.take(limit.saturating_add(1)).read_to_end(&mut bytes)?;
    check(bytes.len() as u64)?;
    Ok(bytes)
}

/// Whether an error of [`open`] means that the path exists but is not a regular file.
pub fn is_not_regular(error: &io::Error) -> bool {
    matches!(error.kind(), ErrorKind::IsADirectory | ErrorKind::Unsupported)
}

fn check(metadata: &Metadata) -> io::Result<()> {
    if metadata.is_file() {
        return Ok(());
    }
    if metadata.is_dir() {
        return Err(io::Error::new(ErrorKind::IsADirectory, "this is a folder, not a file"));
    }
    Err(io::Error::new(ErrorKind::Unsupported, format!("this is {}, not a regular file", kind(metadata))))
}

#[cfg(unix)]
fn kind(metadata: &Metadata) -> &'static str {
    use std::os::unix::fs::FileTypeExt;
    let kind = metadata.file_type();
    match () {
        () if kind.is_fifo() => "a named pipe (FIFO)",
        () if kind.is_socket() => "a socket",
        () => "a device",
    }
}

#[cfg(not(unix))]
fn kind(_: &Metadata) -> &'static str {
    "a device"
}

/// Replaces the system's error for circular links by a clearer message.
fn explain_link_error(path: &Path, error: io::Error) -> io::Error {
    let is_link = fs::symlink_metadata(path).is_ok_and(|metadata| metadata.is_symlink());
    match error.kind() {
        ErrorKind::NotFound | ErrorKind::PermissionDenied | ErrorKind::NotADirectory => error,
        kind if is_link => io::Error::new(kind, "this is a link that leads back to itself"),
        _ => error,
    }
}

#[cfg(all(test, unix))]
#[path = "regular_tests.rs"]
mod tests;
