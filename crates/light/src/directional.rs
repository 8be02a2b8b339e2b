//! Directional light: an infinitely distant light such as the sun, a point or a disk.
//!
//! ```json
//! {"directional": {"direction": [1, -2, -1], "color": [1, 0.9, 0.8], "intensity": 1,
//!     "angle_degrees": 0.53}}
//! ```
//!
//! `angle_degrees` gives soft shadows and does not change the irradiance `E` on a surface that faces
//! the light. All points of the disk emit the same radiance, `E / (π sin²(angle / 2))`, because the
//! integral of the cosine over the disk's cone is `π sin²(angle / 2)`.

use super::{InvalidLight, Light, LightSample, check_color, check_direction, in_range};
use juggler_math::{Frame, Rgb, Transform, Vec2, Vec3, warp};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Infinitely distant light with the same direction everywhere.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Directional {
    /// Direction in which the light travels, in world space, of any length.
    #[schemars(with = "[f32; 3]")]
    pub direction: Vec3,
    /// Color of the light, linear RGB.
    pub color: Rgb,
    /// Factor on `color`. The product is the irradiance on a surface that faces the light.
    #[schemars(range(min = 0, max = 1e30), extend("x-unit" = "W/scene unit²"))]
    pub intensity: f32,
    /// Angular diameter of the light's disk, in degrees. Larger angles give softer shadows; the sun
    /// has 0.53. The default, 0, gives hard shadows.
    #[serde(skip_serializing_if = "is_zero")]
    #[schemars(range(min = 0, max = 180), extend("x-unit" = "degrees"))]
    pub angle_degrees: f32,
    /// Number of shadow rays per shading point, sampled over the disk. Only the classic integrator
    /// uses it. More samples give less noise in penumbras. Without an angle it has no effect.
    #[serde(skip_serializing_if = "is_one")]
    #[schemars(range(min = 1, max = 10_000), extend("x-unit" = "samples"))]
    pub samples: u32,
    /// Light group; the light of each group is written to its own AOV.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub light_group: Option<String>,
}

impl Directional {
    /// Creates white light that travels along a direction.
    pub fn new(direction: impl Into<Vec3>, intensity: f32) -> Self {
        Self { direction: direction.into(), intensity, ..Self::default() }
    }
}

fn is_zero(angle: &f32) -> bool {
    *angle == 0.0
}

fn is_one(samples: &u32) -> bool {
    *samples == 1
}

impl Default for Directional {
    fn default() -> Self {
        let (direction, color) = (Vec3::NEG_Y, Rgb::WHITE);
        Self { direction, color, intensity: 1.0, angle_degrees: 0.0, samples: 1, light_group: None }
    }
}

impl Light for Directional {
    fn light_group(&self) -> Option<&str> {
        self.light_group.as_deref()
    }

    fn light_group_mut(&mut self) -> Option<&mut Option<String>> {
        Some(&mut self.light_group)
    }

    fn transform(&mut self, transform: &Transform) {
        self.direction = super::transformed_direction(transform, self.direction);
    }

    fn check(&self) -> Result<(), InvalidLight> {
        check_direction(self.direction)?;
        in_range("angle_degrees", self.angle_degrees, 0.0, 180.0)?;
        in_range("samples", self.samples as f32, 1.0, 10_000.0)?;
        check_color(self.color, self.intensity)
    }

    fn sample(&self, _from: Vec3, u: Vec2) -> Option<LightSample> {
        let mut radiance = self.color * self.intensity;
        let mut wi = -self.direction.normalize_or_zero();
        if self.angle_degrees > 0.0 && wi != Vec3::ZERO {
            let size = warp::cone_size(0.5 * self.angle_degrees.to_radians());
            // Solid angle of the cone, 2π size, over its integral of the cosine, π size (2 - size).
            radiance = radiance * (2.0 / (2.0 - size));
            wi = Frame::around(wi).to_world(warp::uniform_cone(u, size));
        }
        (!radiance.is_black() && wi != Vec3::ZERO).then_some(LightSample {
            wi,
            distance: f32::INFINITY,
            radiance,
            pdf: 1.0,
        })
    }

    fn shadow_samples(&self) -> u32 {
        if self.is_delta() { 1 } else { self.samples }
    }

    fn is_delta(&self) -> bool {
        self.angle_degrees == 0.0
    }

    fn power(&self, world_radius: f32) -> f32 {
        std::f32::consts::PI * world_radius * world_radius * (self.color * self.intensity).luminance()
    }
}

#[cfg(any(test, feature = "testing"))]
impl Directional {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        let sun = Self { angle_degrees: 0.53, samples: 4, ..Self::default() };
        vec![Self::default(), Self { direction: Vec3::new(1.0, 1.0, -0.5), ..Self::default() }, sun]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::portable;
    use juggler_math::testing::{Random, chi_squared};

    #[test]
    fn directional_light_arrives_against_its_direction() {
        let light = Directional { direction: Vec3::new(3.0, 0.0, -4.0), intensity: 2.0, ..Directional::default() };
        let sample = light.sample(Vec3::new(1e9, 0.0, 3.0), Vec2::ZERO).unwrap();
        assert!((sample.wi - Vec3::new(-0.6, 0.0, 0.8)).length() < 1e-6);
        assert_eq!((sample.distance, sample.radiance), (f32::INFINITY, Rgb::splat(2.0)));
    }

    /// The mean of radiance times cosine over a stratified grid of samples is the irradiance on a
    /// surface that faces the light: `color` times `intensity` for every angle, and the same bits as
    /// ever for 0.
    #[test]
    fn irradiance_does_not_depend_on_the_angle() {
        const GRID: u16 = 64;
        for angle_degrees in [0.0, 0.53, 10.0, 40.0, 90.0, 120.0, 180.0] {
            let light = Directional { intensity: 3.0, angle_degrees, ..Directional::default() };
            let stratum = |i: u16| (f32::from(i) + 0.5) / f32::from(GRID);
            let samples = (0..GRID * GRID).map(|i| Vec2::new(stratum(i / GRID), stratum(i % GRID)));
            let arriving = samples.filter_map(|u| light.sample(Vec3::ZERO, u));
            let sum: f64 = arriving.map(|sample| f64::from(sample.radiance.g * sample.wi.y)).sum();
            let irradiance = sum / f64::from(GRID * GRID);
            assert!((irradiance / 3.0 - 1.0).abs() < 1e-5, "{angle_degrees}: {irradiance}");
        }
        let point = Directional { intensity: 3.0, ..Directional::default() };
        assert_eq!(point.sample(Vec3::ZERO, Vec2::ZERO).map(|sample| sample.radiance), Some(Rgb::splat(3.0)));
    }

    #[test]
    fn sun_disk_is_sampled_uniformly() {
        let light = Directional { direction: Vec3::new(1.0, -2.0, 0.5), angle_degrees: 40.0, ..Directional::default() };
        let axis = -light.direction.normalize();
        let size = warp::cone_size(20f32.to_radians());
        let sample = |u| light.sample(Vec3::ZERO, u).map(|sample| sample.wi);
        let (frame, mut random, mut observed) = (Frame::around(axis), Random::new(97), [0.0; 64]);
        for _ in 0..1_000_000 {
            let u = warp::uniform_cone_inverse(frame.to_local(sample(random.vec2()).unwrap()), size);
            observed[((u.x * 8.0) as usize).min(7) * 8 + ((u.y * 8.0) as usize).min(7)] += 1.0;
        }
        chi_squared(&observed, &[15_625.0; 64], 1e-3).unwrap();
        let rim = sample(Vec2::new(1f32.next_down(), 0.3)).unwrap();
        assert!((portable::acos(rim.dot(axis)).to_degrees() - 20.0).abs() < 1e-3);
        assert!(!light.is_delta() && Directional { samples: 9, ..Directional::default() }.shadow_samples() == 1);
    }
}
