//! Textures: a colour for every point of a surface.

use juggler_math::{Rgb, Vec2, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

mod checker;
mod gradient;

#[cfg(test)]
mod contract;

pub use checker::{Axes, is_odd_cell};
pub use gradient::{GradientShape, Stop};

/// Where a texture is asked.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Lookup {
    /// Surface coordinates.
    pub uv: Vec2,
    /// The point in object space.
    pub local: Vec3,
    /// The point in world space.
    pub world: Vec3,
}

/// The coordinates that a texture lives in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Space {
    /// Surface coordinates: the point (u, v, 0).
    #[default]
    Uv,
    /// Object space: the pattern is carved into the object and moves with it.
    Local,
    /// World space: the pattern stands still.
    World,
}

impl Lookup {
    /// The point in that space.
    pub fn point(&self, space: Space) -> Vec3 {
        match space {
            Space::Uv => self.uv.extend(0.0),
            Space::Local => self.local,
            Space::World => self.world,
        }
    }
}

/// Why a texture cannot be: the field at fault and what it should be.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{message}")]
pub struct InvalidTexture {
    /// Path of the field inside the texture, as in the scene file: `size`, `stops[1].position`.
    pub field: String,
    /// What is wrong, and what would be right.
    pub message: String,
}

impl InvalidTexture {
    fn new(field: impl Into<String>, message: impl Into<String>) -> Self {
        Self { field: field.into(), message: message.into() }
    }
}

/// A colour for every point.
pub trait Texture: Send + Sync {
    /// Checks numbers. A texture that fails still has a colour everywhere, but hardly the one that was meant.
    fn check(&self) -> Result<(), InvalidTexture>;
    /// The colour there, linear light; finite wherever the texture passes its check.
    fn eval(&self, at: &Lookup) -> Rgb;
}

closed_set! {
    /// Every texture. In JSON: `{"checker": {"size": 1}}`.
    pub enum AnyTexture: Texture {
        checker::Checker,
        gradient::Gradient,
    }
}

/// A number or colour, or the name of a texture that gives it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "a number, a colour or the name of a texture")]
pub enum Input<T> {
    /// The same everywhere.
    Value(T),
    /// Name of a texture of the scene.
    Texture(String),
}

impl<T> From<T> for Input<T> {
    fn from(value: T) -> Self {
        Self::Value(value)
    }
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
    names: BTreeMap<String, TextureId>,
    textures: Vec<AnyTexture>,
}

impl TextureTable {
    /// Takes the textures with their names.
    pub fn new(named: impl IntoIterator<Item = (String, AnyTexture)>) -> Self {
        let mut table = Self::default();
        for (name, texture) in named {
            table.names.insert(name, TextureId(u32::try_from(table.textures.len()).unwrap_or(u32::MAX)));
            table.textures.push(texture);
        }
        table
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
