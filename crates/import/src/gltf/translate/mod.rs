//! Translation of a glTF file to parts of a scene.
//!
//! | module | translates |
//! |---|---|
//! | `names` | names of parts, which are unique |
//! | `clips` | animations to clips and to a pose at a time |
//! | `geometry` | primitives to meshes, each once |
//! | `deformed` | skins and morph targets at a pose |
//! | `nodes` | the scene's nodes to objects |
//! | `instances` | EXT_mesh_gpu_instancing |
//! | `textures`, `materials` | materials with their textures |
//! | `cameras`, `lights` | cameras and lights of nodes |

mod cameras;
mod clips;
mod deformed;
mod geometry;
mod instances;
mod lights;
mod materials;
mod names;
mod nodes;
mod select;
mod textures;

pub(super) use clips::ClipSet;
pub(super) use geometry::GeometryCache;
pub(super) use names::Names;
pub(super) use nodes::nodes_of_scene;
pub(super) use select::{chosen_clip, chosen_scene, chosen_variant};

use super::data::GltfData;
use super::error::Fault;
use super::warning::Warnings;
use juggler_scene::model::{ModelChoice, ModelParts};
use materials::MaterialSet;
use nodes::Walk;

/// What a translation reads.
#[derive(Clone, Copy, Debug)]
pub(super) struct Source<'a> {
    /// The file with its buffers.
    pub data: &'a GltfData,
    /// Animation clips of the file.
    pub clips: &'a ClipSet,
    /// Meshes that were decoded before.
    pub geometry: &'a GeometryCache,
    /// Names of the file's parts.
    pub names: &'a Names,
}

/// Translates the chosen scene of a file. The names of all parts begin with `prefix`.
///
/// # Errors
///
/// An array is not valid, or the choice names something that the file does not have.
pub(super) fn translate(source: &Source<'_>, choice: &ModelChoice, prefix: &str) -> Result<ModelParts, Fault> {
    let document = &source.data.gltf.document;
    let scene = chosen_scene(source.names, document, choice)?;
    let clip = chosen_clip(source.clips, choice)?;
    let pose = clip.map(|clip| source.clips.pose(clip, choice)).unwrap_or_default();
    let variant = chosen_variant(document, choice)?;
    let mut warnings = Warnings::default();
    let materials = MaterialSet::new(source.data, source.names, prefix);
    let mut walk = Walk::new(source, materials, &pose, variant, prefix)?;
    walk.scene(scene, &mut warnings)?;
    let mut parts = walk.finish(&mut warnings);
    parts.cameras = cameras::cameras(source, &walk_worlds(source, &pose)?, scene, prefix);
    parts.lights = lights::lights(source, &walk_worlds(source, &pose)?, scene, choice.photometric);
    parts.warnings = texts(&warnings);
    Ok(parts)
}

/// Transforms of all nodes to world space in a pose.
fn walk_worlds(source: &Source<'_>, pose: &super::pose::Pose) -> Result<Vec<glam::DAffine3>, Fault> {
    nodes::world_transforms(&source.data.gltf.document, pose)
}

/// Warnings as texts.
pub(super) fn texts(warnings: &Warnings) -> Vec<String> {
    let further = (warnings.omitted() > 0).then(|| format!("{} further warnings", warnings.omitted()));
    warnings.list().iter().map(ToString::to_string).chain(further).collect()
}
