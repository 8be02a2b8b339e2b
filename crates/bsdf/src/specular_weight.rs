//! Factors on the Fresnel reflectance of glass, by the extension KHR_materials_specular of glTF.
//!
//! With the weight w and the color c, an interface of Fresnel reflectance F reflects w c F and
//! transmits 1 - w F max(c), as the extension demands: light of the channels in which c is smaller
//! than in another is absorbed, so that transmitted light takes no complementary color. The exact F
//! stands for Schlick's approximation of the extension, and c applies at every angle, not at normal
//! incidence only. Total reflection leaves no light to transmit: there, w and c have no effect.

use juggler_math::Rgb;

/// Factors on a Fresnel reflectance below total reflection.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpecularWeight {
    /// w c, 0 to 1 per channel.
    factors: Rgb,
}

impl Default for SpecularWeight {
    /// Factors that change nothing.
    fn default() -> Self {
        Self { factors: Rgb::WHITE }
    }
}

impl SpecularWeight {
    /// Factors of a `weight`, 0 to 1, and a `color`, of which values beyond 1 count as 1.
    pub fn new(weight: f32, color: Rgb) -> Self {
        Self { factors: color.map(|channel| channel.min(1.0)) * weight }
    }

    /// w max(c): factor on the reflectance, 0 to 1. Light that is not reflected is transmitted.
    #[inline]
    pub fn weight(&self) -> f32 {
        self.factors.max_channel()
    }

    /// c / max(c): factor on reflected light, 0 to 1 per channel.
    #[inline]
    pub fn color(&self) -> Rgb {
        let weight = self.weight();
        if weight > 0.0 { self.factors / weight } else { Rgb::WHITE }
    }

    /// Reflected light of an interface of this `reflectance`, which contains the weight; 1 is total
    /// reflection.
    #[inline]
    pub(super) fn tint(&self, reflectance: Rgb) -> Rgb {
        let is_neutral = self.factors == Rgb::WHITE || reflectance == Rgb::WHITE;
        if is_neutral { reflectance } else { reflectance * self.color() }
    }
}
