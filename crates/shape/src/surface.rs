//! Where a ray met a surface, seen once per path vertex and never while traversing.

use juggler_math::{Ray, Transform, Vec2, Vec3, robust};

/// A point on a surface. Shapes make it in object space; the world turns it into world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// The point, pulled back onto the surface after rounding.
    pub point: Vec3,
    /// How far a ray that leaves from `point` must start from it, along `normal`, to be off the surface for
    /// sure: bounds the distance between `point` and the true surface, and what intersecting rounds.
    pub error: f32,
    /// Unit normal of the true surface, outwards (for flat shapes: their stated front).
    pub normal: Vec3,
    /// Unit normal that shading uses, on the same side; equals `normal` unless a mesh brings its own.
    pub shading_normal: Vec3,
    /// Surface coordinates; the range is each shape's to say.
    pub uv: Vec2,
    /// The point in object space, for textures that stick to the object.
    pub local: Vec3,
    /// What `shading_normal` is in object space, for such textures.
    pub local_normal: Vec3,
    /// What the ray that is looked along covers, for textures; a point unless somebody says otherwise.
    pub footprint: Footprint,
}

/// Diameters of the patch of a surface that a ray stands for; 0 for a point alone.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Footprint {
    /// In world units.
    pub world: f32,
    /// In units of object space.
    pub local: f32,
    /// In units of the surface coordinates.
    pub uv: f32,
}

/// How a surface runs along its coordinates at a point, normals aside: what normal maps and stretched highlights stand in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tangents {
    /// ∂p/∂u, world space; need not be unit.
    pub u: Vec3,
    /// ∂p/∂v, world space; need not be unit, nor at a right angle to `u`.
    pub v: Vec3,
    /// ∂p/∂u in object space.
    pub local_u: Vec3,
    /// ∂p/∂v in object space.
    pub local_v: Vec3,
}

impl Surface {
    /// A point with one normal.
    #[inline]
    pub fn new(point: Vec3, error: f32, normal: Vec3, uv: Vec2) -> Self {
        let footprint = Footprint::default();
        Self { point, error, normal, shading_normal: normal, uv, local: point, local_normal: normal, footprint }
    }

    /// The same point in world space.
    #[inline]
    pub fn to_world(&self, transform: &Transform) -> Self {
        let point = transform.point(self.point);
        let normal = transform.normal(self.normal);
        let shading_normal =
            if self.shading_normal == self.normal { normal } else { transform.normal(self.shading_normal) };
        // How far apart two planes along the surface come to lie that were one unit apart.
        let stretch = transform.vector(self.normal).dot(normal).abs();
        Self {
            point,
            error: (self.error + f32::MIN_POSITIVE) * stretch + self.rounding(transform, point, normal, stretch),
            normal,
            shading_normal,
            uv: self.uv,
            local: self.local,
            local_normal: self.local_normal,
            footprint: self.footprint,
        }
    }

    /// What rounding can move the point along the world `normal` on its way to the world, and a ray's origin
    /// on its way back to object space (running error analysis: PBR 4th ed., section 6.8.1).
    fn rounding(&self, transform: &Transform, point: Vec3, normal: Vec3, stretch: f32) -> f32 {
        let there = transform.matrix().abs() * self.point.abs() + transform.origin().abs();
        let back = transform.inverse_matrix().abs() * (point - transform.origin()).abs();
        robust::gamma(5) * (there.dot(normal.abs()) + back.dot(self.normal.abs()) * stretch)
    }

    /// A ray without end from here, free of this surface.
    #[inline]
    pub fn spawn(&self, direction: Vec3, time: f32) -> Ray {
        // Even an exact point on an axis plane has to move off it, in object space too (see `to_world`).
        let error = self.error + f32::MIN_POSITIVE;
        let origin = robust::offset_origin(self.point, error, self.normal, direction);
        Ray { time, ..Ray::new(origin, direction) }
    }

    /// A ray from here to a place `distance` away (or infinitely far) that ends just before it: what the place lies on is not met. That
    /// holds for rays that come down on it by more than some 12 degrees; flatter ones may meet it, for what a rounded
    /// direction misses of the place grows along such a ray without bound.
    #[inline]
    pub fn spawn_to(&self, direction: Vec3, distance: f32, time: f32) -> Ray {
        // Off at the end are: the direction by a few half ulps of the distance, start and place by the error.
        self.spawn(direction, time).up_to(distance * (1.0 - robust::gamma(256)) - 16.0 * self.error)
    }
}
