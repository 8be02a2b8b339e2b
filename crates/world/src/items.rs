//! Objects as tracing sees them: spheres in their level's space, everything else in its own.

use super::{Content, Object, WorldHit};
use juggler_material::MaterialId;
use juggler_math::motion::{between, stretch};
use juggler_math::{Motion, Ray, Transform, Vec3};
use juggler_shape::surface::Surface;
use juggler_shape::{AnyShape, Hit, Shape, intersect_sphere, longitude_latitude, sphere_surface};
use std::sync::Arc;

/// An object with what is worked out once. What a hit asks for lies together: one cache line, seldom two.
#[derive(Clone, Debug)]
#[repr(C)]
pub struct Placed {
    /// For a sphere that is still one in the level's space.
    ball: Ball,
    pub material: Option<MaterialId>,
    /// Object space is the level's space, as for most grounds.
    unmoved: bool,
    pub content: Content,
    pub motion: Motion,
}

/// A sphere in its level's space.
#[derive(Clone, Debug)]
enum Ball {
    /// It is none.
    None,
    /// Centre and radius.
    Still(Vec3, f32),
    /// Centres and radii at the keys of its motion.
    Moving(Arc<[(Vec3, f32)]>),
}

impl Ball {
    /// Of an object that is a sphere, and one wherever it comes.
    fn of(object: &Object) -> Self {
        let Content::Shape(shape) = &object.content else { return Self::None };
        let AnyShape::Sphere(sphere) = &**shape else { return Self::None };
        let ball = |key: &Transform| Some((key.origin(), sphere.radius * key.uniform_scale()?));
        let keys: Option<Vec<(Vec3, f32)>> = object.motion.keys().iter().map(ball).collect();
        match keys.as_deref() {
            None | Some([]) => Self::None,
            Some([(center, radius)]) => Self::Still(*center, *radius),
            Some(keys) => Self::Moving(keys.into()),
        }
    }

    /// Centre and radius at a time.
    #[inline(always)]
    fn at(&self, time: f32) -> Option<(Vec3, f32)> {
        match self {
            Self::None => None,
            Self::Still(center, radius) => Some((*center, *radius)),
            Self::Moving(keys) => {
                let (key, share) = stretch(keys.len(), time);
                let ((from, thin), (to, thick)) = (keys[key], keys[key + 1]);
                Some((between(from, to, share), thin * (1.0 - share) + thick * share))
            }
        }
    }
}

impl Placed {
    pub fn new(object: Object) -> Self {
        let ball = Ball::of(&object);
        let Object { content, motion, material } = object;
        Self { ball, material, unmoved: motion == Motion::Still(Transform::IDENTITY), content, motion }
    }

    /// The ray in the object's space.
    #[inline(always)]
    pub fn local(&self, ray: &Ray) -> Ray {
        if self.unmoved { *ray } else { self.moved(ray) }
    }

    /// [`Placed::local`] where the object's space is not the level's.
    #[inline(always)]
    fn moved(&self, ray: &Ray) -> Ray {
        match &self.motion {
            Motion::Still(transform) => transform.ray_to_local(ray),
            moving => local_at(moving, ray),
        }
    }

    /// Keeps the nearest hit in the ray's range if it is better than `best`. `number` is that of the object's first
    /// shape.
    #[inline(never)]
    pub fn closest(&self, ray: &mut Ray, number: u32, best: &mut WorldHit) {
        let hit = match (&self.content, self.ball.at(ray.time)) {
            (Content::Shape(_), Some((center, radius))) => intersect_sphere(center, radius, ray),
            (Content::Shape(shape), None) => match &**shape {
                // No virtual call for what is most: spheres that are none in the level's space.
                AnyShape::Sphere(sphere) => sphere.intersect(&self.local(ray)),
                shape => self.intersect(&**shape, ray),
            },
            (Content::Level(level), _) => {
                let mut local = self.local(ray);
                level.closest(&mut local, number, best);
                ray.t_max = local.t_max;
                return;
            }
        };
        if let Some(hit) = hit {
            best.keep(hit, number, ray);
        }
    }

    /// [`Placed::closest`] for each of the rays; what the object is, is asked once.
    pub fn closest_each(&self, rays: &mut [Ray], number: u32, hits: &mut [WorldHit]) {
        let rays = rays.iter_mut().zip(hits);
        let (Content::Shape(shape), Ball::None) = (&self.content, &self.ball) else {
            return rays.for_each(|(ray, best)| self.closest(ray, number, best));
        };
        let shape: &dyn Shape = &***shape;
        for (ray, best) in rays {
            if let Some(hit) = self.intersect(shape, ray) {
                best.keep(hit, number, ray);
            }
        }
    }

    /// The nearest hit of this object's `shape`.
    #[inline(always)]
    fn intersect(&self, shape: &dyn Shape, ray: &Ray) -> Option<Hit> {
        // Without a copy of the ray where it can be avoided.
        if self.unmoved { shape.intersect(ray) } else { shape.intersect(&self.moved(ray)) }
    }

    /// Whether anything is hit in the ray's range.
    #[inline]
    pub fn occludes(&self, ray: &Ray) -> bool {
        match (&self.content, self.ball.at(ray.time)) {
            (Content::Shape(_), Some((center, radius))) => intersect_sphere(center, radius, ray).is_some(),
            (Content::Shape(shape), None) => match &**shape {
                AnyShape::Sphere(sphere) => sphere.intersect(&self.local(ray)).is_some(),
                shape if self.unmoved => shape.occludes(ray),
                shape => shape.occludes(&self.moved(ray)),
            },
            (Content::Level(level), _) => level.occludes(&self.local(ray)),
        }
    }

    /// The surface at a hit of this object's `shape`, in the level's space. Surface coordinates may be left out
    /// where a material is `plain`, the same everywhere.
    #[inline(always)]
    pub fn surface(&self, shape: &AnyShape, ray: &Ray, hit: &Hit, plain: bool) -> Surface {
        match (self.ball.at(ray.time), &self.motion) {
            (Some((center, radius)), motion) => {
                let surface = sphere_surface(center, radius, ray, hit);
                if plain { surface } else { textured(shape, surface, &motion.at(ray.time)) }
            }
            (None, _) if self.unmoved => shape.surface(ray, hit),
            (None, Motion::Still(transform)) => shape.surface(&transform.ray_to_local(ray), hit).to_world(transform),
            (None, moving) => {
                let transform = moving.at(ray.time);
                shape.surface(&transform.ray_to_local(ray), hit).to_world(&transform)
            }
        }
    }
}

/// Out of line: what moves is seldom.
#[inline(never)]
fn local_at(motion: &Motion, ray: &Ray) -> Ray {
    motion.at(ray.time).ray_to_local(ray)
}

/// The surface of a sphere in the level's space with what its textures ask for. The point stays where that
/// arithmetic found it: by that of object space, rays that leave it could meet the sphere again.
#[inline(never)]
fn textured(shape: &AnyShape, surface: Surface, transform: &Transform) -> Surface {
    let outwards = transform.vector_to_local(surface.normal).normalize();
    let AnyShape::Sphere(sphere) = shape else { return surface };
    Surface { uv: longitude_latitude(outwards), local: outwards * sphere.radius, local_normal: outwards, ..surface }
}

/// One leaf entry. Spheres bring their numbers along; for the others one more look at the object is no
/// matter.
#[derive(Clone, Copy, Debug)]
pub enum Item {
    /// A sphere that is still one in the level's space, and stays in its place.
    Sphere {
        /// Level's space.
        center: Vec3,
        /// Level's space.
        radius: f32,
        /// Number of the shape.
        number: u32,
    },
    /// Any other shape.
    Other {
        /// Place of the object in its level.
        place: u32,
        /// Number of the shape.
        number: u32,
    },
    /// An instance of another level.
    Instance {
        /// Place of the object in its level.
        place: u32,
        /// Number of its first shape.
        number: u32,
    },
}

impl Item {
    pub fn new(object: &Object, place: u32, number: u32) -> Self {
        match Ball::of(object) {
            Ball::Still(center, radius) => Self::Sphere { center, radius, number },
            _ if object.content.as_shape().is_some() => Self::Other { place, number },
            _ => Self::Instance { place, number },
        }
    }

    /// Keeps the nearest hit in the ray's range if it is better than `best`; `first` is added to the number.
    #[inline(always)]
    pub fn closest(&self, objects: &[Placed], ray: &mut Ray, first: u32, best: &mut WorldHit) {
        match *self {
            Self::Sphere { center, radius, number } => {
                if let Some(hit) = intersect_sphere(center, radius, ray) {
                    best.keep(hit, first + number, ray);
                }
            }
            Self::Other { place, number } | Self::Instance { place, number } => {
                objects[place as usize].closest(ray, first + number, best);
            }
        }
    }

    /// Whether anything is hit in the ray's range.
    #[inline]
    pub fn occludes(&self, objects: &[Placed], ray: &Ray) -> bool {
        match *self {
            Self::Sphere { center, radius, .. } => intersect_sphere(center, radius, ray).is_some(),
            Self::Other { place, .. } | Self::Instance { place, .. } => objects[place as usize].occludes(ray),
        }
    }
}
