//! Optimization by reinsertion: subtrees are removed and inserted where they increase the surface
//! area least (Bittner, Hapala, Havran 2013, "Fast Insertion-Based Optimization of Bounding Volume
//! Hierarchies"; in parallel as in Meister and Bittner 2017, "Parallel Reinsertion for Bounding
//! Volume Hierarchy Optimization").
//!
//! Deviation from the latter: of the moves found in parallel, those that do not conflict are
//! applied sequentially by decreasing gain, in place of atomic locks, so that the result is
//! deterministic.

use super::binary::BinaryNode;
use super::item::SimdBox;
use crate::pages::Pages;
use juggler_math::{BuildControl, Cancelled};
use rayon::prelude::*;

/// Number of rounds. More rounds gain next to nothing.
const ROUNDS: usize = 4;
/// Maximum number of nodes that one search visits; where many boxes overlap it would visit all.
const STEPS: usize = 2000;
/// Depth above which the optimized tree is discarded: traversal supports 72 wide levels.
const MAX_DEPTH: usize = 72;
/// Number of levels whose depths are measured in parallel.
const TASK_LEVELS: usize = 10;
/// Number of nodes that are listed between tests for cancellation, a power of two.
const CHECKED: usize = 1 << 16;

/// Returns the optimized tree, or the original one if the former is too deep. Leaves keep their
/// items. Each round considers one of `share` nodes, the largest ones.
pub(super) fn optimize(
    (nodes, order): (Pages<BinaryNode>, Vec<u32>),
    share: usize,
    control: &BuildControl,
) -> Result<(Pages<BinaryNode>, Vec<u32>), Cancelled> {
    if nodes.len() < 8 {
        return Ok((nodes, order));
    }
    control.check()?;
    let mut better = nodes.clone();
    control.check()?;
    let mut tree = Tree::new(&mut better);
    control.check()?;
    let least = tree.least_area(share);
    for _ in 0..ROUNDS {
        let moves = tree.find_moves(least, control)?;
        tree.apply(&moves);
    }
    drop(tree);
    control.check()?;
    if depth(&better, 0, TASK_LEVELS) > MAX_DEPTH {
        return Ok((nodes, order));
    }
    drop(nodes);
    relist(&better, &order, control)
}

/// Number of levels of the subtree at a node; the upper `levels` are parallel tasks.
fn depth(nodes: &[BinaryNode], number: usize, levels: usize) -> usize {
    let node = &nodes[number];
    if node.is_leaf() {
        return 1;
    }
    let below = |child: usize| depth(nodes, node.first as usize + child, levels.saturating_sub(1));
    let (left, right) = if levels > 0 { rayon::join(|| below(0), || below(1)) } else { (below(0), below(1)) };
    1 + left.max(right)
}

/// A reinsertion of node `from` as a sibling of node `to`.
#[derive(Clone, Copy)]
struct Move {
    from: usize,
    to: usize,
    /// Decrease of the total surface area.
    gain: f64,
}

struct Tree<'a> {
    nodes: &'a mut [BinaryNode],
    /// Parent indices; the root is its own parent.
    parents: Vec<u32>,
}

/// Index of the other child of the same parent. Pairs of siblings start at odd indices.
fn sibling(number: usize) -> usize {
    if number.is_multiple_of(2) { number - 1 } else { number + 1 }
}

fn area(bounds: SimdBox) -> f64 {
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

    fn bounds(&self, number: usize) -> SimdBox {
        self.nodes[number].bounds()
    }

    /// Area that one in `share` nodes exceeds, or fewer if areas are equal.
    fn least_area(&self, share: usize) -> f64 {
        let mut areas: Vec<f64> = self.nodes.par_iter().map(BinaryNode::half_area).collect();
        let at = areas.len() / share;
        *areas.select_nth_unstable_by(at, |a, b| b.total_cmp(a)).1
    }

    /// Finds the best moves of nodes with an area above `least_area`, by decreasing gain.
    fn find_moves(&self, least_area: f64, control: &BuildControl) -> Result<Vec<Move>, Cancelled> {
        control.check()?;
        let large = self.nodes.par_iter().enumerate().filter(|(_, node)| node.half_area() > least_area);
        // Children of the root have no other place.
        let numbers: Vec<usize> = large.map(|(n, _)| n).filter(|&n| self.parent(n) != 0).collect();
        let find = |stack: &mut Vec<(f64, usize)>, &number: &usize| {
            if control.is_cancelled() { None } else { self.find_move(number, stack) }
        };
        let mut moves: Vec<Move> = numbers.par_iter().map_init(Vec::new, find).flatten().collect();
        control.check()?;
        moves.par_sort_unstable_by(|a, b| b.gain.total_cmp(&a.gain).then(a.from.cmp(&b.from)));
        Ok(moves)
    }

    /// Finds the best target for a node. Walks up from the node and, at each level, descends into
    /// the sibling's subtree while the area saved so far exceeds the minimum that the insertion
    /// adds.
    fn find_move(&self, from: usize, stack: &mut Vec<(f64, usize)>) -> Option<Move> {
        let moved = self.bounds(from);
        let moved_area = area(moved);
        let parent = self.parent(from);
        let mut best = Move { from, to: 0, gain: 0.0 };
        let mut saved = area(self.bounds(parent));
        let (mut pivot, mut other) = (parent, sibling(from));
        let mut remaining = self.bounds(other);
        let mut steps = 0;
        while steps < STEPS {
            stack.push((saved, other));
            while let Some((saved, to)) = stack.pop() {
                if saved - moved_area <= best.gain || steps == STEPS {
                    continue;
                }
                steps += 1;
                let node = &self.nodes[to];
                let gain = saved - area(node.bounds().union(moved));
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
                remaining = remaining.union(self.bounds(other));
                saved += area(self.bounds(pivot)) - area(remaining);
            }
            other = sibling(pivot);
            pivot = self.parent(pivot);
        }
        (best.to != 0 && best.to != parent).then_some(best)
    }

    /// Applies the moves that do not touch nodes of an earlier move.
    fn apply(&mut self, moves: &[Move]) {
        let mut touched = vec![false; self.nodes.len()];
        for &Move { from, to, .. } in moves {
            let places = [from, to, sibling(from), self.parent(from), self.parent(to)];
            if places.iter().any(|&place| touched[place]) || self.is_below(to, from) {
                continue;
            }
            places.iter().for_each(|&place| touched[place] = true);
            self.reinsert(from, to);
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

    /// Moves a node: the sibling replaces its parent, and the freed pair holds the target and the
    /// node.
    fn reinsert(&mut self, from: usize, to: usize) {
        let (parent, free) = (self.parent(from), sibling(from));
        self.set(parent, self.nodes[free]);
        self.set(free, self.nodes[to]);
        let pair = from.min(free);
        let bounds = self.bounds(from).union(self.bounds(free));
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

    /// Refits the boxes from a node up to the root.
    fn fit(&mut self, mut number: usize) {
        while number != 0 {
            number = self.parent(number);
            let first = self.nodes[number].first as usize;
            self.nodes[number] = BinaryNode::new(self.bounds(first).union(self.bounds(first + 1)), first, 0);
        }
    }
}

/// Lists the nodes depth first, with items in leaf order.
pub(super) fn relist(
    nodes: &[BinaryNode],
    order: &[u32],
    control: &BuildControl,
) -> Result<(Pages<BinaryNode>, Vec<u32>), Cancelled> {
    let mut pages = Pages::zeroed(nodes.len());
    let listed = &mut pages[..];
    let mut items = Vec::with_capacity(order.len());
    let (mut end, mut stack) = (1, vec![(0, 0)]);
    while let Some((number, place)) = stack.pop() {
        let node: BinaryNode = nodes[number];
        let first = node.first as usize;
        if node.is_leaf() {
            listed[place] = BinaryNode { first: items.len() as u32, ..node };
            items.extend_from_slice(&order[first..first + node.count as usize]);
        } else {
            if end % CHECKED == 1 {
                control.check()?;
            }
            listed[place] = BinaryNode { first: end as u32, ..node };
            stack.extend([(first + 1, end + 1), (first, end)]);
            end += 2;
        }
    }
    Ok((pages, items))
}
