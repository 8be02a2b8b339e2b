//! Translation of a glTF file to parts of a scene.
//!
//! | module | translates |
//! |---|---|
//! | `names` | names of parts, which are unique |
//! | `select` | the choice of scene, clip and variant |
//! | `clips`, `pointers` | animations to a pose, and to a document with animated numbers |
//! | `tree` | nodes to transforms and paths |
//! | `meshes`, `thin` | primitives to meshes, each decoded once; points and lines to solids |
//! | `deformed` | skins and morph targets in a pose |
//! | `objects`, `instances` | nodes to objects and groups |
//! | `rest_bounds` | the bounding box of a scene |
//! | `materials` | materials with their textures |
//! | `cameras`, `lights` | cameras and lights of nodes |
//! | `image_based` | image-based lights of scenes |

mod cameras;
mod clips;
mod deformed;
mod faults;
mod image_based;
mod instances;
mod lights;
mod materials;
mod matrix;
mod meshes;
mod names;
mod objects;
mod pointers;
mod rest_bounds;
mod select;
#[cfg(test)]
mod tests;
mod thin;
mod tree;

pub(super) use cameras::camera_aspects;
pub(super) use meshes::Meshes;
pub(super) use names::Names;
pub(super) use objects::View;
pub(super) use select::Selection;

use super::data::GltfData;
use super::error::GltfError;
use super::pose::{Clip, Pose};
use super::warning::Warnings;
use deformed::Skins;
use faults::Faults;
use glam::DAffine3;
use image_based::ImageBased;
use instances::Instances;
use juggler_light::AnyLight;
use juggler_math::BuildControl;
use juggler_scene::model::{ModelChoice, ModelParts};
use materials::MaterialSet;
use objects::{Findings, Objects};
use tree::{NodeTree, SceneNode};

/// A file with what translations share: names, clips, and arrays that are decoded at their first
/// use.
#[derive(Debug)]
pub(super) struct Content {
    /// The file with its buffers and images.
    pub data: GltfData,
    /// Names of the parts.
    pub names: Names,
    /// Animation clips.
    pub clips: Vec<Clip>,
    /// Warnings about the file that hold for all choices.
    pub warnings: Warnings,
    /// Primitives.
    pub meshes: Meshes,
    tree: NodeTree,
    skins: Skins,
    instances: Instances,
    image_based: ImageBased,
}

/// A scene of a file in a pose.
#[derive(Clone, Debug, Default)]
pub(super) struct Posed {
    /// What the choice selects.
    pub selection: Selection,
    /// Size of the picture in pixels.
    pub picture_size: Option<[u32; 2]>,
    /// Nodes of the scene, depth first.
    pub nodes: Vec<SceneNode>,
    pose: Pose,
    worlds: Vec<DAffine3>,
    visible: Vec<bool>,
}

impl Content {
    /// Reads names, clips and nodes of a file.
    ///
    /// # Errors
    ///
    /// An animation or the transform of a node is not valid. All faults are reported at once.
    pub fn new(data: GltfData) -> Result<Self, GltfError> {
        let document = &data.gltf.document;
        let (mut warnings, mut faults) = (data.gltf.warnings.clone(), Faults::new(data.gltf.limits.faults));
        let names = Names::new(document);
        let clips = clips::read_clips(&data, &names.clips, &mut warnings, &mut faults);
        let tree = NodeTree::new(document, &mut warnings, &mut faults);
        if !faults.is_empty() {
            return Err(faults.into_error(&data.gltf.name));
        }
        let (meshes, skins, instances) =
            (Meshes::new(document, &data.gltf.limits), Skins::new(document), Instances::new(document));
        let image_based = ImageBased::new(document);
        Ok(Self { names, clips, warnings, meshes, tree, skins, instances, image_based, data })
    }

    /// The scene, in the pose of a choice.
    ///
    /// # Errors
    ///
    /// The choice names something that the file does not have.
    pub fn posed(&self, choice: &ModelChoice) -> Result<Posed, GltfError> {
        let selection = Selection::new(self, choice).map_err(|list| {
            let mut faults = Faults::new(self.data.gltf.limits.faults);
            list.into_iter().for_each(|fault| faults.add(fault));
            faults.into_error(&self.data.gltf.name)
        })?;
        let pose = clips::pose_of(selection.clip.and_then(|clip| self.clips.get(clip)), choice);
        let document = &self.data.gltf.document;
        let nodes = self.tree.scene(document, selection.scene);
        let (worlds, visible) = (self.tree.world_transforms(document, &pose), self.tree.visibility(&pose));
        Ok(Posed { selection, picture_size: choice.picture_size, nodes, pose, worlds, visible })
    }

    /// Whether a choice shows an animation clip.
    pub fn moves(&self, choice: &ModelChoice) -> bool {
        Selection::new(self, choice).is_ok_and(|selection| selection.clip.is_some())
    }

    /// Transform of a node to world space in the pose of a choice. `node` is a name or a path of
    /// names; nodes of all scenes count.
    ///
    /// # Errors
    ///
    /// There is no such node, several nodes have the name, or the choice names something that the
    /// file does not have.
    pub fn node_transform(&self, node: &str, choice: &ModelChoice) -> Result<DAffine3, GltfError> {
        let posed = self.posed(choice)?;
        let document = &self.data.gltf.document;
        let nodes = self.tree.scene(document, None);
        let found =
            select::node(document, &nodes, node).map_err(|fault| GltfError::new(&self.data.gltf.name, fault))?;
        Ok(posed.worlds.get(found).copied().unwrap_or_default())
    }

    /// View of a scene in a pose.
    pub fn view<'a>(&'a self, posed: &'a Posed, prefix: &'a str) -> View<'a> {
        let Posed { selection, picture_size, nodes, pose, worlds, visible } = posed;
        let (selection, picture_size) = (*selection, *picture_size);
        View { content: self, pose, worlds, visible, nodes, selection, picture_size, prefix }
    }

    /// Typical illuminance by `lights` among the meshes of a scene; 0 without lights.
    pub fn illuminance(&self, posed: &Posed, lights: &[(String, AnyLight)]) -> f32 {
        if lights.is_empty() {
            return 0.0;
        }
        let mut faults = Faults::new(0);
        let bounds = rest_bounds::rest_bounds(&self.view(posed, ""), &mut faults);
        let lights: Vec<&AnyLight> = lights.iter().map(|(_, light)| light).collect();
        juggler_scene::model::illuminance(&lights, &bounds)
    }

    /// Translates the chosen scene. The names of all parts begin with `prefix`.
    ///
    /// # Errors
    ///
    /// An array is not valid, or the choice names something that the file does not have. All faults
    /// are reported at once. If `control` is cancelled, objects are missing.
    pub fn parts(&self, choice: &ModelChoice, prefix: &str, control: &BuildControl) -> Result<ModelParts, GltfError> {
        let posed = self.posed(choice)?;
        let view = self.view(&posed, prefix);
        let mut findings =
            Findings { warnings: self.warnings.clone(), faults: Faults::new(self.data.gltf.limits.faults) };
        let scenes_missing = posed.selection.scene.is_none() && !self.data.gltf.document.nodes.is_empty();
        findings.warnings.add("", "there are no scenes; all nodes are shown", u64::from(scenes_missing));
        let ignored = NodeTree::ignored_poses(&self.data.gltf.document, &posed.pose);
        findings.warnings.add("/nodes", "nodes with a matrix are not animated", ignored as u64);
        let document = pointers::animated(&self.data.gltf.document, &posed.pose, &mut findings.warnings);
        let mut objects = Objects::new(view, MaterialSet::new(&document, &self.data, prefix));
        objects.add_all(&mut findings, control);
        let lights = lights::lights(&view, &document, choice.photometric);
        let efficacy = if choice.photometric { lights::EFFICACY } else { 1.0 };
        let environment = self.image_based.environment(&view, &document, efficacy);
        let environment = findings.faults.take(environment).flatten();
        let Objects { materials, groups, objects, radius, .. } = objects;
        let materials = materials.finish();
        findings.warnings.append(materials.warnings);
        if !findings.faults.is_empty() {
            return Err(findings.faults.into_error(&self.data.gltf.name));
        }
        let mut assets = materials.assets;
        assets.extend(lights.assets);
        let background = environment.map(|(background, file, picture)| {
            assets.insert(file, picture);
            background
        });
        Ok(ModelParts {
            assets,
            textures: materials.textures,
            materials: materials.materials,
            groups: groups.into_iter().filter(|(_, parts)| !parts.is_empty()).collect(),
            cameras: cameras::cameras(&view, &document),
            lights: lights.lights,
            objects,
            depends_on_size: radius.is_some(),
            background,
            warnings: findings.warnings.texts(),
        })
    }
}
