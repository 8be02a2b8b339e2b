//! Manifold next-event estimation through a specular sphere: all paths that connect two points by
//! one reflection or by two refractions (Hanika, Droske, Fascione, Manifold Next Event Estimation,
//! 2015; Zeltner, Georgiev, Jakob, Specular Manifold Sampling, 2020).
//!
//! Those methods walk on arbitrary surfaces and find some of the paths. For a sphere the whole path
//! lies in one plane, so a single angle describes it: this module finds every path, with its
//! density in closed form.
//!
//! Lengths are in units of the sphere's radius. Let u be the sine of the angle of incidence, which
//! is the same at both interfaces, and k the radius divided by the distance of an end point from
//! the center. At that end point the path and the line to the center form an angle of sine k u.

use arrayvec::ArrayVec;
use juggler_math::{Vec3, portable};

mod lens;
mod mirror;
#[cfg(test)]
mod tests;

/// Kind of specular path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SpecularPath {
    /// Reflection on the outside.
    Reflected,
    /// Refraction into the sphere and out again.
    Refracted {
        /// Relative index of refraction, inside over outside; above 1.
        ior: f32,
    },
}

/// A specular sphere in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpecularSphere {
    /// Center.
    pub center: Vec3,
    /// Radius, above 0.
    pub radius: f32,
}

/// End point of a specular path, relative to the sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EndPoint {
    /// Unit vector from the sphere's center.
    pub toward: Vec3,
    /// Radius divided by the distance from the center: 0 at infinity, below 1.
    pub inverse_distance: f32,
}

/// A specular path between two end points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Connection {
    /// Unit direction in which the path leaves the first end point.
    pub direction: Vec3,
    /// First and last point on the sphere, as unit vectors from its center.
    pub vertices: [Vec3; 2],
    /// Sine of the angle of incidence.
    pub sine: f32,
}

/// Maximum number of paths between two end points.
pub const MAX_CONNECTIONS: usize = 3;

/// End points with a larger inverse distance count as lying on the sphere.
const MAX_INVERSE_DISTANCE: f32 = 0.9999;

impl SpecularSphere {
    /// Converts a point to an end point; `None` unless it is clearly outside the sphere.
    #[inline]
    pub fn end_point(&self, point: Vec3) -> Option<EndPoint> {
        let offset = point - self.center;
        let distance = offset.length();
        let inverse_distance = self.radius / distance;
        (inverse_distance <= MAX_INVERSE_DISTANCE).then(|| EndPoint { toward: offset / distance, inverse_distance })
    }

    /// 1 - cos θ, with θ half the angle that the sphere subtends at a point of this inverse
    /// distance: the sphere's solid angle divided by 2π.
    #[inline]
    pub fn one_minus_cos(inverse_distance: f32) -> f32 {
        let squared = inverse_distance * inverse_distance;
        squared / (1.0 + (1.0 - squared).max(0.0).sqrt())
    }
}

impl EndPoint {
    /// End point at infinity in the direction `toward`, a unit vector.
    #[inline]
    pub fn infinity(toward: Vec3) -> Self {
        Self { toward, inverse_distance: 0.0 }
    }
}

/// The plane through both end points and the sphere's center.
#[derive(Clone, Copy, Debug)]
struct Plane {
    /// Unit vector from the center to the first end point.
    axis: Vec3,
    /// Unit vector orthogonal to `axis`, on the side of the second end point.
    across: Vec3,
    /// Sine of `angle`.
    sin: f32,
    /// Cosine of `angle`.
    cos: f32,
    /// Angle Φ at the center between the end points, in radians.
    angle: f32,
    /// Inverse distance of both end points.
    inverse_distance: [f32; 2],
}

impl Plane {
    /// Plane of two end points; `None` if they are collinear with the center.
    #[inline]
    fn new(from: &EndPoint, to: &EndPoint) -> Option<Self> {
        let cos = from.toward.dot(to.toward);
        let across = to.toward - from.toward * cos;
        let sin = across.length();
        let angle = portable::atan2(sin, cos);
        let inverse_distance = [from.inverse_distance, to.inverse_distance];
        (sin > 1e-6).then(|| Self { axis: from.toward, across: across / sin, sin, cos, angle, inverse_distance })
    }

    /// Unit vector from the center at an angle from the axis, given as sine and cosine.
    #[inline]
    fn at(&self, (sin, cos): (f32, f32)) -> Vec3 {
        self.axis * cos + self.across * sin
    }

    /// Direction in which a path leaves the first end point. `sine` is the sine of its angle of
    /// incidence; `side` is 1 if it passes the center on the side of the second end point, else -1.
    #[inline]
    fn direction(&self, sine: f32, side: f32) -> Vec3 {
        let sin = self.inverse_distance[0] * sine;
        self.at((side * sin, -cos_from_sin(sin)))
    }
}

/// Finds all specular paths between two end points.
#[inline]
pub fn connections(kind: SpecularPath, from: &EndPoint, to: &EndPoint) -> ArrayVec<Connection, MAX_CONNECTIONS> {
    let Some(plane) = Plane::new(from, to) else { return ArrayVec::new() };
    match kind {
        SpecularPath::Reflected => mirror::connection(&plane).into_iter().collect(),
        SpecularPath::Refracted { ior } => lens::connections(&plane, ior),
    }
}

/// Ratio that converts a density of directions at the sphere's center to one at the first end
/// point. At the second end point, a thin bundle of paths has a cross-section; the ratio is the
/// area of this cross-section over the squared distance from the center, divided by the solid angle
/// of the bundle at the first end point. For a point on a surface, the caller also applies the
/// ratio of the cosines at that surface.
///
/// With Φ(u) the angle at the center between the end points, and a₁ and a₂ the angles at the end
/// points between the path and the line to the center, the ratio is cos a₁ cos a₂ |Φ'(u)| sin Φ /
/// (u k₁²).
#[inline]
pub fn solid_angle_ratio(kind: SpecularPath, from: &EndPoint, to: &EndPoint, sine: f32) -> f32 {
    let [k1, k2] = [from.inverse_distance, to.inverse_distance];
    let cosines = [k1, k2].map(|inverse_distance| cos_from_sin(inverse_distance * sine));
    let derivative = match kind {
        SpecularPath::Reflected => mirror::angle_derivative(sine, [k1, k2], cosines),
        SpecularPath::Refracted { ior } => lens::angle_derivative(sine, [k1, k2], cosines, ior),
    };
    let angle = from.toward.cross(to.toward).length();
    // On the axis, sin Φ and u both vanish.
    let around = if sine > 1e-4 { angle / sine } else { derivative.abs() };
    cosines[0] * cosines[1] * derivative.abs() * around / (k1 * k1)
}

/// Cosine of an angle of at most 90 degrees, from its sine.
#[inline]
pub fn cos_from_sin(sine: f32) -> f32 {
    ((1.0 - sine) * (1.0 + sine)).max(0.0).sqrt()
}
