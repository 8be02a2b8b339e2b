use super::*;
use juggler_math::Vec3;
use juggler_scene::model::{AnimationChoice, ModelRepeat, NameOrIndex};

/// A triangle that moves from x = 0 to x = 4 in two seconds, beside one that stays.
pub fn moving() -> Builder {
    let mut builder = triangle();
    builder.floats("SCALAR", 1, &[0.0, 2.0]);
    builder.floats("VEC3", 3, &[0.0, 0.0, 0.0, 4.0, 0.0, 0.0]);
    builder.member(
        r#""meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "scenes": [{"nodes": [0, 1]}],
            "nodes": [{"mesh": 0, "name": "a"}, {"mesh": 0, "name": "b"}],
            "animations": [{"name": "Run", "samplers": [{"input": 1, "output": 2}],
            "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]}]"#,
    );
    builder
}

#[test]
fn clips_move_nodes_and_repeat() {
    let model = open(&moving());
    let x = |choice: &ModelChoice| {
        let found = model.parts(choice, "").unwrap();
        assert_eq!(found.objects[1].transform, [], "the other node stays");
        found.objects[0].transform.first().map_or(0.0, |_| rows(&found.objects[0])[3])
    };
    let at = |seconds, repeat| ModelChoice { seconds, repeat, ..ModelChoice::default() };
    assert_eq!(x(&at(0.5, ModelRepeat::Loop)), 1.0);
    assert_eq!((x(&at(2.5, ModelRepeat::Loop)), x(&at(2.5, ModelRepeat::Once))), (1.0, 4.0));
    assert_eq!(x(&ModelChoice { animation: AnimationChoice::None, ..at(0.5, ModelRepeat::Loop) }), 0.0);
    let summary = model.summary(&ModelChoice::default()).unwrap();
    assert_eq!((summary.clips[0].name.as_str(), summary.clips[0].seconds, summary.clip), ("Run", 2.0, Some(0)));
}

#[test]
fn times_change_values_only_and_share_arrays() {
    let model = open(&moving());
    let [early, late] = [0.0, 1.5].map(|seconds| parts_at(&model, seconds));
    let names = |parts: &ModelParts| parts.objects.iter().map(|object| object.name.clone()).collect::<Vec<_>>();
    assert_eq!(names(&early), names(&late));
    assert!(early.groups.keys().eq(late.groups.keys()) && early.materials.keys().eq(late.materials.keys()));
    let [first, second] = [&early, &late].map(|parts| mesh(&parts.groups["mesh mesh 0"][0]).arrays());
    assert!(Arc::ptr_eq(first, second));
}

#[test]
fn unknown_names_are_errors_with_suggestions() {
    let model = open(&moving());
    let name = |name: &str| NameOrIndex::Name(name.to_owned());
    let choice = ModelChoice {
        animation: AnimationChoice::Clip(name("Rum")),
        scene: Some(NameOrIndex::Index(3)),
        variant: Some(name("red")),
        ..ModelChoice::default()
    };
    let faults = model.parts(&choice, "").unwrap_err().faults;
    assert_eq!(
        faults,
        [
            "a.glb: /scenes: there is no scene 3, there are 1",
            "a.glb: /animations: there is no animation `Rum`; did you mean `Run`?",
            "a.glb: /extensions/KHR_materials_variants/variants: there is no variant `red`; there are none",
        ]
    );
}

/// A triangle of a skin of one joint.
pub fn skinned(joint: &str) -> Builder {
    let mut builder = triangle();
    builder.array(5121, "VEC4", 3, &[0; 12]);
    builder.floats("VEC4", 4, &[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]);
    builder.member(
        r#""meshes": [{"primitives": [{"attributes": {"POSITION": 0, "JOINTS_0": 1, "WEIGHTS_0": 2}}]}],
            "skins": [{"joints": [1]}], "scenes": [{"nodes": [0, 1]}]"#,
    );
    builder.member(format!(r#""nodes": [{{"mesh": 0, "skin": 0, "translation": [9, 9, 9]}}, {{{joint}}}]"#));
    builder
}

#[test]
fn skins_place_vertices_in_world_space() {
    let found = parts(&skinned(r#""translation": [0, 0, 2]"#));
    assert_eq!(found.objects[0].transform, [], "the transform of the node has no effect");
    let arrays = mesh(&found.objects[0]).arrays();
    assert_eq!(arrays.positions, [Vec3::new(0.0, 0.0, 2.0), Vec3::new(1.0, 0.0, 2.0), Vec3::new(0.0, 1.0, 2.0)]);
    assert_eq!(arrays.triangles, [[0, 1, 2]]);
}

#[test]
fn skins_that_reflect_keep_the_front_outside() {
    let found = parts(&skinned(r#""scale": [-1, 1, 1]"#));
    let arrays = mesh(&found.objects[0]).arrays();
    let [a, b, c] = arrays.triangles[0].map(|index| arrays.positions[index as usize]);
    assert_eq!((b - a).cross(c - a).normalize(), Vec3::Z);
}

#[test]
fn morph_targets_move_vertices_by_animated_weights() {
    let mut builder = triangle();
    builder.floats("VEC3", 3, &[0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0]);
    builder.floats("SCALAR", 1, &[0.0, 1.0]);
    builder.floats("SCALAR", 1, &[0.0, 2.0]);
    builder.member(
        r#""meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "targets": [{"POSITION": 1}]}]}],
            "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}], "animations": [{"samplers": [{"input": 2, "output": 3}],
            "channels": [{"sampler": 0, "target": {"node": 0, "path": "weights"}}]}]"#,
    );
    let model = open(&builder);
    let z = |seconds| mesh(&parts_at(&model, seconds).objects[0]).arrays().positions[1].z;
    assert_eq!([0.0, 0.25, 0.5].map(z), [0.0, 0.5, 1.0]);
}
