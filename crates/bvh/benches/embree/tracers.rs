//! One interface for all trees and calls under measurement.

use crate::ffi::Scene;
use crate::options::Call;
use juggler_bvh::TriangleBvh;
use juggler_math::Ray;
use juggler_raybench::kernel::{Kernel, Scratch};
use juggler_raybench::measure::HitSummary;
use juggler_raybench::rays::QueryKind;

/// A tree of Embree or Juggler.
#[derive(Clone, Copy)]
pub enum Tree<'t> {
    Embree(&'t Scene<'t>),
    Juggler(&'t TriangleBvh),
}

/// A tree and a call that traces it.
#[derive(Clone, Copy)]
pub struct Tracer<'t> {
    /// Name of the triangle test.
    pub test: &'static str,
    /// Whether the triangle test is watertight; only tests of the same kind are compared.
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

    /// Traces the rays and sums up the results.
    pub fn trace(&self, query: QueryKind, rays: &[Ray], scratch: &mut Scratch) -> HitSummary {
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

fn single(scene: &Scene, query: QueryKind, rays: &[Ray]) -> HitSummary {
    match query {
        QueryKind::Closest => {
            HitSummary::from_distances(rays.iter().map(|ray| scene.closest(ray).map(|(distance, _)| distance)))
        }
        QueryKind::Any => HitSummary::from_occluded(rays.iter().map(|ray| scene.any(ray))),
    }
}

fn packets(scene: &Scene, query: QueryKind, rays: &[Ray], coherent: bool) -> HitSummary {
    let packet = |rays: &[Ray]| match query {
        QueryKind::Closest => {
            let hits = scene.closest8(rays, coherent);
            HitSummary::from_distances(hits.into_iter().map(|hit| hit.map(|(distance, _)| distance)))
        }
        QueryKind::Any => HitSummary::from_occluded(scene.any8(rays, coherent).into_iter()),
    };
    rays.chunks(8).map(packet).sum()
}
