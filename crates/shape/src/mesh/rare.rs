//! Data that few meshes have and that surfaces do not carry: attributes, a second set of surface
//! coordinates, tangents.

use super::{Mesh, MeshPoint};
use crate::derivatives::dpdu_about_y;
use crate::surface::Surface;
use crate::{AnyShape, SurfaceDerivatives};
use juggler_math::{Ray, Vec3};

impl Mesh {
    /// Whether the mesh has attributes or a second set of surface coordinates.
    pub fn has_attributes(&self) -> bool {
        !self.arrays.attributes.is_empty() || !self.arrays.uvs1.is_empty()
    }

    /// Whether the mesh lacks surface coordinates, so that each triangle has its own.
    pub fn lacks_surface_coordinates(&self) -> bool {
        self.arrays.uvs.is_empty() && !self.arrays.triangles.is_empty()
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
    /// space: T and w (N × T), with the shading normal N (glTF 2.0, section 3.7.2.1). In a mesh
    /// without tangents and surface coordinates, T turns about the object's y axis, as on spheres
    /// and cylinders. `None` for other shapes and meshes without tangents.
    pub fn tangent_frame(&self, primitive: u32, surface: &Surface, time: f32) -> Option<SurfaceDerivatives> {
        let Self::Mesh(mesh) = self else { return None };
        let prepared = mesh.prepared.as_deref()?;
        let about_axis = || mesh.lacks_surface_coordinates().then(|| (dpdu_about_y(surface.local), 1.0));
        let given = prepared.tangent(primitive as usize, surface.barycentrics, time);
        let (tangent, sign) = given.or_else(about_axis)?;
        SurfaceDerivatives::new(tangent, surface.local_normal.cross(tangent) * sign)
    }

    /// Offset from a point of this shape to the smooth surface that its shading normals describe, in
    /// object space; see [`Surface::lifted`]. `ray` hits the surface, in object space. `None` without
    /// shading normals.
    pub fn lift(&self, primitive: u32, surface: &Surface, ray: &Ray) -> Option<Vec3> {
        let triangle = match self {
            Self::Mesh(mesh) => mesh.triangle_geometry(primitive, ray.time)?,
            Self::Triangle(triangle) => triangle.geometry(),
            _ => return None,
        };
        triangle.lift(surface.barycentrics, ray.direction)
    }
}
