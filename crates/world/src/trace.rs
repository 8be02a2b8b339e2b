//! The questions that rays ask: what is nearest, is anything in the way, how much light gets through.

use super::items::{Item, Placed};
use super::large::Order;
use super::{Content, Level, Vertex, World, WorldHit};
use arrayvec::ArrayVec;
use juggler_bvh::{Leaf, PACKET};
use juggler_material::medium::Interiors;
use juggler_math::{Ray, Rgb};
use std::cell::Cell;
use std::ops::Range;

/// What a shadow ray keeps on its way to a light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shadows {
    /// What transparent materials filter, straight on, as classic pictures have it.
    Filtered,
    /// What passes holes; whatever else is in the way is in the way.
    Physical,
}

/// How many transparent surfaces a classic shadow ray may meet before it counts as blocked.
const MAX_FILTERS: u32 = 64;

/// How many holes, and surfaces that others hide, light as it is may pass in a row.
pub const MAX_PASSED: u16 = 1000;

/// So few rays of a packet go through an instance one by one.
const ALONE: u32 = 2;

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

    #[inline]
    fn closest_many(&mut self, first: usize, active: u32, rays: &mut [Ray], range: Range<u32>) -> bool {
        let level = self.level;
        for item in &level.items[range.start as usize..range.end as usize] {
            match *item {
                Item::Instance { place, number } if active.count_ones() > ALONE => {
                    let hits = &mut self.hits[first..first + rays.len()];
                    closest_together(&level.objects[place as usize], self.first + number, active, rays, hits);
                }
                _ => {
                    for lane in lanes(active) {
                        item.closest(&level.objects, &mut rays[lane], self.first, &mut self.hits[first + lane]);
                    }
                }
            }
        }
        true
    }

    #[inline]
    fn any_many(&mut self, _first: usize, active: u32, rays: &[Ray], range: Range<u32>) -> u32 {
        let (level, mut found) = (self.level, 0);
        for item in &level.items[range.start as usize..range.end as usize] {
            let active = active & !found;
            match *item {
                Item::Instance { place, .. } if active.count_ones() > ALONE => {
                    found |= any_together(&level.objects[place as usize], active, rays);
                }
                _ => {
                    for lane in lanes(active) {
                        found |= u32::from(item.occludes(&level.objects, &rays[lane])) << lane;
                    }
                }
            }
        }
        found
    }
}

/// The lanes whose bits are set.
#[inline]
fn lanes(active: u32) -> impl Iterator<Item = usize> {
    (0..PACKET).filter(move |lane| active >> lane & 1 != 0)
}

/// [`Placed::closest`] for the active rays of a packet, which stay together in an instance.
#[inline(never)]
fn closest_together(placed: &Placed, number: u32, active: u32, rays: &mut [Ray], hits: &mut [WorldHit]) {
    let Content::Level(level) = &placed.content else { return };
    let mut local: ArrayVec<Ray, PACKET> = lanes(active).map(|lane| placed.local(&rays[lane])).collect();
    let mut best: ArrayVec<WorldHit, PACKET> = lanes(active).map(|lane| hits[lane]).collect();
    level.improve(&mut local, Order::Coherent, number, &mut best);
    for (lane, (local, best)) in lanes(active).zip(local.iter().zip(best)) {
        (rays[lane].t_max, hits[lane]) = (local.t_max, best);
    }
}

/// Which of the active rays of a packet meet anything in an instance.
#[inline(never)]
fn any_together(placed: &Placed, active: u32, rays: &[Ray]) -> u32 {
    let Content::Level(level) = &placed.content else { return 0 };
    let local: ArrayVec<Ray, PACKET> = lanes(active).map(|lane| placed.local(&rays[lane])).collect();
    let mut occluded = [false; PACKET];
    level.any(&local, Order::Coherent, &mut occluded[..local.len()]);
    lanes(active).zip(occluded).fold(0, |found, (lane, occluded)| found | u32::from(occluded) << lane)
}

impl Level {
    /// Improves on `hits` with the nearest hits. `first` is the number of this level's first shape.
    #[inline]
    pub(super) fn improve(&self, rays: &mut [Ray], order: Order, first: u32, hits: &mut [WorldHit]) {
        for place in &self.unbounded {
            let (placed, number) = (&self.objects[*place as usize], first + self.first(*place));
            placed.closest_each(rays, number, hits);
        }
        let mut nearest = Nearest { level: self, first, hits };
        match order {
            Order::Coherent => self.bvh.closest_packet(rays, &mut nearest),
            Order::Any => self.bvh.closest_batch(rays, &mut nearest),
        }
        for large in &self.large {
            large.closest(&self.objects, rays, order, hits);
        }
        if let Some(merged) = &self.merged {
            merged.closest(rays, order, hits);
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
        if let Some(merged) = &self.merged {
            merged.any(rays, order, occluded);
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
    pub fn transmittance_packet(&self, rays: &[Ray], kept: Shadows, through: &mut [Rgb]) {
        self.transmittance(rays, kept, through, Order::Coherent);
    }

    /// How much of a light's radiance comes through along each of any number of rays.
    pub fn transmittance_batch(&self, rays: &[Ray], kept: Shadows, through: &mut [Rgb]) {
        self.transmittance(rays, kept, through, Order::Any);
    }

    fn transmittance(&self, rays: &[Ray], kept: Shadows, through: &mut [Rgb], order: Order) {
        if kept == Shadows::Filtered && self.has_transparency {
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

    /// Whether shadow rays may lose some of their light on their way, so that it is to be asked by
    /// [`World::transmittance_inside`].
    pub fn dims_shadows(&self) -> bool {
        self.has_holes || self.has_media
    }

    /// How much of a light's radiance comes through holes and media along each of any number of rays, which start in
    /// the solids `inside`.
    pub fn transmittance_inside(&self, rays: &[Ray], inside: impl Iterator<Item = Interiors>, through: &mut [Rgb]) {
        for ((ray, inside), through) in rays.iter().zip(inside).zip(through) {
            *through = self.dimmed(*ray, inside);
        }
    }

    /// The product of the filters of everything that the ray crosses, nearest first.
    fn filtered(&self, ray: Ray) -> Rgb {
        let filter = |vertex: &Vertex| self.materials.filter(vertex.material, &vertex.surface);
        self.crossing(ray, MAX_FILTERS - 1, |_| Rgb::WHITE, filter)
    }

    /// What holes and media leave. Surfaces in solids of higher priority are not there.
    fn dimmed(&self, ray: Ray, inside: Interiors) -> Rgb {
        let inside = Cell::new(inside);
        let interiors = self.materials.interiors();
        let left = |distance: f32| match inside.get().top(interiors) {
            Some(interior) => interior.medium.transmittance(distance),
            None => Rgb::WHITE,
        };
        let gap = |vertex: &Vertex| {
            if let Some(id) = self.materials.interior(vertex.material) {
                let (enters, now) = (vertex.surface.normal.dot(ray.direction) < 0.0, inside.get());
                inside.set(now.crossed(id, enters));
                if now.hide(id, enters, interiors) {
                    return Rgb::WHITE;
                }
            }
            Rgb::splat(self.materials.gap(vertex.material, &vertex.surface))
        };
        self.crossing(ray, MAX_PASSED.into(), left, gap)
    }

    /// What is left of light along a ray: of each stretch between surfaces what `on_the_way` says of its length, of
    /// each of at most `most` surfaces what `filter` says.
    fn crossing(&self, ray: Ray, most: u32, on_the_way: impl Fn(f32) -> Rgb, filter: impl Fn(&Vertex) -> Rgb) -> Rgb {
        let (mut rest, mut through) = (ray, Rgb::WHITE);
        for _ in 0..=most {
            let mut probe = rest;
            let hit = self.closest(&mut probe);
            through *= on_the_way(probe.t_max);
            if !hit.is_some() {
                return through;
            }
            let vertex = self.vertex(&rest, &hit);
            through *= filter(&vertex);
            if through.is_black() {
                return through;
            }
            let left = rest.t_max - hit.hit.t;
            rest = vertex.surface.spawn(rest.direction, rest.time).up_to(left);
        }
        Rgb::BLACK
    }
}
