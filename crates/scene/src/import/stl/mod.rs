//! STL of stereolithography (3D Systems, "StereoLithography Interface Specification", 1988), text or binary.
//!
//! Equal positions become one vertex (-0 and 0 are equal), so that the mesh is indexed as other formats
//! are. The file's normals are ignored: the order of the corners says which side is out. A facet with an
//! infinite or NaN coordinate shows nothing; it is left out and counted.

mod ascii;
mod binary;
#[cfg(test)]
mod tests;

use binary::{announced, is_binary};

use super::assemble::Parts;
use super::error::Fault;
use super::estimate::{Counts, Survey};
use super::format::MeshFormat;
use super::text::Scanner;
use super::weld::{Piece, Welded};
use super::{Imported, Limits};
use juggler_math::Vec3;
use std::io;

/// Bytes of a facet in a binary file.
const FACET: u64 = 50;

/// STL, text or binary.
pub(super) struct Stl;

impl MeshFormat for Stl {
    fn name(&self) -> &'static str {
        "STL"
    }

    fn extension(&self) -> &'static str {
        "stl"
    }

    fn is_z_up(&self) -> bool {
        true
    }

    fn is_content(&self, bytes: &[u8]) -> bool {
        let first = Scanner::wavefront(bytes).word_anywhere();
        is_binary(bytes) || first.is_some_and(|word| word.eq_ignore_ascii_case(b"solid"))
    }

    fn is_head(&self, head: &[u8], size: u64) -> bool {
        announced(head) == Some(size) || self.is_content(head)
    }

    fn read(&self, bytes: &[u8], limits: &Limits, piece: usize) -> Result<Imported, Fault> {
        read(bytes, limits, piece)
    }

    fn counts(&self, file: &mut Survey) -> io::Result<Counts> {
        if announced(&file.head) == Some(file.size) {
            return Ok(Counts::of_facets((file.size / FACET).saturating_sub(1)));
        }
        Ok(Counts::of_facets(file.sample()?.facets))
    }
}

/// Reads a whole file in pieces of about this many bytes.
pub(super) fn read(bytes: &[u8], limits: &Limits, piece: usize) -> Result<Imported, Fault> {
    if is_binary(bytes) || !ascii::is_text(bytes) {
        binary::read(bytes, limits, piece)
    } else {
        ascii::read(bytes, limits, piece)
    }
}

/// Facets as they come, welded.
#[derive(Default)]
struct Soup {
    piece: Piece,
    dropped: u64,
}

impl Soup {
    fn push(&mut self, facet: [Vec3; 3], limits: &Limits) -> Result<(), Fault> {
        if !facet.iter().all(|corner| corner.is_finite()) {
            self.dropped += 1;
            return Ok(());
        }
        let mut triangle = [0; 3];
        for (index, corner) in triangle.iter_mut().zip(facet) {
            // Adding zero turns -0 into 0 and leaves every other number as it is.
            *index = self.piece.corners.index((corner + Vec3::ZERO).to_array().map(f32::to_bits), limits)?;
        }
        self.piece.faces.push_triangle(triangle, limits)
    }
}

/// The facets of all pieces.
#[derive(Default)]
struct Soups {
    welded: Welded,
    dropped: u64,
}

impl Soups {
    fn append(&mut self, soup: Soup, limits: &Limits) -> Result<(), Fault> {
        self.dropped += soup.dropped;
        self.welded.append(soup.piece, limits)
    }

    fn finish(self, mut warnings: Vec<String>, limits: &Limits) -> Result<Imported, Fault> {
        if self.dropped > 0 {
            warnings.push(format!("{} facets with infinite or NaN coordinates left out", self.dropped));
        }
        let (keys, faces) = self.welded.finish(limits)?;
        let positions = keys.into_iter().map(|key| Vec3::from(key.map(f32::from_bits))).collect();
        Parts { positions, faces, warnings, ..Parts::default() }.assemble()
    }
}
