//! Whether both see the same, ray by ray.

use crate::ffi::Scene;
use juggler_bvh::TriangleBvh;
use juggler_raybench::RaySet;
use juggler_raybench::rays::Query;
use std::fmt;

/// Relative difference of distances that rounding explains.
const ROUNDING: f32 = 1e-4;

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
}

impl Differences {
    pub fn of(set: &RaySet, embree: &Scene, juggler: &TriangleBvh) -> Self {
        let mut own = Self { rays: set.rays.len(), ..Self::default() };
        for ray in &set.rays {
            match set.kind.query() {
                Query::Any => own.hit += usize::from(embree.any(ray) != juggler.any(ray)),
                Query::Closest => match (embree.closest(ray), juggler.closest(ray)) {
                    (None, None) => {}
                    (Some((_, index)), Some(hit)) if index == hit.index => {}
                    (Some((t, _)), Some(hit)) if (t - hit.t).abs() <= ROUNDING * t.max(hit.t) => own.triangle += 1,
                    (Some(_), Some(_)) => own.place += 1,
                    _ => own.hit += 1,
                },
            }
        }
        own
    }
}

impl fmt::Display for Differences {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { rays, hit, triangle, place } = self;
        write!(f, "of {rays} rays {hit} differ in hit or miss, {place} in place, {triangle} in triangle only")
    }
}
