//! Light that emits uniformly in all directions, from a point or from a sphere or square.
//!
//! ```json
//! {"point": {"position": [-564, 686, 147], "color": [1, 1, 1], "intensity": 1,
//!     "attenuation": {"constant": 1}, "extent": {"sphere": {"radius": 10}}, "samples": 1}}
//! ```
//!
//! A light of radiant intensity I (watts per steradian) emits the radiant flux Φ = 4π I, so `power`
//! gives I = Φ / 4π, times `color` per channel.
//!
//! A photometric file gives the light the measured distribution of a luminaire:
//! `"ies": {"file": "luminaire.ies"}`.

use super::finite_light::{self, Attenuation, Extent};
use super::strength::Strength;
use super::{Ies, InvalidLight, Light, LightSample};
use crate::emitter::LightBounds;
use juggler_math::{Rgb, Transform, Vec2, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f32::consts::PI;

/// Light that emits uniformly in all directions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Point {
    /// Center of the light, in world space.
    #[schemars(with = "[f32; 3]", extend("x-unit" = "scene units"))]
    pub position: Vec3,
    /// Color of the light, linear RGB.
    pub color: Rgb,
    /// Radiant intensity in watts per steradian, times `color`. It equals the irradiance of a
    /// facing surface at distance 1 with the default attenuation. The default is 1, unless `power`
    /// is given.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0, max = 1e30), extend("x-unit" = "W/sr"))]
    pub intensity: Option<f32>,
    /// Radiant flux in watts per channel, times `color`; replaces `intensity`. The intensity is
    /// power / 4π. A photometric file distributes the same flux over directions.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0, max = 1e30), extend("x-unit" = "W"))]
    pub power: Option<f32>,
    /// Falloff with distance.
    pub attenuation: Attenuation,
    /// Distance d from the light's center at which its light ends: a factor of 1 − (d / `range`)⁴
    /// on the falloff. By default there is no end. `intensity` and `power` hold for the light
    /// without it.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1e-30), extend("x-unit" = "scene units"))]
    pub range: Option<f32>,
    /// Size of the light, for soft shadows. The default is a point, which casts hard shadows.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub extent: Option<Extent>,
    /// Number of shadow rays per shading point, sampled over the extent. Only the classic
    /// integrator uses it. More samples give less noise in penumbras. Without an extent it has no
    /// effect.
    #[schemars(range(min = 1, max = 10_000), extend("x-unit" = "samples"))]
    pub samples: u32,
    /// Photometric file with the measured distribution of intensity over directions.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ies: Option<Ies>,
    /// Light group; the light of each group is written to its own AOV.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub light_group: Option<String>,
}

impl Default for Point {
    fn default() -> Self {
        Self {
            position: Vec3::ZERO,
            color: Rgb::WHITE,
            intensity: None,
            power: None,
            attenuation: Attenuation::default(),
            range: None,
            extent: None,
            samples: 1,
            ies: None,
            light_group: None,
        }
    }
}

impl Point {
    /// Creates a white point light of an intensity, in watts per steradian.
    pub fn new(position: impl Into<Vec3>, intensity: f32) -> Self {
        Self { position: position.into(), intensity: Some(intensity), ..Self::default() }
    }

    /// Radiant intensity in watts per steradian, without the color.
    fn intensity(&self) -> f32 {
        self.power.map_or(self.intensity.unwrap_or(1.0), |power| {
            let mean = self.mean_ies_factor();
            if mean > 0.0 { power / (4.0 * PI * mean) } else { 0.0 }
        })
    }

    /// Mean factor of the photometric file over all directions; 1 without a file.
    fn mean_ies_factor(&self) -> f32 {
        self.ies.as_ref().map_or(1.0, |ies| finite_light::mean_over_sphere(|leaving| ies.factor(leaving, Vec3::NEG_Y)))
    }

    /// Power without the photometric file; see [`Light::power`].
    fn power_without_ies(&self, world_radius: f32) -> f32 {
        let at_radius = finite_light::power_per_intensity(&self.attenuation, self.range, world_radius);
        4.0 * PI * at_radius * (self.color * self.intensity()).luminance()
    }
}

impl Light for Point {
    fn light_group(&self) -> Option<&str> {
        self.light_group.as_deref()
    }

    fn light_group_mut(&mut self) -> Option<&mut Option<String>> {
        Some(&mut self.light_group)
    }

    fn transform(&mut self, transform: &Transform) {
        self.position = transform.point(self.position);
    }

    fn check(&self) -> Result<(), InvalidLight> {
        let strength = Strength { field: "intensity", value: self.intensity, power: self.power };
        strength.check(self.color, self.color * self.intensity())?;
        self.ies.as_ref().map_or(Ok(()), Ies::check)?;
        finite_light::check_range(self.range)?;
        finite_light::check(self.position, self.extent, &self.attenuation, self.samples)
    }

    fn sample(&self, from: Vec3, u: Vec2) -> Option<LightSample> {
        let point = finite_light::sample_extent(self.position, self.extent, &self.attenuation, from, u)?;
        let mut radiance = self.color * (self.intensity() * point.falloff);
        if let Some(ies) = &self.ies {
            radiance = radiance * ies.factor(-point.towards_center, Vec3::NEG_Y);
        }
        if self.range.is_some() {
            radiance = radiance * finite_light::range_factor(self.range, self.position, from);
        }
        let arrives = radiance.is_finite() && !radiance.is_black();
        arrives.then_some(LightSample { wi: point.wi, distance: point.distance, radiance, pdf: 1.0 })
    }

    fn shadow_samples(&self) -> u32 {
        if self.extent.is_some() { self.samples } else { 1 }
    }

    fn prepare(&mut self) {
        (self.intensity, self.power) = (Some(self.intensity()), None);
    }

    fn is_delta(&self) -> bool {
        self.extent.is_none()
    }

    fn ies(&mut self) -> Option<&mut Ies> {
        self.ies.as_mut()
    }

    fn bounding_sphere(&self) -> Option<(Vec3, f32)> {
        Some((self.position, self.extent.map_or(0.0, Extent::radius)))
    }

    fn power(&self, world_radius: f32) -> f32 {
        self.power_without_ies(world_radius) * self.mean_ies_factor()
    }

    fn bounds(&self, world_radius: f32) -> Option<LightBounds> {
        let power = self.power_without_ies(world_radius) * self.ies.as_ref().map_or(1.0, Ies::max_factor);
        Some(finite_light::bounds(self.position, self.extent, power))
    }
}

#[cfg(any(test, feature = "testing"))]
impl Point {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        let juggler = Self {
            position: Vec3::new(-564.0, 686.0, 147.0),
            attenuation: Attenuation { constant: 1.0, linear: 0.0, quadratic: 0.0 },
            extent: Some(Extent::Sphere { radius: 10.0 }),
            ..Self::default()
        };
        let chess = Self {
            position: Vec3::new(0.0, 0.0, 300.0),
            attenuation: Attenuation { constant: 1.0, linear: 8e-5, quadratic: 8e-5 },
            extent: Some(Extent::Square { side: 15.0 }),
            color: Rgb::new(1.0, 0.5, 0.25),
            intensity: Some(3.0),
            samples: 16,
            ..Self::default()
        };
        let measured = Self { ies: Some(super::ies::tests::luminaire()), ..Self::default() };
        let bulb = Self { power: Some(60.0), ..measured.clone() };
        let ending = Self { range: Some(200.0), position: Vec3::ONE, ..Self::default() };
        vec![Self { position: Vec3::new(0.0, 4.0, 0.0), ..Self::default() }, juggler, chess, measured, bulb, ending]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn attenuation_follows_its_coefficients() {
        for (attenuation, expected) in [
            (r#"{"quadratic": 1}"#, [1.0, 0.25, 1e-4]),
            (r#"{"constant": 1}"#, [1.0, 1.0, 1.0]),
            (r#"{"constant": 1, "linear": 0.5, "quadratic": 0.25}"#, [4.0 / 7.0, 1.0 / 3.0, 1.0 / 2551.0]),
            (r#"{"linear": 2}"#, [0.5, 0.25, 0.005]),
        ] {
            let json = format!(r#"{{"position": [1, 2, 3], "intensity": 8, "attenuation": {attenuation}}}"#);
            let light: Point = serde_json::from_str(&json).unwrap();
            for (distance, expected) in [1.0f32, 2.0, 100.0].into_iter().zip(expected) {
                let from = Vec3::new(1.0, 2.0 - distance * 0.6, 3.0 + distance * 0.8);
                let sample = light.sample(from, Vec2::ZERO).unwrap();
                assert!((sample.radiance.g / (8.0 * expected) - 1.0).abs() < 1e-6, "{json} {distance} {sample:?}");
                assert!((sample.distance - distance).abs() < 1e-5 * distance && sample.pdf == 1.0);
                assert!((sample.wi - Vec3::new(0.0, 0.6, -0.8)).length() < 1e-6);
            }
        }
    }

    #[test]
    fn light_ends_at_its_range() {
        let light = Point { range: Some(2.0), intensity: Some(3.0), ..Point::default() };
        for (distance, factor) in [(0.5f32, 255.0 / 256.0), (1.0, 15.0 / 16.0), (1.5, 175.0 / 256.0)] {
            let sample = light.sample(Vec3::new(0.0, distance, 0.0), Vec2::ZERO).unwrap();
            let expected = 3.0 * factor / (distance * distance);
            assert!((sample.radiance.r / expected - 1.0).abs() < 1e-6, "{distance}: {sample:?}");
        }
        for distance in [2.0, 2.5, 1e20, f32::MAX] {
            assert_eq!(light.sample(Vec3::new(0.0, 0.0, distance), Vec2::ZERO), None);
        }
        let even = Attenuation { constant: 1.0, linear: 0.0, quadratic: 0.0 };
        let even = Point { range: Some(2.0), attenuation: even, ..Point::default() };
        assert_eq!((even.power(100.0), even.power(1.0)), (even.power(2.0), even.power(2.0) / 4.0));
        assert!(even.bounds(100.0).unwrap().power > 0.0);
        for range in [0.0, -1.0, f32::NAN, f32::INFINITY] {
            assert_eq!(Point { range: Some(range), ..Point::default() }.check().unwrap_err().field, "range");
        }
    }

    #[test]
    fn power_is_shared_by_all_directions() {
        let bulb = Point { power: Some(100.0), color: Rgb::new(1.0, 0.5, 0.0), ..Point::default() };
        let sample = bulb.sample(Vec3::new(0.0, 0.0, 2.0), Vec2::ZERO).unwrap();
        let expected = 100.0 / (4.0 * PI) / 4.0;
        assert!((sample.radiance.r / expected - 1.0).abs() < 1e-6 && sample.radiance.b == 0.0);
        assert!((sample.radiance.g / sample.radiance.r - 0.5).abs() < 1e-6);
        let mut ready = bulb.clone();
        ready.prepare();
        assert_eq!((ready.power, ready.sample(Vec3::Z, Vec2::ZERO)), (None, bulb.sample(Vec3::Z, Vec2::ZERO)));
    }

    #[test]
    fn only_lights_with_an_extent_need_several_shadow_samples() {
        let many = Point { samples: 16, ..Point::default() };
        assert_eq!(many.shadow_samples(), 1);
        assert_eq!(Point { extent: Some(Extent::Sphere { radius: 1.0 }), ..many }.shadow_samples(), 16);
    }
}
