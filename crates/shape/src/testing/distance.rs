//! Distance of a point from a shape's surface, by independent formulas in `f64`, to verify hits.

use crate::AnyShape;
use juggler_math::{DVec3, Vec3};

/// Distance to the surface.
pub fn distance(shape: &AnyShape, p: DVec3) -> f64 {
    let across = p.x.hypot(p.z);
    let beyond = |v: f64, low: f64, high: f64| (low - v).max(v - high).max(0.0);
    match shape {
        AnyShape::Sphere(s) => (p.length() - f64::from(s.radius)).abs(),
        AnyShape::Plane(_) => p.y.abs(),
        AnyShape::Tube(t) => (across - f64::from(t.radius)).abs(),
        AnyShape::Disk(d) => p.y.hypot(beyond(across, d.inner_radius.into(), d.radius.into())),
        AnyShape::Rectangle(r) => {
            let half = r.size.map(|s| 0.5 * f64::from(s));
            p.y.abs() + beyond(p.x, -half[0], half[0]) + beyond(p.z, -half[1], half[1])
        }
        AnyShape::Cuboid(c) => {
            let outside = (c.min.as_dvec3() - p).max(p - c.max.as_dvec3());
            if outside.max_element() <= 0.0 {
                return -outside.max_element();
            }
            outside.max(DVec3::ZERO).length()
        }
        AnyShape::Cylinder(c) => {
            let (side, low, high) = (across - f64::from(c.radius), c.y_min.into(), c.y_max.into());
            let to_side = side.abs().hypot(beyond(p.y, low, high));
            let to_caps = (p.y - low).abs().min((p.y - high).abs()).hypot(side.max(0.0));
            if c.capped { to_side.min(to_caps) } else { to_side }
        }
        AnyShape::Triangle(t) => to_triangle(p, t.vertices),
        AnyShape::Polygon(polygon) => {
            let v = &polygon.vertices;
            let fan = (2..v.len()).map(|i| to_triangle(p, [v[0], v[i - 1], v[i]]));
            fan.fold(f64::INFINITY, f64::min)
        }
        AnyShape::Mesh(mesh) => {
            let Some(data) = mesh.data() else { return f64::INFINITY };
            let all = data.triangles.iter().map(|t| to_triangle(p, t.map(|i| data.positions[i as usize])));
            all.fold(f64::INFINITY, f64::min)
        }
    }
}

/// Distance to a triangle: to its plane if the foot is inside, else to the nearest edge.
fn to_triangle(p: DVec3, corners: [Vec3; 3]) -> f64 {
    let corners = corners.map(|c| c.as_dvec3());
    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    let edges = [(0, 1), (1, 2), (2, 0)].map(|(i, j)| (corners[i], corners[j]));
    let inside = edges.iter().all(|(a, b)| normal.cross(*b - *a).dot(p - *a) >= 0.0);
    if inside && normal != DVec3::ZERO {
        return normal.normalize().dot(p - corners[0]).abs();
    }
    let to_edge = |(a, b): (DVec3, DVec3)| {
        let along = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        if along.is_nan() { p.distance(a) } else { p.distance(a + (b - a) * along) }
    };
    edges.map(to_edge).into_iter().fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_to_a_triangle_are_known() {
        let corners = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]].map(Vec3::from);
        for (point, expected) in
            [([1.0, 1.0, -3.0], 3.0), ([-3.0, -4.0, 0.0], 5.0), ([2.0, -1.0, 0.0], 1.0), ([3.0, 3.0, 0.0], 2f64.sqrt())]
        {
            assert!((to_triangle(Vec3::from(point).as_dvec3(), corners) - expected).abs() < 1e-12);
        }
    }
}
