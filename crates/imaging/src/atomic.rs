//! Files that appear whole or not at all: written beside their place, then renamed. A run that
//! fails or is interrupted leaves what was there before. A file in the making is called
//! `.NAME.part` and locked by the process that writes it; the next process to write NAME removes
//! one that a killed process has left.

use crate::regular;
use std::ffi::OsStr;
use std::fs::{self, File, Permissions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// A file in the making, in the folder of its place; it vanishes when dropped without [`AtomicFile::commit`].
#[derive(Debug)]
pub struct AtomicFile {
    temporary: NamedTempFile,
    place: PathBuf,
}

impl AtomicFile {
    /// Begins a file for `place`. A link is followed: what it points to will be replaced.
    pub fn create(place: &Path) -> io::Result<Self> {
        let place = fs::canonicalize(place).unwrap_or_else(|_| place.to_owned());
        let name = place.file_name().ok_or_else(|| io::Error::from(io::ErrorKind::IsADirectory))?;
        let existing = fs::metadata(&place).ok();
        if existing.as_ref().is_some_and(|m| !m.is_file()) {
            return Err(io::Error::from(io::ErrorKind::IsADirectory));
        }
        let folder = place.parent().filter(|f| !f.as_os_str().is_empty()).unwrap_or_else(|| Path::new("."));
        // A new file gets the rights that any new file gets, not the narrow ones of temporary files.
        let rights = existing.map(|m| m.permissions()).or_else(usual_rights);
        // The system's reason alone: the temporary name is of no use to anybody.
        let temporary = beside(folder, name, rights.as_ref()).map_err(|error| io::Error::from(error.kind()))?;
        Ok(Self { temporary, place })
    }

    /// Another handle to write with; buffered writers must be flushed before the commit.
    pub fn handle(&self) -> io::Result<File> {
        self.temporary.as_file().try_clone()
    }

    /// Puts the file in its place, over what was there.
    pub fn commit(self) -> io::Result<()> {
        self.temporary.persist(&self.place).map(drop).map_err(|e| e.error)
    }

    /// As [`AtomicFile::commit`], and waits until the disk has it: survives a loss of power.
    pub fn commit_durably(self) -> io::Result<()> {
        self.temporary.as_file().sync_all()?;
        self.commit()
    }
}

/// A new file beside its place: `.NAME.part`, or with a random part in its name where another
/// process is writing that.
fn beside(folder: &Path, name: &OsStr, rights: Option<&Permissions>) -> io::Result<NamedTempFile> {
    let mut prefix = std::ffi::OsString::from(".");
    prefix.push(name);
    let create = |random: usize| {
        let mut builder = tempfile::Builder::new();
        builder.prefix(&prefix).suffix(".part").rand_bytes(random);
        if let Some(rights) = rights {
            builder.permissions(rights.clone());
        }
        builder.tempfile_in(folder)
    };
    let mut usual = prefix.clone();
    usual.push(".part");
    let usual = folder.join(usual);
    for _ in 0..2 {
        match create(0) {
            Ok(file) if is_ours(&file) => return Ok(file),
            // Another process took it for one that was left.
            Ok(file) => drop(file.keep()),
            Err(error) if error.kind() != io::ErrorKind::AlreadyExists => return Err(error),
            Err(_) if remove_abandoned(&usual) => {}
            Err(_) => break,
        }
    }
    create(6)
}

/// Locks a file that was just made, until it is closed. `false` where another process has it or has
/// removed it.
fn is_ours(file: &NamedTempFile) -> bool {
    // Some network disks know no locks: nobody takes anything away there.
    !matches!(file.as_file().try_lock(), Err(fs::TryLockError::WouldBlock)) && is_same(file.as_file(), file.path())
}

/// Removes a file that no process has locked; whether it did.
fn remove_abandoned(path: &Path) -> bool {
    let is_file = fs::symlink_metadata(path).is_ok_and(|file| file.is_file());
    let Some(file) = is_file.then(|| regular::open(path).ok()).flatten() else { return false };
    file.try_lock().is_ok() && is_same(&file, path) && fs::remove_file(path).is_ok()
}

/// Whether the file of that name is this one.
#[cfg(unix)]
fn is_same(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let (here, there) = (file.metadata(), fs::symlink_metadata(path));
    here.is_ok_and(|here| there.is_ok_and(|there| (here.dev(), here.ino()) == (there.dev(), there.ino())))
}

/// An open file cannot be removed there.
#[cfg(not(unix))]
fn is_same(_file: &File, _path: &Path) -> bool {
    true
}

#[cfg(unix)]
fn usual_rights() -> Option<Permissions> {
    use std::os::unix::fs::PermissionsExt;
    Some(Permissions::from_mode(0o666))
}

#[cfg(not(unix))]
fn usual_rights() -> Option<Permissions> {
    None
}

/// Whether bytes go through the place, to a device or a named pipe, instead of staying there.
pub(crate) fn is_passage(place: &Path) -> bool {
    fs::metadata(place).is_ok_and(|m| !m.is_file() && !m.is_dir())
}

/// Writes a small file at once, whole or not at all. Devices and named pipes are written as they are.
pub fn write(place: &Path, bytes: &[u8]) -> io::Result<()> {
    if is_passage(place) {
        return File::options().write(true).open(place)?.write_all(bytes);
    }
    let file = AtomicFile::create(place)?;
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
        let place = folder.path().join("a.txt");
        fs::write(&place, "old").unwrap();
        let file = AtomicFile::create(&place).unwrap();
        file.handle().unwrap().write_all(b"new").unwrap();
        assert_eq!(fs::read_to_string(&place).unwrap(), "old");
        file.commit().unwrap();
        assert_eq!(fs::read_to_string(&place).unwrap(), "new");
        assert_eq!(names(folder.path()), ["a.txt"]);
    }

    #[test]
    fn what_is_not_committed_leaves_no_trace() {
        let folder = tempfile::tempdir().unwrap();
        let place = folder.path().join("a.txt");
        let file = AtomicFile::create(&place).unwrap();
        file.handle().unwrap().write_all(b"half").unwrap();
        assert_eq!(names(folder.path()).len(), 1);
        drop(file);
        assert_eq!(names(folder.path()), [""; 0]);
    }

    #[test]
    fn what_a_killed_process_left_is_cleared_away() {
        let folder = tempfile::tempdir().unwrap();
        let place = folder.path().join("a.txt");
        // Nobody has it locked: whoever wrote it is gone.
        fs::write(folder.path().join(".a.txt.part"), "half").unwrap();
        fs::write(folder.path().join(".b.txt.part"), "not ours").unwrap();
        write(&place, b"whole").unwrap();
        assert_eq!(fs::read_to_string(&place).unwrap(), "whole");
        assert_eq!(names(folder.path()), [".b.txt.part", "a.txt"]);
    }

    #[test]
    fn what_another_writes_is_left_alone() {
        let folder = tempfile::tempdir().unwrap();
        let place = folder.path().join("a.txt");
        let (first, second) = (AtomicFile::create(&place).unwrap(), AtomicFile::create(&place).unwrap());
        assert_eq!(names(folder.path()).len(), 2);
        first.handle().unwrap().write_all(b"first").unwrap();
        second.handle().unwrap().write_all(b"second").unwrap();
        second.commit().unwrap();
        assert_eq!(fs::read_to_string(&place).unwrap(), "second");
        first.commit().unwrap();
        assert_eq!(fs::read_to_string(&place).unwrap(), "first");
        assert_eq!(names(folder.path()), ["a.txt"]);
    }

    #[cfg(unix)]
    #[test]
    fn a_link_of_that_name_is_not_followed() {
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
    fn links_are_followed_and_rights_kept() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = tempfile::tempdir().unwrap();
        let (place, link) = (folder.path().join("a.txt"), folder.path().join("link"));
        fs::write(&place, "old").unwrap();
        fs::set_permissions(&place, Permissions::from_mode(0o640)).unwrap();
        symlink(&place, &link).unwrap();
        write(&link, b"new").unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read_to_string(&place).unwrap(), "new");
        assert_eq!(fs::metadata(&place).unwrap().permissions().mode() & 0o777, 0o640);
        // A new file is as readable as any other new file.
        let (plain, ours) = (folder.path().join("plain"), folder.path().join("ours"));
        File::create(&plain).unwrap();
        write(&ours, b"x").unwrap();
        let mode = |p: &Path| fs::metadata(p).unwrap().permissions().mode();
        assert_eq!(mode(&plain), mode(&ours));
    }
}
