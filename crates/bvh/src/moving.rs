//! Trees over things that move while the shutter is open: each node keeps its boxes at shutter open and close,
//! and the boxes between are interpolated (Glassner 1988, "Spacetime Ray Tracing for Animation"; as in Embree).

use crate::build::{Extent, extent, refit};
use crate::node::{Node, WIDTH};
use crate::pages::Pages;
use crate::{Bvh, Quality};
use bytemuck::{Pod, Zeroable};
use juggler_math::{Aabb, Vec3};
use rayon::prelude::*;

/// The boxes of a node's children at shutter open and close: `bounds[time][axis][min/max][slot]`.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(64))]
pub(crate) struct Motion {
    pub bounds: [[[[f32; WIDTH]; 2]; 3]; 2],
}

impl Motion {
    /// The boxes at a time between 0 (open) and 1 (close). Every step is monotonic in the bounds, so that a
    /// box that contains another at both ends contains it at every time, with all rounding.
    #[inline(always)]
    #[cfg_attr(not(test), expect(dead_code, reason = "for the kernels of moving trees"))]
    pub fn at(&self, time: f32) -> [[[f32; WIDTH]; 2]; 3] {
        let mut bounds = [[[0.0; WIDTH]; 2]; 3];
        for (axis, sides) in bounds.iter_mut().enumerate() {
            for (side, values) in sides.iter_mut().enumerate() {
                let (open, close) = (&self.bounds[0][axis][side], &self.bounds[1][axis][side]);
                for slot in 0..WIDTH {
                    values[slot] = open[slot] * (1.0 - time) + close[slot] * time;
                }
            }
        }
        bounds
    }
}

impl Bvh {
    /// Builds a tree over boxes that move linearly: item `i` has box `boxes[i][0]` at shutter open and
    /// `boxes[i][1]` at shutter close, and what it holds at a time between lies in the box between. The nodes
    /// hold the boxes of the whole time, so that every way to trace is right, and beside them those at both
    /// ends. An item that is empty or has a NaN at one end is left out. Otherwise as [`Bvh::build`].
    pub fn build_moving(boxes: &[[Aabb; 2]], quality: Quality) -> Self {
        let mut bvh = Self::build(&boxes.par_iter().map(whole).collect::<Vec<_>>(), quality);
        let ends = [0, 1].map(|end| bvh.nodes_at(|item| wide(boxes[item][end])));
        let mut motion: Pages<Motion> = Pages::zeroed(bvh.nodes.len());
        motion.par_iter_mut().enumerate().for_each(|(i, motion)| {
            motion.bounds = [bounds_of(&ends[0][i]), bounds_of(&ends[1][i])];
        });
        bvh.motion = motion;
        bvh
    }

    /// The nodes with other boxes.
    fn nodes_at(&self, bounds: impl Fn(usize) -> Aabb + Sync) -> Pages<Node> {
        let mut nodes = self.nodes.clone();
        refit(&mut nodes, |leaf| {
            let items = &self.order[leaf.items().start as usize..leaf.items().end as usize];
            items.iter().fold(Extent::EMPTY, |all, &item| all.union(extent(&bounds(item as usize))))
        });
        nodes
    }
}

/// The bounds of a node; those of free slots finite, for infinity times zero is not a number.
fn bounds_of(node: &Node) -> [[[f32; WIDTH]; 2]; 3] {
    node.bounds.map(|sides| sides.map(|values| values.map(|value| value.clamp(-f32::MAX, f32::MAX))))
}

/// The box of an item over all the time, empty when it is so at one end.
fn whole(ends: &[Aabb; 2]) -> Aabb {
    let usable = ends.iter().all(|bounds| bounds.min.cmple(bounds.max).all());
    if usable { wide(ends[0]).union(wide(ends[1])) } else { Aabb::EMPTY }
}

/// Large enough that the boxes between, rounded, contain what lies between, however that is rounded: an
/// interpolation is off by at most two ulp of the larger end.
fn wide(bounds: Aabb) -> Aabb {
    let margin = |v: Vec3| v.abs() * (4.0 * f32::EPSILON) + f32::MIN_POSITIVE;
    let margin = margin(bounds.min).max(margin(bounds.max));
    Aabb { min: bounds.min - margin, max: bounds.max + margin }
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::hash;

    const TIMES: [f32; 7] = [0.0, 1e-7, 0.25, 1.0 / 3.0, 0.5, 0.999_999_9, 1.0];

    fn boxes(count: u32) -> Vec<[Aabb; 2]> {
        let unit = |i: u32, k: u32| hash::unit_f32(hash::mix(hash::combine(i, k))) * 2.0 - 1.0;
        let point = |i: u32, k: u32| Vec3::new(unit(i, k), unit(i, k + 1), unit(i, k + 2));
        let end = |i: u32, k: u32| {
            let center = point(i, k) * 10.0;
            Aabb::from_points([center + point(i, k + 3) * 0.3, center + point(i, k + 6) * 0.3])
        };
        (0..count).map(|i| if i == 3 { [Aabb::EMPTY, end(i, 0)] } else { [end(i, 0), end(i, 9)] }).collect()
    }

    fn contains(bounds: &[[[f32; WIDTH]; 2]; 3], slot: usize, low: [f64; 3], high: [f64; 3]) -> bool {
        let sides = bounds.map(|sides| sides.map(|values| f64::from(values[slot])));
        (0..3).all(|axis| sides[axis][0] <= low[axis] && high[axis] <= sides[axis][1])
    }

    /// A slot's box.
    fn slot_of(bounds: &[[[f32; WIDTH]; 2]; 3], slot: usize) -> ([f64; 3], [f64; 3]) {
        let side = |side: usize| bounds.map(|sides| f64::from(sides[side][slot]));
        (side(0), side(1))
    }

    /// The boxes of a node's slots against what hangs below.
    fn check(bvh: &Bvh, boxes: &[[Aabb; 2]], number: usize, time: f32) {
        let node = &bvh.nodes[number];
        let bounds = bvh.motion[number].at(time);
        for slot in 0..WIDTH {
            let (low, high) = slot_of(&bounds, slot);
            if slot >= node.count as usize {
                assert!((0..3).all(|axis| low[axis] > high[axis]), "a free slot is met");
                continue;
            }
            let child = node.children[slot];
            if child.is_leaf() {
                for position in child.items() {
                    let [open, close] = boxes[bvh.order[position as usize] as usize];
                    let between = |a: Vec3, b: Vec3| a.as_dvec3().lerp(b.as_dvec3(), f64::from(time)).to_array();
                    let (low, high) = (between(open.min, close.min), between(open.max, close.max));
                    assert!(contains(&bounds, slot, low, high) && contains(&node.bounds, slot, low, high));
                }
            } else {
                let below = bvh.motion[child.0 as usize].at(time);
                for part in 0..bvh.nodes[child.0 as usize].count as usize {
                    let (low, high) = slot_of(&below, part);
                    assert!(contains(&bounds, slot, low, high));
                }
            }
        }
    }

    #[test]
    fn boxes_between_contain_what_moves_in_them() {
        for count in [0, 1, 9, 3000] {
            let boxes = boxes(count);
            for quality in Quality::ALL {
                let bvh = Bvh::build_moving(&boxes, quality);
                assert_eq!((bvh.motion.len(), bvh.stats.left_out), (bvh.nodes.len(), usize::from(count > 3)));
                for time in TIMES {
                    (0..bvh.nodes.len()).for_each(|number| check(&bvh, &boxes, number, time));
                }
            }
        }
    }

    #[test]
    fn what_does_not_move_has_no_motion() {
        assert_eq!(Bvh::build(&[Aabb { min: Vec3::ZERO, max: Vec3::ONE }], Quality::Balanced).motion.len(), 0);
    }
}
