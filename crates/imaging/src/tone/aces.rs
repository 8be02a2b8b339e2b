//! Fit by Stephen Hill (Matt Pettineo's BakingLab, ACES.hlsl, 2017) to the reference rendering
//! transform and sRGB output transform of ACES 1.0 (RRT and ODT): a matrix to a space near AP1 that
//! includes the RRT's desaturation, a rational curve per channel, and a matrix back. In JSON:
//! `{"aces": {}}`.
//!
//! Deviation: values outside 0 to 1 are brought into gamut at constant luminance and hue instead of
//! being clipped per channel.

use super::ToneMapper;
use juggler_math::Rgb;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Filmic tone curve of ACES 1.0, as fitted by Stephen Hill. High contrast; bright colors
/// desaturate towards white. The curve keeps the exposure of ACES: middle gray 0.18 becomes 0.106,
/// so raise `exposure_stops` if the image looks too dark.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Aces {}

impl ToneMapper for Aces {
    fn map(&self, light: Rgb) -> Rgb {
        let Rgb { r, g, b } = light;
        let inner = Rgb::new(
            0.59719 * r + 0.35458 * g + 0.04823 * b,
            0.07600 * r + 0.90834 * g + 0.01566 * b,
            0.02840 * r + 0.13383 * g + 0.83777 * b,
        );
        let Rgb { r, g, b } = inner.map(fit);
        Rgb::new(
            1.60475 * r - 0.53108 * g - 0.07367 * b,
            -0.10208 * r + 1.10813 * g - 0.00605 * b,
            -0.00327 * r - 0.07276 * g + 1.07602 * b,
        )
    }
}

/// Rational fit to RRT and ODT combined; large inputs converge to its limit.
fn fit(v: f32) -> f32 {
    let v = v.clamp(0.0, 1e6);
    (v * (v + 0.024_578_6) - 0.000_090_537) / (v * (0.983_729 * v + 0.432_951) + 0.238_081)
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::testing::Random;

    /// Published formula in double precision.
    fn reference(light: [f64; 3]) -> [f64; 3] {
        let times = |m: [[f64; 3]; 3], v: [f64; 3]| m.map(|row| row.iter().zip(v).map(|(a, b)| a * b).sum::<f64>());
        let input = [[0.59719, 0.35458, 0.04823], [0.07600, 0.90834, 0.01566], [0.02840, 0.13383, 0.83777]];
        let output = [[1.60475, -0.53108, -0.07367], [-0.10208, 1.10813, -0.00605], [-0.00327, -0.07276, 1.07602]];
        let curve = |v: f64| (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081);
        times(output, times(input, light).map(curve))
    }

    #[test]
    fn aces_matches_the_published_formula() {
        let mut random = Random::new(8);
        for _ in 0..5_000 {
            let light = random.rgb() * juggler_math::portable::exp2(random.range(-8.0, 6.0));
            let (found, expected) = (Aces {}.map(light), reference(light.to_array().map(f64::from)));
            for (a, b) in found.to_array().into_iter().zip(expected) {
                assert!((f64::from(a) - b).abs() < 2e-6, "{light:?}: {found:?} is not {expected:?}");
            }
        }
    }

    #[test]
    fn gray_stays_gray_and_rises_to_white() {
        let gray = |v: f32| Aces {}.map(Rgb::splat(v));
        for i in 0..100 {
            let Rgb { r, g, b } = gray(i as f32 * 0.1);
            assert!((r - g).abs() < 1e-4 && (g - b).abs() < 1e-4);
            assert!(g < gray((i + 1) as f32 * 0.1).g);
        }
        // Value at middle gray, by hand:
        // (0.18 * 0.2045786 - 0.000090537) / (0.18 * 0.610022 + 0.238081).
        assert!((gray(0.18).g - 0.105_63).abs() < 1e-4, "{:?}", gray(0.18));
        assert!(gray(1e30).is_finite() && (gray(1e30).g - 1.0165).abs() < 1e-3);
    }
}
