//! Cache of files, each read once.

use super::meshes::read_error_message;
use crate::store::Store;
use juggler_math::BuildControl;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::SystemTime;

/// Cached files of one type by canonical path. Clones share them.
#[derive(Debug)]
pub struct FileCache<T>(Arc<Mutex<BTreeMap<PathBuf, Arc<CachedFile<T>>>>>);

/// Cached file.
#[derive(Debug)]
pub struct CachedFile<T> {
    /// Hash of the content; zeros if the file could not be read.
    pub digest: [u8; 32],
    /// Content, or an error message that names the file.
    pub content: Result<Arc<T>, String>,
    /// Length and modification time, taken before the file was read; `None` for an asset.
    stamp: Option<(u64, SystemTime)>,
}

impl<T> Clone for FileCache<T> {
    fn clone(&self) -> Self {
        Self(Arc::clone(&self.0))
    }
}

impl<T> Default for FileCache<T> {
    fn default() -> Self {
        Self(Arc::default())
    }
}

impl<T> FileCache<T> {
    /// Cache without the files that have changed.
    pub fn without_changed_files(&self) -> Self {
        let same = |path: &PathBuf, item: &CachedFile<T>| item.stamp.is_some() && item.stamp == file_stamp(path);
        let entries = self.entries();
        let kept = entries.iter().filter(|(path, item)| same(path, item));
        Self(Arc::new(Mutex::new(kept.map(|(path, item)| (path.clone(), Arc::clone(item))).collect())))
    }

    /// Content of a file of at most `limit` bytes, which `read` converts from bytes or rejects with
    /// a message. Reads the file without holding the lock, as for meshes.
    pub fn load(
        &self,
        path: &Path,
        store: &Store,
        limit: u64,
        read: impl FnOnce(&[u8]) -> Result<T, String>,
    ) -> Arc<CachedFile<T>> {
        self.get_or_insert_with(store.canonical_name(path), || {
            let stamp = file_stamp(path);
            match store.read_bytes(path, limit) {
                Ok(bytes) => {
                    let digest = blake3::hash(&bytes).into();
                    CachedFile { digest, content: read(&bytes).map(Arc::new), stamp }
                }
                Err(error) => {
                    CachedFile { digest: [0; 32], content: Err(read_error_message(path, &error, store)), stamp }
                }
            }
        })
    }

    /// Content of an asset at `path` with the asset's hash, created by `make`.
    pub fn insert_asset(
        &self,
        path: &Path,
        digest: [u8; 32],
        make: impl FnOnce() -> Result<T, String>,
    ) -> Arc<CachedFile<T>> {
        self.get_or_insert_with(path.to_owned(), || CachedFile { digest, content: make().map(Arc::new), stamp: None })
    }

    /// Content of a name. Creates missing content without holding the lock.
    fn get_or_insert_with(&self, name: PathBuf, make: impl FnOnce() -> CachedFile<T>) -> Arc<CachedFile<T>> {
        if let Some(known) = self.entries().get(&name) {
            return Arc::clone(known);
        }
        let item = Arc::new(make());
        Arc::clone(self.entries().entry(name).or_insert(item))
    }

    fn entries(&self) -> MutexGuard<'_, BTreeMap<PathBuf, Arc<CachedFile<T>>>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// BLAKE3 hash of the content of a file; of its first part if `control` is cancelled.
pub fn hash(bytes: &[u8], control: &BuildControl) -> [u8; 32] {
    const PART: usize = 1 << 22;
    let mut hasher = blake3::Hasher::new();
    for part in bytes.chunks(PART).take_while(|_| !control.is_cancelled()) {
        hasher.update(part);
    }
    hasher.finalize().into()
}

/// Length and modification time of a file.
pub(crate) fn file_stamp(path: &Path) -> Option<(u64, SystemTime)> {
    let metadata = std::fs::metadata(path).ok()?;
    Some((metadata.len(), metadata.modified().ok()?))
}
