//! Where a ray met a surface, seen once per path vertex and never while traversing.

use juggler_math::{Ray, Transform, Vec2, Vec3, robust};

/// A point on a surface. Shapes make it in object space; the world turns it into world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// The point, pulled back onto the surface after rounding.
    pub point: Vec3,
    /// Bound on the rounding error of each coordinate of `point`.
    pub error: f32,
    /// Unit normal of the true surface, outwards (for flat shapes: their stated front).
    pub normal: Vec3,
    /// Unit normal that shading uses; equals `normal` unless a mesh brings its own.
    pub shading_normal: Vec3,
    /// Surface coordinates; the range is each shape's to say.
    pub uv: Vec2,
    /// The point in object space, for textures that stick to the object.
    pub local: Vec3,
}

impl Surface {
    /// An exact point with one normal.
    pub fn new(point: Vec3, error: f32, normal: Vec3, uv: Vec2) -> Self {
        Self { point, error, normal, shading_normal: normal, uv, local: point }
    }

    /// The same point in world space.
    pub fn to_world(&self, transform: &Transform) -> Self {
        let point = transform.point(self.point);
        let rounding = robust::gamma(4) * (point.abs().max_element() + transform.origin().abs().max_element());
        let normal = transform.normal(self.normal);
        let shading_normal =
            if self.shading_normal == self.normal { normal } else { transform.normal(self.shading_normal) };
        Self {
            point,
            error: self.error * transform.max_stretch() + rounding,
            normal,
            shading_normal,
            uv: self.uv,
            local: self.local,
        }
    }

    /// A ray without end from here, free of this surface.
    pub fn spawn(&self, direction: Vec3, time: f32) -> Ray {
        let origin = robust::offset_origin(self.point, self.error, self.normal, direction);
        Ray { time, ..Ray::new(origin, direction) }
    }
}
