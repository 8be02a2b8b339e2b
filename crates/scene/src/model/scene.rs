//! Models of a scene: expansion on first use, and scenes around model files.

use super::{
    Expansion, ModelChoice, ModelNeeds, ModelSummary, NameOrIndex, OpenedModel, SceneTime, describe_model_scene,
};
use super::{expand, expand_heads, has_instance_files, has_models};
use crate::animate::posed_files;
use crate::asset::Assets;
use crate::compile::{AssetCache, Files, NEVER_CANCELLED};
use crate::description::{Description, Model, Object};
use crate::item::Item;
use crate::motion::Tracks;
use crate::path::{Path as ScenePath, PathRef};
use crate::{Scene, SceneError};
use juggler_math::BuildControl;
use std::collections::BTreeSet;
use std::ops::Add;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// Expansions of a scene with the inputs that they were computed from.
#[derive(Clone, Debug, Default)]
pub struct ExpansionMemo {
    whole: Memo,
    /// With only the heads of files of instances.
    heads: Memo,
}

type Memo = Arc<Mutex<Option<KnownExpansion>>>;

/// A computed expansion.
#[derive(Debug)]
struct KnownExpansion {
    scene: Description,
    frame: f64,
    assets: Assets,
    expansion: Arc<Expansion>,
}

/// A model of a scene.
#[derive(Clone, Debug)]
pub struct SceneModel {
    /// Path of the model in the scene.
    pub path: ScenePath,
    /// The model as the scene describes it.
    pub model: Model,
    /// Description of its file.
    pub summary: ModelSummary,
}

impl Scene {
    /// The scene with its models and files of instances expanded; `None` without any.
    pub(crate) fn expanded(&self) -> Option<Arc<Expansion>> {
        self.expanded_with_control(&NEVER_CANCELLED)
    }

    /// [`Scene::expanded`]; incomplete, and not kept, if `control` is cancelled.
    pub(crate) fn expanded_with_control(&self, control: &BuildControl) -> Option<Arc<Expansion>> {
        if !(has_models(&self.description) || has_instance_files(&self.description)) {
            return None;
        }
        Some(self.memoized(&self.expansion.whole, expand, control))
    }

    /// The scene with its models expanded and, of its files of instances, how many instances their heads
    /// declare; `None` without models and files of instances.
    pub(crate) fn expanded_heads(&self) -> Option<Arc<Expansion>> {
        if !has_instance_files(&self.description) {
            return self.expanded();
        }
        Some(self.memoized(&self.expansion.heads, expand_heads, &NEVER_CANCELLED))
    }

    fn memoized(
        &self,
        memo: &Memo,
        expand: fn(Files<'_>, &Tracks, SceneTime) -> Expansion,
        control: &BuildControl,
    ) -> Arc<Expansion> {
        let memo = || memo.lock().unwrap_or_else(PoisonError::into_inner);
        let assets = &self.asset_cache.store().assets;
        let is_current =
            |k: &&KnownExpansion| k.frame == self.frame && k.assets == *assets && k.scene == self.description;
        if let Some(known) = memo().as_ref().filter(is_current) {
            return Arc::clone(&known.expansion);
        }
        // Two expansions of a large model would need twice the memory.
        *memo() = None;
        // The lock is not held meanwhile: a thread that waits for parallel work may start other
        // work that needs it.
        let (tracks, _) = self.tracks_with_control(control);
        let frames_per_second = self.description.animation.frames_per_second;
        let time = SceneTime { frame: self.frame, shutter: self.description.render.shutter, frames_per_second };
        let expansion = Arc::new(expand(Files { control, ..self.files() }, &tracks, time));
        if control.is_cancelled() {
            return expansion;
        }
        *memo() = Some(KnownExpansion {
            scene: self.description.clone(),
            frame: self.frame,
            assets: assets.clone(),
            expansion: Arc::clone(&expansion),
        });
        expansion
    }

    /// Files of the expanded scene.
    pub(crate) fn files_of<'s>(&'s self, expansion: &'s Expansion) -> Files<'s> {
        let (sources, asset_cache) = (self.sources(), &expansion.asset_cache);
        Files { scene: &expansion.description, sources, asset_cache, control: &NEVER_CANCELLED }
    }

    /// Creates the scene that shows a model file.
    pub(crate) fn around_model(
        path: &Path,
        asset_cache: AssetCache,
        control: &BuildControl,
    ) -> Result<Self, SceneError> {
        let opened = asset_cache.model_with_control(path, control);
        control.check()?;
        let model = opened.file.as_ref().map_err(|faults| SceneError::Model { faults: faults.clone() })?;
        let description = describe_model_scene(&path.to_string_lossy(), &**model);
        Ok(Self::around(description, asset_cache))
    }

    /// Whether the scene contains models.
    pub fn has_models(&self) -> bool {
        has_models(&self.description)
    }

    /// Whether the scene shows one model file that was given in place of a scene.
    pub fn is_around_model(&self) -> bool {
        self.sources().names().next().is_none()
            && matches!(self.description.objects.as_slice(), [object] if object.model.is_some())
    }

    /// Whether the scene shows one model or mesh file that was given in place of a scene.
    pub fn is_around_file(&self) -> bool {
        let is_mesh_file = |object: &Item<Object>| object.mesh().is_some_and(|mesh| mesh.file.is_some());
        let is_generated = self.sources().names().next().is_none();
        self.is_around_model() || is_generated && self.description.objects.first().is_some_and(is_mesh_file)
    }

    /// Selects what the model of a scene around a model file shows; `None` keeps a choice of the
    /// file. Returns `false`, without an effect, for other scenes.
    pub fn choose_model(
        &mut self,
        variant: Option<NameOrIndex>,
        animation: Option<NameOrIndex>,
        scene: Option<NameOrIndex>,
    ) -> bool {
        let is_single = self.is_around_model();
        let object = self.description.objects.first_mut().filter(|_| is_single);
        let Some(model) = object.and_then(|object| object.model.as_mut()) else { return false };
        model.variant = variant.or(model.variant.take());
        model.animation = animation.or(model.animation.take());
        model.scene = scene.or(model.scene.take());
        self.fit_animation();
        self.fit_background();
        true
    }

    /// Sets the background of a scene around a model file to that of the chosen scene of the file.
    pub fn fit_background(&mut self) {
        if self.is_around_model() {
            let summary = self.model_summaries().into_iter().next().map(|found| found.summary);
            self.description.background = summary.as_ref().and_then(super::model_light::background).map(Item::from);
        }
    }

    /// Sets the length of the animation to that of the chosen clip of the scene's first model.
    pub fn fit_animation(&mut self) {
        let summary = self.model_summaries().into_iter().next().map(|found| found.summary);
        let seconds = summary.and_then(|summary| summary.clips.get(summary.clip?).map(|clip| clip.seconds));
        self.description.animation.frames = super::frames_of(seconds.unwrap_or(0.0));
    }

    /// Names of the model files of the scene and of the files that these name.
    pub(crate) fn model_paths(&self) -> Vec<PathBuf> {
        let models = self.models();
        let opened = models.iter().map(|(path, model)| self.opened(path, model));
        let followed = self.followed_models().into_iter().map(|path| self.asset_cache.model(&path));
        opened.chain(followed).flat_map(|opened| opened.paths().cloned().collect::<Vec<_>>()).collect()
    }

    /// Locations of the model files whose nodes values follow (`posed`).
    fn followed_models(&self) -> BTreeSet<PathBuf> {
        let (scene, sources) = (&self.description, self.scene_sources());
        let templates = scene.templates(|_| true);
        let sections = [&scene.variables, &scene.paths].map(|section| section.node());
        let mut found = Vec::new();
        for node in templates.iter().map(|source| &source.template.node).chain(sections.into_iter().flatten()) {
            posed_files(node, &mut found);
        }
        found.into_iter().map(|(file, node)| sources.locate(file, node.place)).collect()
    }

    /// Whether a model of the scene has an animation that shows.
    pub(crate) fn has_moving_models(&self) -> bool {
        self.models().iter().any(|(path, model)| {
            let opened = self.opened(path, model);
            model.at.is_none() && opened.file.as_ref().is_ok_and(|file| file.moves(&model.choice(0.0)))
        })
    }

    /// Whether both scenes have the same model files with the same contents.
    pub(crate) fn has_models_of(&self, other: &Self) -> bool {
        let identities = |scene: &Self| scene.expanded().map(|expansion| expansion.identities.clone());
        identities(self) == identities(other)
    }

    /// Models of the scene, each with a description of its file.
    pub fn model_summaries(&self) -> Vec<SceneModel> {
        // Copies of a model have one description.
        let mut known: Vec<(Arc<OpenedModel>, ModelChoice, ModelSummary)> = Vec::new();
        let summary = |(path, model): (ScenePath, Model)| {
            let (opened, choice) = (self.opened(&path, &model), model.choice(0.0));
            let is_same =
                |(other, chosen): (&Arc<OpenedModel>, &ModelChoice)| Arc::ptr_eq(other, &opened) && *chosen == choice;
            let found = known.iter().find(|(other, chosen, _)| is_same((other, chosen)));
            if let Some((.., summary)) = found {
                return Some(SceneModel { path, model, summary: summary.clone() });
            }
            let summary = opened.file.as_ref().ok()?.summary(&choice).ok()?;
            known.push((opened, choice, summary.clone()));
            Some(SceneModel { path, model, summary })
        };
        self.models().into_iter().filter_map(summary).collect()
    }

    /// Memory that the distinct model files of the scene need, before they are opened.
    pub fn model_needs(&self) -> ModelNeeds {
        let models = self.models();
        let file = |(path, model): &(ScenePath, Model)| self.files().locate(&path.key("file"), &model.file);
        let files: BTreeSet<PathBuf> =
            models.iter().map(|model| self.asset_cache.store().canonical_name(&file(model))).collect();
        files.iter().map(|file| self.asset_cache.model_needs(file)).fold(ModelNeeds::default(), ModelNeeds::add)
    }

    /// The scene's description with its models expanded to objects, materials, textures and lights, and
    /// its files of instances to arrays.
    pub fn expanded_description(&self) -> Description {
        self.expanded().map_or_else(|| self.description.clone(), |expansion| expansion.description.clone())
    }

    fn opened(&self, path: &ScenePath, model: &Model) -> Arc<OpenedModel> {
        self.asset_cache.model(&self.files().locate(&path.key("file"), &model.file))
    }

    /// Models of the scene with their paths.
    fn models(&self) -> Vec<(ScenePath, Model)> {
        let mut found = Vec::new();
        let groups = PathRef::Root.key("groups");
        for (name, objects) in self.description.groups.iter() {
            collect(objects, &groups.key(name), &mut found);
        }
        collect(&self.description.objects, &PathRef::Root.key("objects"), &mut found);
        found
    }
}

fn collect(objects: &[Item<Object>], path: &PathRef<'_>, found: &mut Vec<(ScenePath, Model)>) {
    for (i, object) in objects.iter().enumerate() {
        let path = path.index(i);
        if let Some(model) = &object.model {
            found.push((ScenePath::from(&path.key("model")), (**model).clone()));
        }
        collect(object.inner(), &path.key("objects"), found);
    }
}
