//! What decides a scene's pixels, by name: two scenes with the same fingerprint give the same picture for the same
//! samples, and of two that differ it says in what.
//!
//! It covers the resolved description and the contents of the files that it names. It does not cover titles, cameras that are not
//! looked through and the names of cameras, how long the animation is, the tone curve (pixels are linear), and how many
//! samples are taken: a picture that is extended to more samples stays the same picture.

use crate::compile::{Files, light_files, pictures};
use crate::description::{Description, Object};
use crate::integrator::IntegratorChoice;
use crate::path::Path;
use juggler_tracer::camera::AnyCamera;
use juggler_tracer::shape::AnyShape;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

/// Changes when the same description comes to mean another picture.
const MEANING: &[u8] = b"juggler scene 2\n";

/// Named parts of everything that decides the pixels: settings as they are, the rest by its hash.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Fingerprint(BTreeMap<String, String>);

impl Fingerprint {
    /// Of a description, what it is at `moments` while the shutter is open, and the files it names.
    pub(crate) fn of(scene: &Description, moments: &[Description], files: &Files<'_>) -> Self {
        let mut bare = scene.clone();
        bare.title.clear();
        bare.description.clear();
        bare.animation = Default::default();
        bare.tone = Default::default();
        bare.render.samples = 0;
        bare.render.integrator = Some(IntegratorChoice::of(scene).integrator);
        bare.camera = camera_of(scene).cloned();
        bare.cameras.clear();
        bare.render.camera = None;
        let mut parts = Self::default();
        // Descriptions are plain data: they can be written.
        let json = serde_json::to_value(&bare).unwrap_or_default();
        for (key, value) in json.as_object().into_iter().flatten() {
            match value.as_object() {
                Some(settings) if key == "render" => settings.iter().for_each(|(key, value)| match value.as_str() {
                    Some(text) => parts.insert(&format!("render.{key}"), text),
                    None => parts.insert(&format!("render.{key}"), &value.to_string()),
                }),
                _ if is_nothing(value) => {}
                _ => parts.insert(key, &digest(value.to_string().as_bytes())),
            }
        }
        if !moments.is_empty() {
            let all: Vec<_> = moments.iter().map(|at| (&at.groups, &at.lights, &at.objects)).collect();
            parts.insert("motion", &digest(&serde_json::to_vec(&all).unwrap_or_default()));
        }
        for (file, hash) in digests(scene, files) {
            let name = file.file_name().unwrap_or_default().to_string_lossy();
            parts.insert(&format!("file {name}"), &digest(&hash));
        }
        parts
    }

    /// Adds what decides the pixels too. Of a name that is there already, both values count.
    pub fn insert(&mut self, name: &str, value: &str) {
        let part = self.0.entry(name.to_owned()).or_default();
        if !part.is_empty() {
            part.push(' ');
        }
        part.push_str(value);
    }

    /// What is looked through, where the scene leaves it open, and its `course` while the shutter is open.
    pub fn set_camera(&mut self, camera: &AnyCamera, course: &[AnyCamera]) {
        let hash = |json: Value| digest(json.to_string().as_bytes());
        self.0.insert("camera".into(), hash(serde_json::to_value(camera).unwrap_or_default()));
        self.0.remove("camera.course");
        if !course.is_empty() {
            self.0.insert("camera.course".into(), hash(serde_json::to_value(course).unwrap_or_default()));
        }
    }

    /// The same with the camera and the settings of another.
    #[must_use]
    pub fn seen_as(&self, other: &Self) -> Self {
        let of_view = |name: &str| name.starts_with("camera") || name.starts_with("render.");
        let own = self.0.iter().filter(|(name, _)| !of_view(name));
        let others = other.0.iter().filter(|(name, _)| of_view(name));
        Self(own.chain(others).map(|(name, value)| (name.clone(), value.clone())).collect())
    }

    /// The parts by name.
    pub fn parts(&self) -> &BTreeMap<String, String> {
        &self.0
    }

    /// All of it as 64 hexadecimal digits.
    pub fn hash(&self) -> String {
        let mut hasher = blake3::Hasher::new();
        hasher.update(MEANING);
        for (name, value) in &self.0 {
            hasher.update(format!("{name:?} {value:?}\n").as_bytes());
        }
        hasher.finalize().to_hex().to_string()
    }
}

/// The camera that is looked through, unless it is one that follows from what can be seen.
fn camera_of(scene: &Description) -> Option<&AnyCamera> {
    let chosen = scene.render.camera.as_ref().and_then(|name| scene.cameras.get(&name.0));
    chosen.or(scene.camera.as_ref()).or_else(|| scene.cameras.values().next())
}

fn is_nothing(value: &Value) -> bool {
    match value {
        Value::Null => true,
        Value::Array(items) => items.is_empty(),
        Value::Object(items) => items.is_empty(),
        _ => false,
    }
}

fn digest(bytes: &[u8]) -> String {
    blake3::hash(bytes).to_hex()[..32].to_owned()
}

/// The mesh, picture and photometric files that a scene names, with the hashes of their contents.
pub(crate) fn digests(scene: &Description, files: &Files<'_>) -> Vec<(PathBuf, [u8; 32])> {
    let meshes = mesh_files(scene, files).into_iter().map(|file| (files.library.digest(&file), file));
    let pictures = pictures(scene, files).into_iter();
    let pictures = pictures.map(|(file, space)| (files.library.picture_digest(&file, space), file));
    let lights = light_files(scene, files).into_iter();
    let lights = lights.map(|(file, purpose)| (files.library.light_digest(&file, purpose), file));
    meshes.chain(pictures).chain(lights).map(|(hash, file)| (file, hash)).collect()
}

/// The mesh files that a scene names, each once.
pub(crate) fn mesh_files(scene: &Description, files: &Files<'_>) -> BTreeSet<PathBuf> {
    let mut found = BTreeSet::new();
    for (name, objects) in &scene.groups {
        collect(objects, &Path::root().key("groups").key(name.as_str()), files, &mut found);
    }
    collect(&scene.objects, &Path::root().key("objects"), files, &mut found);
    found
}

fn collect(objects: &[Object], path: &Path, files: &Files<'_>, found: &mut BTreeSet<PathBuf>) {
    for (i, object) in objects.iter().enumerate() {
        if let Some(AnyShape::Mesh(mesh)) = &object.shape {
            let path = path.index(i).key("shape").key("mesh");
            found.extend(mesh.file.iter().map(|file| files.locate(&path.key("file"), file)));
            for (i, morph) in mesh.morphs.iter().enumerate() {
                let path = path.key("morphs").index(i).key("file");
                found.extend(morph.file.iter().map(|file| files.locate(&path, file)));
            }
        }
        if let Some(objects) = &object.objects {
            collect(objects, &path.index(i).key("objects"), files, found);
        }
    }
}
