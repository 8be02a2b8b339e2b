//! Points and lines as solids: instances of a sphere and of a cylinder, of a width that a picture
//! shows.

use super::matrix::matrix_rows;
use crate::gltf::pose::Vertices;
use crate::gltf::primitive::Faces;
use glam::{DAffine3, DMat3, DVec3};
use juggler_math::Vec3;
use juggler_scene::{Instances, Object};
use juggler_shape::{Cylinder, Sphere};

/// Least radius of points and lines, as a fraction of the diagonal of the scene's bounding box.
const RELATIVE_RADIUS: f64 = 0.001;
/// Width of points and lines in pixels at the center of the view that frames the model.
const WIDTH: f64 = 2.0;
/// Distance of the framing camera from the center, in diagonals of the bounding box, times the
/// height of the view there per distance: 1.05 tan(20°) / sin(20°) for a picture that is at least
/// as wide as high (`camera` in `scene/src/compile/defaults.rs`).
const VIEW_HEIGHT: f64 = 1.1174;
/// Length of a segment between equal positions, relative to the radius: the segments of all times
/// correspond.
const LEAST_LENGTH: f64 = 1e-3;

/// Radius as a fraction of the diagonal of the scene's bounding box, for a picture of `size` pixels.
pub fn relative_radius(size: Option<[u32; 2]>) -> f64 {
    let Some([width, height]) = size else { return RELATIVE_RADIUS };
    // Where the picture is narrow, the camera stands back until the model fits the width.
    let pixels = f64::from(width.min(height).max(1));
    (0.5 * WIDTH * VIEW_HEIGHT / pixels).max(RELATIVE_RADIUS)
}

/// Spheres of points, or cylinders of lines with spheres at their ends. Equal points and lines of
/// equal ends count once.
pub fn solids(vertices: &Vertices, faces: &Faces, radius: f32) -> Vec<Object> {
    match faces {
        Faces::Points(points) => spheres(vertices, points, radius).into_iter().collect(),
        Faces::Lines(lines) => {
            let ends = spheres(vertices, lines.as_flattened(), radius);
            ends.into_iter().chain(cylinders(vertices, lines, radius)).collect()
        }
        Faces::Triangles(_) => Vec::new(),
    }
}

/// Spheres at the vertices of these indices; `None` if there are none.
fn spheres(vertices: &Vertices, indices: &[u32], radius: f32) -> Option<Object> {
    let mut is_used = vec![false; vertices.positions.len()];
    for index in indices {
        if let Some(slot) = is_used.get_mut(*index as usize) {
            *slot = true;
        }
    }
    let used = || is_used.iter().zip(0_u32..).filter(|(is_used, _)| **is_used).map(|(_, index)| index);
    let positions = used().filter_map(|index| vertices.positions.get(index as usize).copied());
    let colors = used().filter_map(|index| color(vertices, index)).collect();
    let instances = Instances { positions: positions.collect(), colors, ..Instances::default() };
    (instances.count() > 0).then(|| Object::new(Sphere { radius }).instances(instances))
}

/// Open cylinders of the lines, from the first to the second vertex; `None` if there are none.
fn cylinders(vertices: &Vertices, lines: &[[u32; 2]], radius: f32) -> Option<Object> {
    let mut lines: Vec<[u32; 2]> = lines.iter().map(|[a, b]| [*a.min(b), *a.max(b)]).collect();
    lines.sort_unstable();
    lines.dedup();
    let placed = lines.iter().filter_map(|line| Some((*line, placement(vertices, *line, radius)?)));
    let (lines, matrices): (Vec<[u32; 2]>, Vec<[f32; 12]>) = placed.unzip();
    let colors = |end: usize| lines.iter().filter_map(|line| color(vertices, *line.get(end)?)).collect();
    let (colors, end_colors) = (colors(0), colors(1));
    let instances = Instances { colors, end_colors, ..Instances::from_matrices(matrices) };
    let cylinder = Cylinder { radius, y_min: 0.0, y_max: 1.0, capped: false };
    (instances.count() > 0).then(|| Object::new(cylinder).instances(instances))
}

/// Matrix that takes the cylinder of length 1 to a line; `None` outside the range of coordinates.
fn placement(vertices: &Vertices, [from, to]: [u32; 2], radius: f32) -> Option<[f32; 12]> {
    let end = |index: u32| vertices.positions.get(index as usize).copied().map(Vec3::as_dvec3);
    let (from, to) = (end(from)?, end(to)?);
    let axis = (to - from).try_normalize().unwrap_or(DVec3::Y);
    let length = (to - from).length().max(LEAST_LENGTH * f64::from(radius));
    let side = axis.any_orthonormal_vector();
    matrix_rows(&DAffine3::from_mat3_translation(DMat3::from_cols(side, axis * length, side.cross(axis)), from))
}

/// Color of a vertex; `None` without colors.
fn color(vertices: &Vertices, index: u32) -> Option<[f32; 4]> {
    vertices.colors.get(index as usize).map(|color| color.map(|channel| channel.clamp(0.0, 1.0)))
}

/// Radius in the space of a node, so that it is `radius` in world space where the scale is even.
pub fn local_radius(radius: f64, world: &DAffine3) -> f32 {
    let [x, y, z] = [world.matrix3.x_axis, world.matrix3.y_axis, world.matrix3.z_axis].map(DVec3::length);
    let scale = ((x * x + y * y + z * z) / 3.0).sqrt();
    let local = radius / scale;
    let local = if local.is_finite() && local > 0.0 { local } else { radius };
    (local as f32).clamp(f32::MIN_POSITIVE, 1e30)
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::Transform;

    const RED: [f32; 4] = [1.0, 0.0, 0.0, 1.0];
    const BLUE: [f32; 4] = [0.0, 0.0, 1.0, 0.5];

    fn vertices(colors: &[[f32; 4]]) -> Vertices {
        let positions = vec![Vec3::new(1.0, 0.0, 0.0), Vec3::new(1.0, 0.0, 5.0), Vec3::ZERO];
        Vertices { positions, colors: colors.to_vec(), ..Vertices::default() }
    }

    fn instances(object: &Object) -> &Instances {
        object.instances.as_ref().unwrap_or_else(|| panic!("{object:?}"))
    }

    #[test]
    fn a_line_becomes_a_cylinder_between_spheres() {
        let objects = solids(&vertices(&[RED, BLUE, RED]), &Faces::Lines(vec![[1, 0], [0, 1]]), 0.25);
        let [spheres, cylinders] = objects.as_slice() else { panic!("{objects:?}") };
        let spheres = instances(spheres);
        assert_eq!(*spheres.positions, [Vec3::X, Vec3::new(1.0, 0.0, 5.0)], "the third vertex has no line");
        assert_eq!(*spheres.colors, [RED, BLUE]);
        let lines = instances(cylinders);
        let placed: Vec<Transform> = lines.transforms().unwrap();
        let [line] = placed.as_slice() else { panic!("equal lines count once: {placed:?}") };
        for (y, expected) in [(0.0, Vec3::X), (1.0, Vec3::new(1.0, 0.0, 5.0))] {
            assert!(line.point(Vec3::Y * y).abs_diff_eq(expected, 1e-6));
        }
        let across = line.point(Vec3::X * 0.25) - Vec3::X;
        assert!((across.length() - 0.25).abs() < 1e-6 && across.z.abs() < 1e-6, "the radius stays: {across}");
        assert_eq!((&*lines.colors, &*lines.end_colors), ([RED].as_slice(), [BLUE].as_slice()));
    }

    #[test]
    fn points_are_spheres_of_distinct_vertices() {
        let objects = solids(&vertices(&[]), &Faces::Points(vec![2, 0, 2]), 0.25);
        let [spheres] = objects.as_slice() else { panic!("{objects:?}") };
        assert_eq!(*instances(spheres).positions, [Vec3::X, Vec3::ZERO]);
        assert!(instances(spheres).colors.is_empty());
        assert!(solids(&vertices(&[]), &Faces::Points(Vec::new()), 0.25).is_empty());
    }

    #[test]
    fn lines_without_length_stay_so_that_all_times_correspond() {
        let objects = solids(&vertices(&[]), &Faces::Lines(vec![[0, 0], [1, 2]]), 0.25);
        let lines = instances(&objects[1]);
        assert_eq!(lines.count(), 2);
        let length = lines.transforms().unwrap()[0].vector(Vec3::Y).length();
        assert!((length - 0.25e-3).abs() < 1e-6, "{length}");
    }

    #[test]
    fn the_radius_holds_in_world_space() {
        assert_eq!(local_radius(0.5, &DAffine3::from_scale(DVec3::splat(-2.0))), 0.25);
        assert_eq!(local_radius(0.5, &DAffine3::from_scale(DVec3::ZERO)), 0.5);
    }
}
