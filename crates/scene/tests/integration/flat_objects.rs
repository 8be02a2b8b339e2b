//! Objects whose animated scale is 0 at some frames: they are absent there.

use juggler_scene::Scene;
use serde_json::json;

fn scene(objects: &str) -> Scene {
    let scene = format!(
        r#"{{"version": 1, "animation": {{"frames": 9, "frames_per_second": 8}}, "objects": [{objects},
            {{"shape": {{"sphere": {{"radius": 0.5}}}}, "transform": {{"translate": [5, 0, 0]}}}}]}}"#
    );
    Scene::from_json(scene, "flat.json").unwrap_or_else(|error| panic!("{error}"))
}

/// Number of shapes, and the largest x coordinate of the first shape.
fn shapes(scene: &Scene) -> (u64, f32) {
    let world = scene.compile().unwrap_or_else(|error| panic!("{error}")).world;
    (world.geometry_stats().shapes, world.shape_bounds(0).max.x)
}

const GROWING: &str =
    r#"{"shape": {"sphere": {}}, "transform": [{"scale": "=seconds"}, {"translate": [0, "=seconds", 0]}]}"#;

#[test]
fn an_object_is_absent_at_frames_where_its_animated_scale_is_0() {
    let first = scene(GROWING);
    assert_eq!(shapes(&first), (1, 5.5));
    let later = first.at_frame(4.0).unwrap();
    assert_eq!(shapes(&later), (2, 0.5));
    assert_eq!(shapes(&later.at_frame(0.0).unwrap()), (1, 5.5), "and absent again");
    let along_one_axis = r#"{"shape": {"cuboid": {"min": [0, 0, 0], "max": [1, 1, 1]}}, "transform": {"scale": [1, "=1 - seconds", 1]}}"#;
    assert_eq!(shapes(&scene(along_one_axis)), (2, 1.0));
    assert_eq!(shapes(&scene(along_one_axis).at_frame(8.0).unwrap()), (1, 5.5));
}

#[test]
fn children_and_groups_are_absent_with_a_flat_parent() {
    let parent = format!(
        r#"{{"objects": [{GROWING}, {{"shape": {{"sphere": {{}}}}}}], "transform": {{"scale": "=seconds - 0.5"}}}}"#
    );
    assert_eq!(shapes(&scene(&parent).at_frame(4.0).unwrap()), (1, 5.5));
    assert_eq!(shapes(&scene(&parent)).0, 2, "only one child is flat");
    assert_eq!(shapes(&scene(&parent).at_frame(8.0).unwrap()).0, 3);
}

#[test]
fn a_constant_scale_of_0_is_an_error() {
    for transform in [r#"[{"scale": 0}]"#, r#"[{"scale": [1, 0, 1]}]"#] {
        let wrong = scene(&format!(r#"{{"shape": {{"sphere": {{}}}}, "transform": {transform}}}"#)).check().to_string();
        assert!(wrong.contains("`scale` must not be 0"), "{wrong}");
    }
}

/// While the shutter is open, the object grows from nothing.
#[test]
fn an_object_grows_from_nothing_while_the_shutter_is_open() {
    let text = scene(GROWING).at_frame(8.0).unwrap().with_value("/render/shutter", json!([-8.0, 0.0])).unwrap();
    let world = text.compile().unwrap().world;
    let bounds = world.shape_bounds(0);
    assert!(world.moves() && (bounds.min.y - 0.0).abs() < 1e-4 && (bounds.max.y - 2.0).abs() < 1e-4, "{bounds:?}");
}
