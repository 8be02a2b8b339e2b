//! The questions that rays ask: what is nearest, is anything in the way, how much light gets through.

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
    /// Improves on `hits` with the nearest hits of rays that go much the same way as their neighbours. `first` is
    /// the number of this level's first shape.
    pub(super) fn closest_packet(&self, rays: &mut [Ray], first: u32, hits: &mut [WorldHit]) {
        self.closest_unbounded(rays, first, hits);
        self.bvh.closest_packet(rays, &mut Nearest { level: self, first, hits });
    }

    /// Improves on `hits` with the nearest hits of rays in no order.
    pub(super) fn closest_batch(&self, rays: &mut [Ray], first: u32, hits: &mut [WorldHit]) {
        self.closest_unbounded(rays, first, hits);
        self.bvh.closest_batch(rays, &mut Nearest { level: self, first, hits });
    }

    fn closest_unbounded(&self, rays: &mut [Ray], first: u32, hits: &mut [WorldHit]) {
        for place in &self.unbounded {
            let (placed, number) = (&self.objects[*place as usize], first + self.first(*place));
            for (ray, best) in rays.iter_mut().zip(&mut *hits) {
                placed.closest(ray, number, best);
            }
        }
    }

    /// Whether each of the rays, which go much the same way as their neighbours, meets anything.
    fn any_packet(&self, rays: &[Ray], occluded: &mut [bool]) {
        self.bvh.any_packet(rays, occluded, &mut Nearest { level: self, first: 0, hits: &mut [] });
        self.any_unbounded(rays, occluded);
    }

    /// Whether each of the rays meets anything.
    fn any_batch(&self, rays: &[Ray], occluded: &mut [bool]) {
        self.bvh.any_batch(rays, occluded, &mut Nearest { level: self, first: 0, hits: &mut [] });
        self.any_unbounded(rays, occluded);
    }

    fn any_unbounded(&self, rays: &[Ray], occluded: &mut [bool]) {
        for place in &self.unbounded {
            let placed = &self.objects[*place as usize];
            for (ray, occluded) in rays.iter().zip(&mut *occluded) {
                *occluded = *occluded || placed.occludes(ray);
            }
        }
    }

    /// Whether one ray meets anything.
    #[inline(never)]
    pub(super) fn occludes(&self, ray: &Ray) -> bool {
        let mut occluded = [false];
        self.any_batch(std::slice::from_ref(ray), &mut occluded);
        occluded[0]
    }
}

impl World {
    /// The nearest hits of any number of rays that go much the same way as their neighbours.
    pub fn closest_packet(&self, rays: &mut [Ray], hits: &mut [WorldHit]) {
        hits.fill(WorldHit::NONE);
        self.top.closest_packet(rays, 0, hits);
    }

    /// The nearest hits of any number of rays, in no order.
    pub fn closest_batch(&self, rays: &mut [Ray], hits: &mut [WorldHit]) {
        hits.fill(WorldHit::NONE);
        self.top.closest_batch(rays, 0, hits);
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
        self.transmittance(rays, through, Level::any_packet);
    }

    /// How much of a light's radiance comes through along each of any number of rays.
    pub fn transmittance_batch(&self, rays: &[Ray], through: &mut [Rgb]) {
        self.transmittance(rays, through, Level::any_batch);
    }

    fn transmittance(&self, rays: &[Ray], through: &mut [Rgb], any: impl Fn(&Level, &[Ray], &mut [bool])) {
        if self.has_transparency {
            for (ray, through) in rays.iter().zip(through) {
                *through = self.filtered(*ray);
            }
            return;
        }
        const CHUNK: usize = 256;
        for (rays, through) in rays.chunks(CHUNK).zip(through.chunks_mut(CHUNK)) {
            let mut occluded = [false; CHUNK];
            any(&self.top, rays, &mut occluded[..rays.len()]);
            for (occluded, through) in occluded.iter().zip(through) {
                *through = if *occluded { Rgb::BLACK } else { Rgb::WHITE };
            }
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
