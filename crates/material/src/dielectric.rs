//! Glass, water, jewels: what light goes through.
//!
//! ```json
//! {"dielectric": {"ior": 1.5, "roughness": 0.1, "medium": {"color": [0.5, 0.9, 0.6], "distance": 2}}}
//! ```

use super::error::in_range;
use super::input::{check_share, share};
use super::roughness::Roughness;
use super::{Compiled, Material, MaterialError, Resolver, ScatteringMaterial, View};
use crate::medium::{Interior, Medium};
use juggler_bsdf::{Bsdf, Dielectric as DielectricLobe, ThinDielectric};
use juggler_math::Rgb;
use juggler_texture::{Input, Lookup, Slot, TextureTable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The surface of glass, water or a jewel, clear or frosted, and what is inside.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Dielectric {
    /// Index of refraction inside: 1.33 for water, 1.5 for glass, 2.42 for diamond.
    #[schemars(range(min = 0.1, max = 10))]
    pub ior: f32,
    /// 0 for clear glass, up to 1 for frosted; the width of GGX is its square.
    pub roughness: Input<f32>,
    /// Stretches highlights: 0 for round ones, up to 1 along the surface's u, down to -1 across.
    pub anisotropy: Input<f32>,
    /// Turns that direction from u towards v, in whole turns.
    pub anisotropy_rotation: Input<f32>,
    /// Filter of what is mirrored: white in nature.
    pub reflection_tint: Input<Rgb>,
    /// Filter of what goes through the surface: white in nature, where colour comes from the `medium`.
    pub transmission_tint: Input<Rgb>,
    /// A thin pane or bubble, whose two sides are one surface: light goes straight through, and there is no inside.
    pub thin: bool,
    /// What fills it.
    pub medium: Medium,
    /// Where solids overlap, the one with the highest priority is there: let a drink reach a little into its glass, and
    /// give the glass the higher number.
    pub priority: i32,
    /// Gives back what light loses between the grooves of a rough surface. Off, as most renderers have it, rough glass is
    /// darker.
    pub energy_compensation: bool,
}

impl Default for Dielectric {
    fn default() -> Self {
        Self {
            ior: 1.5,
            roughness: 0.0.into(),
            anisotropy: 0.0.into(),
            anisotropy_rotation: 0.0.into(),
            reflection_tint: Rgb::WHITE.into(),
            transmission_tint: Rgb::WHITE.into(),
            thin: false,
            medium: Medium::default(),
            priority: 0,
            energy_compensation: true,
        }
    }
}

/// A [`Dielectric`] with its names looked up.
#[derive(Clone, Debug)]
pub struct CompiledDielectric {
    ior: f32,
    /// Of its surface.
    pub roughness: Roughness,
    reflection: Slot<Rgb>,
    transmission: Slot<Rgb>,
    compensated: bool,
    /// What is inside; nothing for a thin one.
    pub interior: Option<Interior>,
}

impl Material for Dielectric {
    fn compile(&self, resolver: &mut dyn Resolver) -> Result<Compiled, MaterialError> {
        in_range("ior", self.ior, 0.1, 10.0)?;
        check_share("reflection_tint", &self.reflection_tint)?;
        check_share("transmission_tint", &self.transmission_tint)?;
        let medium = super::boundary::checked(&self.medium)?;
        let textures = resolver.textures();
        let roughness = [&self.roughness, &self.anisotropy, &self.anisotropy_rotation];
        Ok(Compiled::scattering(CompiledDielectric {
            ior: self.ior,
            roughness: Roughness::new(textures, roughness)?,
            reflection: textures.resolve("reflection_tint", &self.reflection_tint)?,
            transmission: textures.resolve("transmission_tint", &self.transmission_tint)?,
            compensated: self.energy_compensation,
            interior: (!self.thin).then_some(Interior { ior: self.ior, priority: self.priority, medium }),
        }))
    }
}

impl ScatteringMaterial for CompiledDielectric {
    #[inline]
    fn add_lobes(&self, textures: &TextureTable, view: &View, bsdf: &mut Bsdf) {
        let at = if self.is_textured() { view.lookup() } else { Lookup::default() };
        let alpha = self.roughness.alpha(textures, &at);
        let (reflection, transmission) =
            (share(textures, &self.reflection, &at), share(textures, &self.transmission, &at));
        if self.interior.is_none() {
            let thin = if self.compensated { ThinDielectric::compensated } else { ThinDielectric::new };
            bsdf.push(thin(self.ior, alpha).tinted(reflection, transmission));
            return;
        }
        let border = if self.compensated { DielectricLobe::compensated } else { DielectricLobe::new };
        bsdf.push(border(self.ior / view.around_ior, alpha).tinted(reflection, transmission));
    }

    fn is_textured(&self) -> bool {
        let colors = self.reflection.is_texture() || self.transmission.is_texture();
        colors || self.roughness.is_textured()
    }

    fn turns(&self, textures: &TextureTable, view: &View) -> Option<f32> {
        self.roughness.turns(textures, view)
    }

    fn is_stretched(&self) -> bool {
        self.roughness.is_stretched()
    }

    fn is_transmissive(&self) -> bool {
        true
    }

    fn interior(&self) -> Option<Interior> {
        self.interior
    }
}

#[cfg(any(test, feature = "testing"))]
impl Dielectric {
    /// For the contract tests.
    pub fn examples() -> Vec<Self> {
        let medium = Medium { color: Rgb::new(0.3, 0.9, 0.5), ..Medium::default() };
        let frosted = Self { roughness: 0.5.into(), medium, priority: 3, ..Self::default() };
        vec![Self::default(), frosted, Self { thin: true, ior: 1.33, ..Self::default() }]
    }
}
