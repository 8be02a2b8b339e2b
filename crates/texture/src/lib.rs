//! Textures: a color at every point of a surface.
//!
//! A description may name other textures for its colors and numbers. All textures of a scene are
//! compiled together into a [`TextureTable`], which replaces names by ids.

use juggler_math::{Vec2, Vec3};
use juggler_shape::MeshPoint;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

mod check;
mod compiled;
mod compiler;
mod input;
mod lattice;
mod mapping;
mod octaves;
mod pixels;
mod product;
mod table;

mod attribute;
mod brick;
mod checker;
mod constant;
mod direction;
mod dots;
mod fbm;
mod gradient;
mod image;
mod marble;
mod mix;
mod noise;
mod noise_blend;
mod ramp;
mod triplanar;
mod turbulence;
mod uv;
mod voronoi;
mod wave;
mod wood;

#[cfg(test)]
mod constructors;
#[cfg(test)]
mod contract;

pub use checker::{Axes, is_odd_cell};
pub use compiled::{CompiledTexture, SharedTexture};
pub use compiler::{Images, MAX_LOOKUPS, MAX_NESTING, NoImages, TextureError, TextureResolver};
pub use gradient::{GradientShape, Stop};
pub use image::{Channel, ColorSpace};
pub use input::{Input, InputProduct, InputValue, TextureRef};
pub use mapping::{Mapping, Scale};
pub use mix::MixMode;
pub use noise_blend::NoiseBlend;
pub use octaves::Octaves;
pub use pixels::{Filter, MipMap, Texel, Wrap, half};
pub use product::CompiledProduct;
pub use ramp::Steps;
pub use table::{InputError, Slot, TextureId, TextureTable, UnknownTexture};
pub use voronoi::{Feature, Metric};
pub use wave::{WaveProfile, WaveShape};

/// Point of a surface at which textures are evaluated, with its footprint.
///
/// The footprint is the diameter of the ray's cone at the surface. Textures filter out finer
/// detail; 0 disables the filter.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TextureLookup<'m> {
    /// Surface coordinates (u, v).
    pub uv: Vec2,
    /// Point in object space.
    pub local: Vec3,
    /// Point in world space.
    pub world: Vec3,
    /// Unit shading normal in world space.
    pub normal: Vec3,
    /// Unit shading normal in object space.
    pub local_normal: Vec3,
    /// Footprint in units of world space.
    pub footprint: f32,
    /// Footprint in units of object space.
    pub local_footprint: f32,
    /// Footprint in surface coordinates.
    pub uv_footprint: f32,
    /// Whether procedural textures ignore the footprint, as in classic pictures. Image textures
    /// never do.
    pub unfiltered: bool,
    /// Point of a mesh with attributes or a second set of surface coordinates.
    pub mesh: Option<&'m MeshPoint<'m>>,
}

/// Coordinate space of a texture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Space {
    /// Surface coordinates: the point (u, v, 0).
    #[default]
    Uv,
    /// Object space: the pattern moves with the object, as if the object were carved from it.
    Local,
    /// World space: the pattern stays in place when objects move.
    World,
}

impl TextureLookup<'_> {
    /// Point in a coordinate space.
    pub fn point(&self, space: Space) -> Vec3 {
        match space {
            Space::Uv => self.uv.extend(0.0),
            Space::Local => self.local,
            Space::World => self.world,
        }
    }

    /// Surface coordinates of the second set with the footprint in them; those of the first set
    /// where the surface has no second one.
    #[cold]
    pub fn second_uv(&self) -> (Vec2, f32) {
        let Some((point, uv)) = self.mesh.and_then(|point| Some((point, point.uv1()?))) else {
            return (self.uv, self.uv_footprint);
        };
        (uv, self.uv_footprint * point.uv1_area_ratio().map_or(0.0, f32::sqrt))
    }

    /// Footprint in units of a coordinate space.
    pub fn footprint_in(&self, space: Space) -> f32 {
        match space {
            Space::Uv => self.uv_footprint,
            Space::Local => self.local_footprint,
            Space::World => self.footprint,
        }
    }
}

/// Invalid value in a texture's description, with the field at fault.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{message}")]
pub struct InvalidTexture {
    /// Path of the field inside the texture, as in the scene file: `size`, `stops[1].position`.
    pub field: String,
    /// Message about the error and the valid values.
    pub message: String,
}

impl InvalidTexture {
    fn new(field: impl Into<String>, message: impl Into<String>) -> Self {
        Self { field: field.into(), message: message.into() }
    }
}

/// Description of a texture.
pub trait Texture: Send + Sync {
    /// Checks all values.
    fn check(&self) -> Result<(), InvalidTexture>;
    /// Resolves the names of a description that passes [`Texture::check`].
    fn compile(&self, resolver: &mut TextureResolver<'_>) -> Result<SharedTexture, TextureError>;

    /// Coordinate space of the pattern, nested textures not counted; `None` for textures that have
    /// none.
    fn space(&self) -> Option<Space> {
        None
    }
}

juggler_math::closed_set! {
    /// Texture of any kind. In JSON: `{"checker": {"size": 1}}`.
    pub enum AnyTexture: Texture {
        image::Image,
        attribute::Attribute,
        constant::Constant,
        direction::Direction,
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
