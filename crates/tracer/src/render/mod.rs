//! The engine: pixels in, sums of samples out, on every core, the same bits whoever does what.
//!
//! [`Job::render`] is the pure function that everything else schedules: a rectangle of pixels and a range
//! of samples give a [`Tile`], on any thread or machine.

use crate::camera::Projection;
use crate::film::{Filter, PixelSum};
use crate::integrator::Integrator;
use crate::sampler::Pattern;
use crate::world::World;
use juggler_math::Rgb;
use std::ops::Range;

mod control;
mod expose;
mod schedule;
mod wavefront;

#[cfg(test)]
mod tests;

pub use control::{Control, Rays};
pub use schedule::{Scheduler, Stopped, band_bytes, render};

/// A rectangle of pixels; x to the right, y down, from the picture's top left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rect {
    /// First column.
    pub x: u32,
    /// First row.
    pub y: u32,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

impl Rect {
    /// How many pixels.
    pub fn area(&self) -> u64 {
        u64::from(self.width) * u64::from(self.height)
    }
}

/// What a thread, a pass or a machine is given.
#[derive(Clone, Debug, PartialEq)]
pub struct Work {
    /// Which pixels.
    pub pixels: Rect,
    /// Which samples of each; the start is a multiple of [`crate::film::BLOCK`].
    pub samples: Range<u32>,
}

/// The result of one [`Work`].
#[derive(Clone, Debug, PartialEq)]
pub struct Tile {
    /// Which pixels.
    pub pixels: Rect,
    /// Their sums, row by row.
    pub sums: Vec<PixelSum>,
}

/// A picture to make: everything that decides its pixels.
pub struct Job<'w> {
    /// What can be seen.
    pub world: &'w World,
    /// From where.
    pub camera: &'w Projection,
    /// How light travels.
    pub integrator: &'w dyn Integrator,
    /// How samples become pixels.
    pub filter: Filter,
    /// How samples are spread.
    pub pattern: Pattern,
    /// Samples of each pixel of the finished picture. A single one goes through the pixel's centre.
    pub samples: u32,
    /// Another seed, another noise.
    pub seed: u64,
}

impl Job<'_> {
    /// Renders. Pure: any machine, any order, the same bits. When `control` is cancelled, what is left
    /// counts as black.
    pub fn render(&self, work: &Work, control: &Control) -> Tile {
        wavefront::Engine::new(self).render(work, control)
    }

    /// The finished pixels of a tile that holds all samples.
    pub fn finish(&self, tile: &Tile) -> Vec<Rgb> {
        tile.sums.iter().map(|sum| sum.mean(self.samples)).collect()
    }
}
