//! What all pages share: the session, the wheel, packed frames, the rules.

use crate::access::Access;
use crate::catalogue::Catalogue;
use crate::picture::Packer;
use crate::refusals::Refusals;
use crate::server::{Limits, Options};
use crate::wheel::{PageId, Wheel};
use juggler_session::Session;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use tokio::sync::{Semaphore, watch};

/// What all pages share.
pub struct Hub {
    /// What is looked at.
    pub session: Session,
    /// Frames as files.
    pub packer: Packer,
    /// Scenes to choose from, and names.
    pub catalogue: Catalogue,
    /// Who is let in.
    pub access: Access,
    /// What was not.
    pub refusals: Refusals,
    /// The scene file that pages may go back to.
    pub scene: Option<String>,
    /// How much of anything.
    pub limits: Limits,
    /// WebSockets that may still be opened.
    pub sockets: Arc<Semaphore>,
    /// Pictures that may be made for saving, at once.
    pub saving: Semaphore,
    news: watch::Sender<()>,
    wheel: Mutex<Wheel>,
    pages: AtomicU64,
}

impl Hub {
    /// From now on the session's news reach the pages.
    pub fn new(session: Session, options: Options, access: Access, refusals: Refusals) -> Self {
        let news = watch::Sender::new(());
        let wake = news.clone();
        session.on_news(move || {
            wake.send_replace(());
        });
        Self {
            session,
            packer: Packer::default(),
            catalogue: Catalogue::new(options.scene.as_deref()),
            access,
            refusals,
            scene: options.scene,
            limits: options.limits,
            sockets: Arc::new(Semaphore::new(options.limits.sockets)),
            saving: Semaphore::new(1),
            news,
            wheel: Mutex::default(),
            pages: AtomicU64::new(1),
        }
    }

    /// A number for a new page.
    pub fn new_page(&self) -> PageId {
        self.pages.fetch_add(1, Relaxed)
    }

    /// Wakes whenever there is a frame, a status, or somebody else steers.
    pub fn news(&self) -> watch::Receiver<()> {
        self.news.subscribe()
    }

    /// The wheel, to look at.
    pub fn wheel(&self) -> MutexGuard<'_, Wheel> {
        self.wheel.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The wheel, to turn: all pages are told.
    pub fn turn<T>(&self, change: impl FnOnce(&mut Wheel) -> T) -> T {
        let result = change(&mut self.wheel());
        self.news.send_replace(());
        result
    }
}
