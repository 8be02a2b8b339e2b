//! The engine: pixels in, sums of samples out, on every core, the same bits whoever does what.
//!
//! [`Job::render`] is the pure function that everything else schedules: a rectangle of pixels and a range
//! of samples give a [`Tile`], on any thread or machine.

use juggler_camera::Shot;
use juggler_camera::film::{Filter, Rect, Run, Tile};
use juggler_camera::layer::Layers;
use juggler_camera::sampler::Pattern;
use juggler_integrator::Integrator;
use juggler_world::World;
use juggler_world::frames::Frames;
use std::ops::Range;
use std::sync::Arc;

mod control;
mod expose;
mod exposed;
mod progressive;
mod rounds;
mod schedule;
mod wavefront;

#[cfg(test)]
mod tests;

pub use control::{Control, Rays};
pub use progressive::{Exposure, Hand, NoiseSoFar, expose, is_finished, most_runs, noise_so_far};
pub use rounds::Stop;
pub use schedule::{BAND_PIXELS, Schedule, Scheduler, Stopped, band_bytes, render};
pub use wavefront::{Inspected, LightGain, PathVertex, inspect};

/// What a thread, a pass or a machine is given.
#[derive(Clone, Debug, PartialEq)]
pub struct Work {
    /// Which pixels.
    pub pixels: Rect,
    /// Which samples of each.
    pub samples: Range<u32>,
    /// Where the first sample is in the middle of a block of
    /// [`BLOCK`](juggler_camera::film::BLOCK): for each pixel, the sum of the block's samples
    /// before it.
    pub open: Option<Run>,
}

impl Work {
    /// The first `samples` samples.
    pub fn first(pixels: Rect, samples: u32) -> Self {
        Self { pixels, samples: 0..samples, open: None }
    }
}

/// A picture to make: everything that decides its pixels.
pub struct Job<'w> {
    /// What can be seen.
    pub world: &'w World,
    /// From where.
    pub camera: &'w Shot,
    /// How light travels.
    pub integrator: &'w dyn Integrator,
    /// How samples become pixels.
    pub filter: Filter,
    /// How samples are spread.
    pub pattern: Pattern,
    /// Samples of each pixel of the finished picture. A single one goes through the pixel's centre, half way between
    /// opening and closing of the shutter.
    pub samples: u32,
    /// Another seed, another noise.
    pub seed: u64,
    /// What is kept beside radiance.
    pub layers: &'w Layers,
    /// What the scene is at the frames beside, for
    /// [`Layer::Motion`](juggler_camera::layer::Layer::Motion); without it nothing is known of
    /// that.
    pub frames: Option<&'w Arc<Frames>>,
}

impl Job<'_> {
    /// Renders. Pure: any machine, any order, the same bits. The tile holds the work's samples, and the begun block
    /// before them. An error when `control` is cancelled.
    pub fn render(&self, work: &Work, control: &Control) -> Result<Tile, Stopped> {
        wavefront::Engine::new(self).render(work, control)
    }
}
