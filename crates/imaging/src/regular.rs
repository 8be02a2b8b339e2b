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
