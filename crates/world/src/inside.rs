//! What a place is in: solids whose surface is somewhere behind every way out.

use super::World;
use juggler_material::medium::{InteriorId, Interiors};
use juggler_math::{Ray, Vec3};

/// Ways out that are tried: at odds with axes and diagonals, along which scenes are built.
const WAYS: [Vec3; 7] = [
    Vec3::new(0.1237, 0.9631, 0.2391),
    Vec3::new(-0.7219, 0.1433, 0.6770),
    Vec3::new(0.8563, -0.3319, 0.3959),
    Vec3::new(-0.3671, -0.8923, -0.2629),
    Vec3::new(0.2903, 0.3467, -0.8919),
    Vec3::new(-0.5591, 0.6353, -0.5327),
    Vec3::new(0.4157, -0.5779, -0.7023),
];

/// Surfaces on one way out after which it is given up.
const MAX_SURFACES: usize = 256;

/// What a way out met.
#[derive(Debug, Default)]
struct Way {
    /// What it left without having entered it, in order.
    left: Vec<InteriorId>,
    /// What it entered.
    entered: Vec<InteriorId>,
}

impl World {
    /// The solids that a place is in at a time between 0 and 1. Pure, and free where nothing has an inside that light
    /// comes to.
    ///
    /// A place is in a solid when most ways out that meet its surface leave it before they enter it: surfaces may have
    /// holes, rays may slip along edges, and half of all ways never leave what is below an endless plane.
    pub fn inside(&self, place: Vec3, time: f32) -> Interiors {
        if self.interiors().is_empty() {
            return Interiors::NONE;
        }
        let ways: Vec<Way> = WAYS.iter().filter_map(|way| self.way_out(place, *way, time)).collect();
        let holds = |id: &InteriorId| {
            let left = ways.iter().filter(|way| way.left.contains(id)).count();
            let entered = ways.iter().filter(|way| way.entered.contains(id) && !way.left.contains(id)).count();
            left > entered
        };
        let held = ways.iter().map(|way| way.left.iter().copied().filter(holds).collect::<Vec<_>>());
        // What is left last was entered first. Of several ways that leave the most, the first counts.
        let most = held.rev().max_by_key(Vec::len).unwrap_or_default();
        most.into_iter().rev().fold(Interiors::NONE, Interiors::entered)
    }

    /// A ray straight on to the end of the world; nothing when that is too far.
    fn way_out(&self, place: Vec3, direction: Vec3, time: f32) -> Option<Way> {
        let mut ray = Ray { time, ..Ray::new(place, direction.normalize()) };
        let (mut way, mut open) = (Way::default(), Vec::new());
        for _ in 0..MAX_SURFACES {
            let mut probe = ray;
            let hit = self.closest(&mut probe);
            if !hit.is_some() {
                return Some(way);
            }
            let vertex = self.vertex(&probe, &hit);
            if let Some(id) = self.interior(&vertex) {
                if vertex.surface.normal.dot(ray.direction) < 0.0 {
                    open.push(id);
                    way.entered.push(id);
                } else if let Some(at) = open.iter().rposition(|one| *one == id) {
                    open.remove(at);
                } else {
                    way.left.push(id);
                }
            }
            ray = vertex.surface.spawn(ray.direction, time);
        }
        None
    }
}

#[cfg(test)]
mod tests;
