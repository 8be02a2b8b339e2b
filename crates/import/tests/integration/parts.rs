//! Parts of scenes of other people's models.

use crate::assets::{Folder, assets, find};
use juggler_import::gltf::GltfFormat;
use juggler_scene::Scene;
use juggler_scene::model::{ModelChoice, ModelFile, ModelFormat, ModelParts};
use std::path::Path;
use std::sync::Arc;

fn open(path: &Path) -> Arc<dyn ModelFile> {
    let name = path.file_name().unwrap().to_string_lossy().into_owned();
    let files = Folder(path.parent().unwrap().to_owned());
    GltfFormat::default()
        .open(&name, std::fs::read(path).unwrap(), &files)
        .unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn parts(model: &dyn ModelFile, seconds: f64) -> ModelParts {
    let choice = ModelChoice { seconds, ..ModelChoice::default() };
    model.parts(&choice, "m/").unwrap_or_else(|error| panic!("{error}"))
}

/// A scene of all parts.
fn scene(parts: ModelParts) -> Scene {
    let mut scene = Scene::new();
    scene = parts.assets.into_iter().fold(scene, |scene, (name, asset)| scene.asset(name, asset));
    scene = parts.textures.into_iter().fold(scene, |scene, (name, texture)| scene.texture(name, texture));
    scene = parts.materials.into_iter().fold(scene, |scene, (name, material)| scene.material(name, material));
    scene = parts.groups.into_iter().fold(scene, |scene, (name, objects)| scene.group(name, objects));
    scene = parts.cameras.into_iter().fold(scene, |scene, (name, camera)| scene.camera(name, camera));
    scene = parts.lights.into_iter().fold(scene, |scene, (_, light)| scene.light(light));
    parts.objects.into_iter().fold(scene, Scene::add)
}

#[test]
fn every_model_becomes_a_scene_at_two_times() {
    let Some(folder) = assets() else { return };
    let mut paths = Vec::new();
    find(&folder.join("gltf"), &["gltf", "glb"], &mut paths);
    for path in paths {
        let model = open(&path);
        let [early, late] = [0.0, 0.5].map(|seconds| parts(&*model, seconds));
        let names = |parts: &ModelParts| parts.objects.iter().map(|object| object.name.clone()).collect::<Vec<_>>();
        assert_eq!(names(&early), names(&late), "{}", path.display());
        assert!(!early.objects.is_empty(), "{}", path.display());
        for found in [early, late] {
            scene(found).compile().map(|_| ()).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        }
        let summary = model.summary(&ModelChoice::default()).unwrap();
        assert!(summary.drawn_triangles > 0, "{summary:?}");
        eprintln!("{}: {:?}", path.display(), summary.warnings);
    }
}
