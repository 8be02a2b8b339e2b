//! Morph targets: base + Σ weight · displacement, before the skin (glTF 2.0, section 3.7.2.2).
//!
//! Normals are displaced and normalized where a target has displacements of normals. If no target
//! of the mesh has any, the normals follow the morphed surface, unlike in the specification, which
//! leaves them as they are.

use super::surface_normals::turned_normals;
use super::vertices::{MorphDeltas, Vertices};
use glam::{DVec2, DVec3, DVec4};
use juggler_math::{Vec2, Vec3};

/// Error of the morph targets of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MorphError {
    /// An array of a target has another length than that of the mesh.
    #[error("morph target {target} has {found} displacements of `{attribute}`; the mesh has {expected}")]
    Count {
        /// Index of the target.
        target: usize,
        /// Name of the attribute in a file.
        attribute: &'static str,
        /// Number of displacements.
        found: usize,
        /// Number of elements in the mesh.
        expected: usize,
    },
    /// A weight is infinite or not a number.
    #[error("the weight of morph target {target} is {weight}; weights must be finite")]
    Weight {
        /// Index of the target.
        target: usize,
        /// The weight.
        weight: f64,
    },
}

/// Morphed vertices in double precision, except for attributes that a skin does not change.
#[derive(Clone, Debug)]
pub(super) struct MorphedVertices {
    pub positions: Vec<DVec3>,
    pub normals: Vec<DVec3>,
    /// Tangents without the sign of the bitangent.
    pub tangents: Vec<DVec3>,
    pub texcoords: Vec<Vec<Vec2>>,
    pub colors: Vec<[f32; 4]>,
}

/// Displacements of one attribute with their weights.
type Weighted<'a, T> = Vec<(&'a [T], f64)>;

/// Adds the displacements of `targets` times `weights` to the vertices. Targets without a weight
/// have none.
pub(super) fn morph(
    base: &Vertices,
    triangles: &[[u32; 3]],
    targets: &[MorphDeltas],
    weights: &[f64],
) -> Result<MorphedVertices, MorphError> {
    check(base, targets, weights)?;
    let active: Vec<(&MorphDeltas, f64)> =
        targets.iter().zip(weights.iter().copied()).filter(|(_, weight)| *weight != 0.0).collect();
    let position_deltas = weighted(&active, |target| &target.positions);
    let positions = displaced(base.positions.iter().map(|position| position.as_dvec3()), &position_deltas);
    let follows_surface = targets.iter().all(|target| target.normals.is_empty());
    let normals = if follows_surface && !position_deltas.is_empty() && !base.normals.is_empty() {
        turned_normals(base, triangles, &positions)
    } else {
        unit_vectors(base.normals.iter().map(|normal| normal.as_dvec3()), &weighted(&active, |target| &target.normals))
    };
    let directions = base.tangents.iter().map(|[x, y, z, _]| Vec3::new(*x, *y, *z).as_dvec3());
    let tangents = unit_vectors(directions, &weighted(&active, |target| &target.tangents));
    let texcoords = base.texcoords.iter().enumerate().map(|(set, texcoords)| {
        let deltas = weighted(&active, |target| target.texcoords.get(set).map_or(&[], Vec::as_slice));
        morphed_texcoords(texcoords, &deltas)
    });
    let texcoords = texcoords.collect();
    let colors = morphed_colors(&base.colors, &weighted(&active, |target| &target.colors));
    Ok(MorphedVertices { positions, normals, tangents, texcoords, colors })
}

/// Displacements of an attribute in the targets that have any.
fn weighted<'a, T: 'a>(
    active: &[(&'a MorphDeltas, f64)],
    deltas: impl Fn(&'a MorphDeltas) -> &'a [T],
) -> Weighted<'a, T> {
    let all = active.iter().map(|(target, weight)| (deltas(target), *weight));
    all.filter(|(deltas, _)| !deltas.is_empty()).collect()
}

fn displaced(base: impl Iterator<Item = DVec3>, deltas: &[(&[Vec3], f64)]) -> Vec<DVec3> {
    let displaced = |(vertex, base): (usize, DVec3)| {
        let moves = deltas.iter().filter_map(|(deltas, weight)| Some(deltas.get(vertex)?.as_dvec3() * *weight));
        moves.fold(base, |sum, by| sum + by)
    };
    base.enumerate().map(displaced).collect()
}

/// Displaced and normalized vectors; without displacements the vectors as they are. A vector that
/// becomes zero stays zero.
fn unit_vectors(base: impl Iterator<Item = DVec3>, deltas: &[(&[Vec3], f64)]) -> Vec<DVec3> {
    let vectors = displaced(base, deltas);
    if deltas.is_empty() {
        return vectors;
    }
    vectors.into_iter().map(DVec3::normalize_or_zero).collect()
}

fn morphed_texcoords(base: &[Vec2], deltas: &[(&[Vec2], f64)]) -> Vec<Vec2> {
    let morphed = |(vertex, base): (usize, &Vec2)| {
        let moves = deltas.iter().filter_map(|(deltas, weight)| Some(deltas.get(vertex)?.as_dvec2() * *weight));
        let sum: DVec2 = moves.fold(base.as_dvec2(), |sum, by| sum + by);
        sum.as_vec2()
    };
    base.iter().enumerate().map(morphed).collect()
}

/// Displaced colors, clamped to 0..1; without displacements the colors as they are.
fn morphed_colors(base: &[[f32; 4]], deltas: &[(&[[f32; 4]], f64)]) -> Vec<[f32; 4]> {
    if deltas.is_empty() {
        return base.to_vec();
    }
    let wide = |color: &[f32; 4]| DVec4::from_array(color.map(f64::from));
    let morphed = |(vertex, base): (usize, &[f32; 4])| {
        let moves = deltas.iter().filter_map(|(deltas, weight)| Some(wide(deltas.get(vertex)?) * *weight));
        let sum = moves.fold(wide(base), |sum, by| sum + by);
        sum.clamp(DVec4::ZERO, DVec4::ONE).as_vec4().to_array()
    };
    base.iter().enumerate().map(morphed).collect()
}

fn check(base: &Vertices, targets: &[MorphDeltas], weights: &[f64]) -> Result<(), MorphError> {
    if let Some((target, weight)) = weights.iter().copied().enumerate().find(|(_, weight)| !weight.is_finite()) {
        return Err(MorphError::Weight { target, weight });
    }
    for (target, deltas) in targets.iter().enumerate() {
        let vectors = [
            ("POSITION", deltas.positions.len(), base.positions.len()),
            ("NORMAL", deltas.normals.len(), base.normals.len()),
            ("TANGENT", deltas.tangents.len(), base.tangents.len()),
            ("COLOR_0", deltas.colors.len(), base.colors.len()),
        ];
        let sets = deltas.texcoords.iter().zip(&base.texcoords);
        let sets = sets.map(|(deltas, texcoords)| ("TEXCOORD", deltas.len(), texcoords.len()));
        for (attribute, found, expected) in vectors.into_iter().chain(sets) {
            if found != expected && found > 0 && expected > 0 {
                return Err(MorphError::Count { target, attribute, found, expected });
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests;
