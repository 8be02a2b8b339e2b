//! A point light that shines into a cone.
//!
//! ```json
//! {"spot": {"position": [240, 240, 200], "direction": [-2.4, -2.4, -1], "color": [1, 1, 1], "intensity": 0.5,
//!     "attenuation": {"constant": 1, "linear": 4e-6, "quadratic": 4e-6}, "beam_degrees": 30, "cutoff_degrees": 90}}
//! ```
//!
//! With θ the angle between the axis and the direction from the light's centre, light is full up to
//! `beam_degrees`, falls linearly with θ to nothing at `cutoff_degrees`, and is multiplied by
//! max(0, cos θ)^`beam_exponent`. (The teaching engine's fall-off angle is the difference of the two; its first
//! formula has an exponent of 1 and no edge: both angles 90.)
//!
//! With this falloff f, a light of radiant intensity I on its axis emits the radiant flux Φ = I ∫ f dω, so `power` gives
//! I = Φ / ∫ f dω, the integral taken numerically; for a sharp cone of half angle c it is 2π (1 - cos c). (Blender keeps the
//! intensity of the whole sphere when a cone cuts it; pbrt's `power` divides as is done here.)

use super::source::{self, Attenuation, Extent};
use super::strength::Strength;
use super::{Ies, InvalidLight, Light, LightSample, check_direction, in_range};
use crate::emitter::LightBounds;
use juggler_math::{Rgb, Vec2, Vec3, fun};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A point light that shines into a cone.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Spot {
    /// Where its centre is, world space.
    #[schemars(with = "[f32; 3]")]
    pub position: Vec3,
    /// Where it shines, any length.
    #[schemars(with = "[f32; 3]")]
    pub direction: Vec3,
    /// Its colour.
    pub color: Rgb,
    /// Radiant intensity on the axis in watts per steradian, a factor on the color: what arrives there at distance 1
    /// with the default attenuation. 1 without it and without `power`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0, max = 1e30))]
    pub intensity: Option<f32>,
    /// Radiant flux of the whole cone in watts per channel, a factor on the color, instead of `intensity`: a
    /// narrower cone of the same power is brighter.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0, max = 1e30))]
    pub power: Option<f32>,
    /// How its light falls off with distance.
    pub attenuation: Attenuation,
    /// Angle from the axis up to which it shines in full, in degrees. Between `beam_degrees` and
    /// `cutoff_degrees` intensity falls linearly with the angle itself, not with its cosine, and
    /// without a smooth step.
    #[schemars(range(min = 0, max = 180))]
    pub beam_degrees: f32,
    /// Cut-off angle: the angle from the axis beyond which it does not shine, in degrees;
    /// `beam_degrees` or more.
    #[schemars(range(min = 0, max = 180))]
    pub cutoff_degrees: f32,
    /// Exponent of the cosine of the angle from the axis: gathers light around the axis; 0 leaves it even.
    #[schemars(range(min = 0))]
    pub beam_exponent: f32,
    /// A size, for soft shadows; without it shadows are hard.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub extent: Option<Extent>,
    /// How many places of the extent are asked per sample of the picture.
    #[schemars(range(min = 1, max = 10_000))]
    pub samples: u32,
    /// A photometric file that says how strongly it shines into each direction.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ies: Option<Ies>,
    /// The group of lights that it is kept apart with in layers.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub light_group: Option<String>,
}

impl Default for Spot {
    fn default() -> Self {
        Self {
            position: Vec3::ZERO,
            direction: Vec3::NEG_Y,
            color: Rgb::WHITE,
            intensity: None,
            power: None,
            attenuation: Attenuation::default(),
            beam_degrees: 25.0,
            cutoff_degrees: 30.0,
            beam_exponent: 0.0,
            extent: None,
            samples: 1,
            ies: None,
            light_group: None,
        }
    }
}

impl Spot {
    /// The share of light at an angle with cosine `cos` from the axis.
    fn share(&self, cos: f32) -> f32 {
        let angle = fun::acos(cos.clamp(-1.0, 1.0));
        let (beam, cutoff) = (self.beam_degrees.to_radians(), self.cutoff_degrees.to_radians());
        let edge = if angle <= beam {
            1.0
        } else if angle < cutoff {
            (cutoff - angle) / (cutoff - beam)
        } else {
            return 0.0;
        };
        if self.beam_exponent == 0.0 { edge } else { edge * fun::powf(cos.max(0.0), self.beam_exponent) }
    }

    /// Factor on the color.
    fn intensity(&self) -> f32 {
        self.power.map_or(self.intensity.unwrap_or(1.0), |power| {
            let integral = self.integral();
            if integral > 0.0 { power / integral } else { 0.0 }
        })
    }

    /// Integral over all directions of the share of light, in steradians.
    fn integral(&self) -> f32 {
        const STEPS: u16 = 512;
        if let Some(ies) = &self.ies {
            let axis = self.direction.normalize_or_zero();
            let mean = source::mean(|leaving| self.share(leaving.dot(axis)) * ies.share(leaving, axis));
            return 2.0 * std::f32::consts::TAU * mean;
        }
        // Over bands of equal solid angle within the cut-off, by midpoints.
        let size = 1.0 - fun::cos(self.cutoff_degrees.to_radians());
        let share = |i: u16| self.share(1.0 - size * (f32::from(i) + 0.5) / f32::from(STEPS));
        let mean = (0..STEPS).map(share).sum::<f32>() / f32::from(STEPS);
        std::f32::consts::TAU * size * mean
    }
}

impl Light for Spot {
    fn light_group(&self) -> Option<&str> {
        self.light_group.as_deref()
    }

    fn check(&self) -> Result<(), InvalidLight> {
        self.ies.as_ref().map_or(Ok(()), Ies::check)?;
        check_direction(self.direction)?;
        in_range("beam_degrees", self.beam_degrees, 0.0, 180.0)?;
        in_range("cutoff_degrees", self.cutoff_degrees, self.beam_degrees, 180.0)?;
        in_range("beam_exponent", self.beam_exponent, 0.0, f32::MAX)?;
        let strength = Strength { name: "intensity", value: self.intensity, power: self.power };
        strength.check(self.color, self.color * self.intensity())?;
        source::check(self.position, self.extent, &self.attenuation, self.samples)
    }

    fn sample(&self, from: Vec3, u: Vec2) -> Option<LightSample> {
        let arrival = source::reach(self.position, self.extent, &self.attenuation, from, u)?;
        let cos = -arrival.towards_centre.dot(self.direction.normalize_or_zero());
        let mut radiance = self.color * (self.intensity() * arrival.factor * self.share(cos));
        if let Some(ies) = &self.ies {
            radiance = radiance * ies.share(-arrival.towards_centre, self.direction);
        }
        let arrives = radiance.is_finite() && !radiance.is_black();
        arrives.then_some(LightSample { wi: arrival.wi, distance: arrival.distance, radiance, pdf: 1.0 })
    }

    fn shadow_samples(&self) -> u32 {
        if self.extent.is_some() { self.samples } else { 1 }
    }

    fn prepare(&mut self) {
        (self.intensity, self.power) = (Some(self.intensity()), None);
    }

    fn is_point(&self) -> bool {
        self.extent.is_none()
    }

    fn ies(&mut self) -> Option<&mut Ies> {
        self.ies.as_mut()
    }

    fn ball(&self) -> Option<(Vec3, f32)> {
        Some((self.position, self.extent.map_or(0.0, Extent::radius)))
    }

    fn power(&self, world_radius: f32) -> f32 {
        let at_radius = self.attenuation.at(world_radius) * world_radius * world_radius;
        self.integral() * at_radius * (self.color * self.intensity()).luminance()
    }

    fn bounds(&self, world_radius: f32) -> Option<LightBounds> {
        let at_radius = self.attenuation.at(world_radius) * world_radius * world_radius;
        let shares = self.ies.as_ref().map_or(1.0, Ies::greatest);
        let power = 2.0 * std::f32::consts::TAU * shares * at_radius * (self.color * self.intensity()).luminance();
        // Full up to the beam's angle, and something for the rest of the way to the cut-off.
        let beam = fun::cos(self.beam_degrees.to_radians());
        let edge = fun::cos((self.cutoff_degrees - self.beam_degrees).to_radians());
        let bounds = source::bounds(self.position, self.extent, power);
        Some(LightBounds {
            axis: self.direction.normalize_or(Vec3::NEG_Y),
            cos_theta_o: beam,
            cos_theta_e: edge,
            ..bounds
        })
    }
}

#[cfg(any(test, feature = "testing"))]
impl Spot {
    /// For the contract tests.
    pub fn examples() -> Vec<Self> {
        let chess = Self {
            position: Vec3::new(240.0, 240.0, 200.0),
            direction: Vec3::new(-2.4, -2.4, -1.0),
            attenuation: Attenuation { constant: 1.0, linear: 4e-6, quadratic: 4e-6 },
            beam_degrees: 30.0,
            cutoff_degrees: 90.0,
            ..Self::default()
        };
        let cosine = Self {
            beam_degrees: 90.0,
            cutoff_degrees: 90.0,
            beam_exponent: 3.0,
            extent: Some(Extent::Square { side: 0.5 }),
            samples: 4,
            ..Self::default()
        };
        let measured = Self { ies: Some(super::ies::tests::lamp()), cutoff_degrees: 70.0, ..Self::default() };
        let stage = Self { power: Some(100.0), beam_degrees: 10.0, cutoff_degrees: 25.0, ..Self::default() };
        vec![Self::default(), chess, cosine, measured, stage]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What arrives one unit away, `degrees` off the axis.
    fn at(spot: &Spot, degrees: f32) -> f32 {
        let (sin, cos) = fun::sin_cos(degrees.to_radians());
        spot.sample(Vec3::new(sin, -cos, 0.0), Vec2::ZERO).map_or(0.0, |sample| sample.radiance.r)
    }

    #[test]
    fn full_in_the_beam_then_linear_then_nothing() {
        let spot = Spot { beam_degrees: 30.0, cutoff_degrees: 90.0, ..Spot::default() };
        for (degrees, share) in [(0.0, 1.0), (29.99, 1.0), (45.0, 0.75), (60.0, 0.5), (75.0, 0.25), (89.4, 0.01)] {
            assert!((at(&spot, degrees) - share).abs() < 1e-5, "{degrees}: {}", at(&spot, degrees));
        }
        assert_eq!([90.01, 120.0, 180.0].map(|degrees| at(&spot, degrees)), [0.0; 3]);
        let sharp = Spot { beam_degrees: 20.0, cutoff_degrees: 20.0, ..Spot::default() };
        assert_eq!((at(&sharp, 19.99), at(&sharp, 20.01)), (1.0, 0.0));
    }

    #[test]
    fn the_exponent_gathers_light_around_the_axis() {
        let spot = Spot { beam_degrees: 180.0, cutoff_degrees: 180.0, beam_exponent: 2.0, ..Spot::default() };
        for (degrees, share) in [(0.0, 1.0), (45.0, 0.5), (60.0, 0.25), (100.0, 0.0), (180.0, 0.0)] {
            assert!((at(&spot, degrees) - share).abs() < 1e-6, "{degrees}");
        }
    }

    #[test]
    fn power_is_the_closed_form() {
        use std::f32::consts::TAU;
        let power = |beam: f32, cutoff: f32, exponent: f32| {
            Spot { beam_degrees: beam, cutoff_degrees: cutoff, beam_exponent: exponent, ..Spot::default() }.power(7.0)
        };
        assert!((power(180.0, 180.0, 0.0) / (2.0 * TAU) - 1.0).abs() < 1e-4);
        assert!((power(90.0, 90.0, 3.0) / (TAU / 4.0) - 1.0).abs() < 1e-4);
        // Linear from b to c: 2π (1 - cos b + cos b - (sin c - sin b) / (c - b)).
        let (b, c) = (30f32.to_radians(), 90f32.to_radians());
        assert!((power(30.0, 90.0, 0.0) / (TAU * (1.0 - (fun::sin(c) - fun::sin(b)) / (c - b))) - 1.0).abs() < 1e-4);
    }

    /// Φ = I ∫ f dω: of a sharp cone 2π (1 - cos c), of a cosine over the half space π.
    #[test]
    fn power_is_shared_by_the_cone() {
        let on_axis = |spot: &Spot| spot.sample(Vec3::NEG_Y, Vec2::ZERO).unwrap().radiance.g;
        let power = Some(100.0);
        for degrees in [5.0f32, 30.0, 90.0, 180.0] {
            let spot = Spot { power, beam_degrees: degrees, cutoff_degrees: degrees, ..Spot::default() };
            let solid_angle = std::f32::consts::TAU * (1.0 - fun::cos(degrees.to_radians()));
            assert!((on_axis(&spot) * solid_angle / 100.0 - 1.0).abs() < 1e-4, "{degrees}: {}", on_axis(&spot));
        }
        let cosine = Spot { power, beam_degrees: 90.0, cutoff_degrees: 90.0, beam_exponent: 1.0, ..Spot::default() };
        assert!((on_axis(&cosine) * std::f32::consts::PI / 100.0 - 1.0).abs() < 1e-4);
        let shut = Spot { power, beam_degrees: 0.0, cutoff_degrees: 0.0, ..Spot::default() };
        assert!(shut.check().is_ok() && shut.power(1.0) == 0.0);
        let mut ready = cosine.clone();
        ready.prepare();
        assert_eq!((ready.power, on_axis(&ready)), (None, on_axis(&cosine)));
    }
}
