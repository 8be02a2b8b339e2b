//! Description of a glTF file for people.

use super::document::{Document, Primitive};
use super::extensions::{Support, extension};
use super::format::GltfModel;
use super::translate::{chosen_clip, chosen_scene, nodes_of_scene};
use juggler_scene::model::{
    ExtensionSupport, ModelChoice, ModelClip, ModelError, ModelExtension, ModelFile, ModelSummary,
};
use std::collections::BTreeSet;

/// Describes a file.
///
/// # Errors
///
/// The content is not valid, or the choice names something that the file does not have.
pub fn summary(model: &GltfModel, choice: &ModelChoice) -> Result<ModelSummary, ModelError> {
    let document = &model.data.gltf.document;
    let scene = chosen_scene(&model.names, document, choice).map_err(|fault| model.failed(fault))?;
    let clip = chosen_clip(&model.clips, choice).map_err(|fault| model.failed(fault))?;
    let parts = model.parts(choice, "")?;
    let nodes: Vec<usize> = nodes_of_scene(&model.source(), scene).into_iter().map(|(node, _)| node).collect();
    let (distinct, drawn) = triangles(document, &nodes);
    let clips = model.clips.names().into_iter().enumerate();
    let variants = document.extensions.variants.iter().flat_map(|variants| &variants.variants);
    Ok(ModelSummary {
        format: format!("glTF {}", document.asset.version),
        generator: document.asset.generator.clone(),
        scenes: model.names.scenes.clone(),
        variants: variants.map(|variant| variant.name.clone()).collect(),
        clips: clips.map(|(clip, name)| ModelClip { name, seconds: model.clips.duration(clip) }).collect(),
        clip,
        materials: model.names.materials.clone(),
        cameras: parts.cameras.keys().map(|name| (name.clone(), None)).collect(),
        lights: parts.lights.iter().map(|(name, _)| name.clone()).collect(),
        is_lit: !parts.lights.is_empty() || parts.background.is_some(),
        nodes: document.nodes.len(),
        distinct_triangles: distinct,
        drawn_triangles: drawn,
        textures: model.names.images.iter().map(|name| (name.clone(), None)).collect(),
        extensions: document.extensions_used.iter().map(|name| state(name)).collect(),
        warnings: parts.warnings,
    })
}

/// Support of an extension; unknown extensions are ignored.
fn state(name: &str) -> ModelExtension {
    let support = match extension(name).map(|extension| extension.support) {
        Some(Support::Whole) => ExtensionSupport::Whole,
        Some(Support::Approximated) => ExtensionSupport::Approximated,
        Some(Support::Ignored) | None => ExtensionSupport::Ignored,
    };
    ModelExtension { name: name.to_owned(), support }
}

/// Numbers of triangles of the distinct meshes and of all that the nodes draw, by the counts of the
/// accessors. Instances count once.
fn triangles(document: &Document, nodes: &[usize]) -> (u64, u64) {
    let mut known = BTreeSet::new();
    let (mut distinct, mut drawn) = (0u64, 0u64);
    for mesh in nodes.iter().filter_map(|node| document.nodes.get(*node)?.mesh) {
        let primitives = document.meshes.get(mesh.get()).map(|mesh| mesh.primitives.as_slice()).unwrap_or_default();
        let count = primitives.iter().map(|primitive| triangles_of(document, primitive)).sum::<u64>();
        drawn = drawn.saturating_add(count);
        if known.insert(mesh) {
            distinct = distinct.saturating_add(count);
        }
    }
    (distinct, drawn)
}

fn triangles_of(document: &Document, primitive: &Primitive) -> u64 {
    use super::document::{Mode, Semantic};
    let accessor = primitive.indices.or_else(|| primitive.attributes.find(&Semantic::Position));
    let count = accessor.and_then(|index| document.accessors.get(index.get())).map_or(0, |found| found.count.get());
    match primitive.mode {
        Mode::Triangles => count / 3,
        Mode::TriangleStrip | Mode::TriangleFan => count.saturating_sub(2),
        _ => 0,
    }
}
