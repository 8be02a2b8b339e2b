//! Folder for the frames of a movie until it is complete, with a lock against concurrent processes
//! that make the same movie.

use crate::failure::Failure;
use juggler::imaging::atomic::is_still_at;
use std::fs::{self, File, TryLockError};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::thread;
use std::time::{Duration, Instant};

/// Lock file in a folder of frames.
const LOCK: &str = ".lock";
/// Timeout of the lock.
const LOCK_TIMEOUT: Duration = Duration::from_secs(2);

/// Purpose for which a process uses a folder of frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// Renders frames, beside other processes.
    Shared,
    /// Encodes the movie and removes the frames.
    Exclusive,
}

/// A locked folder of frames. The operating system releases the lock when the process ends.
pub struct FrameFolder {
    path: String,
    _lock: Option<File>,
}

impl FrameFolder {
    /// Creates the folder if necessary and locks it. If another process is about to remove it, it
    /// is created again.
    ///
    /// # Errors
    ///
    /// Fails if another process holds the lock until the timeout.
    pub fn open(path: &str, access: Access) -> Result<Self, Failure> {
        let deadline = Instant::now() + LOCK_TIMEOUT;
        loop {
            match Self::locked(path, access)? {
                Some(folder) => return Ok(folder),
                None if Instant::now() < deadline => thread::sleep(LOCK_TIMEOUT / 40),
                None => return Err(locked_error(path)),
            }
        }
    }

    /// Tries once to lock the folder; `None` if another process holds the lock or has just removed
    /// the folder.
    fn locked(path: &str, access: Access) -> Result<Option<Self>, Failure> {
        match fs::create_dir(path) {
            Err(error) if error.kind() != ErrorKind::AlreadyExists => {
                return Err(Failure::file("create", path, &error));
            }
            _ => {}
        }
        let name = format!("{path}/{LOCK}");
        let mut file = match File::options().create(true).append(true).open(&name) {
            Ok(file) => file,
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
            Err(error) => return Err(Failure::file("write", &name, &error)),
        };
        let locked = if access == Access::Shared { file.try_lock_shared() } else { file.try_lock() };
        match locked {
            Err(TryLockError::WouldBlock) => Ok(None),
            // Continue without a lock where the file system supports none: frames are written
            // atomically.
            Err(TryLockError::Error(_)) => Ok(Some(Self { path: path.into(), _lock: None })),
            // The lock file was removed while this process waited for it.
            Ok(()) if !is_still_at(&file, Path::new(&name)) => Ok(None),
            Ok(()) => {
                // Store the process number for error messages; ignore write errors.
                let who = if access == Access::Exclusive { format!("{}\n", std::process::id()) } else { String::new() };
                let _ = file.set_len(0).and_then(|()| file.write_all(who.as_bytes()));
                Ok(Some(Self { path: path.into(), _lock: Some(file) }))
            }
        }
    }

    /// Removes these frames, the files that killed processes left, and the folder if it is empty
    /// then.
    pub fn clear(self, frames: &[PathBuf]) -> Result<(), Failure> {
        for frame in frames {
            fs::remove_file(frame).map_err(|error| Failure::file("remove", frame.display(), &error))?;
            forget(&frame.with_extension("jfilm").to_string_lossy());
        }
        for entry in fs::read_dir(&self.path).into_iter().flatten().flatten() {
            let name = entry.file_name();
            let name = name.to_string_lossy();
            if name.starts_with(".frame_") && name.ends_with(".part") || name == LOCK {
                let _ = fs::remove_file(entry.path());
            }
        }
        let _ = fs::remove_dir(&self.path);
        Ok(())
    }
}

/// Error that names the process which holds the lock.
fn locked_error(path: &str) -> Failure {
    let number = fs::read_to_string(format!("{path}/{LOCK}")).unwrap_or_default();
    let number = number.trim().parse::<u32>().map(|number| format!(" (process {number})")).unwrap_or_default();
    Failure::System(format!(
        "other processes are writing to `{path}`{number}: run the same command again when they are done"
    ))
}

/// Removes a checkpoint and its previous version.
pub fn forget(file: &str) {
    for file in [file.to_owned(), format!("{file}.previous")] {
        // Ignore errors: the file may not exist.
        let _ = fs::remove_file(file);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn waiting_process_recreates_a_removed_folder() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("film.gif.frames").to_string_lossy().into_owned();
        let first = FrameFolder::open(&path, Access::Exclusive).unwrap();
        let second = thread::spawn({
            let path = path.clone();
            move || FrameFolder::open(&path, Access::Exclusive)
        });
        // Both orders must work: the second thread waits for the lock, or starts after the removal.
        thread::sleep(LOCK_TIMEOUT / 10);
        first.clear(&[]).unwrap();
        let second = second.join().unwrap().unwrap();
        assert!(Path::new(&path).join(LOCK).exists());
        second.clear(&[]).unwrap();
        assert!(!Path::new(&path).exists());
    }

    #[test]
    fn the_error_names_the_process_at_work() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("film.gif.frames").to_string_lossy().into_owned();
        let _first = FrameFolder::open(&path, Access::Exclusive).unwrap();
        let message = format!("{:?}", FrameFolder::open(&path, Access::Exclusive).map(drop).unwrap_err());
        let who = format!("(process {})", std::process::id());
        assert!(message.contains("writing to") && message.contains(&who), "{message}");
    }
}
