//! White balance: Bradford adaptation from the chosen illuminant to sRGB's white point, so that
//! gray objects under this illuminant look gray. In JSON: `{"kelvin": 3200, "tint": 0}`.
//!
//! The illuminant lies on the CIE daylight locus from 5,000 K (CIE 15:2018, equations 4.4 to 4.6),
//! on the Planckian locus up to 4,000 K (Kang et al., Design of advanced color temperature control
//! system for HDTV applications, 2002, a fit in x and y), and is interpolated between the two in
//! between, so that there is no step.

use super::Matrix;
use super::primaries::{Primaries, adaptation};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Temperatures in kelvin below which the illuminant is a black body, and above which it is
/// daylight.
const BLACK_BODY: f64 = 4000.0;
const DAYLIGHT: f64 = 5000.0;

/// Light source that appears white.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct WhiteBalance {
    /// Correlated color temperature of the light in kelvin, 1667 to 25000; 2850 is an incandescent
    /// bulb, the default 6504 is D65. Lower values make the image bluer.
    #[schemars(range(min = 1667, max = 25000), extend("x-unit" = "K"))]
    pub kelvin: f64,
    /// Distance of the light from the Planckian or daylight locus in thousandths of Duv (ANSI
    /// C78.377), -50 to 50. Positive values state that the light is greenish and make the image
    /// more magenta.
    #[schemars(range(min = -50, max = 50), extend("x-unit" = "0.001 Duv"))]
    pub tint: f64,
}

impl Default for WhiteBalance {
    /// Daylight of 6,504 K, sRGB's white point up to rounding.
    fn default() -> Self {
        Self { kelvin: 6504.0, tint: 0.0 }
    }
}

impl WhiteBalance {
    /// Creates the balance for light of a color temperature, without a tint.
    pub fn new(kelvin: f64) -> Self {
        Self { kelvin, ..Self::default() }
    }

    /// Chromaticity of the light, CIE 1931 x, y.
    pub fn chromaticity(&self) -> [f64; 2] {
        let on_line = uv(locus(self.kelvin));
        if self.tint == 0.0 {
            return locus(self.kelvin);
        }
        // Duv is measured perpendicular to the locus, positive towards green.
        let [warmer, cooler] = [0.999, 1.001].map(|factor| uv(locus(self.kelvin * factor)));
        let along = [cooler[0] - warmer[0], cooler[1] - warmer[1]];
        let length = (along[0] * along[0] + along[1] * along[1]).sqrt().max(1e-12);
        let duv = self.tint / 1000.0;
        xy([on_line[0] + along[1] / length * duv, on_line[1] - along[0] / length * duv])
    }

    /// Matrix that applies the white balance to linear sRGB.
    pub(crate) fn matrix(&self) -> Matrix {
        let srgb = Primaries::Srgb.chromaticities();
        srgb.to_xyz().inverse().times(&adaptation(self.chromaticity(), srgb.white)).times(&srgb.to_xyz())
    }
}

/// Chromaticity of the locus at a temperature, CIE 1931 x, y.
fn locus(kelvin: f64) -> [f64; 2] {
    let kelvin = if kelvin.is_nan() { WhiteBalance::default().kelvin } else { kelvin.clamp(1667.0, 25_000.0) };
    if kelvin <= BLACK_BODY {
        return black_body(kelvin);
    }
    if kelvin >= DAYLIGHT {
        return daylight(kelvin);
    }
    let t = (kelvin - BLACK_BODY) / (DAYLIGHT - BLACK_BODY);
    let [a, b] = [uv(black_body(kelvin)), uv(daylight(kelvin))];
    xy([a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t])
}

/// Planckian locus from 1,667 to 25,000 K (Kang et al. 2002, equations 7 and 8).
fn black_body(kelvin: f64) -> [f64; 2] {
    let m = 1000.0 / kelvin;
    let x = if kelvin <= 4000.0 {
        ((-0.2661239 * m - 0.2343589) * m + 0.8776956) * m + 0.179910
    } else {
        ((-3.0258469 * m + 2.1070379) * m + 0.2226347) * m + 0.240390
    };
    let y = if kelvin <= 2222.0 {
        ((-1.1063814 * x - 1.34811020) * x + 2.18555832) * x - 0.20219683
    } else if kelvin <= 4000.0 {
        ((-0.9549476 * x - 1.37418593) * x + 2.09137015) * x - 0.16748867
    } else {
        ((3.0817580 * x - 5.87338670) * x + 3.75112997) * x - 0.37001483
    };
    [x, y]
}

/// Daylight locus from 4,000 to 25,000 K (CIE 15:2018).
fn daylight(kelvin: f64) -> [f64; 2] {
    let m = 1000.0 / kelvin;
    let x = if kelvin <= 7000.0 {
        ((-4.6070 * m + 2.9678) * m + 0.09911) * m + 0.244063
    } else {
        ((-2.0064 * m + 1.9018) * m + 0.24748) * m + 0.237040
    };
    [x, (-3.000 * x + 2.870) * x - 0.275]
}

/// CIE 1960 u, v from CIE 1931 x, y.
fn uv([x, y]: [f64; 2]) -> [f64; 2] {
    let scale = -2.0 * x + 12.0 * y + 3.0;
    [4.0 * x / scale, 6.0 * y / scale]
}

/// CIE 1931 x, y from CIE 1960 u, v.
fn xy([u, v]: [f64; 2]) -> [f64; 2] {
    let scale = 2.0 * u - 8.0 * v + 4.0;
    [3.0 * u / scale, 2.0 * v / scale]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tone::primaries::xyz;

    fn light(kelvin: f64) -> [f64; 2] {
        WhiteBalance { kelvin, tint: 0.0 }.chromaticity()
    }

    #[test]
    fn standard_illuminants_match_cie_chromaticities() {
        // CIE 15:2018, table T.3: D50, D55, D65, D75 at 5003, 5503, 6504 and 7504 K; illuminant A
        // at 2856 K.
        for (kelvin, x, y) in [
            (5003.0, 0.3457, 0.3585),
            (5503.0, 0.3324, 0.3474),
            (6504.0, 0.3127, 0.3290),
            (7504.0, 0.2990, 0.3149),
            (2856.0, 0.4476, 0.4074),
        ] {
            let found = light(kelvin);
            let error = if kelvin < 4000.0 { 7e-4 } else { 1.5e-4 };
            assert!((found[0] - x).abs() < error && (found[1] - y).abs() < error, "{kelvin} K: {found:?}");
        }
    }

    /// Planck's law integrated with Gaussian fits of the color matching functions (Wyman, Sloan and
    /// Shirley 2013).
    fn planck(kelvin: f64) -> [f64; 2] {
        let lobe = |x: f64, scale: f64, at: f64, below: f64, above: f64| {
            let t = (x - at) * if x < at { below } else { above };
            scale * (-0.5 * t * t).exp()
        };
        let mut sum = [0.0; 3];
        for nanometers in 360..=830 {
            let l = f64::from(nanometers);
            let power = l.powi(-5) / ((1.438_776_9e7 / (l * kelvin)).exp() - 1.0);
            let x = lobe(l, 1.056, 599.8, 0.0264, 0.0323) + lobe(l, 0.362, 442.0, 0.0624, 0.0374)
                - lobe(l, 0.065, 501.1, 0.0490, 0.0382);
            let y = lobe(l, 0.821, 568.8, 0.0213, 0.0247) + lobe(l, 0.286, 530.9, 0.0613, 0.0322);
            let z = lobe(l, 1.217, 437.0, 0.0845, 0.0278) + lobe(l, 0.681, 459.0, 0.0385, 0.0725);
            [x, y, z].into_iter().zip(&mut sum).for_each(|(value, sum)| *sum += power * value);
        }
        let all: f64 = sum.iter().sum();
        [sum[0] / all, sum[1] / all]
    }

    #[test]
    fn low_color_temperatures_match_black_bodies() {
        for kelvin in [1700.0, 2000.0, 2400.0, 2856.0, 3200.0, 4000.0] {
            let (found, expected) = (light(kelvin), planck(kelvin));
            let error = (found[0] - expected[0]).abs().max((found[1] - expected[1]).abs());
            // The fits of the matching functions have errors of this order in the red.
            assert!(error < 5e-3, "{kelvin} K: {found:?} is not {expected:?}");
        }
    }

    #[test]
    fn chromaticity_is_continuous_in_temperature() {
        let mut last = light(1667.0);
        for kelvin in (1667..25_000).step_by(5) {
            let next = light(f64::from(kelvin));
            let step = (next[0] - last[0]).abs().max((next[1] - last[1]).abs());
            assert!(step < 2e-3, "{kelvin} K");
            last = next;
        }
    }

    #[test]
    fn gray_under_the_light_becomes_neutral_and_keeps_its_luminance() {
        let srgb = Primaries::Srgb.chromaticities();
        for (kelvin, tint) in [(2856.0, 0.0), (3200.0, 8.0), (4500.0, -12.0), (6504.0, 0.0), (12_000.0, 20.0)] {
            let balance = WhiteBalance { kelvin, tint };
            let gray = srgb.to_xyz().inverse().apply(xyz(balance.chromaticity()).map(|v| v * 0.18));
            let adapted = balance.matrix().apply(gray);
            assert!(adapted.iter().all(|v| (v - 0.18).abs() < 1e-9), "{kelvin} {tint} {adapted:?}");
        }
    }

    #[test]
    fn tint_equals_duv_times_1000() {
        for kelvin in [2500.0, 4500.0, 6504.0, 9000.0] {
            let on_line = uv(light(kelvin));
            for tint in [-20.0, 5.0, 20.0] {
                let off = uv(WhiteBalance { kelvin, tint }.chromaticity());
                let (du, dv) = (off[0] - on_line[0], off[1] - on_line[1]);
                assert!(((du * du + dv * dv).sqrt() * 1000.0 - f64::abs(tint)).abs() < 1e-6);
                // Above the locus is green: larger v.
                assert_eq!(dv > 0.0, tint > 0.0, "{kelvin} {tint}");
            }
        }
    }

    #[test]
    fn white_balance_of_any_temperature_is_finite() {
        for kelvin in [f64::NAN, 0.0, -5.0, f64::INFINITY] {
            assert!(WhiteBalance { kelvin, tint: 0.0 }.matrix().is_finite());
        }
    }
}
