//! Surface where a ray hits, computed once per path vertex and not during traversal.

use juggler_math::{Ray, Transform, Vec2, Vec3, robust};

/// Point on a surface with its local geometry. Shapes return it in object space; the world
/// transforms it to world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// The point, moved back onto the surface after rounding.
    pub point: Vec3,
    /// Distance from `point`, along `normal`, at which a ray that leaves must start to be off the
    /// surface: bounds the distance between `point` and the exact surface, and the rounding of
    /// intersections.
    pub position_error: f32,
    /// Unit normal of the exact surface, outwards; for flat shapes, towards their front.
    pub normal: Vec3,
    /// Unit normal for shading, on the same side; equals `normal` unless the shape has shading
    /// normals.
    pub shading_normal: Vec3,
    /// Surface coordinates; each shape documents their range.
    pub uv: Vec2,
    /// The point in object space, for textures in object space.
    pub local: Vec3,
    /// `shading_normal` in object space, for such textures.
    pub local_normal: Vec3,
    /// Footprint of the ray, for texture filtering; a point by default.
    pub footprint: Footprint,
    /// Barycentrics of the second and third corner of a triangle, for [`MeshPoint`]; zero on other
    /// shapes.
    ///
    /// [`MeshPoint`]: crate::MeshPoint
    pub barycentrics: Vec2,
}

/// Diameters of the patch of a surface that a ray covers; 0 for a point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Footprint {
    /// Diameter in world units.
    pub world: f32,
    /// Diameter in units of object space.
    pub local: f32,
    /// Diameter in units of the surface coordinates.
    pub uv: f32,
}

/// Derivatives of position by surface coordinates, for normal maps and anisotropic highlights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tangents {
    /// ∂p/∂u, world space; need not be unit.
    pub u: Vec3,
    /// ∂p/∂v, world space; need not be unit, nor orthogonal to `u`.
    pub v: Vec3,
    /// ∂p/∂u in object space.
    pub local_u: Vec3,
    /// ∂p/∂v in object space.
    pub local_v: Vec3,
    /// Tangent that the mesh gives, for normal maps and anisotropic highlights in place of `u` and
    /// `v`.
    pub given: Option<GivenTangent>,
}

/// Tangent of a mesh in world space, with the side of its bitangent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GivenTangent {
    /// Tangent; need not be unit, nor orthogonal to the normal.
    pub along: Vec3,
    /// Sign of the bitangent: 1 on the side of normal × tangent, otherwise -1.
    pub sign: f32,
}

impl Surface {
    /// Surface whose shading normal is its normal.
    #[inline]
    pub fn new(point: Vec3, position_error: f32, normal: Vec3, uv: Vec2) -> Self {
        let footprint = Footprint::default();
        Self {
            point,
            position_error,
            normal,
            shading_normal: normal,
            uv,
            local: point,
            local_normal: normal,
            footprint,
            barycentrics: Vec2::ZERO,
        }
    }

    /// Transforms the surface to world space.
    #[inline]
    pub fn to_world(&self, transform: &Transform) -> Self {
        let point = transform.point(self.point);
        let normal = transform.normal(self.normal);
        let shading_normal =
            if self.shading_normal == self.normal { normal } else { transform.normal(self.shading_normal) };
        // Scale of distances along the normal.
        let stretch = transform.vector(self.normal).dot(normal).abs();
        Self {
            point,
            position_error: (self.position_error + f32::MIN_POSITIVE) * stretch
                + self.rounding(transform, point, normal, stretch),
            normal,
            shading_normal,
            uv: self.uv,
            local: self.local,
            local_normal: self.local_normal,
            footprint: self.footprint,
            barycentrics: self.barycentrics,
        }
    }

    /// Bound on the rounding error, along the world `normal`, of the point on its way to world
    /// space and of a ray's origin on its way back to object space (running error analysis: PBR 4th
    /// ed., section 6.8.1).
    fn rounding(&self, transform: &Transform, point: Vec3, normal: Vec3, stretch: f32) -> f32 {
        let there = transform.matrix().abs() * self.point.abs() + transform.origin().abs();
        let back = transform.inverse_matrix().abs() * (point - transform.origin()).abs();
        robust::gamma(5) * (there.dot(normal.abs()) + back.dot(self.normal.abs()) * stretch)
    }

    /// Unbounded ray from this point that does not hit this surface at its origin.
    #[inline]
    pub fn spawn_ray(&self, direction: Vec3, time: f32) -> Ray {
        // Even an exact point on an axis plane must move off it, in object space too (see
        // `to_world`).
        let position_error = self.position_error + f32::MIN_POSITIVE;
        let origin = robust::offset_origin(self.point, position_error, self.normal, direction);
        Ray { time, ..Ray::new(origin, direction) }
    }

    /// The surface with its point moved by `lift`, the offset to the smooth surface that the shading
    /// normals describe (Hanika, Hacking the Shadow Terminator, Ray Tracing Gems II, chapter 4). Rays
    /// that leave from there do not hit the triangles beside it, which would cut off their light in
    /// steps. `None` where both points are the same up to rounding, or for the side of `wo` from which
    /// the offset leads away.
    #[inline]
    pub fn lifted(&self, lift: Vec3, wo: Vec3) -> Option<Self> {
        let height = lift.dot(self.normal);
        let is_off = height.abs() > 8.0 * (self.position_error + f32::EPSILON * self.point.abs().max_element());
        (is_off && height * self.normal.dot(wo) > 0.0).then(|| Self { point: self.point + lift, ..*self })
    }

    /// Enlarges the error of this surface, which `own` states exactly, so that rays that leave it start
    /// beyond `other`, a surface at the same place.
    pub fn grow_error(&mut self, own: &Self, other: &Self) {
        let offset = own.normal.dot(other.point - own.point).abs();
        self.position_error = self.position_error.max(2.0 * (own.position_error + offset + other.position_error));
    }

    /// Ray from this point to another, `distance` away (or at infinity), that ends just before it
    /// and so does not hit the surface of the other point. That holds for rays at more than some 12
    /// degrees to that surface; flatter ones may hit it, since the error of a rounded direction
    /// grows along such a ray without bound.
    #[inline]
    pub fn spawn_ray_to(&self, direction: Vec3, distance: f32, time: f32) -> Ray {
        // Errors at the end: a few half ulps of the distance from the direction, and the error of
        // both points.
        self.spawn_ray(direction, time).with_t_max(distance * (1.0 - robust::gamma(256)) - 16.0 * self.position_error)
    }
}
