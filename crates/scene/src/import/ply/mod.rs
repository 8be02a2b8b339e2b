//! Stanford PLY (Greg Turk, "The PLY Polygon File Format", 1994): text, little-endian or big-endian.
//!
//! Read are the element `vertex` with `x y z`, `nx ny nz` and the first of `u v`, `s t` and
//! `texture_u texture_v`, and the element `face` with its list `vertex_indices` (or `vertex_index`), in any
//! order, of any number type. Everything else is passed over, with a warning that names it; so are lines of
//! the header that are neither declarations nor comments, such as `Created by Blender3D`. In a text, each
//! line is one row of an element, as the header describes it.

mod announced;
mod ascii;
mod binary;
mod body;
mod header;
#[cfg(test)]
mod tests;
mod vertices;

pub(super) use announced::{Announced, announced};

use super::error::Fault;
use super::text::Scanner;
use super::{Imported, Limits};
use body::Body;
use header::{Encoding, Header};

/// Reads a whole file in pieces of about this many bytes.
pub(super) fn read(bytes: &[u8], limits: &Limits, piece: usize) -> Result<Imported, Fault> {
    let mut scanner = Scanner::new(bytes);
    let header = Header::read(&mut scanner)?;
    let body = Body::new(&header, limits, piece);
    match header.encoding {
        Encoding::Ascii => body.read(ascii::AsciiValues::new(scanner)),
        Encoding::Binary(order) => body.read(binary::BinaryValues::new(bytes, scanner.position(), order)),
    }
}
