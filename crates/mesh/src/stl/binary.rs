//! Binary STL, little-endian: 80 arbitrary bytes, the number of facets, and 50 bytes a facet
//! (normal, three corners, two attribute bytes).

use super::facets::{AllFacets, WeldedFacets};
use crate::error::{FilePosition, MeshErrorKind};
use crate::limits::MeshLimits;
use crate::mesh_file::MeshFile;
use crate::pieces::PieceReader;
use crate::text::Scanner;
use juggler_math::Vec3;

const HEADER: usize = 80;
const FACETS: usize = HEADER + 4;
/// Size of a facet, in bytes.
pub(super) const FACET: usize = 50;

/// Whether the file's length matches its facet count exactly. No text does: letters and digits in
/// place of the count would declare more than 500 million facets.
pub(crate) fn is_binary(bytes: &[u8]) -> bool {
    declared_size(bytes) == Some(bytes.len() as u64)
}

/// Length in bytes that a binary STL with these first bytes has.
pub(crate) fn declared_size(bytes: &[u8]) -> Option<u64> {
    count(bytes).map(|count| FACETS as u64 + count * FACET as u64)
}

fn count(bytes: &[u8]) -> Option<u64> {
    let field = bytes.get(HEADER..)?.first_chunk()?;
    Some(u64::from(u32::from_le_bytes(*field)))
}

/// Reads a whole file in pieces.
pub(super) fn read(bytes: &[u8], limits: &MeshLimits, reader: PieceReader<'_>) -> Result<MeshFile, MeshErrorKind> {
    let short = || {
        FilePosition::Byte(bytes.len() as u64).error("expected an STL file: text, or 80 bytes and the number of facets")
    };
    let count = count(bytes).ok_or_else(short)?;
    let body = bytes.get(FACETS..).unwrap_or_default();
    if count * FACET as u64 > body.len() as u64 {
        let held = body.len() / FACET;
        return Err(FilePosition::Byte(HEADER as u64).error(format!(
            "the header declares {count} facets of {FACET} bytes, but the {} bytes that follow contain only {held}",
            body.len()
        )));
    }
    let count = usize::try_from(count).unwrap_or(usize::MAX);
    limits.check_triangles(count)?;
    let facets = body.get(..count * FACET).unwrap_or_default();
    let pieces: Vec<&[u8]> = facets.chunks((reader.size / FACET).max(1) * FACET).collect();
    let mut all_facets = AllFacets::with_capacity(count);
    all_facets.begin_solid(name(bytes.get(..HEADER).unwrap_or_default()));
    let mut colored = 0;
    reader.read(
        &pieces,
        |piece| read_piece(piece, limits),
        |(welded, colors)| {
            colored += colors;
            all_facets.append(welded, limits)
        },
    )?;
    let mut warnings = Vec::new();
    if colored > 0 {
        warnings.push(format!("attributes (colors) of {colored} facets ignored"));
    }
    if let trailing @ 1.. = body.len() - count * FACET {
        warnings.push(format!("{trailing} bytes after the last facet ignored"));
    }
    all_facets.finish(warnings, limits, reader.control)
}

/// Name of the only solid, if the header begins with the line of a text: `solid NAME`.
fn name(header: &[u8]) -> &[u8] {
    let mut scanner = Scanner::new(header);
    let is_solid = scanner.word_anywhere().is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    let rest = scanner.rest_of_line();
    if is_solid && !scanner.rest().is_empty() { rest } else { &[] }
}

/// Reads the facets of a piece and counts those that have attributes.
fn read_piece(facets: &[u8], limits: &MeshLimits) -> Result<(WeldedFacets, u64), MeshErrorKind> {
    let mut welded = WeldedFacets::default();
    let mut colored = 0;
    for facet in facets.chunks_exact(FACET) {
        welded.push([corner(facet, 12), corner(facet, 24), corner(facet, 36)], limits)?;
        colored += u64::from(!facet.ends_with(&[0, 0]));
    }
    Ok((welded, colored))
}

fn corner(facet: &[u8], at: usize) -> Vec3 {
    let number = |offset| {
        let field = facet.get(at + offset..).and_then(<[u8]>::first_chunk);
        field.map_or(f32::NAN, |field| f32::from_le_bytes(*field))
    };
    Vec3::new(number(0), number(4), number(8))
}
