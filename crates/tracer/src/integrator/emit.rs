//! What an integrator may do at a vertex.

use super::Path;
use crate::sampler::Sampler;
use juggler_math::{Ray, Rgb};

/// A ray in the engine's queues, apart from the [`Ray`] itself.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Flight {
    pub weight: Rgb,
    pub slot: u32,
    pub depth: u32,
    pub sampler: Sampler,
}

/// Rays in flight, in order of their slots.
#[derive(Debug, Default)]
pub(crate) struct Queue {
    pub rays: Vec<Ray>,
    pub flights: Vec<Flight>,
}

impl Queue {
    pub fn push(&mut self, ray: Ray, flight: Flight) {
        self.rays.push(ray);
        self.flights.push(flight);
    }

    pub fn len(&self) -> usize {
        self.rays.len()
    }

    pub fn clear(&mut self) {
        self.rays.clear();
        self.flights.clear();
    }
}

/// Questions whether a light is seen, and what it adds when it is.
#[derive(Debug, Default)]
pub(crate) struct ShadowQueue {
    pub rays: Vec<Ray>,
    pub radiance: Vec<Rgb>,
    pub slots: Vec<u32>,
}

/// Everything that a segment of the queue brings forth; kept and emptied by the engine.
#[derive(Debug, Default)]
pub(crate) struct Harvest {
    /// What each sample has gathered.
    pub radiance: Vec<Rgb>,
    /// One queue a light, whose rays run much the same way, and at the end one for rays that do not.
    pub shadows: Vec<ShadowQueue>,
    /// Rays that go on.
    pub next: Queue,
}

impl Harvest {
    /// For samples 0..`slots` and a world of `lights` lights.
    pub fn reset(&mut self, slots: usize, lights: usize) {
        self.radiance.clear();
        self.radiance.resize(slots, Rgb::BLACK);
        self.shadows.resize_with(lights.min(MAX_LIGHT_QUEUES) + 1, ShadowQueue::default);
    }

    /// Shadow rays that wait.
    pub fn pending(&self) -> usize {
        self.shadows.iter().map(|queue| queue.rays.len()).sum()
    }
}

/// More lights than this share queues.
const MAX_LIGHT_QUEUES: usize = 64;

/// What an integrator may do at a vertex: add, ask, go on.
pub struct Emit<'a> {
    harvest: &'a mut Harvest,
    weight: Rgb,
    slot: u32,
    depth: u32,
    sampler: Sampler,
}

impl<'a> Emit<'a> {
    pub(crate) fn new(harvest: &'a mut Harvest, path: &Path, slot: u32) -> Self {
        Self { harvest, weight: path.weight, slot, depth: path.depth, sampler: path.sampler }
    }

    /// Adds to the sample, times the path's weight.
    #[inline]
    pub fn add(&mut self, radiance: Rgb) {
        self.harvest.radiance[self.slot as usize] += radiance * self.weight;
    }

    /// Adds, times the path's weight, what of `radiance` comes through along `ray` from light number `light`.
    #[inline]
    pub fn if_light_visible(&mut self, light: usize, ray: Ray, radiance: Rgb) {
        let last = self.harvest.shadows.len() - 1;
        self.push_shadow(light % last.max(1), ray, radiance);
    }

    /// The same for a ray of no particular direction.
    #[inline]
    pub fn if_visible(&mut self, ray: Ray, radiance: Rgb) {
        self.push_shadow(self.harvest.shadows.len() - 1, ray, radiance);
    }

    fn push_shadow(&mut self, queue: usize, ray: Ray, radiance: Rgb) {
        let radiance = radiance * self.weight;
        if radiance.is_black() {
            return;
        }
        let queue = &mut self.harvest.shadows[queue];
        queue.rays.push(ray);
        queue.radiance.push(radiance);
        queue.slots.push(self.slot);
    }

    /// Follows `ray`, the `child`-th that leaves this vertex; what it finds counts `weight` times as much.
    #[inline]
    pub fn go_on(&mut self, ray: Ray, weight: Rgb, child: u32) {
        let flight = Flight {
            weight: self.weight * weight,
            slot: self.slot,
            depth: self.depth + 1,
            sampler: self.sampler.branch(child),
        };
        self.harvest.next.push(ray, flight);
    }
}
