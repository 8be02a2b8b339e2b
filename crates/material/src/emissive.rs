//! A surface that gives off light: a lamp for the path tracer, whatever its shape.
//!
//! ```json
//! {"emissive": {"radiance": [17, 12, 4], "sides": "front"}}
//! ```

use super::input::{check_light, light};
use super::{Compiled, Material, MaterialError, MaterialId, MaterialRef, Resolver, View};
use juggler_math::{MAX_LIGHT, Rgb};
use juggler_texture::{Input, Slot, TextureTable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A surface that gives off light, the same in every direction, and may scatter as another material does.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Emissive {
    /// Radiance given off.
    pub radiance: Input<Rgb>,
    /// Factor on the radiance.
    #[schemars(range(min = 0, max = 1e30))]
    pub scale: f32,
    /// From which sides it shines.
    pub sides: Sides,
    /// What it is made of besides; black when nothing is said.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub material: Option<MaterialRef>,
}

/// From which sides a surface shines.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Sides {
    /// From the side to which its normals point: the outside of a solid, the upper side of a rectangle.
    #[default]
    Front,
    /// From both.
    Both,
}

impl Default for Emissive {
    fn default() -> Self {
        Self { radiance: Rgb::WHITE.into(), scale: 1.0, sides: Sides::Front, material: None }
    }
}

/// An [`Emissive`] with its names looked up.
#[derive(Clone, Debug)]
pub struct CompiledEmissive {
    radiance: Slot<Rgb>,
    scale: f32,
    sides: Sides,
    /// What it is made of besides.
    pub material: MaterialId,
}

impl Material for Emissive {
    fn compile(&self, resolver: &mut dyn Resolver) -> Result<Compiled, MaterialError> {
        check_light("radiance", &self.radiance, "scale", self.scale)?;
        let radiance = resolver.textures().resolve("radiance", &self.radiance)?;
        let material = match &self.material {
            Some(material) => resolver.material("material", material)?,
            None => MaterialId::NONE,
        };
        Ok(Compiled::Emissive(CompiledEmissive::new(radiance, self.scale, self.sides, material)))
    }

    fn parts(&self) -> Vec<&MaterialRef> {
        self.material.iter().collect()
    }

    fn is_emitter(&self) -> bool {
        true
    }
}

impl CompiledEmissive {
    /// Of numbers that have been checked.
    pub fn new(radiance: Slot<Rgb>, scale: f32, sides: Sides, material: MaterialId) -> Self {
        Self { radiance, scale, sides, material }
    }

    /// Radiance towards the viewer.
    pub fn emission(&self, textures: &TextureTable, view: &View) -> Rgb {
        if self.sides == Sides::Front && !view.is_outside() {
            return Rgb::BLACK;
        }
        let radiance = match &self.radiance {
            Slot::Value(radiance) => *radiance,
            slot => light(textures, slot, &view.lookup()),
        };
        (radiance * self.scale).map(|channel| channel.min(MAX_LIGHT))
    }

    /// How it shines as a whole.
    pub fn glow(&self) -> Glow {
        let radiance = match self.radiance {
            Slot::Value(radiance) => Some(radiance * self.scale),
            Slot::Texture(_) => None,
        };
        Glow { radiance, sides: self.sides }
    }

    /// Whether it differs from place to place.
    pub fn is_textured(&self) -> bool {
        self.radiance.is_texture()
    }
}

/// How a surface shines as a whole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Glow {
    /// Radiance, where it is the same everywhere.
    pub radiance: Option<Rgb>,
    /// From which sides.
    pub sides: Sides,
}

impl Glow {
    /// Two that shine in one place or another.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        let sides = if self.sides == other.sides { self.sides } else { Sides::Both };
        Self { radiance: self.radiance.filter(|_| self.radiance == other.radiance), sides }
    }

    /// The same, but here and not there: whoever wants to know asks at each place.
    #[must_use]
    pub fn somewhere(self) -> Self {
        Self { radiance: None, ..self }
    }
}

#[cfg(any(test, feature = "testing"))]
impl Emissive {
    /// For the contract tests.
    pub fn examples() -> Vec<Self> {
        let screen = Self {
            radiance: Input::Texture("tiles".into()),
            scale: 3.0,
            sides: Sides::Both,
            material: Some(super::Phong::default().into()),
        };
        vec![Self::default(), screen]
    }
}
