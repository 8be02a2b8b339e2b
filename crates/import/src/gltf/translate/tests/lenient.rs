//! Content that other readers accept: it is left out or placed, with a warning.

use super::*;

fn has_warning(parts: &ModelParts, text: &str) -> bool {
    parts.warnings.iter().any(|warning| warning.contains(text))
}

#[test]
fn meshes_without_area_are_left_out_beside_good_ones() {
    let mut builder = triangle();
    builder.floats("VEC3", 3, &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 2.0, 0.0, 0.0]);
    builder.member(
        r#""meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}, {"primitives": [{"attributes": {"POSITION": 1}}]}],
            "scenes": [{"nodes": [0, 1]}], "nodes": [{"mesh": 0, "name": "Good"}, {"mesh": 1, "name": "Line"}]"#,
    );
    let found = parts(&builder);
    let names: Vec<_> = found.objects.iter().filter_map(|object| object.name.as_deref()).collect();
    assert_eq!(names, ["Good"]);
    let text = "/meshes/1/primitives/0: has no triangle with an area and is left out";
    assert!(has_warning(&found, text), "{:?}", found.warnings);
}

/// A triangle whose morph target moves all corners to the origin, weighted by the time.
fn collapsing() -> Builder {
    let mut builder = triangle();
    builder.floats("VEC3", 3, &[0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0]);
    builder.floats("SCALAR", 1, &[0.0, 1.0]);
    builder.floats("SCALAR", 1, &[0.0, 1.0]);
    builder.member(
        r#""meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "targets": [{"POSITION": 1}]}]}],
            "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}], "animations": [{"samplers": [{"input": 2, "output": 3}],
            "channels": [{"sampler": 0, "target": {"node": 0, "path": "weights"}}]}]"#,
    );
    builder
}

#[test]
fn parts_that_a_morph_target_collapses_are_hidden_at_that_time() {
    let model = open(&collapsing());
    let visible =
        |seconds| parts_at(&model, seconds).objects.iter().map(|object| object.is_visible()).collect::<Vec<_>>();
    assert_eq!([0.0, 0.5, 1.0].map(visible), [[true], [true], [false]]);
    assert!(has_warning(&parts_at(&model, 1.0), "the pose leaves no triangle with an area"));
    assert!(!has_warning(&parts_at(&model, 0.5), "the pose leaves"));
}

#[test]
fn parts_that_a_joint_collapses_are_hidden() {
    let found = parts(&animation::skinned(r#""scale": [0, 0, 0]"#));
    assert_eq!(found.objects.iter().map(|object| object.is_visible()).collect::<Vec<_>>(), [false]);
}

#[test]
fn listed_nodes_with_a_parent_are_shown_once_at_their_place() {
    let file = |listed: &str| {
        let mut builder = triangle();
        builder.member(r#""meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}]"#);
        builder.member(format!(
            r#""scenes": [{{"nodes": {listed}}}], "nodes": [{{"name": "Root", "children": [1], "translation": [5, 0, 0]}},
                {{"name": "Inner", "mesh": 0, "translation": [0, 2, 0]}}]"#
        ));
        parts(&builder)
    };
    for (listed, name) in [("[0]", "Root/Inner"), ("[0, 1]", "Root/Inner"), ("[1, 0]", "Root/Inner"), ("[1]", "Inner")]
    {
        let found = file(listed);
        let [object] = found.objects.as_slice() else { panic!("{listed}: {found:?}") };
        assert_eq!(object.name.as_deref(), Some(name), "{listed}");
        assert_eq!([rows(object)[3], rows(object)[7]], [5.0, 2.0], "{listed}");
    }
}

#[test]
fn lights_of_unknown_kinds_are_left_out() {
    let mut builder = triangle();
    builder.member(
        r#""extensionsUsed": ["KHR_lights_punctual"], "extensions": {"KHR_lights_punctual": {"lights":
            [{"type": "area"}, {"type": "point"}]}}, "scenes": [{"nodes": [0, 1]}], "nodes":
            [{"extensions": {"KHR_lights_punctual": {"light": 0}}}, {"extensions": {"KHR_lights_punctual": {"light": 1}}}]"#,
    );
    let found = parts(&builder);
    assert_eq!(found.lights.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>(), ["node 1"]);
    assert!(has_warning(&found, "lights/0/type: the kind of the light is not known"), "{:?}", found.warnings);
}

#[test]
fn pointer_channels_without_their_object_have_no_effect() {
    let mut builder = triangle();
    builder.floats("SCALAR", 1, &[0.0, 1.0]);
    builder.member(r#""meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "scenes": [{"nodes": [0]}]"#);
    builder.member(
        r#""nodes": [{"mesh": 0}], "animations": [{"samplers": [{"input": 1, "output": 1}],
            "channels": [{"sampler": 0, "target": {"path": "pointer"}}]}]"#,
    );
    let found = parts(&builder);
    assert_eq!(found.objects.len(), 1);
    assert!(has_warning(&found, "has no `KHR_animation_pointer`"), "{:?}", found.warnings);
}

#[test]
fn the_end_of_a_clip_shows_its_end() {
    let model = open(&animation::moving());
    let x = |seconds| rows(&parts_at(&model, seconds).objects[0])[3];
    assert_eq!([1.0, 2.0, 2.5].map(x), [2.0, 4.0, 1.0]);
}
