//! Import of triangle meshes: Wavefront OBJ, Stanford PLY, STL.
//!
//! `{"shape": {"mesh": {"file": "models/cow.ply"}}}`
//!
//! The readers are written here because the available crates do not say where a file is wrong (tobj
//! 4.0.5 has an enum without a position, stl_io 0.11.0 an `io::Error` without an offset, ply-rs-bw
//! 4.0.1 no offset in binary files) and take 1.5 to 4 times as long on a million triangles (binary
//! PLY at 177 MB/s, here 697 MB/s). The readers share the scanner of words and numbers (`text`),
//! triangulation (`faces`) and vertex welding (`weld`).
//!
//! Memory use is bounded by the actual size of a file: counts declared by a header are checked
//! against it and against [`Limits`] before memory is allocated.

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

pub use detect::Content;
pub(crate) use detect::head;
pub use error::{FilePosition, ImportError, ImportErrorKind};
pub use estimate::{Estimate, estimate};
pub use obj::{ObjModel, ObjSection};
pub(crate) use ply::{ply_bytes, texture_file};
pub use unsupported::UnsupportedFormat;

use juggler_imaging::regular;
use juggler_shape::MeshData;
use pieces::PIECE;
use std::io::Read;
use std::path::Path;

/// An imported mesh and the warnings of its import.
#[derive(Clone, Debug, PartialEq)]
pub struct Imported {
    /// Mesh of at least one triangle, with indices in range, finite positions and texture
    /// coordinates, and finite normals of any length (zero: no normal). Degenerate triangles are
    /// kept.
    pub mesh: MeshData,
    /// Warnings about ignored and repaired content, one per kind with a count.
    pub warnings: Vec<String>,
}

/// Maximum sizes of a mesh file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Size of the file, in bytes.
    pub file_bytes: u64,
    /// Number of vertices in the file or in the mesh, whichever is larger.
    pub vertices: u32,
    /// Number of triangles after triangulation of polygons.
    pub triangles: u32,
}

impl Default for Limits {
    /// 4 GiB, and 2^28 (268 million) vertices and triangles.
    fn default() -> Self {
        Self { file_bytes: 1 << 32, vertices: 1 << 28, triangles: 1 << 28 }
    }
}

impl Limits {
    fn check_bytes(&self, found: u64) -> Result<(), ImportErrorKind> {
        check("bytes", found, self.file_bytes)
    }

    fn check_vertices(&self, found: u64) -> Result<(), ImportErrorKind> {
        check("vertices", found, u64::from(self.vertices))
    }

    fn check_triangles(&self, found: usize) -> Result<(), ImportErrorKind> {
        check("triangles", found as u64, u64::from(self.triangles))
    }

    /// Returns the index of the next vertex after `count` vertices, or an error beyond the limit.
    fn next_vertex(&self, count: usize) -> Result<u32, ImportErrorKind> {
        match u32::try_from(count) {
            Ok(index) if index < self.vertices => Ok(index),
            _ => Err(too_many("vertices", (count as u64).saturating_add(1), u64::from(self.vertices))),
        }
    }
}

fn check(quantity: &'static str, found: u64, limit: u64) -> Result<(), ImportErrorKind> {
    if found > limit { Err(too_many(quantity, found, limit)) } else { Ok(()) }
}

fn too_many(quantity: &'static str, found: u64, limit: u64) -> ImportErrorKind {
    ImportErrorKind::TooMany { quantity, found, limit }
}

/// Loads a mesh from a file named `.obj`, `.ply` or `.stl` (in any case). If the content is clearly
/// of another of these formats, it is read as that format, with a warning.
pub fn load(path: &Path, limits: &Limits) -> Result<Imported, ImportError> {
    parse(path, &read(path, limits)?, limits)
}

/// Reads the bytes of a mesh file for [`parse`]. Only regular files are accepted, since reading a
/// pipe may block forever.
pub fn read(path: &Path, limits: &Limits) -> Result<Vec<u8>, ImportError> {
    read_file(path, limits).map_err(|kind| ImportError { path: path.to_owned(), kind })
}

/// Parses the bytes of a mesh file as [`load`] does. Only the extension of `path` is used.
pub fn parse(path: &Path, bytes: &[u8], limits: &Limits) -> Result<Imported, ImportError> {
    let in_file = |kind| ImportError { path: path.to_owned(), kind };
    limits.check_bytes(bytes.len() as u64).map_err(in_file)?;
    // Skip a UTF-8 byte order mark.
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let named = format::of_name(path);
    if let Some(foreign) = UnsupportedFormat::of_content(bytes) {
        return Err(in_file(ImportErrorKind::Unsupported(foreign)));
    }
    let unknown =
        || UnsupportedFormat::of_name(path).map_or(ImportErrorKind::UnknownFormat, ImportErrorKind::Unsupported);
    let format = format::of_content(bytes).or(named).ok_or_else(|| in_file(unknown()))?;
    let mut imported = format.read(bytes, limits, PIECE).map_err(in_file)?;
    if named.is_none_or(|named| named.name() != format.name()) {
        imported
            .warnings
            .insert(0, format!("the file's extension does not match its content, which is {}", format.name()));
    }
    Ok(imported)
}

/// Parses the bytes of an OBJ with what its statements say about the faces: objects, groups,
/// materials, smoothing groups and colors of positions. `path` names the file in errors.
pub fn parse_obj(path: &Path, bytes: &[u8], limits: &Limits) -> Result<ObjModel, ImportError> {
    let in_file = |kind| ImportError { path: path.to_owned(), kind };
    limits.check_bytes(bytes.len() as u64).map_err(in_file)?;
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    obj::read_model(bytes, limits).map_err(in_file)
}

fn read_file(path: &Path, limits: &Limits) -> Result<Vec<u8>, ImportErrorKind> {
    let file = regular::open(path)?;
    let size = file.metadata()?.len();
    limits.check_bytes(size)?;
    let mut bytes = Vec::new();
    bytes.try_reserve_exact(usize::try_from(size).unwrap_or(usize::MAX)).map_err(std::io::Error::other)?;
    // The file may have grown: one byte beyond the limit suffices to detect that.
    file.take(limits.file_bytes.saturating_add(1)).read_to_end(&mut bytes)?;
    limits.check_bytes(bytes.len() as u64)?;
    Ok(bytes)
}
