//! From two wide to eight wide: each node takes the place of its children, the largest first, until there
//! are eight (Wald, Benthin, Boulos 2008, "Getting Rid of Packets", section 3.2).

use super::{BinaryNode, BuildStats, half_area};
use crate::node::{Child, Node, WIDTH};

/// The wide tree, root first, and what can be said about it. The root is there even when there is no item.
pub(super) fn collapse(binary: &[BinaryNode], block: usize) -> (Vec<Node>, BuildStats) {
    let mut collapser = Collapser { binary, block, nodes: Vec::new(), stats: BuildStats::default() };
    match binary.first() {
        None => collapser.nodes.push(Node::EMPTY),
        Some(_) => _ = collapser.emit(0, 1),
    }
    let root_area = binary.first().map_or(1.0, |root| half_area(&root.bounds));
    let mut stats = collapser.stats;
    stats.nodes = collapser.nodes.len();
    stats.sah_cost = if root_area > 0.0 { stats.sah_cost / root_area } else { 0.0 };
    (collapser.nodes, stats)
}

struct Collapser<'a> {
    binary: &'a [BinaryNode],
    block: usize,
    nodes: Vec<Node>,
    stats: BuildStats,
}

impl Collapser<'_> {
    /// Appends the wide node for a binary one and all below it; returns its number and the stack it needs.
    fn emit(&mut self, binary: usize, depth: usize) -> (usize, usize) {
        let index = self.nodes.len();
        self.nodes.push(Node::EMPTY);
        self.stats.depth = self.stats.depth.max(depth);
        self.stats.sah_cost += half_area(&self.binary[binary].bounds);
        let (members, count) = self.members(binary);
        let mut node = Node::EMPTY;
        let mut below = 0;
        for &member in &members[..count] {
            let source = &self.binary[member];
            let child = if source.count > 0 {
                self.stats.leaf_sizes[source.count] += 1;
                self.stats.sah_cost += half_area(&source.bounds) * source.count.div_ceil(self.block) as f64;
                Child::leaf(source.first, source.count)
            } else {
                let (child, stack) = self.emit(member, depth + 1);
                below = below.max(stack);
                Child::node(child)
            };
            node.add(&self.binary[member].bounds, child);
        }
        self.nodes[index] = node;
        // All children are pushed at once; when one is entered, the others wait.
        let stack = count.max(count - 1 + below);
        self.stats.stack = self.stats.stack.max(stack);
        (index, stack)
    }

    /// The binary nodes that become children of the wide node in place of `binary`.
    fn members(&self, binary: usize) -> ([usize; WIDTH], usize) {
        let mut members = [binary; WIDTH];
        let mut count = 1;
        while count < WIDTH {
            let inner = (0..count).filter(|&slot| self.binary[members[slot]].count == 0);
            let area = |slot: usize| half_area(&self.binary[members[slot]].bounds);
            let Some(slot) = inner.max_by(|&a, &b| area(a).total_cmp(&area(b)).then(b.cmp(&a))) else { break };
            let first = self.binary[members[slot]].first;
            members[slot] = first;
            members[count] = first + 1;
            count += 1;
        }
        (members, count)
    }
}
