//! Binary hierarchy, the intermediate result between construction and collapse.

use super::item::SimdBox;
use crate::pages::Pages;
use bytemuck::{Pod, Zeroable};
use juggler_math::Aabb;
use rayon::prelude::*;
use std::borrow::Cow;

/// A leaf of `count` items from position `first`, or, if `count` is zero, an inner node whose
/// children are at `first` and `first + 1`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(super) struct BinaryNode {
    pub low: [f32; 3],
    pub first: u32,
    pub high: [f32; 3],
    pub count: u32,
}

impl BinaryNode {
    pub fn new(bounds: SimdBox, first: usize, count: usize) -> Self {
        let ([a, b, c, _], [d, e, f, _]) = (bounds.low.to_array(), bounds.high.to_array());
        Self { low: [a, b, c], first: first as u32, high: [d, e, f], count: count as u32 }
    }

    pub fn is_leaf(&self) -> bool {
        self.count > 0
    }

    /// Half the surface area; in double precision, so that boxes of any finite size can be
    /// compared.
    pub fn half_area(&self) -> f64 {
        let side = |axis: usize| f64::from(self.high[axis]) - f64::from(self.low[axis]);
        let (x, y, z) = (side(0), side(1), side(2));
        x * y + y * z + z * x
    }

    pub fn bounds(&self) -> SimdBox {
        let ([a, b, c], [d, e, f]) = (self.low, self.high);
        SimdBox { low: [a, b, c, 0.0].into(), high: [d, e, f, 0.0].into() }
    }

    pub fn aabb(&self) -> Aabb {
        Aabb { min: self.low.into(), max: self.high.into() }
    }

    /// The node with its child index shifted by `by`; leaves do not change.
    fn moved(self, by: isize) -> Self {
        let first = if self.is_leaf() { self.first } else { (self.first as isize + by) as u32 };
        Self { first, ..self }
    }
}

/// Number of nodes from which a piece is moved to memory that is no longer needed. Moving saves
/// memory, but costs another parallel task when the pieces are concatenated.
const MOVED: usize = 1 << 10;

/// A tree under construction in pieces that are concatenated later. Inside the pieces, child
/// indices are relative to the node's own position; the root's are relative to the begin of the
/// first piece.
pub(super) struct Subtree<'a> {
    root: BinaryNode,
    pieces: Vec<Cow<'a, [BinaryNode]>>,
}

impl<'a> Subtree<'a> {
    /// Constructs a subtree from a root and nodes whose child indices are absolute positions in the
    /// list.
    pub fn new(root: BinaryNode, mut nodes: Vec<BinaryNode>) -> Self {
        for (position, node) in nodes.iter_mut().enumerate() {
            *node = node.moved(-(position as isize));
        }
        Self { root, pieces: vec![nodes.into()] }
    }

    /// The subtree with as much of its single piece as fits in memory that is no longer needed. Of
    /// small pieces, nothing is moved.
    pub fn moved_to(mut self, memory: &'a mut [BinaryNode]) -> Self {
        if let [piece] = &self.pieces[..]
            && piece.len() >= MOVED
        {
            let (moved, rest) = piece.split_at(piece.len().min(memory.len()));
            let (place, _) = memory.split_at_mut(moved.len());
            place.copy_from_slice(moved);
            let rest = rest.to_vec();
            self.pieces = vec![Cow::Borrowed(place)];
            if !rest.is_empty() {
                self.pieces.push(Cow::Owned(rest));
            }
        }
        self
    }

    /// The subtree with memory of its own.
    pub fn into_owned(self) -> Subtree<'static> {
        let pieces = self.pieces.into_iter().map(|piece| Cow::Owned(piece.into_owned()));
        Subtree { root: self.root, pieces: pieces.collect() }
    }

    pub fn join(bounds: SimdBox, left: Self, right: Self) -> Self {
        let right_start = 2 + left.len() as isize;
        let mut pieces = vec![vec![left.root.moved(2), right.root.moved(right_start - 1)].into()];
        pieces.extend(left.pieces);
        pieces.extend(right.pieces);
        Self { root: BinaryNode::new(bounds, 0, 0), pieces }
    }

    fn len(&self) -> usize {
        self.pieces.iter().map(|piece| piece.len()).sum()
    }

    /// Concatenates the pieces, root first, with absolute child indices.
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
            for ((place, node), position) in target.iter_mut().zip(&*piece).zip(start..) {
                *place = node.moved(position);
            }
        });
        nodes
    }
}
