//! Progress and cancellation of a running render, shared with other threads.

use juggler_math::BuildControl;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};

/// Numbers of rays traced.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RayCounts {
    /// Camera rays.
    pub camera: u64,
    /// Shadow rays and ambient occlusion rays.
    pub shadow: u64,
    /// Rays that continue paths: reflected, refracted and scattered ones.
    pub secondary: u64,
    /// Number of samples that were not finite and were counted as black.
    pub not_finite: u64,
}

impl RayCounts {
    /// Total number of rays.
    pub fn total(&self) -> u64 {
        self.camera + self.shadow + self.secondary
    }
}

/// Progress of a render, and requests to end it. All methods may be called from any thread.
#[derive(Debug, Default)]
pub struct Control {
    /// Control of the build before the render, which holds the request for cancellation.
    build: BuildControl,
    finishing: AtomicBool,
    samples: AtomicU64,
    camera: AtomicU64,
    shadow: AtomicU64,
    secondary: AtomicU64,
    not_finite: AtomicU64,
}

impl Control {
    /// Control of the build before the render. Cancelling either cancels both.
    pub fn build(&self) -> &BuildControl {
        &self.build
    }

    /// Requests cancellation. Unfinished tiles are discarded.
    pub fn cancel(&self) {
        self.build.cancel();
    }

    /// Whether cancellation was requested.
    pub fn is_cancelled(&self) -> bool {
        self.build.is_cancelled()
    }

    /// Requests an early end: tiles in progress are completed, and no further samples are started.
    pub fn finish(&self) {
        self.finishing.store(true, Relaxed);
    }

    /// Whether an early end or cancellation was requested.
    pub fn is_finishing(&self) -> bool {
        self.finishing.load(Relaxed) || self.is_cancelled()
    }

    /// Number of finished samples, over all pixels.
    pub fn samples(&self) -> u64 {
        self.samples.load(Relaxed)
    }

    /// Numbers of rays traced so far.
    pub fn rays(&self) -> RayCounts {
        RayCounts {
            camera: self.camera.load(Relaxed),
            shadow: self.shadow.load(Relaxed),
            secondary: self.secondary.load(Relaxed),
            not_finite: self.not_finite.load(Relaxed),
        }
    }

    pub(crate) fn add(&self, samples: u64, rays: &RayCounts) {
        self.samples.fetch_add(samples, Relaxed);
        self.camera.fetch_add(rays.camera, Relaxed);
        self.shadow.fetch_add(rays.shadow, Relaxed);
        self.secondary.fetch_add(rays.secondary, Relaxed);
        self.not_finite.fetch_add(rays.not_finite, Relaxed);
    }
}
