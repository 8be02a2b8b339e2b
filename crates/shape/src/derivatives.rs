//! How a surface runs along its coordinates: what tangents and footprints are made of, worked out only when asked for.

use juggler_math::{Transform, Vec3};
use std::f32::consts::TAU;

/// ∂p/∂u and ∂p/∂v: how far, and which way, the point moves for one unit of a surface coordinate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Derivatives {
    /// Along u; need not be unit.
    pub u: Vec3,
    /// Along v; need not be unit, nor at a right angle to `u`.
    pub v: Vec3,
}

impl Derivatives {
    /// Nothing where they do not span the surface: at poles, in triangles whose coordinates lie on one line.
    pub fn new(u: Vec3, v: Vec3) -> Option<Self> {
        let found = Self { u, v };
        (found.stretch() > 0.0 && found.stretch().is_finite()).then_some(found)
    }

    /// The same seen through a transform.
    pub fn through(&self, transform: &Transform) -> Self {
        Self { u: transform.vector(self.u), v: transform.vector(self.v) }
    }

    /// How long a unit of the coordinates is: the root of the area that a unit square of them covers.
    pub fn stretch(&self) -> f32 {
        // Scaled first: areas of very large and small things leave the range of numbers.
        let scale = self.u.abs().max_element().max(self.v.abs().max_element());
        let area = (self.u / scale).cross(self.v / scale).length();
        if scale > 0.0 && area > 0.0 { scale * area.sqrt() } else { 0.0 }
    }
}

/// ∂p/∂u about the y axis, where u is the fraction of a turn from +x over -z.
pub fn about_y(p: Vec3) -> Vec3 {
    Vec3::new(p.z, 0.0, -p.x) * TAU
}

/// Of a disk about the y axis: v is 0 at its rim, and 1 `width` further in.
pub fn of_disk(p: Vec3, width: f32) -> Option<Derivatives> {
    Derivatives::new(about_y(p), -Vec3::new(p.x, 0.0, p.z).normalize_or_zero() * width)
}
