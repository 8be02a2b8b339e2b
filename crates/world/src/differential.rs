//! Derivatives of surface points with respect to (u, v), and texture footprints; computed only for
//! materials that need them.

use super::{Vertex, World, WorldHit};
use juggler_math::Ray;
use juggler_shape::surface::{Footprint, GivenTangent, Tangents};
use juggler_shape::{MeshPoint, SurfaceDerivatives};

/// Minimum cosine between ray and normal that footprints assume.
const MIN_COS: f32 = 0.01;

/// Derivatives of a surface point, and densities of its texture and object coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceDifferential {
    /// ∂p/∂u and ∂p/∂v, in world space.
    pub derivatives: SurfaceDerivatives,
    /// Texture-coordinate units per world unit: the square root of the ratio of areas. It converts
    /// footprints to (u, v) (Akenine-Möller et al., Texture Level of Detail Strategies for
    /// Real-Time Ray Tracing, Ray Tracing Gems, 2019).
    pub uv_density: f32,
    /// Object-space units per world unit, by the same ratio.
    pub local_density: f32,
}

impl World {
    /// Derivatives at a vertex, for normal maps, anisotropy and texture footprints. `ray` and `hit`
    /// must be those of the vertex, whose material must be textured. `None` at singularities such
    /// as the poles of a sphere.
    pub fn differential(&self, ray: &Ray, hit: &WorldHit, vertex: &Vertex) -> Option<SurfaceDifferential> {
        let [derivatives, local] = self.top.derivatives(vertex.surface.local, &hit.hit, hit.shape, ray.time)?;
        let unit_length = derivatives.unit_length();
        let (uv_density, local_density) = (1.0 / unit_length, local.unit_length() / unit_length);
        let is_finite = unit_length > 0.0 && uv_density.is_finite() && local_density.is_finite();
        is_finite.then_some(SurfaceDifferential { derivatives, uv_density, local_density })
    }

    /// Tangents at a vertex, for normal maps and anisotropic BSDFs; arguments as for
    /// [`World::differential`].
    #[inline(never)]
    pub(super) fn tangents(&self, ray: &Ray, hit: &WorldHit, vertex: &Vertex) -> Option<Tangents> {
        let frame = self.top.tangent_frame(&vertex.surface, &hit.hit, hit.shape, ray.time);
        let along_coordinates = self.top.derivatives(vertex.surface.local, &hit.hit, hit.shape, ray.time);
        // Where coordinates are missing, the mesh's tangents stand in for derivatives too.
        let [world, local] = along_coordinates.or(frame)?;
        let given = frame.map(|[frame, _]| {
            // A mirroring transform turns the bitangent over: it is transformed itself.
            let side = vertex.surface.shading_normal.cross(frame.u).dot(frame.v);
            GivenTangent { along: frame.u, sign: if side < 0.0 { -1.0 } else { 1.0 } }
        });
        Some(Tangents { u: world.u, v: world.v, local_u: local.u, local_v: local.v, given })
    }

    /// Point of a mesh with attributes or a second set of surface coordinates, at a vertex whose
    /// material is textured; `None` on all other surfaces.
    #[inline]
    pub(super) fn mesh_point(&self, vertex: &Vertex) -> Option<MeshPoint<'_>> {
        if self.has_mesh_attributes && self.materials.is_textured(vertex.material) {
            self.top.mesh_point(&vertex.surface, vertex.shape, vertex.primitive)
        } else {
            None
        }
    }

    /// Whether any texture is an image.
    pub fn has_image_textures(&self) -> bool {
        self.has_image_textures
    }

    /// Sets the texture footprint of a vertex whose material is textured. The footprint is a circle
    /// with the area of the ellipse that a ray cone of diameter `width` cuts out of the surface.
    #[inline]
    pub fn ray_differentials(&self, ray: &Ray, hit: &WorldHit, width: f32, vertex: &mut Vertex) {
        if self.materials.is_textured(vertex.material) {
            vertex.surface.footprint = self.footprint(ray, hit, width, vertex);
        }
    }

    #[inline(never)]
    fn footprint(&self, ray: &Ray, hit: &WorldHit, width: f32, vertex: &Vertex) -> Footprint {
        let cos = vertex.surface.normal.dot(ray.direction).abs().max(MIN_COS);
        let world = width / cos.sqrt();
        let differential = self.differential(ray, hit, vertex);
        let (uv, local) = differential.map_or((0.0, 0.0), |d| (world * d.uv_density, world * d.local_density));
        Footprint { world, local, uv }
    }
}

#[cfg(test)]
mod tests;
