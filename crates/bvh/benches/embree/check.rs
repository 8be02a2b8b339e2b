//! Whether both see the same, ray by ray.

use crate::ffi::{Hit, Scene};
use juggler_bvh::TriangleBvh;
use juggler_math::Ray;
use juggler_raybench::RaySet;
use juggler_raybench::rays::Query;
use std::fmt;

/// Relative difference of distances that rounding explains.
const ROUNDING: f32 = 1e-4;

/// Distance, as a share of the origin's largest coordinate, that is no farther than rays are moved off what they leave: a
/// hit there is on the surface that the ray leaves, by a distance wrongly rounded, or on one that touches it.
const START: f32 = 1e-5;

/// Rays on which the two differ.
#[derive(Default)]
pub struct Differences {
    rays: usize,
    /// One hits, the other does not.
    hit: usize,
    /// Another triangle at the same distance: an edge that two share, or coplanar ones.
    triangle: usize,
    /// Another triangle, elsewhere.
    place: usize,
    /// One of them hits where the ray starts.
    start: usize,
}

impl Differences {
    pub fn of(set: &RaySet, embree: &Scene, juggler: &TriangleBvh) -> Self {
        let mut own = Self { rays: set.rays.len(), ..Self::default() };
        for ray in &set.rays {
            let closest = || (embree.closest(ray), juggler.closest(ray).map(|hit| (hit.t, hit.index)));
            match set.kind.query() {
                Query::Closest => own.compare(ray, closest()),
                Query::Any if embree.any(ray) == juggler.any(ray) => {}
                Query::Any => {
                    let (one, other) = closest();
                    let at_start = [one, other].into_iter().flatten().any(|hit| starts_at(ray, hit));
                    *if at_start { &mut own.start } else { &mut own.hit } += 1;
                }
            }
        }
        own
    }

    fn compare(&mut self, ray: &Ray, closest: (Option<Hit>, Option<Hit>)) {
        match closest {
            (None, None) => {}
            (Some((_, a)), Some((_, b))) if a == b => {}
            (Some(hit), _) | (_, Some(hit)) if starts_at(ray, hit) => self.start += 1,
            (Some(_), Some(hit)) if starts_at(ray, hit) => self.start += 1,
            (Some((a, _)), Some((b, _))) if (a - b).abs() <= ROUNDING * a.max(b) => self.triangle += 1,
            (Some(_), Some(_)) => self.place += 1,
            _ => self.hit += 1,
        }
    }
}

fn starts_at(ray: &Ray, (distance, _): Hit) -> bool {
    distance <= START * ray.origin.abs().max_element()
}

impl fmt::Display for Differences {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { rays, hit, triangle, place, start } = self;
        let rounding = format!("{triangle} in triangle only, {start} at the start of the ray");
        write!(f, "of {rays} rays {hit} differ in hit or miss, {place} in place; {rounding}")
    }
}
