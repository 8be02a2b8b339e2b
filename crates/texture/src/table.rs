//! All textures of a scene, by name and by id.

use super::compiler::{self, NoImages};
use super::{AnyTexture, CompiledProduct, Input, InputProduct, InputValue, SharedTexture, TextureError, TextureLookup};
use juggler_math::Rgb;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Index of a texture in the [`TextureTable`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TextureId(pub(super) u32);

/// An [`Input`] whose name has been resolved, so that it cannot dangle.
#[derive(Clone, Debug, PartialEq)]
pub enum Slot<T> {
    /// Constant value.
    Value(T),
    /// Texture that each lookup evaluates.
    Texture(TextureId),
    /// Product that each lookup evaluates. Clones share it.
    Product(Arc<CompiledProduct<T>>),
}

impl<T> Slot<T> {
    /// Whether a texture or an attribute of the mesh gives the value.
    pub fn is_texture(&self) -> bool {
        !matches!(self, Self::Value(_))
    }
}

impl<T: InputValue> Slot<T> {
    /// Product with its parts resolved. The factor 0 makes it a constant.
    pub(super) fn product(product: &InputProduct<T>, texture: Option<TextureId>) -> Self {
        if product.factor == Some(T::ZERO) {
            return Self::Value(T::ZERO);
        }
        Self::Product(Arc::new(CompiledProduct::new(product, texture)))
    }
}

/// Error in an input of a material.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum InputError {
    /// The scene has no texture of this name.
    #[error(transparent)]
    Unknown(#[from] UnknownTexture),
    /// A product lacks a part.
    #[error("{message}")]
    Incomplete {
        /// Field of the product.
        field: &'static str,
        /// Message about the missing part.
        message: String,
    },
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
    /// Whether each texture, or one inside it, varies over the surface coordinates.
    pub(super) over_uv: Vec<bool>,
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

    /// Resolves the name in a material's `field`. Unknown names and incomplete products are errors.
    pub fn resolve<T: InputValue>(&self, field: &'static str, input: &Input<T>) -> Result<Slot<T>, InputError> {
        let id = |name: &str| {
            let unknown = || UnknownTexture { field, name: name.to_owned() };
            self.names.get(name).copied().ok_or_else(unknown)
        };
        match input {
            Input::Value(value) => Ok(Slot::Value(*value)),
            Input::Texture(name) => Ok(Slot::Texture(id(name)?)),
            Input::Product(product) => match product.error(field) {
                Some(message) => Err(InputError::Incomplete { field, message }),
                None => Ok(Slot::product(product, product.texture_name().map(id).transpose()?)),
            },
        }
    }

    /// Whether the texture of this name, or one inside it, varies over the surface coordinates
    /// (u, v).
    pub fn is_over_uv(&self, name: &str) -> bool {
        self.names.get(name).and_then(|id| self.over_uv.get(id.0 as usize)).is_some_and(|over_uv| *over_uv)
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
            Slot::Texture(id) => self.texture_color(*id, at),
            Slot::Product(product) => product.color(self, at),
        }
    }

    /// Color of a texture at a point.
    #[inline]
    pub(super) fn texture_color(&self, id: TextureId, at: &TextureLookup) -> Rgb {
        self.textures.get(id.0 as usize).map_or(Rgb::BLACK, |texture| texture.eval(self, at))
    }

    /// Number of a slot at a point; of a texture, the luminance.
    pub fn number(&self, slot: &Slot<f32>, at: &TextureLookup) -> f32 {
        match slot {
            Slot::Value(value) => *value,
            Slot::Texture(id) => self.texture_color(*id, at).luminance(),
            Slot::Product(product) => product.number(self, at),
        }
    }
}
