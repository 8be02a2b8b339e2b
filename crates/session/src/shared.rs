//! What a session's handles and its worker share.

use crate::subject::Subject;
use crate::{Edit, Frame, Status};
use juggler::Picture;
use juggler::tracer::film::Film;
use juggler::tracer::render::Control;
use std::collections::VecDeque;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

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
    /// A world that was built, or why there is none, with the number of its order.
    pub built: Option<(u64, Result<Subject, String>)>,
    /// The film is exposed.
    pub exposed: bool,
    /// Nobody holds the session any more.
    pub closed: bool,
    /// What is being rendered.
    pub rendering: Option<Rendering>,
    /// What is shown.
    pub frame: Option<Arc<Frame>>,
    /// How things stand.
    pub status: Arc<Status>,
    /// What can be asked about and saved.
    pub shown: Option<Shown>,
    wakes: Vec<Wake>,
}

/// What is being rendered.
pub struct Rendering {
    /// Ends it.
    pub control: Arc<Control>,
    /// Until when it is not to be disturbed: a frame that will be ready soon is worth more than none.
    pub until: Option<Instant>,
}

/// What can be asked about and saved.
#[derive(Clone)]
pub struct Shown {
    /// What is looked at.
    pub subject: Arc<Subject>,
    /// Its samples so far.
    pub film: Arc<Film>,
}

impl Shown {
    /// The picture to make.
    pub fn picture(&self) -> &Arc<Picture> {
        self.subject.picture()
    }
}

impl Desk {
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

    /// Asks for a change; what is being rendered ends, unless it is a frame that is ready soon.
    pub fn edit(&self, edit: Edit) -> u64 {
        let mut desk = self.desk();
        desk.edits.push_back(edit);
        desk.asked += 1;
        if let Some(rendering) = &desk.rendering
            && rendering.until.is_none_or(|until| until <= Instant::now())
        {
            rendering.control.cancel();
        }
        let asked = desk.asked;
        drop(desk);
        self.work.notify_all();
        asked
    }

    /// Nobody holds the session any more.
    pub fn close(&self) {
        self.tell(|desk| {
            desk.closed = true;
            if let Some(rendering) = &desk.rendering {
                rendering.control.cancel();
            }
        });
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
