//! Motion compared with closed forms: tracks, paths, joints, vector variables, visibility.

#![expect(clippy::needless_pass_by_value, reason = "values are written where they are passed")]

use juggler_scene::animate::{depends_on_time, resolve};
use juggler_scene::document::{Node, Sources};
use juggler_scene::{Object, Scene, SceneError};
use juggler_shape::Sphere;
use serde_json::{Value, json};
use std::f64::consts::TAU;

/// Value of `form` at a time in seconds, in a scene with the members `more`.
fn value_in(more: Value, form: Value, seconds: f64) -> Value {
    let mut tree = json!({"version": 1, "animation": {"frames": 100, "frames_per_second": 4}, "here": form});
    tree.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
    let (resolved, findings) = resolve(&Node::from(tree), &Sources::default(), 4.0 * seconds);
    assert!(findings.is_empty(), "{findings:?}");
    resolved.get("here").unwrap().to_json()
}

fn value(form: Value, seconds: f64) -> Value {
    value_in(json!({}), form, seconds)
}

fn number(form: &Value, seconds: f64) -> f64 {
    value(form.clone(), seconds).as_f64().unwrap()
}

fn vector(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect()
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

#[track_caller]
fn near(found: f64, expected: f64) {
    assert!((found - expected).abs() < 1e-9, "{found} is not {expected}");
}

#[test]
fn keys_are_interpolated_and_lines_are_straight() {
    let form = json!({"animate": {"keys": [[0, 1], [2, 5], [3, -1]]}});
    for (seconds, expected) in [(-9.0, 1.0), (0.0, 1.0), (0.5, 2.0), (2.0, 5.0), (2.5, 2.0), (3.0, -1.0), (99.0, -1.0)]
    {
        near(number(&form, seconds), expected);
    }
    let vectors = json!({"animate": {"keys": [[0, [[0, 1], [2, 3]]], [1, [[10, 1], [4, 5]]]]}});
    assert_eq!(value(vectors, 0.5), json!([[5, 1], [3, 4]]));
}

#[test]
fn time_can_be_moved_stretched_and_counted_in_frames() {
    let keys = json!([[0, 0], [10, 10]]);
    for (at, expected) in [("=seconds-0.5", 1.5), ("=2*seconds", 4.0), ("=frame", 8.0), ("=frames / 20", 5.0)] {
        near(number(&json!({"animate": {"keys": keys, "at": at}}), 2.0), expected);
    }
}

#[test]
fn loops_and_ping_pongs_fold_time() {
    let keys = json!([[1, 0], [3, 20]]);
    let at = |repeat: &str, seconds: f64| number(&json!({"animate": {"keys": keys, "repeat": repeat}}), seconds);
    for (seconds, looped, ping_pong) in [
        (1.0, 0.0, 0.0),
        (2.0, 10.0, 10.0),
        (3.0, 0.0, 20.0),
        (3.5, 5.0, 15.0),
        (5.5, 5.0, 5.0),
        (0.5, 15.0, 5.0),
        (-4.5, 5.0, 15.0),
    ] {
        near(at("loop", seconds), looped);
        near(at("ping_pong", seconds), ping_pong);
        near(at("once", seconds), ((seconds - 1.0) * 10.0).clamp(0.0, 20.0));
    }
    for repeat in ["once", "loop", "ping_pong"] {
        for interpolation in ["step", "linear", "smooth"] {
            let one = json!({"animate": {"keys": [[2, 7]], "repeat": repeat, "interpolation": interpolation}});
            assert_eq!([-1.0, 2.0, 1e6].map(|seconds| number(&one, seconds)), [7.0; 3]);
        }
        assert!((0.0..=20.0).contains(&at(repeat, 1e18)) && (0.0..=20.0).contains(&at(repeat, -1e300)));
    }
}

#[test]
fn step_interpolation_accepts_values_of_any_type() {
    let keys = json!([[0, "near"], [1, {"sphere": {"radius": "=1+1"}}], [2, [true, null]]]);
    let form = json!({"animate": {"keys": keys, "interpolation": "step"}});
    assert_eq!(value(form.clone(), 0.99), json!("near"));
    assert_eq!(value(form.clone(), 1.0), json!({"sphere": {"radius": 2}}));
    assert_eq!(value(form, 7.0), json!([true, null]));
    let mixed = json!({"animate": {"keys": [[0, 0, "step"], [1, 10], [2, 20]]}});
    assert_eq!([0.9, 1.0, 1.5].map(|seconds| number(&mixed, seconds)), [0.0, 10.0, 15.0]);
}

#[test]
fn colors_are_interpolated_in_linear_space() {
    let form = json!({"animate": {"keys": [[0, "#ff0000"], [1, "#0000ff"], [2, [0, 1, 1]]]}});
    assert_eq!(value(form.clone(), 0.5), json!([0.5, 0, 0.5]));
    assert_eq!(value(form.clone(), 1.5), json!([0, 0.5, 1]));
    let grey = json!({"animate": {"keys": [[0, "#808080"], [1, "#808080"]]}});
    assert!(vector(&value(grey, 0.3)).iter().all(|channel| (channel - 0.215_860_5).abs() < 1e-6));
    let scene = json!({"version": 1, "background": form, "objects": [{"shape": "sphere"}]}).to_string();
    assert!(Scene::from_json(scene, "a.json").unwrap().at_frame(15.0).unwrap().compile().is_ok());
}

#[test]
fn ease_is_that_of_css() {
    let eased = |ease: Value| number(&json!({"animate": {"keys": [[0, 0], [2, 10]], "ease": ease}}), 1.0);
    assert!((eased(json!("in")) - 3.153_568_1).abs() < 1e-6);
    assert!((eased(json!("out")) - 6.846_431_9).abs() < 1e-6);
    near(eased(json!("in_out")), 5.0);
    near(eased(json!([0.25, 0.1, 0.25, 1.0])).round(), 8.0);
    let own = json!({"animate": {"keys": [[0, 0, "linear"], [2, 10], [4, 0]], "ease": "in"}});
    near(number(&own, 1.0), 5.0);
    assert!((number(&own, 3.0) - 6.846_431_9).abs() < 1e-6, "a key's own ease goes before that of all");
}

/// Halfway between evenly spaced keys, against the matrix of Catmull and Rom.
#[test]
fn smooth_is_catmull_rom() {
    let values = [0.0, 1.0, -2.0, 5.0, 3.0];
    let keys: Vec<Value> = values.iter().enumerate().map(|(i, value)| json!([i, value])).collect();
    let form = json!({"animate": {"keys": keys, "interpolation": "smooth"}});
    for (i, value) in values.iter().enumerate() {
        near(number(&form, i as f64), *value);
    }
    for i in 1..3 {
        let [p0, p1, p2, p3] = [values[i - 1], values[i], values[i + 1], values[i + 2]];
        for u in [0.25, 0.5, 0.75] {
            let expected = 0.5
                * (2.0 * p1
                    + (p2 - p0) * u
                    + (2.0 * p0 - 5.0 * p1 + 4.0 * p2 - p3) * u * u
                    + (3.0 * p1 - p0 - 3.0 * p2 + p3) * u * u * u);
            near(number(&form, i as f64 + u), expected);
        }
    }
}

/// One-sided derivatives by finite differences.
fn speeds(form: &Value, seconds: f64) -> [f64; 2] {
    let step = 1e-5;
    let at = |seconds: f64| number(form, seconds);
    [(at(seconds) - at(seconds - step)) / step, (at(seconds + step) - at(seconds)) / step]
}

#[test]
fn smooth_has_no_corners_at_keys_nor_at_seams() {
    let keys = json!([[0.0, 1.0], [0.3, 4.0], [1.7, -2.0], [2.0, 0.5], [3.0, 1.0]]);
    for repeat in ["once", "loop", "ping_pong"] {
        let form = json!({"animate": {"keys": keys, "interpolation": "smooth", "repeat": repeat}});
        for key in [0.0, 0.3, 1.7, 2.0, 3.0, 6.0, -3.0] {
            let [before, after] = speeds(&form, key);
            assert!((before - after).abs() < 5e-3, "{repeat} at {key}: {before} and {after}");
        }
    }
    let seam = json!({"animate": {"keys": keys, "interpolation": "smooth", "repeat": "loop"}});
    assert!(speeds(&seam, 3.0)[0].abs() > 0.1, "a loop goes through its seam, it does not stop there");
    let line = json!({"animate": {"keys": [[0, 0], [1, 1], [3, 3], [7, 7], [8, 8]], "interpolation": "smooth"}});
    near(number(&line, 2.2), 2.2);
}

#[test]
fn slerp_rotates_at_constant_speed_along_the_shorter_arc() {
    let turn = |degrees: f64| json!({"axis": [0, 0, 2], "degrees": degrees});
    let form = |to: f64| json!({"animate": {"keys": [[0, [0, 0, 0, 3]], [1, turn(to)]], "interpolation": "slerp"}});
    for (to, shorter) in [(90.0, 90.0), (200.0, -160.0), (-30.0, -30.0)] {
        for share in [0.0, 0.125, 0.5, 0.9, 1.0] {
            let found = vector(&value(form(to), share));
            let half = (share * shorter / 2.0_f64).to_radians();
            let expected = [0.0, 0.0, half.sin(), half.cos()];
            let opposite = expected.map(|number| -number);
            assert!(distance(&found, &expected).min(distance(&found, &opposite)) < 1e-12, "{to} {share}: {found:?}");
        }
    }
}

#[test]
fn objects_go_along_paths_at_an_even_speed() {
    let circle: Vec<Value> =
        (0..64).map(|i| f64::from(i) / 64.0 * TAU).map(|a| json!([3.0 * a.cos(), 0.0, 3.0 * a.sin()])).collect();
    let paths =
        json!({"paths": {"ring": {"points": circle, "closed": true}, "line": {"points": [[0, 0, 0], [4, 0, 0]]}}});
    let at = |path: &str, share: f64| {
        vector(&value_in(paths.clone(), json!({"along": {"path": path, "at": "=seconds"}}), share))
    };
    let points: Vec<_> = (0..=100).map(|i| at("ring", f64::from(i) / 100.0)).collect();
    let steps: Vec<f64> = points.windows(2).map(|pair| distance(&pair[0], &pair[1])).collect();
    for step in &steps {
        assert!((step - 2.0 * 3.0 * (TAU / 200.0).sin()).abs() < 1e-5, "{step}");
    }
    assert!(distance(&at("ring", 0.3), &at("ring", 5.3)) < 1e-9);
    assert_eq!([-1.0, 0.5, 7.0].map(|share| at("line", share)[0].round()), [0.0, 2.0, 4.0]);
    let tiny = json!({"paths": {"dot": {"points": [[0, 0, 0], [1e-300, 0, 0], [1e-45, 0, 0]], "closed": true}}});
    assert!(vector(&value_in(tiny, json!({"along": {"path": "dot", "at": 0.4}}), 0.0))[0] < 1e-40);
}

#[test]
fn joints_keep_the_lengths_of_bones() {
    let bones = json!({"from": [0, "=seconds", 0], "to": [1, 4, 1], "lengths": [3, 2], "plane_normal": [1, 0, 3]});
    for seconds in [0.5, 1.0, 2.0] {
        let joint = vector(&value(json!({"joint": bones}), seconds));
        near(distance(&joint, &[0.0, seconds, 0.0]), 3.0);
        near(distance(&joint, &[1.0, 4.0, 1.0]), 2.0);
    }
    // The limb's spheres meet at the joint too.
    let limb = r#"{"version": 1, "objects": [{"limb": {"from": [0, 1, 0], "to": [1, 4, 1], "lengths": [3, 2],
        "plane_normal": [1, 0, 3], "radii": [1, 1, 1]}}]}"#;
    let limb = Scene::from_json(limb, "a.json").unwrap().description.objects[0].limb.clone().unwrap();
    let joint = vector(&value(json!({"joint": bones}), 1.0));
    let sphere = limb.spheres().unwrap()[8].center.as_dvec3().to_array();
    assert!(distance(&joint, &sphere) < 1e-6);
}

#[test]
fn variables_are_vectors_too() {
    let variables = json!({"variables": {
        "one": [5],
        "ball": ["frame", "=one.x - 2", {"animate": {"keys": [[0, 0], [1, 8]]}}],
        "copy": "ball",
        "red": {"animate": {"keys": [[0, "#ff0000"]]}},
        "size": {"animate": {"keys": [[0, 1], [1, 3]]}},
        "far": "ball.x + 10 * ball.y + 100 * copy.z"
    }});
    let at = |form: Value| value_in(variables.clone(), form, 0.5);
    assert_eq!(at(json!("=ball")), json!([2, 3, 4]));
    assert_eq!(at(json!("= copy ")), json!([2, 3, 4]));
    assert_eq!(at(json!(["=far", "=size", "=red.x - red.z"])), json!([432, 2, 1]));
    assert_eq!(at(json!({"animate": {"keys": [["=one.x", "=ball"], [7, [0, 1, 2]]], "at": 6}})), json!([1, 2, 3]));
}

#[test]
fn camera_and_followers_share_a_variable() {
    let text = r#"{"version": 1, "animation": {"frames": 10, "frames_per_second": 5},
        "paths": {"way": {"points": [[0, 0, 0], [0, 0, 4]]}},
        "variables": {"ball": {"along": {"path": "way", "at": "=seconds / 2"}}},
        "camera": {"perspective": {"eye": [9, 2, 0], "look_at": "=ball"}},
        "objects": [{"shape": "sphere", "transform": [{"translate": "=ball"}]},
            {"shape": "cuboid", "transform": [{"look_at": {"from": [5, 0, 2], "to": "=ball"}}]}]}"#;
    let scene = Scene::from_json(text, "a.json").unwrap().at_frame(5.0).unwrap();
    assert_eq!(scene.to_value()["camera"]["perspective"]["look_at"], json!("=ball"), "a scene is written as it moves");
    let json = scene.still().to_value();
    assert_eq!(json["camera"]["perspective"]["look_at"], json!([0, 0, 2]));
    assert_eq!(json["objects"][0]["transform"][0]["translate"], json!([0, 0, 2]));
    let place = scene.description.objects[1].transform[0].transform().unwrap();
    assert!((place.vector(juggler_math::Vec3::Z) + juggler_math::Vec3::X).length() < 1e-6, "it faces the ball");
    assert_eq!(json.get("paths"), None, "a still scene is written without paths");
    assert!(scene.compile().is_ok());
}

#[test]
fn invisible_objects_are_not_compiled() {
    let text = r#"{"version": 1, "animation": {"frames": 4, "frames_per_second": 1},
        "groups": {"pair": [{"shape": "sphere"}, {"shape": "sphere", "visible": false}]},
        "objects": [{"shape": "sphere", "visible": "=frame < 2"}, {"group": "pair", "visible": "=frame"},
            {"objects": [{"shape": "sphere"}, {"group": "pair"}], "visible": {"animate": {
                "keys": [[0, true], [3, false]], "interpolation": "step"}}}]}"#;
    let scene = Scene::from_json(text, "a.json").unwrap();
    let shapes = |frame: f64| scene.at_frame(frame).unwrap().compile().unwrap().world.geometry_stats().shapes;
    assert_eq!([0.0, 1.0, 2.0, 3.0].map(shapes), [3, 4, 3, 1]);
    assert_eq!(scene.at_frame(2.0).unwrap().needs().objects, 3);
    let built = Scene::new().add(Object::new(Sphere::default())).add(Object::new(Sphere::default()).visible(false));
    assert_eq!(built.compile().unwrap().world.geometry_stats().shapes, 1);
}

/// Invisible objects are not expanded: a billion of them cost nothing.
#[test]
fn invisible_groups_are_not_expanded() -> Result<(), SceneError> {
    let ten = |group: &str| Value::from(vec![json!({"group": group, "visible": 0}); 10]);
    let mut groups = serde_json::Map::new();
    groups.insert("g0".into(), json!([{"shape": "sphere"}]));
    (1..40).for_each(|i| drop(groups.insert(format!("g{i}"), ten(&format!("g{}", i - 1)))));
    groups.insert("me".into(), json!([{"group": "me", "visible": false}]));
    let scene =
        json!({"version": 1, "groups": groups, "objects": [{"group": "g39"}, {"group": "me"}, {"shape": "sphere"}]});
    assert_eq!(Scene::from_json(scene.to_string(), "a.json")?.compile()?.world.geometry_stats().shapes, 1);
    Ok(())
}

#[test]
fn keys_of_name_maps_are_not_value_forms() {
    let text = r#"{"version": 1, "groups": {"joint": [{"shape": "sphere"}]}, "materials": {"animate": {"phong": {}}},
        "textures": {"along": "checker"}, "objects": [{"group": "joint", "material": "animate"}]}"#;
    assert!(Scene::from_json(text, "a.json").unwrap().compile().is_ok());
}

#[test]
fn subtrees_without_motion_are_shared() {
    let tree = Node::from(
        json!({"version": 1, "objects": [1, 2], "paths": {"a": {"points": [[0, 0, 0]]}}, "moving": ["=frame"]}),
    );
    let (resolved, _) = resolve(&tree, &Sources::default(), 3.0);
    let elements = |tree: &Node, key: &str| tree.get(key).unwrap().elements().as_ptr();
    assert_eq!(elements(&tree, "objects"), elements(&resolved, "objects"));
    assert_ne!(elements(&tree, "moving"), elements(&resolved, "moving"));
}

#[test]
fn time_dependence_of_values_is_detected() {
    let keys = json!([[0, 1], [1, 2]]);
    for (depends, variables, here) in [
        (false, json!({}), json!(["=2*pi", "frame", 3])),
        (true, json!({}), json!({"radius": "=frame"})),
        (true, json!({"a": "2 * seconds", "b": ["1", "a"]}), json!("=b.x")),
        (false, json!({"a": "2 * seconds"}), json!("=frames")),
        (true, json!({}), json!({"animate": {"keys": keys}})),
        (false, json!({}), json!({"animate": {"keys": keys, "at": 0.5}})),
        (true, json!({"t": {"animate": {"keys": keys}}}), json!({"animate": {"keys": keys, "at": "=t"}})),
        (true, json!({}), json!({"along": {"path": "a", "at": "=seconds"}})),
    ] {
        let tree = Node::from(json!({"version": 1, "title": "=frame", "variables": variables, "here": here}));
        assert_eq!(depends_on_time(&tree), depends, "{variables} {here}");
    }
    assert!(Scene::built_in("juggler").unwrap().depends_on_time());
    assert!(!Scene::built_in("chess").unwrap().depends_on_time());
}

#[test]
fn survey_lists_animated_values() {
    let text = r#"{"version": 1, "animation": {"frames": 4, "frames_per_second": 1},
        "paths": {"way": {"points": [[0, 0, 0], [1, 0, "=frame"]]}}, "variables": {"t": "seconds / 2", "still": "=2*pi"},
        "objects": [{"shape": {"sphere": {"radius": {"animate": {"keys": [[1, 1], [4, 2]], "interpolation": "smooth",
            "repeat": "ping_pong", "at": "=t"}}}}, "transform": [{"translate": {"along": {"path": "way", "at": "=t"}}}]}]}"#;
    let survey = Scene::from_json(text, "a.json").unwrap().survey();
    assert_eq!(survey.expressions, 4);
    let forms: Vec<_> = survey.forms.iter().map(|track| (track.path.to_string(), track.kind.as_str())).collect();
    assert_eq!(
        forms,
        [("objects[0].shape.sphere.radius".into(), "animate"), ("objects[0].transform[0].translate".into(), "along")]
    );
    let track = &survey.forms[0];
    assert_eq!((track.keys, track.time_range), (Some(2), Some([1.0, 4.0])));
    assert_eq!(survey.forms[1].along.as_deref(), Some("way"));
}

#[test]
fn paths_of_included_files_belong_to_the_scene() {
    let file = |name: &str, text: &str| (name.to_owned(), text.as_bytes().to_vec());
    let paths = file("paths.json", r#"{"version": 1, "paths": {"way": {"points": [[1, 0, 0], [3, 0, 0]]}}}"#);
    let main = |more: &str| {
        let text = r#"{"version": 1, "include": "paths.json", MORE "objects": [{"shape": "sphere",
            "transform": [{"translate": {"along": {"path": "way", "at": 0.5}}}]}]}"#;
        Scene::from_bundle(
            [file("main.json", &text.replace("MORE", more)), paths.clone()].into_iter().collect(),
            "main.json",
        )
    };
    assert_eq!(main("").unwrap().still().to_value()["objects"][0]["transform"][0]["translate"], json!([2, 0, 0]));
    let twice = main(r#""paths": {"way": {"points": [[0, 0, 0]]}},"#).unwrap_err().to_string();
    assert!(twice.contains("`way` in `paths` is already defined"), "{twice}");
}

#[test]
fn numeric_visibility_becomes_a_boolean() {
    let scene = |visible: &str| {
        let text = format!(r#"{{"version": 1, "objects": [{{"shape": "sphere", "visible": {visible}}}]}}"#);
        Scene::from_json(text, "a.json").unwrap().fingerprint()
    };
    assert_eq!(scene("true"), scene("\"=1/3\""));
    assert_eq!(scene("false"), scene("0"));
    assert_ne!(scene("true"), scene("false"));
}

/// Tracks move items while the shutter is open; tracks evaluated at a constant time do not move.
#[test]
fn tracks_move_items_while_the_shutter_is_open() {
    let moves = |at: &str, shutter: &str| {
        let text = format!(
            r#"{{"version": 1, "animation": {{"frames": 8, "frames_per_second": 4}}, "render": {{"shutter": {shutter}}},
            "objects": [{{"shape": "sphere", "transform": [{{"translate":
                {{"animate": {{"keys": [[0, [0, 0, 0]], [1, [4, 0, 0]]] {at}}}}}}}]}}]}}"#
        );
        let scene = Scene::from_json(text, "a.json").unwrap();
        assert!(scene.compile().is_ok());
        scene.fingerprint().parts().contains_key("motion")
    };
    assert!(moves("", "[0, 0.5]") && moves(", \"at\": \"=frame / 4\"", "[0, 0.5]"));
    assert!(!moves("", "[0, 0]") && !moves(", \"at\": 0.5", "[0, 0.5]"));
}

/// Extreme numbers of keys and points are evaluated in bounded time.
#[test]
fn many_keys_and_points_are_read_at_each_frame() {
    let keys: Vec<Value> = (0..50_000).map(|i| json!([i, [i, 0, 0]])).collect();
    let form = json!({"animate": {"keys": keys, "interpolation": "smooth"}});
    assert!((vector(&value(form, 20_000.5))[0] - 20_000.5).abs() < 1e-6);
    let points: Vec<Value> = (0..10_000).map(|i| json!([i, i % 7, 0])).collect();
    let paths = json!({"paths": {"long": {"points": points}}});
    assert!(vector(&value_in(paths, json!({"along": {"path": "long", "at": 0.5}}), 0.0))[0] > 4000.0);
}
