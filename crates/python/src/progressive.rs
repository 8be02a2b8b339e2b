//! Renders that show an image now and then.

use crate::image::Image;
use crate::state::{self, Built};
use crate::task::{self, Fault, Monitor, Task, Watch};
use juggler::camera::film::Film;
use juggler::{BuildControl, Error, RenderedImage};
use pyo3::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Minimum interval between images, in seconds.
const MIN_INTERVAL: f64 = 0.02;

/// World and film of a render, once its rays are traced.
type Begun = Arc<Mutex<Option<(Arc<Built>, Arc<Film>, Instant)>>>;

/// Iterator over images of a render that goes on meanwhile; the last one is complete.
#[pyclass(frozen, module = "juggler._native")]
pub struct Progressive {
    task: Task<RenderedImage>,
    begun: Begun,
    every: Duration,
    is_done: AtomicBool,
}

impl Progressive {
    /// Starts a render of the scene that `build` builds.
    pub fn start(
        py: Python<'_>,
        threads: usize,
        every: f64,
        build: impl FnOnce(&BuildControl) -> Result<Arc<Built>, Error> + Send + 'static,
    ) -> PyResult<Self> {
        let begun = Begun::default();
        let shared = Arc::clone(&begun);
        let task = Task::start(py, threads, move |monitor: &Monitor| {
            let built = build(monitor.control.build())?;
            let (film, start) = (Arc::new(built.picture.film()), Instant::now());
            let begin = (Arc::clone(&built), Arc::clone(&film), start);
            *shared.lock().unwrap_or_else(PoisonError::into_inner) = Some(begin);
            state::finish(&built.picture, &film, start, monitor)
        })?;
        let every = Duration::try_from_secs_f64(every.max(MIN_INTERVAL)).unwrap_or(Duration::MAX);
        Ok(Self { task, begun, every, is_done: AtomicBool::new(false) })
    }

    /// World of the render, once it is built.
    pub fn built(&self) -> Option<Arc<Built>> {
        self.begin().map(|(built, ..)| built)
    }

    fn begin(&self) -> Option<(Arc<Built>, Arc<Film>, Instant)> {
        self.begun.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

#[pymethods]
impl Progressive {
    fn __iter__(this: PyRef<'_, Self>) -> PyRef<'_, Self> {
        this
    }

    fn __next__(&self, py: Python<'_>) -> PyResult<Option<Image>> {
        if self.is_done.load(Relaxed) {
            return Ok(None);
        }
        loop {
            let result = self.task.wait(py, &Watch::default(), self.every);
            let frame = self.built().map_or(0.0, |built| built.frame);
            if let Some(image) = result.inspect_err(|_| self.is_done.store(true, Relaxed))? {
                self.is_done.store(true, Relaxed);
                return Ok(Some(Image::new(image, frame)));
            }
            if let Some((built, film, start)) = self.begin() {
                let control = &self.task.monitor().control;
                let snapshot = || built.picture.snapshot(&film, start.elapsed(), control);
                let image = task::guarded(|| py.detach(snapshot)).map_err(Fault::into_exception)?;
                return Ok(Some(Image::new(image, frame)));
            }
        }
    }

    /// Finished share of the render, and the seconds so far.
    fn progress(&self) -> (f64, f64) {
        let share = self.task.monitor().share();
        (share, self.task.elapsed().as_secs_f64())
    }

    /// Whether the last image was complete.
    fn is_done(&self) -> bool {
        self.is_done.load(Relaxed)
    }

    /// Ends the render.
    fn cancel(&self) {
        self.task.monitor().control.cancel();
    }
}
