//! Trees of nodes: transforms to world space, visibility, and the nodes of a scene in depth-first
//! order.

use super::faults::Faults;
use super::names::{joined, node_name};
use crate::gltf::document::{Document, Node};
use crate::gltf::error::Fault;
use crate::gltf::pose::{Hierarchy, NodeTransform, Pose};
use crate::gltf::warning::Warnings;
use glam::DAffine3;

/// Trees of the nodes of a file. Transforms stay in the document.
#[derive(Clone, Debug, Default)]
pub struct NodeTree {
    hierarchy: Hierarchy,
    /// Visibility of each node itself (KHR_node_visibility).
    visible: Vec<bool>,
}

/// A node of a scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SceneNode {
    /// Index of the node.
    pub index: usize,
    /// Names of the node and its ancestors, such as `Root/Body/Head`.
    pub path: String,
}

impl NodeTree {
    /// Nodes of a document.
    pub fn new(document: &Document, warnings: &mut Warnings, faults: &mut Faults) -> Self {
        let mut parents = vec![None; document.nodes.len()];
        for (parent, node) in document.nodes.iter().enumerate() {
            for child in &node.children {
                if let Some(slot) = parents.get_mut(child.get()) {
                    *slot = Some(parent);
                }
            }
        }
        let hierarchy = Hierarchy::new(&parents).map_err(|error| Fault::at("/nodes", error));
        let hierarchy = faults.take(hierarchy).unwrap_or_default();
        for (index, node) in document.nodes.iter().enumerate() {
            let off = node.rotation.is_some_and(|rotation| !NodeTransform::has_unit_length(rotation));
            if off {
                let text = "the rotation has not the length 1; it is normalized";
                warnings.add(format_args!("/nodes/{index}"), text, 1);
            }
            faults.take(transform(index, node));
        }
        let visibility = |node: &Node| node.extensions.as_ref().and_then(|extensions| extensions.visibility);
        let is_visible = |node| visibility(node).is_none_or(|visibility| visibility.visible);
        let visible = document.nodes.iter().map(is_visible).collect();
        Self { hierarchy, visible }
    }

    /// Transforms of all nodes to world space in a pose.
    pub fn world_transforms(&self, document: &Document, pose: &Pose) -> Vec<DAffine3> {
        self.hierarchy.world_transforms(|node| {
            let transform = known_transform(document, node);
            transform.map_or(DAffine3::IDENTITY, |transform| transform.to_parent(pose.nodes.get(&node)))
        })
    }

    /// Whether each node and all its ancestors are visible in a pose.
    pub fn visibility(&self, pose: &Pose) -> Vec<bool> {
        self.hierarchy.visibility(|node| {
            let animated = pose.nodes.get(&node).and_then(|pose| pose.visible);
            animated.or_else(|| self.visible.get(node).copied()).unwrap_or(true)
        })
    }

    /// Number of animated nodes whose transform is a matrix, which animations do not change.
    pub fn ignored_poses(document: &Document, pose: &Pose) -> usize {
        let ignores =
            |(node, pose): (&usize, _)| known_transform(document, *node).is_some_and(|node| node.ignores(pose));
        pose.nodes.iter().filter(|(node, pose)| ignores((node, pose))).count()
    }

    /// Nodes of a scene in depth-first order; all nodes if there is no scene.
    pub fn scene(&self, document: &Document, scene: Option<usize>) -> Vec<SceneNode> {
        let has_parent = |node: &usize| self.hierarchy.parent(*node).is_some();
        let roots: Vec<usize> = match scene.and_then(|scene| document.scenes.get(scene)) {
            Some(scene) => {
                // Listed nodes with parents come last, so that they keep the paths that their
                // parents give.
                let listed = scene.nodes.iter().map(|node| node.get());
                let (inner, mut roots): (Vec<usize>, Vec<usize>) = listed.partition(has_parent);
                roots.extend(inner);
                roots
            }
            None => (0..document.nodes.len()).filter(|node| !has_parent(node)).collect(),
        };
        let mut found: Vec<SceneNode> = Vec::new();
        let mut is_found = vec![false; document.nodes.len()];
        // Each entry is a node and the position of its parent in the list.
        let mut stack: Vec<(usize, Option<usize>)> = roots.into_iter().rev().map(|root| (root, None)).collect();
        while let Some((index, parent)) = stack.pop() {
            let Some(node) = document.nodes.get(index) else { continue };
            match is_found.get_mut(index) {
                Some(known @ false) => *known = true,
                _ => continue,
            }
            let above = parent.and_then(|parent| found.get(parent)).map(|parent| parent.path.as_str());
            let path = joined(above.unwrap_or_default(), &node_name(document, index));
            stack.extend(node.children.iter().rev().map(|child| (child.get(), Some(found.len()))));
            found.push(SceneNode { index, path });
        }
        found
    }
}

/// Transform of a node of a tree to the space of its parent; the tree has checked it.
fn known_transform(document: &Document, index: usize) -> Option<NodeTransform> {
    transform(index, document.nodes.get(index)?).ok()
}

/// Transform of a node to the space of its parent.
fn transform(index: usize, node: &Node) -> Result<NodeTransform, Fault> {
    let transform = match &node.matrix {
        Some(columns) => NodeTransform::from_matrix(columns),
        None => NodeTransform::from_parts(
            node.translation.unwrap_or_default(),
            node.rotation.unwrap_or([0.0, 0.0, 0.0, 1.0]),
            node.scale.unwrap_or([1.0; 3]),
        ),
    };
    transform.map_err(|error| Fault::at(format_args!("/nodes/{index}"), error))
}
