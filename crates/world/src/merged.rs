//! Many small meshes as one: their triangles stand under one hierarchy beside everything else, however their boxes
//! overlap. The same hits as one by one: ties go to the lower number, and within a mesh to the lower triangle.

use super::large::Order;
use super::{Object, WorldHit};
use juggler_bvh::{Quality, SimdLevel, TriangleBvh, TriangleHit};
use juggler_math::{Motion, Ray, Transform, Vec2, Vec3};
use juggler_shape::{AnyShape, Hit, Mesh, Shape, within_floats};
use std::sync::Arc;

/// A mesh of more triangles stands for itself.
const MOST_TRIANGLES: usize = 1 << 14;
/// So many triangles are kept twice at most: in their meshes and here.
const MOST_ALTOGETHER: usize = 1 << 20;

/// Small meshes of a level that are where they were made.
#[derive(Clone)]
pub struct Merged {
    bvh: Arc<TriangleBvh>,
    /// Of each mesh its first triangle here and its number.
    owners: Vec<(u32, u32)>,
}

impl std::fmt::Debug for Merged {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} meshes merged", self.owners.len())
    }
}

/// Places of the meshes that are better merged, if there are several; those `apart` are not.
pub fn places(objects: &[Object], apart: &[u32]) -> Vec<u32> {
    let mut sum = 0;
    let mut fits = |object: &Object| {
        let Some(mesh) = mesh(object).filter(|mesh| mesh.triangles() <= MOST_TRIANGLES) else { return false };
        sum += mesh.triangles();
        sum <= MOST_ALTOGETHER
    };
    let places: Vec<u32> = (0..)
        .zip(objects)
        .filter(|(place, object)| !apart.contains(place) && fits(object))
        .map(|(place, _)| place)
        .collect();
    if places.len() > 1 { places } else { Vec::new() }
}

/// The mesh that an object is, if it neither moves nor stands elsewhere than it was made.
fn mesh(object: &Object) -> Option<&Mesh> {
    let stays = object.motion == Motion::Still(Transform::IDENTITY) && object.is_bounded();
    match object.content.as_shape().filter(|_| stays).map(|shape| &**shape)? {
        AnyShape::Mesh(mesh) if !mesh.moves() => Some(mesh),
        _ => None,
    }
}

impl Merged {
    /// The objects at these places; `number` is that of each place's shape. `None` when there is none.
    pub fn new(objects: &[Object], places: &[u32], number: impl Fn(u32) -> u32) -> Option<Self> {
        let (mut positions, mut triangles, mut owners) = (Vec::<Vec3>::new(), Vec::new(), Vec::new());
        for place in places {
            let data = mesh(objects.get(*place as usize)?)?.data()?;
            owners.push((triangles.len() as u32, number(*place)));
            let first = positions.len() as u32;
            triangles.extend(data.triangles.iter().map(|corners| corners.map(|corner| corner + first)));
            positions.extend_from_slice(&data.positions);
        }
        let bvh = TriangleBvh::build(&positions, &triangles, Quality::Balanced).ok().filter(|_| !places.is_empty())?;
        Some(Self { bvh: Arc::new(bvh), owners })
    }

    /// The same for another vector unit.
    pub fn with_simd_level(&self, level: SimdLevel) -> Self {
        let bvh = Arc::new(TriangleBvh::clone(&self.bvh).with_simd_level(level));
        Self { bvh, ..self.clone() }
    }

    /// Bytes of the hierarchy.
    pub fn bytes(&self) -> usize {
        self.bvh.bytes()
    }

    /// Improves on `hits` with the nearest hits.
    pub fn closest(&self, rays: &mut [Ray], order: Order, hits: &mut [WorldHit]) {
        let mut found: Vec<Option<TriangleHit>> = vec![None; rays.len()];
        rays.iter_mut().for_each(|ray| *ray = within_floats(ray));
        match order {
            Order::Coherent => self.bvh.closest_packet(rays, &mut found),
            Order::Any => self.bvh.closest_batch(rays, &mut found),
        }
        for ((ray, best), hit) in rays.iter_mut().zip(hits).zip(found) {
            if let Some(hit) = hit {
                let owner = self.owners.partition_point(|(first, _)| *first <= hit.index) - 1;
                let (start, number) = self.owners[owner];
                let hit = Hit { t: hit.t, uv: Vec2::new(hit.u, hit.v), part: hit.index - start };
                best.keep(hit, number, ray);
            }
        }
    }

    /// Marks those of the rays that meet it.
    pub fn any(&self, rays: &[Ray], order: Order, occluded: &mut [bool]) {
        // Those that are answered already have no way to go.
        let left = |(ray, occluded): (&Ray, &bool)| if *occluded { ray.up_to(-1.0) } else { within_floats(ray) };
        let local: Vec<Ray> = rays.iter().zip(&*occluded).map(left).collect();
        let mut found = vec![false; rays.len()];
        match order {
            Order::Coherent => self.bvh.any_packet(&local, &mut found),
            Order::Any => self.bvh.any_batch(&local, &mut found),
        }
        for (occluded, found) in occluded.iter_mut().zip(found) {
            *occluded |= found;
        }
    }
}
