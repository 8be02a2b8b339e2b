//! Light, backdrop, floor, turntable and camera around a model or mesh.

use juggler::camera::AnyCamera;
use juggler::math::{Rgb, Vec3};
use juggler::render::Control;
use juggler::stage::{Backdrop, Floor, StageLight, default_camera};
use juggler::{Error, Settings, Stage};
use juggler_scene::Scene;
use std::path::{Path, PathBuf};

/// A tetrahedron around (3, 1, 0), 2 units high, as an OBJ.
fn mesh(folder: &Path) -> PathBuf {
    let path = folder.join("solid.obj");
    let text = "v 2 0 -1\nv 4 0 -1\nv 3 0 1\nv 3 2 0\nf 1 2 3\nf 1 4 2\nf 2 4 3\nf 3 4 1\n";
    std::fs::write(&path, text).unwrap();
    path
}

fn loaded() -> (tempfile::TempDir, Scene) {
    let folder = tempfile::tempdir().unwrap();
    let scene = juggler::loader().load(mesh(folder.path())).unwrap();
    (folder, scene)
}

fn json(scene: &Scene, pointer: &str) -> serde_json::Value {
    scene.to_value().pointer(pointer).cloned().unwrap_or_default()
}

fn numbers(value: &serde_json::Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect()
}

fn camera(scene: &Scene) -> AnyCamera {
    scene.compile().unwrap().cameras.remove(0).1
}

/// Share of the rows and of the columns in which the mesh shows: its alpha in a transparent picture.
fn shares(scene: &Scene, size: [u32; 2]) -> [f64; 2] {
    let stage = Stage { backdrop: Some(Backdrop::Transparent), floor: Some(Floor::None), ..Stage::default() };
    let scene = stage.apply(scene).unwrap();
    let settings = Settings { size: Some(size), samples: Some(16), ..Settings::default() };
    let picture = juggler::Picture::new(&scene, &settings).unwrap();
    let image = picture.render_in_memory(None, &Control::default()).unwrap();
    let alpha = image.alpha().unwrap();
    let [width, height] = size.map(|edge| edge as usize);
    let shows = |x: usize, y: usize| alpha[y * width + x] > 0.0;
    let columns = (0..width).filter(|x| (0..height).any(|y| shows(*x, y))).count();
    let rows = (0..height).filter(|y| (0..width).any(|x| shows(x, *y))).count();
    [columns as f64 / width as f64, rows as f64 / height as f64]
}

#[test]
fn the_default_camera_fills_80_percent_of_pictures_of_any_shape() {
    let (_folder, scene) = loaded();
    for size in [[80, 60], [60, 90], [120, 40]] {
        let [across, along] = shares(&scene, size);
        let most = across.max(along);
        assert!((0.76..=0.86).contains(&most), "{size:?}: {across} {along}");
    }
}

#[test]
fn sides_and_fit_place_the_camera() {
    let (_folder, scene) = loaded();
    let directions = [("left", Vec3::NEG_X), ("top", Vec3::Y), ("front", Vec3::Z)];
    for (name, towards_camera) in directions {
        let stage = Stage { towards_camera: Some(towards_camera), fill: Some(0.5), ..Stage::default() };
        let staged = stage.apply(&scene).unwrap();
        let axes = camera(&staged).axes().unwrap();
        assert!(axes.forward.distance(-towards_camera) < 1e-2, "{name}: {:?}", axes.forward);
        let [across, along] = shares(&staged, [80, 60]);
        assert!((0.44..=0.56).contains(&across.max(along)), "{name}: {across} {along}");
    }
}

#[test]
fn eye_and_look_at_are_taken_as_they_are() {
    let (_folder, scene) = loaded();
    let (eye, look_at) = (Some(Vec3::new(3.0, 9.0, 0.0)), Some(Vec3::new(3.0, 1.0, 0.0)));
    // Straight from above, the camera needs another direction up.
    let stage = Stage { eye, look_at, vertical_fov_degrees: Some(50.0), ..Stage::default() };
    let staged = stage.apply(&scene).unwrap();
    let camera = json(&staged, "/camera/perspective");
    assert_eq!(numbers(&camera["eye"]), [3.0, 9.0, 0.0]);
    assert_eq!(numbers(&camera["look_at"]), [3.0, 1.0, 0.0]);
    assert_eq!(camera["vertical_fov_degrees"].as_f64(), Some(50.0));
    assert!(staged.compile().is_ok());
    let only_eye = Stage { look_at: None, ..stage }.apply(&scene).unwrap();
    assert_eq!(numbers(&json(&only_eye, "/camera/perspective/look_at")), [3.0, 1.0, 0.0]);
}

#[test]
fn environments_replace_the_light_of_a_mesh() {
    let (_folder, scene) = loaded();
    assert_eq!(scene.description.lights.len(), 1);
    for (light, kind) in
        [(StageLight::Studio, "studio"), (StageLight::Sky, "sky"), (StageLight::File("a.hdr".into()), "environment")]
    {
        let staged = Stage { environment: Some(light), ..Stage::default() }.apply(&scene).unwrap();
        assert!(staged.description.lights.is_empty());
        assert!(json(&staged, "/background").get(kind).is_some(), "{kind}");
    }
}

/// A color behind a picture has its own levels, whatever the tone curve; the mesh covers the middle.
#[test]
fn a_backdrop_has_its_own_color() {
    let (folder, scene) = loaded();
    let color = Rgb::from_css("#80c0ff").unwrap();
    let stage = Stage { backdrop: Some(Backdrop::Color(color)), floor: Some(Floor::None), ..Stage::default() };
    let staged = stage.apply(&scene).unwrap();
    let settings = Settings { size: Some([24, 16]), samples: Some(4), dither: Some(false), ..Settings::default() };
    for (name, curve) in [("a.png", "agx"), ("b.png", "srgb"), ("c.webp", "pbr_neutral")] {
        let path = folder.path().join(name);
        let curve = Some(juggler::by_name("tone curve", curve).unwrap());
        juggler::render_to_file(&staged, &Settings { curve, ..settings.clone() }, &path).unwrap();
        let image = juggler::imaging::read_with_alpha(&path).unwrap();
        assert_eq!(image.alpha, None, "{name}");
        let difference = (image.colors.pixels()[0] - color).map(f32::abs).max_channel();
        assert!(difference < 1e-6, "{name}: {difference}");
        assert_ne!(image.colors.pixels()[8 * 24 + 12], image.colors.pixels()[0], "{name}");
    }
}

#[test]
fn floors_stand_below_models_and_catch_shadows() {
    let (folder, scene) = loaded();
    let shadow = Stage { floor: Some(Floor::Shadow), ..Stage::default() };
    let staged = shadow.apply(&scene).unwrap();
    assert_eq!((staged.description.objects.len(), staged.description.objects[1].shadow_catcher), (2, true));
    let none = Stage { floor: Some(Floor::None), ..Stage::default() }.apply(&scene).unwrap();
    assert_eq!(none.description.objects.len(), 1);
    // A model has no floor of its own.
    let model = juggler::loader().load(triangle(folder.path())).unwrap();
    let staged = shadow.apply(&model).unwrap();
    let height = json(&staged, "/objects/1/transform/0/translate/1").as_f64().unwrap();
    assert!(height < 1.0 && height > 0.999, "{height}");
    assert!(staged.compile().unwrap().world.moves() == model.compile().unwrap().world.moves());
}

/// A glTF file of a triangle with corners (0, 1, 0), (1, 1, 0) and (0, 2, 0).
fn triangle(folder: &Path) -> PathBuf {
    let corners: [f32; 9] = [0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 0.0, 2.0, 0.0];
    let bytes: Vec<u8> = corners.into_iter().flat_map(f32::to_le_bytes).collect();
    std::fs::write(folder.join("triangle.bin"), bytes).unwrap();
    let text = r#"{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "buffers": [{"uri": "triangle.bin", "byteLength": 36}], "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3,
            "min": [0, 1, 0], "max": [1, 2, 0]}]}"#;
    let path = folder.join("triangle.gltf");
    std::fs::write(&path, text).unwrap();
    path
}

/// All frames of a turn show the whole mesh, and the turn ends where it began.
#[test]
fn turntables_turn_about_the_middle_and_keep_everything_in_the_picture() {
    let (_folder, scene) = loaded();
    let staged = Stage { turntable: Some(8), ..Stage::default() }.apply(&scene).unwrap();
    assert_eq!(staged.description.animation.frames, 8);
    let bounds = |frame: f64| staged.at_frame(frame).unwrap().compile().unwrap().bounds;
    assert!(bounds(0.0).center().distance(Vec3::new(3.0, 1.0, 0.0)) < 1e-3);
    assert!(bounds(8.0).min.distance(bounds(0.0).min) < 1e-3);
    assert!(bounds(1.0).min.distance(bounds(0.0).min) > 0.01 || bounds(1.0).max.distance(bounds(0.0).max) > 0.01);
    for frame in 0..8 {
        let shown = staged.at_frame(f64::from(frame)).unwrap();
        let [across, along] = shares(&shown, [60, 60]);
        assert!(across.max(along) <= 0.86, "{frame}: {across} {along}");
    }
    assert_eq!(camera(&staged.at_frame(3.0).unwrap()), camera(&staged));
}

#[test]
fn choices_for_models_are_refused_for_scenes() {
    let text = r#"{"version": 1, "objects": [{"shape": "sphere"}]}"#;
    let scene = Scene::from_json(text, "scene.json").unwrap();
    for (stage, setting) in [
        (Stage { environment: Some(StageLight::Sky), ..Stage::default() }, "environment"),
        (Stage { floor: Some(Floor::Solid), ..Stage::default() }, "floor"),
        (Stage { turntable: Some(5), ..Stage::default() }, "turntable"),
        (Stage { fill: Some(1.5), ..Stage::default() }, "fill"),
        (Stage { eye: Some(Vec3::NAN), ..Stage::default() }, "eye"),
    ] {
        let error = stage.apply(&scene).unwrap_err();
        assert!(matches!(&error, Error::Settings { setting: own, .. } if own == setting), "{error}");
    }
    // Cameras and backdrops are for all scenes.
    let stage = Stage { towards_camera: Some(Vec3::X), backdrop: Some(Backdrop::Transparent), ..Stage::default() };
    assert!(stage.apply(&scene).unwrap().compile().is_ok());
}

/// No number panics: a stage is refused, or gives a scene that is compiled or refused.
#[test]
fn extreme_numbers_are_refused_or_shown() {
    let (_folder, scene) = loaded();
    let numbers = [0.0, -0.0, 1e-45, 1e-38, 1e-3, 1.0, -7.5, 1e10, 3.4e38, f32::INFINITY, f32::NAN];
    let mut random = juggler::math::testing::Random::new(66);
    let mut shown = 0;
    for _ in 0..300 {
        let mut number = || numbers[random.below(numbers.len())];
        let mut some = || (number() >= 1.0).then(&mut number);
        let stage = Stage {
            vertical_fov_degrees: some(),
            fill: some(),
            eye: some().map(|x| Vec3::new(x, 1.0, x)),
            look_at: some().map(|y| Vec3::new(0.0, y, 1.0)),
            towards_camera: some().map(|z| Vec3::new(z, z, 1e-3)),
            turntable: some().map(|frames| frames as u32),
            ..Stage::default()
        };
        shown += u32::from(stage.apply(&scene).is_ok_and(|staged| staged.compile().is_ok()));
    }
    assert!(shown > 20, "{shown}");
}

/// The camera that `convert` writes is the one of the picture, to the bit.
#[test]
fn the_default_camera_is_that_of_the_picture() {
    let (_folder, scene) = loaded();
    assert_eq!(default_camera(&scene).unwrap(), Some(camera(&scene)));
    let text = r#"{"version": 1, "camera": {"perspective": {}}, "objects": [{"shape": "sphere"}]}"#;
    assert_eq!(default_camera(&Scene::from_json(text, "scene.json").unwrap()).unwrap(), None);
}
