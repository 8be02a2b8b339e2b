//! State shared by all pages: session, steering, encoded frames and rules.

use crate::access::Access;
use crate::catalog::Catalog;
use crate::encoded_frame::FrameEncoder;
use crate::refusal_log::RefusalLog;
use crate::server::{Limits, ServerOptions};
use crate::uploads::Uploads;
use crate::wheel::{PageId, Wheel};
use juggler_session::Session;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use tokio::sync::{Semaphore, watch};

/// State shared by all pages.
pub struct ServerState {
    /// Rendering session.
    pub session: Session,
    /// Encoder of frames.
    pub encoder: FrameEncoder,
    /// Scenes and names to choose from.
    pub catalog: Catalog,
    /// Access rules.
    pub access: Access,
    /// Log of refusals.
    pub refusals: RefusalLog,
    /// Scene file that pages may open.
    pub scene: Option<String>,
    /// Resource limits.
    pub limits: Limits,
    /// Permits for WebSockets.
    pub sockets: Arc<Semaphore>,
    /// Permit for encoding an image to be saved, one at a time.
    pub saving: Semaphore,
    /// Uploads of dropped files.
    pub uploads: Uploads,
    updates: watch::Sender<()>,
    wheel: Mutex<Wheel>,
    pages: AtomicU64,
}

impl ServerState {
    /// Creates the state and forwards the session's notifications to the pages.
    pub fn new(session: Session, options: ServerOptions, access: Access, refusals: RefusalLog) -> Self {
        let updates = watch::Sender::new(());
        let wake = updates.clone();
        session.on_update(move || {
            wake.send_replace(());
        });
        Self {
            session,
            encoder: FrameEncoder::default(),
            catalog: Catalog::new(options.scene.as_deref(), options.limits.dropped_bytes),
            access,
            refusals,
            scene: options.scene,
            limits: options.limits,
            sockets: Arc::new(Semaphore::new(options.limits.sockets)),
            saving: Semaphore::new(1),
            uploads: Uploads::new(&options.limits),
            updates,
            wheel: Mutex::default(),
            pages: AtomicU64::new(1),
        }
    }

    /// Returns an ID for a new page.
    pub fn new_page(&self) -> PageId {
        self.pages.fetch_add(1, Relaxed)
    }

    /// Returns a receiver that is notified of frames, statuses and changes of steering.
    pub fn updates(&self) -> watch::Receiver<()> {
        self.updates.subscribe()
    }

    /// Locks the wheel.
    pub fn wheel(&self) -> MutexGuard<'_, Wheel> {
        self.wheel.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Changes the wheel and notifies all pages.
    pub fn change_wheel<T>(&self, change: impl FnOnce(&mut Wheel) -> T) -> T {
        let result = change(&mut self.wheel());
        self.updates.send_replace(());
        result
    }
}
