//! Arrays of a triangle mesh as importers fill them in, not yet validated.

use crate::check::{self, invalid};
use crate::{InvalidShape, triangle_geometry::TriangleGeometry};
use juggler_math::{Vec2, Vec3};
use rayon::prelude::*;

/// Arrays of a triangle mesh. Importers fill them in, [`Mesh`](super::Mesh) validates them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshData {
    /// Corner positions, object space, scene units.
    pub positions: Vec<Vec3>,
    /// Index triples into `positions`; corners run counter-clockwise seen from the front.
    pub triangles: Vec<[u32; 3]>,
    /// Shading normals, object space, of any length: empty, or one per position. A zero normal
    /// counts as missing.
    pub normals: Vec<Vec3>,
    /// Surface coordinates: empty, or one per position.
    pub uvs: Vec<Vec2>,
}

impl MeshData {
    /// Triangle with the attributes of its corners; `None` if an index is out of range.
    pub(crate) fn triangle_geometry(&self, triangle: usize) -> Option<TriangleGeometry> {
        let corners = *self.triangles.get(triangle)?;
        Some(TriangleGeometry {
            corners: at_corners(&self.positions, corners)?,
            normals: at_corners(&self.normals, corners),
            uvs: at_corners(&self.uvs, corners),
        })
    }

    /// Checks that every number is finite and every index is in range; the error names the field.
    pub(super) fn check(&self) -> Result<(), InvalidShape> {
        let count = self.positions.len();
        per_position("normals", self.normals.len(), count)?;
        per_position("uvs", self.uvs.len(), count)?;
        finite("positions", self.positions.par_iter().copied())?;
        finite("normals", self.normals.par_iter().copied())?;
        finite("uvs", self.uvs.par_iter().map(|uv| uv.extend(0.0)))?;
        let corners = self.triangles.as_flattened();
        let Some(wrong) = corners.par_iter().position_first(|&index| index as usize >= count) else { return Ok(()) };
        let field = format!("triangles[{}][{}]", wrong / 3, wrong % 3);
        let message = format!("`{field}` is {}, but there are only {count} positions", corners[wrong]);
        Err(invalid(field, message))
    }
}

fn at_corners<T: Copy>(values: &[T], corners: [u32; 3]) -> Option<[T; 3]> {
    let [a, b, c] = corners.map(|index| values.get(index as usize).copied());
    Some([a?, b?, c?])
}

fn per_position(field: &str, length: usize, positions: usize) -> Result<(), InvalidShape> {
    if length == 0 || length == positions {
        return Ok(());
    }
    Err(invalid(
        field,
        format!("`{field}` must be empty or have one entry per position ({positions}), it has {length}"),
    ))
}

fn finite(field: &str, values: impl IndexedParallelIterator<Item = Vec3>) -> Result<(), InvalidShape> {
    let within = |v: Vec3| v.abs().cmple(Vec3::splat(check::MAX_LENGTH)).all();
    match values.enumerate().find_first(|(_, v)| !within(*v)) {
        Some((i, v)) => check::point(&format!("{field}[{i}]"), v),
        None => Ok(()),
    }
}
