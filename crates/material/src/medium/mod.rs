//! What fills a solid: glass that colours light, fog that scatters it.

use juggler_math::{Rgb, fun, range};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

mod interior;
mod phase;

#[cfg(test)]
mod tests;

pub use interior::{Interior, InteriorId, Interiors, MAX_INTERIORS};
pub use phase::HenyeyGreenstein;

/// A homogeneous medium: the same everywhere inside.
///
/// ```
/// use juggler_material::medium::Medium;
/// let fog: Medium = serde_json::from_str(r#"{"scattering": 0.3, "absorption": 0.01, "anisotropy": 0.6}"#)?;
/// let green: Medium = serde_json::from_str(r#"{"color": [0.4, 0.9, 0.5], "distance": 2}"#)?;
/// assert!(fog.scatters() && !green.scatters());
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Medium {
    /// Share of light that is swallowed on each unit of the way, as a coefficient: 1 leaves 1/e after one unit.
    pub absorption: Rgb,
    /// Share of light that is scattered on each unit of the way, as a coefficient.
    pub scattering: Rgb,
    /// Mean cosine of the angle by which light is turned, above -1 and below 1: 0 scatters evenly, fog forward with some 0.8
    /// (Henyey and Greenstein 1941).
    #[schemars(range(min = -0.999, max = 0.999))]
    pub anisotropy: f32,
    /// What white light becomes on a way of `distance`: absorption for those who think in colours, on top of
    /// `absorption`.
    pub color: Rgb,
    /// The way on which white light becomes `color`, scene units.
    #[schemars(range(min = 1e-12))]
    pub distance: f32,
}

impl Default for Medium {
    fn default() -> Self {
        let (absorption, scattering) = (Rgb::BLACK, Rgb::BLACK);
        Self { absorption, scattering, anisotropy: 0.0, color: Rgb::WHITE, distance: 1.0 }
    }
}

/// The least share of light that a `color` leaves: black would need an infinite coefficient.
const LEAST_COLOR: f32 = 1e-6;

/// Largest coefficient of absorption and of scattering, per scene unit.
const MOST_COEFFICIENT: f32 = 1e12;
/// Smallest `distance`, scene units.
const LEAST_DISTANCE: f32 = 1e-12;

impl Medium {
    /// Checks all numbers. The error is the field at fault and the message about it.
    pub fn check(&self) -> Result<(), (&'static str, String)> {
        let number = |field, value, low, high| {
            let wrong = range::outside(field, value, low, high);
            wrong.map_or(Ok(()), |message| Err((field, message)))
        };
        let channels = |field, color: Rgb, most| {
            color.to_array().into_iter().try_for_each(|channel| number(field, channel, 0.0, most))
        };
        channels("absorption", self.absorption, MOST_COEFFICIENT)?;
        channels("scattering", self.scattering, MOST_COEFFICIENT)?;
        number("anisotropy", self.anisotropy, -0.999, 0.999)?;
        channels("color", self.color, 1.0)?;
        number("distance", self.distance, LEAST_DISTANCE, f32::MAX)
    }

    /// With `color` and `distance` taken into the absorption.
    #[must_use]
    pub fn resolved(&self) -> Self {
        let of_color = |share: f32| -fun::ln(share.max(LEAST_COLOR)) / self.distance;
        let color = self.color.map(|share| if share == 1.0 { 0.0 } else { of_color(share) });
        Self { absorption: self.absorption + color, color: Rgb::WHITE, distance: 1.0, ..*self }
    }

    /// Coefficient of all that is lost on the way straight on. Of a resolved medium, as all below.
    #[inline]
    fn extinction(&self) -> Rgb {
        self.absorption + self.scattering
    }

    /// Whether light is scattered in it.
    #[inline]
    pub fn scatters(&self) -> bool {
        !self.scattering.is_black()
    }

    /// Whether it is as good as nothing.
    #[inline]
    pub fn is_clear(&self) -> bool {
        self.extinction().is_black()
    }

    /// Share of light that is left after `distance` straight on (Beer and Lambert).
    pub fn transmittance(&self, distance: f32) -> Rgb {
        self.extinction().map(|coefficient| {
            // Nothing lost is nothing lost, however far.
            if coefficient == 0.0 { 1.0 } else { fun::exp(-coefficient * distance) }
        })
    }

    /// What becomes of light on a way of `distance`. The colour channel that decides where it is scattered is picked with
    /// `pick` in proportion to `throughput`, and all channels are weighted together (one-sample balance heuristic: Wilkie
    /// et al., Hero Wavelength Spectral Sampling, 2014); `u` decides where.
    pub fn sample(&self, distance: f32, throughput: Rgb, pick: f32, u: f32) -> Flight {
        if !self.scatters() {
            return Flight { scattered_at: None, weight: self.transmittance(distance) };
        }
        let extinction = self.extinction();
        let channels = throughput.map(|share| share.max(0.0)).to_array();
        let total = channels[0] + channels[1] + channels[2];
        let chances = if total > 0.0 { channels.map(|share| share / total) } else { [1.0 / 3.0; 3] };
        let channel = usize::from(pick >= chances[0]) + usize::from(pick >= chances[0] + chances[1]);
        let coefficient = extinction.to_array()[channel];
        let way = if coefficient > 0.0 { -fun::ln(1.0 - u) / coefficient } else { f32::INFINITY };
        let scattered_at = Some(way).filter(|way| *way < distance);
        let left = self.transmittance(scattered_at.unwrap_or(distance));
        let (value, density) = match scattered_at {
            Some(_) => (left * self.scattering, left * extinction),
            None => (left, left),
        };
        let density: f32 = density.to_array().iter().zip(chances).map(|(density, chance)| density * chance).sum();
        let weight = if density > 0.0 { value / density } else { Rgb::BLACK };
        Flight { scattered_at, weight }
    }
}

/// What became of light on its way through a medium.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flight {
    /// How far on it was scattered; `None` when it came through.
    pub scattered_at: Option<f32>,
    /// What it then counts.
    pub weight: Rgb,
}
