//! stub
use crate::node::WIDTH;
use crate::{Bvh, Leaf};
use juggler_math::Ray;

/// Most rays that are traced together.
pub const PACKET: usize = WIDTH;

impl Bvh {
    /// x
    pub fn closest_packet(&self, rays: &mut [Ray], leaf: &mut impl Leaf) {
        self.closest_batch(rays, leaf);
    }
    /// x
    pub fn any_packet(&self, rays: &[Ray], occluded: &mut [bool], leaf: &mut impl Leaf) {
        self.any_batch(rays, occluded, leaf);
    }
}
