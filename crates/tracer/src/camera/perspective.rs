//! A pinhole camera.

use super::{Camera, InvalidCamera, Projection};
use juggler_math::{UVec2, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A pinhole camera.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Perspective {
    /// Where it stands.
    #[schemars(with = "[f32; 3]")]
    pub eye: Vec3,
    /// What it looks at.
    #[schemars(with = "[f32; 3]")]
    pub look_at: Vec3,
    /// Vertical field of view.
    pub vertical_fov_degrees: f32,
}

impl Default for Perspective {
    fn default() -> Self {
        Self { eye: Vec3::new(0.0, 0.0, 5.0), look_at: Vec3::ZERO, vertical_fov_degrees: 40.0 }
    }
}

impl Camera for Perspective {
    fn project(&self, size: UVec2) -> Result<Projection, InvalidCamera> {
        let w = (self.eye - self.look_at).normalize();
        let u = Vec3::Y.cross(w).normalize();
        let v = w.cross(u);
        let (sin, cos) = juggler_math::fun::sin_cos(self.vertical_fov_degrees.to_radians() * 0.5);
        let pixel = 2.0 * sin / cos / size.y as f32;
        let (right, down) = (u * pixel, v * -pixel);
        let corner = -w - right * (size.x as f32 * 0.5) - down * (size.y as f32 * 0.5);
        Ok(Projection { origin: self.eye, corner, right, down })
    }
}

#[cfg(test)]
impl Perspective {
    /// For the contract tests.
    pub fn examples() -> Vec<Self> {
        vec![Self::default()]
    }
}
