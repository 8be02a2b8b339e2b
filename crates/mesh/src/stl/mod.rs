//! STL (3D Systems, "StereoLithography Interface Specification", 1988), text or binary.
//!
//! Equal positions are welded to one vertex (-0 equals 0), which makes the mesh indexed. The
//! normals of the file are ignored: the order of the corners defines the front side. Facets with
//! infinite or NaN coordinates are left out and counted.

mod ascii;
mod binary;
#[cfg(test)]
mod tests;

use binary::{declared_size, is_binary};

use crate::assemble::MeshParts;
use crate::error::MeshErrorKind;
use crate::estimate::{Counts, FileSampler};
use crate::format::MeshFormat;
use crate::text::Scanner;
use crate::weld::{Welded, WeldedPiece};
use crate::{MeshFile, MeshLimits};
use juggler_math::Vec3;
use std::io;

/// Size of a facet in a binary file, in bytes.
const FACET: u64 = 50;

/// STL, text or binary.
pub(crate) struct Stl;

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
        let first = Scanner::with_obj_rules(bytes).word_anywhere();
        is_binary(bytes) || first.is_some_and(|word| word.eq_ignore_ascii_case(b"solid"))
    }

    fn is_head(&self, head: &[u8], size: u64) -> bool {
        declared_size(head) == Some(size) || self.is_content(head)
    }

    fn read(&self, bytes: &[u8], limits: &MeshLimits, piece: usize) -> Result<MeshFile, MeshErrorKind> {
        read(bytes, limits, piece)
    }

    fn counts(&self, file: &mut FileSampler) -> io::Result<Counts> {
        if declared_size(&file.head) == Some(file.size) {
            return Ok(Counts::of_facets((file.size / FACET).saturating_sub(1)));
        }
        Ok(Counts::of_facets(file.sample()?.facets))
    }
}

/// Reads a whole file in pieces of about `piece` bytes.
pub(crate) fn read(bytes: &[u8], limits: &MeshLimits, piece: usize) -> Result<MeshFile, MeshErrorKind> {
    if is_binary(bytes) || !ascii::is_text(bytes) {
        binary::read(bytes, limits, piece)
    } else {
        ascii::read(bytes, limits, piece)
    }
}

/// Welded facets of a piece, and the numbers of dropped facets and of those without a normal.
#[derive(Default)]
struct WeldedFacets {
    piece: WeldedPiece,
    dropped: u64,
    without_normal: u64,
}

impl WeldedFacets {
    fn push(&mut self, facet: [Vec3; 3], limits: &MeshLimits) -> Result<(), MeshErrorKind> {
        if !facet.iter().all(|corner| corner.is_finite()) {
            self.dropped += 1;
            return Ok(());
        }
        let mut triangle = [0; 3];
        for (index, corner) in triangle.iter_mut().zip(facet) {
            // Add zero, which turns -0 into 0 and keeps every other number.
            *index = self.piece.corners.index((corner + Vec3::ZERO).to_array().map(f32::to_bits), limits)?;
        }
        self.piece.faces.push_triangle(triangle, limits)
    }
}

/// Welded facets of all pieces, and the numbers of dropped facets and of those without a normal.
#[derive(Default)]
struct AllFacets {
    welded: Welded,
    dropped: u64,
    without_normal: u64,
}

impl AllFacets {
    fn append(&mut self, welded: WeldedFacets, limits: &MeshLimits) -> Result<(), MeshErrorKind> {
        self.dropped += welded.dropped;
        self.without_normal += welded.without_normal;
        self.welded.append(welded.piece, limits)
    }

    fn finish(self, mut warnings: Vec<String>, limits: &MeshLimits) -> Result<MeshFile, MeshErrorKind> {
        if self.dropped > 0 {
            warnings.push(format!("{} facets with infinite or NaN coordinates ignored", self.dropped));
        }
        if self.without_normal > 0 {
            warnings.push(format!("facets without 'normal', which STL requires: {}", self.without_normal));
        }
        let (keys, faces) = self.welded.finish(limits)?;
        let positions = keys.into_iter().map(|key| Vec3::from(key.map(f32::from_bits))).collect();
        MeshParts { positions, faces, warnings, ..MeshParts::default() }.assemble()
    }
}
