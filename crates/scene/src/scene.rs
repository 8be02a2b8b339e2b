//! Scenes: reading, building, checking and compiling.

use crate::SceneError;
use crate::animate::SceneSources;
use crate::compile::{Assembly, AssetCache, Files, NEVER_CANCELLED, Needs, image_files, light_files};
use crate::description::{Description, deserialize_scene};
use crate::document::{Document, Node, SourceSpan, Sources, Unreadable, parse_part};
use crate::fingerprint::{Fingerprint, mesh_files};
use crate::integrator::IntegratorChoice;
use crate::model::ExpansionMemo;
use crate::motion::{self, Tracks, read_list};
use crate::path::{Path as ScenePath, PathRef};
use crate::relocate::relocate;
use crate::report::{Finding, Problems};
use crate::store::Bundle;
use crate::validate::DeclaredNames;
use crate::{animate, mesh_scene};
use juggler_math::{BuildControl, BuildStage};
use juggler_mesh::FileContent;
use serde_json::Value;
use std::borrow::Cow;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::{Arc, LazyLock, Mutex, PoisonError};

/// A scene at one frame.
///
/// ```
/// use juggler_scene::{Object, Scene};
/// use juggler_shape::Sphere;
///
/// let scene = Scene::new().add(Object::new(Sphere::default()).at(0.0, 1.0, 0.0));
/// let compiled = scene.compile()?;
/// assert_eq!(compiled.cameras.len(), 1);
/// # Ok::<(), juggler_scene::SceneError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// Description at the frame, with expressions evaluated to numbers. Programs may change it
    /// freely; a changed property of a moving item no longer moves.
    pub description: Description,
    /// Frame number; fractions lie between frames.
    pub(crate) frame: f64,
    /// Files that the scene was read from.
    origin: Option<Arc<Origin>>,
    /// Loaded files, shared by copies of this scene and its other frames.
    pub(crate) asset_cache: AssetCache,
    /// Motion while the shutter is open, computed on first use.
    tracks: Arc<Mutex<Option<CachedTracks>>>,
    /// The scene with its models and files of instances expanded, computed on first use.
    pub(crate) expansion: ExpansionMemo,
}

/// The merged files of a scene.
#[derive(Debug)]
struct Origin {
    document: Document,
    /// Warnings about content that is allowed but probably not intended.
    warnings: Vec<Finding>,
    names: DeclaredNames,
}

/// Tracks of a scene with the inputs that they were computed from.
#[derive(Debug)]
struct CachedTracks {
    scene: Description,
    frame: f64,
    tracks: Arc<Tracks>,
    findings: Vec<Finding>,
}

impl Scene {
    /// Creates an empty scene.
    pub fn new() -> Self {
        Self::default()
    }

    /// Reads a scene file and the files it includes, at frame 0. For a mesh file, creates a scene
    /// with a floor, lights and a camera that frames the mesh.
    pub fn load(path: impl AsRef<Path>) -> Result<Self, SceneError> {
        Self::read(path.as_ref(), AssetCache::default(), &NEVER_CANCELLED)
    }

    /// Reads a scene from files in memory, as [`Scene::load`] does from disk.
    pub fn from_bundle(bundle: Bundle, name: &str) -> Result<Self, SceneError> {
        Self::read(Path::new(name), AssetCache::new(bundle.into()), &NEVER_CANCELLED)
    }

    /// Reads a file as [`Scene::load`] does, unless `control` is cancelled.
    pub(crate) fn read(path: &Path, asset_cache: AssetCache, control: &BuildControl) -> Result<Self, SceneError> {
        control.begin(BuildStage::Reading);
        control.check()?;
        if asset_cache.is_model(path) && !asset_cache.is_plain_mesh(path) {
            return Self::around_model(path, asset_cache, control);
        }
        match asset_cache.store().content(path) {
            FileContent::Other => {}
            FileContent::Mesh { z_up } => {
                let overview = asset_cache.mesh_overview(path, control);
                control.check()?;
                let overview = overview.map_err(SceneError::Mesh)?;
                let description = mesh_scene::describe_mesh_scene(&path.to_string_lossy(), &overview, z_up);
                return Ok(Self::around(description, asset_cache));
            }
            FileContent::Unsupported(format) => return Err(SceneError::Foreign { path: path.into(), format }),
        }
        let text = asset_cache.store().text(path).map_err(|unreadable| match unreadable {
            Unreadable::Io(source) => SceneError::Read { path: path.into(), source },
            Unreadable::NotText(message) => SceneError::NotText { path: path.into(), message },
        })?;
        Self::parse(text, &path.to_string_lossy(), asset_cache, control)
    }

    /// A generated scene.
    pub(crate) fn around(description: Description, asset_cache: AssetCache) -> Self {
        Self { description, asset_cache, ..Self::default() }
    }

    /// Parses a scene. `name` is the text's name in messages; file names in the scene are relative
    /// to the folder of `name`.
    pub fn from_json(text: impl Into<String>, name: &str) -> Result<Self, SceneError> {
        Self::parse(text.into(), name, AssetCache::default(), &NEVER_CANCELLED)
    }

    /// Parses a text as [`Scene::from_json`] does, unless `control` is cancelled.
    pub(crate) fn parse(
        text: String,
        name: &str,
        asset_cache: AssetCache,
        control: &BuildControl,
    ) -> Result<Self, SceneError> {
        control.begin(BuildStage::Reading);
        let (mut document, mut findings) = Document::read(name, text, asset_cache.store())
            .map_err(|(sources, findings)| SceneError::Problems(Problems::new(findings, sources, &|_| None)))?;
        control.check()?;
        let programs = animate::Programs::default();
        let sources = SceneSources { texts: &document.sources, asset_cache: &asset_cache };
        let (resolved, wrong) = animate::resolve_with(&document.tree, sources, &programs, 0.0);
        findings.extend(wrong);
        control.check()?;
        let found = deserialize_scene(&resolved, &mut findings);
        drop(resolved);
        let is_valid = found.is_some() && !findings.iter().any(Finding::is_error);
        let (mut description, inline_names) = found.unwrap_or_default();
        description.programs = programs;
        motion::attach(&mut description, &document.tree, &inline_names);
        for list in std::mem::take(&mut document.lists) {
            findings.extend(read_list(&mut description, &list, sources, control));
        }
        control.check()?;
        let is_valid = is_valid && !findings.iter().any(Finding::is_error);
        let warnings = findings.iter().filter(|finding| !finding.is_error()).cloned().collect();
        let names = DeclaredNames::of(&description);
        let scene = Self {
            description,
            origin: Some(Arc::new(Origin { document, warnings, names })),
            asset_cache,
            ..Self::default()
        };
        if is_valid {
            return Ok(scene);
        }
        // Compile the valid parts too, to report all errors at once.
        let files = Files { control, ..scene.files() };
        let more = Assembly::from_scene(&scene.description, &Tracks::default(), files).1;
        control.check()?;
        Err(SceneError::Problems(scene.report(merge_findings(findings, more))))
    }

    /// Returns the scene at another frame; fractions lie between frames. Only moving items are
    /// evaluated again, all else is shared.
    pub fn at_frame(&self, frame: f64) -> Result<Self, SceneError> {
        let edits_merged = self.edits_merged();
        let moving = edits_merged.time_dependent();
        let mut scene = Self { frame, tracks: Arc::default(), expansion: ExpansionMemo::default(), ..self.clone() };
        if moving.is_empty() {
            scene.description = edits_merged.into_owned();
            return Ok(scene);
        }
        let head = motion::head(&edits_merged);
        let (parts, findings) = motion::read_items(&edits_merged, &head, self.scene_sources(), frame, &moving);
        scene.description = edits_merged.clone().into_owned();
        match parts {
            Some(parts) => parts.into_iter().for_each(|(path, part)| scene.description.put(&path, part)),
            None => return Err(SceneError::Problems(scene.report(findings))),
        }
        Ok(scene)
    }

    /// Returns the scene a number of frames later, or earlier if negative; see [`Scene::at_frame`].
    pub fn later(&self, frames: f64) -> Result<Self, SceneError> {
        self.at_frame(self.frame + frames)
    }

    /// Freezes the scene at its current frame.
    #[must_use]
    pub fn still(&self) -> Self {
        let mut scene = self.clone();
        scene.description.make_static();
        scene
    }

    /// Reads the scene file again, and those of its other files that have changed.
    pub fn reload(&self, path: impl AsRef<Path>) -> Result<Self, SceneError> {
        self.reload_with_control(path, &NEVER_CANCELLED)
    }

    /// [`Scene::reload`], which ends early if `control` is cancelled, and reports its progress to it.
    pub fn reload_with_control(&self, path: impl AsRef<Path>, control: &BuildControl) -> Result<Self, SceneError> {
        Self::read(path.as_ref(), self.asset_cache.without_changed_files(), control)
    }

    /// Motion while the shutter is open, with the findings about it.
    pub(crate) fn tracks(&self) -> (Arc<Tracks>, Vec<Finding>) {
        self.tracks_with_control(&NEVER_CANCELLED)
    }

    /// [`Scene::tracks`]; empty if `control` is cancelled.
    pub(crate) fn tracks_with_control(&self, control: &BuildControl) -> (Arc<Tracks>, Vec<Finding>) {
        let mut known = self.tracks.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) =
            known.as_ref().filter(|k| k.frame == self.frame && k.scene.has_same_motion(&self.description))
        {
            return (Arc::clone(&known.tracks), known.findings.clone());
        }
        let edits_merged = self.edits_merged();
        let (tracks, findings) = Tracks::sample(&edits_merged, self.scene_sources(), self.frame, control);
        let tracks = Arc::new(tracks);
        if control.is_cancelled() {
            return (tracks, findings);
        }
        let (scene, frame) = (self.description.clone(), self.frame);
        *known = Some(CachedTracks { scene, frame, tracks: Arc::clone(&tracks), findings: findings.clone() });
        (tracks, findings)
    }

    /// Whether the scene was read from files in memory ([`Scene::from_bundle`]), so that its names
    /// of files mean nothing on disk.
    pub fn is_in_memory(&self) -> bool {
        self.asset_cache.store().is_in_memory()
    }

    /// Names of the scene's files: those it was read from, meshes, images, photometric files, and files of
    /// instances.
    pub fn paths(&self) -> Vec<PathBuf> {
        let texts = self.origin.iter().flat_map(|origin| origin.document.sources.names());
        let (scene, files) = (&self.description, self.files());
        let images = image_files(scene, &files).into_iter().map(|(file, _)| file);
        let lights = light_files(scene, &files).into_iter().map(|(file, _)| file);
        let instances = files.instance_files();
        let meshes = mesh_files(scene, &files).into_iter();
        let files: BTreeSet<PathBuf> = meshes.chain(images).chain(lights).chain(instances).collect();
        texts.map(PathBuf::from).chain(files).chain(self.model_paths()).collect()
    }

    /// The scene's integrator with the reason for it: the integrator that the scene names, or the
    /// one that supports its contents.
    pub fn integrator_choice(&self) -> IntegratorChoice {
        match self.expanded_heads() {
            None => IntegratorChoice::for_scene(&self.description),
            Some(expansion) => IntegratorChoice::for_scene(&expansion.description),
        }
    }

    /// Estimates what building the world needs memory for, without reading files.
    pub fn needs(&self) -> Needs {
        match self.expanded_heads() {
            None => Needs::from_scene(&self.description, &Tracks::default(), self.files()),
            Some(expansion) => {
                let files = self.files_of(&expansion);
                let needs = Needs::from_scene(&expansion.description, &expansion.tracks, files);
                Needs { models: expansion.model_bytes, ..needs }
            }
        }
    }

    /// Lists what moves in the scene, for display.
    pub fn survey(&self) -> animate::Survey {
        animate::survey(&self.to_value().into(), self.scene_sources(), &self.description.programs)
    }

    /// Whether anything in the scene may differ between frames.
    pub fn depends_on_time(&self) -> bool {
        !self.edits_merged().time_dependent().is_empty() || self.has_moving_models()
    }

    /// Fingerprint of everything that affects the pixels, except the number of samples.
    pub fn fingerprint(&self) -> Fingerprint {
        let models = self.expanded().map(|expansion| expansion.identities.clone()).unwrap_or_default();
        let integrator = self.integrator_choice().integrator;
        Fingerprint::compute(&self.description, integrator, &self.tracks().0, &self.files(), &models)
    }

    /// The scene as the text of a scene file, including its animation.
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(&self.to_value()).unwrap_or_default()
    }

    /// The scene as the text of a scene file in `folder`: relative file names are rewritten to lead
    /// to the same files from there.
    pub fn to_json_in(&self, folder: &Path) -> String {
        let mut json = self.to_value();
        relocate(&mut json, &self.files(), folder);
        serde_json::to_string_pretty(&json).unwrap_or_default()
    }

    /// The scene as JSON, including its animation.
    pub fn to_value(&self) -> Value {
        motion::written(&self.edits_merged())
    }

    /// Checks the description against the schema. Items read from a file were checked then, so only
    /// their warnings are repeated; items that programs added or changed are checked here.
    pub(crate) fn schema_findings(&self) -> Vec<Finding> {
        let mut findings = self.description.head_findings();
        let names_are_missing = self.origin.as_ref().is_some_and(|origin| !origin.names.are_in(&self.description));
        findings.extend(self.description.item_findings(|item| names_are_missing || item.is_changed()));
        let warnings = self.origin.iter().flat_map(|origin| &origin.warnings);
        let holds = |warning: &&Finding| {
            let item = warning.path().and_then(|path| self.description.innermost_item(path));
            item.is_none_or(|(item, _)| !item.is_changed())
        };
        findings.extend(warnings.filter(holds).cloned());
        findings
    }

    /// The description with the changes of programs merged into the templates of moving items.
    pub(crate) fn edits_merged(&self) -> Cow<'_, Description> {
        motion::edits_merged(&self.description, self.scene_sources(), self.frame)
    }

    pub(crate) fn sources(&self) -> &Sources {
        static NONE: LazyLock<Sources> = LazyLock::new(Sources::default);
        self.origin.as_ref().map_or(&*NONE, |origin| &origin.document.sources)
    }

    pub(crate) fn scene_sources(&self) -> SceneSources<'_> {
        SceneSources { texts: self.sources(), asset_cache: &self.asset_cache }
    }

    pub(crate) fn files(&self) -> Files<'_> {
        let (sources, asset_cache) = (self.sources(), &self.asset_cache);
        Files { scene: &self.description, sources, asset_cache, control: &NEVER_CANCELLED }
    }

    pub(crate) fn report(&self, findings: Vec<Finding>) -> Problems {
        let Some(origin) = self.origin.as_ref().filter(|_| !findings.is_empty()) else {
            return Problems::new(findings, self.sources().clone(), &|_| None);
        };
        let Document { tree, sources, .. } = &origin.document;
        let (resolved, _) = animate::resolve_with(tree, self.scene_sources(), &self.description.programs, self.frame);
        Problems::new(findings, sources.clone(), &|path| Some(self.place_of(path, &resolved)))
    }

    /// Finds the place of the value at a path. Returns its place, or that of its innermost existing
    /// ancestor, and the number of steps that lead there.
    fn place_of(&self, path: &ScenePath, tree: &Node) -> (Option<SourceSpan>, usize) {
        let written = tree.place_of(path);
        let Some((item, depth)) = self.description.innermost_item(path) else { return written };
        let own = ScenePath::from_steps(path.steps().iter().take(depth));
        let is_there = tree.place_of(&own).0 == item.place();
        match item.place().filter(|_| !item.is_changed()) {
            Some(_) if is_there => written,
            // The item is not in the tree, or is at another place by now.
            Some(place) => self.place_within(place, path, depth).unwrap_or((Some(place), depth)),
            None => (item.place(), depth),
        }
    }

    /// Finds the place of a value inside an item that was read from `place` and whose path has
    /// `depth` steps.
    fn place_within(&self, place: SourceSpan, path: &ScenePath, depth: usize) -> Option<(Option<SourceSpan>, usize)> {
        let text = &self.sources().get(place.file)?.text;
        let (node, _) = parse_part(text, place.start as usize..place.end as usize, place.file, &PathRef::Root).ok()?;
        let inner = ScenePath::from_steps(path.steps().iter().skip(depth));
        let (found, steps) = node.place_of(&inner);
        Some((found, depth + steps))
    }
}

/// Concatenates the findings of two steps, without later findings about values that an early error
/// covers.
pub(crate) fn merge_findings(mut early: Vec<Finding>, later: Vec<Finding>) -> Vec<Finding> {
    let fresh = |finding: &Finding| !early.iter().any(|known| known.is_error() && known.concerns_same_value(finding));
    let mut later: Vec<Finding> = later.into_iter().filter(fresh).collect();
    early.append(&mut later);
    early
}
