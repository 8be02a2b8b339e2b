//! Few large meshes beside everything else: all rays that meet one's box go through it together, which its
//! hierarchy does faster than one ray after the other. The same hits, for ties do not hang on the order.

use super::items::Placed;
use super::{Content, Object, WorldHit};
use juggler_math::{Aabb, Ray};
use juggler_shape::{AnyShape, Mesh, Shape};

/// A mesh of so many triangles is large.
const TRIANGLES: usize = 1024;
/// Of more large meshes than this, the nearest come first as in any hierarchy: that saves more.
const FEW: usize = 4;
/// With fewer rays there is nothing to gain from waiting for each other.
const ALONE: usize = 4;

/// How the rays of a call relate to each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// Each goes much the same way as its neighbours.
    Coherent,
    /// In no order.
    Any,
}

/// A large mesh in a level.
#[derive(Clone, Debug)]
pub struct Large {
    /// In the level's space.
    bounds: Aabb,
    place: u32,
    number: u32,
}

/// Places of the bounded objects that are large meshes, if they are few.
pub fn places(objects: &[Object]) -> Vec<u32> {
    let has_many = |object: &Object| object.content.mesh().is_some_and(|mesh| mesh.triangles() >= TRIANGLES);
    let is_large = |object: &Object| has_many(object) && object.is_bounded();
    let places: Vec<u32> = (0..).zip(objects).filter(|(_, object)| is_large(object)).map(|(place, _)| place).collect();
    if places.len() <= FEW { places } else { Vec::new() }
}

impl Large {
    /// The object at `place`, whose shape has this number.
    pub fn new(object: &Object, place: u32, number: u32) -> Self {
        let bounds = object.bounds();
        // No ray may miss the box that the hierarchy, whose test is wider by a few roundings, would let in.
        let bounds = bounds.grown(16.0 * f32::EPSILON * bounds.min.abs().max(bounds.max.abs()).max_element());
        Self { bounds, place, number }
    }

    /// Improves on `hits` with the nearest hits.
    pub fn closest(&self, objects: &[Placed], rays: &mut [Ray], order: Order, hits: &mut [WorldHit]) {
        let placed = &objects[self.place as usize];
        let mesh = placed.content.mesh().filter(|_| rays.len() >= ALONE);
        let Some(mesh) = mesh else {
            for (ray, best) in rays.iter_mut().zip(hits).filter(|(ray, _)| self.bounds.clip(ray).is_some()) {
                placed.closest(ray, self.number, best);
            }
            return;
        };
        let lanes: Vec<usize> = (0..rays.len()).filter(|lane| self.bounds.clip(&rays[*lane]).is_some()).collect();
        let mut local: Vec<Ray> = lanes.iter().map(|lane| placed.local(&rays[*lane])).collect();
        for (lane, hit) in lanes.into_iter().zip(mesh.intersect_many(&mut local, order == Order::Coherent)) {
            if let Some(hit) = hit {
                hits[lane].keep(hit, self.number, &mut rays[lane]);
            }
        }
    }

    /// Marks those of the rays that meet it.
    pub fn any(&self, objects: &[Placed], rays: &[Ray], order: Order, occluded: &mut [bool]) {
        let placed = &objects[self.place as usize];
        let mesh = placed.content.mesh().filter(|_| rays.len() >= ALONE);
        let Some(mesh) = mesh else {
            for (ray, occluded) in rays.iter().zip(occluded) {
                *occluded = *occluded || self.bounds.clip(ray).is_some() && placed.occludes(ray);
            }
            return;
        };
        let waits = |lane: &usize| !occluded[*lane] && self.bounds.clip(&rays[*lane]).is_some();
        let lanes: Vec<usize> = (0..rays.len()).filter(waits).collect();
        let mut local: Vec<Ray> = lanes.iter().map(|lane| placed.local(&rays[*lane])).collect();
        for (lane, found) in lanes.into_iter().zip(mesh.occludes_many(&mut local, order == Order::Coherent)) {
            occluded[lane] = found;
        }
    }
}

impl Content {
    fn mesh(&self) -> Option<&Mesh> {
        match &**self.as_shape()? {
            AnyShape::Mesh(mesh) => Some(mesh),
            _ => None,
        }
    }
}
