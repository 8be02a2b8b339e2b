//! Ray-by-ray comparison of the hits of Juggler and Embree.

use crate::ffi::{Hit, Scene};
use juggler_bvh::TriangleBvh;
use juggler_math::Ray;
use juggler_raybench::RaySet;
use juggler_raybench::rays::QueryKind;
use std::fmt;

/// Relative difference of distances that counts as rounding.
const ROUNDING: f32 = 1e-4;

/// Distance, relative to the origin's largest coordinate, within which rays are offset from the
/// surface that they leave. A hit this close is on that surface, by a rounding error, or on one
/// that touches it.
const START: f32 = 1e-5;

/// Numbers of rays on which the two differ.
#[derive(Default)]
pub struct Differences {
    rays: usize,
    /// Hit or miss differs.
    hit: usize,
    /// Different triangles at the same distance: a shared edge or coplanar triangles.
    triangle: usize,
    /// Different triangles at different distances.
    place: usize,
    /// One of the two hits at the ray's origin.
    start: usize,
}

impl Differences {
    pub fn of(set: &RaySet, embree: &Scene, juggler: &TriangleBvh) -> Self {
        let mut own = Self { rays: set.rays.len(), ..Self::default() };
        for ray in &set.rays {
            let closest = || (embree.closest(ray), juggler.closest(ray).map(|hit| (hit.t, hit.index)));
            match set.kind.query() {
                QueryKind::Closest => own.compare(ray, closest()),
                QueryKind::Any if embree.any(ray) == juggler.any(ray) => {}
                QueryKind::Any => {
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
