//! Participating media inside solids, such as colored glass and fog.

use juggler_math::{Rgb, portable, range};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

mod dispersion;
mod interior;
mod phase;

#[cfg(test)]
mod tests;

pub use dispersion::{MAX_DISPERSION, Wavelength};
pub use interior::{Interior, InteriorId, Interiors, MAX_INTERIORS};
pub use phase::HenyeyGreenstein;

/// Homogeneous participating medium.
///
/// ```
/// use juggler_material::medium::Medium;
/// let fog = r#"{"scattering": 0.3, "absorption": 0.01, "anisotropy": 0.6}"#;
/// let fog: Medium = serde_json::from_str(fog)?;
/// let green: Medium = serde_json::from_str(r#"{"color": [0.4, 0.9, 0.5], "distance": 2}"#)?;
/// assert!(fog.scatters() && !green.scatters());
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Medium {
    /// Absorption coefficient per channel, per scene unit, 0 to 1e12: 1 leaves 1/e of the light
    /// after one unit.
    #[schemars(extend("x-unit" = "1/scene unit"))]
    pub absorption: Rgb,
    /// Scattering coefficient per channel, per scene unit, 0 to 1e12. Black leaves the medium
    /// clear.
    #[schemars(extend("x-unit" = "1/scene unit"))]
    pub scattering: Rgb,
    /// Mean cosine g of the scattering angle in the phase function of Henyey and Greenstein (1941).
    /// 0 scatters isotropically, positive values forward: fog has some 0.8.
    #[schemars(range(min = -0.999, max = 0.999))]
    pub anisotropy: f32,
    /// Color of white light after `distance`, 0 to 1 per channel: a convenient way to state
    /// absorption, which is added to `absorption`.
    pub color: Rgb,
    /// Distance over which white light takes the color `color`, in scene units.
    #[schemars(range(min = 1e-12), extend("x-unit" = "scene units"))]
    pub distance: f32,
}

impl Medium {
    /// Multiplies the distances over which the medium absorbs and scatters by a positive factor.
    pub fn scale_distances(&mut self, factor: f32) {
        self.absorption = self.absorption / factor;
        self.scattering = self.scattering / factor;
        self.distance *= factor;
    }
}

impl Default for Medium {
    fn default() -> Self {
        let (absorption, scattering) = (Rgb::BLACK, Rgb::BLACK);
        Self { absorption, scattering, anisotropy: 0.0, color: Rgb::WHITE, distance: 1.0 }
    }
}

/// Smallest channel of `color`; black would need an infinite coefficient.
const MIN_COLOR: f32 = 1e-6;

/// Largest coefficient of absorption and of scattering, per scene unit.
const MAX_COEFFICIENT: f32 = 1e12;
/// Smallest `distance`, scene units.
const MIN_DISTANCE: f32 = 1e-12;

impl Medium {
    /// Checks all values. An error holds the field at fault and the message about it.
    pub fn check(&self) -> Result<(), (&'static str, String)> {
        let number = |field, value, low, high| {
            let error = range::range_error(field, value, low, high);
            error.map_or(Ok(()), |message| Err((field, message)))
        };
        let channels = |field, color: Rgb, max| {
            color.to_array().into_iter().try_for_each(|channel| number(field, channel, 0.0, max))
        };
        channels("absorption", self.absorption, MAX_COEFFICIENT)?;
        channels("scattering", self.scattering, MAX_COEFFICIENT)?;
        number("anisotropy", self.anisotropy, -0.999, 0.999)?;
        channels("color", self.color, 1.0)?;
        number("distance", self.distance, MIN_DISTANCE, f32::MAX)
    }

    /// The same medium, with `color` and `distance` converted to absorption.
    #[must_use]
    pub fn resolved(&self) -> Self {
        let of_color = |share: f32| -portable::ln(share.max(MIN_COLOR)) / self.distance;
        let color = self.color.map(|share| if share == 1.0 { 0.0 } else { of_color(share) });
        Self { absorption: self.absorption + color, color: Rgb::WHITE, distance: 1.0, ..*self }
    }

    /// Extinction coefficient of a resolved medium; all methods below require a resolved medium,
    /// too.
    #[inline]
    fn extinction(&self) -> Rgb {
        self.absorption + self.scattering
    }

    /// Whether the medium scatters light.
    #[inline]
    pub fn scatters(&self) -> bool {
        !self.scattering.is_black()
    }

    /// Whether the medium neither absorbs nor scatters light.
    #[inline]
    pub fn is_clear(&self) -> bool {
        self.extinction().is_black()
    }

    /// Transmittance over `distance` (Beer-Lambert law).
    pub fn transmittance(&self, distance: f32) -> Rgb {
        self.extinction().map(|coefficient| {
            // Without extinction, 0 times an infinite distance would be NaN.
            if coefficient == 0.0 { 1.0 } else { portable::exp(-coefficient * distance) }
        })
    }

    /// Samples the next scattering event on a path segment of length `distance`. `u_channel`
    /// chooses a color channel in proportion to `throughput`, `u` chooses the distance with the
    /// extinction of that channel, and the weight combines all channels (one-sample balance
    /// heuristic: Wilkie et al., Hero Wavelength Spectral Sampling, 2014).
    pub fn sample(&self, distance: f32, throughput: Rgb, u_channel: f32, u: f32) -> MediumSample {
        if !self.scatters() {
            return MediumSample { scattered_at: None, weight: self.transmittance(distance) };
        }
        let extinction = self.extinction();
        // Choose a color channel.
        let channels = throughput.map(|share| share.max(0.0)).to_array();
        let total = channels[0] + channels[1] + channels[2];
        let probabilities = if total > 0.0 { channels.map(|share| share / total) } else { [1.0 / 3.0; 3] };
        let channel =
            usize::from(u_channel >= probabilities[0]) + usize::from(u_channel >= probabilities[0] + probabilities[1]);
        // Sample the distance to the next event.
        let coefficient = extinction.to_array()[channel];
        let t = if coefficient > 0.0 { -portable::ln(1.0 - u) / coefficient } else { f32::INFINITY };
        let scattered_at = Some(t).filter(|t| *t < distance);
        // Weight by the balance heuristic over all channels.
        let transmittance = self.transmittance(scattered_at.unwrap_or(distance));
        let (value, density) = match scattered_at {
            Some(_) => (transmittance * self.scattering, transmittance * extinction),
            None => (transmittance, transmittance),
        };
        let density: f32 =
            density.to_array().iter().zip(probabilities).map(|(density, probability)| density * probability).sum();
        let weight = if density > 0.0 { value / density } else { Rgb::BLACK };
        MediumSample { scattered_at, weight }
    }
}

/// Event on a path segment through a medium.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MediumSample {
    /// Distance of the scattering event; `None` if the segment passes without one.
    pub scattered_at: Option<f32>,
    /// Factor on the throughput of the path.
    pub weight: Rgb,
}
