//! Number of camera rays of each sample.

use super::wavefront::pilot;
use super::{Cancelled, Control, Job};
use juggler_camera::aov::FilmAov;
use juggler_math::UVec2;
use std::sync::OnceLock;

/// Maximum number of camera rays of a sample.
const MAX_CAMERA_RAYS: u32 = 8;
/// Number of pixels of a frame below which the number is not chosen, but 1.
const MIN_PIXELS: u64 = 320 * 180;

/// Number of camera rays of each sample of a picture: the one that its integrator demands, or one
/// chosen by the noise of a small picture of the whole frame. It depends on the scene, the camera,
/// the integrator and the size of the frame, but not on crops, samples, seeds, threads or shards.
#[derive(Debug, Default)]
pub struct CameraRays {
    /// Size of the whole frame, in pixels.
    frame: UVec2,
    /// The number chosen, once it was needed.
    chosen: OnceLock<u32>,
}

impl CameraRays {
    /// Creates the number for a whole frame of this size; it is chosen when it is needed.
    pub const fn new(frame: UVec2) -> Self {
        Self { frame, chosen: OnceLock::new() }
    }

    /// Number of camera rays of each sample of `job`, 1 to 8. The first call may render the small
    /// picture, on all threads.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] if `control` is cancelled.
    pub fn count(&self, job: &Job, control: &Control) -> Result<u32, Cancelled> {
        if job.samples == 1 {
            return Ok(1);
        }
        if let Some(count) = job.integrator.camera_rays() {
            return Ok(count.clamp(1, MAX_CAMERA_RAYS));
        }
        // Color and alpha of a transparent picture come from the same rays.
        let is_transparent = job.aovs.index_of(FilmAov::Alpha).is_some();
        if is_transparent || u64::from(self.frame.x) * u64::from(self.frame.y) < MIN_PIXELS {
            return Ok(1);
        }
        if let Some(count) = self.chosen.get() {
            return Ok(*count);
        }
        // Threads that come at the same time choose the same number.
        let count = pilot::choose_camera_rays(job, self.frame, control)?;
        Ok(*self.chosen.get_or_init(|| count))
    }
}
