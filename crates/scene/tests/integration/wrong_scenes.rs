//! Invalid scenes with one error each, and the reports about them as reviewed snapshots.

use juggler_scene::{Scene, SceneError};
use std::fs;
use std::path::Path;

/// Report about the scene in `text`, in a folder with the other `files`.
fn report(text: &str, files: &[(&str, &[u8])]) -> String {
    let folder = tempfile::tempdir().unwrap();
    for (name, content) in files {
        fs::write(folder.path().join(name), content).unwrap();
    }
    let path = folder.path().join("scene.json");
    fs::write(&path, text).unwrap();
    complaint(&path).replace(&format!("{}/", folder.path().display()), "")
}

fn complaint(path: &Path) -> String {
    match Scene::load(path).and_then(|scene| scene.compile().map(|compiled| compiled.warnings.to_string())) {
        Ok(warnings) => format!("(renders)\n{warnings}"),
        Err(error) => error.to_string(),
    }
}

/// A scene with one sphere and the members `more`.
fn with(more: &str) -> String {
    format!("{{\n  \"version\": 1,\n  {more},\n  \"objects\": [{{\"shape\": \"sphere\"}}]\n}}")
}

/// A scene with one object.
fn object(object: &str) -> String {
    format!("{{\n  \"version\": 1,\n  \"objects\": [\n    {object}\n  ]\n}}")
}

/// A hundred thousand objects.
const CHAIN: &str = r#"{"chain": {"from": {"center": [0, 0, 0], "radius": 1}, "to": {"center": [1, 0, 0], "radius": 1}, "count": 100000}}"#;

/// Ten placements of a group.
fn ten(group: &str) -> String {
    vec![format!("{{\"group\": \"{group}\"}}"); 10].join(", ")
}

/// A scene with these groups; the last entry is `objects`.
fn groups(groups: &[(&str, &str)]) -> String {
    let lines: Vec<String> = groups.iter().map(|(name, objects)| format!("  \"{name}\": [{objects}]")).collect();
    let (last, groups) = lines.split_last().unwrap();
    format!("{{\"version\": 1, \"groups\": {{\n{}}},\n{last}}}", groups.join(",\n"))
}

/// Seventy nested groups, written from the innermost out, followed by the key of the innermost
/// group.
fn chain_of_groups() -> String {
    let group = |i: u32| format!("\"g{i}\": [{{\"group\": \"g{}\"}}], ", i + 1);
    (0..70).rev().map(group).collect::<String>() + "\"g70\""
}

macro_rules! wrong {
    ($($name:ident: $text:expr;)+) => { $(
        #[test]
        fn $name() {
            insta::assert_snapshot!(report(&$text, &[]));
        }
    )+ };
}

wrong! {
    misspelt_key: object(r#"{"shape": {"sphere": {"raduis": 2}}}"#);
    misspelt_part: r#"{"version": 1, "object": []}"#;
    misspelt_shape_key: object(r#"{"shap": "sphere"}"#);
    wrong_type: object(r#"{"shape": {"sphere": {"radius": "big"}}}"#);
    expression_without_sign: object(r#"{"shape": {"sphere": {"radius": "2 * 3"}}}"#);
    unknown_kind: object(r#"{"shape": {"spere": {}}}"#);
    unknown_kind_far_off: object(r#"{"shape": "teapot"}"#);
    shape_of_another_program: object(r#"{"shape": {"box": {"size": 2}}}"#);
    shape_of_another_program_by_name: object(r#"{"shape": "PlaneGeometry"}"#);
    shape_in_place_of_an_object: object(r#"{"sphere": {"radius": 1}}"#);
    object_with_a_type: object(r##"{"type": "cube", "position": [0, 1, 0], "color": "#f00"}"##);
    material_of_another_program: object(r#"{"shape": "sphere", "material": {"glass": {}}}"#);
    material_by_its_kind_alone: object(r#"{"shape": "sphere", "material": "diffuse"}"#);
    material_by_a_foreign_name: object(r#"{"shape": "sphere", "material": "glass"}"#);
    type_of_another_program: object(r#"{"shape": "sphere", "material": {"type": "roughconductor", "alpha": 0.1}}"#);
    type_that_nobody_knows: object(r#"{"shape": "sphere", "material": {"type": "stuff"}}"#);
    keys_of_another_program: with(r#""camera": {"perspective": {"position": [0, 1, 5], "fov": 40, "aperture": 0.1}}"#);
    settings_of_another_program: with(r#""render": {"width": 640, "height": 360, "spp": 16, "max_depth": 4}"#);
    sections_of_another_program: "{\"version\": 1, \"sensor\": {}, \"bsdfs\": {}, \"objects\": [{\"shape\": \"sphere\"}]}";
    light_of_another_program: with(r#""lights": [{"type": "sun", "direction": [1, -1, 0]}, {"spot": {"angle": 30, "location": [0, 4, 0]}}]"#);
    place_inside_a_shape: object(r#"{"shape": {"sphere": {"radius": 1, "center": [0, 1, 0]}}}"#);
    two_steps_in_one: object(r#"{"shape": "sphere", "transform": {"scale": 2, "translate": [0, 1, 0]}}"#);
    single_step_by_zero: object(r#"{"shape": "sphere", "transform": {"scale": [1, 0, 1]}}"#);
    levels_for_a_color: with(r#""background": [255, 128, 0], "materials": {"red": {"phong": {"diffuse": [255, 0, 0]}}}"#);
    levels_for_a_reflectance: object(r#"{"shape": "sphere", "material": {"plastic": {"reflectance": [200, 40, 40]}}}"#);
    type_as_a_key: object(r#"{"shape": {"type": "sphere", "radius": 1}}"#);
    kind_that_needs_more: object(r#"{"shape": "polygon"}"#);
    unknown_material: "{\"version\": 1, \"materials\": {\"gold\": {\"phong\": {}}},\n \"objects\": [{\"shape\": \"sphere\", \"material\": \"glod\"}]}";
    unknown_metal: object(r#"{"shape": "sphere", "material": {"conductor": {"metal": "alumnium"}}}"#);
    unknown_texture: with(r#""materials": {"red": {"phong": {"diffuse": "marble"}}}"#);
    unknown_texture_in_a_texture: with(r#""textures": {"planks": {"wood": {"light": "plancks"}}}"#);
    texture_circle: with(r#""textures": {"a": {"mix": {"b": "b"}}, "b": {"ramp": {"stops": [{"position": 0, "color": "a"}]}}}"#);
    mortar_wider_than_the_brick: with(r#""textures": {"wall": {"brick": {"width": 0.2, "mortar_width": 0.3}}}"#);
    texture_without_scale: with(r#""textures": {"wall": {"noise": {"scale": [1, 0, 1]}}}"#);
    unknown_group: object(r#"{"group": "pawn"}"#);
    unknown_camera: with(r#""render": {"camera": "mian"}, "cameras": {"main": {"perspective": {"eye": [0, 0, 9]}}}"#);
    not_a_number_by_expression: object(r#"{"shape": {"sphere": {"radius": "=sqrt(1 - frames*2)"}}}"#);
    infinite_by_expression: object(r#"{"shape": "sphere", "transform": [{"translate": [0, "=1/frame", 0]}]}"#);
    unknown_name_in_expression: with(r#""variables": {"phi": "2*pi*fram/frames"}"#);
    bad_expression: object(r#"{"shape": {"sphere": {"radius": "=2 * (1 + frame"}}}"#);
    variable_that_is_taken: with(r#""variables": {"sin": 1}"#);
    variable_used_too_early: with(r#""variables": {"a": "b + 1", "b": 2}"#);
    negative_radius: object(r#"{"shape": {"sphere": {"radius": -1}}}"#);
    radius_too_small_for_32_bits: object(r#"{"shape": {"sphere": {"radius": 1e-60}}}"#);
    number_too_large: object(r#"{"shape": "sphere", "transform": [{"translate": [1e300, 0, 0]}]}"#);
    number_out_of_all_bounds: object(r#"{"shape": {"sphere": {"radius": 1e999}}}"#);
    vector_of_two: object(r#"{"shape": "sphere", "transform": [{"translate": [1, 2]}]}"#);
    missing_include: with(r#""include": ["materials.json"]"#);
    group_circle: "{\"version\": 1, \"groups\": {\"a\": [{\"group\": \"b\"}], \"b\": [{\"group\": \"a\"}]},\n \"objects\": [{\"group\": \"a\"}]}";
    group_in_itself: "{\"version\": 1, \"groups\": {\"a\": [{\"group\": \"a\"}]}, \"objects\": []}";
    material_circle: with(r#""materials": {"a": {"checkerboard": {"even": "a", "odd": "a"}}}"#);
    chain_too_long: object(r#"{"objects": [{"chain": {"from": {"center": [0, 0, 0], "radius": 1}, "to": {"center": [1, 0, 0], "radius": 1}, "count": 100001}}]}"#);
    too_many_objects: groups(&[("b", CHAIN), ("c", &ten("b")), ("d", &ten("c")), ("e", &ten("d")), ("a", &ten("e")), ("objects", &ten("a"))]);
    too_many_objects_in_memory: object(&[CHAIN; 41].join(",\n"));
    groups_nested_too_deep: groups(&[("g70", CHAIN), ("objects", r#"{"group": "g0"}"#)]).replace("\"g70\"", &chain_of_groups());
    missing_mesh: object(r#"{"shape": {"mesh": {"file": "models/cow.ply"}}}"#);
    mesh_from_nothing: object(r#"{"shape": {"mesh": {}}}"#);
    missing_version: r#"{"objects": [{"shape": "sphere"}]}"#;
    bad_version: r#"{"version": 2, "objects": []}"#;
    empty_file: "";
    only_a_comment: "// nothing yet\n";
    not_an_object: "[1, 2]";
    deep_nesting: format!("{{\"version\": 1, \"objects\": {}", "[".repeat(1000));
    never_closed: "{\"version\": 1,\n \"objects\": [{\"shape\": \"sphere\"}";
    missing_comma: "{\"version\": 1\n \"objects\": []}";
    missing_quotes: "{version: 1}";
    two_values: "{\"version\": 1} {\"version\": 1}";
    duplicate_key: "{\"version\": 1,\n \"objects\": [],\n \"objects\": []}";
    both_shape_and_group: "{\"version\": 1, \"groups\": {\"a\": []},\n \"objects\": [{\"shape\": \"sphere\", \"group\": \"a\"}]}";
    two_kinds_at_once: object(r#"{"shape": {"sphere": {}, "cuboid": {}}}"#);
    material_inside_the_shape: object(r#"{"shape": {"sphere": {"radius": 1}, "material": "red"}}"#);
    no_kind_at_all: object(r#"{"shape": {}}"#);
    true_in_capitals: with(r#""materials": {"a": {"phong": {"fresnel": True}}}"#);
    two_numbers_and_a_key_that_cannot_be: "{\"version\": 1,\n \"objects\": [{\"shape\": {\"sphere\": {\"radius\": 1e999}}},\n  {\"shape\": {\"sphere\": {\"radius\": 0, \"radius\": 1}}}]}";
    hex_number: with(r#""background": 0xff8800"#);
    spot_wider_than_its_edge: with(r#""lights": [{"spot": {"beam_degrees": 50, "cutoff_degrees": 20}}]"#);
    dome_without_a_radius: with(r#""background": {"dome": {"radius": 0}}"#);
    point_without_light: with(r#""lights": [{"point": {"attenuation": {"constant": 0, "quadratic": 0}}}]"#);
    direction_without_length: with(r#""lights": [{"directional": {"direction": [0, 0, 0]}}]"#);
    neither_shape_nor_group: object(r#"{"name": "nothing"}"#);
    eye_at_what_it_looks_at: with(r#""camera": {"perspective": {"eye": [1, 2, 3], "look_at": [1, 2, 3]}}"#);
    two_fields_of_view: with(r#""camera": {"perspective": {"vertical_fov_degrees": 40, "horizontal_fov_degrees": 60}}"#);
    camera_and_cameras: with(r#""camera": {"perspective": {}}, "cameras": {"main": {"perspective": {}}}"#);
    polygon_that_is_not_flat: object(r#"{"shape": {"polygon": {"vertices": [[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 1, 1]]}}}"#);
    scale_by_zero: object(r#"{"shape": "sphere", "transform": [{"rotate": {"axis": [0, 1, 0], "degrees": 9}}, {"scale": [1, 0, 1]}]}"#);
    axis_zero: object(r#"{"shape": "sphere", "transform": [{"rotate": {"axis": [0, 0, 0], "degrees": 9}}]}"#);
    singular_matrix: object(r#"{"shape": "sphere", "transform": [{"matrix": [1, 2, 3, 0, 2, 4, 6, 0, 0, 0, 1, 0]}]}"#);
    matrix_of_thirteen: object(r#"{"shape": "sphere", "transform": [{"matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5]}]}"#);
    bad_color: with(r##""background": "#12345g""##);
    color_of_four: with(r#""background": [1, 2, 3, 4]"#);
    color_by_name: with(r#""lights": [{"point": {"color": "tomatoe"}}]"#);
    limb_out_of_reach: object(r#"{"limb": {"from": [0, 0, 0], "to": [0, 9, 0], "lengths": [2, 3], "plane_normal": [0, 0, 1], "radii": [1, 1, 1]}}"#);
    limb_along_its_normal: object(r#"{"limb": {"from": [0, 0, 0], "to": [0, 4, 0], "lengths": [2, 3], "plane_normal": [0, 1, 0], "radii": [1, 1, 1]}}"#);
    picture_of_nothing: with(r#""render": {"size": [0, 0]}"#);
    picture_too_large: with(r#""render": {"size": [65536, 65536]}"#);
    half_a_sample: with(r#""render": {"samples": 0.5}"#);
    unknown_integrator: with(r#""render": {"integrator": "classical"}"#);
    setting_of_nothing: with(r#""render": {"filter": {"box": {"radius": 1}}}"#);
    material_of_a_number: object(r#"{"shape": "sphere", "material": 7}"#);
    number_for_an_object: r#"{"version": 1, "objects": [5]}"#;
    light_that_gives_none: with(r#""lights": [{"point": {"intensity": 0}}]"#);
    track_without_keys: object(r#"{"shape": {"sphere": {"radius": {"animate": {"kyes": [[0, 1]]}}}}}"#);
    track_with_keys_out_of_order: object(r#"{"shape": {"sphere": {"radius": {"animate": {"keys": [[0, 1], [2, 3], [1, 2]]}}}}}"#);
    track_of_words: object(r#"{"shape": {"sphere": {"radius": {"animate": {"keys": [[0, "small"], [1, "large"]]}}}}}"#);
    track_of_unlike_values: object(r#"{"shape": "sphere", "transform": [{"translate": {"animate": {"keys": [[0, [0, 1, 0]], [1, [1, 2]]]}}}]}"#);
    track_in_an_unknown_way: object(r#"{"shape": {"sphere": {"radius": {"animate": {"keys": [[0, 1], [1, 2]], "interpolation": "liner", "repeat": "bounce"}}}}}"#);
    track_beside_others: object(r#"{"shape": {"sphere": {"radius": {"animate": {"keys": [[0, 1]]}, "ease": "in"}}}}"#);
    misspelt_value_form: object(r#"{"shape": {"sphere": {"radius": {"anmiate": {"keys": [[0, 1]]}}}}}"#);
    along_an_unknown_path: "{\"version\": 1, \"paths\": {\"flight\": {\"points\": [[0, 0, 0], [1, 2, 3]]}},\n \"objects\": [{\"shape\": \"sphere\", \"transform\": [{\"translate\": {\"along\": {\"path\": \"fligth\", \"at\": \"=seconds\"}}}]}]}";
    joint_out_of_reach: object(r#"{"shape": "sphere", "transform": [{"translate": {"joint": {"from": [0, 0, 0], "to": [0, 9, 0], "lengths": [2, 3], "plane_normal": [0, 0, 1]}}}]}"#);
    vector_as_a_number: "{\"version\": 1, \"variables\": {\"ball\": [1, 2, 3]},\n \"objects\": [{\"shape\": {\"sphere\": {\"radius\": \"=2 * ball\"}}}]}";
    rotation_of_three: object(r#"{"shape": "sphere", "transform": [{"orient": {"animate": {"keys": [[0, [0, 1, 0]]], "interpolation": "slerp"}}}]}"#);
    unknown_word: with(r#""materials": {"a": {"phong": {"highlight": "phog"}}}"#);
}

#[test]
fn binary_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.json");
    fs::write(&path, b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR").unwrap();
    insta::assert_snapshot!(complaint(&path).replace(&format!("{}/", folder.path().display()), ""));
}

#[test]
fn missing_file() {
    insta::assert_snapshot!(complaint(Path::new("no/such/scene.json")));
}

#[test]
fn includes_in_a_circle() {
    let files: [(&str, &[u8]); 2] = [
        ("a.json", br#"{"version": 1, "include": "b.json"}"#),
        ("b.json", br#"{"version": 1, "include": ["a.json"]}"#),
    ];
    insta::assert_snapshot!(report(&with(r#""include": ["a.json"]"#), &files));
}

#[test]
fn the_same_name_in_two_files() {
    let other: (&str, &[u8]) = ("paint.json", b"{\"materials\": {\n  \"red\": {\"phong\": {}}\n}}");
    insta::assert_snapshot!(report(&with(r#""include": "paint.json", "materials": {"red": {"phong": {}}}"#), &[other]));
}

#[test]
fn mistakes_in_an_included_file_are_found_there() {
    let other: (&str, &[u8]) = (
        "more.json",
        b"{\"version\": 1,\n \"object\": [],\n \"objects\": [{\"shape\": \"sphere\"},\n   {\"shape\": {\"sphere\": {\"radius\": 0}}}]}",
    );
    let text = "{\"version\": 1, \"include\": \"more.json\", \"objects\": [{\"shape\": {\"cuboid\": {\"min\": [1, 1, 1], \"max\": [0, 0, 0]}}}]}";
    insta::assert_snapshot!("included_twice_wrong", report(text, &[other]));
    let fixed: (&str, &[u8]) = (
        "more.json",
        b"{\"version\": 1,\n \"objects\": [{\"shape\": \"sphere\"},\n   {\"shape\": {\"sphere\": {\"radius\": 0}}}]}",
    );
    insta::assert_snapshot!("included_once_wrong", report(text, &[fixed]));
}

#[test]
fn broken_and_odd_meshes() {
    let broken: (&str, &[u8]) = ("broken.obj", b"v 0 0 0\nv 1 0 zero\n");
    insta::assert_snapshot!(
        "broken_mesh",
        report(&object(r#"{"shape": {"mesh": {"file": "broken.obj"}}}"#), &[broken])
    );
    let odd: (&str, &[u8]) = ("odd.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 1 2\n");
    insta::assert_snapshot!("odd_mesh", report(&object(r#"{"shape": {"mesh": {"file": "odd.obj"}}}"#), &[odd]));
    let both = r#"{"shape": {"mesh": {"file": "odd.obj", "normals": [[0, 0, 1], [0, 0, 1], [0, 0, 1]]}}}"#;
    insta::assert_snapshot!("mesh_of_a_file_with_normals", report(&object(both), &[odd]));
}

#[test]
fn invalid_material_is_not_also_reported_as_missing() {
    let text = r##"{"version": 1,
 "materials": {"red": {"phong": {"difuse": "#c02020"}}},
 "groups": {"pair": [{"shape": {"sphere": {"radus": 1}}}]},
 "objects": [{"shape": "sphere", "material": "red"}, {"group": "pair"}]}"##;
    let printed = report(text, &[]);
    assert!(printed.ends_with("2 errors") && !printed.contains("is called"), "{printed}");
}

#[test]
fn ten_mistakes_are_ten_messages() {
    let text = r##"{
  "version": 1,
  "render": {"size": [0, 480], "sampels": 4},
  "camera": {"perspective": {"eye": [0, 0, 0], "look_at": [0, 0, 0]}},
  "materials": {"red": {"phong": {"diffuse": "#zzz", "shininess": -3}}},
  "lights": [{"pont": {}}],
  "objects": [
    {"shape": {"sphere": {"radius": -1}}, "material": "rde"},
    {"shape": "sphere", "transform": [{"scale": 0}]},
    {"shape": {"mesh": {"file": "missing.ply"}}}
  ]
}"##;
    let printed = report(text, &[]);
    assert!(printed.ends_with("10 errors"), "{printed}");
    insta::assert_snapshot!(printed);
}

#[test]
fn messages_have_colors_only_in_a_terminal() {
    let Err(SceneError::Problems(problems)) = Scene::from_json(r#"{"version": 3}"#, "a.json") else { panic!() };
    assert!(problems.render(true).contains("\u{1b}["));
    assert!(!problems.render(false).contains("\u{1b}["));
}

#[test]
fn scenes_made_by_programs_are_checked_too() {
    use juggler_scene::Object;
    use juggler_shape::Sphere;
    let wrong = Scene::new()
        .add(Object::new(Sphere { radius: -1.0 }))
        .add(Object::new(Sphere { radius: f32::NAN }))
        .add(Object::new(Sphere::default()).material_named("gold"))
        .add(Object::default())
        .size(0, 10);
    insta::assert_snapshot!(wrong.check().to_string());
}

#[test]
fn long_names_are_shortened() {
    let long = "x".repeat(1_000_000);
    for (text, expected) in [
        (object(&format!(r#"{{"shape": "sphere", "material": "{long}"}}"#)), "no material is called `xxx"),
        (with(&format!(r#""{long}": 1"#)), "unknown key `xxx"),
        (
            object(&format!(r#"{{"shape": {{"mesh": {{"file": "{long}.ply"}}}}}}"#)),
            "x.ply`: this is not a valid file name",
        ),
        (object(&format!(r#"{{"shape": {{"sphere": {{"radius": {}}}}}}}"#, "1".repeat(1_000_000))), "1` is too large"),
        (with(&format!(r#""materials": {{"{long}": {{"fong": {{}}}}}}"#)), "materials.xxx"),
        (
            with(&format!(r#""materials": {{"{long}": {{"phong": {{}}}}}}, "groups": {{"a": [{{"material": "b"}}]}}"#)),
            "known: `xxx",
        ),
    ] {
        let report = report(&text, &[]);
        assert!(
            report.contains(expected) && report.contains('…') && report.len() < 10_000,
            "{expected}: {}",
            report.len()
        );
    }
}

#[test]
fn deep_nesting_in_an_included_file_names_the_place() {
    let deep = format!(r#"{{"version": 1, "groups": {{"a": {}"#, "[".repeat(1000));
    let report = report(&with(r#""include": "deep.json""#), &[("deep.json", deep.as_bytes())]);
    assert!(report.contains("deep.json:1:94") && report.contains("at: groups.a[0][0]"), "{report}");
}
