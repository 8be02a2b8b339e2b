//! Objects as the hierarchy's leaves keep them: spheres in world space, everything else by number.

use super::{Object, WorldHit};
use crate::material::MaterialTable;
use crate::shape::{AnyShape, Hit, intersect_sphere};
use crate::surface::Surface;
use juggler_math::{Ray, Vec3};

/// One leaf entry.
#[derive(Clone, Copy, Debug)]
pub enum Item {
    /// A sphere that is still one in the world.
    Sphere {
        /// World space.
        center: Vec3,
        /// World space.
        radius: f32,
        /// Number of the object.
        object: u32,
    },
    /// Anything else: asked in its own space.
    Other {
        /// Number of the object.
        object: u32,
    },
}

impl Item {
    /// How to keep an object.
    pub fn new(object: &Object, number: u32, _materials: &MaterialTable) -> Self {
        match (&object.shape, object.transform.uniform_scale()) {
            (AnyShape::Sphere(sphere), Some(scale)) => {
                Self::Sphere { center: object.transform.origin(), radius: sphere.radius * scale, object: number }
            }
            _ => Self::Other { object: number },
        }
    }

    /// The nearest hit in the ray's range.
    #[inline]
    pub fn intersect(&self, objects: &[Object], ray: &Ray) -> Option<WorldHit> {
        match self {
            Self::Sphere { center, radius, object } => {
                Some(WorldHit { hit: intersect_sphere(*center, *radius, ray)?, object: *object })
            }
            Self::Other { object } => intersect(&objects[*object as usize], *object, ray),
        }
    }

    /// Whether anything is hit in the ray's range.
    #[inline]
    pub fn occludes(&self, objects: &[Object], ray: &Ray) -> bool {
        match self {
            Self::Sphere { center, radius, .. } => {
                intersect_sphere(*center, *radius, ray).is_some()
            }
            Self::Other { object } => occludes(&objects[*object as usize], ray),
        }
    }
}

/// The nearest hit with one object in the ray's range.
pub fn intersect(object: &Object, number: u32, ray: &Ray) -> Option<WorldHit> {
    let hit = object.shape.intersect(&object.transform.ray_to_local(ray))?;
    Some(WorldHit { hit, object: number })
}

/// Whether one object is hit in the ray's range.
pub fn occludes(object: &Object, ray: &Ray) -> bool {
    object.shape.occludes(&object.transform.ray_to_local(ray))
}

/// The surface of an object at a hit, world space.
pub fn surface(object: &Object, ray: &Ray, hit: &Hit) -> Surface {
    object.shape.surface(&object.transform.ray_to_local(ray), hit).to_world(&object.transform)
}
