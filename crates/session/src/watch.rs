//! The files of a scene, watched. Editors write beside a file and rename, so it is the folders that are watched.

use notify::{Event, EventKind, RecommendedWatcher, RecursiveMode, Watcher};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// How long it must be quiet after a change: what is written in pieces is read once.
const QUIET: Duration = Duration::from_millis(25);

/// The files of a scene, watched until it is dropped.
pub struct Watch {
    watcher: RecommendedWatcher,
    folders: BTreeSet<PathBuf>,
    files: Arc<Mutex<BTreeSet<PathBuf>>>,
}

impl Watch {
    /// Calls `changed` some time after any of the files has, which are none yet.
    pub fn new(changed: impl Fn() + Send + 'static) -> Option<Self> {
        let files = Arc::new(Mutex::new(BTreeSet::new()));
        let (sender, receiver) = channel();
        let watcher = notify::recommended_watcher(handler(Arc::clone(&files), sender)).ok()?;
        let wait = move || {
            while receiver.recv().is_ok() {
                loop {
                    match receiver.recv_timeout(QUIET) {
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

    /// Watches these files, and no others.
    pub fn set(&mut self, files: &[PathBuf]) {
        let files: BTreeSet<PathBuf> = files.iter().flat_map(|file| names(file)).collect();
        let folders: BTreeSet<PathBuf> = files.iter().filter_map(|file| file.parent()).map(Path::to_owned).collect();
        for folder in self.folders.difference(&folders) {
            // A folder that is gone is no longer watched anyway.
            let _ = self.watcher.unwatch(folder);
        }
        for folder in folders.difference(&self.folders) {
            // What cannot be watched is not shown by itself; `Edit::Reload` is still there.
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
            // Nobody listens only when the watch is being dropped.
            let _ = sender.send(());
        }
    }
}

/// The names by which the system may speak of a file: where it stands, and where a link leads.
fn names(file: &Path) -> Vec<PathBuf> {
    let beside = || Some(std::fs::canonicalize(folder(file)).ok()?.join(file.file_name()?));
    [beside(), std::fs::canonicalize(file).ok()].into_iter().flatten().collect()
}

fn folder(file: &Path) -> &Path {
    file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}
