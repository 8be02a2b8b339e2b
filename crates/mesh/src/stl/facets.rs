//! Facets of an STL, whose corners are welded.

use crate::assemble::MeshParts;
use crate::error::MeshErrorKind;
use crate::limits::MeshLimits;
use crate::mesh_file::MeshFile;
use crate::weld::{Welded, WeldedPiece};
use juggler_math::Vec3;

/// Welded facets of a piece, and the numbers of dropped facets and of those without a normal.
#[derive(Default)]
pub(super) struct WeldedFacets {
    piece: WeldedPiece,
    dropped: u64,
    /// Number of facets without the word `normal`.
    pub without_normal: u64,
}

impl WeldedFacets {
    /// Adds a facet, unless one of its numbers is not finite.
    pub fn push(&mut self, facet: [Vec3; 3], limits: &MeshLimits) -> Result<(), MeshErrorKind> {
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
pub(super) struct AllFacets {
    welded: Welded,
    dropped: u64,
    without_normal: u64,
}

impl AllFacets {
    /// Creates an empty collection with room for this number of facets.
    pub fn with_capacity(facets: usize) -> Self {
        Self { welded: Welded::with_capacity(facets), ..Self::default() }
    }

    /// Appends the facets of the next piece.
    pub fn append(&mut self, welded: WeldedFacets, limits: &MeshLimits) -> Result<(), MeshErrorKind> {
        self.dropped += welded.dropped;
        self.without_normal += welded.without_normal;
        self.welded.append(welded.piece, limits)
    }

    /// Assembles the mesh.
    pub fn finish(self, mut warnings: Vec<String>, limits: &MeshLimits) -> Result<MeshFile, MeshErrorKind> {
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
