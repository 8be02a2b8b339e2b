//! Worker thread that turns edits into images: it decides what to do next; `rendering.rs` does it.

use crate::background_build::{BuildReason, LOADING_DELAY, RunningBuild};
use crate::build::BuildRequest;
use crate::coarse::RenderRate;
use crate::denoising::Denoising;
use crate::screen::{Canvas, DisplayTransform, Preview};
use crate::session::SessionOptions;
use crate::shared::{Shared, Snapshot};
use crate::subject::{EditEffect, Subject};
use crate::watch::Watch;
use crate::{Edit, Frame, SceneFiles, Setting, Stage, Status};
use juggler::Picture;
use juggler::camera::film::{Film, Rect};
use juggler::imaging::{Tone, atomic};
use juggler::render::Scheduler;
use juggler::scene::Bundle;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Maximum number of render threads.
const MAX_THREADS: usize = 1024;
/// Polling interval for the next frame of an animation.
const TICK: Duration = Duration::from_millis(4);

/// State of the worker thread.
pub struct Worker {
    pub shared: Arc<Shared>,
    pub options: SessionOptions,
    pub pool: Arc<ThreadPool>,
    pub scheduler: Scheduler,
    pub subject: Option<Arc<Subject>>,
    /// Samples of the current picture.
    pub film: Option<Arc<Film>>,
    pub preview: Arc<Preview>,
    /// Denoised image of the film.
    pub denoising: Denoising,
    pub canvas: Option<Canvas>,
    pub transform: DisplayTransform,
    pub region: Option<Rect>,
    pub rate: RenderRate,
    pub status: Status,
    /// Build that is running.
    pub building: Option<RunningBuild>,
    /// Whether the picture has changed since the last preview.
    pub needs_preview: bool,
    /// Whether the film must be displayed again with other tone, channel or gains.
    pub needs_repaint: bool,
    /// Time at which the last preview was ready.
    pub drawn: Instant,
    /// Start time and start frame of the playback.
    pub playing: Option<(Instant, f64)>,
    /// Scene that was requested last.
    requested_scene: String,
    /// Files of the scene that was requested last, if they are in memory.
    requested_files: Option<Bundle>,
    /// Errors in the scene's files.
    pub scene_error: Option<String>,
    pub watch: Option<Watch>,
}

/// Creates a thread pool; 0 threads use all cores.
pub fn pool(threads: usize) -> Option<Arc<ThreadPool>> {
    let builder = ThreadPoolBuilder::new().num_threads(threads.min(MAX_THREADS));
    builder.thread_name(|i| format!("session {i}")).build().ok().map(Arc::new)
}

impl Worker {
    /// Creates a worker without a scene.
    pub fn new(shared: Arc<Shared>, options: SessionOptions, pool: Arc<ThreadPool>, status: Status) -> Self {
        let watch = options.watch.then(|| {
            let shared = Arc::downgrade(&shared);
            Watch::new(move || {
                if let Some(shared) = shared.upgrade() {
                    shared.edit(Edit::Reload);
                }
            })
        });
        Self {
            requested_scene: status.scene.clone(),
            requested_files: None,
            options,
            pool,
            scheduler: Scheduler::default(),
            subject: None,
            film: None,
            preview: Arc::default(),
            denoising: Denoising::default(),
            canvas: None,
            transform: DisplayTransform::new(&Tone::default()),
            region: None,
            rate: RenderRate::default(),
            status,
            building: None,
            needs_preview: false,
            needs_repaint: false,
            drawn: Instant::now(),
            playing: None,
            scene_error: None,
            watch: watch.flatten(),
            shared,
        }
    }

    /// Runs until the session is closed.
    pub fn run(mut self, build: BuildRequest) {
        self.build(build, BuildReason::OtherScene);
        while !self.shared.mailbox().closed {
            self.adopt_build();
            self.apply_edits();
            self.play();
            if self.needs_preview && self.building.is_none() {
                self.draw();
            } else if self.needs_repaint {
                self.repaint();
            } else if self.building.is_some() || self.playing.is_some() || !self.refine() {
                self.wait_for_work();
            }
        }
    }

    fn wait_for_work(&self) {
        let timeout = match self.building {
            Some(_) if self.status.stage != Stage::Loading => Some(LOADING_DELAY),
            None if self.playing.is_some() => Some(TICK),
            _ => None,
        };
        let building = self.building.is_some();
        self.shared.wait_for_work(timeout, |mailbox| {
            // While a world is being built, only an edit that opens another scene wakes the worker.
            let edits = if building { mailbox.edits.iter().any(Edit::supersedes) } else { !mailbox.edits.is_empty() };
            mailbox.closed || mailbox.built.is_some() || edits
        });
    }

    /// Publishes the status, with a new frame if given.
    pub fn publish(&mut self, frame: Option<Frame>) {
        let snapshot = self.subject.clone().map(|subject| Snapshot {
            film: self.film.clone(),
            preview: Arc::clone(&self.preview),
            denoised: self.denoised_pixels(&subject),
            subject,
        });
        self.shared.publish(frame, self.status.clone(), snapshot);
    }

    fn apply_edits(&mut self) {
        while let Some(edit) = self.next_edit() {
            if let Err(error) = self.apply(&edit) {
                self.status.error = Some(error);
                self.publish(None);
            } else if !self.needs_preview && !self.needs_repaint && self.building.is_none() {
                self.publish(None);
            }
        }
    }

    fn next_edit(&mut self) -> Option<Edit> {
        let mut mailbox = self.shared.mailbox();
        if self.building.is_some() {
            // Edits before it concern a scene that is being replaced.
            let at = mailbox.edits.iter().position(Edit::supersedes)?;
            mailbox.edits.drain(..at);
            self.status.revision += at as u64;
        }
        loop {
            let edit = mailbox.edits.pop_front()?;
            self.status.revision += 1;
            if !mailbox.edits.front().is_some_and(|next| next.replaces(&edit)) {
                return Some(edit);
            }
        }
    }

    fn apply(&mut self, edit: &Edit) -> Result<(), String> {
        match edit {
            Edit::Show(channel) => {
                self.needs_preview |= self.status.channel != *channel;
                self.status.channel = *channel;
            }
            Edit::Region(region) => self.set_region(*region),
            Edit::Play(play) => {
                let from = self.subject.as_ref().filter(|subject| *play && subject.animation().is_some());
                self.playing = from.map(|subject| (Instant::now(), subject.frame()));
                self.update_status();
            }
            Edit::Setting(Setting::Threads(threads)) => {
                self.pool = pool(*threads).ok_or("error: cannot start threads")?;
                self.rate.forget();
                self.update_status();
            }
            Edit::Setting(Setting::Scheduler(name)) => {
                self.scheduler = scheduler(name)?;
                name.clone_into(&mut self.status.scheduler);
            }
            Edit::Bookmark(name) => self.bookmark(name)?,
            Edit::Scene(name) => {
                (self.requested_scene, self.requested_files) = (name.clone(), None);
                self.open()?;
            }
            Edit::Files(SceneFiles { name, files }) => {
                (self.requested_scene, self.requested_files) = (name.clone(), Some(files.clone()));
                self.open()?;
            }
            // The requested scene could not be opened yet.
            Edit::Reload if self.subject.as_ref().is_none_or(|subject| subject.name != self.requested_scene) => {
                self.open()?;
            }
            edit => self.apply_to_subject(edit)?,
        }
        Ok(())
    }

    /// Opens the scene that was requested last.
    fn open(&mut self) -> Result<(), String> {
        let (name, files) = (self.requested_scene.clone(), self.requested_files.clone());
        if self.subject.is_some() {
            let edit = match files {
                Some(files) => Edit::Files(SceneFiles { name, files }),
                None => Edit::Scene(name),
            };
            return self.apply_to_subject(&edit);
        }
        let request = BuildRequest::open(&name, self.options.size).with_lenient(self.options.lenient);
        let request = match files {
            Some(files) => request.with_files(files),
            None => request,
        };
        self.build(request, BuildReason::OtherScene);
        Ok(())
    }

    fn apply_to_subject(&mut self, edit: &Edit) -> Result<(), String> {
        let Some(subject) = &mut self.subject else { return Ok(()) };
        let before = Arc::clone(subject.picture());
        match Arc::make_mut(subject).apply(edit)? {
            EditEffect::Nothing => self.update_status(),
            EditEffect::Build(build) => {
                let reason = match edit {
                    Edit::Scene(_) | Edit::Files(_) => BuildReason::OtherScene,
                    Edit::Reload => BuildReason::Files,
                    _ => BuildReason::Edit,
                };
                self.build(*build, reason);
            }
            EditEffect::View => {
                self.status.error.clone_from(&self.scene_error);
                self.adopt_view(&before);
                self.update_status();
            }
        }
        Ok(())
    }

    /// Adopts a new picture: the film continues if both share their samples.
    pub fn adopt_view(&mut self, before: &Picture) {
        let Some(subject) = &self.subject else { return };
        let picture = subject.picture();
        if before.size() != picture.size() {
            self.region = None;
        }
        if before.shares_samples(picture) && self.film.is_some() {
            self.needs_repaint = true;
            self.status.samples_wanted = picture.samples();
            self.rebuild_film();
        } else {
            (self.film, self.needs_preview, self.denoising) = (None, true, Denoising::default());
        }
    }

    fn bookmark(&mut self, name: &str) -> Result<(), String> {
        let Some(subject) = &mut self.subject else { return Ok(()) };
        match subject.with_bookmark(name) {
            None => Arc::make_mut(subject).add_bookmark(name),
            Some(text) => {
                let (text, file) = (text?, subject.name.clone());
                let wrong = |error| format!("error: cannot write `{file}`: {error}");
                atomic::write(Path::new(&file), text.as_bytes()).map_err(wrong)?;
                self.apply_to_subject(&Edit::Reload)?;
            }
        }
        self.update_status();
        Ok(())
    }

    fn play(&mut self) {
        let (Some((since, from)), Some(subject)) = (self.playing, &self.subject) else { return };
        let Some(animation) = subject.animation().filter(|_| self.building.is_none() && !self.needs_preview) else {
            return;
        };
        let at = from + since.elapsed().as_secs_f64() * animation.frames_per_second;
        let at = at.floor().rem_euclid(f64::from(animation.frames));
        if at != subject.frame()
            && let Err(error) = self.apply_to_subject(&Edit::At(at))
        {
            (self.status.error, self.playing) = (Some(error), None);
        }
    }

    /// Updates the status.
    pub fn update_status(&mut self) {
        let status = &mut self.status;
        status.threads = self.pool.current_num_threads();
        status.playing = self.playing.is_some();
        status.region = self.region;
        if let Some(subject) = &self.subject {
            subject.write_status(status);
        }
    }
}

fn scheduler(name: &str) -> Result<Scheduler, String> {
    let known = ["work-stealing", "row-queue", "static-rows"];
    juggler::check_name("scheduler", name, known.into_iter()).map_err(|error| format!("error: {error}"))?;
    Ok(match name {
        "row-queue" => Scheduler::RowQueue,
        "static-rows" => Scheduler::StaticRows,
        _ => Scheduler::WorkStealing,
    })
}
