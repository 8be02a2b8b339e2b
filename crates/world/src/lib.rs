//! Scene geometry, materials and lights as the renderer queries them; immutable while rendering.

use contacts::Contacts;
use emissive_shape::EmissiveShape;
use emitters::Emitters;
use juggler_bsdf::PhongParameters;
use juggler_light::background::AnyBackground;
use juggler_material::medium::{Interior, InteriorId};
use juggler_material::{MaterialId, MaterialTable, Shading, ShadingView, TexturedPoint};
use juggler_math::{Aabb, BuildControl, Cancelled, Ray, Rgb, Vec2, Vec3};
use juggler_shape::Hit;
use juggler_shape::surface::{Surface, Tangents};
use shadow_catchers::ShadowCatchers;
use std::borrow::Cow;
use std::sync::Arc;

mod ambiguity;
mod casters;
mod closest_after;
mod cluster;
mod contacts;
mod differential;
mod emissive_shape;
mod emissive_surfaces;
mod emitters;
mod extreme_points;
pub mod frames;
mod geometry;
mod geometry_stats;
mod hierarchy_entries;
mod infinite_lights;
mod instance;
mod instance_attributes;
mod interiors;
mod labels;
mod large_mesh;
mod lift;
pub mod manifold;
mod merged_meshes;
mod object;
mod openings;
mod reproject;
mod scene_light;
mod shadow_catchers;
mod trace;
mod world_shapes;

#[cfg(test)]
mod precision;
#[cfg(test)]
mod tests;

pub use ambiguity::Ambiguity;
pub use casters::{CasterId, CausticCaster, VisibleCasters};
pub use closest_after::HitKey;
use cluster::starts_at;
pub use cluster::{Cluster, Member};
pub use differential::SurfaceDifferential;
pub use emitters::{EmitterId, EmitterSample, LightSampleContext, MAX_SPLIT_TRIANGLES};
pub use extreme_points::extreme_points;
pub use geometry::{Geometry, GeometryTotals, MAX_DEPTH, MAX_OBJECTS};
pub use geometry_stats::GeometryStats;
pub use instance_attributes::{AttributeArrays, AttributeList, InstanceAttributes};
pub use juggler_bvh::{SimdLevel, simd_levels};
pub use labels::{Labels, LightSource, SeparateLights};
pub use object::{Content, Object};
pub use scene_light::{LightState, SceneLight};
pub use trace::{MAX_PASS_THROUGHS, ShadowMode};

/// Result of intersecting a ray with the world, before the surface is evaluated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorldHit {
    /// Distance, parametric coordinates and primitive, as the shape reports them.
    pub hit: Hit,
    /// Index of the shape, counting the contents of every instance.
    shape: u32,
}

impl WorldHit {
    /// No hit.
    pub const NONE: Self = Self { hit: Hit { t: f32::INFINITY, uv: Vec2::ZERO, primitive: 0 }, shape: u32::MAX };

    /// Whether the ray hit a surface.
    #[inline]
    pub fn is_some(&self) -> bool {
        self.shape != u32::MAX
    }

    /// Keeps the nearer of the two hits and shortens the ray to it. At equal distance the hit with
    /// the lower shape index wins, so that the order of traversal does not affect the result.
    #[inline(always)]
    fn keep_nearer(&mut self, hit: Hit, shape: u32, ray: &mut Ray) {
        if hit.t < self.hit.t || (hit.t == self.hit.t && shape < self.shape) {
            ray.t_max = hit.t;
            *self = Self { hit, shape };
        }
    }
}

/// A point where a path hits a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vertex {
    /// Surface at the point, in world space.
    pub surface: Surface,
    /// Material of the surface.
    pub material: MaterialId,
    /// Index of the shape, counting the contents of every instance.
    pub shape: u32,
    /// Index of the triangle or face within the shape.
    pub primitive: u32,
    /// Tangents ∂p/∂u and ∂p/∂v, if the material needs them and the surface has them at this point.
    pub tangents: Option<Tangents>,
}

/// The scene as the renderer queries it: geometry, materials, lights and background.
#[derive(Clone)]
pub struct World {
    /// Top-level geometry, shared by worlds with the same objects and transforms.
    top: Arc<Geometry>,
    materials: MaterialTable,
    lights: Vec<SceneLight>,
    ambient: Rgb,
    background: AnyBackground,
    hides_background: bool,
    shadow_catchers: Option<ShadowCatchers>,
    emitters: Emitters,
    casters: Vec<CausticCaster>,
    contacts: Contacts,
    has_transparency: bool,
    has_opacity: bool,
    /// Whether any surface is absent for some rays: see [`MaterialTable::is_absent`].
    has_absence: bool,
    /// Whether light passes through any surface that bounds no solid.
    has_sheets: bool,
    has_media: bool,
    /// Whether the index of refraction of any material depends on the wavelength.
    has_dispersion: bool,
    has_image_textures: bool,
    /// Whether any mesh has attributes or a second set of surface coordinates.
    has_mesh_attributes: bool,
    moves: bool,
    labels: Labels,
    has_groups: bool,
}

impl World {
    /// Builds the hierarchy over the objects. Every `Object::material` must be in `materials`.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] if `control` is cancelled.
    pub fn new(
        objects: Vec<Object>,
        materials: MaterialTable,
        lights: impl IntoIterator<Item = impl Into<SceneLight>>,
        background: AnyBackground,
        control: &BuildControl,
    ) -> Result<Self, Cancelled> {
        let top = Geometry::top_level(objects, control)?;
        Self::from_top_level(Arc::new(top), materials, lights, background, control)
    }

    /// Creates a world with the same geometry and other materials, lights and background. Reuses
    /// the bounding volume hierarchy. Every `Object::material` must be in `materials`. The result
    /// is bit for bit that of [`World::new`].
    ///
    /// # Errors
    ///
    /// [`Cancelled`] if `control` is cancelled.
    pub fn with_shading(
        &self,
        materials: MaterialTable,
        lights: impl IntoIterator<Item = impl Into<SceneLight>>,
        background: AnyBackground,
        control: &BuildControl,
    ) -> Result<Self, Cancelled> {
        let lights: Vec<SceneLight> = lights.into_iter().map(Into::into).collect();
        let shadow_catchers = match &self.shadow_catchers {
            None => None,
            Some(all) => Some(all.with_shading(materials.clone(), lights.clone(), background.clone(), control)?),
        };
        let world = Self::from_top_level(Arc::clone(&self.top), materials, lights, background, control)?;
        Ok(Self { shadow_catchers, ..world })
    }

    fn from_top_level(
        top: Arc<Geometry>,
        materials: MaterialTable,
        lights: impl IntoIterator<Item = impl Into<SceneLight>>,
        background: AnyBackground,
        control: &BuildControl,
    ) -> Result<Self, Cancelled> {
        let mut lights: Vec<SceneLight> = lights.into_iter().map(Into::into).collect();
        let ambient = lights.iter().fold(Rgb::BLACK, |sum, light| sum + light.ambient);
        lights.retain(|light| light.ambient.is_black());
        let shapes = EmissiveShape::collect(&top, &materials);
        let emitters = Emitters::new(&lights, shapes, &background, top.radius(), control)?;
        Ok(Self::from_emitters(top, materials, (lights, ambient), background, emitters))
    }

    fn from_emitters(
        top: Arc<Geometry>,
        materials: MaterialTable,
        (lights, ambient): (Vec<SceneLight>, Rgb),
        background: AnyBackground,
        emitters: Emitters,
    ) -> Self {
        let geometries = geometry_stats::geometries(&top);
        let used =
            || geometries.iter().flat_map(|geometry| &geometry.objects).filter_map(|instance| instance.material());
        let has_transparency = used().any(|id| materials.is_transparent(id));
        let has_opacity = used().any(|id| materials.has_opacity(id));
        let has_absence = used().any(|id| materials.has_absence(id));
        let has_sheets = used().any(|id| materials.is_sheet(id));
        let has_media = materials.interiors().iter().any(|interior| !interior.medium.is_clear());
        let has_dispersion = materials.interiors().iter().any(|interior| interior.dispersion > 0.0);
        let has_mesh_attributes = top.has_mesh_attributes;
        let has_image_textures = materials.textures().image_bytes() > 0;
        let moves = top.moves() || lights.iter().any(SceneLight::moves);
        let casters = CausticCaster::collect(&top, &materials);
        let contacts = Contacts::new(&top, &materials);
        Self {
            has_mesh_attributes,
            has_image_textures,
            top,
            materials,
            lights,
            ambient,
            background,
            hides_background: false,
            shadow_catchers: None,
            emitters,
            casters,
            contacts,
            has_transparency,
            has_opacity,
            has_absence,
            has_sheets,
            has_media,
            has_dispersion,
            moves,
            labels: Labels::default(),
            has_groups: false,
        }
    }

    /// Sets the SIMD instruction set of all ray queries, for tests and measurements. The default is
    /// the best one that the machine supports.
    pub fn with_simd_level(mut self, level: SimdLevel) -> Self {
        self.top = Arc::new(Arc::unwrap_or_clone(self.top).at_simd_level(level));
        self.emitters = self.emitters.with_simd_level(level);
        self.shadow_catchers = self.shadow_catchers.map(|catchers| catchers.with_simd_level(level));
        self
    }

    /// Materials of all shapes.
    #[inline]
    pub fn materials(&self) -> &MaterialTable {
        &self.materials
    }

    /// Scene entries and light groups of shapes.
    #[inline]
    pub fn labels(&self) -> &Labels {
        &self.labels
    }

    /// Lights of the scene, without ambient ones.
    #[inline]
    pub fn lights(&self) -> &[SceneLight] {
        &self.lights
    }

    /// Radiance of all ambient lights together, which reaches every point unoccluded.
    #[inline]
    pub fn ambient(&self) -> Rgb {
        self.ambient
    }

    /// Background radiance along a ray that leaves the world.
    #[inline]
    pub fn background_radiance(&self, ray: &Ray) -> Rgb {
        self.background.radiance(ray)
    }

    /// Radiance that camera rays see in place of the background's light, directly and through glass;
    /// `None` if they see the light itself.
    #[inline]
    pub fn backdrop(&self) -> Option<Rgb> {
        if self.hides_background { Some(Rgb::BLACK) } else { self.background.visible_as() }
    }

    /// Whether anything moves while the shutter is open, so that the time of a ray matters.
    #[inline]
    pub fn moves(&self) -> bool {
        self.moves
    }

    /// Bounding box of all bounded objects over the shutter interval, in world space; empty if
    /// there are none.
    pub fn bounds(&self) -> Aabb {
        self.top.bounds()
    }

    /// Whether both worlds share their geometry in memory.
    pub fn shares_geometry_with(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.top, &other.top)
    }

    /// Bounding box of a shape, in world space; empty if the shape is unbounded. `shape` is
    /// [`Vertex::shape`] of some vertex.
    pub fn shape_bounds(&self, shape: u32) -> Aabb {
        self.top.shape_bounds(shape)
    }

    /// Parameters of the classic Phong material at a vertex; `None` if the material is of another
    /// kind.
    #[inline]
    pub fn phong(&self, vertex: &Vertex) -> Option<Cow<'_, PhongParameters>> {
        let mesh = self.mesh_point(vertex);
        self.materials.phong(vertex.material, TexturedPoint { surface: &vertex.surface, mesh: mesh.as_ref() })
    }

    /// Evaluates the material at a vertex, viewed from `wo`. `outside_ior` is the index of
    /// refraction of the surrounding medium. `u_choice`, in [0, 1), selects among mixed materials.
    #[inline(always)]
    pub fn shade(&self, vertex: &Vertex, wo: Vec3, outside_ior: f32, u_choice: f32) -> Shading {
        let mut shading = Shading::black();
        self.shade_into(vertex, wo, outside_ior, u_choice, &mut shading);
        shading
    }

    /// Writes the result of [`World::shade`] to `shading`, which must be black. The structure is
    /// too large to return by value cheaply.
    #[inline(always)]
    pub fn shade_into(&self, vertex: &Vertex, wo: Vec3, outside_ior: f32, u_choice: f32, shading: &mut Shading) {
        let tangents = vertex.tangents.as_ref();
        let mesh = self.mesh_point(vertex);
        let point = TexturedPoint { surface: &vertex.surface, mesh: mesh.as_ref() };
        let view = ShadingView { wo, outside_ior, u_choice, tangents, ..ShadingView::along_normal(point) };
        self.materials.shade_into(vertex.material, &view, shading);
    }

    /// Whether light may pass straight through any surface in classic pictures.
    #[inline]
    pub fn has_transparency(&self) -> bool {
        self.has_transparency
    }

    /// Whether shading the vertex needs no random choice among materials.
    #[inline]
    pub fn is_simple(&self, vertex: &Vertex) -> bool {
        self.materials.is_simple(vertex.material)
    }

    /// Interior of the solid that the surface bounds; `None` if the material transmits no light
    /// into it.
    #[inline]
    pub fn interior(&self, vertex: &Vertex) -> Option<InteriorId> {
        self.materials.interior(vertex.material)
    }

    /// Interiors of all solids.
    #[inline]
    pub fn interiors(&self) -> &[Interior] {
        self.materials.interiors()
    }

    /// Interior by its id; `None` for an id of another world.
    #[inline]
    pub fn interior_at(&self, id: InteriorId) -> Option<&Interior> {
        self.interiors().get(id.index())
    }

    /// Whether the index of refraction of any material depends on the wavelength.
    #[inline]
    pub fn has_dispersion(&self) -> bool {
        self.has_dispersion
    }

    /// Surface at a hit of `ray`.
    #[inline(always)]
    pub fn vertex(&self, ray: &Ray, hit: &WorldHit) -> Vertex {
        let mut vertex = self.top.vertex(ray, hit, hit.shape, None, &self.materials);
        if self.materials.needs_tangents(vertex.material) {
            vertex.tangents = self.tangents(ray, hit, &vertex);
        }
        vertex
    }

    /// Counts and memory use of the geometry, for reports.
    pub fn geometry_stats(&self) -> GeometryStats {
        let texture_bytes = self.materials.textures().image_bytes();
        let background_bytes = self.background.heap_bytes();
        let emitter_bytes = self.emitters.heap_bytes();
        let emitting_shapes = self.emitters.emissive_shapes().count();
        let all = GeometryStats::from_geometry(&self.top, self.lights.len());
        GeometryStats { emitting_shapes, texture_bytes, background_bytes, emitter_bytes, ..all }
    }
}
