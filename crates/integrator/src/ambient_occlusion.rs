//! Ambient occlusion: white for exposed points, dark in corners.
//!
//! ```json
//! {"ambient_occlusion": {"distance": 2}}
//! ```

use super::{Integrator, PathState, VertexOutput};
use juggler_camera::aov::LightGroup;
use juggler_math::{Frame, Ray, Rgb, warp};
use juggler_world::{Member, Vertex, World};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Ambient occlusion: the cosine-weighted fraction of the hemisphere that nothing within `distance`
/// occludes.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct AmbientOcclusion {
    /// Maximum distance of occluders, in scene units, above 0. The default is half of the diagonal
    /// of the scene's bounding box; smaller values confine darkening to corners.
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "scene units"))]
    pub distance: Option<f32>,
}

impl Integrator for AmbientOcclusion {
    fn vertex(&self, world: &World, ray: &Ray, path: &PathState, vertex: &Vertex, output: &mut VertexOutput) {
        let Some(Member { vertex, t }) = output.skip_cut_outs(world, ray, vertex) else { return };
        let (ray, vertex) = (&ray.with_t_max(t), &vertex);
        output.record_surface(world, ray, vertex);
        // Trace a shadow ray in a cosine-weighted direction on the viewer's side.
        let surface = &vertex.surface;
        let facing = surface.normal.dot(ray.direction) < 0.0;
        let frame = Frame::around(if facing { surface.shading_normal } else { -surface.shading_normal });
        let mut sampler = path.sampler;
        let direction = frame.to_world(warp::cosine_hemisphere(sampler.next_2d()));
        let extent = world.bounds().extent();
        let distance = self.distance.unwrap_or_else(|| 0.5 * extent.max(juggler_math::Vec3::ZERO).length());
        let lifted = world.lifted_surface(ray, vertex);
        output.add_shadow_ray(
            lifted.as_ref().unwrap_or(surface).spawn_ray(direction, ray.time).with_t_max(distance),
            Rgb::WHITE,
            LightGroup::REST,
        );
    }

    fn escape(&self, world: &World, ray: &Ray, _path: &PathState, output: &mut VertexOutput) {
        output.record_miss(ray);
        output.add(if world.hides_background() { Rgb::BLACK } else { Rgb::WHITE }, LightGroup::REST);
    }
}

#[cfg(any(test, feature = "testing"))]
impl AmbientOcclusion {
    /// Example values for the contract tests.
    pub fn examples() -> Vec<Self> {
        vec![Self::default()]
    }
}
