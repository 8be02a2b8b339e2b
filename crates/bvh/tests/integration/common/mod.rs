//! Random numbers, rays and shapes for the tests, and a leaf visitor that keeps the nearest item.
#![allow(dead_code)] // Each test module uses only a part.

pub mod mesh;
pub mod rays;

use juggler_bvh::{Bvh, Leaf, Quality, simd_levels};
use juggler_math::{Aabb, Ray, Vec3, hash};
use std::ops::Range;

/// Counter-based random numbers: the same in every run.
pub struct Random {
    seed: u32,
    count: u32,
}

impl Random {
    pub fn new(seed: u32) -> Self {
        Self { seed, count: 0 }
    }

    pub fn bits(&mut self) -> u32 {
        self.count += 1;
        hash::mix(hash::combine(self.seed, self.count))
    }

    pub fn below(&mut self, n: usize) -> usize {
        self.bits() as usize % n
    }

    /// A number in [0, 1).
    pub fn unit(&mut self) -> f32 {
        hash::unit_f32(self.bits())
    }

    /// A point in [-1, 1)³.
    pub fn point(&mut self) -> Vec3 {
        Vec3::new(self.unit(), self.unit(), self.unit()) * 2.0 - Vec3::ONE
    }

    pub fn direction(&mut self) -> Vec3 {
        loop {
            let p = self.point();
            if p.length_squared() > 0.01 && p.length_squared() < 1.0 {
                return p.normalize();
            }
        }
    }
}

/// A shape with bounds and an intersection test.
pub trait Shape: Copy {
    fn bounds(&self) -> Aabb;
    fn hit(&self, ray: &Ray) -> Option<f32>;
}

impl Shape for Aabb {
    fn bounds(&self) -> Aabb {
        *self
    }

    fn hit(&self, ray: &Ray) -> Option<f32> {
        self.clip(ray).map(|(enter, _)| enter)
    }
}

#[derive(Clone, Copy)]
pub struct Sphere {
    pub center: Vec3,
    pub radius: f32,
}

impl Shape for Sphere {
    fn bounds(&self) -> Aabb {
        Aabb { min: self.center, max: self.center }.grown(self.radius * 1.000_001)
    }

    fn hit(&self, ray: &Ray) -> Option<f32> {
        let (o, d) = ((ray.origin - self.center).as_dvec3(), ray.direction.as_dvec3());
        let (a, b) = (d.length_squared(), o.dot(d));
        let root = b * b - a * (o.length_squared() - f64::from(self.radius) * f64::from(self.radius));
        let ts = (root >= 0.0).then(|| [(-b - root.sqrt()) / a, (-b + root.sqrt()) / a])?;
        ts.into_iter().map(|t| t as f32).find(|&t| ray.t_min <= t && t <= ray.t_max)
    }
}

pub type Nearest = Option<(u32, u32)>; // (bits of t, item)

/// Leaf visitor that keeps the nearest item of each lane; among equal distances the smallest index.
pub struct Keep<'a, S> {
    pub shapes: &'a [S],
    pub order: &'a [u32],
    pub hits: Vec<Option<(f32, u32)>>,
    pub visits: usize,
}

impl<'a, S: Shape> Keep<'a, S> {
    pub fn new(shapes: &'a [S], order: &'a [u32], lanes: usize) -> Self {
        Self { shapes, order, hits: vec![None; lanes], visits: 0 }
    }

    pub fn nearest(&self) -> Vec<Nearest> {
        self.hits.iter().map(|hit| hit.map(|(t, item)| (t.to_bits(), item))).collect()
    }
}

impl<S: Shape> Leaf for Keep<'_, S> {
    fn closest(&mut self, lane: usize, ray: &mut Ray, items: Range<u32>) {
        self.visits += 1;
        for position in items {
            let item = self.order[position as usize];
            let Some(t) = self.shapes[item as usize].hit(ray) else { continue };
            if self.hits[lane].is_none_or(|(best, other)| t < best || (t == best && item < other)) {
                self.hits[lane] = Some((t, item));
                ray.t_max = t;
            }
        }
    }

    fn any(&mut self, _lane: usize, ray: &Ray, mut items: Range<u32>) -> bool {
        self.visits += 1;
        items.any(|position| self.shapes[self.order[position as usize] as usize].hit(ray).is_some())
    }
}

pub fn brute_force<S: Shape>(shapes: &[S], ray: &Ray) -> Nearest {
    let hits = shapes.iter().zip(0u32..).filter_map(|(shape, item)| shape.hit(ray).map(|t| (t, item)));
    let nearest = hits.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    nearest.map(|(t, item)| (t.to_bits(), item))
}

/// Checks every query against brute force, with `group` rays per call; SIMD levels take turns.
pub fn check<S: Shape>(name: &str, shapes: &[S], rays: &[Ray], group: usize) {
    let boxes: Vec<Aabb> = shapes.iter().map(Shape::bounds).collect();
    for quality in Quality::ALL {
        let bvh = Bvh::build(&boxes, quality);
        let levels = simd_levels().into_iter().map(|level| (level, bvh.clone().with_simd_level(level)));
        let levels: Vec<_> = levels.collect();
        for (number, rays) in rays.chunks(group).enumerate() {
            let (level, bvh) = &levels[number % levels.len()];
            let name = format!("{name}, {quality:?}, {level:?}, call {number}");
            let expected: Vec<Nearest> = rays.iter().map(|ray| brute_force(shapes, ray)).collect();
            check_closest(&name, bvh, shapes, rays, &expected);
            check_any(&name, bvh, shapes, rays, &expected);
        }
    }
}

fn check_closest<S: Shape>(name: &str, bvh: &Bvh, shapes: &[S], rays: &[Ray], expected: &[Nearest]) {
    for (ray, &expected) in rays.iter().zip(expected) {
        let mut leaf = Keep::new(shapes, bvh.order(), 1);
        bvh.closest(&mut { *ray }, &mut leaf);
        assert_eq!(leaf.nearest(), [expected], "{name}: {ray:?}");
        let mut leaf = Keep::new(shapes, bvh.order(), 1);
        let visits = bvh.closest_counted(&mut { *ray }, &mut leaf);
        assert_eq!(leaf.nearest(), [expected], "{name}, counted: {ray:?}");
        assert_eq!(visits.leaves as usize, leaf.visits);
    }
    let mut leaf = Keep::new(shapes, bvh.order(), rays.len());
    let mut ends = rays.to_vec();
    bvh.closest_batch(&mut ends, &mut leaf);
    assert_eq!(leaf.nearest(), expected, "{name}, batch");
    let mut leaf = Keep::new(shapes, bvh.order(), rays.len());
    let mut ends = rays.to_vec();
    bvh.closest_packet(&mut ends, &mut leaf);
    assert_eq!(leaf.nearest(), expected, "{name}, packet: {rays:?}");
    for ((end, ray), expected) in ends.iter().zip(rays).zip(expected) {
        assert_eq!(end.t_max, expected.map_or(ray.t_max, |(t, _)| f32::from_bits(t)));
    }
}

fn check_any<S: Shape>(name: &str, bvh: &Bvh, shapes: &[S], rays: &[Ray], expected: &[Nearest]) {
    let expected: Vec<bool> = expected.iter().map(Option::is_some).collect();
    let mut leaf = Keep::new(shapes, bvh.order(), 0);
    let single: Vec<bool> = rays.iter().map(|ray| bvh.any(ray, &mut leaf)).collect();
    assert_eq!(single, expected, "{name}, any");
    let mut batch = vec![true; rays.len()];
    bvh.any_batch(rays, &mut batch, &mut leaf);
    assert_eq!(batch, expected, "{name}, any batch");
    let mut packet = vec![true; rays.len()];
    bvh.any_packet(rays, &mut packet, &mut leaf);
    assert_eq!(packet, expected, "{name}, any packet: {rays:?}");
}
