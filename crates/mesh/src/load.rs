//! Reading of mesh files of all formats.

use crate::error::{MeshError, MeshErrorKind};
use crate::formats;
use crate::limits::MeshLimits;
use crate::mesh_file::MeshFile;
use crate::pieces::{PIECE, PieceReader};
use crate::text::without_byte_order_mark;
use crate::unsupported::UnsupportedFormat;
use juggler_imaging::regular;
use juggler_math::BuildControl;
use std::path::Path;

/// Loads a mesh from a file. The extension of its name selects the format, in any case. If the
/// content is clearly of another supported format, it is read as that format, with a warning.
pub fn load(path: &Path, limits: &MeshLimits) -> Result<MeshFile, MeshError> {
    let bytes = regular::read(path, limits.file_bytes);
    parse(path, &bytes.map_err(|error| MeshError { path: path.to_owned(), kind: error.into() })?, limits)
}

/// Parses the bytes of a mesh file as [`load`] does. Only the extension of `path` is used.
pub fn parse(path: &Path, bytes: &[u8], limits: &MeshLimits) -> Result<MeshFile, MeshError> {
    parse_with_control(path, bytes, limits, &BuildControl::default())
}

/// Parses as [`parse`] does, and ends early if `control` is cancelled, with an error.
pub fn parse_with_control(
    path: &Path,
    bytes: &[u8],
    limits: &MeshLimits,
    control: &BuildControl,
) -> Result<MeshFile, MeshError> {
    let in_file = |kind| MeshError { path: path.to_owned(), kind };
    limits.check_bytes(bytes.len() as u64).map_err(in_file)?;
    let bytes = without_byte_order_mark(bytes);
    let named = formats::of_name(path);
    let unsupported = |foreign: UnsupportedFormat| MeshErrorKind::Unsupported(foreign.to_string());
    if let Some(foreign) = UnsupportedFormat::of_content(bytes) {
        return Err(in_file(unsupported(foreign)));
    }
    let unknown = || MeshErrorKind::UnknownFormat { extensions: formats::extensions() };
    let refused = || UnsupportedFormat::of_name(path).map_or_else(unknown, unsupported);
    let format = formats::of_content(bytes).or(named).ok_or_else(|| in_file(refused()))?;
    let mut found = format.read(bytes, limits, PieceReader { size: PIECE, control }).map_err(in_file)?;
    let name = format.info().name;
    if named.is_none_or(|named| named.info().name != name) {
        found.warnings.insert(0, format!("the file's extension does not match its content, which is {name}"));
    }
    Ok(found)
}
