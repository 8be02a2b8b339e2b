//! Everything that can be seen, immutable while rendering.

use emitters::Emitters;
use glowing::Glowing;
use juggler_bsdf::Phong;
use juggler_light::background::AnyBackground;
use juggler_material::medium::{Interior, InteriorId};
use juggler_material::{MaterialId, MaterialTable, Shade, View};
use juggler_math::{Aabb, Ray, Rgb, Vec2, Vec3};
use juggler_shape::Hit;
use juggler_shape::surface::{Surface, Tangents};
use std::borrow::Cow;
use std::sync::Arc;

mod areas;
mod carried;
mod casters;
mod differential;
mod emitters;
mod far;
pub mod frames;
mod geometry;
mod glowing;
mod inside;
mod items;
mod labels;
mod lamp;
mod large;
mod level;
pub mod manifold;
mod merged;
mod object;
mod standing;
mod trace;

#[cfg(test)]
mod precision;
#[cfg(test)]
mod tests;

pub use casters::{Caster, CasterId, Prospect};
pub use differential::Differential;
pub use emitters::{Lighting, Origin, Receiver};
pub use geometry::Geometry;
pub use juggler_bvh::{SimdLevel, simd_levels};
pub use labels::{Labels, LightSource, LightsApart};
pub use lamp::{Lamp, Source};
pub use level::{Level, MAX_DEPTH, MAX_OBJECTS, Totals};
pub use object::{Content, Object};
pub use trace::{MAX_PASSED, Shadows};

/// What a ray met, before anything is worked out about it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorldHit {
    /// As the shape gave it.
    pub hit: Hit,
    /// Number of the shape, instances of levels counted as what they hold.
    object: u32,
}

impl WorldHit {
    /// Nothing was met.
    pub const NONE: Self = Self { hit: Hit { t: f32::INFINITY, uv: Vec2::ZERO, part: 0 }, object: u32::MAX };

    /// Whether anything was met.
    #[inline]
    pub fn is_some(&self) -> bool {
        self.object != u32::MAX
    }

    /// The nearer one stays; of two at the same distance the one with the lower number, so that the order of
    /// traversal cannot show. The ray ends at it.
    #[inline(always)]
    fn keep(&mut self, hit: Hit, object: u32, ray: &mut Ray) {
        if hit.t < self.hit.t || (hit.t == self.hit.t && object < self.object) {
            ray.t_max = hit.t;
            *self = Self { hit, object };
        }
    }
}

/// Of a ball around everything that has an end; 1 where nothing has.
fn radius(bounds: &Aabb) -> f32 {
    let radius = 0.5 * bounds.extent().length();
    if radius > 0.0 && radius < f32::INFINITY { radius } else { 1.0 }
}

/// A point where a path touches the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vertex {
    /// The surface there, world space.
    pub surface: Surface,
    /// What it is made of.
    pub material: MaterialId,
    /// Number of the shape, instances of levels counted as what they hold.
    pub object: u32,
    /// Triangle or face of the shape.
    pub part: u32,
    /// How the surface runs along its coordinates, where the material asks for it and the surface has an answer.
    pub tangents: Option<Tangents>,
}

/// Everything that can be seen.
#[derive(Clone)]
pub struct World {
    /// Shared by worlds in which the same things stand in the same places.
    top: Arc<Level>,
    materials: MaterialTable,
    lamps: Vec<Lamp>,
    ambient: Rgb,
    background: AnyBackground,
    emitters: Emitters,
    casters: Vec<Caster>,
    has_transparency: bool,
    has_holes: bool,
    has_media: bool,
    has_pictures: bool,
    moves: bool,
    labels: Labels,
    has_groups: bool,
}

impl World {
    /// Builds the hierarchy over the objects. Every `Object::material` must be in `materials`.
    pub fn new(
        objects: Vec<Object>,
        materials: MaterialTable,
        lights: impl IntoIterator<Item = impl Into<Lamp>>,
        background: AnyBackground,
    ) -> Self {
        Self::over(Arc::new(Level::top(objects)), materials, lights, background)
    }

    /// The same objects with other materials, lights and background: nothing is built anew but what depends on those. Every
    /// `Object::material` must be in `materials`. The result is bit for bit that of [`World::new`].
    pub fn with_shading(
        &self,
        materials: MaterialTable,
        lights: impl IntoIterator<Item = impl Into<Lamp>>,
        background: AnyBackground,
    ) -> Self {
        Self::over(Arc::clone(&self.top), materials, lights, background)
    }

    fn over(
        top: Arc<Level>,
        materials: MaterialTable,
        lights: impl IntoIterator<Item = impl Into<Lamp>>,
        background: AnyBackground,
    ) -> Self {
        let levels = geometry::levels(&top);
        let used = || levels.iter().flat_map(|level| &level.objects).filter_map(|placed| placed.material);
        let has_transparency = used().any(|id| materials.is_transparent(id));
        let has_holes = used().any(|id| materials.has_holes(id));
        let has_media = materials.interiors().iter().any(|interior| !interior.medium.is_clear());
        let mut lamps: Vec<Lamp> = lights.into_iter().map(Into::into).collect();
        let ambient = lamps.iter().fold(Rgb::BLACK, |sum, lamp| sum + lamp.ambient);
        lamps.retain(|lamp| lamp.ambient.is_black());
        let has_pictures = materials.textures().image_bytes() > 0;
        let moves = top.moves() || lamps.iter().any(Lamp::moves);
        let emitters = Emitters::new(&lamps, Glowing::all(&top, &materials), &background, radius(&top.bounds()));
        let casters = Caster::all(&top, &materials);
        Self {
            top,
            materials,
            lamps,
            ambient,
            background,
            emitters,
            casters,
            has_transparency,
            has_holes,
            has_media,
            has_pictures,
            moves,
            labels: Labels::default(),
            has_groups: false,
        }
    }

    /// The same world for another vector unit than the best of this machine: for tests and measurements.
    pub fn with_simd_level(mut self, level: SimdLevel) -> Self {
        self.top = Arc::new(Arc::unwrap_or_clone(self.top).at_simd_level(level));
        self.emitters = self.emitters.with_simd_level(level);
        self
    }

    /// What its shapes are made of.
    #[inline]
    pub fn materials(&self) -> &MaterialTable {
        &self.materials
    }

    /// What belongs together.
    #[inline]
    pub fn labels(&self) -> &Labels {
        &self.labels
    }

    /// The lights that shine from somewhere.
    #[inline]
    pub fn lamps(&self) -> &[Lamp] {
        &self.lamps
    }

    /// Light that is everywhere.
    #[inline]
    pub fn ambient(&self) -> Rgb {
        self.ambient
    }

    /// Light that a ray sees which leaves the world.
    #[inline]
    pub fn background(&self, ray: &Ray) -> Rgb {
        self.background.radiance(ray)
    }

    /// Whether anything moves while the shutter is open, so that the time of a ray makes a difference.
    #[inline]
    pub fn moves(&self) -> bool {
        self.moves
    }

    /// A box around all bounded objects, wherever they come; empty when there are none.
    pub fn bounds(&self) -> Aabb {
        self.top.bounds()
    }

    /// Whether both hold the very same objects in memory.
    pub fn shares_geometry_with(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.top, &other.top)
    }

    /// A box around a shape by its number, which must be that of a [`Vertex`]; empty when it has no end.
    pub fn shape_bounds(&self, number: u32) -> Aabb {
        self.top.shape_bounds(number)
    }

    /// The numbers of the classic material at a vertex; `None` where it is of another kind.
    #[inline]
    pub fn phong(&self, vertex: &Vertex) -> Option<Cow<'_, Phong>> {
        self.materials.phong(vertex.material, &vertex.surface)
    }

    /// The material at a vertex, seen from `wo`, with an index of refraction of `around_ior` around it; `pick` is a number in [0, 1) for what is one thing or another by
    /// chance.
    #[inline(always)]
    pub fn shade(&self, vertex: &Vertex, wo: Vec3, around_ior: f32, pick: f32) -> Shade {
        let mut shade = Shade::black();
        self.fill_shade(vertex, wo, around_ior, pick, &mut shade);
        shade
    }

    /// [`World::shade`] into a black `shade`, which is too large to be handed on by value.
    #[inline]
    pub fn fill_shade(&self, vertex: &Vertex, wo: Vec3, around_ior: f32, pick: f32, shade: &mut Shade) {
        let tangents = vertex.tangents.as_ref();
        let view = View { wo, around_ior, pick, tangents, ..View::of(&vertex.surface) };
        self.materials.fill(vertex.material, &view, shade);
    }

    /// Whether nothing about the material at a vertex is left to chance.
    #[inline]
    pub fn is_simple(&self, vertex: &Vertex) -> bool {
        self.materials.is_simple(vertex.material)
    }

    /// What is behind the surface of a vertex, if light comes there.
    #[inline]
    pub fn interior(&self, vertex: &Vertex) -> Option<InteriorId> {
        self.materials.interior(vertex.material)
    }

    /// All that is behind surfaces.
    #[inline]
    pub fn interiors(&self) -> &[Interior] {
        self.materials.interiors()
    }

    /// The surface where `ray` made `hit`.
    #[inline(always)]
    pub fn vertex(&self, ray: &Ray, hit: &WorldHit) -> Vertex {
        let mut vertex = self.top.vertex(ray, hit, hit.object, None, &self.materials);
        if self.materials.needs_tangents(vertex.material) {
            vertex.tangents = self.tangents(ray, hit, &vertex);
        }
        vertex
    }

    /// Counts for reports.
    pub fn geometry(&self) -> Geometry {
        let texture_bytes = self.materials.textures().image_bytes();
        let background_bytes = self.background.heap_bytes();
        let emitter_bytes = self.emitters.heap_bytes();
        let emitting_shapes = self.emitters.glowing().count();
        let all = Geometry::of(&self.top, self.lamps.len());
        Geometry { emitting_shapes, texture_bytes, background_bytes, emitter_bytes, ..all }
    }
}
