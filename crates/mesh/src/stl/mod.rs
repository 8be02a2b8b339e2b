//! STL (3D Systems, "StereoLithography Interface Specification", 1988), text or binary.
//!
//! Equal positions are welded to one vertex (-0 equals 0), which makes the mesh indexed. The
//! normals of the file are ignored: the order of the corners defines the front side. Facets with
//! infinite or NaN coordinates are left out and counted. The solids of a text are sections of one
//! mesh; a binary file is one solid.

mod ascii;
mod binary;
mod facets;
#[cfg(test)]
mod tests;

use crate::error::MeshErrorKind;
use crate::format::{MeshFormat, MeshFormatInfo};
use crate::limits::MeshLimits;
use crate::mesh_file::MeshFile;
use crate::pieces::PieceReader;
use crate::sampling::{Counts, FileSampler, lines, scaled, words};
use crate::text::{Scanner, without_byte_order_mark};
use std::io;

/// The format STL. Its files have the z axis up, as usual for 3D printing.
pub const STL: MeshFormatInfo = MeshFormatInfo { name: "STL", extension: "stl", is_z_up: true };

/// STL, text or binary.
pub(crate) struct Stl;

impl MeshFormat for Stl {
    fn info(&self) -> MeshFormatInfo {
        STL
    }

    fn is_content(&self, bytes: &[u8]) -> bool {
        let first = Scanner::with_obj_rules(bytes).word_anywhere();
        binary::is_binary(bytes) || first.is_some_and(|word| word.eq_ignore_ascii_case(b"solid"))
    }

    fn is_head(&self, head: &[u8], size: u64) -> bool {
        binary::declared_size(head) == Some(size) || self.is_content(head)
    }

    fn read(&self, bytes: &[u8], limits: &MeshLimits, pieces: PieceReader<'_>) -> Result<MeshFile, MeshErrorKind> {
        if is_text(bytes) { ascii::read(bytes, limits, pieces) } else { binary::read(bytes, limits, pieces) }
    }

    fn counts(&self, file: &mut FileSampler) -> io::Result<Counts> {
        if binary::declared_size(&file.head) == Some(file.size) {
            return Ok(Counts::of_facets((file.size / binary::FACET as u64).saturating_sub(1)));
        }
        let mut facets = 0;
        let is_facet = |line: &&[u8]| words(line).next() == Some("facet");
        let sampled_bytes = file.sample(|text| facets += lines(text).filter(is_facet).count() as u64)?;
        Ok(Counts::of_facets(scaled(facets, file.size, sampled_bytes)))
    }
}

/// Whether the file is read as a text.
fn is_text(bytes: &[u8]) -> bool {
    !binary::is_binary(bytes) && ascii::is_text(bytes)
}

/// Whether an STL may have several solids, by the lines that begin with the keyword `solid`. The
/// file is read up to the second one, and facets are not parsed.
pub fn has_several_solids(bytes: &[u8]) -> bool {
    let bytes = without_byte_order_mark(bytes);
    is_text(bytes) && ascii::has_several_solids(bytes)
}
