//! Interleaved traversal of many rays through a tree larger than the cache: while one ray waits for
//! a node from memory, the others proceed.
//!
//! Each step takes one ray through one node or leaf, prefetches the memory that the ray needs next,
//! and turns to the next ray; finished rays are replaced. The rays need not be coherent.

use super::TriangleHit;
use super::filter::Filter;
use super::query::Query;
use super::ray_visitor::RayVisitor;
use crate::Leaf;
use crate::lanes::Lanes;
use crate::node::Child;
use crate::single::{TraversalMemory, last_child, nearest, pop_nearer_than};
use crate::slabs::{Slabs, cull_distance};
use crate::stack::{Stack, StackView};
use arrayvec::ArrayVec;
use fearless_simd::prelude::*;
use juggler_math::Ray;

/// Number of interleaved rays. A cache miss takes as long as about a dozen steps.
const IN_FLIGHT: usize = 16;

/// Stacks of the rays in flight, apart from the rays, so that a ray moves without its stack.
type Stacks = [Stack; IN_FLIGHT];

/// A ray in flight.
struct RayInFlight<'a, S: Simd, F> {
    /// Index of the ray in the slice.
    number: usize,
    ray: Ray,
    slabs: Slabs,
    ray_visitor: RayVisitor<'a, S, F>,
    current: Child,
    /// Index of the ray's stack.
    stack: usize,
}

impl<'a, S: Lanes, F: Filter> RayInFlight<'a, S, F> {
    #[inline(always)]
    fn new(simd: S, query: Query<'a, F>, number: usize, ray: &Ray, stack: usize) -> Self {
        let slabs = Slabs::of_ray(simd, ray);
        let ray_visitor = RayVisitor::new(simd, query, ray, &slabs);
        Self { number, ray: *ray, slabs, ray_visitor, current: Child::ROOT, stack }
    }

    #[inline(always)]
    fn restart(&mut self, simd: S, query: Query<'a, F>, number: usize, ray: &Ray) {
        self.number = number;
        self.ray = *ray;
        self.slabs = Slabs::of_ray(simd, ray);
        self.ray_visitor = RayVisitor::new(simd, query, ray, &self.slabs);
        self.current = Child::ROOT;
    }

    #[inline(always)]
    fn view<'s>(&self, stacks: &'s mut Stacks) -> StackView<'s> {
        stacks[self.stack % IN_FLIGHT].view()
    }
}

impl<'a, F: Filter> Query<'a, F> {
    /// [`TriangleBvh::closest`](super::TriangleBvh::closest) of all rays.
    #[inline(always)]
    pub(super) fn closest_in_flight<S: Lanes>(&self, simd: S, rays: &mut [Ray], hits: &mut [Option<TriangleHit>]) {
        let mut stacks: Stacks = std::array::from_fn(|_| Stack::new());
        let mut flights = self.start_rays(simd, rays);
        let mut waiting = flights.len();
        let mut at = 0;
        while !flights.is_empty() {
            at = if at + 1 < flights.len() { at + 1 } else { 0 };
            let flight = &mut flights[at];
            if self.closest_step(simd, flight, &mut stacks) {
                continue;
            }
            let number = flight.number;
            hits[number] = flight.ray_visitor.hit;
            if let Some(hit) = flight.ray_visitor.hit {
                rays[number].t_max = hit.t;
            }
            stacks[flight.stack % IN_FLIGHT].clear();
            self.replace(simd, &mut flights, at, (waiting, rays.get(waiting)));
            waiting += 1;
        }
    }

    /// [`TriangleBvh::any`](super::TriangleBvh::any) of all rays.
    #[inline(always)]
    pub(super) fn any_in_flight<S: Lanes>(&self, simd: S, rays: &[Ray], occluded: &mut [bool]) {
        let mut stacks: Stacks = std::array::from_fn(|_| Stack::new());
        let mut flights = self.start_rays(simd, rays);
        let mut waiting = flights.len();
        let mut at = 0;
        while !flights.is_empty() {
            at = if at + 1 < flights.len() { at + 1 } else { 0 };
            let flight = &mut flights[at];
            let Some(found) = self.any_step(simd, flight, &mut stacks) else { continue };
            occluded[flight.number] = found;
            stacks[flight.stack % IN_FLIGHT].clear();
            self.replace(simd, &mut flights, at, (waiting, rays.get(waiting)));
            waiting += 1;
        }
    }

    /// Starts the first rays.
    #[inline(always)]
    fn start_rays<S: Lanes>(&self, simd: S, rays: &[Ray]) -> ArrayVec<RayInFlight<'a, S, F>, IN_FLIGHT> {
        let mut flights = ArrayVec::new();
        for (number, ray) in rays.iter().enumerate().take(IN_FLIGHT) {
            flights.push(RayInFlight::new(simd, *self, number, ray, number));
        }
        flights
    }

    /// Replaces a finished ray by the next one, or removes its slot if none is left.
    #[inline(always)]
    fn replace<S: Lanes>(
        &self,
        simd: S,
        flights: &mut ArrayVec<RayInFlight<'a, S, F>, IN_FLIGHT>,
        at: usize,
        (number, next): (usize, Option<&Ray>),
    ) {
        match next {
            Some(ray) => flights[at].restart(simd, *self, number, ray),
            None => _ = flights.swap_remove(at),
        }
    }

    /// Advances a ray by one node or leaf. Returns whether it continues.
    #[inline(always)]
    fn closest_step<S: Lanes>(&self, simd: S, flight: &mut RayInFlight<S, F>, stacks: &mut Stacks) -> bool {
        let next = if flight.current.is_leaf() {
            flight.ray_visitor.closest(flight.number, &mut flight.ray, flight.current.items());
            flight.slabs.t_max = cull_distance(flight.ray.t_max);
            None
        } else {
            let node = &self.tree.bvh.nodes[flight.current.0 as usize];
            let (mask, enter) = node.test(simd, &flight.slabs);
            nearest(
                mask,
                &enter.into(),
                &mut flight.view(stacks),
                #[inline(always)]
                |slot| node.children[slot].0,
            )
        };
        self.fetch(flight, stacks, next)
    }

    /// Advances a ray by one node or leaf. Returns the result, or `None` if the ray continues.
    #[inline(always)]
    fn any_step<S: Lanes>(&self, simd: S, flight: &mut RayInFlight<S, F>, stacks: &mut Stacks) -> Option<bool> {
        let next = if flight.current.is_leaf() {
            if flight.ray_visitor.any(flight.number, &flight.ray, flight.current.items()) {
                return Some(true);
            }
            None
        } else {
            let node = &self.tree.bvh.nodes[flight.current.0 as usize];
            let (mask, _) = node.test(simd, &flight.slabs);
            let largest = last_child(
                mask,
                &mut flight.view(stacks),
                #[inline(always)]
                |slot| node.children[slot].0,
            );
            largest.map(
                #[inline(always)]
                |slot| node.children[slot & 7].0,
            )
        };
        if self.fetch(flight, stacks, next) { None } else { Some(false) }
    }

    /// Selects and prefetches the next child, given or from the stack. Returns whether there is
    /// one.
    #[inline(always)]
    fn fetch<S: Lanes>(&self, flight: &mut RayInFlight<S, F>, stacks: &mut Stacks, next: Option<u32>) -> bool {
        let next = match next {
            Some(word) => Some(Child(word)),
            None => pop_nearer_than(&mut flight.view(stacks), flight.slabs.t_max),
        };
        let Some(child) = next else { return false };
        flight.current = child;
        self.tree.memory().prefetch(child);
        true
    }
}
