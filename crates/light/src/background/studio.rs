//! Photo studio: a bright dome with four soft boxes, for objects whose file brings no light.
//!
//! ```json
//! {"studio": {"scale": 1, "rotation_degrees": 0, "up": [0, 1, 0], "visible_as": [0.9, 0.9, 0.9]}}
//! ```
//!
//! The front is +Z, where cameras of products stand, and the left is -X. The key light stands in
//! front at the left, the fill light at the right, the rim light behind, and one box hangs above.
//! At a `scale` of 1 the irradiance of a surface that faces `up` is π, so that white paper there
//! has the radiance 1.
//!
//! Directions are importance-sampled by a table of the luminance above its mean, as those of
//! environment maps.

use super::direction_table::{DirectionTable, direction};
use super::orientation::{Orientation, check_direction, in_range};
use super::{Background, BackgroundSample, InvalidBackground, check_color};
use juggler_math::{MAX_LIGHT, Ray, Rgb, Vec2, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::LazyLock;

/// Photo studio: a bright dome with four soft boxes, which lights an object well from all sides.
/// Its front, where the camera usually stands, is +Z.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Studio {
    /// Factor on the radiance. At 1, a white surface that faces up has the radiance 1.
    #[schemars(range(min = 0, max = 1e28))]
    pub scale: f32,
    /// Rotation about the vertical axis in degrees, from -10,000 to 10,000, counterclockwise as
    /// seen from above.
    #[schemars(range(min = -10000, max = 10000), extend("x-unit" = "degrees"))]
    pub rotation_degrees: f32,
    /// Direction of the studio's top in world space, of any length.
    #[schemars(with = "[f32; 3]")]
    pub up: Vec3,
    /// Radiance that camera rays see instead, also through masks and through clear or rough glass
    /// without reflection inside. All other rays see the studio itself. By default camera rays see
    /// it, too.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "W/(scene unit² sr)"))]
    pub visible_as: Option<Rgb>,
    /// Rotation computed by [`Background::prepare`].
    #[serde(skip)]
    orientation: Orientation,
}

impl Default for Studio {
    fn default() -> Self {
        let (visible_as, orientation) = (None, Orientation::default());
        Self { scale: 1.0, rotation_degrees: 0.0, up: Vec3::Y, visible_as, orientation }
    }
}

/// Rectangle of light in the directions around its center, as wide and high as on a plane at
/// distance 1.
struct SoftBox {
    center: Vec3,
    right: Vec3,
    top: Vec3,
    /// Tangents of half the angles across and up.
    half: Vec2,
    radiance: f32,
}

/// Width of the smoothed edges of soft boxes, on a plane at distance 1.
const EDGE: f32 = 0.08;
/// Radiance of the dome at the bottom and at the top.
const DOME: [f32; 2] = [0.3, 0.8];

impl SoftBox {
    /// Box around `center`, of the angles with these half tangents; `top` leads to its upper edge.
    fn new(center: Vec3, top: Vec3, half: Vec2, radiance: f32) -> Self {
        let center = center.normalize();
        let right = center.cross(top).normalize();
        Self { center, right, top: right.cross(center), half, radiance }
    }

    /// Share of the box in a direction, 0 to 1.
    fn share(&self, direction: Vec3) -> f32 {
        let depth = direction.dot(self.center);
        if depth <= 0.1 {
            return 0.0;
        }
        let inside = |at: f32, half: f32| {
            let x = ((half - (at / depth).abs()) / EDGE + 0.5).clamp(0.0, 1.0);
            x * x * (3.0 - 2.0 * x)
        };
        inside(direction.dot(self.right), self.half.x) * inside(direction.dot(self.top), self.half.y)
    }
}

/// Lights of the studio in local space, and their sampling table.
struct Room {
    boxes: [SoftBox; 4],
    /// Factor that makes the irradiance from above π.
    factor: f32,
    /// Mean radiance over all directions, with the factor.
    mean: f32,
    directions: Option<DirectionTable>,
}

static ROOM: LazyLock<Room> = LazyLock::new(Room::new);

/// Rows and columns of the sampling table, and of the points in each cell.
const ROWS: usize = 72;
const COLUMNS: usize = 144;
const POINTS: usize = 4;

impl Room {
    fn new() -> Self {
        // The tangents of half of 60, 40, 50, 70, 24 and 80 degrees.
        let boxes = [
            SoftBox::new(Vec3::new(-0.7, 0.8, 0.8), Vec3::Y, Vec2::new(0.577, 0.364), 6.0),
            SoftBox::new(Vec3::new(1.0, 0.35, 0.45), Vec3::Y, Vec2::new(0.466, 0.7), 2.0),
            SoftBox::new(Vec3::new(0.35, 0.55, -1.0), Vec3::Y, Vec2::new(0.839, 0.213), 8.0),
            SoftBox::new(Vec3::Y, Vec3::NEG_Z, Vec2::new(0.7, 0.577), 4.0),
        ];
        let mut room = Self { boxes, factor: 1.0, mean: 0.0, directions: None };
        // Integrate the radiance and the irradiance from above on a grid of equal solid angle.
        let (rows, columns) = (ROWS * POINTS, COLUMNS * POINTS);
        let mut cells = vec![0.0; ROWS * COLUMNS];
        let (mut sum, mut irradiance) = (0.0, 0.0);
        for row in 0..rows {
            let height = 1.0 - 2.0 * (row as f64 + 0.5) / rows as f64;
            for column in 0..columns {
                let azimuth = (column as f32 + 0.5) / columns as f32;
                let radiance = room.radiance(direction(azimuth, height));
                sum += f64::from(radiance);
                irradiance += f64::from(radiance) * height.max(0.0);
                if let Some(cell) = cells.get_mut(row / POINTS * COLUMNS + column / POINTS) {
                    *cell += radiance / (POINTS * POINTS) as f32;
                }
            }
        }
        let count = (rows * columns) as f64;
        let mean = sum / count;
        let weights: Vec<f32> = cells.iter().map(|v| (v - mean as f32).max(0.0) + 0.1 * v).collect();
        room.directions = DirectionTable::new(COLUMNS, DirectionTable::equal_heights(ROWS), &weights);
        // The irradiance is 4π times the mean of radiance and cosine.
        room.factor = (0.25 * count / irradiance) as f32;
        room.mean = mean as f32 * room.factor;
        room
    }

    /// Radiance in a local direction.
    fn radiance(&self, direction: Vec3) -> f32 {
        let [bottom, top] = DOME;
        let dome = bottom + (top - bottom) * (0.5 * direction.y + 0.5).clamp(0.0, 1.0);
        let radiance = self.boxes.iter().fold(dome, |below, light| {
            let share = light.share(direction);
            below + (light.radiance - below) * share
        });
        radiance * self.factor
    }
}

impl Background for Studio {
    fn check(&self) -> Result<(), InvalidBackground> {
        in_range("scale", self.scale, 0.0, MAX_LIGHT * 0.01)?;
        in_range("rotation_degrees", self.rotation_degrees, -1e4, 1e4)?;
        check_direction("up", self.up)?;
        self.visible_as.map_or(Ok(()), |color| check_color("visible_as", color))
    }

    fn prepare(&mut self) -> Result<(), InvalidBackground> {
        self.check()?;
        self.orientation = Orientation::new(self.up, self.rotation_degrees);
        Ok(())
    }

    fn radiance(&self, ray: &Ray) -> Rgb {
        Rgb::splat(ROOM.radiance(self.orientation.to_local(ray.direction)) * self.scale)
    }

    fn visible_as(&self) -> Option<Rgb> {
        self.visible_as
    }

    fn sample(&self, u: Vec2) -> Option<BackgroundSample> {
        let (local, pdf) = ROOM.directions.as_ref().filter(|_| self.scale > 0.0)?.sample(u)?;
        Some(BackgroundSample { wi: self.orientation.to_world(local), pdf })
    }

    fn pdf(&self, direction: Vec3) -> f32 {
        let directions = ROOM.directions.as_ref().filter(|_| self.scale > 0.0);
        directions.map_or(0.0, |directions| directions.pdf(self.orientation.to_local(direction)))
    }

    fn mean_radiance(&self) -> Rgb {
        Rgb::splat(ROOM.mean * self.scale)
    }
}

#[cfg(any(test, feature = "testing"))]
#[allow(clippy::unwrap_used, reason = "examples for tests")]
impl Studio {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        let up = Vec3::new(0.3, -0.2, 2.0);
        let visible_as = Some(Rgb::new(0.9, 0.5, 0.2));
        let mut turned = Self { scale: 2.5, rotation_degrees: 77.0, up, visible_as, ..Self::default() };
        turned.prepare().unwrap();
        vec![Self::default(), turned]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::testing::Random;

    #[test]
    fn irradiance_from_above_is_pi() {
        let mut random = Random::new(711);
        for studio in Studio::examples() {
            let (top, count) = (studio.orientation.to_world(Vec3::Y), 1_000_000);
            let value = |wi: Vec3, pdf: f32| {
                let light = studio.radiance(&Ray::new(Vec3::ZERO, wi)).g;
                f64::from(light * wi.dot(top).max(0.0) / pdf)
            };
            let sum: f64 = (0..count)
                .map(|_| studio.sample(random.vec2()).map_or(0.0, |sample| value(sample.wi, sample.pdf)))
                .sum();
            let expected = std::f64::consts::PI * f64::from(studio.scale);
            assert!((sum / f64::from(count) / expected - 1.0).abs() < 3e-3, "{studio:?}: {sum}");
        }
    }

    #[test]
    fn boxes_stand_at_their_places() {
        let studio = Studio::default();
        let at = |x: f32, y: f32, z: f32| {
            studio.radiance(&Ray::new(Vec3::ZERO, Vec3::new(x, y, z).normalize())).g / ROOM.factor
        };
        for (found, expected) in [
            (at(-0.7, 0.8, 0.8), 6.0),
            (at(1.0, 0.35, 0.45), 2.0),
            (at(0.35, 0.55, -1.0), 8.0),
            (at(0.0, 1.0, 0.0), 4.0),
            (at(0.0, -1.0, 0.0), 0.3),
            (at(0.0, 0.0, 1.0), 0.55),
        ] {
            assert!((found - expected).abs() < 1e-4, "{found} {expected}");
        }
    }
}
