//! Textures as shading asks them: names are numbers, and nothing is left to be worked out twice.

use super::constant::CompiledConstant;
use super::{Lookup, Pyramid, Slot, TextureTable};
use juggler_math::Rgb;
use std::fmt::Debug;
use std::sync::Arc;

/// A texture with its names looked up.
pub trait CompiledTexture: Debug + Send + Sync {
    /// Color at a point, linear light; finite. `textures` is the table that the texture belongs to.
    fn eval(&self, textures: &TextureTable, at: &Lookup) -> Rgb;

    /// Pixels of an image, if the texture is one.
    fn pixels(&self) -> Option<&Arc<Pyramid>> {
        None
    }
}

/// What a description becomes.
pub type Compiled = Arc<dyn CompiledTexture>;

/// Texture that stands for one that is wrong.
pub fn black() -> Compiled {
    Arc::new(CompiledConstant(Slot::Value(Rgb::BLACK)))
}

/// Two colours, looked up only as far as they are needed.
#[derive(Clone, Copy, Debug)]
pub struct Pair {
    /// At 0.
    pub low: Slot<Rgb>,
    /// At 1.
    pub high: Slot<Rgb>,
}

impl Pair {
    /// The colour at a share from 0 to 1.
    pub fn at(&self, share: f32, textures: &TextureTable, at: &Lookup) -> Rgb {
        if share <= 0.0 {
            textures.color(&self.low, at)
        } else if share >= 1.0 {
            textures.color(&self.high, at)
        } else {
            textures.color(&self.low, at).lerp(textures.color(&self.high, at), share)
        }
    }
}
