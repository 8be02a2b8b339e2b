//! AgX (Troy Sobotka, AgX-S2O3, 2022), as adopted by Blender 4, Filament and three.js: in BT.2020
//! primaries, an inset matrix desaturates colors so that bright ones fade gracefully, a sigmoid
//! maps the logarithm of 16.5 stops around middle gray per channel, and an outset matrix restores
//! saturation. In JSON: `{"agx": {"look": "punchy"}}`.
//!
//! - Inset and outset are the matrices of Filament and three.js. The sigmoid is Sobotka's closed
//!   form (slope 2 at the pivot (10 / 16.5, 0.5); powers 3 in shadows and 3.25 in highlights),
//!   which maps 0 to 0 and 1 to 1; most programs use a polynomial fit instead (Benjamin Wrensch,
//!   Minimal AgX implementation, 2023).
//! - The looks are Wrensch's: slope, power and saturation (ASC CDL) after the sigmoid.
//! - Deviation: values outside the display's gamut are brought into it at constant luminance and
//!   hue instead of being clipped per channel.

use super::ToneMapper;
use juggler_math::{Rgb, portable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Log2 of the darkest and brightest radiance: 10 stops below and 6.5 stops above middle gray 0.18.
const DARKEST: f32 = -12.473_931;
const BRIGHTEST: f32 = 4.026_069;
/// Pivot of the sigmoid: position of middle gray, and its output.
const PIVOT: [f32; 2] = [10.0 / 16.5, 0.5];
/// Slope of the sigmoid at the pivot.
const SLOPE: f32 = 2.0;
/// Powers of the sigmoid in shadows and highlights, and the scales for which it maps 0 to 0 and 1
/// to 1.
const POWERS: [f32; 2] = [3.0, 3.25];
const SCALES: [f32; 2] = [0.512_277_4, 0.541_464_2];
/// Display gamma that the curve is designed for.
const DISPLAY: f32 = 2.2;

/// AgX: filmic tone curve over 16.5 stops, from 10 below to 6.5 above middle gray 0.18. Bright
/// saturated colors fade smoothly to white. Suited to scenes of high contrast.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Agx {
    /// Color grade after the curve; `base` applies no grade.
    pub look: AgxLook,
}

impl Agx {
    /// Creates the AgX curve with a look.
    pub fn new(look: AgxLook) -> Self {
        Self { look }
    }
}

/// Color grade of AgX.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum AgxLook {
    /// No grade: low contrast, a basis for color grading.
    #[default]
    Base,
    /// More contrast and saturation.
    Punchy,
    /// Warm tint and brighter mid-tones.
    Golden,
}

impl ToneMapper for Agx {
    fn map(&self, light: Rgb) -> Rgb {
        let desaturated = inset(to_rec2020(light));
        let encoded = desaturated.map(|v| (portable::log2(v.max(1e-10)) - DARKEST) / (BRIGHTEST - DARKEST));
        let contrast = self.look.grade(encoded.map(sigmoid));
        from_rec2020(outset(contrast).map(|v| portable::powf(v.max(0.0), DISPLAY)))
    }
}

impl AgxLook {
    fn grade(self, color: Rgb) -> Rgb {
        let (slope, power, saturation) = match self {
            Self::Base => return color,
            Self::Punchy => (Rgb::WHITE, 1.35, 1.4),
            Self::Golden => (Rgb::new(1.0, 0.9, 0.5), 0.8, 0.8),
        };
        let graded = (color * slope).map(|v| portable::powf(v, power));
        Rgb::splat(graded.luminance()).lerp(graded, saturation)
    }
}

/// Sigmoid over the normalized logarithm, 0 to 1.
fn sigmoid(x: f32) -> f32 {
    let x = x.clamp(0.0, 1.0);
    let [from, to] = PIVOT;
    let (side, sign) = if x < from { (0, -1.0) } else { (1, 1.0) };
    let scale = SCALES[side];
    let term = SLOPE * (x - from) * sign / scale;
    let bent = term / portable::powf(1.0 + portable::powf(term, POWERS[side]), 1.0 / POWERS[side]);
    (to + sign * scale * bent).clamp(0.0, 1.0)
}

fn inset(Rgb { r, g, b }: Rgb) -> Rgb {
    Rgb::new(
        0.856_627_15 * r + 0.095_121_24 * g + 0.048_251_606 * b,
        0.137_318_97 * r + 0.761_242 * g + 0.101_439_04 * b,
        0.111_898_21 * r + 0.076_799_42 * g + 0.811_302_4 * b,
    )
}

fn outset(Rgb { r, g, b }: Rgb) -> Rgb {
    Rgb::new(
        1.127_100_6 * r - 0.110_606_64 * g - 0.016_493_939 * b,
        -0.141_329_76 * r + 1.157_823_7 * g - 0.016_493_939 * b,
        -0.141_329_76 * r - 0.110_606_64 * g + 1.251_936_4 * b,
    )
}

/// Linear sRGB to BT.2020 (ITU-R BT.2087-0, with more digits).
fn to_rec2020(Rgb { r, g, b }: Rgb) -> Rgb {
    Rgb::new(
        0.627_403_9 * r + 0.329_283 * g + 0.043_313_07 * b,
        0.069_097_29 * r + 0.919_540_4 * g + 0.011_362_32 * b,
        0.016_391_44 * r + 0.088_013_31 * g + 0.895_595_25 * b,
    )
}

fn from_rec2020(Rgb { r, g, b }: Rgb) -> Rgb {
    Rgb::new(
        1.660_491 * r - 0.587_641_1 * g - 0.072_849_86 * b,
        -0.124_550_48 * r + 1.132_899_9 * g - 0.008_349_422 * b,
        -0.018_150_763 * r - 0.100_578_9 * g + 1.118_729_7 * b,
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tone::primaries::Primaries;
    use juggler_math::testing::Random;

    /// Published formula in double precision with the given sigmoid.
    fn reference(light: [f64; 3], look: AgxLook, curve: fn(f64) -> f64) -> [f64; 3] {
        let times = |m: [[f64; 3]; 3], v: [f64; 3]| m.map(|row| row.iter().zip(v).map(|(a, b)| a * b).sum::<f64>());
        // Transposes the matrices, which shaders list by columns.
        let columns = |m: [[f64; 3]; 3]| [0, 1, 2].map(|row| [m[0][row], m[1][row], m[2][row]]);
        let there = Primaries::Rec2020.matrix_from_srgb().unwrap();
        let inset = columns([
            [0.856627153315983, 0.137318972929847, 0.11189821299995],
            [0.0951212405381588, 0.761241990602591, 0.0767994186031903],
            [0.0482516061458583, 0.101439036467562, 0.811302368396859],
        ]);
        let outset = columns([
            [1.1271005818144368, -0.1413297634984383, -0.14132976349843826],
            [-0.11060664309660323, 1.157823702216272, -0.11060664309660294],
            [-0.016493938717834573, -0.016493938717834257, 1.2519364065950405],
        ]);
        let (least, most) = ((0.18 * 2f64.powi(-10)).log2(), (0.18 * 2f64.powf(6.5)).log2());
        let encode = |v: f64| ((v.max(1e-10).log2() - least) / (most - least)).clamp(0.0, 1.0);
        let mut v = times(inset, there.apply(light)).map(encode).map(curve);
        let (slope, power, saturation) = match look {
            AgxLook::Base => ([1.0; 3], 1.0, 1.0),
            AgxLook::Punchy => ([1.0; 3], 1.35, 1.4),
            AgxLook::Golden => ([1.0, 0.9, 0.5], 0.8, 0.8),
        };
        v = [0, 1, 2].map(|i| f64::powf((v[i] * slope[i]).max(0.0), power));
        let luma = 0.2126 * v[0] + 0.7152 * v[1] + 0.0722 * v[2];
        v = v.map(|v| luma + saturation * (v - luma));
        there.inverse().apply(times(outset, v).map(|v| v.max(0.0).powf(2.2)))
    }

    /// Sobotka's closed form of the sigmoid.
    fn closed_form(x: f64) -> f64 {
        let (px, py, slope) = (10.0 / 16.5, 0.5, 2.0);
        let (power, sign) = if x < px { (3.0, -1.0) } else { (3.25, 1.0) };
        let (rx, ry) = if x < px { (px, py) } else { (1.0 - px, 1.0 - py) };
        let scale = ((slope * rx).powf(-power) * ((slope * rx / ry).powf(power) - 1.0)).powf(-1.0 / power) * sign;
        let term = slope * (x - px) / scale;
        scale * term / (1.0 + term.powf(power)).powf(1.0 / power) + py
    }

    /// Wrensch's polynomial fit to the sigmoid.
    fn polynomial(x: f64) -> f64 {
        15.5 * x.powi(6) - 40.14 * x.powi(5) + 31.96 * x.powi(4) - 6.868 * x.powi(3) + 0.4298 * x * x + 0.1191 * x
            - 0.00232
    }

    #[test]
    fn agx_sigmoid_matches_its_closed_form_and_the_published_polynomial() {
        let mut squares = 0.0;
        for i in 0..=1000 {
            let x = f64::from(i) / 1000.0;
            assert!((f64::from(sigmoid(x as f32)) - closed_form(x)).abs() < 2e-6, "{x}");
            squares += (closed_form(x) - polynomial(x)).powi(2) / 1001.0;
        }
        assert!(squares < 8e-6, "mean squared error {squares}");
        assert!(sigmoid(0.0) < 1e-6 && sigmoid(1.0) > 1.0 - 1e-6);
    }

    #[test]
    fn agx_matches_the_published_formula() {
        let mut random = Random::new(10);
        for look in [AgxLook::Base, AgxLook::Punchy, AgxLook::Golden] {
            let mut off = 0.0;
            for _ in 0..2_000 {
                let light = random.rgb() * portable::exp2(random.range(-9.0, 7.0));
                let found = Agx { look }.map(light).to_array().map(f64::from);
                let exact = reference(light.to_array().map(f64::from), look, closed_form);
                let usual = reference(light.to_array().map(f64::from), look, polynomial);
                for i in 0..3 {
                    assert!((found[i] - exact[i]).abs() < 1e-5, "{look:?} {light:?}: {found:?} is not {exact:?}");
                    let screen = |v: f64| v.clamp(0.0, 1.0).powf(1.0 / 2.2);
                    off += (screen(found[i]) - screen(usual[i])).abs() / 6_000.0;
                }
            }
            assert!(off < 2.0 / 255.0, "{look:?}: {off} from what programs with the polynomial show");
        }
    }

    #[test]
    fn middle_gray_maps_to_half_and_gray_stays_gray() {
        let Rgb { r, g, b } = Agx::default().map(Rgb::splat(0.18));
        assert!((portable::powf(g, 1.0 / 2.2) - 0.5).abs() < 1e-4 && (r - g).abs() < 1e-4 && (g - b).abs() < 1e-4);
        let grays: Vec<f32> =
            (0..170).map(|i| Agx::default().map(Rgb::splat(portable::exp2(i as f32 * 0.1 - 12.5))).g).collect();
        assert!(grays.windows(2).all(|pair| pair[0] < pair[1] + 1e-7));
        assert!((grays[169] - 1.0).abs() < 1e-3 && Agx::default().map(Rgb::new(1e30, -1.0, 0.0)).is_finite());
    }
}
