//! Objects as ray queries store them: spheres in their geometry's space, other shapes in object
//! space.

use super::{Content, Object, WorldHit};
use juggler_material::MaterialId;
use juggler_math::motion::{key_interval, lerp};
use juggler_math::{Motion, Ray, Transform, Vec3};
use juggler_shape::surface::Surface;
use juggler_shape::{AnyShape, Hit, Shape, Sphere, intersect_sphere, longitude_latitude, sphere_surface};
use std::sync::Arc;

/// An object with precomputed data. The fields that intersection reads come first, in one cache
/// line if possible.
#[derive(Clone, Debug)]
#[repr(C)]
pub struct Instance {
    /// Sphere in the geometry's space, if the object is one.
    sphere: SphereKeys,
    pub material: Option<MaterialId>,
    /// Whether object space equals the geometry's space, as for most ground planes.
    is_identity: bool,
    pub content: Content,
    pub motion: Motion,
}

/// A sphere in its geometry's space.
#[derive(Clone, Debug)]
pub enum SphereKeys {
    /// The object is no sphere in the geometry's space.
    None,
    /// A sphere that becomes an ellipsoid in the geometry's space.
    Ellipsoid(Sphere),
    /// Center and radius.
    Still(Vec3, f32),
    /// Centers and radii at the keys of the motion.
    Moving(Arc<[(Vec3, f32)]>),
}

impl SphereKeys {
    /// Converts an object that is a sphere and stays one at every key of its motion.
    pub fn from_object(object: &Object) -> Self {
        let Content::Shape(shape) = &object.content else { return Self::None };
        let Some(sphere) = shape.sphere() else { return Self::None };
        let at_key = |key: &Transform| Some((key.origin(), sphere.radius * key.uniform_scale()?));
        let keys: Option<Vec<(Vec3, f32)>> = object.motion.keys().iter().map(at_key).collect();
        match keys.as_deref() {
            None | Some([]) => Self::Ellipsoid(sphere.clone()),
            Some([(center, radius)]) => Self::Still(*center, *radius),
            Some(keys) => Self::Moving(keys.into()),
        }
    }

    /// Motion of the unit sphere to the spheres at the keys, without rotation.
    pub fn motion(keys: &[(Vec3, f32)]) -> Option<Motion> {
        let at_key =
            |(center, radius): &(Vec3, f32)| Some(Transform::scale(Vec3::splat(*radius))?.with_translation(*center));
        Motion::from_keys(keys.iter().map(at_key).collect::<Option<_>>()?)
    }

    /// Center and radius at a time.
    #[inline(always)]
    fn at(&self, time: f32) -> Option<(Vec3, f32)> {
        match self {
            Self::None | Self::Ellipsoid(_) => None,
            Self::Still(center, radius) => Some((*center, *radius)),
            Self::Moving(keys) => {
                let (key, fraction) = key_interval(keys.len(), time);
                let ((from, from_radius), (to, to_radius)) = (keys[key], keys[key + 1]);
                Some((lerp(from, to, fraction), from_radius * (1.0 - fraction) + to_radius * fraction))
            }
        }
    }
}

impl Instance {
    pub fn new(object: Object) -> Self {
        let sphere = SphereKeys::from_object(&object);
        let Object { content, motion, material, .. } = object;
        Self { sphere, material, is_identity: motion == Motion::Still(Transform::IDENTITY), content, motion }
    }

    /// Motion that takes `shape` to the sphere that rays hit, without rotation; `None` unless the
    /// object is a sphere that moves. Between keys, the object's own motion shrinks a sphere that
    /// rotates.
    pub fn sphere_motion(&self, shape: &AnyShape) -> Option<Motion> {
        let (SphereKeys::Moving(keys), Some(sphere)) = (&self.sphere, shape.sphere()) else { return None };
        let to_unit = Transform::scale(Vec3::splat(1.0 / sphere.radius))?;
        Some(Motion::Still(to_unit).then(&SphereKeys::motion(keys)?))
    }

    /// Transforms a ray to object space.
    #[inline(always)]
    pub fn ray_to_object(&self, ray: &Ray) -> Ray {
        if self.is_identity { *ray } else { self.to_object_space(ray) }
    }

    /// Transforms a ray to object space if that differs from the geometry's space.
    #[inline(always)]
    fn to_object_space(&self, ray: &Ray) -> Ray {
        match &self.motion {
            Motion::Still(transform) => transform.ray_to_local(ray),
            moving => ray_to_object_at(moving, ray),
        }
    }

    /// Replaces `best` by a nearer hit in the ray's range. `shape_index` is the index of the
    /// object's first shape.
    #[inline(never)]
    pub fn closest(&self, ray: &mut Ray, shape_index: u32, best: &mut WorldHit) {
        let hit = match (&self.content, self.sphere.at(ray.time)) {
            (Content::Shape(_), Some((center, radius))) => intersect_sphere(center, radius, ray),
            (Content::Shape(shape), None) => match &self.sphere {
                // Avoid a virtual call.
                SphereKeys::Ellipsoid(sphere) => sphere.intersect(&self.ray_to_object(ray)),
                _ => self.intersect(&***shape, ray),
            },
            (Content::Geometry(geometry), _) => {
                let mut local = self.ray_to_object(ray);
                geometry.closest(&mut local, shape_index, best);
                ray.t_max = local.t_max;
                return;
            }
        };
        if let Some(hit) = hit {
            best.keep_nearer(hit, shape_index, ray);
        }
    }

    /// [`Instance::closest`] for several rays, with one dispatch on the kind of object.
    pub fn closest_each(&self, rays: &mut [Ray], shape_index: u32, hits: &mut [WorldHit]) {
        let rays = rays.iter_mut().zip(hits);
        let (Content::Shape(shape), SphereKeys::None) = (&self.content, &self.sphere) else {
            return rays.for_each(|(ray, best)| self.closest(ray, shape_index, best));
        };
        let shape: &dyn Shape = &***shape;
        for (ray, best) in rays {
            if let Some(hit) = self.intersect(shape, ray) {
                best.keep_nearer(hit, shape_index, ray);
            }
        }
    }

    /// Nearest hit of this object's `shape`.
    #[inline(always)]
    fn intersect(&self, shape: &dyn Shape, ray: &Ray) -> Option<Hit> {
        // Avoid copying the ray if possible.
        if self.is_identity { shape.intersect(ray) } else { shape.intersect(&self.to_object_space(ray)) }
    }

    /// Whether the ray hits anything in its range.
    #[inline]
    pub fn occludes(&self, ray: &Ray) -> bool {
        match (&self.content, self.sphere.at(ray.time)) {
            (Content::Shape(_), Some((center, radius))) => intersect_sphere(center, radius, ray).is_some(),
            (Content::Shape(shape), None) => match &self.sphere {
                SphereKeys::Ellipsoid(sphere) => sphere.intersect(&self.ray_to_object(ray)).is_some(),
                _ if self.is_identity => shape.occludes(ray),
                _ => shape.occludes(&self.to_object_space(ray)),
            },
            (Content::Geometry(geometry), _) => geometry.occludes(&self.ray_to_object(ray)),
        }
    }

    /// Surface at a hit of this object's `shape`, in the geometry's space. If the material is
    /// `plain`, without textures, (u, v) and object coordinates may be omitted.
    #[inline(always)]
    pub fn surface(&self, shape: &AnyShape, ray: &Ray, hit: &Hit, plain: bool) -> Surface {
        match (self.sphere.at(ray.time), &self.motion) {
            (Some((center, radius)), motion) => {
                let surface = sphere_surface(center, radius, ray, hit);
                if plain { surface } else { with_texture_coordinates(shape, surface, &motion.at(ray.time)) }
            }
            (None, _) if self.is_identity => shape.surface(ray, hit),
            (None, Motion::Still(transform)) => shape.surface(&transform.ray_to_local(ray), hit).to_world(transform),
            (None, moving) => {
                let transform = moving.at(ray.time);
                shape.surface(&transform.ray_to_local(ray), hit).to_world(&transform)
            }
        }
    }
}

/// Kept out of line, since motion is rare.
#[inline(never)]
fn ray_to_object_at(motion: &Motion, ray: &Ray) -> Ray {
    motion.at(ray.time).ray_to_local(ray)
}

/// Adds texture and object coordinates to the surface of a sphere in the geometry's space. The
/// point remains that of the intersection: one recomputed in object space could make rays that
/// leave it hit the sphere again.
#[inline(never)]
fn with_texture_coordinates(shape: &AnyShape, surface: Surface, transform: &Transform) -> Surface {
    let outwards = transform.vector_to_local(surface.normal).normalize();
    let Some(sphere) = shape.sphere() else { return surface };
    Surface { uv: longitude_latitude(outwards), local: outwards * sphere.radius, local_normal: outwards, ..surface }
}

/// A leaf entry of the hierarchy. Spheres are stored inline; other objects need one more memory
/// access.
#[derive(Clone, Copy, Debug)]
pub enum LeafItem {
    /// A static sphere in the geometry's space.
    Sphere {
        /// Center, in the geometry's space.
        center: Vec3,
        /// Radius, in the geometry's space.
        radius: f32,
        /// Index of the shape.
        shape_index: u32,
    },
    /// Any other shape.
    Shape {
        /// Index of the object in its geometry.
        object_index: u32,
        /// Index of the shape.
        shape_index: u32,
    },
    /// An instance of another geometry.
    Geometry {
        /// Index of the object in its geometry.
        object_index: u32,
        /// Index of its first shape.
        shape_index: u32,
    },
    /// A moving shape or instance, bounded over a segment of the shutter interval.
    Segment {
        /// Times from which and to which the entry counts.
        times: [f32; 2],
        /// Index of the object in its geometry.
        object_index: u32,
        /// Index of its first shape.
        shape_index: u32,
    },
}

/// Whether the time of a ray is in a segment of the shutter interval.
#[inline(always)]
pub(super) fn is_within(ray: &Ray, [from, to]: [f32; 2]) -> bool {
    let time = ray.time.clamp(0.0, 1.0);
    from <= time && time <= to
}

impl LeafItem {
    /// Creates the entry of an object. With `times`, it counts only from the first to the second of
    /// them.
    pub fn new(object: &Object, object_index: u32, shape_index: u32, times: Option<[f32; 2]>) -> Self {
        if let Some(times) = times {
            return Self::Segment { times, object_index, shape_index };
        }
        match SphereKeys::from_object(object) {
            SphereKeys::Still(center, radius) => Self::Sphere { center, radius, shape_index },
            _ if object.content.as_shape().is_some() => Self::Shape { object_index, shape_index },
            _ => Self::Geometry { object_index, shape_index },
        }
    }

    /// Replaces `best` by a nearer hit in the ray's range. `first` is added to the shape index.
    #[inline(always)]
    pub fn closest(&self, objects: &[Instance], ray: &mut Ray, first: u32, best: &mut WorldHit) {
        match *self {
            Self::Sphere { center, radius, shape_index } => {
                if let Some(hit) = intersect_sphere(center, radius, ray) {
                    best.keep_nearer(hit, first + shape_index, ray);
                }
            }
            Self::Shape { object_index, shape_index } | Self::Geometry { object_index, shape_index } => {
                objects[object_index as usize].closest(ray, first + shape_index, best);
            }
            Self::Segment { times, object_index, shape_index } => {
                if is_within(ray, times) {
                    objects[object_index as usize].closest(ray, first + shape_index, best);
                }
            }
        }
    }

    /// Whether the ray hits anything in its range.
    #[inline(always)]
    pub fn occludes(&self, objects: &[Instance], ray: &Ray) -> bool {
        match *self {
            Self::Sphere { center, radius, .. } => intersect_sphere(center, radius, ray).is_some(),
            Self::Shape { object_index, .. } | Self::Geometry { object_index, .. } => {
                objects[object_index as usize].occludes(ray)
            }
            Self::Segment { times, object_index, .. } => occludes_within(&objects[object_index as usize], ray, times),
        }
    }
}

/// Whether the ray hits an object that counts in a segment of the shutter interval. Kept out of line,
/// since motion is rare.
#[cold]
#[inline(never)]
fn occludes_within(object: &Instance, ray: &Ray, times: [f32; 2]) -> bool {
    is_within(ray, times) && object.occludes(ray)
}
