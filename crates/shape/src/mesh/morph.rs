//! Morph targets: a mesh blended with others of as many corners (blend shapes, as in glTF 2.0,
//! section 3.7.2.2): position = base + Σ weight · (target − base).

use super::MeshData;
use crate::check::invalid;
use crate::{InvalidShape, check};
use juggler_math::{DVec3, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Morph target (blend shape) of a mesh: target positions of its corners and a weight. The mesh's
/// normals and tangents are blended with the target's normals and tangents. If a target has no
/// normals, new normals are computed from the blended surface; if a target has no tangents, the
/// mesh keeps its tangents.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
#[schemars(rename = "Morph")]
pub struct MorphTarget {
    /// Model file with as many corners as the mesh, relative to the scene file, instead of
    /// `positions`, `normals` and `tangents`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// Target positions in scene units, one for each of the mesh's.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[schemars(with = "Vec<[f32; 3]>", extend("x-unit" = "scene units"))]
    pub positions: Vec<Vec3>,
    /// Target normals, one for each position, of any length. By default the mesh's normals are
    /// computed anew from the blended surface.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[schemars(with = "Vec<[f32; 3]>")]
    pub normals: Vec<Vec3>,
    /// Target tangents, one for each position: x, y, z and a sign, which is not used. By default the
    /// mesh's tangents stay.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub tangents: Vec<[f32; 4]>,
    /// Weight of the displacement from the mesh to the target, -100 to 100: 0 has no effect, 1
    /// reaches the target, and values outside 0 to 1 extrapolate.
    #[schemars(range(min = -100, max = 100))]
    pub weight: f32,
}

/// Arrays of a morph target. Normals and tangents may be empty.
#[derive(Clone, Copy, Debug, Default)]
pub struct MorphArrays<'a> {
    /// Target positions, one for each of the mesh's.
    pub positions: &'a [Vec3],
    /// Target normals.
    pub normals: &'a [Vec3],
    /// Target tangents.
    pub tangents: &'a [[f32; 4]],
}

impl MorphTarget {
    /// Creates a target of positions, one for each of the mesh's, with a weight.
    pub fn new(positions: impl Into<Vec<Vec3>>, weight: f32) -> Self {
        Self { positions: positions.into(), weight, ..Self::default() }
    }

    /// Creates a target from a model file with a weight.
    pub fn from_file(file: impl Into<String>, weight: f32) -> Self {
        Self { file: Some(file.into()), weight, ..Self::default() }
    }

    /// Arrays of a target that has no file.
    pub fn arrays(&self) -> MorphArrays<'_> {
        MorphArrays { positions: &self.positions, normals: &self.normals, tangents: &self.tangents }
    }
}

/// Blends a mesh with targets and their weights. The error names the field at fault.
pub fn blend(data: &mut MeshData, morphs: &[(MorphArrays<'_>, f32)]) -> Result<(), InvalidShape> {
    for (i, (target, weight)) in morphs.iter().enumerate() {
        check_target(data, i, target, *weight)?;
    }
    let used: Vec<(MorphArrays<'_>, f32)> = morphs.iter().copied().filter(|(_, weight)| *weight != 0.0).collect();
    if used.is_empty() {
        return Ok(());
    }
    let sum = |base: Vec3, target: &dyn Fn(&MorphArrays<'_>) -> Option<Vec3>| {
        used.iter().fold(base, |sum, (arrays, weight)| sum + (target(arrays).unwrap_or(base) - base) * *weight)
    };
    for (corner, position) in data.positions.iter_mut().enumerate() {
        *position = sum(*position, &|target| target.positions.get(corner).copied());
    }
    if used.iter().any(|(target, _)| target.normals.is_empty()) {
        if !data.normals.is_empty() {
            data.normals = normals(data);
        }
    } else {
        for (corner, normal) in data.normals.iter_mut().enumerate() {
            *normal = sum(*normal, &|target| target.normals.get(corner).copied()).normalize_or(*normal);
        }
    }
    if used.iter().all(|(target, _)| !target.tangents.is_empty()) {
        for (corner, tangent) in data.tangents.iter_mut().enumerate() {
            let [x, y, z, sign] = *tangent;
            let target =
                |target: &MorphArrays<'_>| target.tangents.get(corner).map(|[x, y, z, _]| Vec3::new(*x, *y, *z));
            let [x, y, z] = sum(Vec3::new(x, y, z), &target).to_array();
            *tangent = [x, y, z, sign];
        }
    }
    Ok(())
}

/// Checks the weight and the arrays of a target.
fn check_target(data: &MeshData, i: usize, target: &MorphArrays<'_>, weight: f32) -> Result<(), InvalidShape> {
    let count = data.positions.len();
    if target.positions.len() != count {
        let message = format!(
            "a mesh of {count} positions cannot become one of {}: both must have the same vertices in the same order",
            target.positions.len()
        );
        return Err(invalid(format!("morphs[{i}]"), message));
    }
    if !weight.is_finite() {
        return Err(invalid(format!("morphs[{i}].weight"), "`weight` must be finite"));
    }
    for (name, length) in [("normals", target.normals.len()), ("tangents", target.tangents.len())] {
        if length != 0 && length != count {
            let message =
                format!("`{name}` has {length} elements; it must be empty or have one for each of {count} positions");
            return Err(invalid(format!("morphs[{i}].{name}"), message));
        }
    }
    target.positions.iter().try_for_each(|at| check::point(&format!("morphs[{i}]"), *at))?;
    if !target.normals.iter().all(|normal| normal.is_finite()) {
        return Err(invalid(format!("morphs[{i}].normals"), "`normals` must be finite"));
    }
    if !target.tangents.iter().flatten().all(|number| number.is_finite()) {
        return Err(invalid(format!("morphs[{i}].tangents"), "`tangents` must be finite"));
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
