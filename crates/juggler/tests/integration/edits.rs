//! A scene after random edits, the same scene written and read again, and a picture that is rebuilt
//! edit by edit are one: equal values, fingerprints and pictures at several frames.

use juggler::render::Control;
use juggler::scene::{Object, Scene};
use juggler::{Error, Picture, Settings};
use juggler_material::MaterialRef;
use juggler_math::testing::Random;
use juggler_shape::Sphere;
use serde_json::{Value, json};

const MOVING: &str = r#"{"version": 1, "animation": {"frames": 8, "frames_per_second": 4},
    "variables": {"height": "1 + frame / 8", "wide": 0.8},
    "render": {"size": [16, 12], "samples": 1, "integrator": "path", "shutter": [0, 0.5]},
    "camera": {"perspective": {"eye": [0, 2, "=9 + frame"], "look_at": [0, 1, 0]}}, "background": [0.2, 0.3, 0.5],
    "textures": {"spots": {"checker": {"even": ["=frame / 8", 0.2, 0], "size": 0.7}}},
    "materials": {"red": {"diffuse": {"reflectance": [0.8, "=0.1 * frame", 0.1]}},
        "inlaid": {"principled": {"base_color": "spots", "roughness": {"noise": {"scale": "=wide"}}}},
        "glass": {"dielectric": {"ior": 1.5}}},
    "groups": {"pair": [{"shape": {"sphere": {"radius": 0.6}}, "material": "inlaid"},
        {"shape": "cuboid", "transform": {"translate": ["=1 + frame / 4", 0, 0]}}]},
    "lights": [{"point": {"position": [0, 5, "=frame"], "intensity": 90}}, {"directional": {"direction": [1, -2, -1]}}],
    "objects": [{"shape": "plane", "material": "inlaid"},
        {"shape": {"sphere": {"radius": "=wide"}}, "transform": {"translate": [0, "=height", 0]}, "material": "red"},
        {"group": "pair", "transform": [{"scale": "=wide"}, {"translate": [3, 1, 0]}], "material": "red"},
        {"shape": {"sphere": {"radius": 0.7}}, "transform": {"translate": [-2, 1, 2]}, "material": "glass"}]}"#;

/// Collects the JSON pointers of all numbers, texts and truth values in a scene.
fn leaves(json: &Value, at: &str, found: &mut Vec<String>) {
    match json {
        Value::Object(members) => members.iter().for_each(|(key, value)| leaves(value, &format!("{at}/{key}"), found)),
        Value::Array(elements) => {
            elements.iter().enumerate().for_each(|(i, value)| leaves(value, &format!("{at}/{i}"), found));
        }
        _ => found.push(at.to_owned()),
    }
}

/// Changes one random value by its pointer; `None` if the scene refuses the value.
fn edited_by_pointer(scene: &Scene, random: &mut Random) -> Option<Scene> {
    let mut places = Vec::new();
    leaves(&scene.to_value(), "", &mut places);
    let place = &places[random.below(places.len())];
    let number = random.below(40) as f64 / 20.0;
    let value = match random.below(3) {
        0 => json!(format!("={number} + frame / 10")),
        _ => json!(number),
    };
    let is_bounded = !place.starts_with("/render") && !place.starts_with("/animation") && place != "/version";
    is_bounded.then(|| scene.with_value(place, value).ok()).flatten()
}

/// Changes the fields of the scene's description.
fn edited_by_fields(scene: &Scene, random: &mut Random) -> Scene {
    let mut edited = scene.clone();
    let description = &mut edited.description;
    let (count, x) = (description.objects.len(), random.below(8) as f32 / 2.0 - 2.0);
    match random.below(6) {
        0 => description.objects.push(Object::new(Sphere { radius: 0.5 }).at(x, 1.0, 3.0).into()),
        1 if count > 2 => drop(description.objects.remove(random.below(count))),
        2 => description.objects.swap(random.below(count), random.below(count)),
        3 => description.objects[random.below(count)].material = Some(MaterialRef::Name("glass".to_owned())),
        4 => description.objects.insert(0, Object::new(Sphere { radius: 0.4 }).at(x, 0.5, 4.0).into()),
        _ => {
            let moved = Object::new(Sphere { radius: 0.3 + x.abs() / 4.0 }).at(x, 0.0, 1.0);
            description.objects[random.below(count)].transform = moved.transform;
        }
    }
    edited
}

fn picture_hash(picture: &Picture) -> String {
    picture.render(Default::default(), &Control::default(), |_: &[_]| Ok::<(), Error>(())).unwrap().hash
}

/// Asserts that a scene and its written and reread copy are equal at three frames.
fn assert_round_trip(scene: &Scene, what: &str) {
    let reread = Scene::from_json(scene.to_json(), "reread.json").unwrap_or_else(|error| panic!("{what}: {error}"));
    for frame in [0.0, 1.5, 4.0] {
        // An expression may leave the range of its value, in both scenes, also while the shutter is
        // open.
        let [first, second] = [scene, &reread].map(|scene| scene.at_frame(frame));
        assert_eq!(first.is_ok(), second.is_ok(), "{what} at {frame}");
        let (Ok(first), Ok(second)) = (first, second) else { continue };
        assert!(first == second, "{what} at {frame}: values\n{}", scene.to_json());
        assert_eq!(first.fingerprint(), second.fingerprint(), "{what} at {frame}");
        let pictures = [first, second].map(|scene| Picture::new(&scene, &Settings::default()));
        let [first, second] = pictures.map(|picture| picture.as_ref().map(picture_hash).ok());
        assert_eq!(first, second, "{what} at {frame}\n{}", scene.to_json());
    }
}

#[test]
fn randomly_edited_scenes_survive_writing_and_rebuilding() {
    let settings = Settings::default();
    let mut edits = 0;
    for seed in 0..12 {
        let mut random = Random::new(seed);
        let mut scene = Scene::from_json(MOVING, "moving.json").unwrap();
        let mut picture = Picture::new(&scene, &settings).unwrap();
        for round in 0..6 {
            let edited = match random.below(2) {
                0 => edited_by_pointer(&scene, &mut random),
                _ => Some(edited_by_fields(&scene, &mut random)),
            };
            let Some(edited) = edited else { continue };
            let what = format!("seed {seed}, round {round}");
            let Ok(anew) = Picture::new(&edited, &settings) else { continue };
            picture = picture.rebuild(&scene, &edited, &settings).unwrap();
            assert_eq!(picture_hash(&picture), picture_hash(&anew), "{what}\n{}", edited.to_json());
            scene = edited;
            edits += 1;
        }
        assert_round_trip(&scene, &format!("seed {seed}"));
    }
    assert!(edits > 40, "{edits} edits");
}
