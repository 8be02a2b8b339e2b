//! Binary STL: 80 bytes of anything, a count, and 50 bytes a facet (normal, three corners, two bytes for
//! colours), little-endian.

use super::super::error::{Fault, Place};
use super::super::pieces::read_pieces;
use super::super::weld::Welded;
use super::super::{Imported, Limits};
use super::{Soup, Soups};
use juggler_math::Vec3;

const HEADER: usize = 80;
const FACETS: usize = HEADER + 4;
const FACET: usize = super::FACET as usize;

/// Whether the file is exactly as long as its facet count says. No text can be: where the count stands,
/// letters and digits would promise more than 500 million facets.
pub(in super::super) fn is_binary(bytes: &[u8]) -> bool {
    announced(bytes) == Some(bytes.len() as u64)
}

/// Bytes that the file has if it is a binary STL, by its first ones.
pub(in super::super) fn announced(bytes: &[u8]) -> Option<u64> {
    count(bytes).map(|count| FACETS as u64 + count * FACET as u64)
}

fn count(bytes: &[u8]) -> Option<u64> {
    let field = bytes.get(HEADER..)?.first_chunk()?;
    Some(u64::from(u32::from_le_bytes(*field)))
}

/// Reads a whole file in pieces of about this many bytes.
pub(super) fn read(bytes: &[u8], limits: &Limits, piece: usize) -> Result<Imported, Fault> {
    let short = || Place::Byte(bytes.len() as u64).fault("expected an STL: text, or 80 bytes and a count of facets");
    let count = count(bytes).ok_or_else(short)?;
    let body = bytes.get(FACETS..).unwrap_or_default();
    if count * FACET as u64 > body.len() as u64 {
        let held = body.len() / FACET;
        return Err(Place::Byte(HEADER as u64).fault(format!(
            "{count} facets of {FACET} bytes are announced, but the {} bytes that follow hold only {held}",
            body.len()
        )));
    }
    let count = usize::try_from(count).unwrap_or(usize::MAX);
    limits.check_triangles(count)?;
    let facets = body.get(..count * FACET).unwrap_or_default();
    let pieces: Vec<&[u8]> = facets.chunks((piece / FACET).max(1) * FACET).collect();
    let mut soups = Soups { welded: Welded::with_capacity(count), ..Soups::default() };
    let mut colored = 0;
    read_pieces(
        &pieces,
        |piece| read_piece(piece, limits),
        |(soup, colors)| {
            colored += colors;
            soups.append(soup, limits)
        },
    )?;
    let mut warnings = Vec::new();
    if colored > 0 {
        warnings.push(format!("attributes (colours) of {colored} facets ignored"));
    }
    if let trailing @ 1.. = body.len() - count * FACET {
        warnings.push(format!("{trailing} bytes after the last facet ignored"));
    }
    soups.finish(warnings, limits)
}

/// The facets, and how many have attributes.
fn read_piece(facets: &[u8], limits: &Limits) -> Result<(Soup, u64), Fault> {
    let mut soup = Soup::default();
    let mut colored = 0;
    for facet in facets.chunks_exact(FACET) {
        soup.push([corner(facet, 12), corner(facet, 24), corner(facet, 36)], limits)?;
        colored += u64::from(!facet.ends_with(&[0, 0]));
    }
    Ok((soup, colored))
}

fn corner(facet: &[u8], at: usize) -> Vec3 {
    let number = |offset| {
        let field = facet.get(at + offset..).and_then(<[u8]>::first_chunk);
        field.map_or(f32::NAN, |field| f32::from_le_bytes(*field))
    };
    Vec3::new(number(0), number(4), number(8))
}
