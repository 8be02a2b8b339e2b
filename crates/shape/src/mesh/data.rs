//! Arrays of a triangle mesh as importers fill them in, not yet validated.

use crate::attribute::MeshAttribute;
use crate::check::{self, invalid};
use crate::{InvalidShape, triangle_geometry::TriangleGeometry};
use juggler_math::{Vec2, Vec3};
use rayon::prelude::*;
use std::collections::BTreeMap;

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
    /// Second set of surface coordinates, for textures with `uv_set` 1: empty, or one per position.
    pub uvs1: Vec<Vec2>,
    /// Tangents, object space, of any length, and the sign of the bitangent: empty, or one per
    /// position. With the shading normal N and the tangent T, the bitangent is w (N × T). A zero
    /// tangent counts as missing.
    pub tangents: Vec<[f32; 4]>,
    /// Named attributes, per vertex or per face.
    pub attributes: BTreeMap<String, MeshAttribute>,
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

    /// Bytes on the heap.
    pub fn bytes(&self) -> usize {
        let Self { positions, triangles, normals, uvs, uvs1, tangents, attributes } = self;
        let arrays = size_of_val(positions.as_slice()) + size_of_val(triangles.as_slice());
        let arrays = arrays + size_of_val(normals.as_slice()) + size_of_val(uvs.as_slice());
        let arrays = arrays + size_of_val(uvs1.as_slice()) + size_of_val(tangents.as_slice());
        arrays + attributes.values().map(|attribute| attribute.data.bytes()).sum::<usize>()
    }

    /// Tangent at barycentrics of the second and third corner of a triangle, object space, of any
    /// length, and the sign of the bitangent; `None` without tangents.
    pub(crate) fn tangent(&self, triangle: usize, at: Vec2) -> Option<(Vec3, f32)> {
        let tangents = at_corners(&self.tangents, *self.triangles.get(triangle)?)?;
        let [a, b, c] = tangents.map(|[x, y, z, _]| Vec3::new(x, y, z).normalize_or_zero());
        let blended = a * (1.0 - at.x - at.y) + b * at.x + c * at.y;
        let [sign, ..] = tangents.map(|[.., sign]| sign);
        (blended != Vec3::ZERO).then_some((blended, sign))
    }

    /// Checks that every number is finite and every index is in range; the error names the field.
    pub(super) fn check(&self) -> Result<(), InvalidShape> {
        let count = self.positions.len();
        per_position("normals", self.normals.len(), count)?;
        per_position("uvs", self.uvs.len(), count)?;
        per_position("uvs1", self.uvs1.len(), count)?;
        per_position("tangents", self.tangents.len(), count)?;
        finite("positions", self.positions.par_iter().copied())?;
        finite("normals", self.normals.par_iter().copied())?;
        finite("uvs", self.uvs.par_iter().map(|uv| uv.extend(0.0)))?;
        finite("uvs1", self.uvs1.par_iter().map(|uv| uv.extend(0.0)))?;
        finite("tangents", self.tangents.par_iter().map(|[x, y, z, _]| Vec3::new(*x, *y, *z)))?;
        if let Some(at) = self.tangents.iter().position(|[.., sign]| sign.abs() != 1.0) {
            let field = format!("tangents[{at}][3]");
            return Err(invalid(&field, format!("`{field}`, the sign of the bitangent, must be 1 or -1")));
        }
        for (name, attribute) in &self.attributes {
            attribute.check(name, count, self.triangles.len())?;
        }
        let corners = self.triangles.as_flattened();
        let Some(wrong) = corners.par_iter().position_first(|&index| index as usize >= count) else { return Ok(()) };
        let field = format!("triangles[{}][{}]", wrong / 3, wrong % 3);
        let message = format!("`{field}` is {}, but there are only {count} positions", corners[wrong]);
        Err(invalid(field, message))
    }
}

/// Values of an array at the corners of a triangle; `None` if it has too few.
pub(super) fn at_corners<T: Copy>(values: &[T], corners: [u32; 3]) -> Option<[T; 3]> {
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
