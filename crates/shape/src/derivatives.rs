//! Derivatives of position by surface coordinates, for tangents and footprints; computed on demand.

use juggler_math::{Transform, Vec3};
use std::f32::consts::TAU;

/// ∂p/∂u and ∂p/∂v: displacement of the point for one unit of a surface coordinate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceDerivatives {
    /// ∂p/∂u; need not be unit.
    pub u: Vec3,
    /// ∂p/∂v; need not be unit, nor orthogonal to `u`.
    pub v: Vec3,
}

impl SurfaceDerivatives {
    /// `None` where the derivatives do not span the surface: at poles, or in triangles whose
    /// surface coordinates are collinear.
    pub fn new(u: Vec3, v: Vec3) -> Option<Self> {
        let found = Self { u, v };
        (found.unit_length() > 0.0 && found.unit_length().is_finite()).then_some(found)
    }

    /// Applies a transform.
    pub fn transformed(&self, transform: &Transform) -> Self {
        Self { u: transform.vector(self.u), v: transform.vector(self.v) }
    }

    /// Length of a coordinate unit: the square root of the area that a unit square of coordinates
    /// covers.
    pub fn unit_length(&self) -> f32 {
        // Scale first: areas of very large and small shapes leave the range of floats.
        let scale = self.u.abs().max_element().max(self.v.abs().max_element());
        let area = (self.u / scale).cross(self.v / scale).length();
        if scale > 0.0 && area > 0.0 { scale * area.sqrt() } else { 0.0 }
    }
}

/// ∂p/∂u around the y axis, where u is the fraction of a turn from +x towards -z.
pub fn dpdu_about_y(p: Vec3) -> Vec3 {
    Vec3::new(p.z, 0.0, -p.x) * TAU
}

/// Derivatives of a disk around the y axis: v is 0 at its rim, and 1 at `width` further in.
pub fn disk_derivatives(p: Vec3, width: f32) -> Option<SurfaceDerivatives> {
    SurfaceDerivatives::new(dpdu_about_y(p), -Vec3::new(p.x, 0.0, p.z).normalize_or_zero() * width)
}
