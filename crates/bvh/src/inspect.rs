//! Traversal cost of a ray for debug views: nodes, leaves and items visited.

use crate::lanes::Bits;
use crate::node::Child;
use crate::slabs::{Slabs, cull_distance};
use crate::stack::{Stack, distance, entry};
use crate::{Bvh, Leaf};
use fearless_simd::{Level, dispatch};
use juggler_math::Ray;

/// Counts of a closest-hit traversal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Visits {
    /// Nodes whose eight boxes were tested.
    pub nodes: u32,
    /// Leaves passed to the visitor.
    pub leaves: u32,
    /// Items in these leaves.
    pub items: u32,
}

impl Bvh {
    /// [`Bvh::closest`] with the same steps, but counted and slower.
    pub fn closest_counted(&self, ray: &mut Ray, leaf: &mut impl Leaf) -> Visits {
        let mut visits = Visits::default();
        let mut slabs = dispatch!(Level::baseline(), simd => Slabs::of_ray(simd, ray));
        let mut stack = Stack::new();
        let mut stack = stack.view();
        stack.push(entry(ray.t_min, Child::ROOT.0));
        while let Some(top) = stack.pop() {
            let child = Child(top as u32);
            if distance(top) > slabs.t_max {
                continue;
            }
            if child.is_leaf() {
                visits.leaves += 1;
                visits.items += child.items().len() as u32;
                leaf.closest(0, ray, child.items());
                slabs.t_max = cull_distance(ray.t_max);
            } else {
                visits.nodes += 1;
                let node = &self.nodes[child.0 as usize];
                let (mask, enter) = dispatch!(Level::baseline(), simd => {
                    let (mask, enter) = node.test(simd, &slabs);
                    (mask, <[f32; 8]>::from(enter))
                });
                for (sorted, slot) in Bits(mask).enumerate() {
                    stack.insert(sorted, entry(enter[slot], node.children[slot].0));
                }
            }
        }
        visits
    }
}
