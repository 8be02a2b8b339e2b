//! One triangle with what its corners carry: position, shading normal, surface coordinates.

use super::Derivatives;
use super::arithmetic::{EDGE, double};
use crate::surface::Surface;
use juggler_math::{DVec2, DVec3, Ray, Vec2, Vec3, robust};

/// Places with a barycentric below this are looked at more closely: [`EDGE`] for triangles up to 60 times as long as
/// they are wide.
const BESIDE_EDGE: f64 = 1.0 / 4096.0;

/// A triangle of a mesh, or one that stands alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facet {
    /// Corners; the front is where they run counter-clockwise.
    pub corners: [Vec3; 3],
    /// Shading normals at the corners, of any length.
    pub normals: Option<[Vec3; 3]>,
    /// Surface coordinates of the corners.
    pub uvs: Option<[Vec2; 3]>,
}

impl Facet {
    /// Twice the area as a vector along the normal; zero exactly for corners on one line.
    pub fn winding(&self) -> DVec3 {
        let [a, b, c] = self.corners.map(|corner| corner.as_dvec3());
        (b - a).cross(c - a)
    }

    /// Area in square scene units.
    pub fn area(&self) -> f64 {
        0.5 * self.winding().length()
    }

    /// The point and the geometric normal at barycentrics of the second and third corner.
    pub fn point(&self, at: DVec2) -> (Vec3, Vec3) {
        // In f64, weights that sum to one keep the point in the plane whatever their own rounding.
        let [a, b, c] = self.corners.map(|corner| corner.as_dvec3());
        let point = a + (b - a) * at.x + (c - a) * at.y;
        (point.as_vec3(), self.winding().normalize_or(DVec3::Y).as_vec3())
    }

    /// The surface where a ray hits; `near` are barycentrics of the second and third corner, to be refined.
    /// Without surface coordinates of its own, it gives the barycentrics.
    pub fn surface(&self, ray: &Ray, near: Vec2) -> Surface {
        let [a, b, c] = self.corners;
        let size = (b - a).abs().max((c - a).abs()).max_element();
        let at = self.refined(ray, near.as_dvec2());
        let beside_edge = at.min_element().min(1.0 - at.x - at.y) < BESIDE_EDGE;
        let at = if beside_edge { self.inwards(at, f64::from(EDGE * size)) } else { at };
        let (point, normal) = self.point(at);
        // The triangle test takes the corners to the ray in f32: each is off by up to 4 half ulps of the way there
        // (measured from close by, for triangles with sides up to 100,000 : 1: a quarter of one).
        let error = robust::gamma(2) * point.abs().dot(normal.abs()) + robust::gamma(4) * size;
        let at = at.as_vec2();
        let uv = self.uvs.map_or(at, |[a, b, c]| a * (1.0 - at.x - at.y) + b * at.x + c * at.y);
        let shading_normal = self.shading_normal(normal, at);
        Surface { shading_normal, local_normal: shading_normal, ..Surface::new(point, error, normal, uv) }
    }

    /// How the surface runs along its coordinates, which is the same everywhere.
    pub fn derivatives(&self) -> Option<Derivatives> {
        let [a, b, c] = self.corners.map(|corner| corner.as_dvec3());
        let (to_b, to_c) = (b - a, c - a);
        let Some([from, b, c]) = self.uvs.map(|uvs| uvs.map(|uv| uv.as_dvec2())) else {
            return Derivatives::new(to_b.as_vec3(), to_c.as_vec3());
        };
        let (b, c) = (b - from, c - from);
        let turn = b.x * c.y - b.y * c.x;
        let (u, v) = ((to_b * c.y - to_c * b.y) / turn, (to_c * b.x - to_b * c.x) / turn);
        Derivatives::new(u.as_vec3(), v.as_vec3())
    }

    /// Barycentrics where the ray meets the plane, in `f64`: those of a slender triangle are not good in `f32`.
    fn refined(&self, ray: &Ray, near: DVec2) -> DVec2 {
        let (origin, direction) = double(ray);
        let [a, b, c] = self.corners.map(|corner| corner.as_dvec3());
        let winding = self.winding();
        let t = winding.dot(a - origin) / winding.dot(direction);
        if !t.is_finite() {
            return near;
        }
        let from_a = origin + direction * t - a;
        let across = DVec2::new(from_a.cross(c - a).dot(winding), (b - a).cross(from_a).dot(winding));
        let inside = (across / winding.length_squared()).clamp(DVec2::ZERO, DVec2::ONE);
        inside / (inside.x + inside.y).max(1.0)
    }

    /// A place moved by `margin` towards the centre of the inscribed circle, and so as far from each edge that it was
    /// close to.
    #[cold]
    fn inwards(&self, at: DVec2, margin: f64) -> DVec2 {
        let [a, b, c] = self.corners.map(|corner| corner.as_dvec3());
        let sides = DVec3::new((c - b).length(), (a - c).length(), (b - a).length());
        let around = sides.element_sum();
        let radius = self.winding().length() / around;
        let centre = DVec2::new(sides.y, sides.z) / around;
        at.lerp(centre, (margin / radius).min(0.5))
    }

    /// The interpolated normal, kept on the front: a triangle wound against its normals has them turned round,
    /// and what still dips below the surface is mirrored up again.
    fn shading_normal(&self, normal: Vec3, at: Vec2) -> Vec3 {
        let Some([a, b, c]) = self.normals.map(|normals| normals.map(|n| n.normalize_or_zero())) else { return normal };
        let turned = if (a + b + c).dot(normal) < 0.0 { -1.0 } else { 1.0 };
        let smooth = (a * (1.0 - at.x - at.y) + b * at.x + c * at.y) * turned;
        let height = smooth.dot(normal);
        let above = if height < 0.0 { smooth - normal * (2.0 * height) } else { smooth };
        above.normalize_or(normal)
    }
}
