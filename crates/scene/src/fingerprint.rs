//! A hash of everything that decides a scene's pixels: two scenes with the same fingerprint give the same picture
//! for the same samples.
//!
//! It covers the resolved description and the contents of mesh files. It does not cover titles, how long the
//! animation is, the tone curve (pixels are linear), and how many samples are taken: a picture that is extended to
//! more samples stays the same picture.

use crate::compile::Files;
use crate::description::{Description, Object};
use crate::path::Path;
use juggler_tracer::shape::AnyShape;
use std::collections::BTreeSet;
use std::path::PathBuf;

/// Changes when the same description comes to mean another picture.
const MEANING: &[u8] = b"juggler scene 1\n";

/// The fingerprint as 64 hexadecimal digits.
pub fn of(scene: &Description, files: &Files<'_>) -> String {
    let mut hasher = blake3::Hasher::new();
    hasher.update(MEANING);
    let mut bare = scene.clone();
    bare.title.clear();
    bare.description.clear();
    bare.animation = Default::default();
    bare.tone = Default::default();
    bare.render.samples = 0;
    // Writing into a hasher cannot fail, and descriptions are plain data.
    if let Err(error) = serde_json::to_writer(&mut hasher, &bare) {
        hasher.update(error.to_string().as_bytes());
    }
    for file in mesh_files(scene, files) {
        hasher.update(&files.library.digest(&file));
    }
    hasher.finalize().to_hex().to_string()
}

fn mesh_files(scene: &Description, files: &Files<'_>) -> BTreeSet<PathBuf> {
    let mut found = BTreeSet::new();
    for (name, objects) in &scene.groups {
        collect(objects, &Path::root().key("groups").key(name.as_str()), files, &mut found);
    }
    collect(&scene.objects, &Path::root().key("objects"), files, &mut found);
    found
}

fn collect(objects: &[Object], path: &Path, files: &Files<'_>, found: &mut BTreeSet<PathBuf>) {
    for (i, object) in objects.iter().enumerate() {
        if let Some(AnyShape::Mesh(mesh)) = &object.shape
            && let Some(file) = &mesh.file
        {
            found.insert(files.locate(&path.index(i).key("shape").key("mesh").key("file"), file));
        }
        if let Some(objects) = &object.objects {
            collect(objects, &path.index(i).key("objects"), files, found);
        }
    }
}
