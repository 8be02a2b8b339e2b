//! Objects as ray queries store them: spheres in their geometry's space, other shapes in object
//! space.

use super::{Content, Object, WorldHit};
use juggler_material::MaterialId;
use juggler_math::motion::{key_interval, lerp};
use juggler_math::{Motion, Ray, Transform, Vec3};
use juggler_shape::surface::Surface;
use juggler_shape::{AnyShape, Hit, Shape, Sphere, intersect_sphere, longitude_latitude, sphere_surface};
use std::sync::Arc;

/// An object with precomputed data: 56 bytes and what it shares with the objects before it, since a
/// geometry may have millions.
#[derive(Clone, Debug)]
pub struct Instance {
    pub motion: Motion,
    pub content: Content,
    /// Sphere in the geometry's space, if the object is one. Successive spheres of equal radius
    /// share it, such as the points of a cloud.
    sphere: Option<Arc<SphereKeys>>,
    material: MaterialId,
    inherits_material: bool,
    /// Whether object space equals the geometry's space, as for most ground planes.
    is_identity: bool,
}

/// Bytes of the counters of a shared allocation.
const ARC: usize = 2 * size_of::<usize>();

/// A sphere in its geometry's space.
#[derive(Clone, Debug)]
pub enum SphereKeys {
    /// A sphere that becomes an ellipsoid in the geometry's space.
    Ellipsoid(Sphere),
    /// Radius; the center is the origin of the motion.
    Still(f32),
    /// Centers and radii at the keys of the motion.
    Moving(Arc<[(Vec3, f32)]>),
}

impl SphereKeys {
    /// Converts an object that is a sphere; `None` for any other shape.
    pub fn from_object(object: &Object) -> Option<Self> {
        let sphere = object.content.as_shape()?.sphere()?;
        let at_key = |key: &Transform| Some((key.origin(), sphere.radius * key.uniform_scale()?));
        let keys: Option<Vec<(Vec3, f32)>> = object.motion.keys().iter().map(at_key).collect();
        Some(match keys.as_deref() {
            None | Some([]) => Self::Ellipsoid(sphere.clone()),
            Some([(_, radius)]) => Self::Still(*radius),
            Some(keys) => Self::Moving(keys.into()),
        })
    }

    /// Motion of the unit sphere to the spheres at the keys, without rotation.
    pub fn motion(keys: &[(Vec3, f32)]) -> Option<Motion> {
        let at_key =
            |(center, radius): &(Vec3, f32)| Some(Transform::scale(Vec3::splat(*radius))?.with_translation(*center));
        Motion::from_keys(keys.iter().map(at_key).collect::<Option<_>>()?)
    }

    /// The sphere as `previous` stores it, if both stay and their radii are equal.
    fn sharing(self, previous: Option<&Arc<Self>>) -> Arc<Self> {
        match (&self, previous.map(|previous| (previous, &**previous))) {
            (Self::Still(radius), Some((previous, Self::Still(other)))) if radius.to_bits() == other.to_bits() => {
                Arc::clone(previous)
            }
            _ => Arc::new(self),
        }
    }
}

impl Instance {
    /// Instance of an object, which shares what it can with `previous`.
    pub fn new(object: Object, previous: Option<&Self>) -> Self {
        let sphere = SphereKeys::from_object(&object);
        let Object { content, motion, material, .. } = object;
        let shared = previous.and_then(|previous| previous.sphere.as_ref());
        Self {
            is_identity: motion.is_identity(),
            motion: match previous {
                Some(previous) => motion.sharing(&previous.motion),
                None => motion,
            },
            content,
            sphere: sphere.map(|sphere| sphere.sharing(shared)),
            material: material.unwrap_or(MaterialId::NONE),
            inherits_material: material.is_none(),
        }
    }

    /// Instances of objects.
    pub fn from_objects(objects: Vec<Object>) -> Vec<Self> {
        let mut instances: Vec<Self> = Vec::with_capacity(objects.len());
        for object in objects {
            let instance = Self::new(object, instances.last());
            instances.push(instance);
        }
        instances
    }

    /// Bytes beside the instance that it does not share with `previous`.
    pub fn heap_bytes(&self, previous: Option<&Self>) -> usize {
        let sphere = |instance: &Self| instance.sphere.as_ref().map(Arc::as_ptr);
        let linear = |instance: &Self| match &instance.motion {
            Motion::Still(_, linear) => Some(Arc::as_ptr(linear)),
            Motion::Translation(_) | Motion::Moving(_) => None,
        };
        let mut bytes = 0;
        if sphere(self).is_some() && sphere(self) != previous.and_then(sphere) {
            bytes += ARC + size_of::<SphereKeys>();
        }
        if linear(self).is_some() && linear(self) != previous.and_then(linear) {
            bytes += ARC + size_of::<Transform>();
        }
        match &self.motion {
            Motion::Moving(keys) => bytes + ARC + size_of_val(&**keys),
            Motion::Still(..) | Motion::Translation(_) => bytes,
        }
    }

    /// Material; `None` inherits that of the enclosing instance.
    #[inline(always)]
    pub fn material(&self) -> Option<MaterialId> {
        (!self.inherits_material).then_some(self.material)
    }

    /// Center and radius at a time, if the object is a sphere in the geometry's space.
    #[inline(always)]
    fn sphere_at(&self, time: f32) -> Option<(Vec3, f32)> {
        match &**self.sphere.as_ref()? {
            SphereKeys::Ellipsoid(_) => None,
            SphereKeys::Still(radius) => Some((self.origin(), *radius)),
            SphereKeys::Moving(keys) => {
                let (key, fraction) = key_interval(keys.len(), time);
                let ((from, from_radius), (to, to_radius)) = (keys[key], keys[key + 1]);
                Some((lerp(from, to, fraction), from_radius * (1.0 - fraction) + to_radius * fraction))
            }
        }
    }

    /// Origin of object space; of a moving object, when the shutter opens.
    #[inline(always)]
    fn origin(&self) -> Vec3 {
        match &self.motion {
            Motion::Translation(origin) | Motion::Still(origin, _) => *origin,
            moving @ Motion::Moving(_) => moving.at(0.0).origin(),
        }
    }

    /// Motion that takes `shape` to the sphere that rays hit, without rotation; `None` unless the
    /// object is a sphere that moves. Between keys, the object's own motion shrinks a sphere that
    /// rotates.
    pub fn sphere_motion(&self, shape: &AnyShape) -> Option<Motion> {
        let (Some(SphereKeys::Moving(keys)), Some(sphere)) = (self.sphere.as_deref(), shape.sphere()) else {
            return None;
        };
        let to_unit = Transform::scale(Vec3::splat(1.0 / sphere.radius))?;
        Some(Motion::from(to_unit).then(&SphereKeys::motion(keys)?))
    }

    /// Transforms a ray to object space.
    #[inline(always)]
    pub fn ray_to_object(&self, ray: &Ray) -> Ray {
        if self.is_identity { *ray } else { self.motion.ray_to_local(ray) }
    }

    /// Replaces `best` by a nearer hit in the ray's range. `shape_index` is the index of the
    /// object's first shape.
    #[inline(never)]
    pub fn closest(&self, ray: &mut Ray, shape_index: u32, best: &mut WorldHit) {
        let hit = match (&self.content, self.sphere_at(ray.time)) {
            (Content::Shape(_), Some((center, radius))) => intersect_sphere(center, radius, ray),
            (Content::Shape(shape), None) => match self.sphere.as_deref() {
                // Avoid a virtual call.
                Some(SphereKeys::Ellipsoid(sphere)) => sphere.intersect(&self.ray_to_object(ray)),
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
        let (Content::Shape(shape), None) = (&self.content, &self.sphere) else {
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
        if self.is_identity { shape.intersect(ray) } else { shape.intersect(&self.motion.ray_to_local(ray)) }
    }

    /// Whether the ray hits anything in its range.
    #[inline]
    pub fn occludes(&self, ray: &Ray) -> bool {
        match (&self.content, self.sphere_at(ray.time)) {
            (Content::Shape(_), Some((center, radius))) => intersect_sphere(center, radius, ray).is_some(),
            (Content::Shape(shape), None) => match self.sphere.as_deref() {
                Some(SphereKeys::Ellipsoid(sphere)) => sphere.intersect(&self.ray_to_object(ray)).is_some(),
                _ if self.is_identity => shape.occludes(ray),
                _ => shape.occludes(&self.motion.ray_to_local(ray)),
            },
            (Content::Geometry(geometry), _) => geometry.occludes(&self.ray_to_object(ray)),
        }
    }

    /// Surface at a hit of this object's `shape`, in the geometry's space. If the material is
    /// `plain`, without textures, (u, v) and object coordinates may be omitted.
    #[inline(always)]
    pub fn surface(&self, shape: &AnyShape, ray: &Ray, hit: &Hit, plain: bool) -> Surface {
        match self.sphere_at(ray.time) {
            Some((center, radius)) => {
                let surface = sphere_surface(center, radius, ray, hit);
                if plain { surface } else { with_texture_coordinates(shape, surface, &self.motion.at(ray.time)) }
            }
            None if self.is_identity => shape.surface(ray, hit),
            None => {
                let transform = self.motion.at(ray.time);
                shape.surface(&transform.ray_to_local(ray), hit).to_world(&transform)
            }
        }
    }
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

/// Maximum number of static spheres that rays test one by one instead of a hierarchy.
const MAX_FEW_SPHERES: usize = 4;

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
    /// Whether there are a few static spheres and nothing else, so that rays test them one by one.
    pub fn are_few_spheres(items: &[Self]) -> bool {
        items.len() <= MAX_FEW_SPHERES && items.iter().all(|item| matches!(item, Self::Sphere { .. }))
    }

    /// Creates the entry of an object. With `times`, it counts only from the first to the second of
    /// them.
    pub fn new(object: &Instance, object_index: u32, shape_index: u32, times: Option<[f32; 2]>) -> Self {
        if let Some(times) = times {
            return Self::Segment { times, object_index, shape_index };
        }
        match object.sphere.as_deref() {
            Some(SphereKeys::Still(radius)) => Self::Sphere { center: object.origin(), radius: *radius, shape_index },
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
