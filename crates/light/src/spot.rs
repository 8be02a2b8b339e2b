//! Point light that emits into a cone.
//!
//! ```json
//! {"spot": {"position": [240, 240, 200], "direction": [-2.4, -2.4, -1], "color": [1, 1, 1],
//!     "intensity": 0.5, "attenuation": {"constant": 1, "linear": 4e-6, "quadratic": 4e-6},
//!     "beam_degrees": 30, "cutoff_degrees": 90}}
//! ```
//!
//! With θ the angle between the axis and the direction from the light's center, the intensity is
//! constant up to `beam_degrees`, falls to 0 at `cutoff_degrees` (by default linearly with θ; see
//! [`SpotFalloff`]), and is multiplied by max(0, cos θ)^`beam_exponent`. (The teaching engine's falloff angle is the difference of the
//! two angles. Its first formula has an exponent of 1 and no edge: both angles are 90.)
//!
//! With this falloff f, a light of radiant intensity I on its axis emits the radiant flux Φ = I ∫ f
//! dω, so `power` gives I = Φ / ∫ f dω. With the linear falloff the integral is numerical; for a
//! sharp cone of half angle c it is 2π (1 - cos c). The falloffs by the cosine, without an exponent
//! and a photometric file, have closed forms. (Blender keeps the intensity of the whole sphere when a cone restricts it;
//! pbrt's `power` divides by the integral, as here.)

use super::finite_light::{self, Attenuation, Extent};
use super::spot_falloff::SpotFalloff;
use super::strength::Strength;
use super::{Ies, InvalidLight, Light, LightSample, check_direction, in_range};
use crate::emitter::LightBounds;
use juggler_math::{Rgb, Transform, Vec2, Vec3, portable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Point light that emits into a cone.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Spot {
    /// Center of the light, in world space.
    #[schemars(with = "[f32; 3]", extend("x-unit" = "scene units"))]
    pub position: Vec3,
    /// Axis of the cone, in world space, of any length.
    #[schemars(with = "[f32; 3]")]
    pub direction: Vec3,
    /// Color of the light, linear RGB.
    pub color: Rgb,
    /// Radiant intensity on the axis in watts per steradian, times `color`. It equals the
    /// irradiance of a facing surface on the axis at distance 1 with the default attenuation. The
    /// default is 1, unless `power` is given.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0, max = 1e30), extend("x-unit" = "W/sr"))]
    pub intensity: Option<f32>,
    /// Radiant flux of the whole cone in watts per channel, times `color`; replaces `intensity`. At
    /// the same power, a narrower cone is brighter.
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
    /// Angle from the axis up to which the intensity is constant, in degrees. Between
    /// `beam_degrees` and `cutoff_degrees` the intensity falls as `falloff` says.
    #[schemars(range(min = 0, max = 180), extend("x-unit" = "degrees"))]
    pub beam_degrees: f32,
    /// Cut-off angle: the angle from the axis beyond which the light emits nothing, in degrees;
    /// `beam_degrees` or more.
    #[schemars(range(min = 0, max = 180), extend("x-unit" = "degrees"))]
    pub cutoff_degrees: f32,
    /// Falloff between `beam_degrees` and `cutoff_degrees`. The default is linear in the angle.
    #[serde(skip_serializing_if = "SpotFalloff::is_default")]
    pub falloff: SpotFalloff,
    /// Exponent of the cosine of the angle from the axis. Larger values concentrate the light
    /// around the axis; 0 has no effect.
    #[schemars(range(min = 0))]
    pub beam_exponent: f32,
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

impl Default for Spot {
    fn default() -> Self {
        Self {
            position: Vec3::ZERO,
            direction: Vec3::NEG_Y,
            color: Rgb::WHITE,
            intensity: None,
            power: None,
            attenuation: Attenuation::default(),
            range: None,
            beam_degrees: 25.0,
            cutoff_degrees: 30.0,
            falloff: SpotFalloff::Linear,
            beam_exponent: 0.0,
            extent: None,
            samples: 1,
            ies: None,
            light_group: None,
        }
    }
}

impl Spot {
    /// Creates a white spot light of an intensity in watts per steradian, along an axis.
    pub fn new(position: impl Into<Vec3>, direction: impl Into<Vec3>, intensity: f32) -> Self {
        Self { position: position.into(), direction: direction.into(), intensity: Some(intensity), ..Self::default() }
    }

    /// Falloff of the intensity at an angle with cosine `cos` from the axis, 0 to 1.
    fn angular_falloff(&self, cos: f32) -> f32 {
        let (beam, cutoff) = (self.beam_degrees.to_radians(), self.cutoff_degrees.to_radians());
        let angle = portable::acos(cos.clamp(-1.0, 1.0));
        let edge = if self.falloff != SpotFalloff::Linear {
            self.falloff.at_cosine(cos, portable::cos(beam), portable::cos(cutoff))
        } else if angle <= beam {
            1.0
        } else if angle < cutoff {
            (cutoff - angle) / (cutoff - beam)
        } else {
            return 0.0;
        };
        if self.beam_exponent == 0.0 { edge } else { edge * portable::powf(cos.max(0.0), self.beam_exponent) }
    }

    /// Radiant intensity on the axis in watts per steradian, without the color.
    fn intensity(&self) -> f32 {
        self.power.map_or(self.intensity.unwrap_or(1.0), |power| {
            let integral = self.falloff_integral();
            if integral > 0.0 { power / integral } else { 0.0 }
        })
    }

    /// Integral of the falloff over all directions, in steradians.
    fn falloff_integral(&self) -> f32 {
        const STEPS: u16 = 512;
        if let Some(ies) = &self.ies {
            let axis = self.direction.normalize_or_zero();
            let mean = finite_light::mean_over_sphere(|leaving| {
                self.angular_falloff(leaving.dot(axis)) * ies.factor(leaving, axis)
            });
            return 2.0 * std::f32::consts::TAU * mean;
        }
        if self.falloff != SpotFalloff::Linear && self.beam_exponent == 0.0 {
            let cosine = |degrees: f32| portable::cos(degrees.to_radians());
            return self.falloff.integral_of_cosine(cosine(self.beam_degrees), cosine(self.cutoff_degrees));
        }
        // Integrate over bands of equal solid angle within the cut-off by the midpoint rule.
        let size = 1.0 - portable::cos(self.cutoff_degrees.to_radians());
        let falloff = |i: u16| self.angular_falloff(1.0 - size * (f32::from(i) + 0.5) / f32::from(STEPS));
        let mean = (0..STEPS).map(falloff).sum::<f32>() / f32::from(STEPS);
        std::f32::consts::TAU * size * mean
    }
}

impl Light for Spot {
    fn light_group(&self) -> Option<&str> {
        self.light_group.as_deref()
    }

    fn light_group_mut(&mut self) -> Option<&mut Option<String>> {
        Some(&mut self.light_group)
    }

    fn transform(&mut self, transform: &Transform) {
        self.position = transform.point(self.position);
        self.direction = super::transformed_direction(transform, self.direction);
    }

    fn check(&self) -> Result<(), InvalidLight> {
        self.ies.as_ref().map_or(Ok(()), Ies::check)?;
        check_direction(self.direction)?;
        in_range("beam_degrees", self.beam_degrees, 0.0, 180.0)?;
        in_range("cutoff_degrees", self.cutoff_degrees, self.beam_degrees, 180.0)?;
        in_range("beam_exponent", self.beam_exponent, 0.0, f32::MAX)?;
        let strength = Strength { field: "intensity", value: self.intensity, power: self.power };
        strength.check(self.color, self.color * self.intensity())?;
        finite_light::check_range(self.range)?;
        finite_light::check(self.position, self.extent, &self.attenuation, self.samples)
    }

    fn sample(&self, from: Vec3, u: Vec2) -> Option<LightSample> {
        let point = finite_light::sample_extent(self.position, self.extent, &self.attenuation, from, u)?;
        let cos = -point.towards_center.dot(self.direction.normalize_or_zero());
        let mut radiance = self.color * (self.intensity() * point.falloff * self.angular_falloff(cos));
        if let Some(ies) = &self.ies {
            radiance = radiance * ies.factor(-point.towards_center, self.direction);
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
        let at_radius = finite_light::power_per_intensity(&self.attenuation, self.range, world_radius);
        self.falloff_integral() * at_radius * (self.color * self.intensity()).luminance()
    }

    fn bounds(&self, world_radius: f32) -> Option<LightBounds> {
        let at_radius = finite_light::power_per_intensity(&self.attenuation, self.range, world_radius);
        let ies_factor = self.ies.as_ref().map_or(1.0, Ies::max_factor);
        let power = 2.0 * std::f32::consts::TAU * ies_factor * at_radius * (self.color * self.intensity()).luminance();
        // Bound: constant up to the beam angle, some light from there to the cut-off angle.
        let beam = portable::cos(self.beam_degrees.to_radians());
        let edge = portable::cos((self.cutoff_degrees - self.beam_degrees).to_radians());
        let bounds = finite_light::bounds(self.position, self.extent, power);
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
    /// Examples for the contract tests.
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
        let measured = Self { ies: Some(super::ies::tests::luminaire()), cutoff_degrees: 70.0, ..Self::default() };
        let stage = Self { power: Some(100.0), beam_degrees: 10.0, cutoff_degrees: 25.0, ..Self::default() };
        let squared = Self { falloff: SpotFalloff::SquaredCosine, range: Some(200.0), ..stage.clone() };
        let smooth = Self { falloff: SpotFalloff::SmoothCosine, beam_degrees: 0.0, ..stage.clone() };
        let sharp = Self { falloff: SpotFalloff::SquaredCosine, beam_degrees: 25.0, ..stage.clone() };
        let gathered = Self { falloff: SpotFalloff::SmoothCosine, beam_exponent: 2.0, ..chess.clone() };
        vec![Self::default(), chess, cosine, measured, stage, squared, smooth, sharp, gathered]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Red channel of the light at distance 1, `degrees` from the axis.
    fn at(spot: &Spot, degrees: f32) -> f32 {
        let (sin, cos) = portable::sin_cos(degrees.to_radians());
        spot.sample(Vec3::new(sin, -cos, 0.0), Vec2::ZERO).map_or(0.0, |sample| sample.radiance.r)
    }

    #[test]
    fn intensity_is_full_in_the_beam_linear_to_the_cutoff_then_zero() {
        let spot = Spot { beam_degrees: 30.0, cutoff_degrees: 90.0, ..Spot::default() };
        for (degrees, expected) in [(0.0, 1.0), (29.99, 1.0), (45.0, 0.75), (60.0, 0.5), (75.0, 0.25), (89.4, 0.01)] {
            assert!((at(&spot, degrees) - expected).abs() < 1e-5, "{degrees}: {}", at(&spot, degrees));
        }
        assert_eq!([90.01, 120.0, 180.0].map(|degrees| at(&spot, degrees)), [0.0; 3]);
        let sharp = Spot { beam_degrees: 20.0, cutoff_degrees: 20.0, ..Spot::default() };
        assert_eq!((at(&sharp, 19.99), at(&sharp, 20.01)), (1.0, 0.0));
    }

    #[test]
    fn falloffs_by_the_cosine_have_their_formulas() {
        let (beam, cutoff) = (portable::cos(20f32.to_radians()), portable::cos(50f32.to_radians()));
        let (beam_degrees, cutoff_degrees) = (20.0, 50.0);
        let squared = Spot { falloff: SpotFalloff::SquaredCosine, beam_degrees, cutoff_degrees, ..Spot::default() };
        let smooth = Spot { falloff: SpotFalloff::SmoothCosine, ..squared.clone() };
        for degrees in [0.0f32, 10.0, 19.9, 20.1, 25.0, 35.0, 45.0, 49.9] {
            let x = ((portable::cos(degrees.to_radians()) - cutoff) / (beam - cutoff)).clamp(0.0, 1.0);
            assert!((at(&squared, degrees) - x * x).abs() < 1e-5, "{degrees}");
            assert!((at(&smooth, degrees) - (3.0 * x * x - 2.0 * x * x * x)).abs() < 1e-5, "{degrees}");
        }
        for degrees in [50.1, 90.0, 130.0, 180.0] {
            assert_eq!((at(&squared, degrees), at(&smooth, degrees)), (0.0, 0.0));
        }
    }

    #[test]
    fn closed_forms_match_numerical_integrals() {
        let angles = [(0.0, 0.5), (0.0, 45.0), (10.0, 10.5), (30.0, 30.0), (20.0, 90.0), (60.0, 180.0), (180.0, 180.0)];
        for ((beam_degrees, cutoff_degrees), falloff) in angles
            .into_iter()
            .flat_map(|angles| [SpotFalloff::SquaredCosine, SpotFalloff::SmoothCosine].map(|falloff| (angles, falloff)))
        {
            let spot = Spot { beam_degrees, cutoff_degrees, falloff, ..Spot::default() };
            let size = 1.0 - f64::from(portable::cos(f32::to_radians(cutoff_degrees)));
            let value = |i: u32| f64::from(spot.angular_falloff((1.0 - size * (f64::from(i) + 0.5) / 2e5) as f32));
            let expected = std::f64::consts::TAU * size * (0..200_000).map(value).sum::<f64>() / 2e5;
            let found = f64::from(spot.falloff_integral());
            assert!((found - expected).abs() <= 2e-3 * expected, "{spot:?}: {found} {expected}");
        }
    }

    #[test]
    fn the_exponent_gathers_light_around_the_axis() {
        let spot = Spot { beam_degrees: 180.0, cutoff_degrees: 180.0, beam_exponent: 2.0, ..Spot::default() };
        for (degrees, expected) in [(0.0, 1.0), (45.0, 0.5), (60.0, 0.25), (100.0, 0.0), (180.0, 0.0)] {
            assert!((at(&spot, degrees) - expected).abs() < 1e-6, "{degrees}");
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
        assert!(
            (power(30.0, 90.0, 0.0) / (TAU * (1.0 - (portable::sin(c) - portable::sin(b)) / (c - b))) - 1.0).abs()
                < 1e-4
        );
    }

    /// Φ = I ∫ f dω; the integral is 2π (1 - cos c) for a sharp cone and π for a cosine over the
    /// hemisphere.
    #[test]
    fn power_is_shared_by_the_cone() {
        let on_axis = |spot: &Spot| spot.sample(Vec3::NEG_Y, Vec2::ZERO).unwrap().radiance.g;
        let power = Some(100.0);
        for degrees in [5.0f32, 30.0, 90.0, 180.0] {
            let spot = Spot { power, beam_degrees: degrees, cutoff_degrees: degrees, ..Spot::default() };
            let solid_angle = std::f32::consts::TAU * (1.0 - portable::cos(degrees.to_radians()));
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
