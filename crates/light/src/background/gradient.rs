//! Sky with a color gradient by elevation, from the horizon to the zenith.
//!
//! ```json
//! {"gradient": {"horizon": [0.7, 0.7, 1], "zenith": [0.1, 0.1, 1], "blend": "sine_squared"}}
//! ```
//!
//! This example is the sky of Eric Graham's Juggler (1986), which looks the same below the horizon
//! as above.

use super::elevation_gradient::{ElevationGradient, Hemisphere};
use super::{Background, BackgroundSample, InvalidBackground, check_color};
use juggler_math::{Ray, Rgb, Vec2, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Sky with a color gradient by elevation, from the horizon to the zenith.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Gradient {
    /// Color at the horizon.
    #[schemars(extend("x-unit" = "W/(scene unit² sr)"))]
    pub horizon: Rgb,
    /// Color at the zenith.
    #[schemars(extend("x-unit" = "W/(scene unit² sr)"))]
    pub zenith: Rgb,
    /// Color at the nadir. Without it the lower hemisphere mirrors the upper one.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "W/(scene unit² sr)"))]
    pub nadir: Option<Rgb>,
    /// Direction of the zenith in world space, of any length.
    #[schemars(with = "[f32; 3]")]
    pub axis: Vec3,
    /// Interpolation between the colors.
    pub blend: Blend,
}

/// Interpolation between the color at the horizon and the color at the zenith or nadir.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Blend {
    /// Linear in the sine of the elevation, the height of a unit direction.
    #[default]
    Sine,
    /// Linear in the square of the sine, which gives a wider horizon.
    SineSquared,
}

impl Default for Gradient {
    fn default() -> Self {
        Self {
            horizon: Rgb::new(0.75, 0.85, 1.0),
            zenith: Rgb::new(0.25, 0.45, 1.0),
            nadir: None,
            axis: Vec3::Y,
            blend: Blend::Sine,
        }
    }
}

impl Gradient {
    /// Creates a gradient from the radiance at the horizon to that at the zenith.
    pub fn new(horizon: impl Into<Rgb>, zenith: impl Into<Rgb>) -> Self {
        Self { horizon: horizon.into(), zenith: zenith.into(), ..Self::default() }
    }

    fn elevation_gradient(&self) -> ElevationGradient {
        let half = |end: Rgb| Hemisphere { base: self.horizon, end, squared: self.blend == Blend::SineSquared };
        let axis = self.axis.normalize_or(Vec3::Y);
        ElevationGradient { axis, upper: half(self.zenith), lower: half(self.nadir.unwrap_or(self.zenith)) }
    }
}

impl Background for Gradient {
    fn check(&self) -> Result<(), InvalidBackground> {
        check_color("horizon", self.horizon)?;
        check_color("zenith", self.zenith)?;
        check_color("nadir", self.nadir.unwrap_or_default())?;
        let squared = self.axis.length_squared();
        if squared >= f32::MIN_POSITIVE && squared.is_finite() {
            return Ok(());
        }
        let message = format!("`axis` must have a finite length above 0; it is {}", self.axis);
        Err(InvalidBackground { field: "axis", message })
    }

    fn radiance(&self, ray: &Ray) -> Rgb {
        let sine = (ray.direction.dot(self.axis) / self.axis.length()).clamp(-1.0, 1.0);
        let end = if sine < 0.0 { self.nadir.unwrap_or(self.zenith) } else { self.zenith };
        let weight = match self.blend {
            Blend::Sine => sine.abs(),
            Blend::SineSquared => sine * sine,
        };
        self.horizon.lerp(end, weight)
    }

    fn sample(&self, u: Vec2) -> Option<BackgroundSample> {
        self.elevation_gradient().sample(u)
    }

    fn pdf(&self, direction: Vec3) -> f32 {
        self.elevation_gradient().pdf(direction)
    }

    fn mean_radiance(&self) -> Rgb {
        self.elevation_gradient().mean()
    }
}

#[cfg(any(test, feature = "testing"))]
impl Gradient {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        let below = Self { nadir: Some(Rgb::splat(0.1)), axis: Vec3::Z * 3.0, ..Self::default() };
        vec![Self::default(), below, Self { blend: Blend::SineSquared, ..Self::default() }]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(json: &str, direction: Vec3) -> Rgb {
        let sky: Gradient = serde_json::from_str(json).unwrap();
        sky.radiance(&Ray::new(Vec3::new(5.0, 6.0, 7.0), direction))
    }

    fn near(a: Rgb, b: [f32; 3]) -> bool {
        (Vec3::from(a.to_array()) - Vec3::from(b)).abs().max_element() < 1e-6
    }

    #[test]
    fn colors_follow_the_elevation() {
        let json = |more: &str| format!(r#"{{"horizon": [1, 0, 0], "zenith": [0, 1, 0], "axis": [0, 0, 2]{more}}}"#);
        let (plain, lower) = (json(""), json(r#", "nadir": [0, 0, 1]"#));
        assert!(near(at(&plain, Vec3::X), [1.0, 0.0, 0.0]) && near(at(&plain, Vec3::Z), [0.0, 1.0, 0.0]));
        assert!(near(at(&plain, Vec3::new(0.8, 0.0, 0.6)), [0.4, 0.6, 0.0]));
        assert!(near(at(&plain, Vec3::new(0.8, 0.0, -0.6)), [0.4, 0.6, 0.0]));
        assert!(near(at(&lower, Vec3::new(0.0, 0.8, -0.6)), [0.4, 0.0, 0.6]));
    }

    #[test]
    fn sine_squared_gradient_matches_grahams_sky() {
        let json = r#"{"horizon": [0.7, 0.7, 1], "zenith": [0.1, 0.1, 1], "blend": "sine_squared"}"#;
        for (y, red) in [(0.0f32, 0.7), (0.5, 0.55), (-0.5, 0.55), (1.0, 0.1)] {
            let direction = Vec3::new((1.0 - y * y).sqrt(), y, 0.0);
            assert!(near(at(json, direction), [red, red, 1.0]), "{y}");
        }
    }
}
