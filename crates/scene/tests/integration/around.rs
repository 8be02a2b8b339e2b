//! Mesh files loaded as scenes, and files of other programs.

use juggler_integrator::AnyIntegrator;
use juggler_math::testing::skipped;
use juggler_scene::{Bundle, Scene, SceneError};
use std::fs;
use std::path::{Path, PathBuf};

/// A tetrahedron with its base in the plane y = 0.
const TETRAHEDRON: &str = "v 0 0 0\nv 2 0 0\nv 0 0 2\nv 0 2 0\nf 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n";

/// A tower along z, as in 3D printing: one triangle in the plane x = 0.
const TOWER: &str = "solid tower\nfacet normal 1 0 0\nouter loop\nvertex 0 0 0\nvertex 0 1 0\nvertex 0 0 8\n\
                     endloop\nendfacet\nendsolid tower\n";

fn message(name: &str, content: &[u8]) -> String {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, content).unwrap();
    let error = Scene::load(&path).map(|_| ()).unwrap_err().to_string();
    error.replace(&format!("{}/", folder.path().display()), "")
}

/// Loads the scene of a file or around a mesh and asserts that it has no errors and no warnings.
fn around(path: &Path) -> Scene {
    let scene = Scene::load(path).unwrap();
    assert!(scene.check().list().is_empty(), "{}: {}", path.display(), scene.check());
    scene
}

#[test]
fn a_mesh_is_a_scene_with_floor_light_and_camera() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("tetrahedron.obj");
    fs::write(&path, TETRAHEDRON).unwrap();
    let scene = around(&path);
    let description = &scene.description;
    assert_eq!(description.title, "tetrahedron");
    assert!(matches!(description.render.integrator, Some(AnyIntegrator::Path(_))));
    assert_eq!((description.objects.len(), description.lights.len()), (2, 1));
    let compiled = scene.compile().unwrap();
    assert_eq!(compiled.world.geometry_stats().triangles, 4);
    assert_eq!(scene.paths(), std::slice::from_ref(&path), "the mesh is watched");
    // Edits and other frames work as for scene files.
    let edited = scene.with_value("/materials/model/principled/roughness", 0.1.into()).unwrap();
    assert!(edited.compile().is_ok() && !edited.has_world_of(&scene));
    fs::write(&path, TETRAHEDRON.replace("v 0 2 0", "v 0 5.5 0")).unwrap();
    let again = scene.reload(&path).unwrap();
    let camera = |scene: &Scene| scene.compile().unwrap().cameras;
    assert_ne!(camera(&again), camera(&scene));
}

#[test]
fn stl_files_are_read_as_z_up() {
    let bundle = Bundle::from_iter([("tower.stl".to_owned(), TOWER.as_bytes().to_vec())]);
    let scene = Scene::from_bundle(bundle, "tower.stl").unwrap();
    let bounds = scene.compile().unwrap().world.bounds();
    assert!((bounds.max.y - 8.0).abs() < 1e-5 && bounds.max.z < 1e-5, "{bounds:?}");
}

/// A scene that is written to another folder still refers to its files.
#[test]
fn saved_scenes_refer_to_files_relative_to_their_folder() {
    let folder = tempfile::tempdir().unwrap();
    for sub in ["models", "scenes"] {
        fs::create_dir(folder.path().join(sub)).unwrap();
    }
    fs::write(folder.path().join("models/tetrahedron.obj"), TETRAHEDRON).unwrap();
    let text = r#"{"version": 1, "objects": [{"shape": {"mesh": {"file": "../models/tetrahedron.obj"}}}]}"#;
    let path = folder.path().join("scenes/first.json");
    fs::write(&path, text).unwrap();
    let scene = around(&path);
    for (sub, name) in
        [("scenes", "../models/tetrahedron.obj"), ("models", "tetrahedron.obj"), (".", "models/tetrahedron.obj")]
    {
        let folder = folder.path().join(sub);
        let json = scene.to_json_in(&folder);
        assert!(json.contains(&format!("\"file\": \"{name}\"")), "{json}");
        let file = folder.join("second.json");
        fs::write(&file, json).unwrap();
        assert_eq!(around(&file).compile().unwrap().world.geometry_stats().triangles, 4);
    }
}

#[test]
fn formats_that_are_not_read_yet_are_named() {
    let gltf = message("car.glb", b"glTF\x02\0\0\0");
    assert_eq!(gltf, "`car.glb`: glTF files are no meshes: write \"model\": {\"file\": ...} instead of \"shape\"");
    assert_eq!(message("car.gltf", br#"{"asset": {"version": "2.0"}}"#), gltf.replace("glb", "gltf"));
    assert!(message("car.obj", b"Kaydara FBX Binary  \0").contains("FBX is not supported"));
    assert!(message("room.pov", b"// a room\nsphere { 0, 1 }").contains("docs/names.md"));
    let in_scene = br#"{"version": 1, "objects": [{"shape": {"mesh": {"file": "car.glb"}}}]}"#;
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("car.glb"), b"glTF\x02\0\0\0").unwrap();
    let path = folder.path().join("scene.json");
    fs::write(&path, in_scene).unwrap();
    let scene = Scene::load(&path).unwrap();
    assert!(scene.check().to_string().contains("car.glb`: glTF files are no meshes"), "{}", scene.check());
}

#[test]
fn malformed_meshes_are_reported_with_their_line() {
    assert_eq!(
        message("a.obj", b"v 0 0\n"),
        "cannot read `a.obj`: line 1: expected a number for z, found the end of the line"
    );
    assert!(matches!(Scene::load("none.obj"), Err(SceneError::Read { .. })));
}

/// Path of an asset, if the assets are available.
fn asset(name: &str) -> Option<PathBuf> {
    let beside = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/assets");
    let folder = std::env::var_os("JUGGLER_ASSETS").map_or_else(beside, PathBuf::from);
    if !folder.is_dir() {
        skipped(&format!("test assets: none in {}, set JUGGLER_ASSETS to their folder", folder.display()));
        return None;
    }
    Some(folder.join(name))
}

/// Tests real models, if they are available.
#[test]
fn models_of_the_assets_get_scenes() {
    for name in ["obj/teapot.obj", "obj/spot/spot_triangulated.obj", "ply/suzanne.ply", "stl/featuretype.STL"] {
        let Some(path) = asset(name) else { return };
        let compiled = Scene::load(path).unwrap().compile().unwrap();
        assert_eq!(compiled.cameras.len(), 1, "{name}");
    }
}
