//! Tone mapping from linear RGB to display levels: exposure, white balance, curve, primaries. A
//! curve either acts on each channel (`linear`, `srgb`, `gamma`), with clipping to 0 to 1, or maps
//! whole colors (`reinhard`, `aces`, `agx`, `pbr_neutral`), followed by gamut mapping at constant
//! luminance and the sRGB transfer function.
//! In JSON: `{"curve": {"srgb": {}}, "exposure_stops": 0}`.

mod aces;
mod agx;
mod color_pipeline;
mod dither;
mod gamma;
mod gamut;
pub(crate) mod high_dynamic_range;
mod linear;
mod matrix;
mod pbr_neutral;
mod primaries;
mod quantizer;
mod reinhard;
mod srgb;
mod white_balance;

pub use aces::Aces;
pub use agx::{Agx, AgxLook};
pub use gamma::Gamma;
pub use linear::Linear;
pub use matrix::Matrix;
pub use pbr_neutral::PbrNeutral;
pub use primaries::{Chromaticities, Primaries};
pub use quantizer::Quantizer;
pub use reinhard::Reinhard;
pub use srgb::Srgb;
pub use white_balance::WhiteBalance;

pub(crate) use dither::LevelEncoder;

use color_pipeline::ColorPipeline;
use juggler_math::{Rgb, portable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Monotonic curve from linear to display values, the same for each channel.
pub trait Curve: Send + Sync {
    /// Display value, 0 to 1, of a linear value; negative values and NaN count as 0.
    fn encode(&self, linear: f64) -> f64;
    /// Linear value of a display value, 0 to 1.
    fn decode(&self, encoded: f64) -> f64;
}

/// Tone mapper of whole colors.
pub trait ToneMapper: Send + Sync {
    /// Maps exposed scene-linear RGB (finite, possibly negative) to display-linear RGB, both with
    /// sRGB primaries. The result is within 0 to 1 except for colors outside the display's gamut.
    fn map(&self, light: Rgb) -> Rgb;
}

/// Kind of a tone curve.
pub enum CurveKind<'a> {
    /// Curve of each channel.
    PerChannel(&'a dyn Curve),
    /// Tone mapper of whole colors, followed by the sRGB curve.
    WholeColor(&'a dyn ToneMapper),
}

/// Tone curve. In JSON: `{"srgb": {}}`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum AnyCurve {
    #[allow(missing_docs, reason = "the kind's own documentation says it")]
    Srgb(Srgb),
    #[allow(missing_docs, reason = "the kind's own documentation says it")]
    Gamma(Gamma),
    #[allow(missing_docs, reason = "the kind's own documentation says it")]
    Linear(Linear),
    #[allow(missing_docs, reason = "the kind's own documentation says it")]
    Reinhard(Reinhard),
    #[allow(missing_docs, reason = "the kind's own documentation says it")]
    Aces(Aces),
    #[allow(missing_docs, reason = "the kind's own documentation says it")]
    Agx(Agx),
    #[allow(missing_docs, reason = "the kind's own documentation says it")]
    PbrNeutral(PbrNeutral),
}

juggler_math::closed_set! { pub enum ToneCurveKind of AnyCurve { Srgb, Gamma, Linear, Reinhard, Aces, Agx, PbrNeutral } }

impl AnyCurve {
    /// The curve or tone mapper of this kind.
    pub fn kind(&self) -> CurveKind<'_> {
        match self {
            Self::Srgb(curve) => CurveKind::PerChannel(curve),
            Self::Gamma(curve) => CurveKind::PerChannel(curve),
            Self::Linear(curve) => CurveKind::PerChannel(curve),
            Self::Reinhard(mapper) => CurveKind::WholeColor(mapper),
            Self::Aces(mapper) => CurveKind::WholeColor(mapper),
            Self::Agx(mapper) => CurveKind::WholeColor(mapper),
            Self::PbrNeutral(mapper) => CurveKind::WholeColor(mapper),
        }
    }

    /// Final per-channel curve: the curve itself, or sRGB after a tone mapper.
    pub fn channel_curve(&self) -> &dyn Curve {
        match self.kind() {
            CurveKind::PerChannel(curve) => curve,
            CurveKind::WholeColor(_) => &Srgb {},
        }
    }
}

impl Default for AnyCurve {
    fn default() -> Self {
        Self::Srgb(Srgb::default())
    }
}

/// Tone mapping from linear RGB to the levels of an image file. EXR, HDR and PFM files store linear
/// values and ignore these settings, except for the primaries of EXR.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Tone {
    /// Tone curve. The default `srgb` clips values above 1; `reinhard`, `aces`, `agx` and
    /// `pbr_neutral` compress highlights instead.
    pub curve: AnyCurve,
    /// Exposure in photographic stops, -64 to 64, applied before the curve: 1 doubles the radiance,
    /// -1 halves it.
    #[schemars(range(min = -64, max = 64), extend("x-unit" = "stops"))]
    pub exposure_stops: f32,
    /// Light that appears white. By default colors are unchanged, so that D65 (6,504 K) appears
    /// white.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub white_balance: Option<WhiteBalance>,
    /// Primaries of the file. PNG supports `display_p3` and `rec2020`, EXR these and `acescg`; the
    /// other formats support sRGB only.
    #[serde(skip_serializing_if = "Primaries::is_srgb")]
    #[schemars(extend("default" = "srgb"))]
    pub primaries: Primaries,
    /// Dithers 8-bit images, so that gradients show no banding; exact levels are preserved. Movies,
    /// images with a display look and interactive previews are never dithered.
    #[serde(skip_serializing_if = "is_true")]
    #[schemars(extend("default" = true))]
    pub dither: bool,
    /// Color behind a transparent picture (`render.transparent`) as displays show it: the curve leaves it
    /// as it is, so that white stays white. By default the file has alpha; EXR files always have it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub backdrop: Option<Rgb>,
}

impl Default for Tone {
    fn default() -> Self {
        Self::new(AnyCurve::Srgb(Srgb {}))
    }
}

fn is_true(value: &bool) -> bool {
    *value
}

impl Tone {
    /// The given curve with default settings.
    pub const fn new(curve: AnyCurve) -> Self {
        let (primaries, dither) = (Primaries::Srgb, true);
        Self { curve, exposure_stops: 0.0, white_balance: None, primaries, dither, backdrop: None }
    }

    /// Exposure as a factor.
    pub fn gain(&self) -> f32 {
        portable::exp2(self.exposure_stops)
    }

    /// Reference formula: levels from 0 to `top`, rounded to nearest. [`Quantizer`] computes the
    /// same faster.
    pub fn levels(&self, pixel: Rgb, top: u16) -> [u16; 3] {
        let light = ColorPipeline::new(self).map_or_else(|| pixel * self.gain(), |pipeline| pipeline.apply(pixel));
        light.to_array().map(|v| level(self.curve.channel_curve(), v, top))
    }
}

fn level(curve: &dyn Curve, linear: f32, top: u16) -> u16 {
    // The cast takes NaN and negative values to 0.
    ((curve.encode(f64::from(linear)) * f64::from(top) + 0.5) as u16).min(top)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn constructors_equal_json() {
        let curves: [(AnyCurve, &str); 3] = [
            (AnyCurve::Gamma(Gamma::new(1.5)), r#"{"gamma": {"gamma": 1.5}}"#),
            (AnyCurve::Reinhard(Reinhard::new(2.0)), r#"{"reinhard": {"white": 2}}"#),
            (AnyCurve::Agx(Agx::new(AgxLook::Punchy)), r#"{"agx": {"look": "punchy"}}"#),
        ];
        for (built, json) in curves {
            assert_eq!(built, serde_json::from_str(json).unwrap());
        }
        assert_eq!(WhiteBalance::new(4000.0), serde_json::from_str(r#"{"kelvin": 4000}"#).unwrap());
    }

    #[test]
    fn json_is_externally_tagged_and_has_defaults() {
        let read = |text: &str| serde_json::from_str::<Tone>(text).unwrap();
        assert_eq!(read("{}"), Tone::default());
        assert_eq!(read(r#"{"curve": {"srgb": {}}, "exposure_stops": 0}"#), Tone::default());
        let gamma = read(r#"{"curve": {"gamma": {"gamma": 1.8}}, "exposure_stops": -1.5}"#);
        assert_eq!(gamma, Tone { exposure_stops: -1.5, ..Tone::new(AnyCurve::Gamma(Gamma { gamma: 1.8 })) });
        assert_eq!(read(r#"{"curve": {"gamma": {}}}"#).curve, AnyCurve::Gamma(Gamma { gamma: 2.2 }));
        assert_eq!(read(&serde_json::to_string(&gamma).unwrap()), gamma);
        let rich = r#"{"curve": {"agx": {"look": "punchy"}}, "white_balance": {"kelvin": 3200}, "primaries": "display_p3",
            "dither": false}"#;
        let rich = read(rich);
        assert_eq!(
            (&rich.curve, rich.primaries),
            (&AnyCurve::Agx(Agx { look: AgxLook::Punchy }), Primaries::DisplayP3)
        );
        assert!(!rich.dither && rich.white_balance == Some(WhiteBalance { kelvin: 3200.0, tint: 0.0 }));
        assert_eq!(read(&serde_json::to_string(&rich).unwrap()), rich);
        // Defaults are not serialized, so that files match those of earlier versions.
        assert_eq!(serde_json::to_string(&Tone::default()).unwrap(), r#"{"curve":{"srgb":{}},"exposure_stops":0.0}"#);
        let schema = serde_json::to_string(&schemars::schema_for!(Tone)).unwrap();
        assert!(schema.contains("\"exclusiveMinimum\":0") && schema.contains("\"srgb\""), "{schema}");
    }

    #[test]
    fn known_radiances_have_known_levels() {
        let level = |curve, linear| Tone::new(curve).levels(Rgb::splat(linear), 255)[1];
        // 18 % gray is level 118 in sRGB; linear 0.5 is level 188.
        assert_eq!((level(AnyCurve::default(), 0.18), level(AnyCurve::default(), 0.5)), (118, 188));
        assert_eq!(level(AnyCurve::Gamma(Gamma { gamma: 2.2 }), 0.5), 186);
        assert_eq!(level(AnyCurve::Linear(Linear {}), 0.5), 128);
        for curve in [AnyCurve::default(), AnyCurve::Gamma(Gamma { gamma: 2.2 }), AnyCurve::Linear(Linear {})] {
            for (linear, expected) in [
                (f32::NAN, 0),
                (f32::NEG_INFINITY, 0),
                (-1.0, 0),
                (-0.0, 0),
                (1.0, 255),
                (1e30, 255),
                (f32::INFINITY, 255),
            ] {
                assert_eq!(level(curve.clone(), linear), expected, "{curve:?} {linear}");
            }
        }
    }

    #[test]
    fn a_stop_doubles_the_light() {
        let bright = Tone { exposure_stops: 1.0, ..Tone::default() };
        let plain = Tone::default();
        for i in 0..1000 {
            let x = i as f32 * 1e-3;
            let (x, twice) = (Rgb::splat(x), Rgb::splat(x * 2.0));
            assert_eq!(bright.levels(x, 65_535), plain.levels(twice, 65_535));
        }
    }

    #[test]
    fn decoding_inverts_encoding() {
        for curve in [AnyCurve::default(), AnyCurve::Gamma(Gamma { gamma: 1.8 }), AnyCurve::Linear(Linear {})] {
            for i in 0..=1000 {
                let encoded = f64::from(i) / 1000.0;
                let back = curve.channel_curve().encode(curve.channel_curve().decode(encoded));
                assert!((back - encoded).abs() < 1e-7, "{curve:?} {encoded} {back}");
            }
        }
    }

    fn every_curve() -> Vec<AnyCurve> {
        vec![
            AnyCurve::default(),
            AnyCurve::Gamma(Gamma::default()),
            AnyCurve::Linear(Linear {}),
            AnyCurve::Reinhard(Reinhard::default()),
            AnyCurve::Aces(Aces {}),
            AnyCurve::Agx(Agx::default()),
            AnyCurve::Agx(Agx { look: AgxLook::Golden }),
            AnyCurve::PbrNeutral(PbrNeutral {}),
        ]
    }

    #[test]
    fn every_curve_takes_every_number() {
        let odd = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0, 0.0, 1e-40, 0.3, 1e38];
        for curve in every_curve() {
            let tone = Tone { white_balance: Some(WhiteBalance { kelvin: 3000.0, tint: 5.0 }), ..Tone::new(curve) };
            for pixel in odd.iter().flat_map(|r| odd.iter().map(move |g| Rgb::new(*r, *g, 0.5))) {
                let level = |primaries| Tone { primaries, ..tone.clone() }.levels(pixel, 255);
                let all = Primaries::ALL.map(level);
                assert!(all.iter().flatten().all(|level| *level <= 255), "{tone:?} {pixel:?}");
            }
        }
        for curve in every_curve() {
            let tone = Tone::new(curve);
            assert!(tone.levels(Rgb::BLACK, 255).iter().all(|level| *level <= 1), "{tone:?}: black is black");
            let is_golden = tone.curve == AnyCurve::Agx(Agx { look: AgxLook::Golden });
            let white = tone.levels(Rgb::splat(1e6), 255);
            assert!(white.iter().all(|level| *level >= 254) != is_golden, "{tone:?}: light is white {white:?}");
            assert_eq!(tone.levels(Rgb::splat(f32::INFINITY), 255), tone.levels(Rgb::splat(1e30), 255));
        }
    }

    #[test]
    fn white_balance_makes_gray_under_its_light_neutral() {
        let light = WhiteBalance { kelvin: 2856.0, tint: 0.0 };
        let bulb = light.matrix().inverse().color(Rgb::splat(0.4));
        let levels_with = |white_balance| Tone { white_balance, ..Tone::default() }.levels(bulb, 65_535);
        let [r, g, b] = levels_with(Some(light));
        assert!(r.abs_diff(g) <= 1 && g.abs_diff(b) <= 1, "{r} {g} {b}");
        let [r, g, b] = levels_with(None);
        assert!(r > g + 5000 && g > b + 5000, "{r} {g} {b}");
    }

    #[test]
    fn wide_primaries_encode_the_same_colors() {
        for curve in
            every_curve().into_iter().filter(|curve| !matches!(curve, AnyCurve::Gamma(_) | AnyCurve::Linear(_)))
        {
            let tone = Tone { primaries: Primaries::Rec2020, ..Tone::new(curve) };
            let pixel = Rgb::new(0.2, 0.05, 0.1);
            let decode = |level: u16| tone.channel(f64::from(level) / 65_535.0);
            let back = Primaries::Rec2020.matrix_from_srgb().unwrap().inverse();
            let wide = back.apply(tone.levels(pixel, 65_535).map(decode));
            let plain = Tone { primaries: Primaries::Srgb, ..tone.clone() }.levels(pixel, 65_535).map(decode);
            assert!(wide.iter().zip(plain).all(|(a, b)| (a - b).abs() < 1e-4), "{tone:?} {wide:?} {plain:?}");
        }
    }

    impl Tone {
        fn channel(&self, encoded: f64) -> f64 {
            self.curve.channel_curve().decode(encoded)
        }
    }
}
