//! Work on the threads of a pool, on which the calling thread waits. The waiting thread lets other
//! Python threads run, handles signals and calls back; the pool's threads never touch Python.

use crate::errors;
use crate::threads::{self, Use};
use juggler::film::{MergeError, PartialRenderError};
use juggler::imaging::ImageError;
use juggler::render::{Cancelled, Control};
use juggler::scene::SceneError;
use juggler::{BuildControl, Error};
use pyo3::prelude::*;
use rayon::ThreadPool;
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Interval between checks for signals and cancellation.
const TICK: Duration = Duration::from_millis(50);
/// Minimum interval between calls of a progress callback.
const CALL_INTERVAL: Duration = Duration::from_millis(100);

/// Why work failed.
pub enum Fault {
    /// Error of the renderer.
    Renderer(Error),
    /// Panic with this message.
    Panic(String),
}

/// Converts errors of the renderer.
macro_rules! from_errors {
    ($($error:ty),*) => {
        $(impl From<$error> for Fault {
            fn from(error: $error) -> Self {
                Self::Renderer(error.into())
            }
        })*
    };
}

from_errors!(Error, SceneError, ImageError, Cancelled, MergeError, PartialRenderError);

impl Fault {
    /// The exception.
    pub fn into_exception(self) -> PyErr {
        match self {
            Self::Renderer(error) => errors::convert(error),
            Self::Panic(message) => errors::internal(&format!(
                "the renderer failed unexpectedly: {message}; please report this with the scene and `show_config()`"
            )),
        }
    }
}

/// Function that returns the finished share of a render and the number of seconds left, if known.
type Estimate = dyn Fn(&Control) -> (f64, Option<f64>) + Send;

/// Cancellation and progress of work, shared with the thread that waits.
#[derive(Default)]
pub struct Monitor {
    /// Control of the render, which contains that of the build.
    pub control: Control,
    estimate: Mutex<Option<Box<Estimate>>>,
}

impl Monitor {
    /// Begins the stage of which `estimate` reports the progress.
    pub fn set_estimate(&self, estimate: impl Fn(&Control) -> (f64, Option<f64>) + Send + 'static) {
        *self.estimate.lock().unwrap_or_else(PoisonError::into_inner) = Some(Box::new(estimate));
    }

    /// Finished share, 0 while the world is built.
    pub fn share(&self) -> f64 {
        self.progress().map_or(0.0, |(share, _)| share.clamp(0.0, 1.0))
    }

    /// Finished share and seconds left; `None` while the world is built.
    fn progress(&self) -> Option<(f64, Option<f64>)> {
        let estimate = self.estimate.lock().unwrap_or_else(PoisonError::into_inner);
        estimate.as_ref().map(|estimate| estimate(&self.control))
    }
}

/// Request of another thread to cancel work.
#[pyclass(frozen, module = "juggler._native")]
#[derive(Default)]
pub struct Canceler {
    is_cancelled: AtomicBool,
}

#[pymethods]
impl Canceler {
    #[new]
    fn new() -> Self {
        Self::default()
    }

    /// Cancels the work that was started with this object.
    fn cancel(&self) {
        self.is_cancelled.store(true, Relaxed);
    }
}

/// What the thread that waits for work calls and watches.
#[derive(Default)]
pub struct Watch {
    /// Function that takes the stage, its share, the seconds so far and left, and the samples.
    pub callback: Option<Py<PyAny>>,
    /// Request to cancel.
    pub canceler: Option<Py<Canceler>>,
}

impl Watch {
    fn check(&self, py: Python<'_>) -> PyResult<()> {
        py.check_signals()?;
        match &self.canceler {
            Some(canceler) if canceler.get().is_cancelled.load(Relaxed) => Err(errors::cancelled()),
            _ => Ok(()),
        }
    }

    fn call(&self, py: Python<'_>, monitor: &Monitor, start: Instant) -> PyResult<()> {
        let Some(callback) = &self.callback else { return Ok(()) };
        let (stage, share, left) = match monitor.progress() {
            None => (monitor.control.build().stage().name(), monitor.control.build().share(), None),
            Some((share, left)) => ("rendering", share.clamp(0.0, 1.0), left),
        };
        let seconds = start.elapsed().as_secs_f64();
        callback.call1(py, (stage, share, seconds, left, monitor.control.samples())).map(drop)
    }
}

/// What work returns, once it has ended.
type Outcome<T> = Arc<Mutex<Option<Result<T, Fault>>>>;

/// Work in progress. It is cancelled when the task is dropped.
pub struct Task<T> {
    monitor: Arc<Monitor>,
    /// Receives one message at the end of the work. The outcome itself is not sent: a channel for
    /// each type of it would be 2 % of the module.
    end: Mutex<Receiver<()>>,
    outcome: Outcome<T>,
    process: u32,
    start: Instant,
}

impl<T: Send + 'static> Task<T> {
    /// Starts a render on a pool of this many threads.
    pub fn start(
        py: Python<'_>,
        threads: usize,
        work: impl FnOnce(&Monitor) -> Result<T, Fault> + Send + 'static,
    ) -> PyResult<Self> {
        Ok(Self::start_on(&threads::pool(py, threads, Use::Render)?, work))
    }

    fn start_on(pool: &Arc<ThreadPool>, work: impl FnOnce(&Monitor) -> Result<T, Fault> + Send + 'static) -> Self {
        let (monitor, (sender, receiver)) = (Arc::new(Monitor::default()), mpsc::channel());
        let (shared, busy, outcome) = (Arc::clone(&monitor), Arc::clone(pool), Outcome::default());
        let result = Arc::clone(&outcome);
        pool.spawn(move || {
            let ended = guarded(|| work(&shared)).flatten();
            *result.lock().unwrap_or_else(PoisonError::into_inner) = Some(ended);
            drop(busy);
            // The task may have been abandoned.
            sender.send(()).ok();
        });
        let end = Mutex::new(receiver);
        Self { monitor, end, outcome, process: std::process::id(), start: Instant::now() }
    }

    /// Waits for the result, at most this long; `None` if the work takes longer. An exception of a
    /// signal handler or of the callback cancels the work.
    pub fn wait(&self, py: Python<'_>, watch: &Watch, most: Duration) -> PyResult<Option<T>> {
        let (start, mut last_call) = (Instant::now(), Instant::now());
        loop {
            let tick = TICK.min(most.saturating_sub(start.elapsed()));
            let end = py.detach(|| {
                let end = self.end.lock().unwrap_or_else(PoisonError::into_inner);
                end.recv_timeout(tick)
            });
            if end != Err(RecvTimeoutError::Timeout) {
                let outcome = self.outcome.lock().unwrap_or_else(PoisonError::into_inner).take();
                let Some(outcome) = outcome else { return Err(errors::internal("the work ended without a result")) };
                return outcome.map(Some).map_err(Fault::into_exception);
            }
            if std::process::id() != self.process {
                return Err(errors::forked());
            }
            let mut seen = watch.check(py);
            if seen.is_ok() && last_call.elapsed() >= CALL_INTERVAL {
                last_call = Instant::now();
                seen = watch.call(py, &self.monitor, self.start);
            }
            if let Err(error) = seen {
                self.monitor.control.cancel();
                return Err(error);
            }
            if start.elapsed() >= most {
                return Ok(None);
            }
        }
    }

    /// Cancellation and progress of the work.
    pub fn monitor(&self) -> &Monitor {
        &self.monitor
    }

    /// Time since the start.
    pub fn elapsed(&self) -> Duration {
        self.start.elapsed()
    }
}

impl<T> Drop for Task<T> {
    fn drop(&mut self) {
        self.monitor.control.cancel();
    }
}

/// Renders on a pool of this many threads and returns the result.
pub fn run<T: Send + 'static>(
    py: Python<'_>,
    threads: usize,
    watch: &Watch,
    work: impl FnOnce(&Monitor) -> Result<T, Fault> + Send + 'static,
) -> PyResult<T> {
    let task = Task::start(py, threads, work)?;
    task.wait(py, watch, Duration::MAX)?.ok_or_else(errors::cancelled)
}

/// Does work on this very thread. A panic becomes a fault.
pub fn guarded<T>(work: impl FnOnce() -> T) -> Result<T, Fault> {
    catch_unwind(AssertUnwindSafe(work)).map_err(|panic| Fault::Panic(panic_message(panic.as_ref())))
}

/// Does short work, which reports no progress and waits for no render.
pub fn call<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce() -> Result<T, Fault> + Send + 'static,
) -> PyResult<T> {
    read(py, |_| work())
}

/// Reads a scene or the like, which waits for no render. The work looks at the control, which an
/// exception of a signal handler cancels.
pub fn read<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce(&BuildControl) -> Result<T, Fault> + Send + 'static,
) -> PyResult<T> {
    let pool = threads::pool(py, threads::thread_count(None)?, Use::Short)?;
    let task = Task::start_on(&pool, |monitor| work(monitor.control.build()));
    task.wait(py, &Watch::default(), Duration::MAX)?.ok_or_else(errors::cancelled)
}

fn panic_message(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_else(|| "a panic without a message".to_owned())
}

/// Panics on a thread of the pool, for tests.
#[pyfunction]
#[expect(clippy::panic, reason = "tests need a panic")]
pub fn panic_on_a_thread(py: Python<'_>) -> PyResult<()> {
    call(py, || panic!("a panic for tests"))
}
