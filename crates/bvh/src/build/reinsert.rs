//! Makes a finished binary tree better: subtrees are taken out and put where they enlarge the boxes least
//! (Bittner, Hapala, Havran 2013, "Fast Insertion-Based Optimization of Bounding Volume Hierarchies"; many at
//! once as in Meister and Bittner 2017, "Parallel Reinsertion for Bounding Volume Hierarchy Optimization").
//!
//! Deviation from the latter: of the moves found in parallel those that do not meet are made one after
//! another, the most gainful first, instead of by atomic locks, so that every run makes the same tree.

use super::binary::BinaryNode;
use super::item::Extent;
use crate::pages::Pages;
use rayon::prelude::*;

/// How often moves are looked for. More rounds bring next to nothing.
const ROUNDS: usize = 4;
/// A search ends after so many nodes; where many boxes overlap it would see them all.
const STEPS: usize = 2000;
/// Trees that became deeper than this are not used: 72 wide levels are the limit of the traversal.
const MAX_DEPTH: usize = 72;

/// The better tree, or the old one. Every leaf keeps its items. In each round one of `share` nodes is tried,
/// the largest first.
pub(super) fn optimize((nodes, order): (Pages<BinaryNode>, Vec<u32>), share: usize) -> (Pages<BinaryNode>, Vec<u32>) {
    if nodes.len() < 8 {
        return (nodes, order);
    }
    let mut better = nodes.clone();
    let mut tree = Tree::new(&mut better);
    let least = tree.least_area(share);
    for _ in 0..ROUNDS {
        let moves = tree.find_moves(least);
        tree.make(&moves);
    }
    let (listed, items, depth) = relist(&better, &order);
    if depth <= MAX_DEPTH { (listed, items) } else { (nodes, order) }
}

/// A node to be put beside another.
#[derive(Clone, Copy)]
struct Move {
    from: usize,
    to: usize,
    /// By how much the sum of all areas shrinks.
    gain: f64,
}

struct Tree<'a> {
    nodes: &'a mut [BinaryNode],
    /// The root is its own parent.
    parents: Vec<u32>,
}

/// The node with the same parent. Pairs start at odd numbers.
fn sibling(number: usize) -> usize {
    if number.is_multiple_of(2) { number - 1 } else { number + 1 }
}

fn area(bounds: Extent) -> f64 {
    BinaryNode::new(bounds, 0, 0).half_area()
}

impl<'a> Tree<'a> {
    fn new(nodes: &'a mut [BinaryNode]) -> Self {
        let mut parents = vec![0; nodes.len()];
        for (number, node) in nodes.iter().enumerate().filter(|(_, node)| !node.is_leaf()) {
            parents[node.first as usize] = number as u32;
            parents[node.first as usize + 1] = number as u32;
        }
        Self { nodes, parents }
    }

    fn parent(&self, number: usize) -> usize {
        self.parents[number] as usize
    }

    fn extent(&self, number: usize) -> Extent {
        self.nodes[number].extent()
    }

    /// One of `share` nodes is larger, or fewer where areas are the same.
    fn least_area(&self, share: usize) -> f64 {
        let mut areas: Vec<f64> = self.nodes.par_iter().map(BinaryNode::half_area).collect();
        let at = areas.len() / share;
        *areas.select_nth_unstable_by(at, |a, b| b.total_cmp(a)).1
    }

    /// The best moves of nodes with more than this area, the most gainful first.
    fn find_moves(&self, least_area: f64) -> Vec<Move> {
        let large = self.nodes.par_iter().enumerate().filter(|(_, node)| node.half_area() > least_area);
        // Children of the root have no other place.
        let numbers: Vec<usize> = large.map(|(n, _)| n).filter(|&n| self.parent(n) != 0).collect();
        let find = |stack: &mut Vec<(f64, usize)>, &number: &usize| self.find_move(number, stack);
        let mut moves: Vec<Move> = numbers.par_iter().map_init(Vec::new, find).flatten().collect();
        moves.par_sort_unstable_by(|a, b| b.gain.total_cmp(&a.gain).then(a.from.cmp(&b.from)));
        moves
    }

    /// Where a node should go. Walks up from it, and at each level down into the other side as long as the
    /// area saved so far exceeds the least that the node needs.
    fn find_move(&self, from: usize, stack: &mut Vec<(f64, usize)>) -> Option<Move> {
        let moved = self.extent(from);
        let moved_area = area(moved);
        let parent = self.parent(from);
        let mut best = Move { from, to: 0, gain: 0.0 };
        let mut saved = area(self.extent(parent));
        let (mut pivot, mut other) = (parent, sibling(from));
        let mut remaining = self.extent(other);
        let mut steps = 0;
        while steps < STEPS {
            stack.push((saved, other));
            while let Some((saved, to)) = stack.pop() {
                if saved - moved_area <= best.gain || steps == STEPS {
                    continue;
                }
                steps += 1;
                let node = &self.nodes[to];
                let gain = saved - area(node.extent().union(moved));
                if gain > best.gain && to != sibling(from) {
                    best = Move { from, to, gain };
                }
                if !node.is_leaf() {
                    let below = gain + node.half_area();
                    stack.extend([(below, node.first as usize), (below, node.first as usize + 1)]);
                }
            }
            if pivot == 0 {
                break;
            }
            if pivot != parent {
                remaining = remaining.union(self.extent(other));
                saved += area(self.extent(pivot)) - area(remaining);
            }
            other = sibling(pivot);
            pivot = self.parent(pivot);
        }
        (best.to != 0 && best.to != parent).then_some(best)
    }

    /// Makes the moves that do not touch what an earlier one has touched.
    fn make(&mut self, moves: &[Move]) {
        let mut touched = vec![false; self.nodes.len()];
        for &Move { from, to, .. } in moves {
            let places = [from, to, sibling(from), self.parent(from), self.parent(to)];
            if places.iter().any(|&place| touched[place]) || self.is_below(to, from) {
                continue;
            }
            places.iter().for_each(|&place| touched[place] = true);
            self.put(from, to);
        }
    }

    fn is_below(&self, mut number: usize, above: usize) -> bool {
        while number != 0 {
            if number == above {
                return true;
            }
            number = self.parent(number);
        }
        false
    }

    /// The sibling takes its parent's place; the pair that is free then holds the target and the node.
    fn put(&mut self, from: usize, to: usize) {
        let (parent, free) = (self.parent(from), sibling(from));
        self.set(parent, self.nodes[free]);
        self.set(free, self.nodes[to]);
        let pair = from.min(free);
        let bounds = self.extent(from).union(self.extent(free));
        self.set(to, BinaryNode::new(bounds, pair, 0));
        self.fit(parent);
        self.fit(to);
    }

    fn set(&mut self, number: usize, node: BinaryNode) {
        self.nodes[number] = node;
        if !node.is_leaf() {
            self.parents[node.first as usize] = number as u32;
            self.parents[node.first as usize + 1] = number as u32;
        }
    }

    /// New boxes from a node up to the root.
    fn fit(&mut self, mut number: usize) {
        while number != 0 {
            number = self.parent(number);
            let first = self.nodes[number].first as usize;
            self.nodes[number] = BinaryNode::new(self.extent(first).union(self.extent(first + 1)), first, 0);
        }
    }
}

/// Nodes depth first, the items in the order of the leaves, and the depth.
pub(super) fn relist(nodes: &[BinaryNode], order: &[u32]) -> (Pages<BinaryNode>, Vec<u32>, usize) {
    let mut pages = Pages::zeroed(nodes.len());
    let listed = &mut pages[..];
    let mut items = Vec::with_capacity(order.len());
    let (mut end, mut deepest, mut stack) = (1, 0, vec![(0, 0, 1)]);
    while let Some((number, place, depth)) = stack.pop() {
        let node: BinaryNode = nodes[number];
        let first = node.first as usize;
        deepest = deepest.max(depth);
        if node.is_leaf() {
            listed[place] = BinaryNode { first: items.len() as u32, ..node };
            items.extend_from_slice(&order[first..first + node.count as usize]);
        } else {
            listed[place] = BinaryNode { first: end as u32, ..node };
            stack.extend([(first + 1, end + 1, depth + 1), (first, end, depth + 1)]);
            end += 2;
        }
    }
    (pages, items, deepest)
}
