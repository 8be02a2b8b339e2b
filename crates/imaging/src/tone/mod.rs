//! Tone: from linear light to the levels of an sRGB display. Exposure first, then a curve per channel. Another
//! curve than sRGB is a look, as the Amiga's pictures had one: files do not undo it by a tag of their own.
//! In JSON: `{"curve": {"srgb": {}}, "exposure_stops": 0}`.

mod gamma;
mod linear;
mod quantizer;
mod srgb;

pub use gamma::Gamma;
pub use linear::Linear;
pub use quantizer::Quantizer;
pub use srgb::Srgb;

use juggler_math::fun;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A curve from linear light to display values, the same for each channel, that never falls.
pub trait Curve: Send + Sync {
    /// Linear light (any number; what is negative or NaN counts as 0) → display value 0 to 1.
    fn encode(&self, linear: f64) -> f64;
    /// Display value 0 to 1 → linear light.
    fn decode(&self, encoded: f64) -> f64;
}

/// Every curve. In JSON: `{"srgb": {}}`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum AnyCurve {
    #[allow(missing_docs, reason = "the kind's own documentation says it")]
    Srgb(Srgb),
    #[allow(missing_docs, reason = "the kind's own documentation says it")]
    Gamma(Gamma),
    #[allow(missing_docs, reason = "the kind's own documentation says it")]
    Linear(Linear),
}

impl AnyCurve {
    /// The curve behind the name.
    pub fn curve(&self) -> &dyn Curve {
        match self {
            Self::Srgb(curve) => curve,
            Self::Gamma(curve) => curve,
            Self::Linear(curve) => curve,
        }
    }
}

impl Default for AnyCurve {
    fn default() -> Self {
        Self::Srgb(Srgb::default())
    }
}

/// How linear light becomes the levels of a picture file. Formats that keep linear light (EXR, HDR, PFM)
/// ignore it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Tone {
    /// The curve.
    pub curve: AnyCurve,
    /// Photographic stops: each doubles the light before the curve; negative ones halve it.
    #[schemars(range(min = -64, max = 64))]
    pub exposure_stops: f32,
}

impl Tone {
    /// The factor on linear light.
    pub fn gain(&self) -> f32 {
        fun::exp2(self.exposure_stops)
    }

    /// The formula: the level, 0 to `top`, nearest to the curve's value. [`Quantizer`] gives the same, faster.
    pub fn level(&self, linear: f32, top: u16) -> u16 {
        level(self.curve.curve(), linear * self.gain(), top)
    }
}

fn level(curve: &dyn Curve, linear: f32, top: u16) -> u16 {
    // The cast takes NaN and what is negative to 0.
    ((curve.encode(f64::from(linear)) * f64::from(top) + 0.5) as u16).min(top)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn json_is_externally_tagged_and_has_defaults() {
        let read = |text: &str| serde_json::from_str::<Tone>(text).unwrap();
        assert_eq!(read("{}"), Tone::default());
        assert_eq!(read(r#"{"curve": {"srgb": {}}, "exposure_stops": 0}"#), Tone::default());
        let gamma = read(r#"{"curve": {"gamma": {"gamma": 1.8}}, "exposure_stops": -1.5}"#);
        assert_eq!(gamma, Tone { curve: AnyCurve::Gamma(Gamma { gamma: 1.8 }), exposure_stops: -1.5 });
        assert_eq!(read(r#"{"curve": {"gamma": {}}}"#).curve, AnyCurve::Gamma(Gamma { gamma: 2.2 }));
        assert_eq!(read(&serde_json::to_string(&gamma).unwrap()), gamma);
        let schema = serde_json::to_string(&schemars::schema_for!(Tone)).unwrap();
        assert!(schema.contains("\"exclusiveMinimum\":0") && schema.contains("\"srgb\""), "{schema}");
    }

    #[test]
    fn known_levels() {
        let level = |curve, linear| Tone { curve, exposure_stops: 0.0 }.level(linear, 255);
        // 18 % grey in sRGB is level 118; half light is 188.
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
            assert_eq!(bright.level(x, 65_535), plain.level(x * 2.0, 65_535));
        }
    }

    #[test]
    fn curves_undo_themselves() {
        for curve in [AnyCurve::default(), AnyCurve::Gamma(Gamma { gamma: 1.8 }), AnyCurve::Linear(Linear {})] {
            for i in 0..=1000 {
                let encoded = f64::from(i) / 1000.0;
                let back = curve.curve().encode(curve.curve().decode(encoded));
                assert!((back - encoded).abs() < 1e-7, "{curve:?} {encoded} {back}");
            }
        }
    }
}
