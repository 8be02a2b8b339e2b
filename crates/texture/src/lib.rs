//! Textures: a colour for every point of a surface.
//!
//! A description may name other textures for its colours and numbers. All of a scene's are compiled together into a
//! [`TextureTable`], where names have become numbers.

use juggler_math::{Vec2, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

mod check;
mod compiled;
mod compiler;
mod lattice;
mod mapping;
mod octaves;
mod pixels;
mod table;

mod brick;
mod checker;
mod constant;
mod dots;
mod fbm;
mod gradient;
mod heights;
mod image;
mod marble;
mod mix;
mod noise;
mod ramp;
mod triplanar;
mod turbulence;
mod uv;
mod voronoi;
mod wave;
mod wood;

#[cfg(test)]
mod contract;

pub use checker::{Axes, is_odd_cell};
pub use compiled::{Compiled, CompiledTexture};
pub use compiler::{Images, MAX_LOOKUPS, MAX_NESTING, NoImages, Resolver, TextureError};
pub use gradient::{GradientShape, Stop};
pub use image::{Channel, ColorSpace};
pub use mapping::{Mapping, Scale};
pub use mix::MixMode;
pub use octaves::Octaves;
pub use pixels::{Filter, Pyramid, Texel, Wrap};
pub use ramp::Steps;
pub use table::{Slot, TextureId, TextureTable, UnknownTexture};
pub use voronoi::{Feature, Metric};
pub use wave::{WaveProfile, WaveShape};

/// Where a texture is asked.
///
/// A footprint is the diameter of the patch that the answer stands for, what the ray's cone covers: what is finer is
/// smoothed away. 0 asks for the point alone.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Lookup {
    /// Surface coordinates.
    pub uv: Vec2,
    /// The point in object space.
    pub local: Vec3,
    /// The point in world space.
    pub world: Vec3,
    /// Unit normal that shading uses, world space.
    pub normal: Vec3,
    /// Unit normal that shading uses, object space.
    pub local_normal: Vec3,
    /// Footprint in world units.
    pub footprint: f32,
    /// Footprint in units of object space.
    pub local_footprint: f32,
    /// Footprint in units of the surface coordinates.
    pub uv_footprint: f32,
    /// Whether patterns that are computed show the point alone, as in classic pictures; those from files never do.
    pub sharp: bool,
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

    /// The footprint in units of that space.
    pub fn footprint_in(&self, space: Space) -> f32 {
        match space {
            Space::Uv => self.uv_footprint,
            Space::Local => self.local_footprint,
            Space::World => self.footprint,
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
    /// Looks up every name, once. Called only for what passes its check.
    fn compile(&self, resolver: &mut Resolver<'_>) -> Result<Compiled, TextureError>;
}

juggler_math::closed_set! {
    /// Every texture. In JSON: `{"checker": {"size": 1}}`.
    pub enum AnyTexture: Texture {
        image::Image,
        constant::Constant,
        checker::Checker,
        gradient::Gradient,
        ramp::Ramp,
        mix::Mix,
        noise::Noise,
        fbm::Fbm,
        turbulence::Turbulence,
        marble::Marble,
        wood::Wood,
        voronoi::Voronoi,
        brick::Brick,
        dots::Dots,
        wave::Wave,
        triplanar::Triplanar,
        uv::Uv,
    }
}

/// A number or color, or a texture that gives it at every point: written in place, or by its name.
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
