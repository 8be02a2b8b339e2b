//! Points of smooth surfaces, from which light leaves meshes with shading normals.

use super::{Vertex, World};
use juggler_math::Ray;
use juggler_shape::surface::Surface;

/// Fraction of a ray's length below which a lift is not tested for surfaces in between: what it
/// could hide is smaller than a pixel.
const INVISIBLE: f32 = 1e-3;

impl World {
    /// Surface that scatters light at the end of `ray`: [`Surface::lifted`], unless another surface
    /// is in between, as where a coarse mesh touches the floor. `None` where it is the surface itself.
    #[inline(always)]
    pub fn lifted_surface(&self, ray: &Ray, vertex: &Vertex) -> Option<Surface> {
        let is_smooth = vertex.surface.shading_normal != vertex.surface.normal;
        if is_smooth { self.smooth_surface(ray, vertex) } else { None }
    }

    /// Kept out of line, since most surfaces have no shading normals.
    #[inline(never)]
    fn smooth_surface(&self, ray: &Ray, vertex: &Vertex) -> Option<Surface> {
        let surface = &vertex.surface;
        let lift = self.top.lift(ray, surface, vertex.shape, vertex.primitive)?;
        let lifted = surface.lifted(lift, -ray.direction)?;
        (!self.is_lift_blocked(ray, surface, &lifted)).then_some(lifted)
    }

    fn is_lift_blocked(&self, ray: &Ray, from: &Surface, to: &Surface) -> bool {
        let offset = to.point - from.point;
        let distance = offset.length();
        distance > INVISIBLE * ray.t_max && self.top.occludes(&from.spawn_ray_to(offset / distance, distance, ray.time))
    }
}
