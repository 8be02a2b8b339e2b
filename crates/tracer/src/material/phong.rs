//! The classic material.

use super::{Compiled, Material, MaterialError, Resolver};
use crate::bsdf::{Cone, Highlight, Phong as PhongLobe};
use crate::surface::Surface;
use crate::texture::{Input, Lookup, Slot, TextureTable};
use juggler_math::Rgb;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The classic material.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Phong {
    /// Colour of diffuse light.
    pub diffuse: Input<Rgb>,
}

impl Default for Phong {
    fn default() -> Self {
        Self { diffuse: Input::Value(Rgb::splat(0.8)) }
    }
}

/// A [`Phong`] with its names looked up.
#[derive(Clone, Debug)]
pub struct CompiledPhong {
    diffuse: Slot<Rgb>,
}

impl Material for Phong {
    fn compile(&self, resolver: &mut dyn Resolver) -> Result<Compiled, MaterialError> {
        let textures = resolver.textures();
        Ok(Compiled::Phong(CompiledPhong { diffuse: textures.resolve("diffuse", &self.diffuse)? }))
    }
}

impl CompiledPhong {
    /// The numbers at a point.
    pub fn eval(&self, surface: &Surface, textures: &TextureTable) -> PhongLobe {
        let at = Lookup { uv: surface.uv, local: surface.local, world: surface.point };
        let sharp = Cone { half_angle_radians: 0.0, rays: 1 };
        PhongLobe {
            emission: Rgb::BLACK,
            ambient: Rgb::splat(0.1),
            occlusion: 0.0,
            diffuse: textures.color(&self.diffuse, &at),
            specular: Rgb::BLACK,
            shininess: 1.0,
            highlight: Highlight::Phong,
            both_sides: false,
            mirror: Rgb::BLACK,
            glossy: sharp,
            transparency: Rgb::BLACK,
            blurry: sharp,
            ior: 1.0,
            fresnel: false,
        }
    }
}

#[cfg(test)]
impl Phong {
    /// For the contract tests.
    pub fn examples() -> Vec<Self> {
        vec![Self::default()]
    }
}
