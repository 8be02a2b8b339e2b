//! Everything that is measured, behind one face.

use crate::ffi::Scene;
use crate::options::Call;
use juggler_bvh::TriangleBvh;
use juggler_math::Ray;
use juggler_raybench::kernel::{Kernel, Scratch};
use juggler_raybench::measure::Sums;
use juggler_raybench::rays::Query;

/// A tree of one of the two.
#[derive(Clone, Copy)]
pub enum Tree<'t> {
    Embree(&'t Scene<'t>),
    Juggler(&'t TriangleBvh),
}

/// A tree and a way to ask it.
#[derive(Clone, Copy)]
pub struct Tracer<'t> {
    /// What its triangle test is called.
    pub test: &'static str,
    /// Whether that test is watertight; only like is compared with like.
    pub watertight: bool,
    pub call: Call,
    pub tree: Tree<'t>,
}

impl Tracer<'_> {
    pub fn is_ours(&self) -> bool {
        matches!(self.tree, Tree::Juggler(_))
    }

    pub fn label(&self) -> String {
        let who = if self.is_ours() { "Juggler" } else { "Embree" };
        format!("{who} {} {}", self.test, self.call.name())
    }

    /// Traces and adds up.
    pub fn trace(&self, query: Query, rays: &[Ray], scratch: &mut Scratch) -> Sums {
        match self.tree {
            Tree::Juggler(bvh) => match self.call {
                Call::Single => Kernel::Single.trace(bvh, query, rays, scratch),
                Call::Batch => Kernel::Batch.trace(bvh, query, rays, scratch),
                Call::Packet | Call::Coherent => Kernel::Packet.trace(bvh, query, rays, scratch),
            },
            Tree::Embree(scene) => match self.call {
                Call::Single | Call::Batch => single(scene, query, rays),
                Call::Packet => packets(scene, query, rays, false),
                Call::Coherent => packets(scene, query, rays, true),
            },
        }
    }
}

fn single(scene: &Scene, query: Query, rays: &[Ray]) -> Sums {
    match query {
        Query::Closest => Sums::of_distances(rays.iter().map(|ray| scene.closest(ray).map(|(distance, _)| distance))),
        Query::Any => Sums::of_occluded(rays.iter().map(|ray| scene.any(ray))),
    }
}

fn packets(scene: &Scene, query: Query, rays: &[Ray], coherent: bool) -> Sums {
    let packet = |rays: &[Ray]| match query {
        Query::Closest => {
            let hits = scene.closest8(rays, coherent);
            Sums::of_distances(hits.into_iter().map(|hit| hit.map(|(distance, _)| distance)))
        }
        Query::Any => Sums::of_occluded(scene.any8(rays, coherent).into_iter()),
    };
    rays.chunks(8).map(packet).sum()
}
