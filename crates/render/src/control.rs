//! What goes in and out of a running render from other threads.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};

/// How many rays were traced.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rays {
    /// From the camera.
    pub camera: u64,
    /// Towards lights, and for ambient occlusion.
    pub shadow: u64,
    /// Mirrored, refracted.
    pub secondary: u64,
    /// Samples whose radiance was not a finite number and was counted as black.
    pub not_finite: u64,
}

impl Rays {
    /// All rays.
    pub fn total(&self) -> u64 {
        self.camera + self.shadow + self.secondary
    }
}

/// Progress out, a wish to stop in.
#[derive(Debug, Default)]
pub struct Control {
    cancelled: AtomicBool,
    finishing: AtomicBool,
    samples: AtomicU64,
    camera: AtomicU64,
    shadow: AtomicU64,
    secondary: AtomicU64,
    not_finite: AtomicU64,
}

impl Control {
    /// Asks the render to stop soon.
    pub fn cancel(&self) {
        self.cancelled.store(true, Relaxed);
    }

    /// Whether somebody asked.
    pub fn is_cancelled(&self) -> bool {
        self.cancelled.load(Relaxed)
    }

    /// Asks for no new samples to be begun: what is begun is done, and the render ends as if that had been all.
    pub fn finish(&self) {
        self.finishing.store(true, Relaxed);
    }

    /// Whether somebody asked to finish, or to cancel.
    pub fn is_finishing(&self) -> bool {
        self.finishing.load(Relaxed) || self.is_cancelled()
    }

    /// Samples done so far, over all pixels.
    pub fn samples(&self) -> u64 {
        self.samples.load(Relaxed)
    }

    /// Rays traced so far.
    pub fn rays(&self) -> Rays {
        Rays {
            camera: self.camera.load(Relaxed),
            shadow: self.shadow.load(Relaxed),
            secondary: self.secondary.load(Relaxed),
            not_finite: self.not_finite.load(Relaxed),
        }
    }

    pub(crate) fn add(&self, samples: u64, rays: &Rays) {
        self.samples.fetch_add(samples, Relaxed);
        self.camera.fetch_add(rays.camera, Relaxed);
        self.shadow.fetch_add(rays.shadow, Relaxed);
        self.secondary.fetch_add(rays.secondary, Relaxed);
        self.not_finite.fetch_add(rays.not_finite, Relaxed);
    }
}
