//! Inside of a huge sphere around the origin, colored by height: the sky of the Juggler's article.
//!
//! ```json
//! {"dome": {"radius": 1e6, "bottom": "#bdbdff", "top": "#2223f6"}}
//! ```
//!
//! The color is bottom + (top − bottom) · y / radius at the intersection of the ray and the sphere;
//! below y = 0 it is `bottom`. A ray that starts outside sees the far side of the sphere. A ray
//! that misses the sphere uses the height of its closest point.

use super::elevation_gradient::{ElevationGradient, Hemisphere};
use super::{Background, BackgroundSample, InvalidBackground, check_color};
use juggler_math::{Ray, Rgb, Vec2, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Inside of a huge sphere around the origin, colored by height. From near the origin it looks like
/// a gradient by the sine of the elevation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Dome {
    /// Radius of the sphere in scene units, above 0. For a distant sky it is much larger than the
    /// scene.
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "scene units"))]
    pub radius: f32,
    /// Color at height 0 and below.
    #[schemars(extend("x-unit" = "W/(scene unit² sr)"))]
    pub bottom: Rgb,
    /// Color at the top.
    #[schemars(extend("x-unit" = "W/(scene unit² sr)"))]
    pub top: Rgb,
}

impl Default for Dome {
    fn default() -> Self {
        Self { radius: 1e6, bottom: Rgb::new(0.5, 0.5, 1.0), top: Rgb::new(0.015, 0.015, 0.9) }
    }
}

impl Dome {
    /// Creates a dome of a radius with the radiance of its bottom and of its top.
    pub fn new(radius: f32, bottom: impl Into<Rgb>, top: impl Into<Rgb>) -> Self {
        Self { radius, bottom: bottom.into(), top: top.into() }
    }

    /// Sky as seen from the origin, where heights are those of directions.
    fn elevation_gradient(&self) -> ElevationGradient {
        let half = |end: Rgb| Hemisphere { base: self.bottom, end, squared: false };
        ElevationGradient { axis: Vec3::Y, upper: half(self.top), lower: half(self.bottom) }
    }
}

impl Background for Dome {
    fn check(&self) -> Result<(), InvalidBackground> {
        check_color("bottom", self.bottom)?;
        check_color("top", self.top)?;
        if self.radius > 0.0 && self.radius.is_finite() {
            return Ok(());
        }
        Err(InvalidBackground { field: "radius", message: format!("`radius` must be above 0, it is {}", self.radius) })
    }

    fn radiance(&self, ray: &Ray) -> Rgb {
        // Solve |origin + t direction|² = 1 in units of the radius, for the larger root.
        let origin = ray.origin / self.radius;
        let along = origin.dot(ray.direction);
        let discriminant = (along * along + 1.0 - origin.length_squared()).max(0.0);
        let height = origin.y + ray.direction.y * (discriminant.sqrt() - along);
        // Map NaN, from infinite origins, to 0.
        self.bottom.lerp(self.top, if height > 0.0 { height.min(1.0) } else { 0.0 })
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
impl Dome {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        vec![Self::default(), Self { radius: 3.0, ..Self::default() }]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::testing::{Random, close};

    #[test]
    fn dome_color_is_that_of_the_point_on_its_sphere() {
        let dome = Dome { radius: 3.0, bottom: Rgb::BLACK, top: Rgb::WHITE };
        let mut random = Random::new(101);
        for _ in 0..2000 {
            let ray = random.ray(1.7);
            let height = dome.radiance(&ray).r * 3.0;
            // Find the sphere by bisection.
            let (mut inside, mut outside) = (0.0f32, 10.0f32);
            for _ in 0..40 {
                let middle = (inside + outside) * 0.5;
                if ray.at(middle).length() < 3.0 { inside = middle } else { outside = middle }
            }
            assert!(close(height, ray.at(inside).y.max(0.0), 1e-5), "{ray:?}");
        }
    }

    #[test]
    fn far_domes_look_the_same_from_everywhere_near() {
        let dome = Dome { bottom: Rgb::BLACK, top: Rgb::WHITE, ..Dome::default() };
        let direction = Vec3::new(0.6, 0.8, 0.0);
        let near = dome.radiance(&Ray::new(Vec3::new(2.0, 100.0, -2.0), direction)).r;
        assert!((near - 0.8).abs() < 2e-4, "{near}");
        assert_eq!(dome.radiance(&Ray::new(Vec3::ZERO, Vec3::NEG_Y)), Rgb::BLACK);
        assert_eq!(dome.radiance(&Ray::new(Vec3::ZERO, Vec3::Y)), Rgb::WHITE);
    }
}
