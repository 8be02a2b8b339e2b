//! Assembly of a mesh from the data of a reader: triangulates polygons and removes invalid normals.

use crate::error::{MeshErrorKind, quote};
use crate::faces::Faces;
use crate::mesh_file::MeshFile;
use crate::ply::NamedAttributes;
use juggler_math::{Vec2, Vec3};
use juggler_shape::MeshData;
use juggler_shape::attribute::{AttributeData, AttributeDomain, MeshAttribute};
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

/// Data of a mesh as a reader collects them. Indices of `faces` are in range.
#[derive(Default)]
pub(crate) struct MeshParts {
    /// Finite positions.
    pub positions: Vec<Vec3>,
    /// Empty, or one normal per position; a normal that is zero or not finite counts as missing.
    pub normals: Vec<Vec3>,
    /// Texture coordinates: empty, or one per position.
    pub uvs: Vec<Vec2>,
    /// Second set of texture coordinates: empty, or one per position.
    pub uvs1: Vec<Vec2>,
    /// Tangents with the sign of the bitangent: empty, or one per position.
    pub tangents: Vec<[f32; 4]>,
    /// Colors of the positions.
    pub vertex_colors: Colors,
    /// Colors of the triangles.
    pub face_colors: Colors,
    /// Attributes of the positions, in addition to colors.
    pub vertex_attributes: NamedAttributes,
    /// Attributes of the triangles, in addition to colors.
    pub face_attributes: NamedAttributes,
    /// The faces.
    pub faces: Faces,
    /// Warnings about ignored content.
    pub warnings: Vec<String>,
}

/// Linear colors of vertices or triangles.
#[derive(Default)]
pub(crate) struct Colors {
    /// Number of channels: 0 without colors, 3, or 4 with alpha.
    pub channels: usize,
    /// All channels of the first color first.
    pub values: Vec<f32>,
}

impl Colors {
    /// Appends the colors of the next piece of the file.
    pub fn extend(&mut self, piece: Self) {
        self.channels = piece.channels;
        self.values.extend(piece.values);
    }

    fn into_attribute(self, domain: AttributeDomain) -> Option<MeshAttribute> {
        let channels = u32::try_from(self.channels).ok().filter(|channels| *channels > 0)?;
        Some(MeshAttribute { domain, channels, data: AttributeData::F32(self.values) })
    }
}

impl MeshParts {
    /// Builds the mesh; an error if it has no triangles.
    pub fn assemble(self) -> Result<MeshFile, MeshErrorKind> {
        let mut warnings = self.warnings;
        let triangles = self.faces.triangulate(&self.positions, &mut warnings);
        if triangles.is_empty() {
            let note = if warnings.is_empty() { String::new() } else { format!(" ({})", warnings.join("; ")) };
            return Err(MeshErrorKind::NoTriangles { note });
        }
        let normals = clean_normals(self.normals, &mut warnings);
        let tangents = clean_tangents(self.tangents, &mut warnings);
        let colors = attributes_of_colors(self.vertex_colors, self.face_colors);
        let all = colors.into_iter().chain(self.vertex_attributes).chain(self.face_attributes);
        let attributes = distinct(all, &mut warnings);
        let mesh = MeshData {
            positions: self.positions,
            triangles,
            normals,
            uvs: self.uvs,
            uvs1: self.uvs1,
            tangents,
            attributes,
        };
        Ok(MeshFile { mesh, solids: Vec::new(), warnings })
    }
}

/// Colors as attributes. A mesh that has colors of vertices and of faces keeps those of its faces
/// under another name.
fn attributes_of_colors(vertices: Colors, faces: Colors) -> NamedAttributes {
    let vertices = vertices.into_attribute(AttributeDomain::Vertex);
    let face_name = if vertices.is_some() { "face_color" } else { "color" };
    let faces = faces.into_attribute(AttributeDomain::Face).map(|colors| (face_name.to_owned(), colors));
    vertices.map(|colors| ("color".to_owned(), colors)).into_iter().chain(faces).collect()
}

/// The first attribute of each name; a warning names all others.
pub(crate) fn distinct(
    attributes: impl Iterator<Item = (String, MeshAttribute)>,
    warnings: &mut Vec<String>,
) -> BTreeMap<String, MeshAttribute> {
    let mut kept = BTreeMap::new();
    for (name, attribute) in attributes {
        match kept.entry(name) {
            Entry::Vacant(entry) => drop(entry.insert(attribute)),
            Entry::Occupied(entry) => {
                warnings.push(format!("ignored a second attribute {}", quote(entry.key().as_bytes())));
            }
        }
    }
    kept
}

/// Sets normals that are not finite to zero, which means no normal. Returns no normals if all are
/// zero.
fn clean_normals(mut normals: Vec<Vec3>, warnings: &mut Vec<String>) -> Vec<Vec3> {
    for normal in normals.iter_mut().filter(|normal| !normal.is_finite()) {
        *normal = Vec3::ZERO;
    }
    let missing = normals.iter().filter(|normal| **normal == Vec3::ZERO).count();
    if missing == normals.len() {
        return Vec::new();
    }
    if missing > 0 {
        warnings.push(format!("{missing} vertices have no normal and are shaded flat"));
    }
    normals
}

/// Returns no tangents unless each sign of a bitangent is 1 or -1. Tangents that are not finite become
/// zero, which means no tangent.
fn clean_tangents(mut tangents: Vec<[f32; 4]>, warnings: &mut Vec<String>) -> Vec<[f32; 4]> {
    if tangents.iter().any(|[.., sign]| sign.abs() != 1.0) {
        warnings.push("tangents are ignored: a sign of the bitangent (`tw`) is neither 1 nor -1".to_owned());
        return Vec::new();
    }
    for tangent in tangents.iter_mut().filter(|tangent| !tangent.iter().all(|number| number.is_finite())) {
        let [.., sign] = *tangent;
        *tangent = [0.0, 0.0, 0.0, sign];
    }
    tangents
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::limits::MeshLimits;

    fn triangle(normals: [Vec3; 3]) -> MeshFile {
        let mut faces = Faces::default();
        faces.push_triangle([0, 1, 2], &MeshLimits::default()).unwrap();
        let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
        MeshParts { positions, normals: normals.to_vec(), faces, ..MeshParts::default() }.assemble().unwrap()
    }

    #[test]
    fn valid_normals_are_kept_and_invalid_normals_dropped() {
        let tilted = Vec3::new(0.0, 3.0, 4.0);
        assert_eq!(triangle([tilted; 3]).mesh.normals, [tilted; 3]);
        let none = triangle([Vec3::ZERO, Vec3::NAN, Vec3::INFINITY]);
        assert!(none.mesh.normals.is_empty() && none.warnings.is_empty());
        let part = triangle([tilted, Vec3::NAN, Vec3::ZERO]);
        assert_eq!(part.mesh.normals, [tilted, Vec3::ZERO, Vec3::ZERO]);
        assert_eq!(part.warnings, ["2 vertices have no normal and are shaded flat"]);
    }

    #[test]
    fn empty_mesh_error_lists_what_was_ignored() {
        let mut parts = MeshParts { warnings: vec!["2 lines".into()], ..MeshParts::default() };
        parts.faces.push(&[1], &MeshLimits::default()).unwrap();
        let error = parts.assemble().unwrap_err();
        assert_eq!(error.to_string(), "contains no triangles (2 lines; 1 faces with fewer than 3 vertices ignored)");
    }
}
