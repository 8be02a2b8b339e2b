//! Integrators: the radiance that a path vertex contributes to its sample, and the rays that
//! continue.
//!
//! An integrator is a pure function of one vertex. The crate `render` owns queues, tiles and
//! threads. Radiance is linear in its rays, so even a tree of reflected, refracted and glossy rays
//! is a queue of rays with weights.

use juggler_math::Ray;
use juggler_world::{ShadowMode, Vertex, World};

mod albedo;
mod ambient_occlusion;
mod aov_record;
mod clamp;
mod classic;
mod cone;
mod cut_out;
mod depth;
mod direct;
mod normals;
mod path;
mod path_history;
mod path_log;
mod vertex_output;

pub use aov_record::{AovRecord, SurfaceHit};
pub use clamp::ClampState;
pub use clamp::{Clamp, PathKind};
pub use cone::RayCone;
pub use path::Sampling;
pub use path_history::{CausticStage, CausticState, PathHistory, ScatterCounts};
pub use path_log::{HitRecord, PathLog, ShadingPoint};
pub use path_log::{ScatterEvent, Scattering};
pub use vertex_output::{BentShadowRay, CameraRayWeight, PathBuffers, Queue, ShadowQueue};
pub use vertex_output::{PathState, VertexOutput};

/// A light transport algorithm.
pub trait Integrator: Send + Sync {
    /// Handles a hit: adds radiance, requests shadow rays and continues the path. `ray` ends at
    /// `vertex`.
    fn vertex(&self, world: &World, ray: &Ray, path: &PathState, vertex: &Vertex, output: &mut VertexOutput);
    /// Handles a ray that left the world.
    fn escape(&self, _world: &World, _ray: &Ray, _path: &PathState, _output: &mut VertexOutput) {}
    /// Number of camera rays of each sample, which all add the light that they see directly; `None`
    /// leaves the number to the renderer.
    fn camera_rays(&self) -> Option<u32> {
        Some(1)
    }
    /// Whether procedural textures are filtered where the ray cone is wider than their detail.
    /// Classic ray tracing filters image textures only.
    fn filters_textures(&self) -> bool {
        false
    }
    /// How surfaces attenuate shadow rays.
    fn shadows(&self) -> ShadowMode {
        ShadowMode::Filtered
    }
    /// Limits of contributions, if there are any.
    fn clamp(&self) -> Option<Clamp> {
        None
    }
}

juggler_math::closed_set! {
    /// Light transport algorithm, or visualization of one surface property. In JSON: `{"classic":
    /// {"max_depth": 10}}`, or short `"classic"`.
    pub enum AnyIntegrator: Integrator, kind IntegratorKind {
        classic::Classic, path::Path, direct::Direct, ambient_occlusion::AmbientOcclusion, albedo::Albedo, normals::Normals, depth::Depth,
    }
}

impl Default for AnyIntegrator {
    fn default() -> Self {
        Classic::default().into()
    }
}
