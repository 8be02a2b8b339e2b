//! A scene as programs use it: read or built, checked, compiled.

use crate::SceneError;
use crate::compile::{self, Assembly, Compiled, Files, Illuminance, Library, Needs, light_files, pictures};
use crate::description::{Animation, Description};
use crate::document::{Document, Node, Sources, Unreadable, put};
use crate::fingerprint::{Fingerprint, digests, mesh_files};
use crate::import::Content;
use crate::integrator::IntegratorChoice;
use crate::moments::Moments;
use crate::path::Path as ScenePath;
use crate::relocate::relocate;
use crate::report::{Finding, Problems};
use crate::store::{Bundle, Store};
use crate::validate::validate;
use crate::{animate, around, schema};
use serde::Deserialize;
use serde_json::{Map, Value};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A scene at one frame.
///
/// ```
/// use juggler_scene::{Object, Scene};
/// use juggler_tracer::shape::Sphere;
///
/// let scene = Scene::new().add(Object::new(Sphere::default()).at(0.0, 1.0, 0.0));
/// let compiled = scene.compile()?;
/// assert_eq!(compiled.cameras.len(), 1);
/// # Ok::<(), juggler_scene::SceneError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// All of it, as numbers: expressions are resolved.
    pub description: Description,
    /// Where it was read from.
    origin: Option<Arc<Origin>>,
    /// Files that were loaded, for copies of this scene and its other frames.
    library: Library,
}

/// A scene's files, and its tree at the frame.
#[derive(Debug)]
struct Origin {
    document: Arc<Document>,
    frame: f64,
    resolved: Node,
    moments: Moments,
    /// What is allowed and probably not meant.
    warnings: Vec<Finding>,
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
        Self::read(Path::new(name), Library::new(Store::Memory(bundle)))
    }

    fn read(path: &Path, library: Library) -> Result<Self, SceneError> {
        match library.store().content(path) {
            Content::Scene => {}
            Content::Mesh { z_up } => {
                let bounds = library.bounds(path).map_err(SceneError::Mesh)?;
                let description = around::describe(&path.to_string_lossy(), &bounds, z_up);
                return Ok(Self { description, origin: None, library });
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
        let (document, findings) = Document::read(name, text, library.store())
            .map_err(|(sources, findings)| SceneError::Problems(Problems::new(findings, sources, None)))?;
        Self::resolve(Arc::new(document), findings, 0.0, library)
    }

    /// The same scene at another frame, which may lie between two. A scene that was not read from a file has no
    /// expressions and stays as it is; changes made since a scene was read are lost.
    pub fn at_frame(&self, frame: f64) -> Result<Self, SceneError> {
        match &self.origin {
            Some(origin) => Self::resolve(Arc::clone(&origin.document), Vec::new(), frame, self.library.clone()),
            None => Ok(self.clone()),
        }
    }

    /// The same some frames later, or earlier; as [`Scene::at_frame`].
    pub fn later(&self, frames: f64) -> Result<Self, SceneError> {
        let frame = self.origin.as_ref().map_or(0.0, |origin| origin.frame);
        self.at_frame(frame + frames)
    }

    /// Reads the file again, and of the files that it names those that have changed.
    pub fn reload(&self, path: impl AsRef<Path>) -> Result<Self, SceneError> {
        Self::read(path.as_ref(), self.library.renewed())
    }

    /// The same scene with another value at a place, which is a JSON pointer such as `/materials/red/phong/diffuse`;
    /// `null` takes away what is there. The value may be an expression. Objects on the way are made where there are
    /// none. Changes made since a scene was read from a file are lost.
    pub fn with_value(&self, pointer: &str, value: Value) -> Result<Self, SceneError> {
        let (mut document, frame) = match &self.origin {
            Some(origin) => ((*origin.document).clone(), origin.frame),
            None => {
                let tree = serde_json::to_value(&self.description).unwrap_or_default().into();
                (Document { sources: Sources::default(), tree }, 0.0)
            }
        };
        if let Err(finding) = put(&mut document.tree, pointer, value) {
            return Err(SceneError::Problems(Problems::new(vec![finding], document.sources, None)));
        }
        Self::resolve(Arc::new(document), Vec::new(), frame, self.library.clone())
    }

    fn resolve(
        document: Arc<Document>,
        mut findings: Vec<Finding>,
        frame: f64,
        library: Library,
    ) -> Result<Self, SceneError> {
        let (resolved, wrong) = animate::resolve(&document.tree, &document.sources, frame);
        findings.extend(wrong);
        let description = described(&resolved, &mut findings);
        let whole = description.is_some() && !findings.iter().any(Finding::is_error);
        let warnings = findings.iter().filter(|finding| !finding.is_error()).cloned().collect();
        let origin = Arc::new(Origin { document, frame, resolved, moments: Moments::default(), warnings });
        let scene = Self { description: description.unwrap_or_default(), origin: Some(origin), library };
        if whole {
            return Ok(scene);
        }
        // What could be read is checked too, so that all mistakes come at once.
        let more = Assembly::of(&scene.description, &[], scene.files()).1;
        Err(SceneError::Problems(scene.report(joined(findings, more))))
    }

    /// All that is wrong with the scene, warnings included, without building the world.
    pub fn check(&self) -> Problems {
        self.check_with_light().0
    }

    /// [`Scene::check`], and the light that brings the most to the middle of the scene.
    pub fn check_with_light(&self) -> (Problems, Option<Illuminance>) {
        let (moments, wrong) = self.moments();
        let (assembly, more) = Assembly::of(&self.description, &moments, self.files());
        (self.report(joined(joined(self.own_findings(), wrong), more)), assembly.illuminance)
    }

    /// Builds the world.
    pub fn compile(&self) -> Result<Compiled, SceneError> {
        let (moments, wrong) = self.moments();
        let (assembly, more) = Assembly::of(&self.description, &moments, self.files());
        let findings = joined(joined(self.own_findings(), wrong), more);
        let broken = findings.iter().any(Finding::is_error);
        let problems = self.report(findings);
        if broken {
            return Err(SceneError::Problems(problems));
        }
        Ok(assembly.compile(self.description.render.clone(), problems))
    }

    /// Compiles the scene with the world of an earlier compilation, which must be this scene's too:
    /// [`Scene::has_world_of`].
    pub fn compile_with(&self, earlier: &Compiled) -> Result<Compiled, SceneError> {
        let (moments, wrong) = self.moments();
        let (cameras, course, findings) = compile::look_at(&self.description, &moments, &earlier.bounds);
        let findings = joined(joined(self.own_findings(), wrong), findings);
        let broken = findings.iter().any(Finding::is_error);
        let warnings = self.report(findings);
        if broken {
            return Err(SceneError::Problems(warnings));
        }
        let settings = self.description.render.clone();
        let integrator = self.integrator_choice();
        Ok(Compiled { cameras, course, settings, integrator, warnings, ..earlier.clone() })
    }

    /// Whether the same stands in both, however it is looked at. Files are compared by their contents.
    pub fn has_world_of(&self, other: &Self) -> bool {
        let (a, b) = (&self.description, &other.description);
        let same_motion = || {
            let (a, b) = (self.moments().0, other.moments().0);
            let placed = |moments: &[Description]| -> Vec<_> {
                moments.iter().map(|at| (at.groups.clone(), at.lights.clone(), at.objects.clone())).collect()
            };
            Arc::ptr_eq(&a, &b) || placed(&a) == placed(&b)
        };
        (&a.background, &a.textures, &a.materials) == (&b.background, &b.textures, &b.materials)
            && a.background_light_group == b.background_light_group
            // What a scene without lights is lit by hangs on the integrator.
            && (!a.lights.is_empty() || self.integrator_choice().follows_paths() == other.integrator_choice().follows_paths())
            && (&a.groups, &a.lights, &a.objects) == (&b.groups, &b.lights, &b.objects)
            && digests(a, &self.files()) == digests(b, &other.files())
            && same_motion()
    }

    /// What it is at even times while the shutter is open, from opening to closing; nothing when it does not change.
    fn moments(&self) -> (Arc<Vec<Description>>, Vec<Finding>) {
        match &self.origin {
            Some(origin) => origin.moments.of(&origin.document, origin.frame, self.description.render.shutter),
            None => Default::default(),
        }
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

    /// What moves in the scene, as it was written. A scene that was not read from a file is still.
    pub fn survey(&self) -> animate::Survey {
        let document = self.origin.as_ref().map(|origin| &origin.document);
        document.map(|document| animate::survey(&document.tree, &document.sources)).unwrap_or_default()
    }

    /// Whether anything in the scene may change from frame to frame.
    pub fn depends_on_time(&self) -> bool {
        self.origin.as_ref().is_some_and(|origin| animate::depends_on_time(&origin.document.tree))
    }

    /// Everything that decides the pixels, however many samples are taken.
    pub fn fingerprint(&self) -> Fingerprint {
        Fingerprint::of(&self.description, &self.moments().0, &self.files())
    }

    /// The scene as a file, expressions resolved.
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
        let still = Description { animation: Animation::default(), ..self.description.clone() };
        let mut json = serde_json::to_value(&still).unwrap_or_default();
        schema::tidy(&mut json);
        schema::drop_nulls(&mut json);
        json
    }

    /// What does not fit the schema. A scene from a file has been checked when it was read; warnings
    /// are left of that.
    fn own_findings(&self) -> Vec<Finding> {
        match &self.origin {
            Some(origin) => origin.warnings.clone(),
            None => validate(&serde_json::to_value(&self.description).unwrap_or_default().into()).all(),
        }
    }

    fn files(&self) -> Files<'_> {
        let origin = self.origin.as_deref().map(|origin| (&origin.document.sources, &origin.resolved));
        Files { origin, library: &self.library }
    }

    fn report(&self, findings: Vec<Finding>) -> Problems {
        match &self.origin {
            Some(origin) => Problems::new(findings, origin.document.sources.clone(), Some(&origin.resolved)),
            None => Problems::new(findings, Sources::default(), None),
        }
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

/// The types of a tree, as far as it fits them, and all that is wrong with it: what does not fit the schema, and
/// what is wrong with the rest.
pub(crate) fn described(tree: &Node, findings: &mut Vec<Finding>) -> Option<Description> {
    let mut validated = validate(tree);
    let json = validated.json.take();
    findings.append(&mut validated.all());
    let json = json?;
    match Description::deserialize(&json) {
        Ok(description) => Some(description),
        // The schema allows what the types refuse: only a slip of ours can bring us here.
        Err(error) => {
            findings.push(Finding::error(error.to_string()).at(refused_part(&json)));
            None
        }
    }
}

/// The smallest section or item of a description that the types refuse by itself; the root if there is none. The same
/// deserializer serves as for the whole: each one more would double what this crate takes to build.
fn refused_part(json: &Value) -> ScenePath {
    let refused = |key: &str, value: Value| {
        let only = Map::from_iter([("version".to_owned(), 1.into()), (key.to_owned(), value)]);
        Description::deserialize(&Value::Object(only)).is_err()
    };
    let root = ScenePath::root();
    let Some((key, value)) = json.as_object().into_iter().flatten().find(|(key, value)| refused(key, (*value).clone()))
    else {
        return root;
    };
    let section = root.key(key);
    let item = match value {
        Value::Array(items) => {
            let at = items.iter().position(|item| refused(key, Value::Array(vec![item.clone()])));
            at.map(|at| section.index(at))
        }
        Value::Object(items) => {
            let one = |name: &String, item: &Value| Value::Object(Map::from_iter([(name.clone(), item.clone())]));
            let found = items.iter().find(|(name, item)| refused(key, one(name, item)));
            found.map(|(name, _)| section.key(name))
        }
        _ => None,
    };
    item.unwrap_or(section)
}
