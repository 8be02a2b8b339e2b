//! Worker thread that turns edits into images: it decides what to do next; `rendering.rs` does it.

use crate::apply::EditEffect;
use crate::background_build::LOADING_DELAY;
use crate::build::BuildRequest;
use crate::edit::{Edit, SceneFiles, Setting};
use crate::shared::Request;
use crate::status::Stage;
use crate::worker_state::{BuildReason, DenoisedFilm, Playback, Worker, WorkerThreads};
use juggler::Picture;
use juggler::imaging::atomic;
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Polling interval for the next frame of an animation.
const TICK: Duration = Duration::from_millis(4);

impl Worker {
    /// Runs until the session is closed.
    pub fn run(mut self, build: BuildRequest) {
        self.build(build, BuildReason::OtherScene);
        while !self.shared.mailbox().closed {
            self.adopt_build();
            self.apply_edits();
            self.play();
            if self.pending.needs_preview && self.building.is_none() {
                self.draw();
            } else if self.pending.needs_repaint {
                self.repaint();
            } else if self.building.is_some() || self.playback.is_some() || !self.refine() {
                self.wait_for_work();
            }
        }
    }

    fn wait_for_work(&self) {
        let timeout = match &self.building {
            Some(_) if self.status.stage != Stage::Loading => Some(LOADING_DELAY),
            None if self.playback.is_some() => Some(TICK),
            _ => None,
        };
        let building = self.building.is_some();
        self.shared.wait_for_work(timeout, |mailbox| {
            // While a world is being built, only an edit that opens another scene wakes the worker.
            let edits = if building { mailbox.edits.iter().any(supersedes) } else { !mailbox.edits.is_empty() };
            mailbox.closed || mailbox.built.is_some() || edits
        });
    }

    fn apply_edits(&mut self) {
        while let Some(request) = self.next_request() {
            let applied = match request {
                Ok(edit) => self.apply(&edit),
                // Without a scene, its own error matters more.
                Err(error) => self.subject.as_ref().map_or(Ok(()), |_| Err(error)),
            };
            if let Err(error) = applied {
                self.status.error = Some(error);
                self.publish(None);
            } else if !self.pending.needs_preview && !self.pending.needs_repaint && self.building.is_none() {
                self.publish(None);
            }
        }
    }

    fn next_request(&mut self) -> Option<Request> {
        let mut mailbox = self.shared.mailbox();
        if self.building.is_some() {
            // Edits before it concern a scene that is being replaced.
            let at = mailbox.edits.iter().position(supersedes)?;
            mailbox.edits.drain(..at);
            self.status.revision += at as u64;
        }
        loop {
            let request = mailbox.edits.pop_front()?;
            self.status.revision += 1;
            if !mailbox.edits.front().is_some_and(|next| replaces(next, &request)) {
                return Some(request);
            }
        }
    }

    fn apply(&mut self, edit: &Edit) -> Result<(), String> {
        match edit {
            Edit::Show(channel) => {
                self.pending.needs_preview |= self.status.channel != *channel;
                self.status.channel = *channel;
            }
            Edit::Region(region) => self.set_region(*region),
            Edit::Play(play) => {
                let from = self.subject.as_ref().filter(|subject| *play && subject.animation().is_some());
                self.playback = from.map(|subject| Playback { since: Instant::now(), from: subject.frame() });
                self.update_status();
            }
            Edit::Setting(Setting::Threads(threads)) => {
                let scheduler = self.threads.scheduler;
                let threads = WorkerThreads::new(*threads).ok_or("error: cannot start threads")?;
                self.threads = WorkerThreads { scheduler, ..threads };
                self.pending.rate.forget();
                self.update_status();
            }
            Edit::Setting(Setting::Scheduler(scheduler)) => {
                self.threads.scheduler = *scheduler;
                self.update_status();
            }
            Edit::Bookmark(name) => self.bookmark(name)?,
            Edit::Scene(name) => {
                (self.source.name, self.source.files) = (name.clone(), None);
                self.open()?;
            }
            Edit::Files(SceneFiles { name, files }) => {
                (self.source.name, self.source.files) = (name.clone(), Some(files.clone()));
                self.open()?;
            }
            // The requested scene could not be opened yet.
            Edit::Reload if self.subject.as_ref().is_none_or(|subject| subject.name != self.source.name) => {
                self.open()?;
            }
            edit => self.apply_to_subject(edit)?,
        }
        Ok(())
    }

    /// Opens the scene that was requested last.
    fn open(&mut self) -> Result<(), String> {
        let (name, files) = (self.source.name.clone(), self.source.files.clone());
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
                self.status.error.clone_from(&self.source.error);
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
            self.samples.region = None;
        }
        if before.shares_samples(picture) && self.samples.film.is_some() {
            self.pending.needs_repaint = true;
            self.status.samples_wanted = picture.samples();
            self.rebuild_film();
        } else {
            (self.samples.film, self.samples.denoised) = (None, DenoisedFilm::default());
            self.pending.needs_preview = true;
        }
    }

    fn bookmark(&mut self, name: &str) -> Result<(), String> {
        let Some(subject) = &mut self.subject else { return Ok(()) };
        match subject.with_bookmark(name) {
            None => Arc::make_mut(subject).add_bookmark(name),
            Some(found) => {
                let (file, text) = found?;
                let wrong = |error| format!("error: cannot write `{}`: {error}", file.display());
                atomic::write(&file, text.as_bytes()).map_err(wrong)?;
                if file == Path::new(&subject.name) {
                    self.apply_to_subject(&Edit::Reload)?;
                } else {
                    Arc::make_mut(subject).add_bookmark(name);
                }
            }
        }
        self.update_status();
        Ok(())
    }

    fn play(&mut self) {
        let (Some(Playback { since, from }), Some(subject)) = (self.playback, &self.subject) else { return };
        if self.building.is_some() || self.pending.needs_preview {
            return;
        }
        let Some(animation) = subject.animation() else { return };
        let at = from + since.elapsed().as_secs_f64() * animation.frames_per_second;
        let at = at.floor().rem_euclid(f64::from(animation.frames));
        if at != subject.frame()
            && let Err(error) = self.apply_to_subject(&Edit::At(at))
        {
            (self.status.error, self.playback) = (Some(error), None);
        }
    }
}

/// Returns whether all earlier requests become irrelevant.
fn supersedes(request: &Request) -> bool {
    request.as_ref().is_ok_and(Edit::supersedes)
}

/// Returns whether a request overwrites the effect of the one directly `before` it.
fn replaces(request: &Request, before: &Request) -> bool {
    match (request, before) {
        (Ok(edit), Ok(before)) => edit.replaces(before),
        _ => supersedes(request),
    }
}
