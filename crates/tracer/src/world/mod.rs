//! Everything that can be seen, immutable while rendering.

use crate::background::AnyBackground;
use crate::bsdf::Phong;
use crate::light::AnyLight;
use crate::material::{MaterialId, MaterialTable};
use crate::shape::{AnyShape, Hit};
use crate::surface::Surface;
use juggler_bvh::{Bvh, Quality};
use juggler_math::{Aabb, Ray, Rgb, Transform, Vec2, Vec3};
use std::borrow::Cow;
use std::collections::BTreeSet;

mod items;
mod trace;

#[cfg(test)]
mod precision;
#[cfg(test)]
mod tests;

use items::{Item, Placed};

/// A shape in its place.
#[derive(Clone, Debug)]
pub struct Object {
    /// The shape, already prepared.
    pub shape: AnyShape,
    /// Object space → world.
    pub transform: Transform,
    /// What it is made of.
    pub material: MaterialId,
}

/// What a ray met, before anything is worked out about it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorldHit {
    /// As the shape gave it.
    pub hit: Hit,
    object: u32,
}

impl WorldHit {
    /// Nothing was met.
    pub const NONE: Self = Self { hit: Hit { t: f32::INFINITY, uv: Vec2::ZERO, part: 0 }, object: u32::MAX };

    /// Whether anything was met.
    pub fn is_some(&self) -> bool {
        self.object != u32::MAX
    }
}

/// A point where a path touches the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vertex {
    /// The surface there, world space.
    pub surface: Surface,
    /// What it is made of.
    pub material: MaterialId,
    /// Number of the object.
    pub object: u32,
}

/// A light that shines from somewhere, with what is asked at every vertex.
#[derive(Clone, Debug)]
pub struct Lamp {
    /// The light.
    pub light: AnyLight,
    /// [`Light::shadow_samples`](crate::light::Light::shadow_samples), at least 1.
    pub samples: u32,
    /// [`Light::is_point`](crate::light::Light::is_point).
    pub is_point: bool,
    /// [`Light::ball`](crate::light::Light::ball).
    ball: Option<(Vec3, f32)>,
}

/// Counts for reports.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Geometry {
    /// Objects.
    pub shapes: usize,
    /// Triangles of all meshes, polygons and triangles.
    pub triangles: usize,
    /// Lights.
    pub lights: usize,
    /// Bytes of shapes, each mesh counted once however often it is placed.
    pub geometry_bytes: usize,
    /// Bytes of the hierarchies, over the objects and within meshes.
    pub bvh_bytes: usize,
}

/// Everything that can be seen.
pub struct World {
    objects: Vec<Placed>,
    /// Bounded objects in the hierarchy's order.
    items: Vec<Item>,
    bvh: Bvh,
    unbounded: Vec<u32>,
    bounds: Aabb,
    materials: MaterialTable,
    lamps: Vec<Lamp>,
    ambient: Rgb,
    background: AnyBackground,
    has_transparency: bool,
}

impl Lamp {
    fn new(light: AnyLight) -> Self {
        let (samples, is_point, ball) = (light.shadow_samples().max(1), light.is_point(), light.ball());
        Self { light, samples, is_point, ball }
    }

    /// Whether all of it lies below the plane through `point`: it cannot light what faces along `normal` there.
    #[inline]
    pub fn is_below(&self, point: Vec3, normal: Vec3) -> bool {
        self.ball.is_some_and(|(centre, radius)| (centre - point).dot(normal) < -radius)
    }
}

impl World {
    /// Builds the hierarchy over all bounded objects. Every `Object::material` must be in `materials`.
    pub fn new(
        objects: Vec<Object>,
        materials: MaterialTable,
        lights: Vec<AnyLight>,
        background: AnyBackground,
    ) -> Self {
        let boxes: Vec<Aabb> = objects.iter().map(|o| o.transform.aabb(&o.shape.bounds())).collect();
        let numbers = 0..objects.len() as u32;
        let (bounded, unbounded): (Vec<u32>, Vec<u32>) = numbers.partition(|i| boxes[*i as usize].is_finite());
        let bounded_boxes: Vec<Aabb> = bounded.iter().map(|i| boxes[*i as usize]).collect();
        let bvh = Bvh::build(&bounded_boxes, Quality::Balanced);
        let order = bvh.order().iter().map(|position| bounded[*position as usize]);
        let has_transparency = objects.iter().any(|o| materials.is_transparent(o.material));
        let objects: Vec<Placed> = objects.into_iter().map(|object| Placed::new(object, &materials)).collect();
        let items = order.map(|object| Item::new(&objects[object as usize], object)).collect();
        let ambient = lights.iter().fold(Rgb::BLACK, |sum, light| sum + light.ambient());
        let bounds = bounded_boxes.iter().fold(Aabb::EMPTY, |all, one| all.union(*one));
        let lamps = lights.into_iter().filter(|light| light.ambient().is_black()).map(Lamp::new).collect();
        Self { objects, items, bvh, unbounded, bounds, materials, lamps, ambient, background, has_transparency }
    }

    /// The lights that shine from somewhere.
    pub fn lamps(&self) -> &[Lamp] {
        &self.lamps
    }

    /// Light that is everywhere.
    pub fn ambient(&self) -> Rgb {
        self.ambient
    }

    /// Light that a ray sees which leaves the world.
    pub fn background(&self, ray: &Ray) -> Rgb {
        self.background.radiance(ray)
    }

    /// A box around all bounded objects; empty when there are none.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// The numbers of the material at a vertex.
    #[inline]
    pub fn phong(&self, vertex: &Vertex) -> Cow<'_, Phong> {
        self.materials.phong(vertex.material, &vertex.surface)
    }

    /// The surface where `ray` made `hit`.
    #[inline(always)]
    pub fn vertex(&self, ray: &Ray, hit: &WorldHit) -> Vertex {
        let placed = &self.objects[hit.object as usize];
        Vertex { surface: placed.surface(ray, &hit.hit), material: placed.object.material, object: hit.object }
    }

    /// Counts for reports.
    pub fn geometry(&self) -> Geometry {
        // Copies of a mesh share its arrays and its hierarchy.
        let mut meshes = BTreeSet::new();
        let shapes = self.objects.iter().map(|placed| &placed.object.shape);
        let stored: Vec<&AnyShape> = shapes
            .clone()
            .filter(|shape| match shape {
                AnyShape::Mesh(mesh) => mesh.data().is_none_or(|data| meshes.insert(std::ptr::from_ref(data).addr())),
                _ => true,
            })
            .collect();
        Geometry {
            shapes: self.objects.len(),
            triangles: shapes.map(|shape| shape.triangles()).sum(),
            lights: self.lamps.len(),
            geometry_bytes: size_of_val(self.objects.as_slice())
                + size_of_val(self.items.as_slice())
                + stored.iter().map(|shape| shape.heap_bytes()).sum::<usize>(),
            bvh_bytes: self.bvh.bytes() + stored.iter().map(|shape| shape.bvh_bytes()).sum::<usize>(),
        }
    }
}
