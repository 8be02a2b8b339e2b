//! Targets of animation channels: node properties, weights of meshes, and any other property by its
//! JSON pointer (KHR_animation_pointer).

/// Animated property of a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum NodeProperty {
    /// Translation in the parent's space.
    Translation,
    /// Rotation as a quaternion.
    Rotation,
    /// Scale factors along the node's axes.
    Scale,
    /// Weights of all morph targets.
    Weights,
    /// Weight of one morph target.
    Weight(usize),
    /// Visibility (KHR_node_visibility): visible where the value is not 0.
    Visible,
}

/// Animated property.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum ChannelTarget {
    /// Property of a node.
    Node {
        /// Index of the node.
        node: usize,
        /// The property.
        property: NodeProperty,
    },
    /// Default weights of a mesh's morph targets.
    Mesh {
        /// Index of the mesh.
        mesh: usize,
        /// The morph target; all if `None`.
        morph_target: Option<usize>,
    },
    /// Another property.
    Pointer(String),
}

impl NodeProperty {
    /// Number of components; `None` if it is that of the mesh's morph targets.
    pub fn components(self) -> Option<usize> {
        match self {
            Self::Translation | Self::Scale => Some(3),
            Self::Rotation => Some(4),
            Self::Weight(_) | Self::Visible => Some(1),
            Self::Weights => None,
        }
    }
}

impl ChannelTarget {
    /// Target of a channel with `node` and one of the paths `translation`, `rotation`, `scale` and
    /// `weights`; `None` for another path.
    pub fn from_path(node: usize, path: &str) -> Option<Self> {
        let property = match path {
            "translation" => NodeProperty::Translation,
            "rotation" => NodeProperty::Rotation,
            "scale" => NodeProperty::Scale,
            "weights" => NodeProperty::Weights,
            _ => return None,
        };
        Some(Self::Node { node, property })
    }

    /// Target of a channel with a JSON pointer, such as `/nodes/3/rotation`.
    pub fn from_pointer(pointer: &str) -> Self {
        let tokens: Vec<&str> = pointer.split('/').collect();
        let known = match tokens.as_slice() {
            ["", "nodes", node, path] => index(node).and_then(|node| Self::from_path(node, path)),
            ["", "nodes", node, "weights", weight] => index(node)
                .zip(index(weight))
                .map(|(node, weight)| Self::Node { node, property: NodeProperty::Weight(weight) }),
            ["", "nodes", node, "extensions", "KHR_node_visibility", "visible"] => {
                index(node).map(|node| Self::Node { node, property: NodeProperty::Visible })
            }
            ["", "meshes", mesh, "weights"] => index(mesh).map(|mesh| Self::Mesh { mesh, morph_target: None }),
            ["", "meshes", mesh, "weights", weight] => {
                index(mesh).zip(index(weight)).map(|(mesh, weight)| Self::Mesh { mesh, morph_target: Some(weight) })
            }
            _ => None,
        };
        known.unwrap_or_else(|| Self::Pointer(pointer.to_owned()))
    }

    /// Number of components of the target; `None` if the target determines none.
    pub fn components(&self) -> Option<usize> {
        match self {
            Self::Node { property, .. } => property.components(),
            Self::Mesh { morph_target, .. } => morph_target.map(|_| 1),
            Self::Pointer(_) => None,
        }
    }
}

/// Array index of a JSON pointer: digits without leading zeros (RFC 6901, section 4).
fn index(token: &str) -> Option<usize> {
    let is_index = token.bytes().all(|byte| byte.is_ascii_digit()) && (token == "0" || !token.starts_with('0'));
    token.parse().ok().filter(|_| is_index)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn node(node: usize, property: NodeProperty) -> ChannelTarget {
        ChannelTarget::Node { node, property }
    }

    #[test]
    fn pointers_name_nodes_meshes_and_other_properties() {
        let cases = [
            ("/nodes/3/translation", node(3, NodeProperty::Translation)),
            ("/nodes/0/rotation", node(0, NodeProperty::Rotation)),
            ("/nodes/12/scale", node(12, NodeProperty::Scale)),
            ("/nodes/1/weights", node(1, NodeProperty::Weights)),
            ("/nodes/1/weights/2", node(1, NodeProperty::Weight(2))),
            ("/nodes/7/extensions/KHR_node_visibility/visible", node(7, NodeProperty::Visible)),
            ("/meshes/4/weights", ChannelTarget::Mesh { mesh: 4, morph_target: None }),
            ("/meshes/4/weights/0", ChannelTarget::Mesh { mesh: 4, morph_target: Some(0) }),
        ];
        for (pointer, expected) in cases {
            assert_eq!(ChannelTarget::from_pointer(pointer), expected, "{pointer}");
        }
        for other in [
            "",
            "/",
            "/nodes",
            "/nodes/01/scale",
            "/nodes/-1/scale",
            "/nodes/+1/scale",
            "/nodes//scale",
            "/nodes/99999999999999999999999/scale",
            "/nodes/1/matrix",
            "/materials/0/alphaCutoff",
            "nodes/1/scale",
        ] {
            assert_eq!(ChannelTarget::from_pointer(other), ChannelTarget::Pointer(other.to_owned()), "{other}");
        }
    }

    #[test]
    fn paths_name_node_properties() {
        assert_eq!(ChannelTarget::from_path(2, "weights"), Some(node(2, NodeProperty::Weights)));
        assert_eq!(ChannelTarget::from_path(2, "pointer"), None);
        assert_eq!(ChannelTarget::from_path(2, "rotation").and_then(|target| target.components()), Some(4));
        assert_eq!(ChannelTarget::from_pointer("/meshes/4/weights/0").components(), Some(1));
    }
}
