//! A surface that emits light: a rectangle, a disk or a sphere.
//!
//! ```json
//! {"area": {"shape": {"rectangle": {"size": [1.2, 0.6]}}, "position": [0, 2.4, 0],
//!     "direction": [0, -1, 0], "power": 60}}
//! ```
//!
//! The front emits the same radiance L from every point in every direction (a Lambertian emitter).
//! A front of area A then emits the radiant flux Φ = π A L, so `power` gives L = Φ / (π A) (PBR 4th
//! ed., section 12.4). Path tracing samples the light like an `emissive` shape, and camera rays and
//! reflected rays hit it. The classic integrator samples it too, with the same irradiance on
//! surfaces.

use super::{InvalidLight, Light, LightSample, check_direction, check_exclusive, check_position, strength::Strength};
use crate::emitter::{AreaEmitter, DiskEmitter, LightBounds, RectangleEmitter, SphereEmitter};
use juggler_math::{Mat3, Rgb, Transform, Vec2, Vec3};
use juggler_shape::{AnyShape, Disk, Rectangle, Sphere};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f32::consts::PI;

/// A surface that emits light from its front. The camera sees it; its back is black.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Area {
    /// Form and size of the surface.
    pub shape: AreaShape,
    /// Center of the surface, world space.
    #[schemars(with = "[f32; 3]", extend("x-unit" = "scene units"))]
    pub position: Vec3,
    /// Direction that the front faces, of any length. Without it and without `look_at`, the front
    /// faces straight down. A sphere has no front.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<[f32; 3]>")]
    pub direction: Option<Vec3>,
    /// Point that the front faces, in world space; replaces `direction`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<[f32; 3]>", extend("x-unit" = "scene units"))]
    pub look_at: Option<Vec3>,
    /// Color of the light, linear RGB; a factor on `radiance` or `power`.
    pub color: Rgb,
    /// Radiance of the front in watts per square scene unit and steradian, times `color`. It
    /// determines how bright the surface looks. The default is 1, unless `power` is given.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0, max = 1e30), extend("x-unit" = "W/(scene unit² sr)"))]
    pub radiance: Option<f32>,
    /// Radiant flux of the whole surface in watts per channel, times `color`; replaces `radiance`.
    /// At the same power, a larger surface has a lower radiance.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0, max = 1e30), extend("x-unit" = "W"))]
    pub power: Option<f32>,
    /// Light group; the light of each group is written to its own AOV.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub light_group: Option<String>,
}

/// Form and size of a surface that emits light.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum AreaShape {
    /// A rectangle that emits to one side.
    Rectangle {
        /// Width and height in scene units. The width is horizontal.
        #[schemars(extend("items" = {"type": "number", "format": "float", "exclusiveMinimum": 0}))]
        #[schemars(extend("x-unit" = "scene units"))]
        size: [f32; 2],
    },
    /// A disk that emits to one side.
    Disk {
        /// Radius in scene units.
        #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "scene units"))]
        radius: f32,
    },
    /// A sphere that emits outwards.
    Sphere {
        /// Radius in scene units.
        #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "scene units"))]
        radius: f32,
    },
}

impl Default for AreaShape {
    fn default() -> Self {
        Self::Rectangle { size: [1.0, 1.0] }
    }
}

impl Default for Area {
    fn default() -> Self {
        Self {
            shape: AreaShape::default(),
            position: Vec3::ZERO,
            direction: None,
            look_at: None,
            color: Rgb::WHITE,
            radiance: None,
            power: None,
            light_group: None,
        }
    }
}

impl AreaShape {
    /// Shape centered at the origin with its front along +Y.
    pub fn shape(self) -> AnyShape {
        match self {
            Self::Rectangle { size } => Rectangle { size }.into(),
            Self::Disk { radius } => Disk { radius, inner_radius: 0.0 }.into(),
            Self::Sphere { radius } => Sphere { radius }.into(),
        }
    }

    /// Area of the front in square scene units.
    fn area(self) -> f32 {
        match self {
            Self::Rectangle { size: [width, height] } => width * height,
            Self::Disk { radius } => PI * radius * radius,
            Self::Sphere { radius } => 4.0 * PI * radius * radius,
        }
    }

    /// Radius of the bounding sphere.
    fn bounding_radius(self) -> f32 {
        match self {
            Self::Rectangle { size: [width, height] } => 0.5 * (width * width + height * height).sqrt(),
            Self::Disk { radius } | Self::Sphere { radius } => radius,
        }
    }

    fn check(self) -> Result<(), InvalidLight> {
        let (field, sizes) = match self {
            Self::Rectangle { size } => ("shape.rectangle.size", size),
            Self::Disk { radius } => ("shape.disk.radius", [radius; 2]),
            Self::Sphere { radius } => ("shape.sphere.radius", [radius; 2]),
        };
        let name = field.rsplit('.').next().unwrap_or(field);
        // Keep the area and its inverse in a range from which a radiance can be computed.
        let fits = sizes.iter().all(|size| *size > 0.0) && self.area() >= 1e-30 && self.area() <= 1e30;
        let message = || format!("`{name}` must be above 0, and neither too small nor too large for an area");
        if fits { Ok(()) } else { Err(InvalidLight { field, message: message() }) }
    }
}

impl Area {
    /// Creates a white area light of a radiance around a position. Its front faces down.
    pub fn new(shape: AreaShape, position: impl Into<Vec3>, radiance: f32) -> Self {
        Self { shape, position: position.into(), radiance: Some(radiance), ..Self::default() }
    }

    /// Radiance of the front per channel.
    pub fn radiance(&self) -> Rgb {
        let of_power = |power: f32| power / (PI * self.shape.area());
        self.color * self.power.map_or(self.radiance.unwrap_or(1.0), of_power)
    }

    /// Shape in object space and its transform to world space; `None` for an area light that
    /// [`Light::check`] rejects.
    pub fn shape_and_transform(&self) -> Option<(AnyShape, Transform)> {
        let normal = self.normal()?;
        // Keep the width horizontal.
        let side = Vec3::Y.cross(normal).try_normalize().unwrap_or(Vec3::X);
        let rotation = Mat3::from_cols(side, normal, side.cross(normal));
        Some((self.shape.shape(), Transform::new(rotation, self.position)?))
    }

    /// Unit normal of the front.
    fn normal(&self) -> Option<Vec3> {
        let towards = self.look_at.map(|point| point - self.position);
        towards.or(self.direction).unwrap_or(Vec3::NEG_Y).as_dvec3().try_normalize().map(|normal| normal.as_vec3())
    }

    fn emitter(&self) -> Option<AreaEmitter> {
        let normal = self.normal()?;
        Some(match self.shape {
            AreaShape::Rectangle { size: [width, height] } => {
                let (_, transform) = self.shape_and_transform()?;
                let (along, up) = (transform.vector(Vec3::X * width), transform.vector(Vec3::NEG_Z * height));
                RectangleEmitter::new(self.position - (along + up) * 0.5, [along, up])?.into()
            }
            AreaShape::Disk { radius } => DiskEmitter::new(self.position, normal, radius)?.into(),
            AreaShape::Sphere { radius } => SphereEmitter::new(self.position, radius)?.into(),
        })
    }
}

impl Light for Area {
    fn check(&self) -> Result<(), InvalidLight> {
        self.shape.check()?;
        check_position(self.position)?;
        if let Some(direction) = self.direction {
            check_direction(direction)?;
        }
        if let Some(point) = self.look_at {
            let towards = (point - self.position).length_squared();
            let usable = (f32::MIN_POSITIVE..f32::INFINITY).contains(&towards);
            let message = || "`look_at` must be finite and differ from `position`".to_owned();
            usable.then_some(()).ok_or_else(|| InvalidLight { field: "look_at", message: message() })?;
        }
        check_exclusive(("look_at", self.look_at.is_some()), ("direction", self.direction.is_some()))?;
        let strength = Strength { field: "radiance", value: self.radiance, power: self.power };
        strength.check(self.color, self.radiance())
    }

    fn sample(&self, from: Vec3, u: Vec2) -> Option<LightSample> {
        let sample = self.emitter()?.sample(from, u)?;
        let radiance = self.radiance() / sample.pdf;
        let arrives = sample.normal.dot(sample.wi) < 0.0 && radiance.is_finite() && !radiance.is_black();
        arrives.then_some(LightSample { wi: sample.wi, distance: sample.distance, radiance, pdf: 1.0 })
    }

    fn is_delta(&self) -> bool {
        false
    }

    fn is_surface(&self) -> bool {
        true
    }

    fn bounding_sphere(&self) -> Option<(Vec3, f32)> {
        Some((self.position, self.shape.bounding_radius()))
    }

    fn bounds(&self, _world_radius: f32) -> Option<LightBounds> {
        Some(self.emitter()?.light_bounds(self.radiance().luminance(), false))
    }

    fn light_group(&self) -> Option<&str> {
        self.light_group.as_deref()
    }

    fn light_group_mut(&mut self) -> Option<&mut Option<String>> {
        Some(&mut self.light_group)
    }

    fn area(&self) -> Option<&Area> {
        Some(self)
    }

    fn power(&self, _world_radius: f32) -> f32 {
        PI * self.shape.area() * self.radiance().luminance()
    }
}

#[cfg(any(test, feature = "testing"))]
impl Area {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        let ceiling = Self { position: Vec3::new(0.5, 2.4, -1.0), power: Some(60.0), ..Self::default() };
        let window = Self {
            shape: AreaShape::Disk { radius: 0.5 },
            position: Vec3::new(-3.0, 1.0, 0.0),
            look_at: Some(Vec3::new(0.0, 0.5, 1.0)),
            color: Rgb::new(1.0, 0.5, 0.25),
            radiance: Some(4.0),
            ..Self::default()
        };
        let globe = Self { shape: AreaShape::Sphere { radius: 0.5 }, power: Some(10.0), ..Self::default() };
        vec![Self { shape: AreaShape::Rectangle { size: [1.2, 0.6] }, ..Self::default() }, ceiling, window, globe]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::testing::Random;

    #[test]
    fn area_light_faces_its_direction_with_horizontal_width() {
        let facing = |area: &Area| area.shape_and_transform().unwrap().1.normal(Vec3::Y);
        assert_eq!(facing(&Area::default()), Vec3::NEG_Y);
        let along = Area { direction: Some(Vec3::new(0.0, 0.0, 5.0)), ..Area::default() };
        assert_eq!(facing(&along), Vec3::Z);
        let position = Vec3::new(1.0, 2.0, 3.0);
        let at = Area { position, look_at: Some(Vec3::new(1.0, -2.0, 0.0)), ..Area::default() };
        assert!((facing(&at) - Vec3::new(0.0, -0.8, -0.6)).length() < 1e-6);
        let transform = at.shape_and_transform().unwrap().1;
        assert!(transform.vector(Vec3::X).y.abs() < 1e-6 && (transform.matrix().determinant() - 1.0).abs() < 1e-6);
        assert_eq!(transform.point(Vec3::ZERO), position);
    }

    #[test]
    fn area_light_does_not_illuminate_points_behind_it() {
        let (ceiling, mut random) = (Area { position: Vec3::Y, ..Area::default() }, Random::new(71));
        for _ in 0..1000 {
            assert_eq!(ceiling.sample(Vec3::new(0.3, 1.5, 0.1), random.vec2()), None);
            assert!(ceiling.sample(Vec3::new(0.3, 0.5, 0.1), random.vec2()).is_some());
        }
    }

    /// Irradiance below the center of a square of side 2 at distance 1: 4 L (x / √(1 + x²)) atan(1
    /// / √(1 + x²)) with x = 1, the sum of four corner configuration factors.
    #[test]
    fn irradiance_under_a_square_is_the_closed_form() {
        let shape = AreaShape::Rectangle { size: [2.0, 2.0] };
        let ceiling = Area { shape, position: Vec3::Y, radiance: Some(3.0), ..Area::default() };
        let (mut random, count, mut sum) = (Random::new(72), 200_000, 0.0f64);
        for _ in 0..count {
            let sample = ceiling.sample(Vec3::ZERO, random.vec2()).unwrap();
            sum += f64::from(sample.radiance.g * sample.wi.y);
        }
        let (x, root) = (1.0f64, 2f64.sqrt());
        let expected = 3.0 * 4.0 * (x / root) * (1.0 / root).atan();
        assert!((sum / f64::from(count) / expected - 1.0).abs() < 3e-3, "{sum} {expected}");
    }
}
