//! State that a session's handles and its worker share.

use crate::build::BuildError;
use crate::edit::Edit;
use crate::frame::Frame;
use crate::screen::Preview;
use crate::status::{Stage, Status};
use crate::subject::Subject;
use juggler::Picture;
use juggler::camera::film::Film;
use juggler::denoise::DenoisedPicture;
use juggler::math::{PixelRows, Rgb};
use std::collections::VecDeque;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Edit of a client, or the error of an edit that a client could not read.
pub type Request = Result<Edit, String>;

/// Callback for new frames and statuses.
pub type Callback = Arc<dyn Fn() + Send + Sync>;

/// State that a session's handles and its worker share.
#[derive(Default)]
pub struct Shared {
    mailbox: Mutex<Mailbox>,
    /// Notifies the worker about new work.
    work: Condvar,
    /// Notifies clients about new frames and statuses.
    updates: Condvar,
}

/// Mailbox between the handles and the worker.
#[derive(Default)]
pub struct Mailbox {
    /// Edits that the worker has not taken yet.
    pub edits: VecDeque<Request>,
    /// Total number of edits.
    pub edit_count: u64,
    /// Number of the latest build; results of earlier builds are discarded.
    pub build_number: u64,
    /// Result of the latest build.
    pub built: Option<Result<Subject, BuildError>>,
    /// Whether the current render job has ended.
    pub job_ended: bool,
    /// Whether all handles are dropped.
    pub closed: bool,
    /// Newest frame.
    pub frame: Option<Arc<Frame>>,
    /// Newest status.
    pub status: Arc<Status>,
    /// Data for probing and saving.
    pub snapshot: Option<Snapshot>,
    callbacks: Vec<Callback>,
}

/// Snapshot of the session for probing and saving.
#[derive(Clone)]
pub struct Snapshot {
    /// Scene, edits and picture.
    pub subject: Arc<Subject>,
    /// Film with the samples so far.
    pub film: Option<Arc<Film>>,
    /// Preview that stands in for pixels without samples.
    pub preview: Arc<Preview>,
    /// Denoised image, displayed instead of the film if there is one.
    pub denoised: Option<Arc<DenoisedPicture>>,
}

impl Snapshot {
    /// Returns the picture that is rendered.
    pub fn picture(&self) -> &Arc<Picture> {
        self.subject.picture()
    }

    /// Passes the rows of the displayed image to `rows`, from the top: denoised if so displayed,
    /// else from the film, with the preview where it has no samples.
    pub fn develop<E>(&self, mut rows: impl FnMut(PixelRows) -> Result<(), E>) -> Result<(), E> {
        if let Some(denoised) = &self.denoised {
            return denoised.rows().chunks(self.picture().size()[0].max(1) as usize).try_for_each(rows);
        }
        let (size, preview, gains) = (self.picture().size(), &self.preview, self.subject.gains());
        let row = |y: u32| (0..size[0]).map(move |x| preview.at([x, y], size));
        let is_transparent = self.picture().aovs().is_transparent();
        let Some(film) = &self.film else {
            return (0..size[1]).try_for_each(|y| {
                let (colors, alpha): (Vec<Rgb>, Vec<f32>) = row(y).unzip();
                rows(PixelRows { colors: &colors, alpha: is_transparent.then_some(&*alpha) })
            });
        };
        for (number, band) in (0..).zip(film.tiling().bands()) {
            let (mut pixels, alpha): (Vec<Rgb>, Vec<f32>) = (band.y..band.y + band.height).flat_map(row).unzip();
            let aovs = self.picture().aovs();
            let mut alpha = is_transparent.then_some(alpha);
            for tile in film.tiling().tiles_of_band(number).filter_map(|tile| film.tile(tile as usize)) {
                if tile.samples_per_pixel() > 0 {
                    tile.pixels().copy_into(&self.subject.light(&tile, &gains), &band, &mut pixels);
                    let own = aovs.alpha(&tile.pixels(), std::slice::from_ref(&*tile));
                    own.iter().zip(&mut alpha).for_each(|(own, all)| tile.pixels().copy_into(own, &band, all));
                }
            }
            rows(PixelRows { colors: &pixels, alpha: alpha.as_deref() })?;
        }
        Ok(())
    }
}

impl Mailbox {
    /// Returns whether the current render job has ended, and whether the worker has new work.
    pub fn state(&self) -> (bool, bool) {
        (self.job_ended, self.has_work())
    }

    /// Returns whether the worker has new work.
    pub fn has_work(&self) -> bool {
        self.closed || !self.edits.is_empty() || self.built.is_some()
    }
}

impl Shared {
    /// Locks the mailbox.
    pub fn mailbox(&self) -> MutexGuard<'_, Mailbox> {
        // Poisoning only means that another thread panicked: every value is consistent at any time.
        self.mailbox.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Changes the mailbox and wakes the worker.
    pub fn update(&self, change: impl FnOnce(&mut Mailbox)) {
        change(&mut self.mailbox());
        self.work.notify_all();
    }

    /// Queues an edit and returns the number of edits so far.
    pub fn request(&self, edit: Request) -> u64 {
        let mut edit_count = 0;
        self.update(|mailbox| {
            mailbox.edits.push_back(edit);
            mailbox.edit_count += 1;
            edit_count = mailbox.edit_count;
        });
        edit_count
    }

    /// Blocks the worker until `ready` or the timeout; `None` waits without a limit.
    pub fn wait_for_work(&self, timeout: Option<Duration>, ready: impl Fn(&Mailbox) -> bool) {
        let mailbox = self.mailbox();
        match timeout {
            Some(timeout) => {
                let waited = self.work.wait_timeout_while(mailbox, timeout, |mailbox| !ready(mailbox));
                drop(waited.unwrap_or_else(PoisonError::into_inner));
            }
            None => {
                let waited = self.work.wait_while(mailbox, |mailbox| !ready(mailbox));
                drop(waited.unwrap_or_else(PoisonError::into_inner));
            }
        }
    }

    /// Publishes a status, with a new frame and snapshot if given, and notifies the clients.
    pub fn publish(&self, frame: Option<Frame>, mut status: Status, snapshot: Option<Snapshot>) {
        let mut mailbox = self.mailbox();
        let mut changed = frame.is_some();
        if let Some(mut frame) = frame {
            frame.number = mailbox.frame.as_ref().map_or(0, |frame| frame.number) + 1;
            mailbox.frame = Some(Arc::new(frame));
        }
        status.number = mailbox.status.number;
        if status != *mailbox.status {
            status.number += 1;
            mailbox.status = Arc::new(status);
            changed = true;
        }
        mailbox.snapshot = snapshot.or(mailbox.snapshot.take());
        let callbacks = if changed { mailbox.callbacks.clone() } else { Vec::new() };
        drop(mailbox);
        if changed {
            self.updates.notify_all();
        }
        callbacks.iter().for_each(|callback| callback());
    }

    /// Publishes the end of the session with an error; the displayed frame stays.
    pub fn end(&self, error: &str) {
        let before = Status::clone(&self.mailbox().status);
        self.publish(None, Status { error: Some(error.into()), stage: Stage::Finished, ..before }, None);
    }

    /// Waits for a frame or a status with a higher number. Returns `false` on timeout.
    pub fn wait(&self, frame: u64, status: u64, timeout: Duration) -> bool {
        let old = |mailbox: &Mailbox| {
            mailbox.frame.as_ref().is_none_or(|f| f.number <= frame) && mailbox.status.number <= status
        };
        let waited = self.updates.wait_timeout_while(self.mailbox(), timeout, |mailbox| old(mailbox));
        !waited.unwrap_or_else(PoisonError::into_inner).1.timed_out()
    }

    /// Registers a callback for new frames and statuses.
    pub fn on_update(&self, callback: Callback) {
        self.mailbox().callbacks.push(callback);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn end_of_the_session_is_reported_and_the_frame_kept() {
        let shared = Shared::default();
        let status = Status { scene: "chess".into(), samples: 3.0, ..Status::default() };
        shared.publish(None, status, None);
        let number = shared.mailbox().status.number;
        shared.end("error: no");
        assert!(shared.wait(u64::MAX, number, Duration::ZERO));
        let status = Arc::clone(&shared.mailbox().status);
        assert_eq!((status.error.as_deref(), status.stage), (Some("error: no"), Stage::Finished));
        assert_eq!((status.scene.as_str(), status.samples), ("chess", 3.0));
    }
}
