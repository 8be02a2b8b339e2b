//! Fine relief as a picture of heights (Blinn, Simulation of Wrinkled Surfaces, 1978).
//!
//! ```json
//! {"bump_map": {"height": "leather", "distance": 0.02, "material": "skin"}}
//! ```
//!
//! The normal n becomes n - ∇h, with ∇h the slope of the height along the surface (Mikkelsen, Bump Mapping
//! Unparametrized Surfaces on the GPU, 2010), by differences of the height a little to each side.

use super::error::in_range;
use super::{Compiled, Material, MaterialError, MaterialId, MaterialRef, Resolver, View};
use juggler_math::{Vec2, Vec3};
use juggler_shape::surface::Tangents;
use juggler_texture::{Input, Lookup, Slot, TextureTable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Another material whose shading normals are those of a surface raised by a texture. Its outline stays as it is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct BumpMap {
    /// The height, outwards; a picture's `color_space` should be `linear`.
    pub height: Input<f32>,
    /// How high a height of 1 is, scene units; below 0 heights are depths.
    pub distance: f32,
    /// The material.
    pub material: MaterialRef,
}

/// Least distance of surface coordinates between the heights that are compared.
const STEP: f32 = 1.0 / 2048.0;

impl Default for BumpMap {
    fn default() -> Self {
        Self { height: 0.0.into(), distance: 1.0, material: MaterialRef::default() }
    }
}

/// A [`BumpMap`] with its names looked up.
#[derive(Clone, Debug)]
pub struct CompiledBumpMap {
    height: Slot<f32>,
    distance: f32,
    /// The material.
    pub material: MaterialId,
}

impl Material for BumpMap {
    fn compile(&self, resolver: &mut dyn Resolver) -> Result<Compiled, MaterialError> {
        super::input::check_number("height", &self.height, -1e6, 1e6)?;
        in_range("distance", self.distance, -1e6, 1e6)?;
        let height = resolver.textures().resolve("height", &self.height)?;
        let material = resolver.material("material", &self.material)?;
        Ok(Compiled::BumpMap(CompiledBumpMap { height, distance: self.distance, material }))
    }

    fn parts(&self) -> Vec<&MaterialRef> {
        vec![&self.material]
    }
}

impl CompiledBumpMap {
    /// The shading normal as the relief turns it, on the side of the surface's own. As it is where the surface does not say
    /// how it runs.
    pub fn turned(&self, textures: &TextureTable, view: &View) -> Vec3 {
        let Some(tangents) = view.tangents.filter(|_| self.height.is_texture()) else { return view.normal };
        let at = view.lookup();
        let step = STEP.max(at.uv_footprint);
        let height = |way: Vec2| textures.number(&self.height, &moved(&at, tangents, way));
        let rise = |way: Vec2| (height(way * (0.5 * step)) - height(way * (-0.5 * step))) / step;
        let (along_u, along_v) = (rise(Vec2::X), rise(Vec2::Y));
        let (normal, across_v) = (view.normal, tangents.v.cross(view.normal));
        let slope = (across_v * along_u + normal.cross(tangents.u) * along_v) / tangents.u.dot(across_v);
        (normal - slope * self.distance).try_normalize().unwrap_or(normal)
    }
}

/// The point that lies `way` further on in surface coordinates.
fn moved(at: &Lookup, tangents: &Tangents, way: Vec2) -> Lookup {
    Lookup {
        uv: at.uv + way,
        world: at.world + tangents.u * way.x + tangents.v * way.y,
        local: at.local + tangents.local_u * way.x + tangents.local_v * way.y,
        ..*at
    }
}

#[cfg(any(test, feature = "testing"))]
impl BumpMap {
    /// For the contract tests.
    pub fn examples() -> Vec<Self> {
        let tiles = Self { height: Input::Texture("waves".into()), distance: 0.2, ..Self::default() };
        let glass = Self { material: super::Dielectric::default().into(), distance: -3.0, ..tiles.clone() };
        vec![Self::default(), tiles, glass]
    }
}
