//! Atomic file writes: data go to a temporary file that replaces the destination by renaming, so
//! that a failed or interrupted run leaves the old file untouched. The temporary file `.NAME.part`
//! is locked by its writer; the next process that writes NAME removes one left by a killed process.
//! The temporary file of a very long NAME has the beginning of that name.

use crate::regular;
use std::ffi::{OsStr, OsString};
use std::fs::{self, File, Permissions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// Maximum number of bytes of a destination's name in the name of its temporary file. File systems
/// allow 255 bytes, of which the leading period, a random suffix and `.part` need 12.
const MAX_NAME_BYTES: usize = 243;
/// Maximum number of symbolic links in a row, as on Linux.
const MAX_LINKS: usize = 40;

/// A temporary file beside its destination. Dropping it without [`AtomicFile::commit`] removes it.
#[derive(Debug)]
pub struct AtomicFile {
    temporary: NamedTempFile,
    path: PathBuf,
}

impl AtomicFile {
    /// Creates a temporary file for `path`. If `path` is a symbolic link, its target will be
    /// replaced, or created if it does not exist.
    ///
    /// # Errors
    ///
    /// `path` is not a regular file or the temporary file cannot be created.
    pub fn create(path: &Path) -> io::Result<Self> {
        let path = link_target(path)?;
        let name = path.file_name().ok_or_else(|| io::Error::from(io::ErrorKind::IsADirectory))?;
        let existing = fs::metadata(&path).ok();
        if existing.as_ref().is_some_and(|m| !m.is_file()) {
            return Err(io::Error::from(io::ErrorKind::IsADirectory));
        }
        let folder = path.parent().filter(|f| !f.as_os_str().is_empty()).unwrap_or_else(|| Path::new("."));
        // Use the permissions of regular new files, not the stricter ones of temporary files.
        let permissions = existing.map(|m| m.permissions()).or_else(default_permissions);
        // Report only the kind of error, since the temporary name means nothing to the user.
        let temporary =
            create_temporary(folder, name, permissions.as_ref()).map_err(|error| io::Error::from(error.kind()))?;
        Ok(Self { temporary, path })
    }

    /// Returns another handle for writing. Flush buffered writers before the commit.
    pub fn handle(&self) -> io::Result<File> {
        self.temporary.as_file().try_clone()
    }

    /// Renames the file to its destination, replacing an existing file.
    pub fn commit(self) -> io::Result<()> {
        self.temporary.persist(&self.path).map(drop).map_err(|e| e.error)
    }

    /// Like [`AtomicFile::commit`], but first syncs the file to disk, so that it survives a power
    /// loss.
    pub fn commit_durably(self) -> io::Result<()> {
        self.temporary.as_file().sync_all()?;
        self.commit()
    }
}

/// Path that a chain of symbolic links ends at, whether a file exists there or not.
fn link_target(path: &Path) -> io::Result<PathBuf> {
    let mut end = path.to_owned();
    for _ in 0..=MAX_LINKS {
        match fs::read_link(&end) {
            // A relative target starts at the folder of the link.
            Ok(target) => end = end.parent().unwrap_or(Path::new("")).join(target),
            Err(_) => return Ok(end),
        }
    }
    // Fails with the system's message about loops.
    fs::canonicalize(path)
}

/// Creates `.NAME.part` beside the destination, or a file with a random suffix if another process
/// is writing that one.
fn create_temporary(folder: &Path, name: &OsStr, permissions: Option<&Permissions>) -> io::Result<NamedTempFile> {
    let mut prefix = OsString::from(".");
    if name.len() <= MAX_NAME_BYTES {
        prefix.push(name);
    } else {
        let name = name.to_string_lossy();
        prefix.push(name.get(..name.floor_char_boundary(MAX_NAME_BYTES)).unwrap_or_default());
    }
    let create = |random: usize| {
        let mut builder = tempfile::Builder::new();
        builder.prefix(&prefix).suffix(".part").rand_bytes(random);
        if let Some(permissions) = permissions {
            builder.permissions(permissions.clone());
        }
        builder.tempfile_in(folder)
    };
    let mut path = prefix.clone();
    path.push(".part");
    let path = folder.join(path);
    for _ in 0..2 {
        match create(0) {
            Ok(file) if is_ours(&file) => return Ok(file),
            // Another process considered the file abandoned and removed it.
            Ok(file) => drop(file.keep()),
            Err(error) if error.kind() != io::ErrorKind::AlreadyExists => return Err(error),
            Err(_) if remove_abandoned(&path) => {}
            Err(_) => break,
        }
    }
    create(6)
}

/// Locks a new file until it is closed; `false` if another process holds the lock or removed the
/// file.
fn is_ours(file: &NamedTempFile) -> bool {
    // On file systems without locks no process removes files, so treat an unlocked file as ours.
    !matches!(file.as_file().try_lock(), Err(fs::TryLockError::WouldBlock)) && is_still_at(file.as_file(), file.path())
}

/// Removes a file that no process has locked; returns whether it did.
fn remove_abandoned(path: &Path) -> bool {
    let is_file = fs::symlink_metadata(path).is_ok_and(|file| file.is_file());
    let Some(file) = is_file.then(|| regular::open(path).ok()).flatten() else { return false };
    file.try_lock().is_ok() && is_still_at(&file, path) && fs::remove_file(path).is_ok()
}

/// Whether `path` still refers to the open `file`: another process may have removed or replaced the
/// file since it was opened. Follows symbolic links.
#[cfg(unix)]
pub fn is_still_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let (opened, found) = (file.metadata(), fs::metadata(path));
    opened.is_ok_and(|opened| found.is_ok_and(|found| (opened.dev(), opened.ino()) == (found.dev(), found.ino())))
}

/// Whether `path` still refers to the open `file`; always true, since systems other than Unix do
/// not let a process remove a file that another one has open.
#[cfg(not(unix))]
pub fn is_still_at(_file: &File, _path: &Path) -> bool {
    true
}

#[cfg(unix)]
fn default_permissions() -> Option<Permissions> {
    use std::os::unix::fs::PermissionsExt;
    Some(Permissions::from_mode(0o666))
}

#[cfg(not(unix))]
fn default_permissions() -> Option<Permissions> {
    None
}

/// Whether `path` is a device or a named pipe rather than a file.
pub(crate) fn is_device_or_pipe(path: &Path) -> bool {
    fs::metadata(path).is_ok_and(|m| !m.is_file() && !m.is_dir())
}

/// Writes a small file atomically; devices and named pipes are written directly.
pub fn write(path: &Path, bytes: &[u8]) -> io::Result<()> {
    if is_device_or_pipe(path) {
        return File::options().write(true).open(path)?.write_all(bytes);
    }
    let file = AtomicFile::create(path)?;
    file.handle()?.write_all(bytes)?;
    file.commit()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap();
        let mut names: Vec<String> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn the_old_file_stays_until_the_commit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        fs::write(&path, "old").unwrap();
        let file = AtomicFile::create(&path).unwrap();
        file.handle().unwrap().write_all(b"new").unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "old");
        file.commit().unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "new");
        assert_eq!(names(folder.path()), ["a.txt"]);
    }

    #[test]
    fn uncommitted_file_is_removed() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        let file = AtomicFile::create(&path).unwrap();
        file.handle().unwrap().write_all(b"half").unwrap();
        assert_eq!(names(folder.path()).len(), 1);
        drop(file);
        assert_eq!(names(folder.path()), [""; 0]);
    }

    #[test]
    fn stale_temporary_file_is_removed() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        // The lock is free, so the writer is gone.
        fs::write(folder.path().join(".a.txt.part"), "half").unwrap();
        fs::write(folder.path().join(".b.txt.part"), "not ours").unwrap();
        write(&path, b"whole").unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "whole");
        assert_eq!(names(folder.path()), [".b.txt.part", "a.txt"]);
    }

    #[test]
    fn temporary_file_of_another_writer_is_kept() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        let (first, second) = (AtomicFile::create(&path).unwrap(), AtomicFile::create(&path).unwrap());
        assert_eq!(names(folder.path()).len(), 2);
        first.handle().unwrap().write_all(b"first").unwrap();
        second.handle().unwrap().write_all(b"second").unwrap();
        second.commit().unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "second");
        first.commit().unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "first");
        assert_eq!(names(folder.path()), ["a.txt"]);
    }

    #[cfg(unix)]
    #[test]
    fn symbolic_link_at_the_temporary_name_is_not_followed() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("theirs"), "theirs").unwrap();
        std::os::unix::fs::symlink("theirs", folder.path().join(".a.txt.part")).unwrap();
        write(&folder.path().join("a.txt"), b"ours").unwrap();
        assert_eq!(fs::read_to_string(folder.path().join("theirs")).unwrap(), "theirs");
        assert_eq!(fs::read_to_string(folder.path().join("a.txt")).unwrap(), "ours");
    }

    #[test]
    fn folders_and_missing_folders_are_errors() {
        let folder = tempfile::tempdir().unwrap();
        assert!(AtomicFile::create(folder.path()).is_err());
        assert!(AtomicFile::create(&folder.path().join("none/a.txt")).is_err());
    }

    #[cfg(unix)]
    #[test]
    fn links_to_missing_files_create_the_files() {
        use std::os::unix::fs::symlink;
        let folder = tempfile::tempdir().unwrap();
        let place = |name: &str| folder.path().join(name);
        fs::create_dir(place("out")).unwrap();
        symlink("second", place("first")).unwrap();
        symlink("out/a.txt", place("second")).unwrap();
        symlink(place("out/b.txt"), place("absolute")).unwrap();
        symlink("none/a.txt", place("lost")).unwrap();
        symlink("round", place("round")).unwrap();
        for (link, target) in [("first", "out/a.txt"), ("absolute", "out/b.txt")] {
            write(&place(link), b"new").unwrap();
            assert!(fs::symlink_metadata(place(link)).unwrap().is_symlink(), "{link}");
            assert_eq!(fs::read_to_string(place(target)).unwrap(), "new", "{link}");
        }
        let failure = |link: &str| write(&place(link), b"new").unwrap_err();
        assert_eq!(failure("lost").kind(), io::ErrorKind::NotFound);
        assert!(failure("round").to_string().contains("symbolic links"), "{}", failure("round"));
        assert_eq!(names(folder.path()), ["absolute", "first", "lost", "out", "round", "second"]);
        assert_eq!(names(&place("out")), ["a.txt", "b.txt"]);
    }

    #[test]
    fn names_may_be_as_long_as_file_systems_allow() {
        let folder = tempfile::tempdir().unwrap();
        // Two bytes per character, cut after half of one.
        for name in ["x".repeat(255), format!("x{}", "ä".repeat(127)), "y".repeat(244)] {
            let path = folder.path().join(&name);
            let (first, second) = (AtomicFile::create(&path).unwrap(), AtomicFile::create(&path).unwrap());
            first.handle().unwrap().write_all(b"first").unwrap();
            first.commit().unwrap();
            second.commit().unwrap();
            assert_eq!(names(folder.path()), [name]);
            fs::remove_file(path).unwrap();
        }
    }

    #[cfg(unix)]
    #[test]
    fn links_are_followed_and_rights_kept() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = tempfile::tempdir().unwrap();
        let (path, link) = (folder.path().join("a.txt"), folder.path().join("link"));
        fs::write(&path, "old").unwrap();
        fs::set_permissions(&path, Permissions::from_mode(0o640)).unwrap();
        symlink(&path, &link).unwrap();
        write(&link, b"new").unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read_to_string(&path).unwrap(), "new");
        assert_eq!(fs::metadata(&path).unwrap().permissions().mode() & 0o777, 0o640);
        // New files get the usual permissions.
        let (plain, ours) = (folder.path().join("plain"), folder.path().join("ours"));
        File::create(&plain).unwrap();
        write(&ours, b"x").unwrap();
        let mode = |p: &Path| fs::metadata(p).unwrap().permissions().mode();
        assert_eq!(mode(&plain), mode(&ours));
    }
}
