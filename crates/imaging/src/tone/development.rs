//! What happens to a pixel's light where its channels do not each go their own way: exposure, white balance, a curve that
//! crosses channels, the file's primaries, and back into what the display can show.

use super::matrix::Matrix;
use super::{AnyCurve, Response, Tone, gamut};
use juggler_math::Rgb;

/// Light that nobody photographs: what is beyond, infinities too, counts as this.
const BRIGHTEST: f32 = 1e12;

/// From scene light to the light of a display, both linear.
#[derive(Clone, Debug)]
pub(super) struct Development {
    gain: f32,
    /// White balance.
    balance: Option<Matrix>,
    /// A curve that crosses channels; it works in the primaries of sRGB.
    curve: Option<AnyCurve>,
    /// To the file's primaries.
    primaries: Option<Matrix>,
    /// Their luminances.
    luminances: [f64; 3],
}

impl Development {
    /// `None` where each channel goes its own way.
    pub fn new(tone: &Tone) -> Option<Self> {
        let crosses = matches!(tone.curve.response(), Response::Colors(_));
        let (balance, primaries) = (tone.white_balance.map(|b| b.matrix()), tone.primaries.conversion());
        (crosses || balance.is_some() || primaries.is_some()).then(|| Self {
            gain: tone.gain(),
            balance,
            curve: crosses.then(|| tone.curve.clone()),
            primaries,
            luminances: tone.primaries.chromaticities().to_xyz().0[1],
        })
    }

    /// What a pixel becomes: the display's light where the curve crosses channels, else light before its curve.
    pub fn light(&self, pixel: Rgb) -> Rgb {
        // What is no number becomes 0.
        let known = |v: f32| if v.is_nan() { 0.0 } else { (v * self.gain).clamp(-BRIGHTEST, BRIGHTEST) };
        let mut light = pixel.map(known);
        if let Some(balance) = &self.balance {
            light = balance.color(light);
        }
        let mapper = self.curve.as_ref().map(AnyCurve::response);
        if let Some(Response::Colors(mapper)) = mapper {
            light = mapper.map(light);
        }
        if let Some(primaries) = &self.primaries {
            light = primaries.color(light);
        }
        if self.curve.is_some() {
            let shown = gamut::into_display(light.to_array().map(f64::from), self.luminances);
            light = Rgb::from(shown.map(|v| v as f32));
        }
        light
    }
}
