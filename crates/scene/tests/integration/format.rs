//! Promises of the scene format, by example.

use juggler_scene::schema::Schema;
use juggler_scene::{Scene, SceneError, names_page, reference, schema_json};
use std::fs;
use std::path::Path;

const SKELETON: &str = r##"{
  "version": 1, // comments and trailing commas are welcome
  "render": {"size": [640, 360], "samples": 16, "integrator": {"classic": {}}},
  "cameras": {"main": {"perspective": {"eye": [0, 2, 6], "look_at": [0, 1, 0], "vertical_fov_degrees": 40}}},
  "textures": {},
  "materials": {"red": {"phong": {"diffuse": "#c02020", "shininess": 20}}},
  "lights": [{"point": {"position": [4, 6, 4], "color": [1, 1, 1], "intensity": 60}}],
  "groups": {"pair": [{"shape": {"sphere": {}}}, {"shape": {"sphere": {}}, "material": {"phong": {}}}]},
  "objects": [
    {"shape": {"sphere": {"radius": 1}}, "transform": [{"translate": [0, 1, 0]}], "material": "red"},
    {"group": "pair", "transform": [{"scale": 2}, {"rotate": {"axis": [0, 1, 0], "degrees": "=90/3"}}]},
  ],
}"##;

fn scene(text: &str) -> Scene {
    Scene::from_json(text, "test.json").unwrap()
}

#[test]
fn the_skeleton_compiles() -> Result<(), SceneError> {
    let compiled = scene(SKELETON).compile()?;
    assert_eq!(compiled.world.geometry_stats().shapes, 3);
    assert_eq!(compiled.cameras.len(), 1);
    Ok(())
}

/// The schema lists metals by all names that scenes may use, and aluminum in both spellings.
#[test]
fn scenes_name_metals() {
    let metals = ["aluminum", "aluminium", "brass", "chromium", "cobalt", "copper", "gold", "iron", "nickel"];
    for metal in metals.into_iter().chain(["platinum", "silver", "titanium", "tungsten", "zinc"]) {
        let sphere = format!(r#"{{"shape": "sphere", "material": {{"conductor": {{"metal": "{metal}"}}}}}}"#);
        let scene = scene(&format!(r#"{{"version": 1, "objects": [{sphere}]}}"#));
        assert!(scene.check().list().is_empty() && scene.compile().is_ok(), "{metal}: {}", scene.check());
        assert!(reference().contains(&format!("- `\"{metal}\"`: ")), "the reference does not list {metal}");
    }
}

/// The published files are up to date.
#[test]
fn schema_and_reference_are_current() {
    let files = [
        ("schema/scene.schema.json", schema_json()),
        ("docs/scene-format.md", reference()),
        ("docs/names.md", names_page()),
    ];
    for (file, text) in files {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(file);
        if std::env::var_os("JUGGLER_BLESS").is_some() {
            fs::write(&path, &text).unwrap();
        }
        let current = fs::read_to_string(&path).unwrap_or_default().replace("\r\n", "\n") == text;
        assert!(current, "{file} is out of date; to write it anew: JUGGLER_BLESS=1 cargo test -p juggler-scene");
    }
}

/// The reference's whole scenes are valid and its links lead somewhere.
#[test]
fn scenes_of_the_reference_are_valid_and_its_links_resolve() {
    let text = reference();
    let scenes = text.split("```").skip(1).step_by(2).filter(|block| block.contains("\"version\""));
    let scenes: Vec<&str> = scenes.filter_map(|block| Some(block.split_once('\n')?.1)).collect();
    assert_eq!(scenes.len(), 4);
    for text in scenes {
        let scene = scene(text);
        assert!(scene.check().list().is_empty(), "{}", scene.check());
        assert!(scene.compile().is_ok());
    }
    let anchor = |heading: &str| heading.trim().to_lowercase().replace(['`', ':'], "").replace(' ', "-");
    let anchors: Vec<String> =
        text.lines().filter(|line| line.starts_with('#')).map(|line| anchor(line.trim_start_matches('#'))).collect();
    for (i, name) in anchors.iter().enumerate() {
        assert!(!anchors[..i].contains(name), "two headings are called {name}");
    }
    let links: Vec<&str> = text.split("](#").skip(1).filter_map(|rest| rest.split(')').next()).collect();
    assert!(links.len() > 100);
    for link in links {
        assert!(anchors.iter().any(|anchor| anchor == link), "nothing is at #{link}");
    }
    let type_names = Schema::get().definitions().map(|(name, _)| name);
    for name in type_names.filter(|name| name.chars().skip(1).any(char::is_uppercase)) {
        assert!(!text.contains(name.as_str()), "the reference speaks Rust: {name}");
    }
    assert!(!text.contains("any value") && !text.contains("[`crate"));
}

/// Short forms give the same scene and are written out in full.
#[test]
fn short_forms_equal_long_forms() {
    let sphere = |transform: &str, color: &str| {
        let material = format!(r#"{{"phong": {{"diffuse": "{color}"}}}}"#);
        let object = format!(r#"{{"shape": "sphere", "transform": {transform}, "material": {material}}}"#);
        scene(&format!(r#"{{"version": 1, "objects": [{object}]}}"#))
    };
    let long = sphere(r#"[{"translate": [0, 1, 0]}]"#, "#ff0033");
    let short = sphere(r#"{"translate": [0, 1, 0]}"#, "#f03");
    assert_eq!(short.description, long.description);
    assert_eq!(short.to_json(), long.to_json());
    assert_eq!(scene(&short.to_json()).description, long.description);
    assert!(short.check().list().is_empty(), "{}", short.check());
    let moving = sphere(r#"{"translate": [0, "=frame", 0]}"#, "#f03");
    assert_eq!(moving.at_frame(1.0).unwrap().description, long.description);
}

/// Colors that look like 8-bit levels are allowed with a warning; bright lights cause none.
#[test]
fn colors_that_look_like_8_bit_levels_cause_warnings() {
    let warned = |text: &str| {
        let scene = scene(&format!(r#"{{"version": 1, "objects": [{{"shape": "sphere"}}], {text}}}"#));
        assert!(scene.compile().is_ok());
        scene.check().warnings()
    };
    for (text, warnings) in [
        (r#""materials": {"a": {"phong": {"diffuse": [255, 0, 0]}}}"#, 1),
        (r#""background": [135, 206, 235]"#, 1),
        (r#""lights": [{"point": {"position": [0, 3, 0], "color": [255, 255, 255]}}]"#, 1),
        (r#""lights": [{"point": {"position": [0, 3, 0], "color": [20, 15, 10]}}]"#, 0),
        (r#""background": 1, "materials": {"a": {"emissive": {"radiance": [60, 50, 40]}}}"#, 0),
        (r#""materials": {"a": {"phong": {"diffuse": [1, 0, 0]}}}"#, 0),
        (r#""background": [2, 2, 2.5]"#, 0),
    ] {
        assert_eq!(warned(text), warnings, "{text}");
    }
}

/// The limits of 32-bit and 64-bit numbers are allowed values themselves.
#[test]
fn limits_of_number_types_are_valid_values() {
    let allowed = [
        r#"{"version": 1, "render": {"seed": 18446744073709551615}}"#,
        r#"{"version": 1, "render": {"integrator": {"path": {"clamp_direct": 1e-6, "clamp_indirect": 1e30}}}}"#,
        r#"{"version": 1, "materials": {"a": {"phong": {"ior": 0.01}}}}"#,
    ];
    for text in allowed {
        let scene = scene(text);
        assert_eq!(scene.check().to_string().matches("warning").count(), 1, "{text}: {}", scene.check());
    }
    assert_eq!(scene(allowed[0]).description.render.seed, u64::MAX);
    let refused = [
        (r#"{"version": 1, "render": {"seed": 18446744073709551616}}"#, "between 0 and 18446744073709551615"),
        (r#"{"version": 1, "render": {"seed": -1}}"#, "between 0 and 18446744073709551615"),
        (r#"{"version": 1, "render": {"integrator": {"path": {"clamp_direct": 9e-7}}}}"#, "between 0.000001 and 1e30"),
    ];
    for (text, message) in refused {
        let error = Scene::from_json(text, "test.json").map(|_| ()).unwrap_err().to_string();
        assert!(error.contains(message), "{text}: {error}");
    }
}

/// Editors read `$schema`; the program only checks that it is a string.
#[test]
fn scenes_name_their_schema() {
    let named = scene(r#"{"$schema": "./scene.schema.json", "version": 1, "objects": [{"shape": "sphere"}]}"#);
    let plain = scene(r#"{"version": 1, "objects": [{"shape": "sphere"}]}"#);
    assert_eq!(named.description, plain.description);
    let error = Scene::from_json(r#"{"$schema": 7, "version": 1}"#, "test.json").map(|_| ()).unwrap_err().to_string();
    assert!(error.contains("JSON Schema") && error.contains("found a number"), "{error}");
}

#[test]
fn included_files_name_their_schema() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    fs::write(path("main.json"), r#"{"version": 1, "include": "ball.json"}"#).unwrap();
    let included = |schema: &str| {
        let ball = format!(r#"{{"$schema": {schema}, "version": 1, "objects": [{{"shape": "sphere"}}]}}"#);
        fs::write(path("ball.json"), ball).unwrap();
        Scene::load(path("main.json"))
    };
    let plain = scene(r#"{"version": 1, "objects": [{"shape": "sphere"}]}"#);
    assert_eq!(included(r#""./scene.schema.json""#).unwrap().description, plain.description);
    let error = included("7").map(|_| ()).unwrap_err().to_string();
    assert!(error.contains("JSON Schema") && error.contains("ball.json:1:13"), "{error}");
}

/// The main file is one of the 1,000 files that a scene may consist of.
#[test]
fn a_scene_has_at_most_1000_files() {
    let folder = tempfile::tempdir().unwrap();
    let with_included = |count: usize| {
        let names: Vec<String> = (0..count).map(|i| format!("{i}.json")).collect();
        for name in &names {
            fs::write(folder.path().join(name), r#"{"version": 1}"#).unwrap();
        }
        let main = folder.path().join("main.json");
        let text = format!(r#"{{"version": 1, "include": {names:?}, "objects": [{{"shape": "sphere"}}]}}"#);
        fs::write(&main, text).unwrap();
        Scene::load(main).map(|_| ()).map_err(|error| error.to_string())
    };
    assert_eq!(with_included(999), Ok(()));
    let error = with_included(1000).unwrap_err();
    assert!(error.contains("a scene has at most 1000 files"), "{error}");
}
