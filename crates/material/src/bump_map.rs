//! Bump map: shading normals from a texture of heights (Blinn, Simulation of Wrinkled Surfaces,
//! 1978).
//!
//! ```json
//! {"bump_map": {"height": "leather", "distance": 0.02, "material": "skin"}}
//! ```
//!
//! The normal n becomes n - ∇h, with ∇h the gradient of the height along the surface (Mikkelsen,
//! Bump Mapping Unparametrized Surfaces on the GPU, 2010), estimated by central differences.

use super::error::in_range;
use super::{CompiledMaterial, Material, MaterialError, MaterialId, MaterialRef, MaterialResolver, ShadingView};
use juggler_math::{Vec2, Vec3};
use juggler_shape::surface::Tangents;
use juggler_texture::{Input, Slot, TextureLookup, TextureTable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Bump map over another material: shading normals follow a texture of heights. The geometry and
/// its silhouette stay unchanged.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct BumpMap {
    /// Height above the surface, in units of `distance`; of a texture, the luminance. Set an
    /// image's `color_space` to `linear`. A constant has no effect.
    pub height: Input<f32>,
    /// Displacement at a height of 1, in scene units, -1e6 to 1e6. Negative values turn bumps into
    /// dents.
    #[schemars(range(min = -1e6, max = 1e6), extend("x-unit" = "scene units"))]
    pub distance: f32,
    /// Material that the bumped normals shade.
    pub material: MaterialRef,
}

impl BumpMap {
    /// Creates a material whose shading normals follow a height, in scene units.
    pub fn new(height: impl Into<Input<f32>>, material: impl Into<MaterialRef>) -> Self {
        Self { height: height.into(), material: material.into(), ..Self::default() }
    }
}

/// Smallest step of the finite differences, in surface coordinates.
const STEP: f32 = 1.0 / 2048.0;

impl Default for BumpMap {
    fn default() -> Self {
        Self { height: 0.0.into(), distance: 1.0, material: MaterialRef::default() }
    }
}

/// A [`BumpMap`] with its names resolved.
#[derive(Clone, Debug)]
pub struct CompiledBumpMap {
    height: Slot<f32>,
    distance: f32,
    /// Material that the bumped normals shade.
    pub material: MaterialId,
}

impl Material for BumpMap {
    fn compile(&self, resolver: &mut dyn MaterialResolver) -> Result<CompiledMaterial, MaterialError> {
        super::input::check_number("height", &self.height, -1e6, 1e6)?;
        in_range("distance", self.distance, -1e6, 1e6)?;
        let height = resolver.textures().resolve("height", &self.height)?;
        let material = resolver.material("material", &self.material)?;
        Ok(CompiledMaterial::BumpMap(CompiledBumpMap { height, distance: self.distance, material }))
    }

    fn nested_materials(&self) -> Vec<(&'static str, &MaterialRef)> {
        vec![("material", &self.material)]
    }

    fn scale_distances(&mut self, factor: f32) {
        self.material.scale_distances(factor);
    }
}

impl CompiledBumpMap {
    /// Bumped shading normal, a unit vector in world space on the side of `view.normal`. Returns
    /// `view.normal` for a constant height and where the surface has no tangents.
    pub fn shading_normal(&self, textures: &TextureTable, view: &ShadingView) -> Vec3 {
        let Some(tangents) = view.tangents.filter(|_| self.height.is_texture()) else { return view.normal };
        let at = view.lookup();
        let step = STEP.max(at.uv_footprint);
        let height = |offset: Vec2| {
            let mesh = at.mesh.map(|point| point.moved(offset));
            let at = TextureLookup { mesh: mesh.as_ref(), ..offset_lookup(&at, tangents, offset) };
            textures.number(&self.height, &at)
        };
        let derivative = |offset: Vec2| (height(offset * (0.5 * step)) - height(offset * (-0.5 * step))) / step;
        let (along_u, along_v) = (derivative(Vec2::X), derivative(Vec2::Y));
        let (normal, across_v) = (view.normal, tangents.v.cross(view.normal));
        let slope = (across_v * along_u + normal.cross(tangents.u) * along_v) / tangents.u.dot(across_v);
        (normal - slope * self.distance).try_normalize().unwrap_or(normal)
    }
}

/// Lookup that is moved by `offset` in surface coordinates, to first order.
fn offset_lookup<'m>(at: &TextureLookup<'m>, tangents: &Tangents, offset: Vec2) -> TextureLookup<'m> {
    TextureLookup {
        uv: at.uv + offset,
        world: at.world + tangents.u * offset.x + tangents.v * offset.y,
        local: at.local + tangents.local_u * offset.x + tangents.local_v * offset.y,
        ..*at
    }
}

#[cfg(any(test, feature = "testing"))]
impl BumpMap {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        let tiles = Self { height: Input::Texture("waves".into()), distance: 0.2, ..Self::default() };
        let glass = Self { material: super::Dielectric::default().into(), distance: -3.0, ..tiles.clone() };
        vec![Self::default(), tiles, glass]
    }
}
