//! Models as objects and as scenes, with a small format that is made for these tests.

use glam::{DAffine3, DQuat, DVec3};
use indexmap::IndexMap;
use juggler_camera::{AnyCamera, Perspective};
use juggler_light::{AnyLight, Point};
use juggler_material::medium::Medium;
use juggler_material::{AnyMaterial, MaterialRef, Principled};
use juggler_math::{Rgb, Vec3};
use juggler_scene::model::{
    AnimationChoice, FileDigest, FileError, Files, ModelChoice, ModelClip, ModelError, ModelFile, ModelFormat,
    ModelParts, ModelSummary, NameOrIndex,
};
use juggler_scene::{Bundle, Loader, Object, Scene, SceneError};
use juggler_shape::Sphere;
use std::fs;
use std::path::Path;
use std::sync::Arc;

/// Format "toy": a first line "toy", then one word a line: `lit`, `clip`, or the name of a file that
/// must exist.
#[derive(Debug)]
struct ToyFormat;

/// Opened file.
#[derive(Debug)]
struct Toy {
    digest: [u8; 32],
    files: Vec<FileDigest>,
    has_clip: bool,
    is_lit: bool,
}

pub const LOADER: Loader = Loader::new(&[&ToyFormat]);

impl ModelFormat for ToyFormat {
    fn name(&self) -> &'static str {
        "toy"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["toy"]
    }

    fn is_content(&self, head: &[u8]) -> bool {
        head.starts_with(b"toy\n")
    }

    fn open(&self, name: &str, bytes: Vec<u8>, files: &dyn Files) -> Result<Arc<dyn ModelFile>, ModelError> {
        let text = String::from_utf8(bytes).unwrap();
        let mut toy = Toy { digest: [0; 32], files: Vec::new(), has_clip: false, is_lit: false };
        for word in text.lines().skip(1) {
            match word {
                "clip" => toy.has_clip = true,
                "lit" => toy.is_lit = true,
                other => {
                    let bytes = files
                        .read(other, 1000)
                        .map_err(|error: FileError| ModelError::new(format!("{name}: /files/0: {other}: {error}")))?;
                    toy.files.push(FileDigest { name: other.to_owned(), digest: digest(&bytes) });
                }
            }
        }
        toy.digest = digest(text.as_bytes());
        Ok(Arc::new(toy))
    }
}

/// Hash of bytes.
fn digest(bytes: &[u8]) -> [u8; 32] {
    let sum = bytes.iter().fold(7u64, |sum, byte| sum.wrapping_mul(31).wrapping_add(u64::from(*byte)));
    let mut digest = [0; 32];
    digest[..8].copy_from_slice(&sum.to_le_bytes());
    digest
}

impl Toy {
    fn clip(&self, choice: &ModelChoice) -> Result<Option<usize>, ModelError> {
        match &choice.animation {
            AnimationChoice::None => Ok(None),
            AnimationChoice::First => Ok(self.has_clip.then_some(0)),
            AnimationChoice::Clip(NameOrIndex::Name(name)) if name == "Walk" => Ok(Some(0)),
            AnimationChoice::Clip(other) => Err(ModelError::new(format!("no animation {other:?}"))),
        }
    }
}

impl ModelFile for Toy {
    fn digest(&self) -> [u8; 32] {
        self.digest
    }

    fn files(&self) -> &[FileDigest] {
        &self.files
    }

    fn moves(&self, choice: &ModelChoice) -> bool {
        self.clip(choice).is_ok_and(|clip| clip.is_some())
    }

    fn parts(&self, choice: &ModelChoice, prefix: &str) -> Result<ModelParts, ModelError> {
        let x = self.clip(choice)?.map_or(0.0, |_| choice.seconds as f32);
        let medium = Medium { color: Rgb::splat(0.5), distance: 1.0, ..Medium::default() };
        let mut fur = Principled { medium, ..Principled::default() };
        if choice.variant.is_some() {
            fur.metallic = 1.0.into();
        }
        let named = |name: &str| Some(MaterialRef::Name(format!("{prefix}{name}")));
        let ball = Object { material: named("Fur"), ..Object::new(Sphere { radius: 1.0 }) };
        let head = ball.clone().at(x, 2.0, 0.0).named("Root/Head");
        let foot = Object::group(format!("{prefix}mesh Foot")).named("Root/Foot");
        let point = Point { position: Vec3::new(x, 5.0, 0.0), ..Point::default() };
        let camera = Perspective { eye: Vec3::new(x, 0.0, 9.0), ..Perspective::default() };
        Ok(ModelParts {
            materials: IndexMap::from([(format!("{prefix}Fur"), fur.into())]),
            groups: IndexMap::from([(format!("{prefix}mesh Foot"), vec![ball])]),
            cameras: IndexMap::from([(format!("{prefix}Eye"), camera.into())]),
            lights: if self.is_lit { vec![("Root/Bulb".into(), point.into())] } else { Vec::new() },
            objects: vec![head.into(), foot.into()],
            warnings: vec!["the toy is approximated".into()],
            ..ModelParts::default()
        })
    }

    fn node_transform(&self, node: &str, choice: &ModelChoice) -> Result<DAffine3, ModelError> {
        if node != "Head" {
            return Err(ModelError::new(format!("no node {node}")));
        }
        let x = self.clip(choice)?.map_or(0.0, |_| choice.seconds);
        Ok(DAffine3::from_scale_rotation_translation(DVec3::splat(2.0), DQuat::IDENTITY, DVec3::new(x, 2.0, 0.0)))
    }

    fn summary(&self, choice: &ModelChoice) -> Result<ModelSummary, ModelError> {
        let clip = ModelClip { name: "Walk".into(), seconds: 2.0 };
        Ok(ModelSummary {
            format: "toy 1".into(),
            clips: if self.has_clip { vec![clip] } else { Vec::new() },
            clip: self.clip(choice)?,
            cameras: vec![("Eye".into(), Some(2.0))],
            illuminance: if self.is_lit { 1.0 } else { 0.0 },
            ..ModelSummary::default()
        })
    }
}

/// Scene of the objects with the toys `still.toy` and `walk.toy`.
fn scene(objects: &str) -> Result<Scene, SceneError> {
    scene_with(objects, "")
}

pub fn scene_with(objects: &str, more: &str) -> Result<Scene, SceneError> {
    let text = format!(r#"{{"version": 1, "objects": [{objects}]{more}}}"#);
    let files = [("a.json", text.as_str()), ("still.toy", "toy\nlit\n"), ("walk.toy", "toy\nclip\nlit\n")];
    let files = files.map(|(name, text)| (name.to_owned(), text.as_bytes().to_vec()));
    LOADER.from_bundle(Bundle::from_iter(files), "a.json")
}

const STILL: &str = r#"{"model": {"file": "still.toy"}}"#;

fn medium_distances(scene: &Scene) -> Vec<(String, f32)> {
    let distance = |material: &AnyMaterial| match material {
        AnyMaterial::Principled(principled) => principled.medium.distance,
        _ => 0.0,
    };
    let materials = scene.expanded_description().materials;
    materials.iter().map(|(name, material)| (name.clone(), distance(material))).collect()
}

fn points(scene: &Scene) -> Vec<Vec3> {
    let position = |light: &AnyLight| if let AnyLight::Point(point) = light { Some(point.position) } else { None };
    scene.expanded_description().lights.iter().filter_map(|light| position(light)).collect()
}

#[test]
fn a_model_becomes_objects_materials_groups_lights_and_cameras() {
    let scene = scene(
        r#"{"model": {"file": "still.toy"}, "name": "toy", "transform": [{"scale": 2}, {"translate": [1, 0, 0]}]}"#,
    );
    let scene = scene.unwrap();
    assert_eq!(scene.check().to_string().matches("the toy is approximated").count(), 1, "{}", scene.check());
    let compiled = scene.compile().unwrap();
    assert_eq!(compiled.world.geometry_stats().shapes, 2);
    assert_eq!(compiled.bounds.min, Vec3::new(-1.0, -2.0, -2.0));
    assert_eq!(compiled.bounds.max, Vec3::new(3.0, 6.0, 2.0));
    assert_eq!(points(&scene), [Vec3::new(1.0, 10.0, 0.0)]);
    assert_eq!(medium_distances(&scene), [("still/Fur".to_owned(), 2.0)]);
    let (name, camera) = &compiled.cameras[0];
    let AnyCamera::Perspective(camera) = camera else { panic!("{camera:?}") };
    assert_eq!((name.as_str(), camera.eye), ("still/Eye", Vec3::new(1.0, 0.0, 18.0)));
}

#[test]
fn models_of_equal_content_share_their_parts_and_others_do_not() {
    let turned = r#"{"model": {"file": "still.toy"}, "transform": [{"rotate": {"axis": [1, 2, 3], "degrees": 77}}]}"#;
    let larger = r#"{"model": {"file": "still.toy"}, "transform": [{"scale": [1, -2, 4]}]}"#;
    let metal = r#"{"model": {"file": "still.toy", "variant": "metal"}}"#;
    let scene = scene(&[STILL, turned, larger, metal].join(", ")).unwrap();
    let expected = [("still/Fur", 1.0), ("still#2/Fur", 2.0), ("still#3/Fur", 1.0)];
    assert_eq!(medium_distances(&scene), expected.map(|(name, distance)| (name.to_owned(), distance)));
    assert_eq!(scene.compile().unwrap().cameras.len(), 4);
    assert_eq!(points(&scene).len(), 4);
}

#[test]
fn copies_of_a_model_share_their_objects() {
    let walking = r#"{"model": {"file": "walk.toy"}}, {"model": {"file": "walk.toy", "at": 0.5}}"#;
    let headless = r#"{"model": {"file": "still.toy", "hide": ["Head"]}}"#;
    let scene = scene(&[STILL, STILL, headless, walking, r#"{"model": {"file": "walk.toy"}}"#].join(", ")).unwrap();
    let objects = scene.expanded_description().objects;
    let inner = |i: usize| objects[i].objects.clone().unwrap();
    assert!(inner(0).is_same(&inner(1)) && inner(3).is_same(&inner(5)));
    assert_eq!([0, 1, 2, 3, 4].map(|i| inner(i).len()), [2, 2, 1, 2, 2]);
    assert!(inner(3) != inner(4), "the clip is at another time");
    let hidden = r#"{"model": {"file": "still.toy", "hide": ["Hed"]}}"#;
    let message = scene_with(&[hidden, hidden].join(", "), "").unwrap().check().to_string();
    assert!(message.contains("objects[0].model.hide[0]") && message.contains("objects[1].model.hide[0]"), "{message}");
    assert_eq!(message.matches("the toy is approximated").count(), 2, "{message}");
}

#[test]
fn names_of_a_scene_are_kept_beside_those_of_its_models() {
    let own = r#", "materials": {"still/Fur": {"diffuse": {}}}, "cameras": {"still/Eye": {"perspective": {}}}"#;
    let scene = scene_with(STILL, own).unwrap();
    let names: Vec<String> = medium_distances(&scene).into_iter().map(|(name, _)| name).collect();
    assert_eq!(names, ["still/Fur", "still#2/Fur"]);
    assert_eq!(scene.compile().unwrap().cameras.len(), 2);
}

#[test]
fn settings_of_a_model_select_and_replace_its_parts() {
    let shapes = |model: &str| {
        let scene = scene(model).unwrap();
        (scene.compile().unwrap().world.geometry_stats().shapes, points(&scene).len())
    };
    assert_eq!(shapes(STILL), (2, 1));
    assert_eq!(shapes(r#"{"model": {"file": "still.toy", "hide": ["Foot"]}}"#), (1, 1));
    assert_eq!(shapes(r#"{"model": {"file": "still.toy", "nodes": ["Head"], "lights": false}}"#).0, 1);
    assert_eq!(shapes(r#"{"model": {"file": "still.toy", "lights": false}}"#).1, 0);
    assert_eq!(shapes(r#"{"model": {"file": "still.toy"}, "visible": false}"#).1, 0);
    for model in [
        r#"{"model": {"file": "still.toy", "materials": {"Fur": "clay"}}}"#,
        r#"{"model": {"file": "still.toy"}, "material": "clay"}"#,
    ] {
        let scene = scene_with(model, r#", "materials": {"clay": {"diffuse": {}}}"#).unwrap();
        let used = format!("{:?}", (&scene.expanded_description().objects, &scene.expanded_description().groups));
        assert!(!used.contains("still/Fur") && used.contains("clay"), "{used}");
        scene.compile().unwrap();
    }
}

#[test]
fn unknown_names_and_files_are_errors_with_their_place() {
    let message = |model: &str| match scene(model) {
        Ok(scene) => scene.check().to_string(),
        Err(error) => error.to_string(),
    };
    let text = message(
        r#"{"model": {"file": "still.toy", "nodes": ["Heap"], "hide": ["x"], "materials": {"Fut": {"diffuse": {}}}}}"#,
    );
    for expected in ["the model has no node `Heap`", "did you mean `Head`", "no node `x`", "no material `Fut`"] {
        assert!(text.contains(expected), "{expected}: {text}");
    }
    assert!(text.contains("a.json:1:"), "{text}");
    assert!(message(r#"{"model": {"file": "none.toy"}}"#).contains("none.toy"));
    let text = message(r#"{"model": {"file": "walk.toy", "animation": "Wolk"}}"#);
    assert!(text.contains("no animation"), "{text}");
    assert!(message(r#"{"model": {"variant": "a"}}"#).contains("file"));
    assert!(message(r#"{"model": {"file": "still.toy"}, "shape": {"sphere": {}}}"#).contains("model"));
    let text = Scene::from_json(format!(r#"{{"version": 1, "objects": [{STILL}]}}"#), "a.json").unwrap().check();
    assert!(text.errors() > 0, "{text}");
}

#[test]
fn a_model_in_a_group_leaves_its_lights_out_with_a_warning() {
    let objects = r#"{"group": "toys"}, {"group": "toys", "transform": [{"translate": [9, 0, 0]}]}"#;
    let scene = scene_with(objects, &format!(r#", "groups": {{"toys": [{STILL}]}}"#)).unwrap();
    let text = scene.check().to_string();
    assert!(text.contains("the model's lights are left out"), "{text}");
    assert_eq!(scene.compile().unwrap().world.geometry_stats().shapes, 4);
}

#[test]
fn clips_move_objects_lights_and_cameras_between_frames_and_while_the_shutter_is_open() {
    let shutter = r#", "render": {"shutter": [0, 1]}, "animation": {"frames": 30, "frames_per_second": 10}"#;
    let model = r#"{"model": {"file": "walk.toy"}, "transform": [{"rotate": {"axis": [0, 1, 0], "degrees": 180}}]}"#;
    let scene = scene_with(model, shutter).unwrap();
    assert!(scene.depends_on_time());
    let later = scene.at_frame(10.0).unwrap();
    assert!((points(&later)[0] - Vec3::new(-1.0, 5.0, 0.0)).length() < 1e-5);
    assert_ne!(scene.fingerprint(), later.fingerprint());
    let compiled = later.compile().unwrap();
    assert_eq!(compiled.camera_keys.len(), 17);
    // The ball of radius 1 moves from x = -1 to -1.1, and the one at the origin is still.
    assert!((compiled.bounds.min.x + 2.1).abs() < 1e-4 && (compiled.bounds.max.x - 1.0).abs() < 1e-4);
    assert!(compiled.world.lights().iter().any(juggler_world::SceneLight::moves));
    let fixed = r#"{"model": {"file": "walk.toy", "at": 0.5}}"#;
    let fixed = scene_with(fixed, shutter).unwrap();
    assert!(!fixed.depends_on_time());
    assert_eq!(fixed.compile().unwrap().camera_keys.len(), 0);
    assert_eq!(points(&fixed), [Vec3::new(0.5, 5.0, 0.0)]);
    let half = scene_with(r#"{"model": {"file": "walk.toy", "at": "=seconds / 2"}}"#, shutter).unwrap();
    assert!(half.depends_on_time());
    assert_eq!(points(&half.at_frame(10.0).unwrap()), [Vec3::new(0.5, 5.0, 0.0)]);
    assert_eq!(half.compile().unwrap().camera_keys.len(), 17);
    let rest = scene_with(r#"{"model": {"file": "walk.toy", "animation": "none"}}"#, shutter).unwrap();
    assert!(!rest.depends_on_time());
}

#[test]
fn fingerprints_tell_files_choices_and_times() {
    let models = [
        STILL,
        r#"{"model": {"file": "still.toy", "variant": 0}}"#,
        r#"{"model": {"file": "walk.toy"}}"#,
        r#"{"model": {"file": "walk.toy", "at": 1}}"#,
    ];
    let mut prints: Vec<String> = models.map(|model| scene(model).unwrap().fingerprint().hash()).to_vec();
    prints.sort();
    prints.dedup();
    assert_eq!(prints.len(), models.len());
    assert_eq!(scene(STILL).unwrap().fingerprint(), scene(STILL).unwrap().fingerprint());
}

#[test]
fn scenes_with_models_are_written_as_they_were_read() {
    let model = r#"{"model": {"file": "still.toy", "variant": "a", "animation": 0, "at": "=seconds", "repeat": "once", "materials": {"Fur": "x"}, "nodes": ["Head"], "hide": ["Foot"], "lights": false, "photometric": true}}"#;
    let scene = scene_with(model, r#", "materials": {"x": {"diffuse": {}}}"#).unwrap();
    let written: serde_json::Value = serde_json::from_str(&scene.to_json()).unwrap();
    let expected: serde_json::Value = serde_json::from_str(model).unwrap();
    assert_eq!(written["objects"][0], expected);
    assert_eq!(
        serde_json::from_str::<serde_json::Value>(&super::models::scene(STILL).unwrap().to_json()).unwrap()["objects"]
            [0]["model"]["file"],
        "still.toy"
    );
}

#[test]
fn a_model_file_is_a_scene_and_is_read_again_when_its_files_change() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.toy");
    fs::write(&path, "toy\nclip\nextra.bin\n").unwrap();
    let error = LOADER.load(&path).unwrap_err().to_string();
    assert!(error.contains("a.toy: /files/0: extra.bin: no such file"), "{error}");
    fs::write(folder.path().join("extra.bin"), "1").unwrap();
    let scene = LOADER.load(&path).unwrap();
    let description = &scene.description;
    assert_eq!((description.title.as_str(), description.render.size), ("a", [960, 480]));
    assert_eq!((description.animation.frames, description.render.samples), (60, 64));
    assert!(description.background.is_some());
    let paths = scene.paths();
    assert!(paths.contains(&path) && paths.contains(&folder.path().join("extra.bin")), "{paths:?}");
    assert!(scene.check().errors() == 0, "{}", scene.check());
    assert_eq!(scene.compile().unwrap().cameras[0].0, "a/Eye");
    let before = scene.fingerprint();
    fs::write(folder.path().join("extra.bin"), "22").unwrap();
    assert_ne!(scene.reload(&path).unwrap().fingerprint(), before);
    let inner = folder.path().join("inner");
    fs::create_dir(&inner).unwrap();
    let saved = inner.join("a.json");
    let beside = folder.path().join("scene.json");
    fs::write(&beside, r#"{"version": 1, "objects": [{"model": {"file": "a.toy"}}]}"#).unwrap();
    fs::write(&saved, LOADER.load(&beside).unwrap().to_json_in(&inner)).unwrap();
    assert!(fs::read_to_string(&saved).unwrap().contains("\"../a.toy\""));
    assert_eq!(LOADER.load(&saved).unwrap().compile().unwrap().bounds, scene.compile().unwrap().bounds);
    fs::write(&path, "toy\nlit\n").unwrap();
    // Beside the light of the file, the studio is dimmed to a tenth of its irradiance, which is 1 here.
    let scene = LOADER.load(&path).unwrap();
    let background = serde_json::to_value(&scene.description.background).unwrap();
    assert_eq!(background.pointer("/studio/scale").and_then(serde_json::Value::as_f64), Some(f64::from(0.032_f32)));
    let report = scene.check().to_string();
    assert!(report.contains("lights of its own, so the studio around it is dimmed to 0.032"), "{report}");
    assert!(Scene::load(Path::new(&path)).is_err());
}

#[test]
fn an_edit_of_a_scene_with_models_compiles_to_the_same_as_anew() {
    let scene = scene(STILL).unwrap();
    let compiled = scene.compile().unwrap();
    let mut edited = scene.clone();
    edited.description.title = "other".into();
    assert!(edited.has_world_of(&scene));
    let after = edited.compile_after(&scene, &compiled).unwrap();
    assert_eq!(after.bounds, compiled.bounds);
    let mut other = scene.clone();
    if let Some(model) = other.description.objects[0].model.as_mut() {
        model.hide = vec!["Head".into()];
    }
    assert!(!other.has_world_of(&scene));
    assert_eq!(other.compile_after(&scene, &compiled).unwrap().world.geometry_stats().shapes, 1);
    assert_ne!(other, scene);
}
