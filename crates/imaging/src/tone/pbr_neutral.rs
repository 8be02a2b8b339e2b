//! Khronos PBR Neutral (Khronos PBR Neutral Tone Mapper, specification 1.0, 2024): reproduces base
//! colors; only highlights above 0.8 are compressed and desaturated.
//! In JSON: `{"pbr_neutral": {}}`.

use super::ToneMapper;
use juggler_math::Rgb;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Start of compression: 0.8 minus the 4 % Fresnel reflectance of a dielectric.
const START: f32 = 0.8 - 0.04;
/// Rate of desaturation of highlights.
const DESATURATION: f32 = 0.15;

/// Khronos PBR Neutral: reproduces base colors faithfully, for product renderings and comparisons.
/// Only values above 0.8 are compressed and desaturate towards white.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct PbrNeutral {}

impl ToneMapper for PbrNeutral {
    fn map(&self, light: Rgb) -> Rgb {
        // The specification does not define negative values.
        let light = light.map(|v| v.max(0.0));
        let least = light.r.min(light.g).min(light.b);
        let offset = if least < 0.08 { least - 6.25 * least * least } else { 0.04 };
        let color = light - Rgb::splat(offset);
        let peak = color.max_channel();
        if peak < START {
            return color;
        }
        let room = 1.0 - START;
        let compressed = 1.0 - room * room / (peak + room - START);
        let gray = 1.0 - 1.0 / (DESATURATION * (peak - compressed) + 1.0);
        (color * (compressed / peak)).lerp(Rgb::splat(compressed), gray)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::testing::Random;

    /// Pseudocode of the specification in double precision.
    fn reference(light: [f64; 3]) -> [f64; 3] {
        let (f90, kd, ks) = (0.04, 0.15, 0.8 - 0.04);
        let x = light[0].min(light[1]).min(light[2]);
        let f = if x <= 2.0 * f90 { x - x * x / (4.0 * f90) } else { f90 };
        let c = light.map(|v| v - f);
        let p = c[0].max(c[1]).max(c[2]);
        if p <= ks {
            return c;
        }
        let n = 1.0 - (1.0 - ks) * (1.0 - ks) / (p + 1.0 - 2.0 * ks);
        let g = 1.0 / (kd * (p - n) + 1.0);
        c.map(|v| v * n / p * g + n * (1.0 - g))
    }

    #[test]
    fn pbr_neutral_matches_the_specification() {
        let mut random = Random::new(9);
        for _ in 0..5_000 {
            let light = random.rgb() * juggler_math::portable::exp2(random.range(-6.0, 7.0));
            let (found, expected) = (PbrNeutral {}.map(light), reference(light.to_array().map(f64::from)));
            for (a, b) in found.to_array().into_iter().zip(expected) {
                assert!((f64::from(a) - b).abs() < 2e-6, "{light:?}: {found:?} is not {expected:?}");
            }
        }
    }

    #[test]
    fn pbr_neutral_preserves_base_colors_with_4_percent_specular() {
        // A dielectric of base color c under white light shows c plus 4 % specular reflection.
        for base in [Rgb::new(0.1, 0.5, 0.75), Rgb::new(0.7, 0.06, 0.05)] {
            let mapped = PbrNeutral {}.map(base + Rgb::splat(0.04));
            assert!((mapped.r - base.r).abs() < 1e-6 && (mapped.b - base.b).abs() < 1e-6, "{mapped:?}");
        }
        assert!(PbrNeutral {}.map(Rgb::new(-1.0, 1e30, 2.0)).is_finite());
    }
}
