//! Several camera rays for each sample (splitting; Arvo and Kirk, Particle Transport and Image
//! Synthesis, 1990). Their film positions are one finer set of points if the sampler has one. All
//! other numbers of the additional rays come from a stream of their own.

use super::Pixel;
use juggler_camera::LANES;
use juggler_camera::sampler::Sampler;
use juggler_integrator::{PathHistory, PathState, Queue};
use juggler_math::Vec2;
use std::ops::Range;

/// Sampler branch of the additional camera rays.
const SPLIT_BRANCH: u32 = (1 << 31) + 1;

impl Pixel<'_> {
    /// Pushes the rays of the samples `first` and following, sample by sample.
    pub(super) fn push_split_rays(&self, first: u32, slots: Range<u32>, queue: &mut Queue) {
        let rays = self.start.camera_rays;
        for start in (0..slots.len() as u32 * rays).step_by(LANES) {
            let count = LANES.min((slots.len() as u32 * rays - start) as usize);
            let number = |i: usize| ((start + i as u32) / rays, (start + i as u32) % rays);
            let all: [(Vec2, Sampler); LANES] = std::array::from_fn(|i| {
                let (sample, ray) = number(i);
                self.split_ray(first + sample, ray)
            });
            let (points, samplers) = (all.map(|(point, _)| point), all.map(|(_, sampler)| sampler));
            self.push_packet(&points[..count], &samplers, queue, |i, weight| {
                let (sample, ray) = number(i);
                let path = self.path(&samplers[i], slots.start + sample, weight);
                PathState { history: PathHistory { is_split: ray > 0, ..path.history }, ..path }
            });
        }
    }

    /// Point in [0, 1)² from which the film position of a camera ray of a sample follows, and the
    /// sampler of the ray at its first dimension.
    fn split_ray(&self, sample: u32, ray: u32) -> (Vec2, Sampler) {
        let (rays, first) = (self.start.camera_rays, self.sampler(sample));
        let sampler = match ray.checked_sub(1) {
            None => first,
            Some(additional) => first.branch(SPLIT_BRANCH).subsequence(additional, rays - 1),
        };
        (first.film_point(ray, rays).unwrap_or_else(|| sampler.skipped(0).next_2d()), sampler)
    }
}
