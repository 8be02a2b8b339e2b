//! Session handle for windows, web pages and scripts.

use crate::build::BuildRequest;
use crate::edit::Edit;
use crate::frame::Frame;
use crate::options::SessionOptions;
use crate::pixel_info::PixelInfo;
use crate::shared::Shared;
use crate::status::Status;
use crate::worker_state::{Worker, WorkerThreads};
use juggler::camera::AnyCamera;
use juggler::imaging::{self, Destination, ImageFormat, Options as EncoderOptions, RowWriter};
use juggler::scene::Scene;
use std::io::{Cursor, Seek, SeekFrom, Write};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// Error of saving an image.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SaveError {
    /// No image has been rendered yet.
    #[error("there is no picture yet")]
    Nothing,
    /// The image cannot be encoded or written.
    #[error(transparent)]
    Image(#[from] imaging::ImageError),
}

/// Handle of an interactive session. Clones share one session, which ends when the last of them is
/// dropped.
#[derive(Clone)]
pub struct Session {
    handle: Arc<Handle>,
}

struct Handle(Arc<Shared>);

impl Drop for Handle {
    fn drop(&mut self) {
        self.0.update(|mailbox| mailbox.closed = true);
    }
}

impl Session {
    /// Opens a scene file, or a built-in scene by name. Errors of the scene do not end the session;
    /// see [`Status::error`].
    pub fn open(name: &str, options: SessionOptions) -> Self {
        let build = BuildRequest::open(name, options.size).with_lenient(options.lenient);
        let build = build.with_values(options.values.clone());
        Self::start(build, name, options)
    }

    /// Opens a scene that a program has built; it has no files to watch.
    pub fn from_scene(scene: Scene, name: &str, options: SessionOptions) -> Self {
        let build = BuildRequest::from_scene(scene, name, options.size);
        Self::start(build, name, options)
    }

    fn start(build: BuildRequest, name: &str, options: SessionOptions) -> Self {
        let shared = Arc::new(Shared::default());
        let handle = Arc::new(Handle(Arc::clone(&shared)));
        let status = Status { scene: name.to_owned(), ..Status::default() };
        shared.publish(None, status.clone(), None);
        let work = move || {
            let Some(threads) = WorkerThreads::new(options.threads) else {
                return shared.end("error: cannot start threads");
            };
            let worker = Worker::new(Arc::clone(&shared), options, threads, status);
            if catch_unwind(AssertUnwindSafe(|| worker.run(build))).is_err() {
                shared.end("error: the session has ended: this is a bug of Juggler");
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

    /// Queues an edit and returns at once, with the number of edits so far. Frames and status
    /// include the edit once their `revision` is at least that number.
    pub fn edit(&self, edit: Edit) -> u64 {
        self.shared().request(Ok(edit))
    }

    /// Queues the error of an edit that a client could not read. It counts as an edit, and the
    /// status reports it as the error of one.
    pub fn report_unread(&self, error: String) -> u64 {
        self.shared().request(Err(error))
    }

    /// Returns the newest frame; `None` before the first.
    pub fn frame(&self) -> Option<Arc<Frame>> {
        self.shared().mailbox().frame.clone()
    }

    /// Returns the current status.
    pub fn status(&self) -> Arc<Status> {
        Arc::clone(&self.shared().mailbox().status)
    }

    /// Waits for a frame with a higher number than `seen_frame` or a status with a higher number
    /// than `seen_status`. Returns `false` on timeout.
    pub fn wait(&self, seen_frame: u64, seen_status: u64, timeout: Duration) -> bool {
        self.shared().wait(seen_frame, seen_status, timeout)
    }

    /// Registers a callback for new frames and statuses. A thread of the session calls it, so it
    /// must return quickly.
    pub fn on_update(&self, callback: impl Fn() + Send + Sync + 'static) {
        self.shared().on_update(Arc::new(callback));
    }

    /// Probes a pixel of the image; `None` before a world is built.
    pub fn probe(&self, pixel: [u32; 2]) -> Option<PixelInfo> {
        let snapshot = self.shared().mailbox().snapshot.clone()?;
        Some(PixelInfo::at_pixel(&snapshot.subject, snapshot.film.as_deref(), pixel))
    }

    /// Returns the cameras bookmarked in memory, by name;
    /// [`wire::bookmarks`](crate::wire::bookmarks) writes them as the member `cameras` of a scene
    /// file.
    pub fn bookmarks(&self) -> Vec<(String, AnyCamera)> {
        let snapshot = self.shared().mailbox().snapshot.clone();
        snapshot.map_or_else(Vec::new, |snapshot| snapshot.subject.bookmarks().to_vec())
    }

    /// Writes the image with the samples it has so far; the file extension selects the format.
    pub fn save(&self, path: &Path) -> Result<(), SaveError> {
        let format = ImageFormat::from_path(path)?;
        self.write(|header| imaging::create(path, format, header))
    }

    /// Encodes the image in memory, in a format given by its file extension, such as `png` or
    /// `exr`.
    pub fn encode(&self, format: &str) -> Result<Vec<u8>, SaveError> {
        let format = ImageFormat::from_path(Path::new(&format!("picture.{format}")))?;
        let bytes = SharedBuffer::default();
        self.write(|header| imaging::writer(format, Destination::seekable("memory", bytes.clone()), header))?;
        Ok(bytes.take())
    }

    fn write(
        &self,
        writer: impl FnOnce(&imaging::Header) -> Result<Box<dyn RowWriter>, imaging::ImageError>,
    ) -> Result<(), SaveError> {
        let snapshot = self.shared().mailbox().snapshot.clone().ok_or(SaveError::Nothing)?;
        if snapshot.preview.pixels.is_empty() {
            return Err(SaveError::Nothing);
        }
        let mut writer = writer(&snapshot.picture().header(EncoderOptions::default()))?;
        snapshot.develop(|rows| writer.write_rows(rows))?;
        Ok(writer.finish()?)
    }
}

/// Shared in-memory file for an image writer.
#[derive(Clone, Default)]
struct SharedBuffer(Arc<Mutex<Cursor<Vec<u8>>>>);

impl SharedBuffer {
    fn with<T>(&self, what: impl FnOnce(&mut Cursor<Vec<u8>>) -> T) -> T {
        what(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }

    fn take(&self) -> Vec<u8> {
        self.with(|bytes| std::mem::take(bytes.get_mut()))
    }
}

impl Write for SharedBuffer {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.with(|all| all.write(bytes))
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

impl Seek for SharedBuffer {
    fn seek(&mut self, to: SeekFrom) -> std::io::Result<u64> {
        self.with(|all| all.seek(to))
    }
}
