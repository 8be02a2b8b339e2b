//! Materials: descriptions with textures, which are compiled once into a table without names.

use juggler_shape::MeshPoint;
use juggler_shape::surface::Surface;
use juggler_texture::{TextureLookup, TextureTable};
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
mod one_sided;
mod phong;
mod plastic;
mod principled;
mod properties;
mod roughness;
mod shading;
mod table;
mod tangent;
mod translucent;
mod unlit;
mod velvet;

#[cfg(test)]
mod contract;

pub use checkerboard::Plane as CheckerboardPlane;
pub use compiled::{CompiledMaterial, ScatteringMaterial};
pub use compiler::{MAX_NESTING, MaterialCompiler};
pub use conductor::MetalName;
pub use emissive::{Sides, SurfaceEmission};
pub use error::MaterialError;
pub use one_sided::SurfaceSides;
pub use phong::{DiffuseNormalization, Spread};
pub use shading::{Shading, ShadingView};
pub use table::MaterialTable;

/// Index of a material in the [`MaterialTable`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct MaterialId(pub u32);

impl MaterialId {
    /// No material, which shades black.
    pub const NONE: Self = Self(u32::MAX);
}

/// Inline material, or the name of one of the scene's materials.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum MaterialRef {
    /// Name of a material of the scene.
    Name(String),
    /// The material itself.
    Inline(Box<AnyMaterial>),
}

impl MaterialRef {
    /// [`Material::scale_distances`] of a material in place; a named one keeps its distances.
    fn scale_distances(&mut self, factor: f32) {
        if let Self::Inline(material) = self {
            material.scale_distances(factor);
        }
    }
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

/// Name of a material of the scene.
impl From<&str> for MaterialRef {
    fn from(name: &str) -> Self {
        Self::Name(name.to_owned())
    }
}

/// Name of a material of the scene.
impl From<String> for MaterialRef {
    fn from(name: String) -> Self {
        Self::Name(name)
    }
}

/// Implemented by hand, so that an error inside a material names its field (an untagged enum would
/// not).
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

/// Setting of a material that has no effect because another setting replaces it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct IneffectiveSetting {
    /// Name of the field without effect.
    pub field: &'static str,
    /// Name of the field that replaces it.
    pub replaced_by: &'static str,
}

/// Resolves the names in a material's description while it is compiled.
pub trait MaterialResolver {
    /// The scene's textures.
    fn textures(&self) -> &TextureTable;
    /// Compiles (once) the material that `field` refers to.
    fn material(&mut self, field: &'static str, material: &MaterialRef) -> Result<MaterialId, MaterialError>;
    /// Adds a material that is part of the one being compiled and has no description of its own.
    fn add_nested(&mut self, compiled: CompiledMaterial) -> MaterialId;
}

/// Description of a material.
pub trait Material: Send + Sync {
    /// Checks the description and resolves its names.
    fn compile(&self, resolver: &mut dyn MaterialResolver) -> Result<CompiledMaterial, MaterialError>;

    /// Materials nested in this one, each with the name of its field.
    fn nested_materials(&self) -> Vec<(&'static str, &MaterialRef)> {
        Vec::new()
    }

    /// Settings that have no effect because other settings replace them, nested materials not
    /// counted. They are no errors.
    fn ineffective_settings(&self) -> Vec<IneffectiveSetting> {
        Vec::new()
    }

    /// Multiplies the distances over which the media of the material, and of nested materials that
    /// are written in place, absorb and scatter by a positive factor.
    fn scale_distances(&mut self, _factor: f32) {}

    /// Whether the material emits light in path tracers by design, nested materials not counted.
    /// The emission of a classic material does not count.
    fn is_area_light(&self) -> bool {
        false
    }

    /// Whether the material emits light, nested materials not counted.
    fn has_emission(&self) -> bool {
        self.is_area_light()
    }

    /// Whether the material belongs to the classic model, which the integrator `classic` shades as
    /// a whole.
    fn is_classic(&self) -> bool {
        false
    }

    /// Number of rays that the classic integrator traces from a point for glossy reflection and
    /// blurry refraction.
    fn glossy_rays(&self) -> u64 {
        0
    }
}

juggler_math::closed_set! {
    /// Material of any kind. In JSON: `{"phong": {"diffuse": [0.8, 0.1, 0.1]}}`.
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
        unlit::Unlit,
        checkerboard::Checkerboard,
        mask::Mask,
        mix::Mix,
        normal_map::NormalMap,
        bump_map::BumpMap,
        boundary::Boundary,
    }
}

/// Point of a surface where textures are evaluated.
#[derive(Clone, Copy, Debug)]
pub struct TexturedPoint<'a> {
    /// Surface in world space, with the normals of its shape.
    pub surface: &'a Surface,
    /// Point of a mesh that has attributes or a second set of surface coordinates.
    pub mesh: Option<&'a MeshPoint<'a>>,
}

impl<'a> From<&'a Surface> for TexturedPoint<'a> {
    #[inline]
    fn from(surface: &'a Surface) -> Self {
        Self { surface, mesh: None }
    }
}

/// Texture lookup at a point of a surface.
fn lookup(TexturedPoint { surface, mesh }: TexturedPoint<'_>) -> TextureLookup<'_> {
    TextureLookup {
        uv: surface.uv,
        local: surface.local,
        world: surface.point,
        normal: surface.shading_normal,
        local_normal: surface.local_normal,
        footprint: surface.footprint.world,
        local_footprint: surface.footprint.local,
        uv_footprint: surface.footprint.uv,
        unfiltered: false,
        mesh,
    }
}
