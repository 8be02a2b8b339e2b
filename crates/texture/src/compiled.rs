//! Compiled textures: names are resolved, and derived values are precomputed.

use super::constant::CompiledConstant;
use super::{MipMap, Slot, TextureLookup, TextureTable};
use juggler_math::Rgb;
use std::fmt::Debug;
use std::sync::Arc;

/// A texture with its names resolved.
pub trait CompiledTexture: Debug + Send + Sync {
    /// Color at a point, in linear light; finite. `textures` is the table that holds the texture.
    fn eval(&self, textures: &TextureTable, at: &TextureLookup) -> Rgb;

    /// Pixels of an image texture; `None` for all other textures.
    fn pixels(&self) -> Option<&Arc<MipMap>> {
        None
    }
}

/// Texture that shading evaluates.
pub type SharedTexture = Arc<dyn CompiledTexture>;

/// Black texture, in place of an invalid one.
pub fn black() -> SharedTexture {
    Arc::new(CompiledConstant(Slot::Value(Rgb::BLACK)))
}

/// Two colors to blend. Colors of weight 0 are not evaluated.
#[derive(Clone, Debug)]
pub struct ColorBlend {
    /// Color at weight 0.
    pub low: Slot<Rgb>,
    /// Color at weight 1.
    pub high: Slot<Rgb>,
}

impl ColorBlend {
    /// Blended color; `weight` from 0 to 1 is the weight of `high`.
    pub fn eval(&self, weight: f32, textures: &TextureTable, at: &TextureLookup) -> Rgb {
        if weight <= 0.0 {
            textures.color(&self.low, at)
        } else if weight >= 1.0 {
            textures.color(&self.high, at)
        } else {
            textures.color(&self.low, at).lerp(textures.color(&self.high, at), weight)
        }
    }
}
