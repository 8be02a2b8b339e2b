//! All textures of a scene, by name and by number.

use super::compiler::{self, NoImages};
use super::{AnyTexture, Compiled, Input, Lookup, TextureError};
use juggler_math::Rgb;
use std::collections::BTreeMap;
use std::sync::Arc;

/// A texture's place in the [`TextureTable`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TextureId(pub(super) u32);

/// An [`Input`] whose name has been looked up: it cannot dangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Slot<T> {
    /// The same everywhere.
    Value(T),
    /// Asked at each point.
    Texture(TextureId),
}

impl<T> Slot<T> {
    /// Whether it may differ from point to point.
    pub fn is_texture(&self) -> bool {
        matches!(self, Self::Texture(_))
    }
}

/// A material named a texture that the scene has not.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no texture is called `{name}`")]
pub struct UnknownTexture {
    /// The field that names it.
    pub field: &'static str,
    /// The name.
    pub name: String,
}

/// All textures of a scene, by name and by number.
#[derive(Clone, Debug, Default)]
pub struct TextureTable {
    pub(super) names: BTreeMap<String, TextureId>,
    /// A texture refers only to earlier ones.
    pub(super) textures: Vec<Compiled>,
}

impl TextureTable {
    /// Takes textures without mistakes and without images; what is wrong is black.
    pub fn new(named: impl IntoIterator<Item = (String, AnyTexture)>) -> Self {
        Self::compile(named, &NoImages).0
    }

    /// Compiles textures with their names, each once. Beside the table, what is wrong with which: such a texture is black,
    /// so that those who name it need not be wrong too.
    pub fn compile(
        named: impl IntoIterator<Item = (String, AnyTexture)>,
        images: &dyn compiler::Images,
    ) -> (Self, Vec<(String, TextureError)>) {
        compiler::compile(named, images)
    }

    /// The names of all textures, in order: for "did you mean".
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.names.keys().map(String::as_str)
    }

    /// Looks a name up once, when a material is compiled.
    pub fn resolve<T: Clone>(&self, field: &'static str, input: &Input<T>) -> Result<Slot<T>, UnknownTexture> {
        match input {
            Input::Value(value) => Ok(Slot::Value(value.clone())),
            Input::Texture(name) => match self.names.get(name) {
                Some(id) => Ok(Slot::Texture(*id)),
                None => Err(UnknownTexture { field, name: name.clone() }),
            },
        }
    }

    /// How many textures there are.
    pub fn len(&self) -> usize {
        self.textures.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.textures.is_empty()
    }

    /// Bytes of the pictures that textures show, those that several show counted once.
    pub fn image_bytes(&self) -> usize {
        let pictures = self.textures.iter().filter_map(|texture| texture.pixels());
        let pictures: BTreeMap<usize, usize> = pictures.map(|p| (Arc::as_ptr(p).addr(), p.bytes())).collect();
        pictures.values().sum()
    }

    /// The colour of a slot at a point.
    pub fn color(&self, slot: &Slot<Rgb>, at: &Lookup) -> Rgb {
        match slot {
            Slot::Value(value) => *value,
            Slot::Texture(id) => self.textures.get(id.0 as usize).map_or(Rgb::BLACK, |t| t.eval(self, at)),
        }
    }

    /// The number of a slot at a point: a texture's luminance.
    pub fn number(&self, slot: &Slot<f32>, at: &Lookup) -> f32 {
        match slot {
            Slot::Value(value) => *value,
            Slot::Texture(id) => self.textures.get(id.0 as usize).map_or(0.0, |t| t.eval(self, at).luminance()),
        }
    }
}
