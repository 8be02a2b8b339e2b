//! Names of the parts of a file. Names of one kind are unique: a name that repeats gets a number in
//! the order of the file, and a part without a name is called by its kind and index.

use crate::gltf::document::{Document, Variants};
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};

/// Maximum number of bytes of a path of node names.
const MAX_PATH: usize = 1024;

/// Names by index.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Names {
    /// Names of the scenes.
    pub scenes: Vec<String>,
    /// Names of the meshes.
    pub meshes: Vec<String>,
    /// Names of the materials.
    pub materials: Vec<String>,
    /// Names of the images.
    pub images: Vec<String>,
    /// Names of the animation clips.
    pub clips: Vec<String>,
    /// Names of the variants of materials.
    pub variants: Vec<String>,
}

impl Names {
    /// Names of a document's parts.
    pub fn new(document: &Document) -> Self {
        let Document { scenes, meshes, materials, images, animations, extensions, .. } = document;
        let variants = extensions.variants.as_ref().map(|Variants { variants }| variants.as_slice());
        Self {
            scenes: unique("scene", scenes.iter().map(|scene| scene.name.as_deref())),
            meshes: unique("mesh", meshes.iter().map(|mesh| mesh.name.as_deref())),
            materials: unique("material", materials.iter().map(|material| material.name.as_deref())),
            images: unique("image", images.iter().map(|image| image.name.as_deref())),
            clips: unique("animation", animations.iter().map(|animation| animation.name.as_deref())),
            variants: unique("variant", variants.unwrap_or_default().iter().map(|variant| Some(&*variant.name))),
        }
    }
}

/// Name of a node, which need not be unique: objects are called by paths of names.
pub fn node_name(document: &Document, node: usize) -> Cow<'_, str> {
    let name = document.nodes.get(node).and_then(|node| node.name.as_deref()).filter(|name| !name.is_empty());
    name.map_or_else(|| Cow::Owned(format!("node {node}")), Cow::Borrowed)
}

/// Names in which missing and empty ones are the kind with the index.
fn named<'n>(kind: &str, names: impl Iterator<Item = Option<&'n str>>) -> impl Iterator<Item = String> {
    names.enumerate().map(move |(index, name)| match name.filter(|name| !name.is_empty()) {
        Some(name) => name.to_owned(),
        None => format!("{kind} {index}"),
    })
}

/// Unique names: the second `Name` is `Name#2`.
pub fn unique<'n>(kind: &str, names: impl Iterator<Item = Option<&'n str>>) -> Vec<String> {
    let (mut known, mut counts) = (BTreeSet::new(), BTreeMap::<String, u64>::new());
    named(kind, names)
        .map(|name| {
            if known.insert(name.clone()) {
                return name;
            }
            let count = counts.entry(name.clone()).or_insert(1);
            loop {
                *count += 1;
                let candidate = format!("{name}#{count}");
                if known.insert(candidate.clone()) {
                    return candidate;
                }
            }
        })
        .collect()
}

/// Path of a node below a parent: `Root/Body/Head`. A path that would exceed 1,024 bytes begins
/// anew, so that the memory for paths is proportional to the number of nodes.
pub fn joined(parent: &str, name: &str) -> String {
    let mut path = String::new();
    if !parent.is_empty() && parent.len() + name.len() < MAX_PATH {
        path.reserve_exact(parent.len() + name.len() + 1);
        path.push_str(parent);
        path.push('/');
    }
    path.push_str(name.get(..name.floor_char_boundary(MAX_PATH)).unwrap_or_default());
    path
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn repeated_and_missing_names_become_unique() {
        let names = [Some("a"), None, Some("a"), Some(""), Some("a#2"), Some("a")];
        assert_eq!(unique("mesh", names.into_iter()), ["a", "mesh 1", "a#2", "mesh 3", "a#2#2", "a#3"]);
    }

    #[test]
    fn paths_are_joined_and_bounded() {
        assert_eq!((joined("", "Root"), joined("Root/Body", "Head")), ("Root".into(), "Root/Body/Head".into()));
        let long = "ä".repeat(1000);
        assert_eq!(joined("Root", &long).len(), MAX_PATH);
        assert_eq!(joined(&joined("", &long), "Head"), "Head");
    }
}
