//! Collapse of the binary tree to eight children per node, as planned. Nodes are stored in
//! depth-first order; below a node, the child of the largest area comes first.

use super::BuildStats;
use super::binary::BinaryNode;
use super::plan::Plan;
use super::refit::sah_cost;
use crate::node::{Child, Node, WIDTH};
use crate::pages::Pages;
use rayon::prelude::*;

/// Number of wide levels whose children are parallel tasks.
const TASK_LEVELS: usize = 3;
/// Number of binary nodes below which one thread collapses the tree.
const SMALL: usize = 1 << 13;

/// Collapses a binary tree. Returns the wide nodes, root first, and their statistics. There is a
/// root even without items.
pub(super) fn collapse(binary: &[BinaryNode], leaf_size: usize, block: usize) -> (Pages<Node>, BuildStats) {
    if binary.is_empty() {
        return (vec![Node::EMPTY].into(), BuildStats { nodes: 1, depth: 1, block, ..BuildStats::default() });
    }
    let levels = if binary.len() < SMALL { 0 } else { TASK_LEVELS };
    let collapser = Collapser { binary, plan: Plan::new(binary, leaf_size, block) };
    let subtree = collapser.subtree(0, levels);
    let nodes = flatten(subtree.pieces);
    let sah_cost = sah_cost(&nodes, block);
    let stats = BuildStats { nodes: nodes.len(), sah_cost, block, ..subtree.stats };
    (nodes, stats)
}

/// Concatenates the pieces and makes child indices absolute; before, they are relative to the
/// node's own position.
fn flatten(pieces: Vec<Vec<Node>>) -> Pages<Node> {
    let mut nodes = Pages::zeroed(pieces.iter().map(Vec::len).sum());
    let (mut rest, mut start) = (&mut nodes[..], 0);
    let mut jobs = Vec::with_capacity(pieces.len());
    for piece in pieces {
        let (target, after) = rest.split_at_mut(piece.len());
        rest = after;
        let position = start;
        start += piece.len();
        jobs.push((target, piece, position));
    }
    jobs.into_par_iter().for_each(|(target, piece, start)| {
        for ((place, mut node), position) in target.iter_mut().zip(piece).zip(start..) {
            for child in node.children[..node.count as usize].iter_mut().filter(|child| !child.is_leaf()) {
                *child = Child::node(child.0 as usize + position);
            }
            *place = node;
        }
    });
    nodes
}

/// A wide subtree, root first.
struct Subtree {
    pieces: Vec<Vec<Node>>,
    /// Depth, stack size and leaf sizes.
    stats: BuildStats,
}

struct Collapser<'a> {
    binary: &'a [BinaryNode],
    plan: Plan<'a>,
}

impl Collapser<'_> {
    /// Collapses the subtree at a binary node; children down to `levels` are parallel tasks.
    fn subtree(&self, binary: usize, levels: usize) -> Subtree {
        if levels == 0 {
            let mut nodes = Vec::new();
            let stats = self.emit(binary, &mut nodes);
            return Subtree { pieces: vec![nodes], stats };
        }
        let (mut node, members) = self.node(binary);
        let inner: Vec<(usize, usize)> = self.inner(&members).collect();
        let below: Vec<Subtree> = inner.par_iter().map(|&(_, member)| self.subtree(member, levels - 1)).collect();
        let (mut pieces, mut size) = (vec![Vec::new()], 1);
        let mut stats = self.alone(&members);
        for ((slot, _), subtree) in inner.iter().zip(below) {
            node.children[*slot] = Child::node(size);
            size += subtree.pieces.iter().map(Vec::len).sum::<usize>();
            pieces.extend(subtree.pieces);
            add_child(&mut stats, &subtree.stats, members.count);
        }
        pieces[0].push(node);
        Subtree { pieces, stats }
    }

    /// Appends the wide nodes of the subtree at a binary node.
    fn emit(&self, binary: usize, nodes: &mut Vec<Node>) -> BuildStats {
        let place = nodes.len();
        let (node, members) = self.node(binary);
        nodes.push(node);
        let mut stats = self.alone(&members);
        for (slot, member) in self.inner(&members) {
            nodes[place].children[slot] = Child::node(nodes.len() - place);
            add_child(&mut stats, &self.emit(member, nodes), members.count);
        }
        stats
    }

    /// Wide node at a binary node, without the indices of inner children.
    fn node(&self, binary: usize) -> (Node, Members) {
        let members = self.members(binary);
        let mut node = Node::EMPTY;
        for &(member, _) in members.list().iter().rev() {
            let source = &self.binary[member];
            let child = self.plan.leaf(member).map_or(Child::ROOT, |(first, count)| Child::leaf(first, count));
            node.add(source.low, source.high, child);
        }
        (node, members)
    }

    /// Slots and binary nodes of the inner children by decreasing area. The largest has the last
    /// slot.
    fn inner(&self, members: &Members) -> impl Iterator<Item = (usize, usize)> {
        let slots = (0..members.count).rev().zip(members.list());
        slots.map(|(slot, &(member, _))| (slot, member)).filter(|&(_, member)| self.plan.leaf(member).is_none())
    }

    /// Binary nodes that become the children of the wide node at `binary`, by decreasing area.
    fn members(&self, binary: usize) -> Members {
        let mut members = Members { list: [(binary, 0.0); WIDTH], count: 0 };
        self.plan.children(binary, &mut |member| members.insert(member, self.binary[member].half_area()));
        members
    }

    /// Statistics of a node and its leaves, without inner children.
    fn alone(&self, members: &Members) -> BuildStats {
        let mut stats = BuildStats { depth: 1, stack: members.count, ..BuildStats::default() };
        for &(member, _) in members.list() {
            if let Some((_, count)) = self.plan.leaf(member) {
                stats.leaf_sizes[count] += 1;
            }
        }
        stats
    }
}

/// Merges the statistics of a child. Traversal pushes all `count` children at once; when it enters
/// one, the others stay on the stack.
fn add_child(stats: &mut BuildStats, child: &BuildStats, count: usize) {
    stats.depth = stats.depth.max(child.depth + 1);
    stats.stack = stats.stack.max(count - 1 + child.stack);
    for (all, some) in stats.leaf_sizes.iter_mut().zip(child.leaf_sizes) {
        *all += some;
    }
}

/// Future children and their areas, by decreasing area.
struct Members {
    list: [(usize, f64); WIDTH],
    count: usize,
}

impl Members {
    fn list(&self) -> &[(usize, f64)] {
        &self.list[..self.count]
    }

    /// Inserts a child, after those of equal area.
    fn insert(&mut self, member: usize, area: f64) {
        let slot = self.list().iter().position(|&(_, other)| other < area).unwrap_or(self.count);
        self.list.copy_within(slot..self.count, slot + 1);
        self.list[slot] = (member, area);
        self.count += 1;
    }
}
