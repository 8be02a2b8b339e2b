//! The scene, clip and variant that a choice selects.

use super::clips::ClipSet;
use super::names::Names;
use crate::gltf::document::Document;
use crate::gltf::error::Fault;
use juggler_math::suggest::did_you_mean_or_list;
use juggler_scene::model::{AnimationChoice, ModelChoice, NameOrIndex};

/// Root nodes of the chosen scene: of the choice, of the file, or all roots of a file without
/// scenes.
///
/// # Errors
///
/// The file has no such scene.
pub fn chosen_scene(names: &Names, document: &Document, choice: &ModelChoice) -> Result<Option<usize>, Fault> {
    match &choice.scene {
        Some(wanted) => find("scene", &names.scenes, wanted).map(Some),
        None if document.scenes.is_empty() => Ok(None),
        None => Ok(Some(document.scene.map_or(0, |scene| scene.get()))),
    }
}

/// Index of the chosen clip, if one is chosen and the file has any.
///
/// # Errors
///
/// The file has no such clip.
pub fn chosen_clip(clips: &ClipSet, choice: &ModelChoice) -> Result<Option<usize>, Fault> {
    match &choice.animation {
        AnimationChoice::First => Ok((clips.len() > 0).then_some(0)),
        AnimationChoice::None => Ok(None),
        AnimationChoice::Clip(wanted) => find("animation", &clips.names(), wanted).map(Some),
    }
}

/// Index of the chosen variant, if one is chosen.
///
/// # Errors
///
/// The file has no such variant.
pub fn chosen_variant(document: &Document, choice: &ModelChoice) -> Result<Option<usize>, Fault> {
    let variants = document.extensions.variants.iter().flat_map(|variants| &variants.variants);
    let names: Vec<String> = variants.map(|variant| variant.name.clone()).collect();
    choice.variant.as_ref().map(|wanted| find("variant", &names, wanted)).transpose()
}

/// Index of a part by its name or index.
fn find(kind: &str, names: &[String], wanted: &NameOrIndex) -> Result<usize, Fault> {
    let found = match wanted {
        NameOrIndex::Index(index) => Some(*index as usize).filter(|index| *index < names.len()),
        NameOrIndex::Name(name) => names.iter().position(|known| known == name),
    };
    found.ok_or_else(|| match wanted {
        NameOrIndex::Index(index) => Fault::at("", format!("there is no {kind} {index}; there are {}", names.len())),
        NameOrIndex::Name(name) => {
            let help = did_you_mean_or_list(name, names.iter().map(String::as_str));
            let help = help.map(|help| format!("; {help}")).unwrap_or_default();
            Fault::at("", format!("there is no {kind} `{name}`{help}"))
        }
    })
}
