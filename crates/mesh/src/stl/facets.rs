//! Facets of an STL, whose corners are welded, and its solids.

use crate::assemble::MeshParts;
use crate::error::MeshErrorKind;
use crate::limits::MeshLimits;
use crate::mesh_file::{MAX_SOLIDS, MeshFile, StlSolid};
use crate::weld::{Welded, WeldedPiece};
use juggler_math::{BuildControl, Vec3};

/// Maximum number of bytes of the name of a solid.
const MAX_NAME: usize = 1024;

/// Welded facets of a piece, the solids that begin in it, and the numbers of dropped facets and of
/// facets without a normal.
#[derive(Default)]
pub(super) struct WeldedFacets {
    piece: WeldedPiece,
    solids: Vec<StlSolid>,
    dropped: u64,
    /// Number of facets without the word `normal`.
    pub without_normal: u64,
}

impl WeldedFacets {
    /// Begins a solid; `rest` follows its keyword on the line.
    pub fn begin_solid(&mut self, rest: &[u8]) {
        begin_solid(&mut self.solids, self.piece.faces.len(), rest);
    }

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

fn begin_solid(solids: &mut Vec<StlSolid>, first: usize, rest: &[u8]) {
    // The limit bounds the memory that a hostile text needs.
    if solids.len() <= MAX_SOLIDS {
        solids.push(StlSolid { first, name: solid_name(rest) });
    }
}

/// Name of a solid from the rest of its line.
fn solid_name(rest: &[u8]) -> Option<String> {
    let name = rest.trim_ascii();
    let is_name = !name.is_empty() && name.len() <= MAX_NAME && !name.contains(&0);
    is_name.then(|| String::from_utf8_lossy(name).into_owned())
}

/// Welded facets of all pieces, their solids, and the numbers of dropped facets and of facets
/// without a normal.
#[derive(Default)]
pub(super) struct AllFacets {
    welded: Welded,
    solids: Vec<StlSolid>,
    dropped: u64,
    without_normal: u64,
}

impl AllFacets {
    /// Creates an empty collection with room for this number of facets.
    pub fn with_capacity(facets: usize) -> Self {
        Self { welded: Welded::with_capacity(facets), ..Self::default() }
    }

    /// Begins a solid; `rest` follows its keyword on the line.
    pub fn begin_solid(&mut self, rest: &[u8]) {
        begin_solid(&mut self.solids, self.welded.triangles(), rest);
    }

    /// Appends the facets of the next piece.
    pub fn append(&mut self, welded: WeldedFacets, limits: &MeshLimits) -> Result<(), MeshErrorKind> {
        self.dropped += welded.dropped;
        self.without_normal += welded.without_normal;
        let triangles = self.welded.triangles();
        let room = (MAX_SOLIDS + 1).saturating_sub(self.solids.len());
        let solids = welded.solids.into_iter().take(room);
        self.solids.extend(solids.map(|solid| StlSolid { first: solid.first.saturating_add(triangles), ..solid }));
        self.welded.append(welded.piece, limits)
    }

    /// Assembles the mesh.
    pub fn finish(
        self,
        mut warnings: Vec<String>,
        limits: &MeshLimits,
        control: &BuildControl,
    ) -> Result<MeshFile, MeshErrorKind> {
        if self.dropped > 0 {
            warnings.push(format!("{} facets with infinite or NaN coordinates ignored", self.dropped));
        }
        if self.without_normal > 0 {
            warnings.push(format!("facets without 'normal', which STL requires: {}", self.without_normal));
        }
        let (keys, faces) = self.welded.finish(limits, control)?;
        let positions = keys.into_iter().map(|key| Vec3::from(key.map(f32::from_bits))).collect();
        let file = MeshParts { positions, faces, warnings, ..MeshParts::default() }.assemble()?;
        Ok(MeshFile { solids: self.solids, ..file })
    }
}
