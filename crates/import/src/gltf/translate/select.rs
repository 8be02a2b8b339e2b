//! The scene, the clip and the variant that a choice selects.

use super::Content;
use super::names::node_name;
use super::tree::SceneNode;
use crate::gltf::document::Document;
use crate::gltf::error::Fault;
use juggler_math::suggest::did_you_mean_or_list;
use juggler_scene::model::{AnimationChoice, ModelChoice, NameOrIndex};

/// Indices of what a choice selects.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Selection {
    /// Scene; all root nodes of a file without scenes if `None`.
    pub scene: Option<usize>,
    /// Animation clip.
    pub clip: Option<usize>,
    /// Variant of materials.
    pub variant: Option<usize>,
}

impl Selection {
    /// Finds what a choice selects.
    ///
    /// # Errors
    ///
    /// The file lacks the scene, the clip or the variant. All faults are reported at once.
    pub fn new(content: &Content, choice: &ModelChoice) -> Result<Self, Vec<Fault>> {
        let (names, document) = (&content.names, &content.data.gltf.document);
        let scene = match &choice.scene {
            Some(wanted) => find("scene", "/scenes", &names.scenes, wanted).map(Some),
            None if document.scenes.is_empty() => Ok(None),
            None => Ok(Some(document.scene.map_or(0, |scene| scene.get()))),
        };
        let clip = match &choice.animation {
            AnimationChoice::First => Ok((!names.clips.is_empty()).then_some(0)),
            AnimationChoice::None => Ok(None),
            AnimationChoice::Clip(wanted) => find("animation", "/animations", &names.clips, wanted).map(Some),
        };
        let variants = "/extensions/KHR_materials_variants/variants";
        let variant = choice.variant.as_ref().map(|wanted| find("variant", variants, &names.variants, wanted));
        match (scene, clip, variant.transpose()) {
            (Ok(scene), Ok(clip), Ok(variant)) => Ok(Self { scene, clip, variant }),
            (scene, clip, variant) => Err([scene.err(), clip.err(), variant.err()].into_iter().flatten().collect()),
        }
    }
}

/// Index of the node with a path such as `Root/Body/Head`, or with a name that no other node has.
pub fn node(document: &Document, nodes: &[SceneNode], wanted: &str) -> Result<usize, Fault> {
    let name = |node: &SceneNode| node_name(document, node.index);
    let by_path: Vec<&SceneNode> = nodes.iter().filter(|node| node.path == wanted).collect();
    let by_name = || nodes.iter().filter(|node| name(node) == wanted).collect();
    let found: Vec<&SceneNode> = if by_path.is_empty() { by_name() } else { by_path };
    match found.as_slice() {
        [node] => Ok(node.index),
        [] => {
            let names: Vec<_> = nodes.iter().map(name).collect();
            let help = did_you_mean_or_list(wanted, names.iter().map(|name| &**name));
            let help = help.unwrap_or_else(|| "there are none".to_owned());
            Err(Fault::at("/nodes", format!("there is no node `{wanted}`; {help}")))
        }
        [first, ..] => {
            let text = format!("{} nodes are called `{wanted}`; write the path, such as `{}`", found.len(), first.path);
            Err(Fault::at("/nodes", text))
        }
    }
}

/// Index of a part by its name or index.
fn find(kind: &str, pointer: &str, names: &[String], wanted: &NameOrIndex) -> Result<usize, Fault> {
    let known = names.iter().map(String::as_str);
    match wanted {
        NameOrIndex::Index(index) if (*index as usize) < names.len() => Ok(*index as usize),
        NameOrIndex::Index(index) => {
            Err(Fault::at(pointer, format!("there is no {kind} {index}, there are {}", names.len())))
        }
        NameOrIndex::Name(name) => names.iter().position(|known| known == name).ok_or_else(|| {
            let help = did_you_mean_or_list(name, known).unwrap_or_else(|| "there are none".to_owned());
            Fault::at(pointer, format!("there is no {kind} `{name}`; {help}"))
        }),
    }
}
