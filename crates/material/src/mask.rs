//! Opacity of another material, from a texture: leaves, fences, lace.
//!
//! ```json
//! {"mask": {"opacity": "leaf outline", "material": "leaf"}}
//! ```

use super::error::in_range;
use super::input::{check_number, unit_number};
use super::{CompiledMaterial, Material, MaterialError, MaterialId, MaterialRef, MaterialResolver, ShadingView};
use juggler_texture::{Input, Slot, TextureTable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Opacity of another material: light passes straight through where the opacity is 0, and with
/// probability 1 - opacity elsewhere. Use it to cut leaves out of a rectangle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Mask {
    /// Opacity, 0 (absent) to 1 (present).
    pub opacity: Input<f32>,
    /// Threshold that makes opacity binary: smaller opacities count as 0, all others as 1. Set the
    /// `filter` of an image to `bilinear`, since the means of distant texels would shrink or fill
    /// leaves.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0, max = 1))]
    pub cutoff: Option<f32>,
    /// Material that has this opacity.
    pub material: MaterialRef,
}

impl Mask {
    /// Creates a mask that makes a material as opaque as a number or texture says.
    pub fn new(opacity: impl Into<Input<f32>>, material: impl Into<MaterialRef>) -> Self {
        Self { opacity: opacity.into(), material: material.into(), ..Self::default() }
    }
}

impl Default for Mask {
    fn default() -> Self {
        Self { opacity: 1.0.into(), cutoff: None, material: MaterialRef::default() }
    }
}

/// A [`Mask`] with its names resolved.
#[derive(Clone, Debug)]
pub struct CompiledMask {
    opacity: Slot<f32>,
    cutoff: Option<f32>,
    /// Material that has this opacity.
    pub material: MaterialId,
}

impl Material for Mask {
    fn compile(&self, resolver: &mut dyn MaterialResolver) -> Result<CompiledMaterial, MaterialError> {
        check_number("opacity", &self.opacity, 0.0, 1.0)?;
        in_range("cutoff", self.cutoff.unwrap_or_default(), 0.0, 1.0)?;
        let opacity = resolver.textures().resolve("opacity", &self.opacity)?;
        let material = resolver.material("material", &self.material)?;
        Ok(CompiledMaterial::Mask(CompiledMask::new(opacity, self.cutoff, material)))
    }

    fn nested_materials(&self) -> Vec<(&'static str, &MaterialRef)> {
        vec![("material", &self.material)]
    }

    fn scale_distances(&mut self, factor: f32) {
        self.material.scale_distances(factor);
    }
}

impl CompiledMask {
    /// Opacity of a material, from checked values.
    pub fn new(opacity: Slot<f32>, cutoff: Option<f32>, material: MaterialId) -> Self {
        let cut_off = |opacity: f32| cutoff.map_or(opacity, |cutoff| f32::from(opacity >= cutoff));
        let opacity = match opacity {
            Slot::Value(opacity) => Slot::Value(cut_off(opacity)),
            texture => texture,
        };
        Self { opacity, cutoff, material }
    }

    /// Opacity at a point, 0 to 1.
    pub fn opacity(&self, textures: &TextureTable, view: &ShadingView) -> f32 {
        match &self.opacity {
            Slot::Value(opacity) => *opacity,
            slot => {
                let opacity = unit_number(textures, slot, &view.lookup());
                self.cutoff.map_or(opacity, |cutoff| f32::from(opacity >= cutoff))
            }
        }
    }

    /// Whether the material is fully opaque everywhere.
    pub fn is_opaque(&self) -> bool {
        matches!(self.opacity, Slot::Value(1.0))
    }

    /// Whether opacity varies over the surface.
    pub fn is_textured(&self) -> bool {
        self.opacity.is_texture()
    }
}

#[cfg(any(test, feature = "testing"))]
impl Mask {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        let leaf = Self { opacity: Input::Texture("tiles".into()), ..Self::default() };
        vec![Self::default(), Self { cutoff: Some(0.3), ..leaf.clone() }, leaf]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::{Vec2, Vec3};
    use juggler_shape::surface::Surface;
    use juggler_texture::{AnyTexture, Image, Images, MipMap};
    use std::sync::Arc;

    /// An image of 64 × 64 texels with alpha 1 in a quarter of them, one in each 2 × 2.
    struct Leaves;

    impl Images for Leaves {
        fn image(&self, _: &str, _: &Image) -> Result<Arc<MipMap>, String> {
            let texel = |i: u32| [0, 0, 0, if i.is_multiple_of(2) && (i / 64).is_multiple_of(2) { 255 } else { 0 }];
            let bytes = (0..64 * 64).flat_map(texel).collect();
            MipMap::from_bytes([64, 64], 4, bytes, |level| level).map(Arc::new).ok_or_else(String::new)
        }
    }

    /// Share of the surface that is opaque at this distance, in texels that a footprint covers.
    fn coverage(filter: &str, texels: f32) -> f64 {
        coverage_above(0.5, filter, texels)
    }

    fn coverage_above(cutoff: f32, filter: &str, texels: f32) -> f64 {
        let json = format!(r#"{{"image": {{"file": "leaves", "channel": "a", "filter": "{filter}"}}}}"#);
        let leaves: AnyTexture = serde_json::from_str(&json).unwrap();
        let (textures, errors) = TextureTable::compile([("leaves".to_owned(), leaves)], &Leaves);
        assert!(errors.is_empty(), "{errors:?}");
        let opacity = textures.resolve("opacity", &Input::product("leaves", 1.0)).unwrap();
        let mask = CompiledMask::new(opacity, Some(cutoff), MaterialId::NONE);
        let opaque = (0..40_000).filter(|i| {
            let uv = Vec2::new((i % 200) as f32 + 0.5, (i / 200) as f32 + 0.5) / 200.0;
            let mut surface = Surface::new(Vec3::ZERO, 0.0, Vec3::Z, uv);
            surface.footprint.uv = texels / 64.0;
            mask.opacity(&textures, &ShadingView::along_normal(&surface)) == 1.0
        });
        opaque.count() as f64 / 40_000.0
    }

    /// An opacity equal to the threshold is present (glTF 2.0, section 3.9.4: "greater than or
    /// equal").
    #[test]
    fn opacity_equal_to_the_cutoff_is_opaque() {
        for (opacity, cutoff, is_opaque) in [(0.5, 0.5, true), (0.5, 0.5f32.next_up(), false), (0.0, 0.0, true)] {
            let mask = CompiledMask::new(Slot::Value(opacity), Some(cutoff), MaterialId::NONE);
            assert_eq!(mask.is_opaque(), is_opaque, "{opacity} at {cutoff}");
        }
        // Texels of opacity 1 and 0 at thresholds of 1 and 0.
        let texels = coverage("nearest", 0.0);
        assert_eq!([1.0, 0.0].map(|cutoff| coverage_above(cutoff, "nearest", 0.0)), [texels, 1.0]);
    }

    #[test]
    fn leaves_keep_their_area_at_a_distance_without_mip_levels() {
        let near = coverage("bilinear", 0.0);
        assert!(near > 0.1 && near < 0.4, "{near}");
        for texels in [1.0, 4.0, 50.0] {
            assert_eq!(coverage("bilinear", texels), near, "{texels}");
        }
        assert_eq!(coverage("trilinear", 8.0), 0.0, "the mean is below the threshold");
    }
}
