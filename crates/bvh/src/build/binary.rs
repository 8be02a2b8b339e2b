//! The binary tree between construction and collapse.

use super::item::Extent;
use crate::pages::Pages;
use bytemuck::{Pod, Zeroable};
use juggler_math::Aabb;
use rayon::prelude::*;

/// A leaf of `count` items from position `first`, or (`count` zero) the parent of the two nodes at `first`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(super) struct BinaryNode {
    pub low: [f32; 3],
    pub first: u32,
    pub high: [f32; 3],
    pub count: u32,
}

impl BinaryNode {
    pub fn new(bounds: Extent, first: usize, count: usize) -> Self {
        let ([a, b, c, _], [d, e, f, _]) = (bounds.low.to_array(), bounds.high.to_array());
        Self { low: [a, b, c], first: first as u32, high: [d, e, f], count: count as u32 }
    }

    pub fn is_leaf(&self) -> bool {
        self.count > 0
    }

    /// Half the surface area. In double precision, so that boxes of any finite size can be compared.
    pub fn half_area(&self) -> f64 {
        let side = |axis: usize| f64::from(self.high[axis]) - f64::from(self.low[axis]);
        let (x, y, z) = (side(0), side(1), side(2));
        x * y + y * z + z * x
    }

    pub fn extent(&self) -> Extent {
        let ([a, b, c], [d, e, f]) = (self.low, self.high);
        Extent { low: [a, b, c, 0.0].into(), high: [d, e, f, 0.0].into() }
    }

    pub fn aabb(&self) -> Aabb {
        Aabb { min: self.low.into(), max: self.high.into() }
    }

    /// The node moved along the list by so much, with what hangs below.
    fn moved(self, by: isize) -> Self {
        let first = if self.is_leaf() { self.first } else { (self.first as isize + by) as u32 };
        Self { first, ..self }
    }
}

/// A tree under construction. Inside the pieces a node names its children relative to its own position, so
/// that pieces can be put behind one another; the root relative to the begin of the first piece.
pub(super) struct Subtree {
    root: BinaryNode,
    pieces: Vec<Vec<BinaryNode>>,
}

impl Subtree {
    /// A root above nodes that are named by their position in the list.
    pub fn new(root: BinaryNode, mut nodes: Vec<BinaryNode>) -> Self {
        for (position, node) in nodes.iter_mut().enumerate() {
            *node = node.moved(-(position as isize));
        }
        Self { root, pieces: vec![nodes] }
    }

    pub fn join(bounds: Extent, left: Self, right: Self) -> Self {
        let right_start = 2 + left.len() as isize;
        let mut pieces = vec![vec![left.root.moved(2), right.root.moved(right_start - 1)]];
        pieces.extend(left.pieces);
        pieces.extend(right.pieces);
        Self { root: BinaryNode::new(bounds, 0, 0), pieces }
    }

    fn len(&self) -> usize {
        self.pieces.iter().map(Vec::len).sum()
    }

    /// The nodes in one list, root first, children named by position.
    pub fn into_nodes(self) -> Pages<BinaryNode> {
        let mut nodes = Pages::zeroed(self.len() + 1);
        nodes[0] = self.root.moved(1);
        let (mut rest, mut start) = (&mut nodes[1..], 1);
        let mut jobs = Vec::with_capacity(self.pieces.len());
        for piece in self.pieces {
            let (target, after) = rest.split_at_mut(piece.len());
            rest = after;
            let position = start;
            start += piece.len() as isize;
            jobs.push((target, piece, position));
        }
        jobs.into_par_iter().for_each(|(target, piece, start)| {
            for ((place, node), position) in target.iter_mut().zip(piece).zip(start..) {
                *place = node.moved(position);
            }
        });
        nodes
    }
}
