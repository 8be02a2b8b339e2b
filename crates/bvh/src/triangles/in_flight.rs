//! Many rays at a time through a tree that is larger than the cache: while one waits for its next node to come
//! from memory, the others go on.
//!
//! Each step takes one ray through one node or one leaf, asks for what this ray needs next to be fetched, and
//! turns to the next ray; finished rays are replaced. The rays need nothing in common.

use super::TriangleHit;
use super::filter::Filter;
use super::one::One;
use super::query::Query;
use crate::Leaf;
use crate::lanes::Lanes;
use crate::node::Child;
use crate::single::{Boxes, first, nearest, next_below};
use crate::slabs::{Slabs, cull_distance};
use crate::stack::Stack;
use arrayvec::ArrayVec;
use fearless_simd::prelude::*;
use juggler_math::Ray;

/// Rays under way together. A miss takes as long as a dozen steps.
const IN_FLIGHT: usize = 16;

/// A ray under way.
struct Flight<'a, S: Simd, F> {
    /// Number of the ray in the slice.
    number: usize,
    ray: Ray,
    slabs: Slabs,
    one: One<'a, S, F>,
    current: Child,
    stack: Stack,
}

impl<'a, S: Lanes, F: Filter> Flight<'a, S, F> {
    #[inline(always)]
    fn new(simd: S, query: Query<'a, F>, number: usize, ray: &Ray) -> Self {
        let slabs = Slabs::of_ray(simd, ray);
        let one = One::new(simd, query, ray, &slabs);
        Self { number, ray: *ray, slabs, one, current: Child::ROOT, stack: Stack::new() }
    }

    #[inline(always)]
    fn restart(&mut self, simd: S, query: Query<'a, F>, number: usize, ray: &Ray) {
        self.number = number;
        self.ray = *ray;
        self.slabs = Slabs::of_ray(simd, ray);
        self.one = One::new(simd, query, ray, &self.slabs);
        self.current = Child::ROOT;
        self.stack.clear();
    }
}

impl<'a, F: Filter> Query<'a, F> {
    /// [`TriangleBvh::closest`] of all rays.
    #[inline(always)]
    pub(super) fn closest_in_flight<S: Lanes>(&self, simd: S, rays: &mut [Ray], hits: &mut [Option<TriangleHit>]) {
        let mut flights = self.take_off(simd, rays);
        let mut waiting = flights.len();
        let mut at = 0;
        while !flights.is_empty() {
            at = if at + 1 < flights.len() { at + 1 } else { 0 };
            let flight = &mut flights[at];
            if self.closest_step(simd, flight) {
                continue;
            }
            let number = flight.number;
            hits[number] = flight.one.hit;
            if let Some(hit) = flight.one.hit {
                rays[number].t_max = hit.t;
            }
            self.replace(simd, &mut flights, at, (waiting, rays.get(waiting)));
            waiting += 1;
        }
    }

    /// [`TriangleBvh::any`] of all rays.
    #[inline(always)]
    pub(super) fn any_in_flight<S: Lanes>(&self, simd: S, rays: &[Ray], occluded: &mut [bool]) {
        let mut flights = self.take_off(simd, rays);
        let mut waiting = flights.len();
        let mut at = 0;
        while !flights.is_empty() {
            at = if at + 1 < flights.len() { at + 1 } else { 0 };
            let flight = &mut flights[at];
            let Some(found) = self.any_step(simd, flight) else { continue };
            occluded[flight.number] = found;
            self.replace(simd, &mut flights, at, (waiting, rays.get(waiting)));
            waiting += 1;
        }
    }

    /// The first rays.
    #[inline(always)]
    fn take_off<S: Lanes>(&self, simd: S, rays: &[Ray]) -> ArrayVec<Flight<'a, S, F>, IN_FLIGHT> {
        let mut flights = ArrayVec::new();
        for (number, ray) in rays.iter().enumerate().take(IN_FLIGHT) {
            flights.push(Flight::new(simd, *self, number, ray));
        }
        flights
    }

    /// The next ray takes the place of one that has landed; the place goes when no ray is left.
    #[inline(always)]
    fn replace<S: Lanes>(
        &self,
        simd: S,
        flights: &mut ArrayVec<Flight<'a, S, F>, IN_FLIGHT>,
        at: usize,
        (number, next): (usize, Option<&Ray>),
    ) {
        match next {
            Some(ray) => flights[at].restart(simd, *self, number, ray),
            None => _ = flights.swap_remove(at),
        }
    }

    /// Whether the ray goes on.
    #[inline(always)]
    fn closest_step<S: Lanes>(&self, simd: S, flight: &mut Flight<S, F>) -> bool {
        let next = if flight.current.is_leaf() {
            flight.one.closest(flight.number, &mut flight.ray, flight.current.items());
            flight.slabs.t_max = cull_distance(flight.ray.t_max);
            None
        } else {
            let node = &self.tree.bvh.nodes[flight.current.0 as usize];
            let (mask, enter) = node.test(simd, &flight.slabs);
            nearest(
                mask,
                &enter.into(),
                &mut flight.stack.view(),
                #[inline(always)]
                |slot| node.children[slot].0,
            )
        };
        self.fetch(flight, next)
    }

    /// The answer, or `None` if the ray goes on.
    #[inline(always)]
    fn any_step<S: Lanes>(&self, simd: S, flight: &mut Flight<S, F>) -> Option<bool> {
        let next = if flight.current.is_leaf() {
            if flight.one.any(flight.number, &flight.ray, flight.current.items()) {
                return Some(true);
            }
            None
        } else {
            let node = &self.tree.bvh.nodes[flight.current.0 as usize];
            let (mask, _) = node.test(simd, &flight.slabs);
            let largest = first(
                mask,
                &mut flight.stack.view(),
                #[inline(always)]
                |slot| node.children[slot].0,
            );
            largest.map(
                #[inline(always)]
                |slot| node.children[slot & 7].0,
            )
        };
        if self.fetch(flight, next) { None } else { Some(false) }
    }

    /// Asks for the next child, or the next on the stack, and says whether there is one.
    #[inline(always)]
    fn fetch<S: Lanes>(&self, flight: &mut Flight<S, F>, next: Option<u32>) -> bool {
        let next = match next {
            Some(word) => Some(Child(word)),
            None => next_below(&mut flight.stack.view(), flight.slabs.t_max),
        };
        let Some(child) = next else { return false };
        flight.current = child;
        self.tree.memory().prefetch(child);
        true
    }
}
