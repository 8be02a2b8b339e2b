//! All textures of a scene, by name and by id.

use super::compiler::{self, NoImages};
use super::{AnyTexture, Input, SharedTexture, TextureError, TextureLookup};
use juggler_math::Rgb;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Index of a texture in the [`TextureTable`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TextureId(pub(super) u32);

/// An [`Input`] whose name has been resolved, so that it cannot dangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Slot<T> {
    /// Constant value.
    Value(T),
    /// Texture that each lookup evaluates.
    Texture(TextureId),
}

impl<T> Slot<T> {
    /// Whether a texture gives the value.
    pub fn is_texture(&self) -> bool {
        matches!(self, Self::Texture(_))
    }
}

/// Error: a material names a texture that the scene lacks.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no texture is called `{name}`")]
pub struct UnknownTexture {
    /// Field that contains the name.
    pub field: &'static str,
    /// The name.
    pub name: String,
}

/// All textures of a scene, by name and by id.
#[derive(Clone, Debug, Default)]
pub struct TextureTable {
    pub(super) names: BTreeMap<String, TextureId>,
    /// Textures by id. A texture refers only to earlier ones.
    pub(super) textures: Vec<SharedTexture>,
}

impl TextureTable {
    /// Compiles textures without images. Invalid textures become black.
    pub fn new(named: impl IntoIterator<Item = (String, AnyTexture)>) -> Self {
        Self::compile(named, &NoImages).0
    }

    /// Compiles named textures, each once. Returns the table, and the errors with the names of
    /// their textures. An invalid texture becomes black, so that textures and materials that name
    /// it stay valid.
    pub fn compile(
        named: impl IntoIterator<Item = (String, AnyTexture)>,
        images: &dyn compiler::Images,
    ) -> (Self, Vec<(String, TextureError)>) {
        compiler::compile(named, images)
    }

    /// Names of all textures in sorted order, for suggestions in messages.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.names.keys().map(String::as_str)
    }

    /// Resolves the name in a material's `field`. An unknown name is an error.
    pub fn resolve<T: Clone>(&self, field: &'static str, input: &Input<T>) -> Result<Slot<T>, UnknownTexture> {
        match input {
            Input::Value(value) => Ok(Slot::Value(value.clone())),
            Input::Texture(name) => match self.names.get(name) {
                Some(id) => Ok(Slot::Texture(*id)),
                None => Err(UnknownTexture { field, name: name.clone() }),
            },
        }
    }

    /// Number of textures.
    pub fn len(&self) -> usize {
        self.textures.len()
    }

    /// Whether there are no textures.
    pub fn is_empty(&self) -> bool {
        self.textures.is_empty()
    }

    /// Size of all images in bytes; images that several textures share count once.
    pub fn image_bytes(&self) -> usize {
        let pictures = self.textures.iter().filter_map(|texture| texture.pixels());
        let pictures: BTreeMap<usize, usize> = pictures.map(|p| (Arc::as_ptr(p).addr(), p.bytes())).collect();
        pictures.values().sum()
    }

    /// Color of a slot at a point.
    pub fn color(&self, slot: &Slot<Rgb>, at: &TextureLookup) -> Rgb {
        match slot {
            Slot::Value(value) => *value,
            Slot::Texture(id) => self.textures.get(id.0 as usize).map_or(Rgb::BLACK, |t| t.eval(self, at)),
        }
    }

    /// Number of a slot at a point; of a texture, the luminance.
    pub fn number(&self, slot: &Slot<f32>, at: &TextureLookup) -> f32 {
        match slot {
            Slot::Value(value) => *value,
            Slot::Texture(id) => self.textures.get(id.0 as usize).map_or(0.0, |t| t.eval(self, at).luminance()),
        }
    }
}
