//! State of the worker thread, cut by job. `worker.rs` decides what to do next;
//! `background_build.rs`, `rendering.rs` and `denoising.rs` do it.

use crate::coarse::RenderRate;
use crate::edit::Edit;
use crate::frame::Frame;
use crate::options::SessionOptions;
use crate::screen::{Canvas, DisplayTransform, Preview};
use crate::shared::{Shared, Snapshot};
use crate::status::Status;
use crate::subject::Subject;
use crate::watch::Watch;
use juggler::BuildControl;
use juggler::camera::film::{Film, Rect};
use juggler::denoise::DenoisedPicture;
use juggler::imaging::Tone;
use juggler::render::Scheduler;
use juggler::scene::Bundle;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Maximum number of render threads.
const MAX_THREADS: usize = 1024;

/// State of the worker thread.
pub struct Worker {
    pub shared: Arc<Shared>,
    pub options: SessionOptions,
    pub threads: WorkerThreads,
    pub source: RequestedScene,
    /// Edited scene and its picture; `None` before the first build.
    pub subject: Option<Arc<Subject>>,
    /// Build that is running.
    pub building: Option<RunningBuild>,
    pub playback: Option<Playback>,
    pub samples: PictureSamples,
    pub display: Display,
    pub pending: PendingFrames,
    pub status: Status,
}

/// Threads that build and render.
pub struct WorkerThreads {
    pub pool: Arc<ThreadPool>,
    /// Distribution of a frame's pixels to the threads.
    pub scheduler: Scheduler,
}

/// Scene that was requested last, which may not be open yet, and its files.
pub struct RequestedScene {
    pub name: String,
    /// Files of the scene, if they are in memory.
    pub files: Option<Bundle>,
    /// Errors in the scene's files.
    pub error: Option<String>,
    pub watch: Option<Watch>,
}

/// Build that is running. It is cancelled when this object is dropped.
pub struct RunningBuild {
    /// Start of the build.
    pub began: Instant,
    /// Reason of the build.
    pub reason: BuildReason,
    /// Control of the build.
    pub control: Arc<BuildControl>,
}

impl Drop for RunningBuild {
    fn drop(&mut self) {
        self.control.cancel();
    }
}

/// Reason of a build.
#[derive(Clone, Copy, PartialEq)]
pub enum BuildReason {
    /// Another scene is being opened.
    OtherScene,
    /// The scene's files may have changed.
    Files,
    /// A value of the scene, a setting that affects the film, or the frame has changed.
    Edit,
}

/// Playback of the animation.
#[derive(Clone, Copy)]
pub struct Playback {
    /// Time at which the playback started.
    pub since: Instant,
    /// Frame from which it started.
    pub from: f64,
}

/// Samples of the current picture, and what they are refined to.
#[derive(Default)]
pub struct PictureSamples {
    pub film: Option<Arc<Film>>,
    /// Region that is refined; `None` for the whole image.
    pub region: Option<Rect>,
    /// Denoised image of the film.
    pub denoised: DenoisedFilm,
}

/// Last denoised image of the film.
#[derive(Default)]
pub struct DenoisedFilm {
    /// Denoised picture; `None` before the first run, or after a failed one.
    pub picture: Option<Arc<DenoisedPicture>>,
    /// Number of samples of the film that `picture` was computed from.
    pub samples: u64,
    /// Time at which the last run ended, and its duration.
    pub last: Option<(Instant, Duration)>,
}

/// Pixels on display.
pub struct Display {
    pub preview: Arc<Preview>,
    /// Preview with the samples of the film over it; `None` until the film is displayed.
    pub canvas: Option<Canvas>,
    pub transform: DisplayTransform,
}

/// Frames that are due, and the pace at which they are rendered.
pub struct PendingFrames {
    /// Whether the picture has changed since the last preview.
    pub needs_preview: bool,
    /// Whether the film must be displayed again with other tone, channel or gains.
    pub needs_repaint: bool,
    /// Time at which the last preview was ready.
    pub drawn: Instant,
    pub rate: RenderRate,
}

impl WorkerThreads {
    /// Starts render threads; 0 uses all cores. `None` if the system provides none.
    pub fn new(count: usize) -> Option<Self> {
        let builder = ThreadPoolBuilder::new().num_threads(count.min(MAX_THREADS));
        let pool = builder.thread_name(|i| format!("session {i}")).build().ok()?;
        Some(Self { pool: Arc::new(pool), scheduler: Scheduler::default() })
    }
}

impl RequestedScene {
    /// The scene with which a session is opened. If `is_watched`, changes of its files reload it.
    fn new(name: &str, shared: &Arc<Shared>, is_watched: bool) -> Self {
        let watch = is_watched.then(|| {
            let shared = Arc::downgrade(shared);
            Watch::new(move || {
                if let Some(shared) = shared.upgrade() {
                    shared.request(Ok(Edit::Reload));
                }
            })
        });
        Self { name: name.to_owned(), files: None, error: None, watch: watch.flatten() }
    }
}

impl Worker {
    /// Creates a worker without a scene.
    pub fn new(shared: Arc<Shared>, options: SessionOptions, threads: WorkerThreads, status: Status) -> Self {
        Self {
            source: RequestedScene::new(&status.scene, &shared, options.watch),
            options,
            threads,
            subject: None,
            building: None,
            playback: None,
            samples: PictureSamples::default(),
            display: Display {
                preview: Arc::default(),
                canvas: None,
                transform: DisplayTransform::new(&Tone::default()),
            },
            pending: PendingFrames {
                needs_preview: false,
                needs_repaint: false,
                drawn: Instant::now(),
                rate: RenderRate::default(),
            },
            status,
            shared,
        }
    }

    /// Returns the denoised image if there is one and denoising is on. Relighting disables it: the
    /// halves that the denoiser compares hold all light groups together.
    pub fn denoised_picture(&self, subject: &Subject) -> Option<Arc<DenoisedPicture>> {
        self.samples.denoised.picture.clone().filter(|_| subject.is_denoised())
    }

    /// Publishes the status, with a new frame if given.
    pub fn publish(&mut self, frame: Option<Frame>) {
        let snapshot = self.subject.clone().map(|subject| Snapshot {
            film: self.samples.film.clone(),
            preview: Arc::clone(&self.display.preview),
            denoised: self.denoised_picture(&subject),
            subject,
        });
        self.shared.publish(frame, self.status.clone(), snapshot);
    }

    /// Updates the status.
    pub fn update_status(&mut self) {
        let status = &mut self.status;
        status.threads = self.threads.pool.current_num_threads();
        status.scheduler = self.threads.scheduler;
        status.playing = self.playback.is_some();
        status.region = self.samples.region;
        if let Some(subject) = &self.subject {
            subject.write_status(status);
        }
    }
}
