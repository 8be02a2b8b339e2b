//! One triangle with the attributes of its corners: position, shading normal, surface coordinates.

use super::SurfaceDerivatives;
use super::arithmetic::{EDGE_MARGIN, to_f64};
use crate::surface::Surface;
use juggler_math::{DVec2, DVec3, Ray, Vec2, Vec3, robust};

/// Barycentric below which the distance to an edge is checked: [`EDGE_MARGIN`] for triangles up to
/// 60 times as long as they are wide.
const BESIDE_EDGE: f64 = 1.0 / 4096.0;

/// A triangle of a mesh, or a single one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleGeometry {
    /// Corners, counter-clockwise seen from the front.
    pub corners: [Vec3; 3],
    /// Shading normals at the corners, of any length.
    pub normals: Option<[Vec3; 3]>,
    /// Surface coordinates of the corners.
    pub uvs: Option<[Vec2; 3]>,
}

impl TriangleGeometry {
    /// Twice the area as a vector along the normal; exactly zero for collinear corners.
    #[inline]
    pub fn area_normal(&self) -> DVec3 {
        let [a, b, c] = self.corners.map(|corner| corner.as_dvec3());
        (b - a).cross(c - a)
    }

    /// Area in square scene units.
    pub fn area(&self) -> f64 {
        0.5 * self.area_normal().length()
    }

    /// Point and geometric normal at barycentrics of the second and third corner.
    pub fn point(&self, at: DVec2) -> (Vec3, Vec3) {
        self.point_with_normal(at, self.area_normal())
    }

    /// [`TriangleGeometry::point`] with the result of [`TriangleGeometry::area_normal`].
    #[inline]
    fn point_with_normal(&self, at: DVec2, area_normal: DVec3) -> (Vec3, Vec3) {
        // In f64, weights that sum to one keep the point in the plane despite their own rounding.
        let [a, b, c] = self.corners.map(|corner| corner.as_dvec3());
        let point = a + (b - a) * at.x + (c - a) * at.y;
        (point.as_vec3(), area_normal.normalize_or(DVec3::Y).as_vec3())
    }

    /// The surface where a ray hits; `near` are approximate barycentrics of the second and third
    /// corner. Without surface coordinates of the triangle, `uv` are the barycentrics.
    pub fn surface(&self, ray: &Ray, near: Vec2) -> Surface {
        let [a, b, c] = self.corners;
        let size = (b - a).abs().max((c - a).abs()).max_element();
        let area_normal = self.area_normal();
        let at = self.refine_barycentrics(ray, near.as_dvec2(), area_normal);
        let beside_edge = at.min_element().min(1.0 - at.x - at.y) < BESIDE_EDGE;
        let at = if beside_edge { self.move_inwards(at, f64::from(EDGE_MARGIN * size)) } else { at };
        let (point, normal) = self.point_with_normal(at, area_normal);
        // The triangle test translates the corners to the ray in f32, with an error of up to 4 half
        // ulps of that translation each. (The measured error is a quarter of one half ulp, for
        // nearby triangles whose sides differ by up to a factor of 100,000.)
        let error = robust::gamma(2) * point.abs().dot(normal.abs()) + robust::gamma(4) * size;
        let at = at.as_vec2();
        let uv = self.uvs.map_or(at, |[a, b, c]| a * (1.0 - at.x - at.y) + b * at.x + c * at.y);
        let plain = Surface { barycentrics: at, ..Surface::new(point, error, normal, uv) };
        let Some(normals) = self.front_normals(normal) else { return plain };
        let shading_normal = smooth_normal(normals, normal, at);
        Surface { shading_normal, local_normal: shading_normal, ..plain }
    }

    /// Derivatives of position by surface coordinates, constant over the triangle.
    pub fn derivatives(&self) -> Option<SurfaceDerivatives> {
        let [a, b, c] = self.corners.map(|corner| corner.as_dvec3());
        let (to_b, to_c) = (b - a, c - a);
        let Some([from, b, c]) = self.uvs.map(|uvs| uvs.map(|uv| uv.as_dvec2())) else {
            return SurfaceDerivatives::new(to_b.as_vec3(), to_c.as_vec3());
        };
        let (b, c) = (b - from, c - from);
        let determinant = b.x * c.y - b.y * c.x;
        let (u, v) = ((to_b * c.y - to_c * b.y) / determinant, (to_c * b.x - to_b * c.x) / determinant);
        SurfaceDerivatives::new(u.as_vec3(), v.as_vec3())
    }

    /// Barycentrics of the ray's intersection with the plane, in `f64`: `f32` is too inaccurate for
    /// slender triangles.
    #[inline]
    fn refine_barycentrics(&self, ray: &Ray, near: DVec2, area_normal: DVec3) -> DVec2 {
        let (origin, direction) = to_f64(ray);
        let [a, b, c] = self.corners.map(|corner| corner.as_dvec3());
        let t = area_normal.dot(a - origin) / area_normal.dot(direction);
        if !t.is_finite() {
            return near;
        }
        let from_a = origin + direction * t - a;
        let across = DVec2::new(from_a.cross(c - a).dot(area_normal), (b - a).cross(from_a).dot(area_normal));
        let inside = (across / area_normal.length_squared()).clamp(DVec2::ZERO, DVec2::ONE);
        inside / (inside.x + inside.y).max(1.0)
    }

    /// Moves a point by `margin` towards the incenter, and so as far away from each edge close to
    /// it.
    #[cold]
    fn move_inwards(&self, at: DVec2, margin: f64) -> DVec2 {
        let [a, b, c] = self.corners.map(|corner| corner.as_dvec3());
        let sides = DVec3::new((c - b).length(), (a - c).length(), (b - a).length());
        let perimeter = sides.element_sum();
        let radius = self.area_normal().length() / perimeter;
        let incenter = DVec2::new(sides.y, sides.z) / perimeter;
        at.lerp(incenter, (margin / radius).min(0.5))
    }

    /// Unit shading normals at the corners, on the front: normals opposite to the winding are
    /// negated.
    #[inline]
    fn front_normals(&self, normal: Vec3) -> Option<[Vec3; 3]> {
        let [a, b, c] = self.normals?.map(|n| n.normalize_or_zero());
        let turned = if (a + b + c).dot(normal) < 0.0 { -1.0 } else { 1.0 };
        Some([a * turned, b * turned, c * turned])
    }

    /// Offset from the point at barycentrics of the second and third corner to the smooth surface, on
    /// the side from which a ray comes in this direction (Hanika 2021): the mean, by barycentrics, of
    /// the offsets to the tangent planes at the corners, of which those beyond the triangle count as
    /// 0. Neighboring triangles have the same offset on their common edge. `None` without shading
    /// normals, and if the normal of a corner lies in the triangle or behind it.
    pub fn lift(&self, barycentrics: Vec2, direction: Vec3) -> Option<Vec3> {
        let (point, normal) = self.point(barycentrics.as_dvec2());
        let normals = self.front_normals(normal)?;
        if normals.iter().any(|n| n.dot(normal) <= 0.0) {
            return None;
        }
        let side = if normal.dot(direction) > 0.0 { -1.0 } else { 1.0 };
        let Vec2 { x, y } = barycentrics;
        let offset = |corner: Vec3, normal: Vec3| normal * (side * (side * (corner - point).dot(normal)).max(0.0));
        let [a, b, c] = self.corners;
        let [on_a, on_b, on_c] = normals;
        Some(offset(a, on_a) * (1.0 - x - y) + offset(b, on_b) * x + offset(c, on_c) * y)
    }
}

/// The interpolated normal: one that is below the surface is reflected above it.
fn smooth_normal([a, b, c]: [Vec3; 3], normal: Vec3, at: Vec2) -> Vec3 {
    let smooth = a * (1.0 - at.x - at.y) + b * at.x + c * at.y;
    let height = smooth.dot(normal);
    let above = if height < 0.0 { smooth - normal * (2.0 * height) } else { smooth };
    above.normalize_or(normal)
}
