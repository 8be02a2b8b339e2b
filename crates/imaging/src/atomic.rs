//! Files that appear whole or not at all: written beside their place, then renamed. A run that fails or is
//! interrupted leaves what was there before.

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
        let mut prefix = std::ffi::OsString::from(".");
        prefix.push(name);
        let mut builder = tempfile::Builder::new();
        builder.prefix(&prefix).suffix(".part");
        // A new file gets the rights that any new file gets, not the narrow ones of temporary files.
        let rights = existing.map(|m| m.permissions()).or_else(usual_rights);
        if let Some(rights) = rights {
            builder.permissions(rights);
        }
        // The system's reason alone: the temporary name is of no use to anybody.
        let temporary = builder.tempfile_in(folder).map_err(|error| io::Error::from(error.kind()))?;
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
