//! Phase function of Henyey and Greenstein (Diffuse Radiation in the Galaxy, 1941).

use juggler_math::{Frame, Vec2, Vec3, portable};
use std::f32::consts::PI;

/// Phase function of Henyey and Greenstein. Directions point along the light; `forward` is the
/// direction before scattering.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HenyeyGreenstein {
    /// Mean cosine g of the scattering angle, above -1 and below 1.
    pub anisotropy: f32,
}

impl HenyeyGreenstein {
    /// Value and density per steradian for the cosine `cos` of the angle between `forward` and the
    /// scattered direction.
    #[inline]
    pub fn eval(&self, cos: f32) -> f32 {
        let g = self.anisotropy;
        let squared = 1.0 + g * g - 2.0 * g * cos;
        (1.0 - g * g) / (4.0 * PI * squared * squared.sqrt())
    }

    /// Samples a scattered direction, with [`HenyeyGreenstein::eval`] of its cosine as density (PBR
    /// 4th ed., equation 11.20).
    pub fn sample(&self, forward: Vec3, u: Vec2) -> Vec3 {
        let g = self.anisotropy;
        let cos = if g.abs() < 1e-3 {
            1.0 - 2.0 * u.x
        } else {
            let part = (1.0 - g * g) / (1.0 - g + 2.0 * g * u.x);
            ((1.0 + g * g - part * part) / (2.0 * g)).clamp(-1.0, 1.0)
        };
        let radius = (1.0 - cos * cos).max(0.0).sqrt();
        let (sin_phi, cos_phi) = portable::sin_cos_turns(u.y);
        Frame::around(forward).to_world(Vec3::new(radius * cos_phi, radius * sin_phi, cos)).normalize()
    }
}
