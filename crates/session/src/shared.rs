//! What a session's handles and its worker share.

use crate::build::Mistake;
use crate::screen::Draft;
use crate::subject::Subject;
use crate::{Edit, Frame, Stage, Status};
use juggler::Picture;
use juggler::camera::film::Film;
use juggler::math::Rgb;
use std::collections::VecDeque;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Something to be called when there is news.
pub type Wake = Arc<dyn Fn() + Send + Sync>;

/// What a session's handles and its worker share.
#[derive(Default)]
pub struct Shared {
    desk: Mutex<Desk>,
    /// Something lies on the desk for the worker.
    work: Condvar,
    /// Something lies on the desk for who waits for pictures.
    news: Condvar,
}

/// What lies between the two.
#[derive(Default)]
pub struct Desk {
    /// Edits that wait.
    pub edits: VecDeque<Edit>,
    /// How many were asked for.
    pub asked: u64,
    /// The number of the world that is waited for; those before it were overtaken.
    pub awaited: u64,
    /// That world once it is built, or why there is none.
    pub built: Option<Result<Subject, Mistake>>,
    /// What was being rendered is done.
    pub done: bool,
    /// Nobody holds the session any more.
    pub closed: bool,
    /// What is shown.
    pub frame: Option<Arc<Frame>>,
    /// How things stand.
    pub status: Arc<Status>,
    /// What can be asked about and saved.
    pub shown: Option<Shown>,
    wakes: Vec<Wake>,
}

/// What can be asked about and saved.
#[derive(Clone)]
pub struct Shown {
    /// What is looked at.
    pub subject: Arc<Subject>,
    /// Its samples so far.
    pub film: Option<Arc<Film>>,
    /// The picture before there are samples.
    pub draft: Arc<Draft>,
    /// The picture without noise, which is what is shown where there is one.
    pub denoised: Option<Arc<[Rgb]>>,
}

impl Shown {
    /// The picture to make.
    pub fn picture(&self) -> &Arc<Picture> {
        self.subject.picture()
    }

    /// Hands the picture's rows to `rows`, from the top: denoised where it is shown so; where there are no samples yet, those
    /// of the draft.
    pub fn develop<E>(&self, mut rows: impl FnMut(&[Rgb]) -> Result<(), E>) -> Result<(), E> {
        if let Some(pixels) = &self.denoised {
            return pixels.chunks(self.picture().size()[0].max(1) as usize).try_for_each(rows);
        }
        let (size, draft, gains) = (self.picture().size(), &self.draft, self.subject.gains());
        let row = |y: u32| -> Vec<Rgb> { (0..size[0]).map(|x| draft.at([x, y], size)).collect() };
        let Some(film) = &self.film else { return (0..size[1]).try_for_each(|y| rows(&row(y))) };
        for (number, band) in (0..).zip(film.layout().bands()) {
            let mut pixels: Vec<Rgb> = (band.y..band.y + band.height).flat_map(row).collect();
            for tile in film.layout().in_band(number).filter_map(|tile| film.tile(tile as usize)) {
                if tile.count() > 0 {
                    tile.pixels().copy(&self.subject.light(&tile, &gains), &band, &mut pixels);
                }
            }
            rows(&pixels)?;
        }
        Ok(())
    }
}

impl Desk {
    /// Whether what was being rendered is done, and whether the worker has anything to turn to.
    pub fn state(&self) -> (bool, bool) {
        (self.done, self.calls())
    }

    /// Whether the worker has anything to turn to.
    pub fn calls(&self) -> bool {
        self.closed || !self.edits.is_empty() || self.built.is_some()
    }
}

impl Shared {
    /// The desk, for a moment.
    pub fn desk(&self) -> MutexGuard<'_, Desk> {
        // Poison only says that another thread panicked; every value here is whole at any time.
        self.desk.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Puts something on the worker's desk.
    pub fn tell(&self, change: impl FnOnce(&mut Desk)) {
        change(&mut self.desk());
        self.work.notify_all();
    }

    /// Asks for a change.
    pub fn edit(&self, edit: Edit) -> u64 {
        let mut asked = 0;
        self.tell(|desk| {
            desk.edits.push_back(edit);
            desk.asked += 1;
            asked = desk.asked;
        });
        asked
    }

    /// The worker waits until `ready`, or for so long; forever without.
    pub fn rest(&self, timeout: Option<Duration>, ready: impl Fn(&Desk) -> bool) {
        let desk = self.desk();
        match timeout {
            Some(timeout) => {
                let waited = self.work.wait_timeout_while(desk, timeout, |desk| !ready(desk));
                drop(waited.unwrap_or_else(PoisonError::into_inner));
            }
            None => {
                let waited = self.work.wait_while(desk, |desk| !ready(desk));
                drop(waited.unwrap_or_else(PoisonError::into_inner));
            }
        }
    }

    /// Shows something new.
    pub fn publish(&self, frame: Option<Frame>, mut status: Status, shown: Option<Shown>) {
        let mut desk = self.desk();
        let mut news = frame.is_some();
        if let Some(mut frame) = frame {
            frame.number = desk.frame.as_ref().map_or(0, |frame| frame.number) + 1;
            desk.frame = Some(Arc::new(frame));
        }
        status.number = desk.status.number;
        if status != *desk.status {
            status.number += 1;
            desk.status = Arc::new(status);
            news = true;
        }
        desk.shown = shown.or(desk.shown.take());
        let wakes = if news { desk.wakes.clone() } else { Vec::new() };
        drop(desk);
        if news {
            self.news.notify_all();
        }
        wakes.iter().for_each(|wake| wake());
    }

    /// Says that nothing more will come, and why; what is shown stays.
    pub fn end(&self, error: &str) {
        let before = Status::clone(&self.desk().status);
        self.publish(None, Status { error: Some(error.into()), stage: Stage::Finished, ..before }, None);
    }

    /// Waits for a frame or a status with a higher number.
    pub fn wait(&self, frame: u64, status: u64, timeout: Duration) -> bool {
        let old = |desk: &Desk| desk.frame.as_ref().is_none_or(|f| f.number <= frame) && desk.status.number <= status;
        let waited = self.news.wait_timeout_while(self.desk(), timeout, |desk| old(desk));
        !waited.unwrap_or_else(PoisonError::into_inner).1.timed_out()
    }

    /// Calls `wake` from now on.
    pub fn on_news(&self, wake: Wake) {
        self.desk().wakes.push(wake);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_end_is_told_and_what_is_shown_stays() {
        let shared = Shared::default();
        let status = Status { scene: "chess".into(), samples: 3.0, ..Status::default() };
        shared.publish(None, status, None);
        let seen = shared.desk().status.number;
        shared.end("error: no");
        assert!(shared.wait(u64::MAX, seen, Duration::ZERO));
        let status = Arc::clone(&shared.desk().status);
        assert_eq!((status.error.as_deref(), status.stage), (Some("error: no"), Stage::Finished));
        assert_eq!((status.scene.as_str(), status.samples), ("chess", 3.0));
    }
}
