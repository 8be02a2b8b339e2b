//! Scenes as values: changes by programs are checked, take effect at every frame, and survive
//! writing and reading.

use super::mutations::Numbers;
use juggler_material::{AnyMaterial, MaterialRef, Phong};
use juggler_math::Vec3;
use juggler_scene::description::{GroupName, Visible};
use juggler_scene::{Object, Scene, SceneError, TransformStep, built_in_scenes};
use juggler_shape::{Mesh, Shape, Sphere};
use serde_json::{Value, json};

const MOVING: &str = r#"{"version": 1, "animation": {"frames": 8, "frames_per_second": 4},
    "variables": {"height": "1 + frame", "wide": 2},
    "paths": {"way": {"points": [[0, 0, 0], [0, "=height", 4]]}},
    "render": {"shutter": [0, 0.5], "size": [16, 16]},
    "camera": {"perspective": {"eye": [0, 2, "=9 + frame"], "look_at": [0, 0, 0]}},
    "textures": {"spots": {"checker": {"even": ["=frame / 8", 0, 0]}}},
    "materials": {"red": {"phong": {"diffuse": ["=0.1 * frame", 0, 0]}},
        "inlaid": {"principled": {"base_color": {"checker": {"odd": [0, "=frame / 10", 0]}},
            "roughness": {"noise": {"scale": "=wide"}}}}},
    "groups": {"pair": [{"shape": "sphere"}, {"shape": "cuboid", "transform": {"translate": ["=frame", 0, 0]}}]},
    "lights": [{"point": {"position": [0, 5, "=frame"], "intensity": 9}}],
    "objects": [
        {"shape": {"sphere": {"radius": "=wide"}}, "transform": {"translate": [0, "=height", 0]}, "material": "red"},
        {"group": "pair", "transform": [{"scale": "=wide"}, {"translate": [3, 0, 0]}]},
        {"objects": [{"shape": "disk"}, {"shape": "sphere", "transform": [{"translate": {"along": {"path": "way",
            "at": "=seconds / 2"}}}]}], "material": "inlaid"},
        {"shape": "cuboid", "visible": "=frame < 4"}]}"#;

fn moving() -> Scene {
    Scene::from_json(MOVING, "moving.json").unwrap()
}

/// The scene written, read again and advanced to a frame.
fn again(scene: &Scene, frame: f64) -> Scene {
    Scene::from_json(scene.to_json(), "again.json").and_then(|scene| scene.at_frame(frame)).unwrap_or_else(|error| {
        panic!("{error}\n{}", scene.to_json());
    })
}

/// Asserts that a scene and its written and reread copy have equal fingerprints at three frames.
fn assert_is_one(scene: &Scene, what: &str) {
    for frame in [0.0, 2.5, 5.0] {
        let there = scene.at_frame(frame).unwrap();
        assert!(there.compile().is_ok(), "{what}");
        assert_eq!(there.fingerprint(), again(scene, frame).fingerprint(), "{what} at {frame}");
        assert_eq!(there.at_frame(1.0).unwrap().fingerprint(), again(&there, 1.0).fingerprint(), "{what} from {frame}");
    }
}

#[test]
fn scenes_survive_being_written() {
    assert_is_one(&moving(), "moving");
    for scene in built_in_scenes() {
        let scene = Scene::built_in(scene.name).unwrap();
        let there = scene.at_frame(1.5).unwrap();
        assert_eq!(there.fingerprint(), again(&scene, 1.5).fingerprint(), "{}", scene.description.title);
        assert_eq!(there.still().fingerprint().parts().get("objects"), there.fingerprint().parts().get("objects"));
    }
}

fn place(scene: &Scene, object: usize) -> Vec3 {
    let steps = &scene.description.objects[object].transform;
    steps.iter().find_map(|step| if let TransformStep::Translate(by) = step { Some(*by) } else { None }).unwrap()
}

/// Each of these changes once had no effect or was lost at another frame.
#[test]
fn programmatic_edits_survive_frame_changes() {
    // A moving object that is replaced stands still.
    let mut scene = moving();
    let before = scene.fingerprint();
    scene.description.objects[0] = Object::new(Sphere { radius: 3.0 }).at(1.0, 1.0, 1.0).into();
    assert_ne!(scene.fingerprint(), before);
    assert_eq!(place(&scene.at_frame(4.0).unwrap(), 0), Vec3::ONE);
    assert_is_one(&scene, "replaced");
    // A moving object of which another property is changed moves on.
    let mut scene = moving();
    let material = Some(MaterialRef::from(Phong::default()));
    scene.description.objects[0].material.clone_from(&material);
    let later = scene.at_frame(4.0).unwrap();
    assert_eq!((place(&later, 0), &later.description.objects[0].material), (Vec3::new(0.0, 5.0, 0.0), &material));
    assert_is_one(&scene, "other material");
    // A moving property that is changed stands still; all else moves on.
    let mut scene = moving();
    scene.description.objects[0].transform = vec![TransformStep::Translate(Vec3::Z)];
    scene = scene.with_value("/variables/wide", json!(5)).unwrap();
    let later = scene.at_frame(4.0).unwrap();
    assert_eq!(place(&later, 0), Vec3::Z);
    assert_eq!(later.description.objects[0].shape, Some(Sphere { radius: 5.0 }.into()));
    assert_is_one(&scene, "other place");
}

#[test]
fn edits_anywhere_in_a_scene_survive_frame_changes() {
    // Moving objects may change their positions in the list.
    let mut scene = moving();
    scene.description.objects.remove(1);
    scene.description.objects.insert(0, Object::new(Sphere::default()).into());
    assert_eq!(place(&scene.at_frame(4.0).unwrap(), 1), Vec3::new(0.0, 5.0, 0.0));
    assert_is_one(&scene, "moved in the list");
    // Nested objects, groups, lights, settings and materials may change.
    let mut scene = moving();
    scene.description.objects[2].objects.as_mut().unwrap()[1].visible = Visible(false);
    scene.description.groups["pair"][1].name = Some("block".into());
    let light = scene.description.lights[0].clone();
    scene.description.lights.push(light);
    scene.description.render.samples = 3;
    *scene.description.materials["red"] = AnyMaterial::from(Phong::default());
    let later = scene.at_frame(3.0).unwrap();
    assert!(!later.description.objects[2].inner()[1].is_visible());
    assert_eq!((later.description.lights.len(), later.description.render.samples), (2, 3));
    assert_is_one(&scene, "everywhere");
}

/// Edits by a program are rejected for the same reasons as JSON text.
#[test]
fn programmatic_edits_are_validated() {
    let refused = |change: &dyn Fn(&mut Scene), path: &str, words: &str| {
        let mut scene = moving();
        change(&mut scene);
        let problems = scene.check();
        let found = problems.list().iter().any(|problem| problem.path == path && problem.message.contains(words));
        assert!(found && scene.compile().is_err() && problems.errors() > 0, "{path}: {problems}");
    };
    refused(
        &|scene| scene.description.objects[3].group = Some(GroupName("none".into())),
        "objects[3]",
        "exactly one of",
    );
    refused(
        &|scene| scene.description.objects[3].material = Some(MaterialRef::Name("none".into())),
        "objects[3].material",
        "no material",
    );
    refused(
        &|scene| drop(scene.description.materials.shift_remove("red")),
        "objects[0].material",
        "no material is called `red`",
    );
    refused(&|scene| drop(scene.description.groups.shift_remove("pair")), "objects[1].group", "no group");
    refused(&|scene| scene.description.render.samples = 0, "render.samples", "between 1");
    refused(&|scene| scene.description.animation.frames = 0, "animation.frames", "between 1");
    refused(
        &|scene| scene.description.objects[0].shape = Some(Sphere { radius: -1.0 }.into()),
        "objects[0].shape.sphere.radius",
        "greater than 0",
    );
    refused(
        &|scene| {
            scene.description.objects[2].objects.as_mut().unwrap()[0].shape = Some(Sphere { radius: f32::NAN }.into());
        },
        "objects[2].objects[0].shape.sphere.radius",
        "not finite",
    );
}

/// Items that have passed validation are validated again when they or the names of the scene change.
#[test]
fn validated_items_are_validated_again_after_changes() {
    let object = Object::new(Sphere::default()).material_named("paint");
    let scene = Scene::new().material("paint", Phong::default()).add(object);
    assert!(scene.compile().is_ok() && scene.compile().is_ok());
    let mut unnamed = scene.clone();
    unnamed.description.materials.shift_remove("paint");
    assert!(unnamed.compile().is_err() && scene.compile().is_ok());
    let mut renamed = unnamed.clone();
    renamed.description.materials.insert("paint".into(), AnyMaterial::from(Phong::default()).into());
    assert!(renamed.compile().is_ok());
    let mut edited = scene.clone();
    edited.description.objects[0].shape = Some(Sphere { radius: -1.0 }.into());
    assert!(edited.compile().is_err() && scene.compile().is_ok());
    edited.description.objects[0].shape = Some(Sphere::default().into());
    assert!(edited.compile().is_ok());
}

#[test]
fn copies_share_unchanged_items() {
    let scene = moving();
    let mut copy = scene.clone();
    copy.description.objects[3].name = Some("mine".into());
    let (own, other) = (&scene.description, &copy.description);
    assert!(own.objects[2].is_same(&other.objects[2]) && !own.objects[3].is_same(&other.objects[3]));
    assert!(own.materials.is_same(&other.materials) && own.objects[3].name.is_none());
    let later = scene.at_frame(3.0).unwrap();
    assert!(own.textures["spots"] != later.description.textures["spots"]);
    assert!(own.groups["pair"][0].is_same(&later.description.groups["pair"][0]));
}

/// Scenes with different prepared meshes once had the same fingerprint.
#[test]
fn prepared_meshes_have_fingerprints_of_their_own() {
    let scene = |x: f32| {
        let mut mesh = Mesh::from_triangles([Vec3::ZERO, Vec3::new(x, 0.0, 0.0), Vec3::Y], [[0, 1, 2]]);
        mesh.prepare().unwrap();
        Scene::new().add(Object::new(mesh))
    };
    assert_ne!(scene(1.0).fingerprint(), scene(2.0).fingerprint());
    assert_eq!(scene(1.0).fingerprint(), again(&scene(1.0), 0.0).fingerprint());
    assert_eq!(scene(1.0).compile().unwrap().world.geometry_stats().triangles, 1);
}

/// Collects the JSON pointers of all values in a scene.
fn places(json: &Value, at: &str, found: &mut Vec<String>) {
    found.push(at.to_owned());
    match json {
        Value::Object(members) => members.iter().for_each(|(key, member)| {
            places(member, &format!("{at}/{}", key.replace('~', "~0").replace('/', "~1")), found);
        }),
        Value::Array(elements) => {
            elements.iter().enumerate().for_each(|(i, element)| places(element, &format!("{at}/{i}"), found));
        }
        _ => {}
    }
}

/// Sets the value at a JSON pointer; null removes it.
fn put(json: &mut Value, pointer: &str, value: &Value) {
    let (outer, last) = pointer.rsplit_once('/').unwrap();
    let last = last.replace("~1", "/").replace("~0", "~");
    match json.pointer_mut(outer) {
        Some(Value::Object(members)) if value.is_null() => drop(members.shift_remove(&last)),
        Some(Value::Object(members)) => drop(members.insert(last, value.clone())),
        Some(Value::Array(elements)) if value.is_null() => drop(elements.remove(last.parse().unwrap())),
        Some(Value::Array(elements)) => elements[last.parse::<usize>().unwrap()] = value.clone(),
        _ => unreachable!("{pointer}"),
    }
}

/// An edited scene equals the scene written with the edit, and both are rejected alike.
#[test]
fn edited_scenes_equal_scenes_parsed_with_the_edit() {
    let mut numbers = Numbers(38);
    let texts = [MOVING, built_in_scenes().iter().find(|scene| scene.name == "sphere-triangle-shadow").unwrap().json];
    let (mut same, mut refused) = (0, 0);
    for round in 0..600 {
        let scene = Scene::from_json(texts[round % texts.len()], "edited.json").unwrap();
        let json = scene.to_value();
        let mut known = Vec::new();
        places(&json, "", &mut known);
        // Leave out the version and the whole scene.
        known.retain(|place| !place.is_empty() && place != "/version");
        let place = &known[numbers.below(known.len())];
        let value = match numbers.below(6) {
            0 => Value::Null,
            1 => json!(numbers.below(9)),
            2 => json!("=0.5 + frame / 10"),
            3 => json!({"animate": {"keys": [[0, 1], [2, 3]]}}),
            4 => json.pointer(&known[numbers.below(known.len())]).unwrap().clone(),
            _ => json!([numbers.below(3), "=wide", 1]),
        };
        let mut written = json.clone();
        put(&mut written, place, &value);
        let edited = scene.with_value(place, value.clone());
        let anew = Scene::from_json(written.to_string(), "anew.json");
        let what = format!("{round}: {place} = {value}");
        match (edited, anew) {
            (Ok(edited), Ok(anew)) => {
                for frame in [0.0, 3.5] {
                    let both = [&edited, &anew].map(|scene| scene.at_frame(frame).map(|there| there.fingerprint()));
                    let [edited, anew] = both.map(|found| found.map_err(|error| error.to_string()));
                    assert_eq!(edited.as_ref().ok(), anew.as_ref().ok(), "{what} at {frame}\n{edited:?}\n{anew:?}");
                }
                same += 1;
            }
            (Err(_), Err(_)) => refused += 1,
            (edited, anew) => panic!("{what}\nedited: {:?}\nanew: {:?}", edited.err(), anew.err()),
        }
    }
    assert!(same > 100 && refused > 100, "{same} {refused}");
}

/// A scene of `count` objects, each on its own line, and `last`.
fn long(count: usize, last: &str) -> Result<Scene, SceneError> {
    let ball = |i: usize| match i % 500 {
        7 => r#"{"shape": {"sphere": {"radius": "=1 + frame"}}, "material": "red"}"#.to_owned(),
        8 => r#"{"objects": [{"shape": "disk", "material": {"phong": {"diffuse": {"checker": {}}}}}]}"#.to_owned(),
        _ => format!(r#"{{"shape": "sphere", "transform": {{"translate": [{i}, 0, 0]}}, "name": "b{i}"}}"#),
    };
    let balls: Vec<String> = (0..count).map(ball).chain([last.to_owned()]).collect();
    let head = r#"{"version": 1, "animation": {"frames": 9}, "materials": {"red": {"phong": {}}},"#;
    Scene::from_json(format!("{head}\n\"objects\": [{}]}}", balls.join(",\n")), "long.json")
}

/// A long list, which is parsed in chunks, gives the same scene as a short one.
#[test]
fn long_and_short_lists_give_the_same_scene() {
    let [long, short] = [2500, 600].map(|count| long(count, r#"{"shape": "plane"}"#).unwrap());
    for frame in [0.0, 2.5] {
        let [long, short] = [&long, &short].map(|scene| scene.at_frame(frame).unwrap().description);
        assert_eq!((long.objects.len(), short.objects.len()), (2501, 601));
        assert_eq!(long.objects[..600], short.objects[..600]);
    }
    assert_is_one(&long, "long");
}

/// Errors in long lists are reported as in short ones, with their places.
#[test]
fn mistakes_in_long_lists_have_their_places() {
    for (wrong, path, words) in [
        (r#"{"shape": "spere"}"#, "objects[N].shape", "unknown kind"),
        (r#"{"shape": {"sphere": {"radius": "=r"}}}"#, "objects[N].shape.sphere.radius", "`r`"),
        (r#"{"shape": "sphere", "material": "blue"}"#, "objects[N].material", "no material"),
        (r#"{"shape": "sphere", "shape": "disk"}"#, "objects[N].shape", "duplicate key"),
        (r#"{"shape": {"mesh": {"file": "none.obj"}}}"#, "objects[N].shape.mesh.file", "none.obj"),
        (r#"{"shape": "sphere" "name": 3}"#, "", "missing"),
    ] {
        let first_error = |count: usize| {
            let problems = match long(count, wrong) {
                Ok(scene) => scene.check(),
                Err(SceneError::Problems(problems)) => problems,
                Err(error) => panic!("{error}"),
            };
            let problem = problems.list()[0].clone();
            let line = problems.render(false).lines().nth(1).unwrap_or_default().to_owned();
            assert!(line.contains(&format!("long.json:{}:", count + 2)), "{line}");
            (problem.path.replace(&count.to_string(), "N"), problem.message)
        };
        assert_eq!(first_error(2500), first_error(600));
        let (found, message) = first_error(2500);
        assert!(found == path && message.contains(words), "{found}: {message}");
    }
}

/// Numbers of moving transforms are set in the deserialized objects; deserializing the objects'
/// JSON gives the same bits.
#[test]
fn animated_transforms_equal_their_deserialized_json() {
    let steps = [
        r#"{"translate": ["=frame / 3", 1, "=-sin(frame) * wide"]}"#,
        r#"{"rotate": {"axis": [0, "=1 + frame / 7", 0.5], "degrees": "=frame * 10.1"}}"#,
        r#"{"scale": "=1 + frame / 9"}"#,
        r#"{"scale": [1, "=2 + frame", "=0.1 * wide"]}"#,
        r#"{"orient": [0, "=sin(frame)", 0, "=cos(frame)"]}"#,
        r#"{"look_at": {"from": ["=frame", 1, 2], "to": [0, "=-frame", 0], "up": [0, 1, "=frame / 8"], "forward": ["=0.1 + frame", 0, 1]}}"#,
        r#"{"matrix": [1, 0, 0, "=frame", 0, "=1 + frame", 0, 0, 0, 0, 1, "=0 * -frame"]}"#,
        // A vector and a track are deserialized.
        r#"{"translate": "=place"}"#,
        r#"{"translate": {"animate": {"keys": [[0, [0, 0, 0]], [3, [1, "=frame", 2]]]}}}"#,
    ];
    let object = |transform: String| format!(r#"{{"shape": "sphere", "transform": {transform}}}"#);
    let mut objects: Vec<String> = steps.iter().map(|step| object((*step).to_owned())).collect();
    objects.push(object(format!("[{}]", steps.join(", "))));
    objects.push(format!(r#"{{"objects": [{}, {{"shape": "disk"}}]}}"#, objects[0]));
    let text = format!(
        r#"{{"version": 1, "variables": {{"wide": 2, "place": [1, "frame * 2", 3]}}, "groups": {{"g": [{}]}},
            "render": {{"shutter": [0, 0.5]}}, "objects": [{}]}}"#,
        objects[1],
        objects.join(", ")
    );
    let scene = Scene::from_json(text, "moving.json").unwrap();
    for frame in [0.0, 1.0, 2.5, -7.25] {
        let there = scene.at_frame(frame).unwrap();
        // Change a variable, so that all moving items are deserialized again.
        let read = there.with_value("/variables/other", json!(1)).unwrap();
        assert_eq!(there.description.objects, read.description.objects, "at {frame}");
        assert_eq!(there.description.groups, read.description.groups, "at {frame}");
        assert_eq!(there.still().fingerprint(), read.still().fingerprint());
    }
    let [grown, still] = [7, 8].map(|i| scene.at_frame(1.0).unwrap().description.objects[i].transform.clone());
    assert_eq!(grown, [TransformStep::Translate(Vec3::new(1.0, 2.0, 3.0))]);
    assert_ne!(still, grown);
    // A number too large for 32 bits is rejected with its place.
    let text =
        r#"{"version": 1, "objects": [{"shape": "sphere", "transform": {"translate": ["=1e39 * frame", 0, 0]}}]}"#;
    let error = Scene::from_json(text, "huge.json").unwrap().at_frame(1.0).unwrap_err().to_string();
    assert!(error.contains("objects[0].transform"), "{error}");
}

/// Static items are shared by all frames and not evaluated while the shutter is open.
#[test]
fn frames_share_static_items() {
    let mut scene = long(2500, r#"{"shape": "plane"}"#).unwrap();
    let later = scene.at_frame(3.0).unwrap();
    let same = (0..2501).filter(|i| scene.description.objects[*i].is_same(&later.description.objects[*i]));
    assert_eq!(same.count(), 2501 - 5, "one of five hundred grows");
    scene.description.render.shutter = [0.0, 0.5];
    assert!(scene.compile().unwrap().world.moves() && !later.compile().unwrap().world.moves());
}
