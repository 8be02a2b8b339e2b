//! A tree over many lights that picks one by what it may give at a point (Conty Estevez and Kulla, Importance Sampling
//! of Many Lights with Adaptive Tree Splitting, 2018; bounds and importance as in Pharr, Jakob, Humphreys, PBR 4th
//! ed., section 12.6.3).
//!
//! Deviations: eight children a node, whose importances are computed side by side; angles are never computed, only
//! their sines and cosines; bounds only decide whether light may arrive at all, and the importance is an estimate of its
//! mean, never lower than a small share of what distance and power say, so that no such light has chance 0; the cosine at
//! the point counts one side only.
//!
//! A light's way from the root, three bits a level, is stored with it: its chance is found by the very operations that
//! pick it, to the last bit.

use fearless_simd::dispatch;
use juggler_bvh::SimdLevel;
use juggler_math::{Aabb, Vec3};

mod build;
mod node;
mod summary;
#[cfg(test)]
mod tests;

use node::{Child, Node, Place};

/// What a light can do at most: where it is, which way it shines, how strongly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightBounds {
    /// Holds every place that shines; finite.
    pub bounds: Aabb,
    /// Axis of the cone of its normals, a unit vector.
    pub axis: Vec3,
    /// Cosine of that cone's half angle: 1 for one normal, -1 for all directions.
    pub cos_theta_o: f32,
    /// Cosine of the greatest angle to a normal under which it shines, beyond the cone: 0 for surfaces.
    pub cos_theta_e: f32,
    /// 4 π times the greatest intensity that leaves it in any direction: the power of a point light that is as bright. Any
    /// unit that is the same for all lights.
    pub power: f32,
    /// Whether it shines to the other side as well.
    pub two_sided: bool,
}

/// A light that was picked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pick {
    /// Which one.
    pub index: u32,
    /// The chance with which it was.
    pub probability: f32,
    /// The random number that picked it, stretched to [0, 1) again. After many levels few of its bits are left.
    pub rest: f32,
}

/// A tree over lights.
#[derive(Clone, Debug)]
pub struct LightTree {
    /// The root is the first; none when nothing shines.
    nodes: Vec<Node>,
    /// The slots from the root to each light, lowest bits first; [`Self::DARK`] for one that is never picked.
    trails: Vec<u64>,
    /// A power of two that takes the world's coordinates below 1.
    scale: f32,
    /// The vector unit that weighs children.
    level: SimdLevel,
}

impl Default for LightTree {
    /// A tree over nothing.
    fn default() -> Self {
        Self::build(&[])
    }
}

impl LightTree {
    /// The trail of a light that is not in the tree. A trail has 21 levels, 63 bits.
    const DARK: u64 = u64::MAX;

    /// A tree over lights. Those with a power that is not above 0, or a box that is empty or not finite, are never
    /// picked.
    pub fn build(lights: &[LightBounds]) -> Self {
        build::build(lights)
    }

    /// The same tree for another vector unit than the best of this machine: for tests and measurements.
    pub fn with_simd_level(mut self, level: SimdLevel) -> Self {
        self.level = level;
        self
    }

    /// Bytes on the heap.
    pub fn heap_bytes(&self) -> usize {
        size_of_val(self.nodes.as_slice()) + size_of_val(self.trails.as_slice())
    }

    /// Picks a light for a point by `u` in [0, 1); `None` when none can light it.
    ///
    /// `normal` is the unit normal on the side that is to be lit: what lies wholly below its plane is not picked.
    /// `Vec3::ZERO` where light counts from all sides: media, surfaces that let light through.
    pub fn sample(&self, point: Vec3, normal: Vec3, u: f32) -> Option<Pick> {
        dispatch!(self.level, _ => self.descend(point, normal, u))
    }

    #[inline(always)]
    fn descend(&self, point: Vec3, normal: Vec3, u: f32) -> Option<Pick> {
        let place = self.place(point, normal);
        let mut node = self.nodes.first()?;
        let mut weights = node.weights(&place);
        let (mut probability, mut rest) = (1.0, u);
        loop {
            let (slot, chance, stretched) = weights.pick(rest)?;
            probability *= chance;
            rest = stretched;
            match node.child(slot) {
                Child::Light(index) => return Some(Pick { index, probability, rest }),
                Child::Node(index) => node = self.nodes.get(index)?,
            }
            weights = node.weights(&place).or_powers(node);
        }
    }

    /// The chance with which [`LightTree::sample`] picks this light for the same point and normal.
    pub fn probability(&self, point: Vec3, normal: Vec3, index: u32) -> f32 {
        dispatch!(self.level, _ => self.follow(point, normal, index))
    }

    #[inline(always)]
    fn follow(&self, point: Vec3, normal: Vec3, index: u32) -> f32 {
        let trail = self.trails.get(index as usize).copied().filter(|trail| *trail != Self::DARK);
        let (Some(mut trail), Some(mut node)) = (trail, self.nodes.first()) else { return 0.0 };
        let place = self.place(point, normal);
        let mut weights = node.weights(&place);
        let mut probability = 1.0;
        loop {
            let slot = (trail & 7) as usize;
            trail >>= 3;
            probability *= weights.chance(slot);
            match node.child(slot) {
                Child::Node(next) if probability > 0.0 => match self.nodes.get(next) {
                    Some(next) => node = next,
                    None => return 0.0,
                },
                _ => return probability,
            }
            weights = node.weights(&place).or_powers(node);
        }
    }

    /// The point in the tree's coordinates. From a thousand million times as far as the lights lie from the origin,
    /// nothing changes any more but the size of the numbers.
    #[inline(always)]
    fn place(&self, point: Vec3, normal: Vec3) -> Place {
        const FAR: f32 = 1e9;
        let scaled = point * self.scale;
        let near = scaled.abs().max_element() <= FAR;
        let point = if near { scaled } else { point / point.abs().max_element() * FAR };
        Place::new(point, normal)
    }
}
