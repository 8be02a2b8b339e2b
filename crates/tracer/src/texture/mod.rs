//! Textures: a colour for every point of a surface.

use juggler_math::{Rgb, Vec2, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

mod checker;

/// Where a texture is asked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lookup {
    /// Surface coordinates.
    pub uv: Vec2,
    /// The point in object space.
    pub local: Vec3,
    /// The point in world space.
    pub world: Vec3,
}

/// A colour for every point.
pub trait Texture: Send + Sync {
    /// The colour there, linear light.
    fn eval(&self, at: &Lookup) -> Rgb;
}

closed_set! {
    /// Every texture. In JSON: `{"checker": {"size": 1}}`.
    pub enum AnyTexture: Texture { checker::Checker }
}

/// A number or colour, or the name of a texture that gives it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Input<T> {
    /// The same everywhere.
    Value(T),
    /// Name of a texture of the scene.
    Texture(String),
}

/// A texture's place in the [`TextureTable`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TextureId(u32);

/// An [`Input`] whose name has been looked up: it cannot dangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Slot<T> {
    /// The same everywhere.
    Value(T),
    /// Asked at each point.
    Texture(TextureId),
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
    names: Vec<String>,
    textures: Vec<AnyTexture>,
}

impl TextureTable {
    /// Takes the textures with their names.
    pub fn new(named: impl IntoIterator<Item = (String, AnyTexture)>) -> Self {
        let (names, textures) = named.into_iter().unzip();
        Self { names, textures }
    }

    /// Looks a name up once, when a material is compiled.
    pub fn resolve<T: Clone>(&self, field: &'static str, input: &Input<T>) -> Result<Slot<T>, UnknownTexture> {
        match input {
            Input::Value(value) => Ok(Slot::Value(value.clone())),
            Input::Texture(name) => match self.names.iter().position(|n| n == name) {
                Some(at) => Ok(Slot::Texture(TextureId(at as u32))),
                None => Err(UnknownTexture { field, name: name.clone() }),
            },
        }
    }

    /// The colour of a slot at a point.
    pub fn color(&self, slot: &Slot<Rgb>, at: &Lookup) -> Rgb {
        match slot {
            Slot::Value(value) => *value,
            Slot::Texture(id) => self.textures.get(id.0 as usize).map_or(Rgb::BLACK, |t| t.eval(at)),
        }
    }

    /// The number of a slot at a point: a texture's luminance.
    pub fn number(&self, slot: &Slot<f32>, at: &Lookup) -> f32 {
        match slot {
            Slot::Value(value) => *value,
            Slot::Texture(id) => self.textures.get(id.0 as usize).map_or(0.0, |t| t.eval(at).luminance()),
        }
    }
}
