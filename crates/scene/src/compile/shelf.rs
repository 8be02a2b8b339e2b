//! Files that were read, each once.

use super::meshes::{explain, state};
use crate::import::Limits;
use crate::store::Store;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::SystemTime;

/// Files of one sort by their true names. Clones share them.
#[derive(Debug)]
pub struct Shelf<T>(Arc<Mutex<BTreeMap<PathBuf, Arc<Shelved<T>>>>>);

/// A file that was read.
#[derive(Debug)]
pub struct Shelved<T> {
    /// The hash of its content; zeros when it could not be read.
    pub digest: [u8; 32],
    /// What it holds; or why nothing, in words that name the file.
    pub content: Result<Arc<T>, String>,
    /// How long the file was and when it was last written to, before it was read.
    state: Option<(u64, SystemTime)>,
}

impl<T> Clone for Shelf<T> {
    fn clone(&self) -> Self {
        Self(Arc::clone(&self.0))
    }
}

impl<T> Default for Shelf<T> {
    fn default() -> Self {
        Self(Arc::default())
    }
}

impl<T> Shelf<T> {
    /// Those whose files have not changed.
    pub fn renewed(&self) -> Self {
        let same = |path: &PathBuf, item: &Shelved<T>| item.state.is_some() && item.state == state(path);
        let entries = self.entries();
        let kept = entries.iter().filter(|(path, item)| same(path, item));
        Self(Arc::new(Mutex::new(kept.map(|(path, item)| (path.clone(), Arc::clone(item))).collect())))
    }

    /// What a file holds: what `read` makes of its bytes, or says is wrong with the file. As with meshes, files are read
    /// without the lock.
    pub fn load(
        &self,
        path: &Path,
        store: &Store,
        limits: &Limits,
        read: impl FnOnce(&[u8]) -> Result<T, String>,
    ) -> Arc<Shelved<T>> {
        self.known_or(store.true_name(path), || {
            let state = state(path);
            match store.mesh(path, limits) {
                Ok(bytes) => {
                    let digest = blake3::hash(&bytes).into();
                    Shelved { digest, content: read(&bytes).map(Arc::new), state }
                }
                Err(error) => Shelved { digest: [0; 32], content: Err(explain(&error)), state },
            }
        })
    }

    /// Content of an asset at `path`, with the hash of the asset: what `make` makes of it.
    pub fn keep(&self, path: &Path, digest: [u8; 32], make: impl FnOnce() -> Result<T, String>) -> Arc<Shelved<T>> {
        self.known_or(path.to_owned(), || Shelved { digest, content: make().map(Arc::new), state: None })
    }

    /// Content of a name, made without the lock where it is not known yet.
    fn known_or(&self, name: PathBuf, make: impl FnOnce() -> Shelved<T>) -> Arc<Shelved<T>> {
        if let Some(known) = self.entries().get(&name) {
            return Arc::clone(known);
        }
        let item = Arc::new(make());
        Arc::clone(self.entries().entry(name).or_insert(item))
    }

    fn entries(&self) -> MutexGuard<'_, BTreeMap<PathBuf, Arc<Shelved<T>>>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
