//! The handle that windows, pages and scripts hold.

use crate::build::Build;
use crate::shared::Shared;
use crate::worker::{self, Worker};
use crate::{Edit, Frame, Probe, Status};
use juggler::imaging::{self, Destination, Format, Options as FileOptions, RowWriter};
use juggler::scene::Scene;
use std::io::{Cursor, Seek, SeekFrom, Write};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};
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
    Image(#[from] imaging::ImageError),
}

/// A scene that is looked at. Cheap to clone: all clones are the same session, which ends with the last of them.
#[derive(Clone)]
pub struct Session {
    handle: Arc<Handle>,
}

struct Handle(Arc<Shared>);

impl Drop for Handle {
    fn drop(&mut self) {
        self.0.tell(|desk| desk.closed = true);
    }
}

impl Session {
    /// Opens a scene file or a built-in scene by name. Mistakes do not end a session: see [`Status::error`].
    pub fn open(name: &str, options: Options) -> Self {
        let build = Build::open(name, options.size);
        Self::begin(build, name, options)
    }

    /// The same for a scene made by a program; it has no files to watch.
    pub fn of(scene: Scene, name: &str, options: Options) -> Self {
        let build = Build::of(scene, name, options.size);
        Self::begin(build, name, options)
    }

    fn begin(build: Build, name: &str, options: Options) -> Self {
        let shared = Arc::new(Shared::default());
        let handle = Arc::new(Handle(Arc::clone(&shared)));
        let status = Status { scene: name.to_owned(), scheduler: "work-stealing".into(), ..Status::default() };
        shared.publish(None, status.clone(), None);
        let work = move || {
            let Some(pool) = worker::pool(options.threads) else {
                return shared.end("error: the threads cannot be started");
            };
            let worker = Worker::new(Arc::clone(&shared), options, pool, status);
            if catch_unwind(AssertUnwindSafe(|| worker.run(build))).is_err() {
                shared.end("error: the session has ended: the program has a fault");
            }
        };
        let started = std::thread::Builder::new().name("session".into()).spawn(work);
        if let Err(error) = started {
            handle.0.end(&format!("error: {error}"));
        }
        Self { handle }
    }

    fn shared(&self) -> &Shared {
        &self.handle.0
    }

    /// Asks for a change and returns at once, with the number of edits so far; frames and status tell by `revision` from
    /// when on it shows.
    pub fn edit(&self, edit: Edit) -> u64 {
        self.shared().edit(edit)
    }

    /// The newest frame; the same one until there is a newer.
    pub fn frame(&self) -> Option<Arc<Frame>> {
        self.shared().desk().frame.clone()
    }

    /// How things stand.
    pub fn status(&self) -> Arc<Status> {
        Arc::clone(&self.shared().desk().status)
    }

    /// Waits until there is a frame with a higher number than `seen_frame`, or a status with a higher one than
    /// `seen_status`, or for so long; whether anything came.
    pub fn wait(&self, seen_frame: u64, seen_status: u64, timeout: Duration) -> bool {
        self.shared().wait(seen_frame, seen_status, timeout)
    }

    /// Calls `wake` whenever there is a new frame or status, from a thread of the session: it must be quick.
    pub fn on_news(&self, wake: impl Fn() + Send + Sync + 'static) {
        self.shared().on_news(Arc::new(wake));
    }

    /// What is known about a pixel of the picture; nothing before there is a world.
    pub fn probe(&self, pixel: [u32; 2]) -> Option<Probe> {
        let shown = self.shared().desk().shown.clone()?;
        Some(Probe::of(&shown.subject, shown.film.as_deref(), pixel))
    }

    /// Cameras that were kept, as the member `cameras` of a scene file.
    pub fn bookmarks(&self) -> serde_json::Value {
        let shown = self.shared().desk().shown.clone();
        shown.map_or_else(|| serde_json::json!({}), |shown| shown.subject.kept())
    }

    /// Writes the picture as it is now, with the samples that it has; the ending of the name says the format.
    pub fn save(&self, path: &Path) -> Result<(), SaveError> {
        let format = Format::from_path(path)?;
        self.write(|header| imaging::create(path, format, header))
    }

    /// The same as bytes in memory, in a format by its ending: `png`, `exr`.
    pub fn encoded(&self, format: &str) -> Result<Vec<u8>, SaveError> {
        let format = Format::from_path(Path::new(&format!("picture.{format}")))?;
        let bytes = Bytes::default();
        self.write(|header| imaging::writer(format, Destination::seekable("memory", bytes.clone()), header))?;
        Ok(bytes.take())
    }

    fn write(
        &self,
        writer: impl FnOnce(&imaging::Header) -> Result<Box<dyn RowWriter>, imaging::ImageError>,
    ) -> Result<(), SaveError> {
        let shown = self.shared().desk().shown.clone().ok_or(SaveError::Nothing)?;
        if shown.draft.pixels.is_empty() {
            return Err(SaveError::Nothing);
        }
        let mut writer = writer(&shown.picture().header(FileOptions::default()))?;
        shown.develop(|rows| writer.write_rows(rows))?;
        Ok(writer.finish()?)
    }
}

/// Bytes that somebody else writes.
#[derive(Clone, Default)]
struct Bytes(Arc<Mutex<Cursor<Vec<u8>>>>);

impl Bytes {
    fn with<T>(&self, what: impl FnOnce(&mut Cursor<Vec<u8>>) -> T) -> T {
        what(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }

    fn take(&self) -> Vec<u8> {
        self.with(|bytes| std::mem::take(bytes.get_mut()))
    }
}

impl Write for Bytes {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.with(|all| all.write(bytes))
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

impl Seek for Bytes {
    fn seek(&mut self, to: SeekFrom) -> std::io::Result<u64> {
        self.with(|all| all.seek(to))
    }
}
