//! Triplanar projection: a texture is projected along x, y and z and blended by the normal. It
//! needs no surface coordinates and stretches little.
//!
//! ```json
//! {"triplanar": {"texture": "planks", "space": "world", "scale": 0.5, "sharpness": 8}}
//! ```
//!
//! With n the normal, the projection along axis i has the weight |nᵢ|^`sharpness` over the sum of
//! all three (Geiss, Generating Complex Procedural Terrains Using the GPU, GPU Gems 3, 2007,
//! section 1.5, with powers). Seen from outside, v points up (away for y), u to the right.

use super::CompiledTexture;
use super::mapping::CompiledMapping;
use super::{
    Input, InvalidTexture, Mapping, SharedTexture, Slot, Space, Texture, TextureError, TextureLookup, TextureResolver,
    TextureTable, check,
};
use juggler_math::{Rgb, Vec2, Vec3, portable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Triplanar projection of a texture along x, y and z, blended by the normal. Use it for surfaces
/// without suitable surface coordinates.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Triplanar {
    /// Texture that is projected. It receives the coordinates of each projection as (u, v).
    pub texture: Input<Rgb>,
    /// Exponent of the blend weights. Larger values make the transition between projections
    /// sharper.
    #[schemars(range(min = 0.1, max = 1000))]
    pub sharpness: f32,
    /// Placement of the projections. `space` is `local` or `world`; `uv` counts as `local`.
    #[serde(flatten)]
    pub mapping: Mapping,
}

impl Triplanar {
    /// Creates a projection of a texture along the three axes.
    pub fn new(texture: impl Into<Input<Rgb>>) -> Self {
        Self { texture: texture.into(), ..Self::default() }
    }
}

impl Default for Triplanar {
    fn default() -> Self {
        Self { texture: Rgb::splat(0.5).into(), sharpness: 4.0, mapping: Mapping::default() }
    }
}

impl Texture for Triplanar {
    fn check(&self) -> Result<(), InvalidTexture> {
        check::color("texture", &self.texture)?;
        check::in_range("sharpness", self.sharpness, 0.1, 1000.0)?;
        if self.mapping.matrix.is_some() {
            let message = "`triplanar` uses no surface coordinates, which `matrix` maps; use `scale` and the like";
            return Err(InvalidTexture::new("matrix", message));
        }
        self.mapping.check()
    }

    fn compile(&self, resolver: &mut TextureResolver<'_>) -> Result<SharedTexture, TextureError> {
        let space = self.mapping.space.filter(|space| *space != Space::Uv);
        let map = Mapping { space, ..self.mapping }.compile(Space::Local);
        let texture = resolver.projected_slot("texture", &self.texture, 3)?;
        Ok(Arc::new(CompiledTriplanar { texture, sharpness: self.sharpness, map }))
    }
}

/// A [`Triplanar`] with its name resolved.
#[derive(Clone, Debug)]
pub struct CompiledTriplanar {
    texture: Slot<Rgb>,
    sharpness: f32,
    map: CompiledMapping,
}

impl CompiledTriplanar {
    /// Weights of the three projections, with sum 1.
    fn weights(&self, normal: Vec3) -> Vec3 {
        let size = normal.abs();
        // Divide by the largest component, so that its power cannot underflow.
        let size = size / size.max_element();
        if !size.is_finite() {
            return Vec3::Y;
        }
        let weights = Vec3::from(size.to_array().map(|v| portable::powf(v, self.sharpness)));
        weights / weights.element_sum()
    }
}

impl CompiledTexture for CompiledTriplanar {
    fn eval(&self, textures: &TextureTable, at: &TextureLookup) -> Rgb {
        let pattern = self.map.filtered_point(at);
        let normal = self.map.direction(if self.map.space == Space::World { at.normal } else { at.local_normal });
        let (weights, p) = (self.weights(normal), pattern.point);
        let facing = |n: f32| if n < 0.0 { -1.0 } else { 1.0 };
        let sides = [
            (weights.x, Vec2::new(-p.z * facing(normal.x), p.y)),
            (weights.y, Vec2::new(p.x, -p.z * facing(normal.y))),
            (weights.z, Vec2::new(p.x * facing(normal.z), p.y)),
        ];
        let side = |(weight, uv): (f32, Vec2)| {
            let at = TextureLookup { uv, uv_footprint: pattern.width, ..*at };
            textures.color(&self.texture, &at) * weight
        };
        sides.into_iter().filter(|(weight, _)| *weight > 0.0).map(side).fold(Rgb::BLACK, |sum, side| sum + side)
    }
}

#[cfg(any(test, feature = "testing"))]
impl Triplanar {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        vec![Self::default(), Self { mapping: Mapping::in_space(Space::World), sharpness: 1000.0, ..Self::default() }]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::AnyTexture;

    fn read(json: &str, at: &TextureLookup) -> Rgb {
        let uv: AnyTexture = serde_json::from_str(r#"{"uv": {}}"#).unwrap();
        let table = TextureTable::new([("uv".into(), uv), ("t".into(), serde_json::from_str(json).unwrap())]);
        table.color(&table.resolve("t", &Input::Texture("t".into())).unwrap(), at)
    }

    #[test]
    fn triplanar_uses_one_projection_along_an_axis() {
        let world = Vec3::new(0.1, 0.2, 0.3);
        let json = r#"{"triplanar": {"texture": "uv", "space": "world"}}"#;
        for (normal, u, v) in [
            (Vec3::X, 0.7, 0.2),
            (-Vec3::X, 0.3, 0.2),
            (Vec3::Y, 0.1, 0.7),
            (-Vec3::Y, 0.1, 0.3),
            (Vec3::Z, 0.1, 0.2),
            (-Vec3::Z, 0.9, 0.2),
        ] {
            let at = TextureLookup { world, normal, ..TextureLookup::default() };
            let color = read(json, &at);
            assert!((color.r - u).abs() < 1e-6 && (color.g - v).abs() < 1e-6, "{normal}: {color:?}");
        }
    }

    #[test]
    fn weights_add_up_and_follow_their_power() {
        let compiled = |sharpness| {
            let map = Mapping::in_space(Space::World).compile(Space::Local);
            CompiledTriplanar { texture: Slot::Value(Rgb::WHITE), sharpness, map }
        };
        let normal = Vec3::new(2.0, -1.0, 0.0) / 5f32.sqrt();
        assert!((compiled(2.0).weights(normal) - Vec3::new(0.8, 0.2, 0.0)).abs().max_element() < 1e-6);
        assert!((compiled(1.0).weights(Vec3::ONE) - Vec3::splat(1.0 / 3.0)).abs().max_element() < 1e-6);
        assert_eq!(compiled(1000.0).weights(normal), Vec3::X);
        assert_eq!(compiled(4.0).weights(Vec3::ZERO), Vec3::Y);
    }

    #[test]
    fn triplanar_in_object_space_uses_the_object_space_normal() {
        let local = Vec3::new(0.1, 0.2, 0.3);
        let at = TextureLookup { local, normal: Vec3::X, local_normal: Vec3::Z, ..TextureLookup::default() };
        let color = read(r#"{"triplanar": {"texture": "uv", "space": "local", "scale": 2}}"#, &at);
        assert!((color.r - 0.2).abs() < 1e-6 && (color.g - 0.4).abs() < 1e-6, "{color:?}");
    }
}
