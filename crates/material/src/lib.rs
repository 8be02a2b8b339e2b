//! Materials: recipes that textures fill in, compiled once into tables without names.

use juggler_shape::surface::Surface;
use juggler_texture::{Lookup, TextureTable};
use schemars::JsonSchema;
use serde::de::value::MapAccessDeserializer;
use serde::{Deserialize, Deserializer, Serialize};

mod average;
mod boundary;
mod bump_map;
mod checkerboard;
mod compiled;
mod compiler;
mod conductor;
mod dielectric;
mod diffuse;
mod emissive;
mod error;
mod input;
mod mask;
pub mod medium;
mod mix;
mod normal_map;
mod phong;
mod plastic;
mod principled;
mod roughness;
mod shade;
mod table;
mod tangent;
mod translucent;
mod velvet;

#[cfg(test)]
mod contract;

pub use compiled::{Compiled, ScatteringMaterial};
pub use compiler::{MAX_NESTING, MaterialCompiler};
pub use emissive::{Glow, Sides};
pub use error::MaterialError;
pub use phong::{DiffuseNormalization, Spread};
pub use shade::{Shade, View};
pub use table::MaterialTable;

/// A material's place in the [`MaterialTable`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct MaterialId(pub u32);

impl MaterialId {
    /// No material at all: black.
    pub const NONE: Self = Self(u32::MAX);
}

/// A material written in place, or the name of one of the scene's.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum MaterialRef {
    /// Name of a material of the scene.
    Name(String),
    /// The material itself.
    Inline(Box<AnyMaterial>),
}

impl Default for MaterialRef {
    fn default() -> Self {
        Phong::default().into()
    }
}

impl<M: Into<AnyMaterial>> From<M> for MaterialRef {
    fn from(material: M) -> Self {
        Self::Inline(Box::new(material.into()))
    }
}

/// By hand, so that an error inside a material names its field (an untagged enum would not).
impl<'de> Deserialize<'de> for MaterialRef {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Visitor;
        impl<'de> serde::de::Visitor<'de> for Visitor {
            type Value = MaterialRef;
            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("the name of a material, or a material")
            }
            fn visit_str<E: serde::de::Error>(self, name: &str) -> Result<MaterialRef, E> {
                Ok(MaterialRef::Name(name.to_owned()))
            }
            fn visit_map<A: serde::de::MapAccess<'de>>(self, map: A) -> Result<MaterialRef, A::Error> {
                AnyMaterial::deserialize(MapAccessDeserializer::new(map)).map(MaterialRef::from)
            }
        }
        deserializer.deserialize_any(Visitor)
    }
}

/// Looks up what a material names while it is compiled.
pub trait Resolver {
    /// The scene's textures.
    fn textures(&self) -> &TextureTable;
    /// Compiles (once) the material that `field` refers to.
    fn material(&mut self, field: &'static str, material: &MaterialRef) -> Result<MaterialId, MaterialError>;
    /// Takes what lies within the one that is being compiled and has no description of its own.
    fn within(&mut self, compiled: Compiled) -> MaterialId;
}

/// A recipe.
pub trait Material: Send + Sync {
    /// Looks up every name, once.
    fn compile(&self, resolver: &mut dyn Resolver) -> Result<Compiled, MaterialError>;

    /// Materials that this one is made of.
    fn parts(&self) -> Vec<&MaterialRef> {
        Vec::new()
    }

    /// Whether surfaces of the material are emitters, its parts not counted.
    fn is_emitter(&self) -> bool {
        false
    }

    /// Whether the material shows light of its own, its parts not counted.
    fn has_emission(&self) -> bool {
        self.is_emitter()
    }

    /// Whether the material is of the classic model, which the integrator `classic` shades as a
    /// whole.
    fn is_classic(&self) -> bool {
        false
    }

    /// Number of rays that the classic integrator traces from a point for glossy reflections.
    fn glossy_rays(&self) -> u64 {
        0
    }
}

juggler_math::closed_set! {
    /// Every material. In JSON: `{"phong": {"diffuse": [0.8, 0.1, 0.1]}}`.
    #[allow(clippy::large_enum_variant, reason = "descriptions are few, and those within others are boxed")]
    pub enum AnyMaterial: Material {
        phong::Phong,
        diffuse::Diffuse,
        conductor::Conductor,
        dielectric::Dielectric,
        plastic::Plastic,
        velvet::Velvet,
        translucent::Translucent,
        principled::Principled,
        emissive::Emissive,
        checkerboard::Checkerboard,
        mask::Mask,
        mix::Mix,
        normal_map::NormalMap,
        bump_map::BumpMap,
        boundary::Boundary,
    }
}

/// Where textures are asked at a point of a surface.
fn lookup(surface: &Surface) -> Lookup {
    Lookup {
        uv: surface.uv,
        local: surface.local,
        world: surface.point,
        normal: surface.shading_normal,
        local_normal: surface.local_normal,
        footprint: surface.footprint.world,
        local_footprint: surface.footprint.local,
        uv_footprint: surface.footprint.uv,
        sharp: false,
    }
}
