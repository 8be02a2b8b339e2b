//! File watching. Editors write a new file and rename it, so the folders are watched rather than
//! the files.

use notify::{Event, EventKind, RecommendedWatcher, RecursiveMode, Watcher};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// Time without events after which a change is reported, so that a file written in pieces is read
/// once.
const DEBOUNCE: Duration = Duration::from_millis(25);

/// Watcher of a scene's files; dropping it stops the watch.
pub struct Watch {
    watcher: RecommendedWatcher,
    folders: BTreeSet<PathBuf>,
    files: Arc<Mutex<BTreeSet<PathBuf>>>,
}

impl Watch {
    /// Creates a watcher without files. It calls `changed` after a change of any watched file.
    pub fn new(changed: impl Fn() + Send + 'static) -> Option<Self> {
        let files = Arc::new(Mutex::new(BTreeSet::new()));
        let (sender, receiver) = channel();
        let watcher = notify::recommended_watcher(handler(Arc::clone(&files), sender)).ok()?;
        let wait = move || {
            while receiver.recv().is_ok() {
                loop {
                    match receiver.recv_timeout(DEBOUNCE) {
                        Ok(()) => {}
                        Err(RecvTimeoutError::Timeout) => break,
                        Err(RecvTimeoutError::Disconnected) => return,
                    }
                }
                changed();
            }
        };
        std::thread::Builder::new().name("session watch".into()).spawn(wait).ok()?;
        Some(Self { watcher, folders: BTreeSet::new(), files })
    }

    /// Replaces the set of watched files.
    pub fn set(&mut self, files: &[PathBuf]) {
        let files: BTreeSet<PathBuf> = files.iter().flat_map(|file| names(file)).collect();
        let folders: BTreeSet<PathBuf> = files.iter().filter_map(|file| file.parent()).map(Path::to_owned).collect();
        for folder in self.folders.difference(&folders) {
            // A deleted folder is no longer watched.
            let _ = self.watcher.unwatch(folder);
        }
        for folder in folders.difference(&self.folders) {
            // A folder that cannot be watched is not reloaded automatically; `Edit::Reload` still
            // works.
            let _ = self.watcher.watch(folder, RecursiveMode::NonRecursive);
        }
        self.folders = folders;
        *self.files.lock().unwrap_or_else(PoisonError::into_inner) = files;
    }
}

fn handler(files: Arc<Mutex<BTreeSet<PathBuf>>>, sender: Sender<()>) -> impl Fn(notify::Result<Event>) {
    move |event| {
        let Ok(event) = event else { return };
        if matches!(event.kind, EventKind::Access(_)) {
            return;
        }
        let files = files.lock().unwrap_or_else(PoisonError::into_inner);
        if event.paths.iter().any(|path| files.contains(path)) {
            // The receiver is gone only while the watcher is being dropped.
            let _ = sender.send(());
        }
    }
}

/// Returns the names under which events may report a file: its own path and the target of a link.
fn names(file: &Path) -> Vec<PathBuf> {
    let beside = || Some(std::fs::canonicalize(folder(file)).ok()?.join(file.file_name()?));
    [beside(), std::fs::canonicalize(file).ok()].into_iter().flatten().collect()
}

fn folder(file: &Path) -> &Path {
    file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}
