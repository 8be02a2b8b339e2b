//! Normal map: shading normals from a texture.
//!
//! ```json
//! {"normal_map": {"texture": "brick normals", "strength": 1, "material": "brick"}}
//! ```
//!
//! Red, green and blue from 0 to 1 encode x, y and z from -1 to 1 in tangent space: x along u, y
//! along v, z outwards. The image's `color_space` must be `linear`.

use super::input::check_number;
use super::tangent::axes;
use super::{CompiledMaterial, Material, MaterialError, MaterialId, MaterialRef, MaterialResolver, ShadingView};
use juggler_math::{Rgb, Vec3};
use juggler_texture::{Input, Slot, TextureTable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Normal map over another material: shading normals come from a texture, in tangent space.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct NormalMap {
    /// Normals, encoded from 0 to 1 per channel; (0.5, 0.5, 1) leaves the normal unchanged. Set an
    /// image's `color_space` to `linear`.
    pub texture: Input<Rgb>,
    /// Factor on the tangential components of the normals, 0 to 1000. 0 disables the map.
    pub strength: Input<f32>,
    /// Material that the mapped normals shade.
    pub material: MaterialRef,
}

impl NormalMap {
    /// Creates a material whose shading normals a texture tilts.
    pub fn new(texture: impl Into<Input<Rgb>>, material: impl Into<MaterialRef>) -> Self {
        Self { texture: texture.into(), material: material.into(), ..Self::default() }
    }
}

/// Encoding of the unchanged normal.
pub const UNCHANGED_NORMAL: Rgb = Rgb::new(0.5, 0.5, 1.0);

/// Largest `strength`.
pub const MAX_STRENGTH: f32 = 1000.0;

impl Default for NormalMap {
    fn default() -> Self {
        Self { texture: UNCHANGED_NORMAL.into(), strength: 1.0.into(), material: MaterialRef::default() }
    }
}

/// A [`NormalMap`] with its names resolved.
#[derive(Clone, Debug)]
pub struct CompiledNormalMap {
    texture: Slot<Rgb>,
    strength: Slot<f32>,
    /// Material that the mapped normals shade.
    pub material: MaterialId,
}

impl Material for NormalMap {
    fn compile(&self, resolver: &mut dyn MaterialResolver) -> Result<CompiledMaterial, MaterialError> {
        super::input::check_unit_color("texture", &self.texture)?;
        check_number("strength", &self.strength, 0.0, MAX_STRENGTH)?;
        let texture = resolver.textures().resolve("texture", &self.texture)?;
        let strength = resolver.textures().resolve("strength", &self.strength)?;
        let material = resolver.material("material", &self.material)?;
        Ok(CompiledMaterial::NormalMap(CompiledNormalMap { texture, strength, material }))
    }

    fn nested_materials(&self) -> Vec<(&'static str, &MaterialRef)> {
        vec![("material", &self.material)]
    }

    fn scale_distances(&mut self, factor: f32) {
        self.material.scale_distances(factor);
    }
}

impl CompiledNormalMap {
    /// Mapped shading normal, a unit vector in world space on the side of `view.normal`.
    pub fn shading_normal(&self, textures: &TextureTable, view: &ShadingView) -> Vec3 {
        let at = view.lookup();
        let strength = match &self.strength {
            Slot::Value(strength) => *strength,
            slot => textures.number(slot, &at).clamp(0.0, MAX_STRENGTH),
        };
        mapped_normal(super::input::unit_color(textures, &self.texture, &at), strength, view.normal, view)
    }
}

/// Normal that a color of a normal map encodes, a unit vector in world space on the side of
/// `normal`, the unit normal without the map. `strength` scales its tangential components.
pub fn mapped_normal(color: Rgb, strength: f32, normal: Vec3, view: &ShadingView) -> Vec3 {
    let [x, y, z] = color.to_array().map(|channel| channel * 2.0 - 1.0);
    let (x, y) = (x * strength, y * strength);
    if x == 0.0 && y == 0.0 {
        return normal;
    }
    let (u, v) = axes(normal, view.tangents);
    (u * x + v * y + normal * z.max(0.0)).normalize_or(normal)
}

#[cfg(any(test, feature = "testing"))]
impl NormalMap {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        let tiles = Self { texture: Input::Texture("tiles".into()), strength: 0.7.into(), ..Self::default() };
        let leaning = Self {
            texture: Rgb::new(0.9, 0.3, 0.6).into(),
            material: super::Dielectric::default().into(),
            ..Self::default()
        };
        vec![Self::default(), tiles, leaning]
    }
}
