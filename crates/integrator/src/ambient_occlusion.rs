//! How open each point is: white in the open, dark in corners.
//!
//! ```json
//! {"ambient_occlusion": {"distance": 2}}
//! ```

use super::{Emit, Integrator, PathState};
use juggler_camera::layer::LightGroup;
use juggler_math::{Frame, Ray, Rgb, warp};
use juggler_world::{Vertex, World};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The cosine-weighted share of the hemisphere from which nothing within `distance` hides the sky.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct AmbientOcclusion {
    /// How far to look; without it half of the scene's diagonal.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub distance: Option<f32>,
}

impl Integrator for AmbientOcclusion {
    fn vertex(&self, world: &World, ray: &Ray, path: &PathState, vertex: &Vertex, emit: &mut Emit) {
        emit.see_unlit(world, ray, vertex);
        let surface = &vertex.surface;
        let facing = surface.normal.dot(ray.direction) < 0.0;
        let frame = Frame::around(if facing { surface.shading_normal } else { -surface.shading_normal });
        let mut sampler = path.sampler;
        let direction = frame.to_world(warp::cosine_hemisphere(sampler.next_2d()));
        let extent = world.bounds().extent();
        let distance = self.distance.unwrap_or_else(|| 0.5 * extent.max(juggler_math::Vec3::ZERO).length());
        emit.if_visible(surface.spawn(direction, ray.time).up_to(distance), Rgb::WHITE, LightGroup::REST);
    }

    fn escape(&self, _world: &World, ray: &Ray, _path: &PathState, emit: &mut Emit) {
        emit.miss(ray);
        emit.add(Rgb::WHITE, LightGroup::REST);
    }
}

#[cfg(any(test, feature = "testing"))]
impl AmbientOcclusion {
    /// For the contract tests.
    pub fn examples() -> Vec<Self> {
        vec![Self::default()]
    }
}
