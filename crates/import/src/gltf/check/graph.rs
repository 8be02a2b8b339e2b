//! Checks of the graph of nodes: each node has at most one parent and is not its own ancestor.

use super::checker::Checker;
use crate::gltf::document::Index;
use crate::gltf::location::Location;

/// Maximum number of nodes of a cycle in a message.
const MAX_SHOWN: usize = 8;

/// Parent of a node, and the position of the node among its children.
type Parent = Option<(usize, usize)>;

impl Checker<'_> {
    /// Checks that the nodes form trees, and warns of scenes that list other nodes than roots.
    pub(super) fn graph(&mut self) {
        let parents = self.parents();
        self.roots(&parents);
        let depths = self.cycles(&parents);
        self.depths(&depths);
    }

    /// Finds the parent of each node.
    fn parents(&mut self) -> Vec<Parent> {
        let nodes = &self.document.nodes;
        let mut parents: Vec<Parent> = vec![None; nodes.len()];
        let list = Location::root("nodes");
        for (parent, node) in nodes.iter().enumerate() {
            let at = list.index(parent);
            let children = at.key("children");
            for (position, child) in node.children.iter().enumerate() {
                let at = children.index(position);
                self.index(&at, *child, nodes.len(), "node");
                match parents.get_mut(child.get()) {
                    None => {}
                    Some(known @ None) => *known = Some((parent, position)),
                    Some(Some((other, _))) => {
                        let other = *other;
                        self.fault(&at, format_args!("node {child} is a child of node {other} already"));
                    }
                }
            }
        }
        parents
    }

    /// Warns of nodes of scenes that have parents.
    fn roots(&mut self, parents: &[Parent]) {
        let list = Location::root("scenes");
        for (position, scene) in self.document.scenes.iter().enumerate() {
            let at = list.index(position);
            let nodes = at.key("nodes");
            for (position, node) in scene.nodes.iter().enumerate() {
                if let Some(Some((parent, _))) = parents.get(node.get()) {
                    let text = "it is shown once, with the transforms of its ancestors";
                    self.warn(&nodes.index(position), format_args!("node {node} is a child of node {parent}; {text}"));
                }
            }
        }
    }

    /// Reports cycles. Returns the number of nodes on the path from a root to each node; that of
    /// nodes in or below a cycle is 0.
    fn cycles(&mut self, parents: &[Parent]) -> Vec<usize> {
        const ON_PATH: usize = usize::MAX;
        let mut depths: Vec<Option<usize>> = vec![None; parents.len()];
        let mut path = Vec::new();
        for start in 0..parents.len() {
            // Walk upwards to a node of known depth, to a root or to a node of this path.
            let mut node = Some(start);
            let above = loop {
                let Some(current) = node else { break Some(0) };
                match depths.get(current).copied().flatten() {
                    Some(ON_PATH) => {
                        let from = path.iter().position(|known| *known == current).unwrap_or(0);
                        self.cycle(path.get(from..).unwrap_or_default(), parents);
                        break None;
                    }
                    Some(0) => break None,
                    Some(depth) => break Some(depth),
                    None => {}
                }
                if let Some(depth) = depths.get_mut(current) {
                    *depth = Some(ON_PATH);
                }
                path.push(current);
                node = parents.get(current).copied().flatten().map(|(parent, _)| parent);
            };
            for (steps, current) in path.drain(..).rev().enumerate() {
                if let Some(depth) = depths.get_mut(current) {
                    *depth = Some(above.map_or(0, |above| above + steps + 1));
                }
            }
        }
        depths.into_iter().map(|depth| depth.unwrap_or(0)).collect()
    }

    /// Reports a cycle: nodes, each followed by its parent.
    fn cycle(&mut self, upwards: &[usize], parents: &[Parent]) {
        let Some(first) = upwards.iter().min().copied() else { return };
        let Some((parent, position)) = parents.get(first).copied().flatten() else { return };
        let mut ancestors = upwards.to_vec();
        ancestors.rotate_left(upwards.iter().position(|node| *node == first).unwrap_or(0));
        // Go from the first node downwards, which is backwards in the list.
        let mut shown: Vec<String> = ancestors.iter().skip(1).rev().map(usize::to_string).collect();
        if shown.len() > MAX_SHOWN {
            shown.truncate(MAX_SHOWN);
            shown.push("...".to_owned());
        }
        shown.push(first.to_string());
        let list = Location::root("nodes");
        let at = list.index(parent);
        let children = at.key("children");
        let path = shown.join(" -> ");
        let text = format_args!("node {first} is its own ancestor ({first} -> {path})");
        self.fault(&children.index(position), text);
    }

    /// Checks the depths of nodes.
    fn depths(&mut self, depths: &[usize]) {
        let limit = self.limits.node_depth;
        let Some(node) = depths.iter().position(|depth| *depth > limit) else { return };
        let list = Location::root("nodes");
        let node = Index::from(u32::try_from(node).unwrap_or(u32::MAX));
        self.fault(&list.index(node.get()), format_args!("has more than {limit} ancestors, the limit"));
    }
}
