//! Deformation of a mesh: morph targets, then the skin, in double precision; the result is rounded
//! to single precision once.

use super::morph::{MorphError, MorphedVertices, morph};
use super::skin::{SkinBinding, SkinCounts, SkinError};
use super::vertices::{MorphDeltas, Vertices};
use juggler_math::Aabb;

/// Error of a deformation.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DeformError {
    /// The morph targets do not fit the mesh.
    #[error(transparent)]
    Morph(#[from] MorphError),
    /// The skin does not fit the mesh.
    #[error(transparent)]
    Skin(#[from] SkinError),
    /// A deformed attribute exceeds the range of single precision.
    #[error("the pose gives vertex {vertex} numbers beyond the range of single precision")]
    NotFinite {
        /// Index of the vertex.
        vertex: usize,
    },
}

/// Morph targets of a mesh and their weights.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MorphBinding<'a> {
    /// The targets.
    pub targets: &'a [MorphDeltas],
    /// A weight for each target; targets beyond the last weight have none.
    pub weights: &'a [f64],
}

/// A deformed mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Deformed {
    /// Vertices: in world space with a skin, else in the space of the node that draws the mesh.
    pub vertices: Vertices,
    /// Bounding box of the positions.
    pub bounds: Aabb,
    /// Number of vertices whose joint weights have a positive sum that deviates from 1 by more than
    /// 1e-3. The weights are divided by their sum.
    pub renormalized: usize,
    /// Number of vertices without joint weights. The skin leaves them in place.
    pub unweighted: usize,
    /// Number of vertices that the skin reflects. Their normals stay on the outside, but the
    /// corners of their triangles run clockwise seen from there, and the sign of their bitangents
    /// is wrong.
    pub mirrored: usize,
}

/// Deforms a mesh by its morph targets and a skin. `triangles` are needed where the morph targets
/// have no normals.
pub fn deform(
    base: &Vertices,
    triangles: &[[u32; 3]],
    morphs: MorphBinding<'_>,
    skin: Option<&SkinBinding<'_>>,
) -> Result<Deformed, DeformError> {
    let morphed = morph(base, triangles, morphs.targets, morphs.weights)?;
    let (vertices, counts) = match skin {
        Some(skin) => skin.skin(morphed)?,
        None => (morphed, SkinCounts::default()),
    };
    let vertices = rounded(vertices, base);
    if let Some(vertex) = not_finite(&vertices) {
        return Err(DeformError::NotFinite { vertex });
    }
    let bounds = Aabb::from_points(vertices.positions.iter().copied());
    let SkinCounts { renormalized, unweighted, mirrored } = counts;
    Ok(Deformed { vertices, bounds, renormalized, unweighted, mirrored })
}

/// A vertex with a number that is not finite. Normals and tangents become zero instead, and colors
/// are clamped.
fn not_finite(vertices: &Vertices) -> Option<usize> {
    let position = vertices.positions.iter().position(|position| !position.is_finite());
    let texcoord = || vertices.texcoords.iter().find_map(|set| set.iter().position(|texcoord| !texcoord.is_finite()));
    position.or_else(texcoord)
}

fn rounded(vertices: MorphedVertices, base: &Vertices) -> Vertices {
    let tangents = vertices.tangents.iter().zip(&base.tangents).map(|(direction, [.., sign])| {
        let [x, y, z] = direction.as_vec3().to_array();
        [x, y, z, *sign]
    });
    Vertices {
        positions: vertices.positions.iter().map(|position| position.as_vec3()).collect(),
        normals: vertices.normals.iter().map(|normal| normal.as_vec3()).collect(),
        tangents: tangents.collect(),
        texcoords: vertices.texcoords,
        colors: vertices.colors,
    }
}

#[cfg(test)]
mod tests;
