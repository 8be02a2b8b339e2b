//! How what was met runs along its surface coordinates, worked out only when a material asks.

use super::{Vertex, World, WorldHit};
use juggler_math::Ray;
use juggler_shape::Derivatives;
use juggler_shape::surface::{Footprint, Tangents};

/// The flattest angle that footprints know, by its cosine to the normal.
const LEAST_COS: f32 = 0.01;

/// How a surface runs along its coordinates, world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Differential {
    /// ∂p/∂u and ∂p/∂v, world space.
    pub derivatives: Derivatives,
    /// Units of the surface coordinates per unit of the world, by areas: footprints times this are in such units
    /// (Akenine-Möller et al., Texture Level of Detail Strategies for Real-Time Ray Tracing, Ray Tracing Gems, 2019).
    pub uv_density: f32,
    /// Units of object space per unit of the world, likewise.
    pub local_density: f32,
}

impl World {
    /// How the surface at a vertex runs along its coordinates: for normal maps, anisotropy, and footprints of textures.
    /// `ray` and `hit` are those that led to the vertex, whose material must be textured. Nothing at poles and the like.
    pub fn differential(&self, ray: &Ray, hit: &WorldHit, vertex: &Vertex) -> Option<Differential> {
        let [found, local] = self.top.derivatives(vertex.surface.local, &hit.hit, hit.object, ray.time)?;
        let stretch = found.stretch();
        let (uv_density, local_density) = (1.0 / stretch, local.stretch() / stretch);
        let finite = stretch > 0.0 && uv_density.is_finite() && local_density.is_finite();
        finite.then_some(Differential { derivatives: found, uv_density, local_density })
    }

    /// What normal maps and stretched highlights stand in at a vertex; as for [`World::differential`].
    #[inline(never)]
    pub(super) fn tangents(&self, ray: &Ray, hit: &WorldHit, vertex: &Vertex) -> Option<Tangents> {
        let [world, local] = self.top.derivatives(vertex.surface.local, &hit.hit, hit.object, ray.time)?;
        Some(Tangents { u: world.u, v: world.v, local_u: local.u, local_v: local.v })
    }

    /// Whether anything shows pictures from files.
    pub fn has_pictures(&self) -> bool {
        self.has_pictures
    }

    /// Tells a vertex, if its material asks textures, what `ray` covers that is `width` wide there: a circle with the area
    /// of the ellipse that its cone cuts out of the surface.
    #[inline]
    pub fn measure(&self, ray: &Ray, hit: &WorldHit, width: f32, vertex: &mut Vertex) {
        if self.materials.is_textured(vertex.material) {
            vertex.surface.footprint = self.footprint(ray, hit, width, vertex);
        }
    }

    #[inline(never)]
    fn footprint(&self, ray: &Ray, hit: &WorldHit, width: f32, vertex: &Vertex) -> Footprint {
        let cos = vertex.surface.normal.dot(ray.direction).abs().max(LEAST_COS);
        let world = width / cos.sqrt();
        let found = self.differential(ray, hit, vertex);
        let (uv, local) = found.map_or((0.0, 0.0), |found| (world * found.uv_density, world * found.local_density));
        Footprint { world, local, uv }
    }
}

#[cfg(test)]
mod tests;
