//! Mesh files: readers of Wavefront OBJ, Stanford PLY and STL, and a writer of PLY.
//!
//! [`load`] reads a file of any of these formats as one mesh, and [`parse_obj`] an OBJ with what its
//! statements say about the faces.
//!
//! The readers are written here because the available crates do not say where a file is wrong (tobj
//! 4.0.5 has an enum without a position, stl_io 0.11.0 an `io::Error` without an offset, ply-rs-bw
//! 4.0.1 no offset in binary files) and take 1.5 to 4 times as long on a million triangles (binary
//! PLY at 177 MB/s, here 697 MB/s). The readers share the scanner of words and numbers (`text`),
//! triangulation (`faces`) and vertex welding (`weld`).
//!
//! Memory use is bounded by the actual size of a file: counts declared by a header are checked
//! against it and against [`MeshLimits`] before memory is allocated.

mod assemble;
mod detect;
mod error;
mod estimate;
mod faces;
mod format;
mod obj;
mod pieces;
mod ply;
mod stl;
#[cfg(test)]
mod tests;
mod text;
mod unsupported;
mod weld;

pub use detect::FileContent;
pub use error::{FilePosition, MeshError, MeshErrorKind};
pub use estimate::{MeshEstimate, estimate};
pub use obj::{ObjModel, ObjSection};
pub use ply::{ply_bytes, texture_file};
pub use unsupported::UnsupportedFormat;

use juggler_imaging::regular;
use juggler_shape::MeshData;
use pieces::PIECE;
use std::path::Path;

/// Contents of a mesh file: its mesh, and the warnings of its reader.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshFile {
    /// Mesh of at least one triangle, with indices in range, finite positions and texture
    /// coordinates, and finite normals of any length (zero: no normal). Degenerate triangles are
    /// kept.
    pub mesh: MeshData,
    /// Warnings about ignored and repaired content, one per kind with a count.
    pub warnings: Vec<String>,
}

/// Maximum sizes of a mesh file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MeshLimits {
    /// Size of the file, in bytes.
    pub file_bytes: u64,
    /// Number of vertices in the file or in the mesh, whichever is larger.
    pub vertices: u32,
    /// Number of triangles after triangulation of polygons.
    pub triangles: u32,
}

impl Default for MeshLimits {
    /// 4 GiB, and 2^28 (268 million) vertices and triangles.
    fn default() -> Self {
        Self { file_bytes: 1 << 32, vertices: 1 << 28, triangles: 1 << 28 }
    }
}

impl MeshLimits {
    fn check_bytes(&self, found: u64) -> Result<(), MeshErrorKind> {
        check("bytes", found, self.file_bytes)
    }

    fn check_vertices(&self, found: u64) -> Result<(), MeshErrorKind> {
        check("vertices", found, u64::from(self.vertices))
    }

    fn check_triangles(&self, found: usize) -> Result<(), MeshErrorKind> {
        check("triangles", found as u64, u64::from(self.triangles))
    }

    /// Returns the index of the next vertex after `count` vertices, or an error beyond the limit.
    fn next_vertex(&self, count: usize) -> Result<u32, MeshErrorKind> {
        match u32::try_from(count) {
            Ok(index) if index < self.vertices => Ok(index),
            _ => Err(too_many("vertices", (count as u64).saturating_add(1), u64::from(self.vertices))),
        }
    }
}

fn check(quantity: &'static str, found: u64, limit: u64) -> Result<(), MeshErrorKind> {
    if found > limit { Err(too_many(quantity, found, limit)) } else { Ok(()) }
}

fn too_many(quantity: &'static str, found: u64, limit: u64) -> MeshErrorKind {
    MeshErrorKind::TooMany { quantity, found, limit }
}

/// Loads a mesh from a file named `.obj`, `.ply` or `.stl` (in any case). If the content is clearly
/// of another of these formats, it is read as that format, with a warning.
pub fn load(path: &Path, limits: &MeshLimits) -> Result<MeshFile, MeshError> {
    let bytes = regular::read(path, limits.file_bytes);
    parse(path, &bytes.map_err(|error| MeshError { path: path.to_owned(), kind: error.into() })?, limits)
}

/// Parses the bytes of a mesh file as [`load`] does. Only the extension of `path` is used.
pub fn parse(path: &Path, bytes: &[u8], limits: &MeshLimits) -> Result<MeshFile, MeshError> {
    let in_file = |kind| MeshError { path: path.to_owned(), kind };
    limits.check_bytes(bytes.len() as u64).map_err(in_file)?;
    // Skip a UTF-8 byte order mark.
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let named = format::of_name(path);
    if let Some(foreign) = UnsupportedFormat::of_content(bytes) {
        return Err(in_file(MeshErrorKind::Unsupported(foreign)));
    }
    let unknown = || UnsupportedFormat::of_name(path).map_or(MeshErrorKind::UnknownFormat, MeshErrorKind::Unsupported);
    let format = format::of_content(bytes).or(named).ok_or_else(|| in_file(unknown()))?;
    let mut found = format.read(bytes, limits, PIECE).map_err(in_file)?;
    if named.is_none_or(|named| named.name() != format.name()) {
        found
            .warnings
            .insert(0, format!("the file's extension does not match its content, which is {}", format.name()));
    }
    Ok(found)
}

/// Parses the bytes of an OBJ with what its statements say about the faces: objects, groups,
/// materials, smoothing groups and colors of positions. `path` names the file in errors.
pub fn parse_obj(path: &Path, bytes: &[u8], limits: &MeshLimits) -> Result<ObjModel, MeshError> {
    let in_file = |kind| MeshError { path: path.to_owned(), kind };
    limits.check_bytes(bytes.len() as u64).map_err(in_file)?;
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    obj::read_model(bytes, limits).map_err(in_file)
}
