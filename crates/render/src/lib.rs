//! The rendering engine: sums of samples for the pixels of a picture, on all cores, bit-identical
//! for any schedule.
//!
//! [`Job::render`] is the pure function behind all schedules: it turns a rectangle of pixels and a
//! range of samples into a [`Tile`], on any thread or machine.

use juggler_camera::ShutterCamera;
use juggler_camera::aov::FilmAovs;
use juggler_camera::film::{FilterSampler, Rect, SampleRun, Tile};
use juggler_camera::sampler::AnyPointSet;
use juggler_integrator::Integrator;
use juggler_world::World;
use juggler_world::frames::NeighborFrames;
use std::ops::Range;
use std::sync::Arc;

mod camera_ray_count;
mod camera_rays;
mod control;
mod progressive;
mod rounds;
mod schedule;
mod tile_samples;
mod wavefront;

#[cfg(test)]
mod tests;

pub use camera_ray_count::CameraRays;
pub use control::{Control, RayCounts};
pub use juggler_math::Cancelled;
pub use progressive::{
    NoiseEstimate, ProgressiveRender, Worker, estimate_noise, is_finished, is_tile_finished, max_runs,
    render_progressive,
};
pub use rounds::StopCriterion;
pub use schedule::{BAND_PIXELS, Schedule, Scheduler, band_bytes, render};
pub use wavefront::{InspectedSample, LightContribution, PathVertex, inspect};

/// Unit of work for a thread, a pass or a machine.
#[derive(Clone, Debug, PartialEq)]
pub struct Work {
    /// Pixels.
    pub pixels: Rect,
    /// Samples of each pixel.
    pub samples: Range<u32>,
    /// If the first sample lies within a block of
    /// [`BLOCK_SAMPLES`](juggler_camera::film::BLOCK_SAMPLES) samples: the sum of the block's
    /// earlier samples, for each pixel.
    pub open_block: Option<SampleRun>,
}

impl Work {
    /// Samples 0..`samples` of each pixel.
    pub fn first(pixels: Rect, samples: u32) -> Self {
        Self { pixels, samples: 0..samples, open_block: None }
    }
}

/// Everything that determines the pixels of a picture.
pub struct Job<'w> {
    /// Geometry, materials and lights.
    pub world: &'w World,
    /// Camera, over the time that the shutter is open.
    pub camera: &'w ShutterCamera,
    /// Integrator that estimates the radiance along camera rays.
    pub integrator: &'w dyn Integrator,
    /// Reconstruction filter.
    pub filter: FilterSampler,
    /// Sampling pattern.
    pub pattern: AnyPointSet,
    /// Samples per pixel of the finished picture. A single sample goes through the pixel's center
    /// at mid-shutter.
    pub samples: u32,
    /// Seed of the sampling pattern. Another seed gives other noise of the same mean.
    pub seed: u64,
    /// Number of camera rays of each sample.
    pub camera_rays: &'w CameraRays,
    /// AOVs to record.
    pub aovs: &'w FilmAovs,
    /// The scene at the previous and next frame, for
    /// [`FilmAov::Motion`](juggler_camera::aov::FilmAov::Motion). `None` records no motion.
    pub frames: Option<&'w Arc<NeighborFrames>>,
}

impl Job<'_> {
    /// Renders a piece of work; bit-identical on any machine and in any order. The tile holds the
    /// work's samples and those of the open block before them.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] if `control` is cancelled.
    pub fn render(&self, work: &Work, control: &Control) -> Result<Tile, Cancelled> {
        wavefront::Engine::new(self).render(work, control)
    }
}
