//! Objects as tracing sees them: spheres in world space, everything else in its own.

use super::Object;
use crate::material::MaterialTable;
use crate::shape::{AnyShape, Hit, intersect_sphere, longitude_latitude, sphere_surface};
use crate::surface::Surface;
use juggler_math::{Ray, Transform, Vec3};

/// An object with what is worked out once.
#[derive(Clone, Debug)]
pub struct Placed {
    pub object: Object,
    /// Centre and radius in the world, for a sphere that is still one there.
    sphere: Option<(Vec3, f32)>,
    /// The material is the same everywhere: nobody asks for surface coordinates.
    plain: bool,
    /// Object space is world space, as for most grounds.
    unmoved: bool,
}

impl Placed {
    pub fn new(object: Object, materials: &MaterialTable) -> Self {
        let sphere = match (&object.shape, object.transform.uniform_scale()) {
            (AnyShape::Sphere(sphere), Some(scale)) => Some((object.transform.origin(), sphere.radius * scale)),
            _ => None,
        };
        let plain = !materials.is_textured(object.material);
        let unmoved = object.transform == Transform::IDENTITY;
        Self { object, sphere, plain, unmoved }
    }

    /// The nearest hit in the ray's range.
    #[inline]
    pub fn intersect(&self, ray: &Ray) -> Option<Hit> {
        match self.sphere {
            Some((center, radius)) => intersect_sphere(center, radius, ray),
            None if self.unmoved => self.object.shape.intersect(ray),
            None => self.object.shape.intersect(&self.object.transform.ray_to_local(ray)),
        }
    }

    /// Whether anything is hit in the ray's range.
    #[inline]
    pub fn occludes(&self, ray: &Ray) -> bool {
        match self.sphere {
            Some((center, radius)) => intersect_sphere(center, radius, ray).is_some(),
            None if self.unmoved => self.object.shape.occludes(ray),
            None => self.object.shape.occludes(&self.object.transform.ray_to_local(ray)),
        }
    }

    /// The surface at a hit, world space.
    #[inline(always)]
    pub fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        match self.sphere {
            Some((center, radius)) => {
                let surface = sphere_surface(center, radius, ray, hit);
                if self.plain { surface } else { self.textured(surface) }
            }
            None if self.unmoved => self.object.shape.surface(ray, hit),
            None => {
                let transform = &self.object.transform;
                self.object.shape.surface(&transform.ray_to_local(ray), hit).to_world(transform)
            }
        }
    }

    /// The surface of a sphere in the world with what its textures ask for. The point stays where the world's
    /// arithmetic found it: by that of object space, rays that leave it could meet the sphere again.
    #[inline(never)]
    fn textured(&self, surface: Surface) -> Surface {
        let outwards = self.object.transform.vector_to_local(surface.normal).normalize();
        let AnyShape::Sphere(sphere) = &self.object.shape else { return surface };
        Surface { uv: longitude_latitude(outwards), local: outwards * sphere.radius, ..surface }
    }
}

/// One leaf entry. Spheres bring their numbers along; for the others one more look at the object is no
/// matter.
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
    /// Anything else.
    Other {
        /// Number of the object.
        object: u32,
    },
}

impl Item {
    pub fn new(placed: &Placed, object: u32) -> Self {
        match placed.sphere {
            Some((center, radius)) => Self::Sphere { center, radius, object },
            None => Self::Other { object },
        }
    }

    /// The nearest hit in the ray's range, and the number of the object.
    #[inline(always)]
    pub fn intersect(&self, objects: &[Placed], ray: &Ray) -> Option<(Hit, u32)> {
        match *self {
            Self::Sphere { center, radius, object } => Some((intersect_sphere(center, radius, ray)?, object)),
            Self::Other { object } => Some((objects[object as usize].intersect(ray)?, object)),
        }
    }

    /// Whether anything is hit in the ray's range.
    #[inline]
    pub fn occludes(&self, objects: &[Placed], ray: &Ray) -> bool {
        match *self {
            Self::Sphere { center, radius, .. } => intersect_sphere(center, radius, ray).is_some(),
            Self::Other { object } => objects[object as usize].occludes(ray),
        }
    }
}
