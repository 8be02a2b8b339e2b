//! Transform steps of affine maps.

use crate::gltf::pose::is_invertible;
use glam::DAffine3;
use juggler_scene::TransformStep;

/// Largest coordinate that a transform may have.
const MAX_NUMBER: f64 = 1e30;

/// Transform step of a map, whose numbers are rounded to single precision once. `None` if the map
/// is singular or exceeds the range of coordinates.
pub fn matrix_step(map: &DAffine3) -> Option<TransformStep> {
    matrix_rows(map).map(|rows| TransformStep::Matrix(rows.to_vec()))
}

/// The 3 rows of the matrix of a map, as of [`matrix_step`].
pub fn matrix_rows(map: &DAffine3) -> Option<[f32; 12]> {
    let rounded = DAffine3::from_cols_array(&map.to_cols_array().map(|number| f64::from(number as f32)));
    let in_range = rounded.to_cols_array().iter().all(|number| number.abs() <= MAX_NUMBER);
    if !in_range || !is_invertible(&rounded.matrix3) {
        return None;
    }
    let [x, y, z] = [map.matrix3.x_axis, map.matrix3.y_axis, map.matrix3.z_axis];
    let t = map.translation;
    let rows = [x.x, y.x, z.x, t.x, x.y, y.y, z.y, t.y, x.z, y.z, z.z, t.z];
    Some(rows.map(|number| number as f32))
}
