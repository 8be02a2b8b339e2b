//! Reinhard's curve on luminance with a white point: L' = L (1 + L / white²) / (1 + L) (Reinhard,
//! Stark, Shirley and Ferwerda, Photographic tone reproduction for digital images, 2002, equation
//! 4). All channels are scaled alike, which preserves hue and saturation; colors outside the
//! display's gamut move towards gray. In JSON: `{"reinhard": {"white": 4}}`.

use super::ToneMapper;
use juggler_math::Rgb;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Reinhard's curve on luminance: keeps shadows nearly linear and compresses highlights up to a
/// white point. Hue and saturation are preserved as far as the display's gamut allows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Reinhard {
    /// Luminance that maps to white, after exposure; above 0. Larger values keep more detail in
    /// highlights, smaller ones more contrast.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub white: f32,
}

impl Reinhard {
    /// Creates a curve that maps the luminance `white` to white.
    pub fn new(white: f32) -> Self {
        Self { white }
    }
}

impl Default for Reinhard {
    fn default() -> Self {
        Self { white: 4.0 }
    }
}

impl ToneMapper for Reinhard {
    fn map(&self, light: Rgb) -> Rgb {
        let luminance = light.luminance();
        if luminance > 0.0 {
            light * ((1.0 + luminance / (self.white * self.white)) / (1.0 + luminance))
        } else {
            Rgb::BLACK
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reinhard_matches_the_papers_formula_on_luminance() {
        let curve = Reinhard { white: 2.5 };
        for i in 0..200 {
            let l = f64::from(i) * 0.02;
            let light = Rgb::new(0.5, 1.25, 2.0) * (l / f64::from(Rgb::new(0.5, 1.25, 2.0).luminance())) as f32;
            let expected = l * (1.0 + l / 6.25) / (1.0 + l);
            let found = curve.map(light);
            assert!((f64::from(found.luminance()) - expected).abs() < 1e-6, "{l}");
            assert!(i == 0 || (found.b / found.r - 4.0).abs() < 1e-5);
        }
        assert!((curve.map(Rgb::splat(2.5)).g - 1.0).abs() < 1e-6, "white is white");
        assert!((curve.map(Rgb::splat(1e-4)).g - 1e-4).abs() < 1e-7, "shadows stay");
    }

    #[test]
    fn reinhard_is_monotonic_up_to_white() {
        let curve = Reinhard::default();
        let levels: Vec<f32> = (0..=400).map(|i| curve.map(Rgb::splat(i as f32 * 0.01)).g).collect();
        assert!(levels.windows(2).all(|pair| pair[0] < pair[1]));
    }
}
