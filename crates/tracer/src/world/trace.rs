//! The questions that rays ask: what is nearest, is anything in the way, how much light gets through.

use super::{World, WorldHit};
use crate::shape::Hit;
use juggler_bvh::Leaf;
use juggler_math::{Ray, Rgb};
use std::ops::Range;

/// How often a shadow ray may cross transparent surfaces before it counts as blocked.
const MAX_CROSSINGS: u32 = 64;

/// Keeps the nearest hit of each ray of a call.
struct Nearest<'a> {
    world: &'a World,
    hits: &'a mut [WorldHit],
}

impl Leaf for Nearest<'_> {
    #[inline]
    fn closest(&mut self, lane: usize, ray: &mut Ray, range: Range<u32>) {
        for item in &self.world.items[range.start as usize..range.end as usize] {
            if let Some((hit, object)) = item.intersect(&self.world.objects, ray) {
                keep(&mut self.hits[lane], hit, object, ray);
            }
        }
    }

    #[inline]
    fn any(&mut self, _lane: usize, ray: &Ray, range: Range<u32>) -> bool {
        let items = &self.world.items[range.start as usize..range.end as usize];
        items.iter().any(|item| item.occludes(&self.world.objects, ray))
    }
}

/// The nearer one stays; of two at the same distance the one with the lower number, so that the order of
/// traversal cannot show.
#[inline(always)]
fn keep(best: &mut WorldHit, hit: Hit, object: u32, ray: &mut Ray) {
    if hit.t < best.hit.t || (hit.t == best.hit.t && object < best.object) {
        ray.t_max = hit.t;
        *best = WorldHit { hit, object };
    }
}

impl World {
    /// The nearest hits of any number of rays that go much the same way as their neighbours.
    pub fn closest_packet(&self, rays: &mut [Ray], hits: &mut [WorldHit]) {
        self.closest_unbounded(rays, hits);
        self.bvh.closest_packet(rays, &mut Nearest { world: self, hits });
    }

    /// The nearest hits of any number of rays, in no order.
    pub fn closest_batch(&self, rays: &mut [Ray], hits: &mut [WorldHit]) {
        self.closest_unbounded(rays, hits);
        self.bvh.closest_batch(rays, &mut Nearest { world: self, hits });
    }

    fn closest_unbounded(&self, rays: &mut [Ray], hits: &mut [WorldHit]) {
        hits.fill(WorldHit::NONE);
        for number in &self.unbounded {
            let placed = &self.objects[*number as usize];
            for (ray, best) in rays.iter_mut().zip(&mut *hits) {
                if let Some(hit) = placed.intersect(ray) {
                    keep(best, hit, *number, ray);
                }
            }
        }
    }

    /// The nearest hit of one ray, whose end is drawn in to it.
    pub fn closest(&self, ray: &mut Ray) -> WorldHit {
        let mut hits = [WorldHit::NONE];
        self.closest_batch(std::slice::from_mut(ray), &mut hits);
        hits[0]
    }

    /// How much of a light's radiance comes through along each of any number of rays that go much the same way
    /// as their neighbours.
    pub fn transmittance_packet(&self, rays: &[Ray], through: &mut [Rgb]) {
        self.transmittance(rays, through, |rays, occluded, leaf| self.bvh.any_packet(rays, occluded, leaf));
    }

    /// How much of a light's radiance comes through along each of any number of rays.
    pub fn transmittance_batch(&self, rays: &[Ray], through: &mut [Rgb]) {
        self.transmittance(rays, through, |rays, occluded, leaf| self.bvh.any_batch(rays, occluded, leaf));
    }

    fn transmittance(&self, rays: &[Ray], through: &mut [Rgb], any: impl Fn(&[Ray], &mut [bool], &mut Nearest)) {
        if self.has_transparency {
            for (ray, through) in rays.iter().zip(through) {
                *through = self.filtered(*ray);
            }
            return;
        }
        const CHUNK: usize = 256;
        for (rays, through) in rays.chunks(CHUNK).zip(through.chunks_mut(CHUNK)) {
            let mut occluded = [false; CHUNK];
            let occluded = &mut occluded[..rays.len()];
            any(rays, occluded, &mut Nearest { world: self, hits: &mut [] });
            for ((ray, occluded), through) in rays.iter().zip(occluded).zip(through) {
                let blocked = *occluded || self.unbounded.iter().any(|i| self.objects[*i as usize].occludes(ray));
                *through = if blocked { Rgb::BLACK } else { Rgb::WHITE };
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
