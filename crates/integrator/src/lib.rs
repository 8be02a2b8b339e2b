//! Integrators: what a point where a path touches the world adds to the picture, and which rays go on.
//!
//! An integrator is a pure function of one vertex. Queues, tiles and threads are the engine's
//! (module `render`). Radiance is linear in its rays, so even a tree of mirror, glass and glossy rays is
//! a queue of weighted rays.

use juggler_math::Ray;
use juggler_world::{Shadows, Vertex, World};

mod albedo;
mod ambient_occlusion;
mod clamp;
mod classic;
mod cone;
mod depth;
mod direct;
mod emit;
mod normals;
mod path;
mod path_log;
mod record;
mod trail;

pub use clamp::Clamping;
pub use clamp::{Clamp, Way};
pub use cone::Cone;
pub use emit::{Bent, Harvest, Queue, ShadowQueue};
pub use emit::{Emit, PathState};
pub use path_log::{Arrival, PathLog, Seen};
pub use path_log::{Event, Scattering};
pub use record::Record;
pub use record::Sight;
pub use trail::{Chain, Counts, Stage, Trail};

/// Light transport, nothing else.
pub trait Integrator: Send + Sync {
    /// `ray`, its end drawn in, met a surface: what that adds, which lights to ask, where the light came from.
    fn vertex(&self, world: &World, ray: &Ray, path: &PathState, vertex: &Vertex, emit: &mut Emit);
    /// `ray` left the world: what it adds.
    fn escape(&self, _world: &World, _ray: &Ray, _path: &PathState, _emit: &mut Emit) {}
    /// Whether patterns fade where rays are wider than they are fine. Classic pictures never had that: in them only
    /// pictures on surfaces do.
    fn fades_patterns(&self) -> bool {
        false
    }
    /// What its shadow rays keep.
    fn shadows(&self) -> Shadows {
        Shadows::Filtered
    }
    /// What contributions are limited to.
    fn clamp(&self) -> Option<Clamp> {
        None
    }
}

juggler_math::closed_set! {
    /// Every integrator. In JSON: `{"classic": {"max_depth": 10}}`, or short `"classic"`.
    pub enum AnyIntegrator: Integrator {
        classic::Classic, path::Path, direct::Direct, ambient_occlusion::AmbientOcclusion, albedo::Albedo, normals::Normals, depth::Depth,
    }
}

impl Default for AnyIntegrator {
    fn default() -> Self {
        Classic::default().into()
    }
}
