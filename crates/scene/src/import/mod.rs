//! Triangle meshes from files: Wavefront OBJ, Stanford PLY, STL.
//!
//! `{"shape": {"mesh": {"file": "models/cow.ply"}}}`
//!
//! The readers are our own. The crates that were considered do not say where a file is wrong (tobj 4.0.5 has
//! an enum without a place, stl_io 0.11.0 an `io::Error` without an offset, ply-rs-bw 4.0.1 no offset in
//! binary files), and on a million triangles they took 1.5 to 4 times as long (binary PLY 177 MB/s, here
//! 697). What the readers share is small: words and numbers (`text`), polygons (`faces`), equal vertices
//! (`weld`).
//!
//! Memory follows the bytes that are really there: counts announced by a header are checked against them
//! before anything is reserved, and against [`Limits`].

mod assemble;
mod error;
mod estimate;
mod faces;
mod foreign;
mod format;
mod obj;
mod pieces;
mod ply;
mod sniff;
mod stl;
#[cfg(test)]
mod tests;
mod text;
mod weld;

pub use error::{Fault, ImportError, Place};
pub use estimate::{Estimate, estimate};
pub use foreign::Foreign;
pub use sniff::Content;

use juggler_imaging::regular;
use juggler_shape::MeshData;
use pieces::PIECE;
use std::io::Read;
use std::path::Path;

/// A mesh, and what of the file is not in it.
#[derive(Clone, Debug, PartialEq)]
pub struct Imported {
    /// The mesh: at least one triangle, indices in range, finite positions and surface coordinates,
    /// finite normals of any length (zero: none here). Degenerate triangles are as the file has them.
    pub mesh: MeshData,
    /// What was left out or repaired, each once with a count.
    pub warnings: Vec<String>,
}

/// The most that a file may hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Size of the file in bytes.
    pub file_bytes: u64,
    /// Vertices in the file or, when that is more, in the mesh.
    pub vertices: u32,
    /// Triangles, after polygons are cut.
    pub triangles: u32,
}

impl Default for Limits {
    /// 4 GiB, and 2^28 (268 million) vertices and triangles.
    fn default() -> Self {
        Self { file_bytes: 1 << 32, vertices: 1 << 28, triangles: 1 << 28 }
    }
}

impl Limits {
    fn check_bytes(&self, found: u64) -> Result<(), Fault> {
        check("bytes", found, self.file_bytes)
    }

    fn check_vertices(&self, found: u64) -> Result<(), Fault> {
        check("vertices", found, u64::from(self.vertices))
    }

    fn check_triangles(&self, found: usize) -> Result<(), Fault> {
        check("triangles", found as u64, u64::from(self.triangles))
    }

    /// Index of one more vertex after this many.
    fn next_vertex(&self, count: usize) -> Result<u32, Fault> {
        match u32::try_from(count) {
            Ok(index) if index < self.vertices => Ok(index),
            _ => Err(too_many("vertices", (count as u64).saturating_add(1), u64::from(self.vertices))),
        }
    }
}

fn check(quantity: &'static str, found: u64, limit: u64) -> Result<(), Fault> {
    if found > limit { Err(too_many(quantity, found, limit)) } else { Ok(()) }
}

fn too_many(quantity: &'static str, found: u64, limit: u64) -> Fault {
    Fault::TooMany { quantity, found, limit }
}

/// Loads a mesh from a file named `.obj`, `.ply` or `.stl` (in any case). Content that is plainly of
/// another of these formats is read as what it is, with a warning.
pub fn load(path: &Path, limits: &Limits) -> Result<Imported, ImportError> {
    parse(path, &read(path, limits)?, limits)
}

/// The bytes of a file that [`parse`] is to be given: an ordinary one, for what waits for another program could
/// wait forever.
pub fn read(path: &Path, limits: &Limits) -> Result<Vec<u8>, ImportError> {
    read_file(path, limits).map_err(|fault| ImportError { path: path.to_owned(), fault })
}

/// As [`load`], from the bytes of a file; only the ending of `path` is looked at.
pub fn parse(path: &Path, bytes: &[u8], limits: &Limits) -> Result<Imported, ImportError> {
    let in_file = |fault| ImportError { path: path.to_owned(), fault };
    limits.check_bytes(bytes.len() as u64).map_err(in_file)?;
    // Some editors put the mark of UTF-8 before a text.
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let named = format::of_name(path);
    if let Some(foreign) = Foreign::of_content(bytes) {
        return Err(in_file(Fault::Foreign(foreign)));
    }
    let unknown = || Foreign::of_name(path).map_or(Fault::UnknownFormat, Fault::Foreign);
    let format = format::of_content(bytes).or(named).ok_or_else(|| in_file(unknown()))?;
    let mut imported = format.read(bytes, limits, PIECE).map_err(in_file)?;
    if named.is_none_or(|named| named.name() != format.name()) {
        imported.warnings.insert(0, format!("the name does not say so, but the content is {}", format.name()));
    }
    Ok(imported)
}

fn read_file(path: &Path, limits: &Limits) -> Result<Vec<u8>, Fault> {
    let file = regular::open(path)?;
    let size = file.metadata()?.len();
    limits.check_bytes(size)?;
    let mut bytes = Vec::new();
    bytes.try_reserve_exact(usize::try_from(size).unwrap_or(usize::MAX)).map_err(std::io::Error::other)?;
    // A file may grow: one byte too many is enough to know.
    file.take(limits.file_bytes.saturating_add(1)).read_to_end(&mut bytes)?;
    limits.check_bytes(bytes.len() as u64)?;
    Ok(bytes)
}
