//! Fingerprints of scenes. Scenes with the same fingerprint give the same pixels for the same
//! samples; for other scenes, the named parts tell the difference.
//!
//! A fingerprint covers the evaluated description and the contents of its files. It does not cover
//! titles, unused cameras, names of cameras, the length of the animation, the tone mapping (pixels
//! are linear) and the number of samples, since a render continued with more samples is still of
//! the same scene.

use crate::compile::{Files, image_files, light_files};
use crate::description::{Description, Object, Render};
use crate::item::Item;
use crate::model::{FileDigest, ModelIdentity};
use crate::motion::Tracks;
use crate::path::Path;
use crate::shared::Shared;
use indexmap::IndexSet;
use juggler_camera::AnyCamera;
use juggler_imaging::Tone;
use juggler_integrator::AnyIntegrator;
use serde::{Deserialize, Serialize};
use serde_json::ser::Formatter;
use std::collections::{BTreeMap, BTreeSet};
use std::io::{self, BufWriter, Write};
use std::path::PathBuf;

/// Version of the renderer's interpretation; changes when equal descriptions give other pixels.
const INTERPRETATION_VERSION: &[u8] = b"juggler scene 2\n";

/// Named parts of everything that affects the pixels: render settings verbatim, all else as hashes.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Fingerprint(BTreeMap<String, String>);

impl Fingerprint {
    /// Computes the fingerprint of a description with this integrator, its motion while the
    /// shutter is open, the files it refers to, and its models.
    pub(crate) fn compute(
        scene: &Description,
        integrator: AnyIntegrator,
        tracks: &Tracks,
        files: &Files<'_>,
        models: &[ModelIdentity],
    ) -> Self {
        // Clear the settings that do not affect pixels.
        let settings = Render { samples: 0, integrator: Some(integrator), camera: None, ..(*scene.render).clone() };
        let mut parts = Self::default();
        for (key, value) in serde_json::to_value(&settings).unwrap_or_default().as_object().into_iter().flatten() {
            match value.as_str() {
                Some(text) => parts.insert(&format!("render.{key}"), text),
                None => parts.insert(&format!("render.{key}"), &value.to_string()),
            }
        }
        let Description { version, background, background_light_group, .. } = scene;
        let Description { textures, materials, groups, lights, objects, .. } = scene;
        parts.insert("version", &digest_of(version));
        // The tone mapping does not affect pixels, but existing files contain the hash of the
        // default.
        parts.insert("tone", &digest_of(&Tone::default()));
        parts.insert_some("camera", camera_of(scene));
        parts.insert_some("background", background.as_ref());
        parts.insert_some("background_light_group", background_light_group.as_ref());
        parts.insert_section("textures", textures, textures.is_empty());
        parts.insert_section("materials", materials, materials.is_empty());
        parts.insert_section("groups", groups, groups.is_empty());
        parts.insert_section("lights", lights, lights.is_empty());
        parts.insert_section("objects", objects, objects.is_empty());
        parts.insert_motion(tracks);
        parts.insert_models(models);
        for (file, hash) in digests(scene, files) {
            let name = file.file_name().unwrap_or_default().to_string_lossy();
            parts.insert(&format!("file {name}"), &digest(&hash));
        }
        parts
    }

    /// Adds a part that affects the pixels. If the name exists, the value is appended to the
    /// existing one.
    pub fn insert(&mut self, name: &str, value: &str) {
        let part = self.0.entry(name.to_owned()).or_default();
        if !part.is_empty() {
            part.push(' ');
        }
        part.push_str(value);
    }

    /// Adds the hash of a part of the scene, if the scene has the part.
    fn insert_some(&mut self, name: &str, part: Option<&impl Serialize>) {
        if let Some(part) = part {
            self.insert(name, &digest_of(part));
        }
    }

    /// Adds the hash of the motion while the shutter is open, unless nothing moves.
    fn insert_motion(&mut self, tracks: &Tracks) {
        if !(tracks.objects.is_empty() && tracks.groups.is_empty() && tracks.lights.is_empty()) {
            self.insert("motion", &digest_of(&(&tracks.objects, &tracks.groups, &tracks.lights)));
        }
    }

    /// Adds the models, unless there are none: a part for each of their files, which names the file
    /// that changes, and a part for which of the models are where, at which times.
    fn insert_models(&mut self, models: &[ModelIdentity]) {
        if models.is_empty() {
            return;
        }
        let mut distinct: IndexSet<&[FileDigest]> = IndexSet::new();
        let placed = models.iter().map(|model| (distinct.insert_full(&model.files).0, &model.times));
        self.insert("models", &digest_of(&placed.collect::<Vec<_>>()));
        for file in distinct.into_iter().flatten() {
            self.insert(&format!("file {}", file.name), &digest(&file.digest));
        }
    }

    /// Adds the hash of a section unless it is empty. The hash is computed once for all scenes that
    /// share the section.
    fn insert_section(&mut self, name: &str, section: &Shared<impl Serialize>, is_empty: bool) {
        if !is_empty {
            self.insert(name, section.digest(|section| digest_of(section)));
        }
    }

    /// Sets the camera, for scenes that leave it open, and its `camera_keys` of motion while the
    /// shutter is open.
    pub fn set_camera(&mut self, camera: &AnyCamera, camera_keys: &[AnyCamera]) {
        self.0.insert("camera".into(), digest_of(camera));
        self.0.remove("camera.course");
        if !camera_keys.is_empty() {
            self.0.insert("camera.course".into(), digest_of(&camera_keys));
        }
    }

    /// Replaces the camera and the render settings by those of another fingerprint.
    #[must_use]
    pub fn with_view_of(&self, other: &Self) -> Self {
        let of_view = |name: &str| name.starts_with("camera") || name.starts_with("render.");
        let own = self.0.iter().filter(|(name, _)| !of_view(name));
        let others = other.0.iter().filter(|(name, _)| of_view(name));
        Self(own.chain(others).map(|(name, value)| (name.clone(), value.clone())).collect())
    }

    /// The parts by name.
    pub fn parts(&self) -> &BTreeMap<String, String> {
        &self.0
    }

    /// Hash of the fingerprint as 64 hexadecimal digits.
    pub fn hash(&self) -> String {
        let mut hasher = blake3::Hasher::new();
        hasher.update(INTERPRETATION_VERSION);
        for (name, value) in &self.0 {
            hasher.update(format!("{name:?} {value:?}\n").as_bytes());
        }
        hasher.finalize().to_hex().to_string()
    }
}

/// The active camera; `None` if the scene defines none and it is derived from the bounds.
fn camera_of(scene: &Description) -> Option<&AnyCamera> {
    let chosen = scene.render.camera.as_ref().and_then(|name| scene.cameras.get(&name.0));
    chosen.or(scene.camera.as_ref()).or_else(|| scene.cameras.values().next()).map(|camera| &**camera)
}

/// Hash of a value's JSON, with 32-bit numbers written as 64-bit ones. The JSON is streamed to the
/// hasher.
fn digest_of(value: &impl Serialize) -> String {
    let mut writer = BufWriter::new(blake3::Hasher::new());
    // Serialization of plain data cannot fail.
    let written = value.serialize(&mut serde_json::Serializer::with_formatter(&mut writer, WideNumbers));
    let hasher = writer.into_inner().unwrap_or_default();
    debug_assert!(written.is_ok());
    hex(hasher.finalize())
}

/// Writes each 32-bit number as the 64-bit number of the same value.
struct WideNumbers;

impl Formatter for WideNumbers {
    fn write_f32<W: ?Sized + Write>(&mut self, writer: &mut W, value: f32) -> io::Result<()> {
        self.write_f64(writer, f64::from(value))
    }
}

fn digest(bytes: &[u8]) -> String {
    hex(blake3::hash(bytes))
}

/// First half of a hash, as 32 hexadecimal digits.
fn hex(hash: blake3::Hash) -> String {
    hash.to_hex()[..32].to_owned()
}

/// The files of meshes, images, lights and instances that a scene refers to, with the hashes of their
/// contents.
pub(crate) fn digests(scene: &Description, files: &Files<'_>) -> Vec<(PathBuf, [u8; 32])> {
    let meshes = mesh_files(scene, files).into_iter().map(|file| (files.asset_cache.digest(&file), file));
    let images = image_files(scene, files).into_iter();
    let images = images.map(|(file, space)| (files.asset_cache.image_digest(&file, space), file));
    let lights = light_files(scene, files).into_iter();
    let lights = lights.map(|(file, purpose)| (files.asset_cache.light_digest(&file, purpose), file));
    let instances = files.instance_files().into_iter();
    let instances = instances.map(|file| (files.asset_cache.instance_digest(&file), file));
    meshes.chain(images).chain(lights).chain(instances).map(|(hash, file)| (file, hash)).collect()
}

/// The mesh files that a scene refers to, without duplicates.
pub(crate) fn mesh_files(scene: &Description, files: &Files<'_>) -> BTreeSet<PathBuf> {
    let mut found = BTreeSet::new();
    for (name, objects) in &scene.groups {
        collect(objects, &Path::root().key("groups").key(name.as_str()), files, &mut found);
    }
    collect(&scene.objects, &Path::root().key("objects"), files, &mut found);
    found
}

fn collect(objects: &[Item<Object>], path: &Path, files: &Files<'_>, found: &mut BTreeSet<PathBuf>) {
    for (i, object) in objects.iter().enumerate() {
        if let Some(mesh) = object.mesh() {
            let path = path.index(i).key("shape").key("mesh");
            found.extend(mesh.file.iter().map(|file| files.locate(&path.key("file"), file)));
            for (i, morph) in mesh.morphs.iter().enumerate() {
                let path = path.key("morphs").index(i).key("file");
                found.extend(morph.file.iter().map(|file| files.locate(&path, file)));
            }
        }
        if object.objects.is_some() {
            collect(object.inner(), &path.index(i).key("objects"), files, found);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Scene, built_in_scenes};

    /// Existing checkpoints and partial renders contain these hashes.
    #[test]
    fn fingerprint_hashes_equal_those_of_the_json_value() {
        let mut parts = 0;
        for scene in built_in_scenes() {
            let scene = Scene::built_in(scene.name).unwrap();
            let tree = serde_json::to_value(&scene.description).unwrap();
            let fingerprint = scene.fingerprint();
            for name in ["background", "textures", "materials", "groups", "lights", "objects"] {
                let expected = tree.get(name).filter(|part| !part.as_array().is_some_and(Vec::is_empty));
                let expected = expected.map(|part| digest(part.to_string().as_bytes()));
                assert_eq!(fingerprint.parts().get(name), expected.as_ref(), "{}: {name}", scene.description.title);
                parts += usize::from(expected.is_some());
            }
        }
        assert!(parts > 100, "{parts}");
    }
}
