//! Morph targets: a mesh blended with others of as many corners (blend shapes, as in glTF 2.0,
//! section 3.7.2.2): position = base + Σ weight · (target − base).

use super::MeshData;
use crate::check::invalid;
use crate::{InvalidShape, check};
use juggler_math::{DVec3, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Morph target (blend shape) of a mesh: target positions of its corners and a weight. The mesh's
/// shading normals are computed anew from the blended surface.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
#[schemars(rename = "Morph")]
pub struct MorphTarget {
    /// Model file with as many corners as the mesh, relative to the scene file, instead of
    /// `positions`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// Target positions in scene units, one for each of the mesh's.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[schemars(with = "Vec<[f32; 3]>", extend("x-unit" = "scene units"))]
    pub positions: Vec<Vec3>,
    /// Weight of the displacement from the mesh to the target, -100 to 100: 0 has no effect, 1
    /// reaches the target, and values outside 0 to 1 extrapolate.
    #[schemars(range(min = -100, max = 100))]
    pub weight: f32,
}

/// Blends the positions of a mesh with target positions and their weights, and computes its normals
/// anew. The error names the field at fault.
pub fn blend(data: &mut MeshData, morphs: &[(&[Vec3], f32)]) -> Result<(), InvalidShape> {
    for (i, (positions, weight)) in morphs.iter().enumerate() {
        if positions.len() != data.positions.len() {
            let field = format!("morphs[{i}]");
            let message = format!(
                "a mesh of {} positions cannot become one of {}: both must have the same vertices in the same order",
                data.positions.len(),
                positions.len()
            );
            return Err(invalid(field, message));
        }
        if !weight.is_finite() {
            return Err(invalid(format!("morphs[{i}].weight"), "`weight` must be finite"));
        }
        positions.iter().try_for_each(|at| check::point(&format!("morphs[{i}]"), *at))?;
    }
    if morphs.iter().all(|(_, weight)| *weight == 0.0) {
        return Ok(());
    }
    for (corner, position) in data.positions.iter_mut().enumerate() {
        let base = *position;
        for (positions, weight) in morphs {
            *position += (positions.get(corner).copied().unwrap_or(base) - base) * *weight;
        }
    }
    if !data.normals.is_empty() {
        data.normals = normals(data);
    }
    Ok(())
}

/// Shading normals of the surface: at each corner the mean of its triangles' normals, weighted by
/// area.
fn normals(data: &MeshData) -> Vec<Vec3> {
    let mut sums = vec![DVec3::ZERO; data.positions.len()];
    for (triangle, corners) in data.triangles.iter().enumerate() {
        let Some(triangle) = data.triangle_geometry(triangle) else { continue };
        for corner in corners {
            if let Some(sum) = sums.get_mut(*corner as usize) {
                *sum += triangle.area_normal();
            }
        }
    }
    sums.into_iter().map(|sum| sum.normalize_or_zero().as_vec3()).collect()
}
