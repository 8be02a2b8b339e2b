//! Points and lines as solids: spheres, and cylinders between spheres.

use super::matrix::matrix_step;
use crate::gltf::primitive::Faces;
use glam::{DAffine3, DMat3, DVec3};
use juggler_math::Vec3;
use juggler_scene::Object;
use juggler_shape::{Cylinder, Sphere};

/// Radius of points and lines, as a fraction of the diagonal of the scene's bounding box.
pub const RELATIVE_RADIUS: f64 = 0.001;

/// Spheres of points, or cylinders of lines with spheres at their ends.
pub fn solids(positions: &[Vec3], faces: &Faces, radius: f32) -> Vec<Object> {
    let sphere = |index: u32| {
        let center = positions.get(index as usize)?;
        Some(Object::new(Sphere { radius }).at(center.x, center.y, center.z))
    };
    match faces {
        Faces::Points(points) => points.iter().filter_map(|index| sphere(*index)).collect(),
        Faces::Lines(lines) => {
            let mut is_end = vec![false; positions.len()];
            for end in lines.as_flattened() {
                if let Some(slot) = is_end.get_mut(*end as usize) {
                    *slot = true;
                }
            }
            let ends = (0_u32..).zip(is_end).filter(|(_, is_end)| *is_end);
            let spheres = ends.filter_map(|(index, _)| sphere(index));
            spheres.chain(lines.iter().filter_map(|line| cylinder(positions, *line, radius))).collect()
        }
        Faces::Triangles(_) => Vec::new(),
    }
}

/// Open cylinder between two positions; `None` if they coincide.
fn cylinder(positions: &[Vec3], [from, to]: [u32; 2], radius: f32) -> Option<Object> {
    let [from, to] = [positions.get(from as usize)?, positions.get(to as usize)?].map(|end| end.as_dvec3());
    let (length, axis) = ((to - from).length(), (to - from).try_normalize()?);
    let y_max = length as f32;
    let is_valid = y_max.is_finite() && y_max > 0.0;
    let side = axis.any_orthonormal_vector();
    let turn = DMat3::from_cols(side, axis, side.cross(axis));
    let step = matrix_step(&DAffine3::from_mat3_translation(turn, from))?;
    is_valid.then(|| Object::new(Cylinder { radius, y_min: 0.0, y_max, capped: false }).transformed(step))
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
    use juggler_scene::TransformStep;

    #[test]
    fn a_line_becomes_a_cylinder_between_spheres() {
        let positions = [Vec3::new(1.0, 0.0, 0.0), Vec3::new(1.0, 0.0, 5.0), Vec3::ZERO];
        let objects = solids(&positions, &Faces::Lines(vec![[0, 1]]), 0.25);
        assert_eq!(objects.len(), 3, "two ends and a cylinder; the third vertex has no line");
        let TransformStep::Matrix(rows) = &objects[2].transform[0] else { panic!("{:?}", objects[2]) };
        // The y axis of the cylinder runs along the line.
        assert_eq!([rows[1], rows[5], rows[9]], [0.0, 0.0, 1.0]);
        assert_eq!([rows[3], rows[7], rows[11]], [1.0, 0.0, 0.0]);
        assert_eq!(solids(&positions, &Faces::Points(vec![2, 0]), 0.25).len(), 2);
        assert_eq!(solids(&positions, &Faces::Lines(vec![[0, 0]]), 0.25).len(), 1);
    }

    #[test]
    fn the_radius_holds_in_world_space() {
        assert_eq!(local_radius(0.5, &DAffine3::from_scale(DVec3::splat(-2.0))), 0.25);
        assert_eq!(local_radius(0.5, &DAffine3::from_scale(DVec3::ZERO)), 0.5);
    }
}
