//! Regular files are opened; everything else is rejected with its own message.

use super::*;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::process::Command;

#[test]
fn regular_files_are_opened_through_links() {
    let folder = tempfile::tempdir().unwrap();
    let (file, link) = (folder.path().join("a"), folder.path().join("b"));
    fs::write(&file, "hello").unwrap();
    symlink(&file, &link).unwrap();
    assert_eq!(first_bytes(&link, 4).unwrap(), b"hell");
    assert_eq!(first_bytes(&file, 9).unwrap(), b"hello");
}

#[test]
fn files_beyond_the_limit_are_rejected() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a");
    fs::write(&file, "hello").unwrap();
    assert_eq!(read(&file, 5).unwrap(), b"hello");
    let error = read(&file, 4).unwrap_err();
    assert!(matches!(error, ReadError::TooLarge { found: 5, limit: 4 }));
    assert_eq!(error.to_string(), "at least 5 bytes, the limit is 4");
    // The length of a file of the system is 0 before it is read.
    assert!(matches!(read(Path::new("/proc/self/status"), 9), Err(ReadError::TooLarge { found: 10, limit: 9 })));
    assert!(matches!(read(folder.path(), 9), Err(ReadError::Io(_))));
}

#[test]
fn pipes_and_folders_are_rejected_without_blocking() {
    let folder = tempfile::tempdir().unwrap();
    let place = |name: &str| folder.path().join(name);
    let refused = |path: &Path| open(path).unwrap_err().to_string();
    assert!(Command::new("mkfifo").arg(place("pipe")).status().unwrap().success());
    symlink(place("pipe"), place("to_pipe")).unwrap();
    symlink(place("round"), place("round")).unwrap();
    symlink(place("none"), place("dangling")).unwrap();
    let _socket = std::os::unix::net::UnixListener::bind(place("socket")).unwrap();
    let expected = [
        ("pipe", "this is a named pipe (FIFO), not a regular file"),
        ("to_pipe", "this is a named pipe (FIFO), not a regular file"),
        ("socket", "this is a socket, not a regular file"),
        ("round", "this is a link that leads back to itself"),
        (".", "this is a folder, not a file"),
    ];
    for (name, message) in expected {
        assert_eq!(refused(&place(name)), message, "{name}");
    }
    for device in ["/dev/zero", "/dev/null"] {
        assert_eq!(refused(Path::new(device)), "this is a device, not a regular file", "{device}");
    }
    assert_eq!(open(&place("dangling")).unwrap_err().kind(), ErrorKind::NotFound);
    fs::write(place("closed"), "x").unwrap();
    fs::set_permissions(place("closed"), fs::Permissions::from_mode(0o0)).unwrap();
    // Root may read files without permissions.
    let closed = open(&place("closed")).map_err(|error| error.kind());
    assert!(closed.is_ok() || closed.is_err_and(|kind| kind == ErrorKind::PermissionDenied));
}
