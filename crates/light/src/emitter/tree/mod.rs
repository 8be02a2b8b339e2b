//! Light tree: selects one of many lights by its approximate contribution at a point (Conty Estevez
//! and Kulla, Importance Sampling of Many Lights with Adaptive Tree Splitting, 2018; bounds and
//! importance as in Pharr, Jakob, Humphreys, PBR 4th ed., section 12.6.3).
//!
//! Deviations: a node has eight children, whose importances are computed in parallel. Angles are
//! never computed, only their sines and cosines. Bounds decide only whether light may arrive at
//! all. The importance estimates the mean contribution, with a lower bound in proportion to power
//! over squared distance, so that no light that may arrive has probability 0. The cosine at the
//! point counts one side only.
//!
//! Each light stores its path from the root, three bits per level. Its probability is computed by
//! the same operations as in sampling, so both agree to the last bit.

use fearless_simd::dispatch;
use juggler_bvh::SimdLevel;
use juggler_math::{Aabb, BuildControl, Cancelled, Vec3};

mod build;
mod child_bounds;
mod emission_profile;
mod node;
#[cfg(test)]
mod tests;

use node::{Child, Node, ShadingContext};

/// Bounds of a light's emission: position, directions and power.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightBounds {
    /// Bounding box of all emitting points; finite.
    pub bounds: Aabb,
    /// Axis of the cone of normals, a unit vector.
    pub axis: Vec3,
    /// Cosine of the half angle of this cone: 1 for a single normal, -1 for all directions.
    pub cos_theta_o: f32,
    /// Cosine of the largest angle between a normal and the emitted light: 0 for surfaces.
    pub cos_theta_e: f32,
    /// 4π times the maximum intensity over all directions: the power of a uniform point light of
    /// this intensity. The unit is arbitrary, but the same for all lights.
    pub power: f32,
    /// Whether the light emits from both sides.
    pub two_sided: bool,
}

/// Light selected by [`LightTree::sample`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightTreeSample {
    /// Index of the light.
    pub index: u32,
    /// Probability of the selection.
    pub probability: f32,
    /// Random number left by the selection, rescaled to [0, 1). After many levels few of its bits
    /// remain.
    pub u_remapped: f32,
}

/// Light tree.
#[derive(Clone, Debug)]
pub struct LightTree {
    /// Nodes, the root first; empty if no light emits.
    nodes: Vec<Node>,
    /// Slots from the root to each light, the lowest bits first; [`Self::NOT_IN_TREE`] for a light
    /// that is never selected.
    bit_trails: Vec<u64>,
    /// Power of two that scales world coordinates below 1.
    scale: f32,
    /// Vector instructions that compute the importances.
    level: SimdLevel,
}

impl Default for LightTree {
    /// Creates a tree without lights.
    fn default() -> Self {
        Self::build(&[])
    }
}

impl LightTree {
    /// Bit trail of a light that is not in the tree. A bit trail has 21 levels, 63 bits.
    const NOT_IN_TREE: u64 = u64::MAX;

    /// Builds a tree over lights. A light is never selected if its power is not above 0, or if its
    /// box is empty or not finite.
    pub fn build(lights: &[LightBounds]) -> Self {
        // Nothing cancels this control.
        Self::build_with_control(lights, &BuildControl::default()).unwrap_or_else(|Cancelled| Self::empty(lights.len()))
    }

    /// [`LightTree::build`], which ends early if `control` is cancelled.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] if `control` is cancelled.
    pub fn build_with_control(lights: &[LightBounds], control: &BuildControl) -> Result<Self, Cancelled> {
        build::build(lights, control)
    }

    /// Tree that selects none of `count` lights.
    fn empty(count: usize) -> Self {
        Self { nodes: Vec::new(), bit_trails: vec![Self::NOT_IN_TREE; count], scale: 1.0, level: SimdLevel::new() }
    }

    /// Sets the vector instructions, which are the best of this machine by default; for tests and
    /// benchmarks.
    pub fn with_simd_level(mut self, level: SimdLevel) -> Self {
        self.level = level;
        self
    }

    /// Heap memory in bytes.
    pub fn heap_bytes(&self) -> usize {
        size_of_val(self.nodes.as_slice()) + size_of_val(self.bit_trails.as_slice())
    }

    /// Selects a light for a point with `u` in [0, 1); `None` if no light can illuminate the point.
    ///
    /// `normal` is the unit normal on the lit side: lights that lie wholly below its plane are not
    /// selected. It is `Vec3::ZERO` where light from all sides counts, in media and on transmissive
    /// surfaces.
    pub fn sample(&self, point: Vec3, normal: Vec3, u: f32) -> Option<LightTreeSample> {
        dispatch!(self.level, _ => self.sample_impl(point, normal, u))
    }

    #[inline(always)]
    fn sample_impl(&self, point: Vec3, normal: Vec3, u: f32) -> Option<LightTreeSample> {
        let context = self.to_tree_space(point, normal);
        let mut node = self.nodes.first()?;
        let mut importances = node.importances(&context);
        let (mut probability, mut u_remapped) = (1.0, u);
        loop {
            let (slot, slot_probability, remapped) = importances.sample(u_remapped)?;
            probability *= slot_probability;
            u_remapped = remapped;
            match node.child(slot) {
                Child::Light(index) => return Some(LightTreeSample { index, probability, u_remapped }),
                Child::Node(index) => node = self.nodes.get(index)?,
            }
            importances = node.importances(&context).or_by_power(node);
        }
    }

    /// Probability with which [`LightTree::sample`] selects the light `index` for the same point
    /// and normal.
    pub fn probability(&self, point: Vec3, normal: Vec3, index: u32) -> f32 {
        dispatch!(self.level, _ => self.probability_impl(point, normal, index))
    }

    #[inline(always)]
    fn probability_impl(&self, point: Vec3, normal: Vec3, index: u32) -> f32 {
        let bit_trail =
            self.bit_trails.get(index as usize).copied().filter(|bit_trail| *bit_trail != Self::NOT_IN_TREE);
        let (Some(mut bit_trail), Some(mut node)) = (bit_trail, self.nodes.first()) else { return 0.0 };
        let context = self.to_tree_space(point, normal);
        let mut importances = node.importances(&context);
        let mut probability = 1.0;
        loop {
            let slot = (bit_trail & 7) as usize;
            bit_trail >>= 3;
            probability *= importances.probability(slot);
            match node.child(slot) {
                Child::Node(next) if probability > 0.0 => match self.nodes.get(next) {
                    Some(next) => node = next,
                    None => return 0.0,
                },
                _ => return probability,
            }
            importances = node.importances(&context).or_by_power(node);
        }
    }

    /// Converts a point to the tree's coordinates. Points beyond 10^9 times the extent of the
    /// lights are moved to that distance, which changes only the magnitude of the numbers.
    #[inline(always)]
    fn to_tree_space(&self, point: Vec3, normal: Vec3) -> ShadingContext {
        const FAR: f32 = 1e9;
        let scaled = point * self.scale;
        let near = scaled.abs().max_element() <= FAR;
        let point = if near { scaled } else { point / point.abs().max_element() * FAR };
        ShadingContext::new(point, normal)
    }
}
