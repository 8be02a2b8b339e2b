//! The handle that windows, pages and scripts hold.

use crate::{Edit, Frame, Probe, Status};
use juggler::scene::Scene;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

/// What a session is opened with.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Width and height, instead of the scene's.
    pub size: Option<[u32; 2]>,
    /// Threads that render; all cores when 0.
    pub threads: usize,
    /// How long a frame may take while the camera moves; resolution is lowered to keep it.
    pub budget: Duration,
    /// Whether the scene's files are watched, and edits of them shown.
    pub watch: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self { size: None, threads: 0, budget: Duration::from_millis(30), watch: false }
    }
}

/// Why a picture was not saved.
#[derive(Debug, thiserror::Error)]
pub enum SaveError {
    /// There is none yet.
    #[error("there is no picture yet")]
    Nothing,
    /// It cannot be written.
    #[error(transparent)]
    Image(#[from] juggler::imaging::ImageError),
}

/// A scene that is looked at. Cheap to clone: all clones are the same session, which ends with the last of them.
#[derive(Clone)]
pub struct Session {
    shared: Arc<()>,
}

impl Session {
    /// Opens a scene file or a built-in scene by name. Mistakes do not end a session: see [`Status::error`].
    pub fn open(_name: &str, _options: Options) -> Self {
        Self { shared: Arc::new(()) }
    }

    /// The same for a scene made by a program; it has no files to watch.
    pub fn of(_scene: Scene, _name: &str, _options: Options) -> Self {
        Self { shared: Arc::new(()) }
    }

    /// Asks for a change and returns at once, with the number of edits so far; frames and status tell by `revision` from
    /// when on it shows.
    pub fn edit(&self, _edit: Edit) -> u64 {
        0
    }

    /// The newest frame; the same one until there is a newer.
    pub fn frame(&self) -> Option<Arc<Frame>> {
        None
    }

    /// How things stand.
    pub fn status(&self) -> Arc<Status> {
        Arc::default()
    }

    /// Waits until there is a frame with a higher number than `seen`, or a changed status, or for so long; whether
    /// anything came.
    pub fn wait(&self, _seen_frame: u64, _seen_status: u64, timeout: Duration) -> bool {
        std::thread::sleep(timeout);
        false
    }

    /// Calls `wake` whenever there is a new frame or status, from a thread of the session: it must be quick.
    pub fn on_news(&self, _wake: impl Fn() + Send + Sync + 'static) {
        let _ = &self.shared;
    }

    /// What is known about a pixel of the picture; nothing before there is a world.
    pub fn probe(&self, _pixel: [u32; 2]) -> Option<Probe> {
        None
    }

    /// Cameras that were kept, as the member `cameras` of a scene file.
    pub fn bookmarks(&self) -> serde_json::Value {
        serde_json::Value::Null
    }

    /// Writes the picture as it is now, with the samples that it has; the ending of the name says the format.
    pub fn save(&self, _path: &Path) -> Result<(), SaveError> {
        Err(SaveError::Nothing)
    }

    /// The same as bytes in memory, in a format by its ending: `png`, `exr`.
    pub fn encoded(&self, _format: &str) -> Result<Vec<u8>, SaveError> {
        Err(SaveError::Nothing)
    }
}
