//! Collapse of the binary tree to eight children per node, as planned. Nodes are stored in
//! depth-first order; below a node, the child of the largest area comes first.

use super::BuildStats;
use super::binary::BinaryNode;
use super::binned::Settings;
use super::plan::Plan;
use super::refit::sah_cost;
use crate::node::{Child, Node, WIDTH};
use crate::pages::Pages;
use juggler_math::{BuildControl, Cancelled};
use rayon::prelude::*;

/// Number of wide levels whose children are parallel tasks.
const TASK_LEVELS: usize = 3;
/// Number of binary nodes below which one thread collapses the tree.
const SMALL: usize = 1 << 13;

/// Collapses a binary tree. Returns the wide nodes, root first, and their statistics. There is a
/// root even without items.
pub(super) fn collapse(binary: &[BinaryNode], settings: &Settings) -> Result<(Pages<Node>, BuildStats), Cancelled> {
    let (leaf_size, block, control) = (settings.leaf_size, 1 << settings.block.0, settings.control);
    if binary.is_empty() {
        return Ok((vec![Node::EMPTY].into(), BuildStats { nodes: 1, depth: 1, block, ..BuildStats::default() }));
    }
    let levels = if binary.len() < SMALL { 0 } else { TASK_LEVELS };
    let collapser = Collapser { binary, plan: Plan::new(binary, leaf_size, block, control), control };
    control.check()?;
    let size = collapser.size(0, levels);
    control.check()?;
    let mut nodes = Pages::zeroed(size.nodes);
    let stats = collapser.write(0, &size, &mut nodes, 0);
    let sah_cost = sah_cost(&nodes, block);
    let stats = BuildStats { nodes: nodes.len(), sah_cost, block, ..stats };
    control.check()?;
    Ok((nodes, stats))
}

/// Number of wide nodes of a subtree. `below` has the sizes of its inner children's subtrees if
/// these are parallel tasks.
struct Size {
    nodes: usize,
    below: Vec<Size>,
}

struct Collapser<'a> {
    binary: &'a [BinaryNode],
    plan: Plan<'a>,
    control: &'a BuildControl,
}

impl Collapser<'_> {
    /// Size of the subtree at a binary node; children down to `levels` are parallel tasks. After
    /// cancellation sizes are too small, and nothing may be written.
    fn size(&self, binary: usize, levels: usize) -> Size {
        if self.control.is_cancelled() {
            return Size { nodes: 0, below: Vec::new() };
        }
        if levels == 0 {
            return Size { nodes: self.count(binary), below: Vec::new() };
        }
        let inner: Vec<usize> = self.inner(&self.members(binary)).map(|(_, member)| member).collect();
        let below: Vec<Size> = inner.into_par_iter().map(|member| self.size(member, levels - 1)).collect();
        Size { nodes: 1 + below.iter().map(|size| size.nodes).sum::<usize>(), below }
    }

    /// Number of wide nodes of the subtree at a binary node.
    fn count(&self, binary: usize) -> usize {
        let mut count = 1;
        let inner = |member: usize| if self.plan.leaf(member).is_none() { self.count(member) } else { 0 };
        self.plan.children(binary, &mut |member| count += inner(member));
        count
    }

    /// Writes the wide nodes of the subtree at a binary node into `nodes`, the first of which has
    /// the index `first` in the tree.
    fn write(&self, binary: usize, size: &Size, nodes: &mut [Node], first: usize) -> BuildStats {
        if self.control.is_cancelled() {
            return BuildStats::default();
        }
        if size.below.is_empty() {
            return self.write_sequentially(binary, nodes, first, &mut 0);
        }
        let (mut node, members) = self.node(binary);
        let (root, mut rest) = nodes.split_at_mut(1);
        let (mut jobs, mut start) = (Vec::with_capacity(size.below.len()), first + 1);
        for ((slot, member), size) in self.inner(&members).zip(&size.below) {
            node.children[slot] = Child::node(start);
            let (target, after) = rest.split_at_mut(size.nodes);
            rest = after;
            jobs.push((member, size, target, start));
            start += size.nodes;
        }
        root[0] = node;
        let write = |(member, size, target, start)| self.write(member, size, target, start);
        let below: Vec<BuildStats> = jobs.into_par_iter().map(write).collect();
        let mut stats = self.alone(&members);
        below.iter().for_each(|child| add_child(&mut stats, child, members.count));
        stats
    }

    /// [`Collapser::write`] by one thread, from position `next` of the nodes, which moves behind
    /// the subtree.
    fn write_sequentially(&self, binary: usize, nodes: &mut [Node], first: usize, next: &mut usize) -> BuildStats {
        let place = *next;
        *next += 1;
        let (node, members) = self.node(binary);
        nodes[place] = node;
        let mut stats = self.alone(&members);
        for (slot, member) in self.inner(&members) {
            nodes[place].children[slot] = Child::node(first + *next);
            add_child(&mut stats, &self.write_sequentially(member, nodes, first, next), members.count);
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
