//! The thread that turns edits into pictures: what is to be done, and when. How it is done: `rendering.rs`.

use crate::build::Build;
use crate::coarse::Pace;
use crate::denoising::Denoising;
use crate::screen::{Canvas, Draft, Toner};
use crate::session::Options;
use crate::shared::{Shared, Shown};
use crate::subject::{Change, Subject};
use crate::watch::Watch;
use crate::worlds::{Building, QUICK, Why};
use crate::{Edit, Frame, Setting, Stage, Status};
use juggler::Picture;
use juggler::camera::film::{Film, Rect};
use juggler::imaging::{Tone, atomic};
use juggler::render::Scheduler;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Most threads that render.
const MAX_THREADS: usize = 1024;
/// How often it is looked whether the next frame of an animation is due.
const TICK: Duration = Duration::from_millis(4);

/// The thread that turns edits into pictures.
pub struct Worker {
    pub shared: Arc<Shared>,
    pub options: Options,
    pub pool: Arc<ThreadPool>,
    pub scheduler: Scheduler,
    pub subject: Option<Arc<Subject>>,
    /// Samples of the picture so far.
    pub film: Option<Arc<Film>>,
    pub draft: Arc<Draft>,
    /// The film's picture without noise.
    pub denoising: Denoising,
    pub canvas: Option<Canvas>,
    pub toner: Toner,
    pub region: Option<Rect>,
    pub pace: Pace,
    pub status: Status,
    /// The world that is being built.
    pub building: Option<Building>,
    /// The picture is another one than the draft shows.
    pub moved: bool,
    /// The film is to be shown anew.
    pub retoned: bool,
    /// When the last draft was ready.
    pub drawn: Instant,
    /// Since when it plays, and from which frame.
    pub playing: Option<(Instant, f64)>,
    /// The scene that was asked for last.
    wanted: String,
    /// What is wrong with the scene's files.
    pub broken: Option<String>,
    pub watch: Option<Watch>,
}

/// Threads that render; all cores when 0.
pub fn pool(threads: usize) -> Option<Arc<ThreadPool>> {
    let builder = ThreadPoolBuilder::new().num_threads(threads.min(MAX_THREADS));
    builder.thread_name(|i| format!("session {i}")).build().ok().map(Arc::new)
}

impl Worker {
    /// For a scene that will be built by [`Worker::open`].
    pub fn new(shared: Arc<Shared>, options: Options, pool: Arc<ThreadPool>, status: Status) -> Self {
        let watch = options.watch.then(|| {
            let shared = Arc::downgrade(&shared);
            Watch::new(move || {
                if let Some(shared) = shared.upgrade() {
                    shared.edit(Edit::Reload);
                }
            })
        });
        Self {
            wanted: status.scene.clone(),
            options,
            pool,
            scheduler: Scheduler::default(),
            subject: None,
            film: None,
            draft: Arc::default(),
            denoising: Denoising::default(),
            canvas: None,
            toner: Toner::new(&Tone::default()),
            region: None,
            pace: Pace::default(),
            status,
            building: None,
            moved: false,
            retoned: false,
            drawn: Instant::now(),
            playing: None,
            broken: None,
            watch: watch.flatten(),
            shared,
        }
    }

    /// Works until the session is closed.
    pub fn run(mut self, build: Build) {
        self.build(build, Why::Other);
        while !self.shared.desk().closed {
            self.take_built();
            self.take_edits();
            self.play();
            if self.moved && self.building.is_none() {
                self.draw();
            } else if self.retoned {
                self.repaint();
            } else if self.building.is_some() || self.playing.is_some() || !self.refine() {
                self.rest();
            }
        }
    }

    fn rest(&self) {
        let timeout = match self.building {
            Some(_) if self.status.stage != Stage::Loading => Some(QUICK),
            None if self.playing.is_some() => Some(TICK),
            _ => None,
        };
        let building = self.building.is_some();
        self.shared.rest(timeout, |desk| {
            // While a world is built, only another scene is of interest.
            let edits = if building { desk.edits.iter().any(Edit::supersedes) } else { !desk.edits.is_empty() };
            desk.closed || desk.built.is_some() || edits
        });
    }

    /// Shows how things stand, with a new frame or without.
    pub fn publish(&mut self, frame: Option<Frame>) {
        let shown = self.subject.clone().map(|subject| Shown {
            film: self.film.clone(),
            draft: Arc::clone(&self.draft),
            denoised: self.denoised_pixels(&subject),
            subject,
        });
        self.shared.publish(frame, self.status.clone(), shown);
    }

    fn take_edits(&mut self) {
        while let Some(edit) = self.next_edit() {
            if let Err(error) = self.apply(&edit) {
                self.status.error = Some(error);
                self.publish(None);
            } else if !self.moved && !self.retoned && self.building.is_none() {
                self.publish(None);
            }
        }
    }

    fn next_edit(&mut self) -> Option<Edit> {
        let mut desk = self.shared.desk();
        if self.building.is_some() {
            // What came before it is about a scene that nobody wants to see any more.
            let at = desk.edits.iter().position(Edit::supersedes)?;
            desk.edits.drain(..at);
            self.status.revision += at as u64;
        }
        loop {
            let edit = desk.edits.pop_front()?;
            self.status.revision += 1;
            if !desk.edits.front().is_some_and(|next| next.replaces(&edit)) {
                return Some(edit);
            }
        }
    }

    fn apply(&mut self, edit: &Edit) -> Result<(), String> {
        match edit {
            Edit::Show(channel) => {
                self.moved |= self.status.channel != *channel;
                self.status.channel = *channel;
            }
            Edit::Region(region) => self.confine(*region),
            Edit::Play(play) => {
                let from = self.subject.as_ref().filter(|subject| *play && subject.animation().is_some());
                self.playing = from.map(|subject| (Instant::now(), subject.frame()));
                self.describe();
            }
            Edit::Setting(Setting::Threads(threads)) => {
                self.pool = pool(*threads).ok_or("error: the threads cannot be started")?;
                self.pace.forget();
                self.describe();
            }
            Edit::Setting(Setting::Scheduler(name)) => {
                self.scheduler = scheduler(name)?;
                name.clone_into(&mut self.status.scheduler);
            }
            Edit::Bookmark(name) => self.bookmark(name)?,
            Edit::Scene(name) => {
                name.clone_into(&mut self.wanted);
                self.open()?;
            }
            // The scene that was asked for was not to be had yet.
            Edit::Reload if self.subject.as_ref().is_none_or(|subject| subject.name != self.wanted) => self.open()?,
            edit => self.apply_to_subject(edit)?,
        }
        Ok(())
    }

    /// Opens the scene that was asked for last.
    fn open(&mut self) -> Result<(), String> {
        if self.subject.is_some() {
            return self.apply_to_subject(&Edit::Scene(self.wanted.clone()));
        }
        self.build(Build::open(&self.wanted, self.options.size), Why::Other);
        Ok(())
    }

    fn apply_to_subject(&mut self, edit: &Edit) -> Result<(), String> {
        let Some(subject) = &mut self.subject else { return Ok(()) };
        let before = Arc::clone(subject.picture());
        match Arc::make_mut(subject).apply(edit)? {
            Change::Nothing => self.describe(),
            Change::Build(build) => {
                let why = match edit {
                    Edit::Scene(_) => Why::Other,
                    Edit::Reload => Why::Files,
                    _ => Why::Parts,
                };
                self.build(*build, why);
            }
            Change::View => {
                self.status.error.clone_from(&self.broken);
                self.take_view(&before);
                self.describe();
            }
        }
        Ok(())
    }

    /// The film goes on when its samples are those of the new picture too.
    pub fn take_view(&mut self, before: &Picture) {
        let Some(subject) = &self.subject else { return };
        let picture = subject.picture();
        if before.size() != picture.size() {
            self.region = None;
        }
        if before.shares_samples(picture) && self.film.is_some() {
            self.retoned = true;
            self.status.samples_wanted = picture.samples();
            self.refilm();
        } else {
            (self.film, self.moved, self.denoising) = (None, true, Denoising::default());
        }
    }

    fn bookmark(&mut self, name: &str) -> Result<(), String> {
        let Some(subject) = &mut self.subject else { return Ok(()) };
        match subject.with_bookmark(name) {
            None => Arc::make_mut(subject).keep(name),
            Some(text) => {
                let (text, file) = (text?, subject.name.clone());
                let wrong = |error| format!("error: cannot write `{file}`: {error}");
                atomic::write(Path::new(&file), text.as_bytes()).map_err(wrong)?;
                self.apply_to_subject(&Edit::Reload)?;
            }
        }
        self.describe();
        Ok(())
    }

    fn play(&mut self) {
        let (Some((since, from)), Some(subject)) = (self.playing, &self.subject) else { return };
        let Some(animation) = subject.animation().filter(|_| self.building.is_none() && !self.moved) else { return };
        let at = from + since.elapsed().as_secs_f64() * animation.frames_per_second;
        let at = at.floor().rem_euclid(f64::from(animation.frames));
        if at != subject.frame()
            && let Err(error) = self.apply_to_subject(&Edit::At(at))
        {
            (self.status.error, self.playing) = (Some(error), None);
        }
    }

    /// Brings the status up to date.
    pub fn describe(&mut self) {
        let status = &mut self.status;
        status.threads = self.pool.current_num_threads();
        status.playing = self.playing.is_some();
        status.region = self.region;
        if let Some(subject) = &self.subject {
            subject.describe(status);
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
