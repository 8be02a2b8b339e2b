//! Opening files for reading. Every input file of the workspace is opened here, so that nothing but a regular file
//! is read: a named pipe waits for another program, and a device may never end.

use std::fs::{self, File, Metadata};
use std::io::{self, ErrorKind, Read};
use std::path::Path;

/// Opens a regular file for reading. Links are followed. Folders, named pipes (FIFOs), devices and sockets are refused
/// before they are opened, each by what it is; a link that leads back to itself is refused as such.
pub fn open(path: &Path) -> io::Result<File> {
    check(&fs::metadata(path).map_err(|error| of_link(path, error))?)?;
    let file = File::open(path)?;
    // Another program may have put something else there in the meantime.
    check(&file.metadata()?)?;
    Ok(file)
}

/// Reads the first bytes of a regular file: up to `count`, fewer where the file is shorter.
pub fn first_bytes(path: &Path, count: u64) -> io::Result<Vec<u8>> {
    let mut start = Vec::new();
    open(path)?.take(count).read_to_end(&mut start)?;
    Ok(start)
}

/// Whether an error of [`open`] says that something is there, but no regular file.
pub fn is_of_kind(error: &io::Error) -> bool {
    matches!(error.kind(), ErrorKind::IsADirectory | ErrorKind::Unsupported)
}

fn check(facts: &Metadata) -> io::Result<()> {
    if facts.is_file() {
        return Ok(());
    }
    if facts.is_dir() {
        return Err(io::Error::new(ErrorKind::IsADirectory, "this is a folder, not a file"));
    }
    Err(io::Error::new(ErrorKind::Unsupported, format!("this is {}, not a regular file", kind(facts))))
}

#[cfg(unix)]
fn kind(facts: &Metadata) -> &'static str {
    use std::os::unix::fs::FileTypeExt;
    let kind = facts.file_type();
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

/// The error of a path that leads nowhere, where links lead in a circle in words of its own.
fn of_link(path: &Path, error: io::Error) -> io::Error {
    let is_link = fs::symlink_metadata(path).is_ok_and(|facts| facts.is_symlink());
    match error.kind() {
        ErrorKind::NotFound | ErrorKind::PermissionDenied | ErrorKind::NotADirectory => error,
        kind if is_link => io::Error::new(kind, "this is a link that leads back to itself"),
        _ => error,
    }
}

#[cfg(all(test, unix))]
#[path = "regular_tests.rs"]
mod tests;
