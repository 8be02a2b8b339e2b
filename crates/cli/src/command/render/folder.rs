//! The folder in which the frames of a movie wait until it is complete, and the lock by which
//! processes that make the same movie know of each other.

use super::film::forget;
use crate::failure::Failure;
use std::fs::{self, File, TryLockError};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::thread;
use std::time::{Duration, Instant};

/// The file in a folder of frames by which processes know of each other.
const LOCK: &str = ".lock";
/// How long to wait for it.
const PATIENCE: Duration = Duration::from_secs(2);

/// How a process uses a folder of frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Use {
    /// It puts frames there, as others may.
    Shared,
    /// It makes the movie and clears the frames away.
    Alone,
}

/// A folder of frames. The system lets go of the lock when the process ends, however it ends.
pub struct Folder {
    path: String,
    _lock: Option<File>,
}

impl Folder {
    /// Makes it where there is none. Another process that makes the same movie may be about to
    /// clear it away: then it is made anew.
    pub fn open(path: &str, purpose: Use) -> Result<Self, Failure> {
        let patient_until = Instant::now() + PATIENCE;
        loop {
            match Self::locked(path, purpose)? {
                Some(folder) => return Ok(folder),
                None if Instant::now() < patient_until => thread::sleep(PATIENCE / 40),
                None => return Err(others(path)),
            }
        }
    }

    /// The same at once; `None` where the folder is being cleared away or another process has the
    /// lock.
    fn locked(path: &str, purpose: Use) -> Result<Option<Self>, Failure> {
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
        let locked = if purpose == Use::Shared { file.try_lock_shared() } else { file.try_lock() };
        match locked {
            Err(TryLockError::WouldBlock) => Ok(None),
            // Some network disks know no locks; frames appear whole or not at all in any case.
            Err(TryLockError::Error(_)) => Ok(Some(Self { path: path.into(), _lock: None })),
            // A lock that was cleared away while this process waited for it keeps nobody out.
            Ok(()) if !is_same(&file, Path::new(&name)) => Ok(None),
            Ok(()) => {
                // Who has it is told to people only: it does not matter if that cannot be written.
                let who = if purpose == Use::Alone { format!("{}\n", std::process::id()) } else { String::new() };
                let _ = file.set_len(0).and_then(|()| file.write_all(who.as_bytes()));
                Ok(Some(Self { path: path.into(), _lock: Some(file) }))
            }
        }
    }

    /// Clears away what processes that were killed left of these frames, and the folder unless
    /// somebody keeps something else in it.
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

/// Who else is at work in a folder.
fn others(path: &str) -> Failure {
    let number = fs::read_to_string(format!("{path}/{LOCK}")).unwrap_or_default();
    let number = number.trim().parse::<u32>().map(|number| format!(" (process {number})")).unwrap_or_default();
    Failure::System(format!(
        "other processes are at work in `{path}`{number}: the same command can make the movie when they are done"
    ))
}

/// Whether the file of that name is this one.
#[cfg(unix)]
fn is_same(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let (here, there) = (file.metadata(), fs::metadata(path));
    here.is_ok_and(|here| there.is_ok_and(|there| (here.dev(), here.ino()) == (there.dev(), there.ino())))
}

/// An open file cannot be removed there.
#[cfg(not(unix))]
fn is_same(_file: &File, _path: &Path) -> bool {
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_that_is_cleared_away_is_made_anew_by_who_waits_for_it() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("film.gif.frames").to_string_lossy().into_owned();
        let first = Folder::open(&path, Use::Alone).unwrap();
        let second = thread::spawn({
            let path = path.clone();
            move || Folder::open(&path, Use::Alone)
        });
        // The second waits for the lock by then, or comes afterwards: both end well.
        thread::sleep(PATIENCE / 10);
        first.clear(&[]).unwrap();
        let second = second.join().unwrap().unwrap();
        assert!(Path::new(&path).join(LOCK).exists());
        second.clear(&[]).unwrap();
        assert!(!Path::new(&path).exists());
    }

    #[test]
    fn who_is_at_work_is_told() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("film.gif.frames").to_string_lossy().into_owned();
        let _first = Folder::open(&path, Use::Alone).unwrap();
        let message = format!("{:?}", Folder::open(&path, Use::Alone).map(drop).unwrap_err());
        let who = format!("(process {})", std::process::id());
        assert!(message.contains("at work in") && message.contains(&who), "{message}");
    }
}
