//! Solids that contain a point: those whose surface encloses it in most of several directions.

use super::{Cluster, Member, World};
use juggler_material::medium::{InteriorId, Interiors, Wavelength};
use juggler_math::{Ray, Vec3};

/// Directions of the test rays, chosen off the axes and diagonals along which scenes are built.
const TEST_DIRECTIONS: [Vec3; 7] = [
    Vec3::new(0.1237, 0.9631, 0.2391),
    Vec3::new(-0.7219, 0.1433, 0.6770),
    Vec3::new(0.8563, -0.3319, 0.3959),
    Vec3::new(-0.3671, -0.8923, -0.2629),
    Vec3::new(0.2903, 0.3467, -0.8919),
    Vec3::new(-0.5591, 0.6353, -0.5327),
    Vec3::new(0.4157, -0.5779, -0.7023),
];

/// Maximum number of surfaces along a test ray.
const MAX_SURFACES: usize = 256;

/// Interfaces along a test ray.
#[derive(Debug, Default)]
struct TestRay {
    /// Solids that the ray left without having entered them, in order.
    left: Vec<InteriorId>,
    /// Solids that the ray entered.
    entered: Vec<InteriorId>,
}

impl World {
    /// Returns the solids that contain a point at a time, 0 to 1 over the shutter interval. The
    /// result is deterministic, and costs nothing if no material has an interior.
    ///
    /// A point is in a solid if most test rays that hit its surface leave it before they enter it.
    /// The majority decides because surfaces may have openings, rays may slip between faces, and
    /// half of all rays from below an infinite plane never cross it.
    pub fn interiors_at(&self, point: Vec3, time: f32) -> Interiors {
        if self.interiors().is_empty() {
            return Interiors::NONE;
        }
        let rays: Vec<TestRay> =
            TEST_DIRECTIONS.iter().filter_map(|direction| self.trace_out(point, *direction, time)).collect();
        let contains_point = |id: &InteriorId| {
            let left = rays.iter().filter(|ray| ray.left.contains(id)).count();
            let entered = rays.iter().filter(|ray| ray.entered.contains(id) && !ray.left.contains(id)).count();
            left > entered
        };
        let candidates = rays.iter().map(|ray| ray.left.iter().copied().filter(contains_point).collect::<Vec<_>>());
        // The solid that a ray leaves last was entered first. Of several rays that leave the most
        // solids, the first counts.
        let most = candidates.rev().max_by_key(Vec::len).unwrap_or_default();
        most.into_iter().rev().fold(Interiors::NONE, Interiors::entered)
    }

    /// Index of refraction of the medium in these solids; at 587.56 nm without a wavelength.
    #[inline]
    pub fn ior_in(&self, solids: Interiors, wavelength: Option<Wavelength>) -> f32 {
        solids.top(self.interiors()).map_or(1.0, |interior| interior.ior_at(wavelength))
    }

    /// Follows a ray until it leaves the world; `None` after too many surfaces.
    fn trace_out(&self, point: Vec3, direction: Vec3, time: f32) -> Option<TestRay> {
        let mut ray = Ray { time, ..Ray::new(point, direction.normalize()) };
        let (mut test_ray, mut open) = (TestRay::default(), Vec::new());
        for _ in 0..MAX_SURFACES {
            let hit = self.closest(&mut ray);
            if !hit.is_some() {
                return Some(test_ray);
            }
            let first = Member { vertex: self.vertex(&ray, &hit), t: ray.t_max };
            let mut cluster = Cluster::new(self, &ray, &first.vertex);
            for member in std::iter::once(first).chain(&mut cluster) {
                if let Some(id) = self.interior(&member.vertex) {
                    test_ray.cross(id, member.is_entered(&ray), &mut open);
                }
            }
            ray = cluster.ray_behind();
        }
        None
    }
}

impl TestRay {
    /// Records that the ray enters or leaves a solid. `open` lists the solids that it entered and has
    /// not left.
    fn cross(&mut self, id: InteriorId, inwards: bool, open: &mut Vec<InteriorId>) {
        if inwards {
            open.push(id);
            self.entered.push(id);
        } else if let Some(at) = open.iter().rposition(|one| *one == id) {
            open.remove(at);
        } else {
            self.left.push(id);
        }
    }
}

#[cfg(test)]
mod tests;
