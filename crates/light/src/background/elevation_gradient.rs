//! Importance sampling of a luminance that depends only on the sine of the elevation. It goes from
//! a base at the horizon to an end at the pole, linearly in the sine or in its square. Both are
//! mixtures of two densities with invertible CDFs, so samples follow the luminance exactly.

use super::BackgroundSample;
use juggler_math::{Frame, Rgb, Vec2, Vec3, portable};
use std::f32::consts::TAU;

/// Hemisphere of a sky on one side of the horizon.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hemisphere {
    /// Color at the horizon.
    pub base: Rgb,
    /// Color at the pole.
    pub end: Rgb,
    /// Whether the interpolation uses the square of the sine.
    pub squared: bool,
}

impl Hemisphere {
    /// Weight of the base in the mean over the hemisphere.
    fn base_weight(&self) -> f32 {
        if self.squared { 2.0 / 3.0 } else { 0.5 }
    }

    /// Mean over the hemisphere by solid angle.
    fn mean(&self) -> Rgb {
        self.end.lerp(self.base, self.base_weight())
    }

    fn luminance(&self, sine: f32) -> f32 {
        let weight = if self.squared { sine * sine } else { sine };
        self.base.lerp(self.end, weight).luminance()
    }

    /// Samples a sine from 0 to 1 in proportion to the luminance.
    fn sample(&self, u: f32) -> f32 {
        let base = self.base.luminance() * self.base_weight();
        let end = self.end.luminance() * (1.0 - self.base_weight());
        let target = u * (base + end);
        if target < base {
            let v = (target / base).min(1.0);
            // Densities 2 (1 - s) and 3/2 (1 - s²).
            return if self.squared {
                2.0 * portable::sin(portable::asin(v) / 3.0)
            } else {
                v / (1.0 + (1.0 - v).sqrt())
            };
        }
        let v = ((target - base) / end).clamp(0.0, 1.0);
        if self.squared { portable::cbrt_f64(f64::from(v)) as f32 } else { v.sqrt() }
    }
}

/// Sky of two hemispheres around an axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct ElevationGradient {
    /// Unit vector to the zenith.
    pub axis: Vec3,
    pub upper: Hemisphere,
    pub lower: Hemisphere,
}

impl ElevationGradient {
    /// Mean over all directions.
    pub fn mean(&self) -> Rgb {
        self.upper.mean().lerp(self.lower.mean(), 0.5)
    }

    /// Samples a direction in proportion to the luminance; `None` if the sky is black.
    pub fn sample(&self, u: Vec2) -> Option<BackgroundSample> {
        let (upper, lower) = (self.upper.mean().luminance(), self.lower.mean().luminance());
        let target = u.x * (upper + lower);
        let sine = if target < upper {
            self.upper.sample(target / upper)
        } else if lower > 0.0 {
            -self.lower.sample(((target - upper) / lower).min(1.0))
        } else {
            return None;
        };
        let (sin, cos) = portable::sin_cos_turns(u.y);
        let ring = (1.0 - sine * sine).max(0.0).sqrt();
        let wi = Frame::around(self.axis).to_world(Vec3::new(ring * cos, ring * sin, sine));
        let pdf = self.density(sine);
        (pdf > 0.0).then_some(BackgroundSample { wi, pdf })
    }

    /// Density per steradian of a unit direction.
    pub fn pdf(&self, direction: Vec3) -> f32 {
        self.density(direction.dot(self.axis).clamp(-1.0, 1.0))
    }

    fn density(&self, sine: f32) -> f32 {
        let half = if sine < 0.0 { &self.lower } else { &self.upper };
        let total = TAU * (self.upper.mean().luminance() + self.lower.mean().luminance());
        if total > 0.0 { half.luminance(sine.abs()) / total } else { 0.0 }
    }
}
