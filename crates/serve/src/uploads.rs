//! Uploads: their memory, and the files that wait until a page opens them.

use crate::server::Limits;
use juggler_session::SceneFiles;
use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use tokio::sync::{OwnedSemaphorePermit, Semaphore};

/// Unit in which memory is reserved, in bytes.
const UNIT: u64 = 4096;
/// Maximum number of uploads whose files wait.
const MAX_KEPT: usize = 2;

/// Uploads that are received, and the files of the latest complete ones.
pub struct Uploads {
    /// Free memory, in units.
    free: Arc<Semaphore>,
    kept: Mutex<Kept>,
}

/// Files of complete uploads.
#[derive(Default)]
struct Kept {
    /// Number of the latest upload.
    latest: u64,
    /// Files with their numbers and their memory, the oldest first.
    files: VecDeque<(u64, SceneFiles, OwnedSemaphorePermit)>,
}

impl Uploads {
    /// No uploads.
    pub fn new(limits: &Limits) -> Self {
        let units = usize::try_from(units(limits.dropped_total_bytes)).unwrap_or(usize::MAX);
        Self { free: Arc::new(Semaphore::new(units.min(Semaphore::MAX_PERMITS))), kept: Mutex::default() }
    }

    /// Reserves memory for an upload. To make room, forgets files that no page has opened, the oldest
    /// first. `None` if other uploads need the memory.
    pub fn reserve(&self, bytes: u64) -> Option<OwnedSemaphorePermit> {
        let units = u32::try_from(units(bytes)).ok()?;
        loop {
            match Arc::clone(&self.free).try_acquire_many_owned(units) {
                Ok(permit) => return Some(permit),
                Err(_) => drop(self.kept().files.pop_front()?),
            }
        }
    }

    /// Keeps the files of an upload with their memory, and returns the number under which a page opens
    /// them.
    pub fn keep(&self, files: SceneFiles, memory: OwnedSemaphorePermit) -> u64 {
        let mut kept = self.kept();
        if kept.files.len() >= MAX_KEPT {
            kept.files.pop_front();
        }
        kept.latest += 1;
        let number = kept.latest;
        kept.files.push_back((number, files, memory));
        number
    }

    /// Takes files by their number; `None` if later ones have replaced them.
    pub fn take(&self, number: u64) -> Option<SceneFiles> {
        let mut kept = self.kept();
        let index = kept.files.iter().position(|(known, ..)| *known == number)?;
        kept.files.remove(index).map(|(_, files, _)| files)
    }

    fn kept(&self) -> MutexGuard<'_, Kept> {
        self.kept.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn units(bytes: u64) -> u64 {
    bytes.div_ceil(UNIT)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn uploads(bytes: u64) -> Uploads {
        Uploads::new(&Limits { dropped_total_bytes: bytes, ..Limits::default() })
    }

    fn files(name: &str) -> SceneFiles {
        SceneFiles { name: name.to_owned(), files: std::iter::empty().collect() }
    }

    #[test]
    fn files_that_wait_give_way_to_uploads_and_uploads_do_not() {
        let all = uploads(4 * UNIT);
        let first = all.keep(files("a"), all.reserve(2 * UNIT).unwrap());
        let second = all.reserve(2 * UNIT).unwrap();
        let third = all.reserve(UNIT + 1).unwrap();
        assert_eq!(all.take(first), None, "the files gave way");
        assert!(all.reserve(1).is_none(), "both uploads need all the memory");
        drop(second);
        assert!(all.reserve(2 * UNIT).is_some() && all.reserve(3 * UNIT).is_none());
        drop(third);
        assert!(
            all.reserve(4 * UNIT).is_some() && all.reserve(4 * UNIT + 1).is_none() && all.reserve(u64::MAX).is_none()
        );
    }

    #[test]
    fn the_two_latest_uploads_are_kept_until_they_are_taken() {
        let all = uploads(100 * UNIT);
        let numbers = ["a", "b", "c"].map(|name| all.keep(files(name), all.reserve(UNIT).unwrap()));
        assert_eq!(all.take(numbers[0]), None);
        assert_eq!(all.take(numbers[2]), Some(files("c")));
        assert_eq!((all.take(numbers[2]), all.take(numbers[1])), (None, Some(files("b"))));
        assert!(all.reserve(100 * UNIT).is_some(), "the memory is free again");
    }
}
