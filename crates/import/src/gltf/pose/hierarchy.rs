//! Node hierarchies: transforms to world space and inherited visibility, each in one pass over the
//! nodes without recursion.

use glam::DAffine3;
use std::mem;

/// Index that stands for no node.
const NONE: u32 = u32::MAX;

/// Error of the parents of a hierarchy.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum HierarchyError {
    /// A parent is not a node of the hierarchy.
    #[error("the parent of node {node} is node {parent}; there are {nodes} nodes")]
    Parent {
        /// The child.
        node: usize,
        /// The index that its parent should have.
        parent: usize,
        /// Number of nodes.
        nodes: usize,
    },
    /// A node is among its own ancestors.
    #[error("node {node} is its own ancestor")]
    Cycle {
        /// A node of the cycle.
        node: usize,
    },
    /// The nodes cannot be counted by 32 bits.
    #[error("{nodes} nodes; at most {} are possible", u32::MAX)]
    TooMany {
        /// Number of nodes.
        nodes: usize,
    },
}

/// Trees of nodes: the parent of each node, and an order in which parents precede children.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Hierarchy {
    /// Parent of each node, or `NONE`.
    parents: Vec<u32>,
    /// All nodes, parents first.
    order: Vec<u32>,
}

impl Hierarchy {
    /// Constructs a hierarchy from the parent of each node; roots have none. Cycles are errors.
    pub fn new(parents: &[Option<usize>]) -> Result<Self, HierarchyError> {
        let nodes = parents.len();
        if u32::try_from(nodes).is_err() {
            return Err(HierarchyError::TooMany { nodes });
        }
        let outside = |parent: usize| parent >= nodes;
        let wrong = parents.iter().enumerate().find_map(|(node, parent)| Some((node, parent.filter(|p| outside(*p))?)));
        if let Some((node, parent)) = wrong {
            return Err(HierarchyError::Parent { node, parent, nodes });
        }
        let parents: Vec<u32> = parents.iter().map(|parent| parent.map_or(NONE, |parent| parent as u32)).collect();
        let order = topological_order(&parents);
        if order.len() < nodes {
            return Err(HierarchyError::Cycle { node: node_of_cycle(&parents, &order) });
        }
        Ok(Self { parents, order })
    }

    /// Number of nodes.
    pub fn len(&self) -> usize {
        self.parents.len()
    }

    /// Whether there are no nodes.
    pub fn is_empty(&self) -> bool {
        self.parents.is_empty()
    }

    /// Parent of a node; `None` for roots and for indices beyond the last node.
    pub fn parent(&self, node: usize) -> Option<usize> {
        self.parents.get(node).filter(|parent| **parent != NONE).map(|parent| *parent as usize)
    }

    /// Transform of each node to world space, from the transform `local` of a node to its parent's
    /// space. A singular transform ([`is_invertible`](super::is_invertible)), as a scale of 0 gives
    /// it, hides what the node draws, except a skinned mesh, which its own node does not transform.
    pub fn world_transforms(&self, local: impl Fn(usize) -> DAffine3) -> Vec<DAffine3> {
        self.inherit(DAffine3::IDENTITY, |parent, node| match parent {
            Some(parent) => *parent * local(node),
            None => local(node),
        })
    }

    /// Whether each node and all its ancestors are visible, from the visibility `own` of a node
    /// ([`NodePose::visible`](super::NodePose::visible), else that of the file).
    pub fn visibility(&self, own: impl Fn(usize) -> bool) -> Vec<bool> {
        self.inherit(false, |parent, node| parent.copied().unwrap_or(true) && own(node))
    }

    /// Computes a value of each node from that of its parent.
    fn inherit<T: Clone>(&self, placeholder: T, value: impl Fn(Option<&T>, usize) -> T) -> Vec<T> {
        let mut values = vec![placeholder; self.parents.len()];
        for node in self.order.iter().map(|node| *node as usize) {
            let inherited = value(self.parent(node).and_then(|parent| values.get(parent)), node);
            if let Some(slot) = values.get_mut(node) {
                *slot = inherited;
            }
        }
        values
    }
}

/// Nodes that have a root among their ancestors, or are one, in breadth-first order.
fn topological_order(parents: &[u32]) -> Vec<u32> {
    // Link the children of each node to a list, in the order of their indices.
    let mut first_child = vec![NONE; parents.len()];
    let mut next_sibling = vec![NONE; parents.len()];
    for (node, (parent, next)) in parents.iter().zip(&mut next_sibling).enumerate().rev() {
        if let Some(first) = first_child.get_mut(*parent as usize) {
            *next = mem::replace(first, node as u32);
        }
    }
    let roots = parents.iter().enumerate().filter(|(_, parent)| **parent == NONE);
    let mut order: Vec<u32> = roots.map(|(node, _)| node as u32).collect();
    let mut visited = 0;
    while let Some(node) = order.get(visited).copied() {
        visited += 1;
        let mut child = first_child.get(node as usize).copied();
        while let Some(node) = child.filter(|child| *child != NONE) {
            order.push(node);
            child = next_sibling.get(node as usize).copied();
        }
    }
    order
}

/// A node that is its own ancestor, where the order leaves nodes out.
fn node_of_cycle(parents: &[u32], order: &[u32]) -> usize {
    let mut is_ordered = vec![false; parents.len()];
    for node in order {
        if let Some(slot) = is_ordered.get_mut(*node as usize) {
            *slot = true;
        }
    }
    let mut node = is_ordered.iter().position(|is_ordered| !is_ordered).unwrap_or_default();
    // As many steps to the parent as there are nodes end in the cycle.
    for _ in parents {
        node = parents.get(node).map_or(node, |parent| *parent as usize);
    }
    node
}

#[cfg(test)]
mod tests {
    use super::super::matrix::{is_invertible, normal_matrix};
    use super::super::testing::{difference, random_affine, random_rotation, random_vector};
    use super::super::{NodePose, NodeTransform};
    use super::*;
    use glam::{DMat3, DQuat, DVec3};
    use juggler_math::testing::Random;

    /// A random forest whose nodes have random indices.
    fn random_parents(random: &mut Random, nodes: usize) -> Vec<Option<usize>> {
        let mut names: Vec<usize> = (0..nodes).collect();
        for i in (1..nodes).rev() {
            names.swap(i, random.below(i + 1));
        }
        let mut parents = vec![None; nodes];
        for i in 1..nodes {
            parents[names[i]] = (random.below(5) > 0).then(|| names[random.below(i)]);
        }
        parents
    }

    #[test]
    fn transforms_are_products_along_the_ancestors() {
        let mut random = Random::new(41);
        for nodes in [0, 1, 2, 7, 50] {
            let parents = random_parents(&mut random, nodes);
            let locals: Vec<DAffine3> = (0..nodes).map(|_| random_affine(&mut random)).collect();
            let hidden: Vec<bool> = (0..nodes).map(|_| random.below(6) == 0).collect();
            let hierarchy = Hierarchy::new(&parents).unwrap();
            let worlds = hierarchy.world_transforms(|node| locals[node]);
            let visibility = hierarchy.visibility(|node| !hidden[node]);
            assert_eq!((hierarchy.len(), worlds.len(), hierarchy.is_empty()), (nodes, nodes, nodes == 0));
            for node in 0..nodes {
                let (mut world, mut visible, mut ancestor) = (locals[node], !hidden[node], parents[node]);
                assert_eq!(hierarchy.parent(node), parents[node]);
                while let Some(parent) = ancestor {
                    (world, visible, ancestor) = (locals[parent] * world, visible && !hidden[parent], parents[parent]);
                }
                let size = world.to_cols_array().iter().fold(1.0_f64, |size, v| size.max(v.abs()));
                assert!(difference(&worlds[node], &world) < 1e-12 * size, "{node}");
                assert_eq!(visibility[node], visible, "{node}");
            }
        }
    }

    #[test]
    fn wrong_parents_are_errors() {
        let error = Hierarchy::new(&[None, Some(2)]).unwrap_err();
        assert_eq!(error.to_string(), "the parent of node 1 is node 2; there are 2 nodes");
        assert!(Hierarchy::new(&[Some(usize::MAX)]).is_err());
        assert_eq!(Hierarchy::new(&[Some(0)]), Err(HierarchyError::Cycle { node: 0 }));
        // Node 1 hangs below the cycle of 3 and 4.
        let error = Hierarchy::new(&[None, Some(3), Some(0), Some(4), Some(3)]).unwrap_err();
        assert!(matches!(error, HierarchyError::Cycle { node: 3 | 4 }), "{error}");
    }

    #[test]
    fn deep_chains_need_no_stack() {
        let nodes = 300_000;
        let parents: Vec<Option<usize>> = (0..nodes).map(|node| (node + 1 < nodes).then_some(node + 1)).collect();
        let hierarchy = Hierarchy::new(&parents).unwrap();
        let worlds = hierarchy.world_transforms(|_| DAffine3::from_translation(DVec3::X));
        assert_eq!((worlds[0].translation, worlds[nodes - 1].translation), (DVec3::X * 300_000.0, DVec3::X));
        assert!(!hierarchy.visibility(|node| node + 1 < nodes).contains(&true));
    }

    #[test]
    fn mirrored_parents_keep_normals_outside() {
        let mut random = Random::new(42);
        let mirror = NodeTransform::from_parts([1.0, 2.0, 3.0], DQuat::IDENTITY.to_array(), [-1.0, 1.0, 1.0]).unwrap();
        for _ in 0..100 {
            let rotation = random_rotation(&mut random).to_array();
            let child =
                NodeTransform::from_parts(random_vector(&mut random, 2.0).into(), rotation, [1.0, 2.0, 0.5]).unwrap();
            let nodes = [&mirror, &child, &mirror];
            let hierarchy = Hierarchy::new(&[None, Some(0), Some(1)]).unwrap();
            let worlds = hierarchy.world_transforms(|node| nodes[node].to_parent(None));
            let determinants = [0, 1, 2].map(|node: usize| worlds[node].matrix3.determinant());
            assert!(determinants[0] < 0.0 && determinants[1] < 0.0 && determinants[2] > 0.0);
            // On a sphere about the origin the normal is the point, so it stays on the outer side.
            for world in &worlds {
                let [n, along] = [(); 2].map(|()| random.unit_vector().as_dvec3());
                let normal = normal_matrix(&world.matrix3) * n;
                assert!(normal.dot(world.transform_vector3(n)) > 0.0);
                let tangent = world.transform_vector3(n.cross(along));
                assert!(normal.dot(tangent).abs() < 1e-12 * normal.length() * tangent.length().max(1.0));
            }
        }
    }

    #[test]
    fn uneven_scale_above_a_rotation_shears() {
        let turn = juggler_math::quaternion::from_axis_degrees(DVec3::Z, 45.0).unwrap();
        let stretched = NodeTransform::from_parts([0.0; 3], DQuat::IDENTITY.to_array(), [3.0, 1.0, 1.0]).unwrap();
        let turned = NodeTransform::from_parts([1.0, 0.0, 0.0], turn.to_array(), [1.0; 3]).unwrap();
        let hierarchy = Hierarchy::new(&[Some(1), None]).unwrap();
        let world = hierarchy.world_transforms(|node| [&turned, &stretched][node].to_parent(None))[0];
        let h = 0.5_f64.sqrt();
        let columns = [[3.0 * h, h, 0.0], [-3.0 * h, h, 0.0], [0.0, 0.0, 1.0], [3.0, 0.0, 0.0]];
        let expected = DAffine3::from_cols_array_2d(&columns);
        assert!(difference(&world, &expected) < 1e-15);
        assert!(world.matrix3.x_axis.dot(world.matrix3.y_axis).abs() > 1.0, "the axes are not at right angles");
    }

    #[test]
    fn scales_of_zero_make_descendants_singular() {
        let flat = NodeTransform::from_parts([0.0; 3], DQuat::IDENTITY.to_array(), [1.0, 0.0, 1.0]).unwrap();
        let hierarchy = Hierarchy::new(&[None, Some(0), None]).unwrap();
        let nodes = [&flat, &NodeTransform::default(), &NodeTransform::default()];
        let worlds = hierarchy.world_transforms(|node| nodes[node].to_parent(None));
        assert_eq!([0, 1, 2].map(|node: usize| is_invertible(&worlds[node].matrix3)), [false, false, true]);
        let pose = NodePose { scale: Some(DVec3::ONE), ..NodePose::default() };
        let shown = hierarchy.world_transforms(|node| nodes[node].to_parent((node == 0).then_some(&pose)));
        assert_eq!(shown[1].matrix3, DMat3::IDENTITY);
    }
}
