//! Falloff of a spot light between its beam and its cut-off angle.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Falloff of a spot light between its beam and its cut-off angle. With θ the angle from the axis,
/// c the cosine of the cut-off angle and b that of the beam, x = (cos θ − c) / (b − c), clamped to
/// 0..1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum SpotFalloff {
    /// Linear in the angle itself, not in its cosine (Mitsuba).
    #[default]
    Linear,
    /// x², with b − c of at least 0.001 (glTF's KHR_lights_punctual).
    SquaredCosine,
    /// Smooth step of x: 3x² − 2x³ (pbrt).
    SmoothCosine,
}

impl SpotFalloff {
    #[allow(clippy::trivially_copy_pass_by_ref, reason = "serde passes a reference")]
    pub(super) fn is_default(&self) -> bool {
        *self == Self::default()
    }

    /// Distance between the cosines of the edge's ends, above 0.
    fn width(self, beam: f32, cutoff: f32) -> f32 {
        let least = if self == Self::SquaredCosine { 0.001 } else { f32::MIN_POSITIVE };
        (beam - cutoff).max(least)
    }

    /// Falloff by the cosine of the angle from the axis and those of the beam and cut-off angles.
    pub(super) fn at_cosine(self, cos: f32, beam: f32, cutoff: f32) -> f32 {
        let x = ((cos - cutoff) / self.width(beam, cutoff)).clamp(0.0, 1.0);
        if self == Self::SquaredCosine { x * x } else { x * x * (3.0 - 2.0 * x) }
    }

    /// Integral of [`SpotFalloff::at_cosine`] over all directions, in steradians.
    pub(super) fn integral_of_cosine(self, beam: f32, cutoff: f32) -> f32 {
        // Separate the edge, which may be cut by the axis, from the constant part.
        let (width, span) = (self.width(beam, cutoff), 1.0 - cutoff);
        let x = (span / width).min(1.0);
        let edge = if self == Self::SquaredCosine { x * x * x / 3.0 } else { x * x * x * (1.0 - 0.5 * x) };
        std::f32::consts::TAU * ((span - width).max(0.0) + width * edge)
    }
}
