//! A scene as programs use it: read or built, checked, compiled.

use crate::SceneError;
use crate::compile::{self, Assembly, Compiled, Files, Illuminance, Library, Needs, areas, light_files, pictures};
use crate::description::{Description, described};
use crate::document::{Document, Node, Place, Sources, Unreadable, parse_part};
use crate::fingerprint::{Fingerprint, digests, mesh_files};
use crate::import::Content;
use crate::integrator::IntegratorChoice;
use crate::motion::{self, Tracks, read_list};
use crate::path::{Path as ScenePath, Trail};
use crate::relocate::relocate;
use crate::report::{Finding, Problems};
use crate::store::Bundle;
use crate::validate::DeclaredNames;
use crate::{animate, around};
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
    /// All of it at the frame, as numbers: expressions are worked out. It may be changed at will: what a program changes
    /// of an item that moves stands still from then on.
    pub description: Description,
    /// The time that it is at.
    pub(crate) frame: f64,
    /// Where it was read from.
    origin: Option<Arc<Origin>>,
    /// Files that were loaded, for copies of this scene and its other frames.
    pub(crate) library: Library,
    /// What moves while the shutter is open, once somebody has asked.
    tracks: Arc<Mutex<Option<CachedTracks>>>,
}

/// The files of a scene, merged.
#[derive(Debug)]
struct Origin {
    document: Document,
    /// What is allowed and probably not meant.
    warnings: Vec<Finding>,
    names: DeclaredNames,
}

/// The tracks of a scene that was like this.
#[derive(Debug)]
struct CachedTracks {
    scene: Description,
    frame: f64,
    tracks: Arc<Tracks>,
    findings: Vec<Finding>,
}

impl Scene {
    /// An empty scene to build upon.
    pub fn new() -> Self {
        Self::default()
    }

    /// Reads a scene file and what it includes, at frame 0. A mesh file gets a scene around it: floor,
    /// light and a camera that holds all of it.
    pub fn load(path: impl AsRef<Path>) -> Result<Self, SceneError> {
        Self::read(path.as_ref(), Library::default())
    }

    /// Reads a scene from files in memory, as [`Scene::load`] does from those of the disk.
    pub fn from_bundle(bundle: Bundle, name: &str) -> Result<Self, SceneError> {
        Self::read(Path::new(name), Library::new(bundle.into()))
    }

    fn read(path: &Path, library: Library) -> Result<Self, SceneError> {
        match library.store().content(path) {
            Content::Scene => {}
            Content::Mesh { z_up } => {
                let bounds = library.bounds(path).map_err(SceneError::Mesh)?;
                let description = around::describe(&path.to_string_lossy(), &bounds, z_up);
                return Ok(Self { description, library, ..Self::default() });
            }
            Content::Foreign(format) => return Err(SceneError::Foreign { path: path.into(), format }),
        }
        let text = library.store().text(path).map_err(|unreadable| match unreadable {
            Unreadable::Io(source) => SceneError::Read { path: path.into(), source },
            Unreadable::NotText(message) => SceneError::NotText { path: path.into(), message },
        })?;
        Self::parse(text, &path.to_string_lossy(), library)
    }

    /// Reads a scene from a text. `name` is what messages call it; files that the scene names are looked for in
    /// the folder of `name`.
    pub fn from_json(text: impl Into<String>, name: &str) -> Result<Self, SceneError> {
        Self::parse(text.into(), name, Library::default())
    }

    fn parse(text: String, name: &str, library: Library) -> Result<Self, SceneError> {
        let (mut document, mut findings) = Document::read(name, text, library.store())
            .map_err(|(sources, findings)| SceneError::Problems(Problems::new(findings, sources, &|_| None)))?;
        let programs = animate::Programs::default();
        let (resolved, wrong) = animate::resolve_with(&document.tree, &document.sources, &programs, 0.0);
        findings.extend(wrong);
        let found = described(&resolved, &mut findings);
        drop(resolved);
        let whole = found.is_some() && !findings.iter().any(Finding::is_error);
        let (mut description, in_place) = found.unwrap_or_default();
        description.programs = programs;
        motion::attach(&mut description, &document.tree, &in_place);
        for list in std::mem::take(&mut document.lists) {
            findings.extend(read_list(&mut description, &list, &document.sources));
        }
        let whole = whole && !findings.iter().any(Finding::is_error);
        let warnings = findings.iter().filter(|finding| !finding.is_error()).cloned().collect();
        let names = DeclaredNames::of(&description);
        let scene = Self {
            description,
            origin: Some(Arc::new(Origin { document, warnings, names })),
            library,
            ..Self::default()
        };
        if whole {
            return Ok(scene);
        }
        // What could be read is checked too, so that all mistakes come at once.
        let more = Assembly::of(&scene.description, &Tracks::default(), scene.files()).1;
        Err(SceneError::Problems(scene.report(joined(findings, more))))
    }

    /// The same scene at another frame, which may lie between two. What moves is read anew, all else is shared.
    pub fn at_frame(&self, frame: f64) -> Result<Self, SceneError> {
        let edits_merged = self.edits_merged();
        let wanted = edits_merged.time_dependent();
        let mut scene = Self { frame, tracks: Arc::default(), ..self.clone() };
        if wanted.is_empty() {
            scene.description = edits_merged.into_owned();
            return Ok(scene);
        }
        let head = motion::head(&edits_merged);
        let (parts, findings) = motion::read_items(&edits_merged, &head, self.sources(), frame, &wanted);
        scene.description = edits_merged.clone().into_owned();
        match parts {
            Some(parts) => parts.into_iter().for_each(|(path, part)| scene.description.put(&path, part)),
            None => return Err(SceneError::Problems(scene.report(findings))),
        }
        Ok(scene)
    }

    /// The same some frames later, or earlier; as [`Scene::at_frame`].
    pub fn later(&self, frames: f64) -> Result<Self, SceneError> {
        self.at_frame(self.frame + frames)
    }

    /// The scene as it is at its frame, and at all others too.
    #[must_use]
    pub fn still(&self) -> Self {
        let mut scene = self.clone();
        scene.description.stand_still();
        scene
    }

    /// Reads the file again, and of the files that it names those that have changed.
    pub fn reload(&self, path: impl AsRef<Path>) -> Result<Self, SceneError> {
        Self::read(path.as_ref(), self.library.renewed())
    }

    /// All that is wrong with the scene, warnings included, without building the world.
    pub fn check(&self) -> Problems {
        self.check_with_light().0
    }

    /// [`Scene::check`], and the light that brings the most to the middle of the scene.
    pub fn check_with_light(&self) -> (Problems, Option<Illuminance>) {
        let (tracks, wrong) = self.tracks();
        let (assembly, more) = Assembly::of(&self.description, &tracks, self.files());
        (self.report(joined(joined(self.own_findings(), wrong), more)), assembly.illuminance)
    }

    /// Builds the world.
    pub fn compile(&self) -> Result<Compiled, SceneError> {
        let (tracks, wrong) = self.tracks();
        let (assembly, more) = Assembly::of(&self.description, &tracks, self.files());
        let findings = joined(joined(self.own_findings(), wrong), more);
        let broken = findings.iter().any(Finding::is_error);
        let problems = self.report(findings);
        if broken {
            return Err(SceneError::Problems(problems));
        }
        Ok(assembly.compile((*self.description.render).clone(), problems))
    }

    /// Builds the world, with what still serves of an earlier compilation of the scene `before`: all of the world when the same
    /// stands in both, its objects and their hierarchies when materials, lights or the background differ. The result is that
    /// of [`Scene::compile`], bit for bit.
    pub fn compile_after(&self, before: &Self, earlier: &Compiled) -> Result<Compiled, SceneError> {
        let (tracks, wrong) = self.tracks();
        let found = if self.has_world_of(before) {
            let (cameras, course, findings) = compile::look_at(&self.description, &tracks, &earlier.bounds);
            let settings = (*self.description.render).clone();
            let integrator = self.integrator_choice();
            Some((Compiled { cameras, course, settings, integrator, ..earlier.clone() }, findings))
        } else if self.has_objects_of(before) {
            compile::with_shading(&self.description, &tracks, self.files(), earlier)
        } else {
            None
        };
        let Some((compiled, findings)) = found else { return self.compile() };
        let findings = joined(joined(self.own_findings(), wrong), findings);
        let broken = findings.iter().any(Finding::is_error);
        let warnings = self.report(findings);
        if broken { Err(SceneError::Problems(warnings)) } else { Ok(Compiled { warnings, ..compiled }) }
    }

    /// Whether the same objects and area lights stand in both, whatever they are made of. Mesh files are compared by their
    /// contents.
    fn has_objects_of(&self, other: &Self) -> bool {
        let (a, b) = (&self.description, &other.description);
        let (tracks, others) = (self.tracks().0, other.tracks().0);
        let meshes = |scene: &Self| {
            let files = mesh_files(&scene.description, &scene.files()).into_iter();
            files.map(|file| scene.library.digest(&file)).collect::<Vec<_>>()
        };
        (&a.groups, &a.objects) == (&b.groups, &b.objects)
            && (&tracks.objects, &tracks.groups) == (&others.objects, &others.groups)
            && areas::of(&a.lights).eq(areas::of(&b.lights))
            && (areas::of(&a.lights).next().is_none() || tracks.lights == others.lights)
            && meshes(self) == meshes(other)
    }

    /// Whether the same stands in both, however it is looked at. Files are compared by their contents.
    pub fn has_world_of(&self, other: &Self) -> bool {
        let (a, b) = (&self.description, &other.description);
        let same_motion = || {
            let (a, b) = (self.tracks().0, other.tracks().0);
            Arc::ptr_eq(&a, &b) || (&a.objects, &a.groups, &a.lights) == (&b.objects, &b.groups, &b.lights)
        };
        (&a.background, &a.textures, &a.materials) == (&b.background, &b.textures, &b.materials)
            && a.background_light_group == b.background_light_group
            // What a scene without lights is lit by hangs on the integrator.
            && (!a.lights.is_empty() || self.integrator_choice().follows_paths() == other.integrator_choice().follows_paths())
            && (&a.groups, &a.lights, &a.objects) == (&b.groups, &b.lights, &b.objects)
            && digests(a, &self.files()) == digests(b, &other.files())
            && same_motion()
    }

    /// What moves while the shutter is open, and what is wrong with it.
    fn tracks(&self) -> (Arc<Tracks>, Vec<Finding>) {
        let mut known = self.tracks.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = known.as_ref().filter(|k| k.frame == self.frame && k.scene.moves_as(&self.description)) {
            return (Arc::clone(&known.tracks), known.findings.clone());
        }
        let edits_merged = self.edits_merged();
        let (tracks, findings) = Tracks::of(&edits_merged, self.sources(), self.frame);
        let tracks = Arc::new(tracks);
        let (scene, frame) = (self.description.clone(), self.frame);
        *known = Some(CachedTracks { scene, frame, tracks: Arc::clone(&tracks), findings: findings.clone() });
        (tracks, findings)
    }

    /// The files that it was read from, and those of its meshes, pictures and lights.
    pub fn paths(&self) -> Vec<PathBuf> {
        let texts = self.origin.iter().flat_map(|origin| origin.document.sources.names());
        let (scene, files) = (&self.description, self.files());
        let pictures = pictures(scene, &files).into_iter().map(|(file, _)| file);
        let lights = light_files(scene, &files).into_iter().map(|(file, _)| file);
        let files: BTreeSet<PathBuf> = mesh_files(scene, &files).into_iter().chain(pictures).chain(lights).collect();
        texts.map(PathBuf::from).chain(files).collect()
    }

    /// The integrator that the scene is rendered with, and why: the one that it names, or the one that fits what it
    /// holds.
    pub fn integrator_choice(&self) -> IntegratorChoice {
        IntegratorChoice::of(&self.description)
    }

    /// What building the world will need memory for; no file is read for it.
    pub fn needs(&self) -> Needs {
        Needs::of(&self.description, self.files())
    }

    /// What moves in the scene, for people to read.
    pub fn survey(&self) -> animate::Survey {
        animate::survey(&self.to_value().into(), self.sources(), &self.description.programs)
    }

    /// Whether anything in the scene may change from frame to frame.
    pub fn depends_on_time(&self) -> bool {
        !self.edits_merged().time_dependent().is_empty()
    }

    /// Everything that decides the pixels, however many samples are taken.
    pub fn fingerprint(&self) -> Fingerprint {
        Fingerprint::of(&self.description, &self.tracks().0, &self.files())
    }

    /// The scene as a file, with everything that moves.
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(&self.to_value()).unwrap_or_default()
    }

    /// The same for a file in `folder`, from where the files that the scene names have other names.
    pub fn to_json_in(&self, folder: &Path) -> String {
        let mut json = self.to_value();
        relocate(&mut json, &self.files(), folder);
        serde_json::to_string_pretty(&json).unwrap_or_default()
    }

    /// The same as a tree.
    pub fn to_value(&self) -> Value {
        motion::written(&self.edits_merged())
    }

    /// What does not fit the schema. What was read from a file was checked when it was read, and only warnings are left of
    /// that; what programs have made or changed is checked here.
    fn own_findings(&self) -> Vec<Finding> {
        let mut findings = self.description.head_findings();
        let names_are_missing = self.origin.as_ref().is_some_and(|origin| !origin.names.are_in(&self.description));
        findings.extend(self.description.item_findings(|item| names_are_missing || item.is_changed()));
        let warnings = self.origin.iter().flat_map(|origin| &origin.warnings);
        let holds = |warning: &&Finding| {
            let item = warning.path().and_then(|path| self.description.item_of(path));
            item.is_none_or(|(item, _)| !item.is_changed())
        };
        findings.extend(warnings.filter(holds).cloned());
        findings
    }

    /// The description with templates that hold all that programs have changed.
    pub(crate) fn edits_merged(&self) -> Cow<'_, Description> {
        motion::edits_merged(&self.description, self.sources(), self.frame)
    }

    pub(crate) fn sources(&self) -> &Sources {
        static NONE: LazyLock<Sources> = LazyLock::new(Sources::default);
        self.origin.as_ref().map_or(&*NONE, |origin| &origin.document.sources)
    }

    fn files(&self) -> Files<'_> {
        Files { scene: &self.description, sources: self.sources(), library: &self.library }
    }

    pub(crate) fn report(&self, findings: Vec<Finding>) -> Problems {
        let Some(origin) = self.origin.as_ref().filter(|_| !findings.is_empty()) else {
            return Problems::new(findings, self.sources().clone(), &|_| None);
        };
        let Document { tree, sources, .. } = &origin.document;
        let (resolved, _) = animate::resolve(tree, sources, self.frame);
        Problems::new(findings, sources.clone(), &|path| Some(self.place_of(path, &resolved)))
    }

    /// Where the value at a path was written, or the last value on the way to it that was, and how many steps lead there.
    fn place_of(&self, path: &ScenePath, tree: &Node) -> (Option<Place>, usize) {
        let written = tree.place_of(path);
        let Some((item, depth)) = self.description.item_of(path) else { return written };
        let own = ScenePath::from_steps(path.steps().iter().take(depth));
        let is_there = tree.place_of(&own).0 == item.place();
        match item.place().filter(|_| !item.is_changed()) {
            Some(_) if is_there => written,
            // The item is not in the tree, or stands elsewhere by now.
            Some(place) => self.place_within(place, path, depth).unwrap_or((Some(place), depth)),
            None => (item.place(), depth),
        }
    }

    /// The same inside of an item that was written at `place`, to which the first `depth` steps lead.
    fn place_within(&self, place: Place, path: &ScenePath, depth: usize) -> Option<(Option<Place>, usize)> {
        let text = &self.sources().get(place.file)?.text;
        let (node, _) = parse_part(text, place.start as usize..place.end as usize, place.file, &Trail::Root).ok()?;
        let inner = ScenePath::from_steps(path.steps().iter().skip(depth));
        let (found, steps) = node.place_of(&inner);
        Some((found, depth + steps))
    }
}

/// Findings of an early step with those of a later one. What the early step found wrong, the later one need not
/// find wrong again.
fn joined(mut early: Vec<Finding>, later: Vec<Finding>) -> Vec<Finding> {
    let fresh = |finding: &Finding| !early.iter().any(|known| known.is_error() && known.covers(finding));
    let mut later: Vec<Finding> = later.into_iter().filter(fresh).collect();
    early.append(&mut later);
    early
}
