//! STL of stereolithography (3D Systems, "StereoLithography Interface Specification", 1988), text or binary.
//!
//! Equal positions become one vertex (-0 and 0 are equal), so that the mesh is indexed as other formats
//! are. The file's normals are ignored: the order of the corners says which side is out. A facet with an
//! infinite or NaN coordinate shows nothing; it is left out and counted.

mod ascii;
mod binary;
#[cfg(test)]
mod tests;

pub(super) use binary::is_binary;

use super::assemble::Parts;
use super::error::Fault;
use super::faces::Faces;
use super::weld::Welder;
use super::{Imported, Limits};
use juggler_math::Vec3;

/// Reads a whole file.
pub(super) fn read(bytes: &[u8], limits: &Limits) -> Result<Imported, Fault> {
    if is_binary(bytes) || !ascii::is_text(bytes) { binary::read(bytes, limits) } else { ascii::read(bytes, limits) }
}

/// Facets as they come, welded.
#[derive(Default)]
struct Soup {
    corners: Welder,
    faces: Faces,
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
            *index = self.corners.index((corner + Vec3::ZERO).to_array().map(f32::to_bits), limits)?;
        }
        self.faces.push_triangle(triangle, limits)
    }

    fn finish(self, mut warnings: Vec<String>) -> Result<Imported, Fault> {
        if self.dropped > 0 {
            warnings.push(format!("{} facets with infinite or NaN coordinates left out", self.dropped));
        }
        let positions = self.corners.into_keys().into_iter().map(|key| Vec3::from(key.map(f32::from_bits))).collect();
        Parts { positions, faces: self.faces, warnings, ..Parts::default() }.assemble()
    }
}
