//! Orientation of a sky in the world: its up direction and its azimuth.

use super::InvalidBackground;
use juggler_math::{Vec3, portable, range};

/// Rotation from a sky's local space, with +Y up, to world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Orientation {
    x: Vec3,
    y: Vec3,
    z: Vec3,
}

impl Default for Orientation {
    fn default() -> Self {
        Self { x: Vec3::X, y: Vec3::Y, z: Vec3::Z }
    }
}

impl Orientation {
    /// Creates a rotation by `degrees` about +Y, counterclockwise as seen from above, followed by
    /// the shortest rotation from +Y to `up`. An `up` of zero length counts as +Y.
    pub fn new(up: Vec3, degrees: f32) -> Self {
        let y = up.try_normalize().unwrap_or(Vec3::Y);
        let (sin, cos) = portable::sin_cos(degrees.to_radians());
        let axis = Vec3::Y.cross(y);
        let rotate = |v: Vec3| {
            if y.y < -0.9999 {
                // Half a turn about x; near -Y any perpendicular axis is valid.
                Vec3::new(v.x, 0.0, -v.z)
            } else {
                v * y.y + axis.cross(v) + axis * (axis.dot(v) / (1.0 + y.y))
            }
        };
        let z = rotate(Vec3::new(sin, 0.0, cos));
        let z = (z - y * z.dot(y)).normalize();
        Self { x: y.cross(z), y, z }
    }

    /// Transforms a vector from world to local space.
    pub fn to_local(self, v: Vec3) -> Vec3 {
        Vec3::new(v.dot(self.x), v.dot(self.y), v.dot(self.z))
    }

    /// Transforms a vector from local to world space.
    pub fn to_world(self, v: Vec3) -> Vec3 {
        self.x * v.x + self.y * v.y + self.z * v.z
    }
}

/// Rejects a direction of zero or infinite length.
pub(super) fn check_direction(field: &'static str, direction: Vec3) -> Result<(), InvalidBackground> {
    let squared = direction.length_squared();
    if squared >= f32::MIN_POSITIVE && squared.is_finite() {
        return Ok(());
    }
    let message = format!("`{field}` must have a finite length above 0; it is {direction}");
    Err(InvalidBackground { field, message })
}

/// Rejects numbers outside `low..=high` and NaN.
pub(super) fn in_range(field: &'static str, value: f32, low: f32, high: f32) -> Result<(), InvalidBackground> {
    let wrong = range::range_error(field, value, low, high);
    wrong.map_or(Ok(()), |message| Err(InvalidBackground { field, message }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::testing::{Random, close3};

    #[test]
    fn turns_are_rotations_that_take_the_top_up() {
        let mut random = Random::new(1201);
        let poles = [Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::new(1e-3, -1.0, 2e-3), Vec3::new(0.02, -1.0, 0.0)];
        for up in (0..200).map(|_| random.unit_vector() * 3.0).chain(poles).collect::<Vec<_>>() {
            let orientation = Orientation::new(up, random.range(-400.0, 400.0));
            assert!(close3(orientation.to_world(Vec3::Y), up.normalize(), 1e-6), "{up}");
            let v = random.unit_vector();
            assert!(close3(orientation.to_local(orientation.to_world(v)), v, 1e-5), "{up}");
            let [x, y, z] = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| orientation.to_world(axis));
            assert!(close3(x.cross(y), z, 1e-5), "{up}");
        }
        let quarter = Orientation::new(Vec3::Y, 90.0);
        assert!(close3(quarter.to_world(Vec3::Z), Vec3::X, 1e-6) && close3(quarter.to_world(Vec3::X), -Vec3::Z, 1e-6));
        // Shortest rotation: from +Y to +Z about +X.
        assert!(close3(Orientation::new(Vec3::Z, 0.0).to_world(Vec3::X), Vec3::X, 1e-6));
    }
}
