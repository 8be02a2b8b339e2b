//! Validation of a polygon's corners, its plane and its edges.

use super::super::check::{invalid, point};
use super::InvalidShape;
use juggler_math::{Aabb, DVec3, Ray, Vec3, portable};

/// A validated polygon. No ray hits the default one.
#[derive(Clone, Debug, PartialEq)]
pub struct PolygonGeometry {
    /// Unit normal of the front.
    pub normal: DVec3,
    /// Unit direction of the first edge.
    pub along: DVec3,
    /// Bounding box.
    pub bounds: Aabb,
    /// Running sums of the areas of the triangles that fan out from the first corner.
    pub areas: Vec<f64>,
    /// Bound on the rounding error of the plane's `f64` numbers.
    pub rounding: f32,
    /// Mean of the corners; the plane goes through it.
    center: DVec3,
    /// For each edge, the inward direction and the position of the edge along it, relative to the
    /// center.
    edges: Vec<(DVec3, f64)>,
}

impl Default for PolygonGeometry {
    fn default() -> Self {
        let (edges, areas) = (Vec::new(), Vec::new());
        Self {
            normal: DVec3::ZERO,
            along: DVec3::ZERO,
            bounds: Aabb::EMPTY,
            areas,
            rounding: 0.0,
            center: DVec3::ZERO,
            edges,
        }
    }
}

impl PolygonGeometry {
    /// Validates that the corners make a flat convex polygon; the error names the vertex at fault.
    pub fn new(vertices: &[Vec3]) -> Result<Self, InvalidShape> {
        if vertices.len() < 3 {
            let message = format!("`vertices` must be at least 3 points, there are {}", vertices.len());
            return Err(invalid("vertices", message));
        }
        vertices.iter().enumerate().try_for_each(|(i, &v)| point(&format!("vertices[{i}]"), v))?;
        let corners: Vec<DVec3> = vertices.iter().map(|v| v.as_dvec3()).collect();
        let edges = edges(&corners)?;
        let bounds = Aabb::from_points(vertices.iter().copied());
        let extent = f64::from(bounds.extent().max_element());
        let around = area_normal(&corners);
        if around.length() <= 1e-10 * extent * extent {
            return Err(invalid(
                "vertices",
                "`vertices` enclose no area: they lie on one line, or the outline crosses itself",
            ));
        }
        let normal = around.normalize();
        let center = corners.iter().copied().sum::<DVec3>() / corners.len() as f64;
        let coordinate = f64::from(bounds.min.abs().max(bounds.max.abs()).max_element());
        let tolerance = 1e-5 * extent + f64::from(f32::EPSILON) * coordinate;
        let deviation = check_flat(&corners, normal, center, tolerance)?;
        check_convex(&edges, normal, f64::from(2.0 * f32::EPSILON) * coordinate)?;
        let inwards = edges.iter().zip(&corners).map(|(edge, corner)| {
            let inwards = normal.cross(*edge);
            (inwards, inwards.dot(*corner - center))
        });
        Ok(Self {
            normal,
            along: edges.first().map_or(DVec3::X, |e| (*e - normal * e.dot(normal)).normalize()),
            bounds: if deviation > 0.0 { bounds.grown((deviation as f32).next_up()) } else { bounds },
            areas: fan_areas(&corners),
            rounding: (8.0 * f64::EPSILON * coordinate) as f32,
            center,
            edges: inwards.collect(),
        })
    }

    /// Direction of v: in the plane, orthogonal to the first edge.
    pub fn across(&self) -> DVec3 {
        self.normal.cross(self.along)
    }

    /// Distance and point where a ray hits the plane.
    pub fn intersect_plane(&self, ray: &Ray) -> (f64, DVec3) {
        let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
        let t = self.normal.dot(self.center - origin) / self.normal.dot(direction);
        (t, origin + direction * t)
    }

    /// Whether a point of the plane is inside or on an edge.
    pub fn contains(&self, point: DVec3) -> bool {
        let from_center = point - self.center;
        self.edges.iter().all(|(inwards, edge)| inwards.dot(from_center) >= *edge)
    }

    /// Projects a point onto the plane.
    pub fn onto_plane(&self, point: DVec3) -> DVec3 {
        point - self.normal * self.normal.dot(point - self.center)
    }

    /// Bytes on the heap.
    pub fn heap_bytes(&self) -> usize {
        size_of_val(self.areas.as_slice()) + size_of_val(self.edges.as_slice())
    }
}

/// Vectors from each corner to the next; an error if one of them is zero.
fn edges(corners: &[DVec3]) -> Result<Vec<DVec3>, InvalidShape> {
    let mut edges = Vec::with_capacity(corners.len());
    for (i, (corner, next)) in corners.iter().zip(corners.iter().cycle().skip(1)).enumerate() {
        if corner == next {
            let later = (i + 1) % corners.len();
            let (first, again) = (i.min(later), i.max(later));
            let message = format!("`vertices[{again}]` repeats `vertices[{first}]`");
            return Err(invalid(format!("vertices[{again}]"), message));
        }
        edges.push(*next - *corner);
    }
    Ok(edges)
}

/// Twice the area as a vector along the normal (Newell's method: Sutherland et al. 1974), which
/// takes every corner into account.
fn area_normal(corners: &[DVec3]) -> DVec3 {
    let first = corners.first().copied().unwrap_or_default();
    let pairs = corners.iter().zip(corners.iter().skip(1));
    pairs.map(|(a, b)| (*a - first).cross(*b - first)).sum()
}

fn fan_areas(corners: &[DVec3]) -> Vec<f64> {
    let first = corners.first().copied().unwrap_or_default();
    let mut sum = 0.0;
    let pairs = corners.iter().zip(corners.iter().skip(1)).skip(1);
    let areas = pairs.map(|(a, b)| {
        sum += 0.5 * (*a - first).cross(*b - first).length();
        sum
    });
    areas.collect()
}

/// Largest distance of a corner from the plane; an error if it exceeds `tolerance`.
fn check_flat(corners: &[DVec3], normal: DVec3, center: DVec3, tolerance: f64) -> Result<f64, InvalidShape> {
    let off = |corner: &DVec3| normal.dot(*corner - center).abs();
    let worst = corners.iter().map(off).fold(0.0, f64::max);
    if worst <= tolerance {
        return Ok(worst);
    }
    // All of four corners are equally far from the mean plane; then report the last one.
    let i = corners.iter().rposition(|corner| off(corner) >= 0.999 * worst).unwrap_or(0);
    let others: Vec<DVec3> = corners.iter().enumerate().filter(|(at, _)| *at != i).map(|(_, c)| *c).collect();
    let away = others.first().map_or(DVec3::ZERO, |first| corners[i] - *first);
    let distance = area_normal(&others).normalize_or_zero().dot(away).abs();
    let message =
        format!("`vertices` must lie in one plane: `vertices[{i}]` is {distance:.6} off the plane of the others");
    Err(invalid(format!("vertices[{i}]"), message))
}

/// Checks that the outline turns in the same direction at every corner, and once around in total.
/// `rounding` is the distance by which a corner may be displaced.
fn check_convex(edges: &[DVec3], normal: DVec3, rounding: f64) -> Result<(), InvalidShape> {
    let before = edges.iter().cycle().skip(edges.len().saturating_sub(1));
    let angle =
        |before: DVec3, edge: DVec3| portable::atan2_f64(normal.dot(before.cross(edge)), before.dot(edge)).to_degrees();
    let turns: Vec<f64> = before.zip(edges).map(|(before, edge)| angle(*before, *edge)).collect();
    let least = edges.iter().map(|edge| edge.length()).fold(f64::INFINITY, f64::min);
    let slack = 1e-3 + (2.0 * rounding / least).to_degrees();
    if let Some(i) = turns.iter().position(|turn| *turn < -slack || *turn > 180.0 - slack) {
        let message = format!(
            "`vertices` must be convex and in order: the outline turns back at `vertices[{i}]`, by {:.3} degrees",
            turns[i].abs()
        );
        return Err(invalid(format!("vertices[{i}]"), message));
    }
    let running = turns.iter().scan(0.0, |sum, turn| {
        *sum += turn;
        Some(*sum)
    });
    if let Some((i, _)) = running.enumerate().find(|(_, turned)| *turned > 361.0) {
        let message =
            format!("`vertices` must be in order: the outline turns by more than 360 degrees at `vertices[{i}]`");
        return Err(invalid(format!("vertices[{i}]"), message));
    }
    Ok(())
}
