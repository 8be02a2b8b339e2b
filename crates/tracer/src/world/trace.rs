//! The questions that rays ask: what is nearest, is anything in the way, how much light gets through.

use super::large::Order;
use super::{Level, World, WorldHit};
use juggler_bvh::Leaf;
use juggler_math::{Ray, Rgb};
use std::ops::Range;

/// How often a shadow ray may cross transparent surfaces before it counts as blocked.
const MAX_CROSSINGS: u32 = 64;

/// Keeps the nearest hit of each ray of a call.
struct Nearest<'a> {
    level: &'a Level,
    /// Number of the level's first shape.
    first: u32,
    hits: &'a mut [WorldHit],
}

impl Leaf for Nearest<'_> {
    #[inline]
    fn closest(&mut self, lane: usize, ray: &mut Ray, range: Range<u32>) {
        for item in &self.level.items[range.start as usize..range.end as usize] {
            item.closest(&self.level.objects, ray, self.first, &mut self.hits[lane]);
        }
    }

    #[inline]
    fn any(&mut self, _lane: usize, ray: &Ray, range: Range<u32>) -> bool {
        let items = &self.level.items[range.start as usize..range.end as usize];
        items.iter().any(|item| item.occludes(&self.level.objects, ray))
    }
}

impl Level {
    /// Improves on `hits` with the nearest hits. `first` is the number of this level's first shape.
    #[inline]
    pub(super) fn improve(&self, rays: &mut [Ray], order: Order, first: u32, hits: &mut [WorldHit]) {
        for place in &self.unbounded {
            let (placed, number) = (&self.objects[*place as usize], first + self.first(*place));
            for (ray, best) in rays.iter_mut().zip(&mut *hits) {
                placed.closest(ray, number, best);
            }
        }
        let mut nearest = Nearest { level: self, first, hits };
        match order {
            Order::Coherent => self.bvh.closest_packet(rays, &mut nearest),
            Order::Any => self.bvh.closest_batch(rays, &mut nearest),
        }
        for large in &self.large {
            large.closest(&self.objects, rays, order, hits);
        }
    }

    /// Whether each of the rays meets anything.
    #[inline]
    fn any(&self, rays: &[Ray], order: Order, occluded: &mut [bool]) {
        let mut nearest = Nearest { level: self, first: 0, hits: &mut [] };
        match order {
            Order::Coherent => self.bvh.any_packet(rays, occluded, &mut nearest),
            Order::Any => self.bvh.any_batch(rays, occluded, &mut nearest),
        }
        for place in &self.unbounded {
            let placed = &self.objects[*place as usize];
            for (ray, occluded) in rays.iter().zip(&mut *occluded) {
                *occluded = *occluded || placed.occludes(ray);
            }
        }
        for large in &self.large {
            large.any(&self.objects, rays, order, occluded);
        }
    }

    /// Whether one ray meets anything.
    #[inline(never)]
    pub(super) fn occludes(&self, ray: &Ray) -> bool {
        let mut occluded = [false];
        self.any(std::slice::from_ref(ray), Order::Any, &mut occluded);
        occluded[0]
    }
}

impl World {
    /// The nearest hits of any number of rays that go much the same way as their neighbours.
    pub fn closest_packet(&self, rays: &mut [Ray], hits: &mut [WorldHit]) {
        hits.fill(WorldHit::NONE);
        self.top.improve(rays, Order::Coherent, 0, hits);
    }

    /// The nearest hits of any number of rays, in no order.
    pub fn closest_batch(&self, rays: &mut [Ray], hits: &mut [WorldHit]) {
        hits.fill(WorldHit::NONE);
        self.top.improve(rays, Order::Any, 0, hits);
    }

    /// The nearest hit of one ray, whose end is drawn in to it.
    pub fn closest(&self, ray: &mut Ray) -> WorldHit {
        let mut hit = WorldHit::NONE;
        self.top.closest(ray, 0, &mut hit);
        hit
    }

    /// How much of a light's radiance comes through along each of any number of rays that go much the same way
    /// as their neighbours.
    pub fn transmittance_packet(&self, rays: &[Ray], through: &mut [Rgb]) {
        self.transmittance(rays, through, Order::Coherent);
    }

    /// How much of a light's radiance comes through along each of any number of rays.
    pub fn transmittance_batch(&self, rays: &[Ray], through: &mut [Rgb]) {
        self.transmittance(rays, through, Order::Any);
    }

    fn transmittance(&self, rays: &[Ray], through: &mut [Rgb], order: Order) {
        if self.has_transparency {
            for (ray, through) in rays.iter().zip(through) {
                *through = self.filtered(*ray);
            }
            return;
        }
        let mut occluded = vec![false; rays.len()];
        self.top.any(rays, order, &mut occluded);
        for (occluded, through) in occluded.iter().zip(through) {
            *through = if *occluded { Rgb::BLACK } else { Rgb::WHITE };
        }
    }

    /// The product of the filters of everything that the ray crosses, nearest first.
    fn filtered(&self, ray: Ray) -> Rgb {
        let (mut rest, mut through) = (ray, Rgb::WHITE);
        for _ in 0..MAX_CROSSINGS {
            let mut probe = rest;
            let hit = self.closest(&mut probe);
            if !hit.is_some() {
                return through;
            }
            let vertex = self.vertex(&rest, &hit);
            through *= self.materials.filter(vertex.material, &vertex.surface);
            if through.is_black() {
                return through;
            }
            let left = rest.t_max - hit.hit.t;
            rest = vertex.surface.spawn(rest.direction, rest.time).up_to(left);
        }
        Rgb::BLACK
    }
}
