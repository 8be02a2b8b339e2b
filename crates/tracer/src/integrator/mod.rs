//! Integrators: what a point where a path touches the world adds to the picture, and which rays go on.
//!
//! An integrator is a pure function of one vertex. Queues, tiles and threads are the engine's
//! (module `render`). Radiance is linear in its rays, so even a tree of mirror, glass and glossy rays is
//! a queue of weighted rays.

use crate::sampler::Sampler;
use crate::world::{Vertex, World};
use juggler_math::{Ray, Rgb};

mod albedo;
mod ambient_occlusion;
mod classic;
mod depth;
mod emit;
mod normals;

pub use emit::Emit;
pub(crate) use emit::{Flight, Harvest, Queue};

/// One ray in flight, as the integrator sees it.
#[derive(Clone, Copy, Debug)]
pub struct Path {
    /// The ray that arrived, its end at the vertex.
    pub ray: Ray,
    /// What its radiance is worth to the sample.
    pub weight: Rgb,
    /// Vertices before this one.
    pub depth: u32,
    /// Numbers of this vertex.
    pub sampler: Sampler,
}

/// Light transport, nothing else.
pub trait Integrator: Send + Sync {
    /// A ray met a surface, or left the world (`None`): what that adds, which lights to ask, where the
    /// light came from.
    fn vertex(&self, world: &World, path: &Path, vertex: Option<&Vertex>, emit: &mut Emit);
}

closed_set! {
    /// Every integrator. In JSON: `{"classic": {"max_depth": 10}}`, or short `"classic"`.
    pub enum AnyIntegrator: Integrator {
        classic::Classic, ambient_occlusion::AmbientOcclusion, albedo::Albedo, normals::Normals, depth::Depth,
    }
}

impl Default for AnyIntegrator {
    fn default() -> Self {
        Classic::default().into()
    }
}

impl AnyIntegrator {
    /// The name in the scene file and on the command line.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Classic(_) => "classic",
            Self::AmbientOcclusion(_) => "ambient_occlusion",
            Self::Albedo(_) => "albedo",
            Self::Normals(_) => "normals",
            Self::Depth(_) => "depth",
        }
    }
}
