//! Wavefront OBJ ("Advanced Visualizer" manual, Wavefront Technologies 1992, appendix B1): polygons
//! from `v`, `vt`, `vn` and `f`.
//!
//! A corner refers to a position, texture coordinates and a normal by three indices. Corners with
//! equal triples become one vertex, in the order of their first use. Indices count from 1, or
//! backwards from -1, the last element so far. A face may refer to a position that is defined
//! further down. An undefined position is an error; undefined texture coordinates or normals are
//! dropped, since the mesh keeps its form without them. Statements without an equivalent in a
//! single mesh (groups, materials, smoothing groups, lines, curves) are counted and ignored, except
//! by [`parse_obj`], which keeps them all but lines and curves. Positions may have sRGB colors
//! after x, y and z, as MeshLab and Blender write them, or levels from 0 to 255; they become the
//! attribute `color`.

mod colors;
mod counts;
mod lenient;
mod model;
mod notes;
mod reader;
#[cfg(test)]
mod tests;

use crate::error::{MeshError, MeshErrorKind};
use crate::format::{MeshFormat, MeshFormatInfo};
use crate::limits::MeshLimits;
use crate::mesh_file::MeshFile;
use crate::pieces::{PIECE, PieceReader};
use crate::sampling::{Counts, FileSampler};
use crate::text::{Scanner, without_byte_order_mark};
use juggler_math::BuildControl;
pub use model::{ObjModel, ObjSection, is_plain_obj};
use reader::Contents;
use std::io;
use std::path::Path;

/// The format Wavefront OBJ.
pub const OBJ: MeshFormatInfo = MeshFormatInfo { name: "OBJ", extension: "obj", is_z_up: false };

/// Wavefront OBJ.
pub(crate) struct Obj;

impl MeshFormat for Obj {
    fn info(&self) -> MeshFormatInfo {
        OBJ
    }

    fn is_content(&self, bytes: &[u8]) -> bool {
        let first = Scanner::with_obj_rules(bytes).word_anywhere();
        matches!(first, Some(b"v" | b"vt" | b"vn" | b"f" | b"mtllib" | b"usemtl" | b"o" | b"g"))
    }

    fn read(&self, bytes: &[u8], limits: &MeshLimits, pieces: PieceReader<'_>) -> Result<MeshFile, MeshErrorKind> {
        reader::read(bytes, limits, pieces, false).map(|contents| contents.file)
    }

    fn counts(&self, file: &mut FileSampler) -> io::Result<Counts> {
        counts::counts(file)
    }
}

/// Parses the bytes of an OBJ with what its statements say about the faces: objects, groups,
/// materials, smoothing groups and colors of positions. `path` names the file in errors.
pub fn parse_obj(path: &Path, bytes: &[u8], limits: &MeshLimits) -> Result<ObjModel, MeshError> {
    parse_obj_with_control(path, bytes, limits, &BuildControl::default())
}

/// Parses as [`parse_obj`] does, and ends early if `control` is cancelled, with an error.
pub fn parse_obj_with_control(
    path: &Path,
    bytes: &[u8],
    limits: &MeshLimits,
    control: &BuildControl,
) -> Result<ObjModel, MeshError> {
    let in_file = |kind| MeshError { path: path.to_owned(), kind };
    limits.check_bytes(bytes.len() as u64).map_err(in_file)?;
    let pieces = PieceReader { size: PIECE, control };
    let found = reader::read(without_byte_order_mark(bytes), limits, pieces, true).map_err(in_file)?;
    let Contents { file: MeshFile { mesh, warnings, .. }, positions, marks } = found;
    let (sections, libraries) = model::sections(marks);
    Ok(ObjModel { mesh, positions, sections, libraries, warnings })
}
