//! Names of the parts of a file. Each is unique among its kind: names that repeat get a number in
//! the order of the file, and parts without a name are called by their kind and index.

use crate::gltf::document::Document;
use std::collections::BTreeSet;

/// Names by index.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Names {
    /// Names of the scenes.
    pub scenes: Vec<String>,
    /// Names of the nodes. A node's name need not be unique: objects are called by paths of nodes.
    pub nodes: Vec<String>,
    /// Names of the meshes.
    pub meshes: Vec<String>,
    /// Names of the materials.
    pub materials: Vec<String>,
    /// Names of the images.
    pub images: Vec<String>,
    /// Names of the animations.
    pub animations: Vec<String>,
}

impl Names {
    /// Names of a document's parts.
    pub fn new(document: &Document) -> Self {
        let Document { scenes, nodes, meshes, materials, images, animations, .. } = document;
        Self {
            scenes: unique("scene", scenes.iter().map(|scene| scene.name.as_deref())),
            nodes: named("node", nodes.iter().map(|node| node.name.as_deref())),
            meshes: unique("mesh", meshes.iter().map(|mesh| mesh.name.as_deref())),
            materials: unique("material", materials.iter().map(|material| material.name.as_deref())),
            images: unique("image", images.iter().map(|image| image.name.as_deref())),
            animations: unique("animation", animations.iter().map(|animation| animation.name.as_deref())),
        }
    }
}

/// Names in which missing and empty ones are the kind with the index.
fn named<'n>(kind: &str, names: impl Iterator<Item = Option<&'n str>>) -> Vec<String> {
    let name = |(index, name): (usize, Option<&str>)| match name.filter(|name| !name.is_empty()) {
        Some(name) => name.to_owned(),
        None => format!("{kind} {index}"),
    };
    names.enumerate().map(name).collect()
}

/// Unique names: the second `Name` is `Name#2`.
fn unique<'n>(kind: &str, names: impl Iterator<Item = Option<&'n str>>) -> Vec<String> {
    let mut known = BTreeSet::new();
    let mut counts = std::collections::BTreeMap::new();
    named(kind, names)
        .into_iter()
        .map(|name| {
            let mut candidate = name.clone();
            let count = counts.entry(name.clone()).or_insert(1u64);
            // The loop ends: the number rises, and there are finitely many names.
            while !known.insert(candidate.clone()) {
                *count += 1;
                candidate = format!("{name}#{count}");
            }
            candidate
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn repeated_and_missing_names_become_unique() {
        let names = [Some("a"), None, Some("a"), Some(""), Some("a#2"), Some("a")];
        assert_eq!(unique("mesh", names.into_iter()), ["a", "mesh 1", "a#2", "mesh 3", "a#2#2", "a#3"]);
    }
}
