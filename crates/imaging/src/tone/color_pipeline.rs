//! Color pipeline for tone settings that mix channels: exposure, white balance, tone mapper,
//! primaries, gamut mapping.

use super::matrix::Matrix;
use super::{AnyCurve, CurveKind, Tone, gamut};
use juggler_math::Rgb;

/// Upper clamp for radiance, which also replaces infinity.
const MAX_RADIANCE: f32 = 1e12;

/// Transform from scene-linear to display-linear RGB.
#[derive(Clone, Debug)]
pub(super) struct ColorPipeline {
    gain: f32,
    /// White balance.
    balance: Option<Matrix>,
    /// Tone mapper on RGB with sRGB primaries; `None` for per-channel curves.
    curve: Option<AnyCurve>,
    /// Matrix from sRGB to the file's primaries.
    primaries: Option<Matrix>,
    /// Luminances of the file's primaries.
    luminances: [f64; 3],
}

impl ColorPipeline {
    /// The pipeline of `tone`; `None` if channels are independent.
    pub fn new(tone: &Tone) -> Option<Self> {
        let mixes_channels = matches!(tone.curve.kind(), CurveKind::WholeColor(_));
        let (balance, primaries) = (tone.white_balance.map(|b| b.matrix()), tone.primaries.matrix_from_srgb());
        (mixes_channels || balance.is_some() || primaries.is_some()).then(|| Self {
            gain: tone.gain(),
            balance,
            curve: mixes_channels.then(|| tone.curve.clone()),
            primaries,
            luminances: tone.primaries.chromaticities().to_xyz().0[1],
        })
    }

    /// Transforms a pixel; the result is display-linear with a tone mapper, else input of the
    /// channel curve.
    pub fn apply(&self, pixel: Rgb) -> Rgb {
        // Replace NaN by 0.
        let exposed = |v: f32| if v.is_nan() { 0.0 } else { (v * self.gain).clamp(-MAX_RADIANCE, MAX_RADIANCE) };
        let mut light = pixel.map(exposed);
        if let Some(balance) = &self.balance {
            light = balance.color(light);
        }
        let mapper = self.curve.as_ref().map(AnyCurve::kind);
        if let Some(CurveKind::WholeColor(mapper)) = mapper {
            light = mapper.map(light);
        }
        if let Some(primaries) = &self.primaries {
            light = primaries.color(light);
        }
        if self.curve.is_some() {
            let in_gamut = gamut::map_to_gamut(light.to_array().map(f64::from), self.luminances);
            light = Rgb::from(in_gamut.map(|v| v as f32));
        }
        light
    }
}
