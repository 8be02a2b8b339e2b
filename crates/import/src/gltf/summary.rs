//! Description of a glTF file for people.

use super::document::{Document, Mode, Primitive, Semantic};
use super::error::GltfError;
use super::extensions::{Support, extension};
use super::format::GltfModel;
use super::translate::camera_aspects;
use juggler_math::BuildControl;
use juggler_scene::model::{ExtensionSupport, ModelChoice, ModelClip, ModelExtension, ModelParts, ModelSummary};
use std::collections::BTreeSet;

/// Describes a file.
///
/// # Errors
///
/// The content is not valid, or the choice names something that the file does not have.
pub fn summary(model: &GltfModel, choice: &ModelChoice) -> Result<ModelSummary, GltfError> {
    let (content, document) = (&model.content, model.document());
    // The objects of many nodes are dropped at once.
    let ModelParts { lights, background, warnings, .. } = content.parts(choice, "", &BuildControl::new())?;
    let posed = content.posed(choice)?;
    let nodes = posed.nodes.iter().map(|node| node.index);
    let clips = content.clips.iter().map(|clip| ModelClip { name: clip.name.clone(), seconds: clip.duration() });
    let names = &content.names;
    Ok(ModelSummary {
        format: format!("glTF {}", document.asset.version),
        generator: document.asset.generator.clone(),
        scenes: names.scenes.clone(),
        variants: names.variants.clone(),
        clips: clips.collect(),
        clip: posed.selection.clip,
        materials: names.materials.clone(),
        cameras: camera_aspects(&content.view(&posed, ""), document),
        lights: lights.iter().map(|(name, _)| name.clone()).collect(),
        illuminance: content.illuminance(&posed, &lights),
        has_environment: background.is_some(),
        nodes: document.nodes.len(),
        distinct_triangles: distinct_triangles(model),
        drawn_triangles: nodes.map(|node| drawn_triangles(document, node)).fold(0, u64::saturating_add),
        textures: textures(model),
        extensions: document.extensions_used.iter().map(|name| support(name)).collect(),
        warnings,
    })
}

/// Names of the pictures with their sizes.
fn textures(model: &GltfModel) -> Vec<(String, Option<[u32; 2]>)> {
    let size = |image: usize| {
        let asset = model.content.data.image_asset(image)?;
        super::image_size::image_size(asset.bytes()?)
    };
    model.content.names.images.iter().enumerate().map(|(image, name)| (name.clone(), size(image))).collect()
}

/// Support of an extension; unknown extensions are ignored.
fn support(name: &str) -> ModelExtension {
    let support = match extension(name).map(|extension| extension.support) {
        Some(Support::Whole) => ExtensionSupport::Whole,
        Some(Support::Approximated) => ExtensionSupport::Approximated,
        Some(Support::Ignored) | None => ExtensionSupport::Ignored,
    };
    ModelExtension { name: name.to_owned(), support }
}

/// Number of triangles of the distinct primitives of a file, by the counts of accessors.
fn distinct_triangles(model: &GltfModel) -> u64 {
    let document = model.document();
    let mut known = BTreeSet::new();
    let mut sum = 0_u64;
    for (mesh, found) in document.meshes.iter().enumerate() {
        for (part, primitive) in found.primitives.iter().enumerate() {
            if known.insert(model.content.meshes.slot(mesh, part)) {
                sum = sum.saturating_add(triangles(document, primitive));
            }
        }
    }
    sum
}

/// Number of triangles that a node draws, with its instances.
fn drawn_triangles(document: &Document, node: usize) -> u64 {
    let Some(node) = document.nodes.get(node) else { return 0 };
    let mesh = node.mesh.and_then(|mesh| document.meshes.get(mesh.get()));
    let primitives = mesh.map(|mesh| mesh.primitives.as_slice()).unwrap_or_default();
    let count = primitives.iter().map(|primitive| triangles(document, primitive)).fold(0, u64::saturating_add);
    let instancing = node.extensions.as_deref().and_then(|extensions| extensions.instancing.as_ref());
    let instances = instancing.map(|instancing| {
        let first =
            instancing.attributes.iter().next().and_then(|(_, accessor)| document.accessors.get(accessor.get()));
        first.map_or(0, |accessor| accessor.count.get())
    });
    count.saturating_mul(instances.unwrap_or(1))
}

/// Number of triangles of a primitive, degenerate ones included.
pub fn triangles(document: &Document, primitive: &Primitive) -> u64 {
    let accessor = primitive.indices.or_else(|| primitive.attributes.find(&Semantic::Position));
    let corners = accessor.and_then(|index| document.accessors.get(index.get())).map_or(0, |found| found.count.get());
    match primitive.mode {
        Mode::Triangles => corners / 3,
        Mode::TriangleStrip | Mode::TriangleFan => corners.saturating_sub(2),
        Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip => 0,
    }
}
