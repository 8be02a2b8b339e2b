//! Triangulation of polygons. A strictly convex polygon becomes a fan around its first corner; any
//! other polygon is triangulated by ear clipping (Meisters, "Polygons have ears", 1975) in its own
//! plane, projected along Newell's normal (Sutherland, Sproull and Schumacker, 1974). A polygon of
//! n corners always gives n - 2 triangles, so a polygon that is read before its positions are known
//! is stored as a fan and triangulated later in place.

use crate::error::MeshErrorKind;
use crate::limits::MeshLimits;
use juggler_math::{DVec2, DVec3, Vec3};
use rayon::prelude::*;
use std::ops::Range;

/// Maximum number of corner tests for all concave polygons of a file: about a second of work,
/// enough for a hundred thousand outlines of fifty corners. Polygons beyond it stay fans and are
/// counted.
const EAR_TESTS: u64 = 1 << 28;

/// The faces of a mesh or of a piece of a file, in the order of the file.
#[derive(Default)]
pub(crate) struct Faces {
    triangles: Vec<[u32; 3]>,
    polygons: Vec<Polygon>,
    skipped: u64,
}

/// The run of triangles that forms the fan of a polygon with more than three corners.
struct Polygon {
    first: usize,
    count: usize,
}

impl Polygon {
    fn range(&self) -> Range<usize> {
        self.first..self.first + self.count
    }
}

impl Faces {
    /// Creates an empty list with room for this number of triangles.
    pub fn with_capacity(triangles: usize) -> Self {
        Self { triangles: Vec::with_capacity(triangles), ..Self::default() }
    }

    /// Number of triangles so far.
    pub fn len(&self) -> usize {
        self.triangles.len()
    }

    /// Appends the faces of the next piece of the file and adds `first` to their vertex indices.
    pub fn append(&mut self, piece: &Self, first: u32, limits: &MeshLimits) -> Result<(), MeshErrorKind> {
        let start = self.triangles.len();
        limits.check_triangles(start.saturating_add(piece.triangles.len()))?;
        self.triangles.extend(piece.triangles.iter().map(|corners| corners.map(|corner| corner + first)));
        self.polygons.extend(piece.polygons.iter().map(|polygon| Polygon { first: start + polygon.first, ..*polygon }));
        self.skipped += piece.skipped;
        Ok(())
    }

    /// Replaces all vertex indices.
    pub fn renumber(&mut self, number: impl Fn(u32) -> u32 + Sync) {
        self.triangles.par_iter_mut().for_each(|corners| *corners = corners.map(&number));
    }

    /// Adds a triangle.
    pub fn push_triangle(&mut self, corners: [u32; 3], limits: &MeshLimits) -> Result<(), MeshErrorKind> {
        limits.check_triangles(self.triangles.len().saturating_add(1))?;
        self.triangles.push(corners);
        Ok(())
    }

    /// Adds a polygon; polygons of fewer than three corners are counted and left out.
    pub fn push(&mut self, corners: &[u32], limits: &MeshLimits) -> Result<(), MeshErrorKind> {
        let [start, second, rest @ ..] = corners else {
            self.skipped += 1;
            return Ok(());
        };
        if rest.is_empty() {
            self.skipped += 1;
        }
        limits.check_triangles(self.triangles.len().saturating_add(rest.len()))?;
        if rest.len() > 1 {
            self.polygons.push(Polygon { first: self.triangles.len(), count: rest.len() });
        }
        let mut previous = *second;
        for corner in rest {
            self.triangles.push([*start, previous, *corner]);
            previous = *corner;
        }
        Ok(())
    }

    /// Triangulates the concave polygons and returns all triangles. Vertex indices must be in
    /// range.
    pub fn triangulate(mut self, positions: &[Vec3], warnings: &mut Vec<String>) -> Vec<[u32; 3]> {
        if self.skipped > 0 {
            warnings.push(format!("{} faces with fewer than 3 vertices ignored", self.skipped));
        }
        let fan_of = |polygon: &Polygon| self.triangles.get(polygon.range());
        let is_concave = |polygon: &&Polygon| fan_of(polygon).is_some_and(|fan| !is_convex(&outline(fan, positions)));
        let concave: Vec<&Polygon> = self.polygons.par_iter().filter(is_concave).collect();
        let mut tests = EAR_TESTS;
        let mut fans = 0_u64;
        for polygon in concave {
            let Some(fan) = self.triangles.get_mut(polygon.range()) else { continue };
            if !cut(fan, positions, &mut tests) {
                fans += 1;
            }
        }
        if fans > 0 {
            warnings.push(format!("{fans} concave polygons have too many vertices and were triangulated as if convex"));
        }
        self.triangles
    }
}

/// Vertex indices of the polygon that this fan represents.
fn corners(fan: &[[u32; 3]]) -> impl Iterator<Item = u32> {
    fan.iter().take(1).flat_map(|first| [first[0], first[1]]).chain(fan.iter().map(|corners| corners[2]))
}

/// The polygon that this fan represents, projected to its plane.
fn outline(fan: &[[u32; 3]], positions: &[Vec3]) -> Vec<DVec2> {
    let point = |corner: u32| positions.get(corner as usize).copied().unwrap_or_default().as_dvec3();
    in_plane(&corners(fan).map(point).collect::<Vec<DVec3>>())
}

/// Triangulates the concave polygon that this fan represents; `false` if no tests are left.
fn cut(fan: &mut [[u32; 3]], positions: &[Vec3], tests: &mut u64) -> bool {
    let Some(ears) = ears(&outline(fan, positions), tests) else { return false };
    let corners: Vec<u32> = corners(fan).collect();
    for (triangle, ear) in fan.iter_mut().zip(ears) {
        *triangle = ear.map(|corner| corners.get(corner).copied().unwrap_or_default());
    }
    true
}

/// Projects the polygon along the dominant axis of its normal, oriented counter-clockwise.
fn in_plane(points: &[DVec3]) -> Vec<DVec2> {
    let origin = points.first().copied().unwrap_or_default();
    let following = points.iter().cycle().skip(1);
    let normal: DVec3 = points.iter().zip(following).map(|(a, b)| (*a - origin).cross(*b - origin)).sum();
    let size = normal.abs();
    let flatten = |point: &DVec3| {
        let (flat, facing) = if size.x >= size.y && size.x >= size.z {
            (DVec2::new(point.y, point.z), normal.x)
        } else if size.y >= size.z {
            (DVec2::new(point.z, point.x), normal.y)
        } else {
            (DVec2::new(point.x, point.y), normal.z)
        };
        if facing < 0.0 { DVec2::new(flat.y, flat.x) } else { flat }
    };
    points.iter().map(flatten).collect()
}

/// Twice the signed area of a triangle; positive if it is oriented counter-clockwise.
fn signed_area2(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

fn is_convex(points: &[DVec2]) -> bool {
    let next = points.iter().cycle().skip(1);
    let after = points.iter().cycle().skip(2);
    points.iter().zip(next).zip(after).all(|((a, b), c)| signed_area2(*a, *b, *c) > 0.0)
}

/// Clips ears. Returns the corner indices of n - 2 triangles; `None` if the tests run out.
fn ears(points: &[DVec2], tests: &mut u64) -> Option<Vec<[usize; 3]>> {
    let mut left: Vec<usize> = (0..points.len()).collect();
    let mut found = Vec::with_capacity(points.len());
    let mut at = 0;
    let mut refused = 0;
    while left.len() > 3 {
        let count = left.len();
        *tests = tests.checked_sub(count as u64)?;
        at %= count;
        let ear = [left[(at + count - 1) % count], left[at], left[(at + 1) % count]];
        // A self-intersecting outline may have no ear left; clip any corner then.
        if refused == count || is_ear(ear, points, &left) {
            found.push(ear);
            left.remove(at);
            refused = 0;
        } else {
            at += 1;
            refused += 1;
        }
    }
    found.extend(<[usize; 3]>::try_from(left).ok());
    Some(found)
}

/// Whether the middle corner is convex and no other corner lies in the triangle. Corners at the
/// position of one of the three do not count, since outlines with holes traverse their bridges
/// twice.
fn is_ear(ear: [usize; 3], points: &[DVec2], left: &[usize]) -> bool {
    let [a, b, c] = ear.map(|corner| points[corner]);
    let inside =
        |p: DVec2| signed_area2(a, b, p) >= 0.0 && signed_area2(b, c, p) >= 0.0 && signed_area2(c, a, p) >= 0.0;
    signed_area2(a, b, c) > 0.0
        && left.iter().map(|corner| points[*corner]).all(|p| p == a || p == b || p == c || !inside(p))
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::vec3;

    fn triangulate(outline: &[(f32, f32)]) -> (Vec<[u32; 3]>, Vec<Vec3>, Vec<String>) {
        let positions: Vec<Vec3> = outline.iter().map(|(x, y)| vec3(*x, *y, 0.5 * x - 2.0 * y)).collect();
        let corners: Vec<u32> = (0..outline.len() as u32).collect();
        let mut faces = Faces::default();
        let mut warnings = Vec::new();
        faces.push(&corners, &MeshLimits::default()).unwrap();
        (faces.triangulate(&positions, &mut warnings), positions, warnings)
    }

    /// Asserts that the signed areas in the xy plane are positive and add up to the outline's area
    /// (shoelace formula).
    fn assert_exact_cover(outline: &[(f32, f32)]) {
        let (triangles, positions, _) = triangulate(outline);
        assert_eq!(triangles.len(), outline.len() - 2);
        let flat = |index: u32| positions[index as usize].truncate().as_dvec2();
        let areas: Vec<f64> =
            triangles.iter().map(|[a, b, c]| 0.5 * signed_area2(flat(*a), flat(*b), flat(*c))).collect();
        let next = outline.iter().cycle().skip(1);
        let shoelace: f32 = outline.iter().zip(next).map(|(a, b)| 0.5 * (a.0 * b.1 - b.0 * a.1)).sum();
        assert!(areas.iter().all(|area| area * f64::from(shoelace) >= 0.0), "{areas:?}");
        assert!((areas.iter().sum::<f64>() - f64::from(shoelace)).abs() < 1e-4, "{areas:?} against {shoelace}");
    }

    #[test]
    fn convex_polygons_are_fans() {
        let (triangles, ..) = triangulate(&[(0.0, 0.0), (2.0, 0.0), (3.0, 1.0), (1.0, 3.0), (0.0, 2.0)]);
        assert_eq!(triangles, [[0, 1, 2], [0, 2, 3], [0, 3, 4]]);
    }

    #[test]
    fn concave_quad_is_cut_at_its_notch_whichever_corner_comes_first() {
        let dart = [(0.0, 0.0), (2.0, 1.0), (0.0, 2.0), (0.5, 1.0)];
        for shift in 0..4 {
            let mut outline = dart;
            outline.rotate_left(shift);
            assert_exact_cover(&outline);
            outline.reverse();
            assert_exact_cover(&outline);
        }
    }

    #[test]
    fn combs_and_collinear_corners_are_covered_exactly() {
        let mut comb = vec![(0.0, -1.0), (20.0, -1.0)];
        for tooth in (0..20).rev() {
            let x = tooth as f32;
            comb.extend([(x + 1.0, 0.0), (x + 0.75, 3.0), (x + 0.5, 0.1)]);
        }
        assert_exact_cover(&comb);
        assert_exact_cover(&[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (2.0, 2.0), (1.0, 2.0), (0.0, 2.0)]);
    }

    #[test]
    fn no_triangle_of_a_square_with_a_corner_on_its_edge_is_flat() {
        let (triangles, positions, _) = triangulate(&[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)]);
        for [a, b, c] in triangles.iter().map(|corners| corners.map(|corner| positions[corner as usize])) {
            assert!((b - a).cross(c - a).length() > 0.1);
        }
    }

    #[test]
    fn crossed_and_shrunken_outlines_still_give_triangles() {
        assert_eq!(triangulate(&[(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)]).0.len(), 2);
        assert_eq!(triangulate(&[(1.0, 1.0); 7]).0.len(), 5);
        assert_eq!(triangulate(&[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (3.0, 0.0)]).0.len(), 2);
    }

    #[test]
    fn huge_spirals_end_as_counted_fans() {
        let outline: Vec<(f32, f32)> =
            (0..60_000_u16).map(|i| (f32::from(i % 2) * 3.0 - f32::from(i), f32::from(i % 7))).collect();
        let (triangles, _, warnings) = triangulate(&outline);
        assert_eq!(triangles.len(), outline.len() - 2);
        assert_eq!(warnings, ["1 concave polygons have too many vertices and were triangulated as if convex"]);
    }

    #[test]
    fn points_and_lines_are_counted() {
        let mut faces = Faces::default();
        let mut warnings = Vec::new();
        for corners in [&[][..], &[0], &[0, 1], &[0, 1, 2]] {
            faces.push(corners, &MeshLimits::default()).unwrap();
        }
        assert_eq!(faces.triangulate(&[Vec3::ZERO; 3], &mut warnings), [[0, 1, 2]]);
        assert_eq!(warnings, ["3 faces with fewer than 3 vertices ignored"]);
    }
}
