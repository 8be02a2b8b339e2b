//! Data that few meshes have and that surfaces do not carry: attributes, a second set of surface
//! coordinates, tangents.

use super::{Mesh, MeshPoint};
use crate::surface::Surface;
use crate::{AnyShape, SurfaceDerivatives};

impl Mesh {
    /// Whether the mesh has attributes or a second set of surface coordinates.
    pub fn has_attributes(&self) -> bool {
        !self.arrays.attributes.is_empty() || !self.arrays.uvs1.is_empty()
    }
}

impl AnyShape {
    /// Point of a mesh that has attributes or a second set of surface coordinates, at a surface of
    /// the triangle `primitive`; `None` for all other shapes.
    pub fn mesh_point(&self, primitive: u32, surface: &Surface) -> Option<MeshPoint<'_>> {
        match self {
            Self::Mesh(mesh) if mesh.has_attributes() => {
                Some(MeshPoint::new(mesh.data()?, primitive, surface.barycentrics))
            }
            _ => None,
        }
    }

    /// Tangent and bitangent that a mesh gives at a surface of the triangle `primitive`, object
    /// space: T and w (N × T), with the shading normal N (glTF 2.0, section 3.7.2.1). `None` for
    /// other shapes and meshes without tangents.
    pub fn tangent_frame(&self, primitive: u32, surface: &Surface, time: f32) -> Option<SurfaceDerivatives> {
        let Self::Mesh(mesh) = self else { return None };
        let prepared = mesh.prepared.as_deref()?;
        let (tangent, sign) = prepared.tangent(primitive as usize, surface.barycentrics, time)?;
        SurfaceDerivatives::new(tangent, surface.local_normal.cross(tangent) * sign)
    }
}
