//! Model files as scenes, and the flags that select what they show.

use crate::harness::Folder;
use serde_json::Value;
use std::fs;
use std::path::Path;

/// A triangle (0, 0, 0), (1, 0, 0), (0, 1, 0) with a clip that raises it, and two materials of which
/// a variant selects the second.
const TRIANGLE: &str = r#"{"asset": {"version": "2.0", "generator": "by hand"},
    "extensionsUsed": ["KHR_materials_variants"],
    "extensions": {"KHR_materials_variants": {"variants": [{"name": "shiny"}]}},
    "scene": 0, "scenes": [{"name": "first", "nodes": [0]}], "nodes": [{"name": "Top", "mesh": 0}],
    "meshes": [{"name": "Triangle", "primitives": [{"attributes": {"POSITION": 0}, "material": 0,
        "extensions": {"KHR_materials_variants": {"mappings": [{"material": 1, "variants": [0]}]}}}]}],
    "materials": [{"name": "Dull", "doubleSided": true}, {"name": "Shiny", "doubleSided": true, "pbrMetallicRoughness": {"roughnessFactor": 0.1}}],
    "animations": [{"name": "Rise", "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
        "samplers": [{"input": 1, "output": 2}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
        {"bufferView": 1, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [1]},
        {"bufferView": 2, "componentType": 5126, "count": 2, "type": "VEC3"}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 8},
        {"buffer": 0, "byteOffset": 44, "byteLength": 24}],
    "buffers": [{"uri": "triangle.bin", "byteLength": 68}]}"#;

fn with_triangle() -> Folder {
    let folder = Folder::new();
    let numbers = [0.0f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 2.0, 0.0];
    fs::write(folder.path("triangle.bin"), numbers.map(f32::to_le_bytes).concat()).unwrap();
    fs::write(folder.path("triangle.gltf"), TRIANGLE).unwrap();
    folder
}

#[test]
fn a_model_file_is_a_scene_for_all_commands() {
    let folder = with_triangle();
    assert!(folder.good("check triangle.gltf").stdout.starts_with("triangle.gltf: no mistakes"));
    let words = folder.good("info triangle.gltf").stdout;
    for said in ["by hand", "Rise, 1.000 s, shown", "KHR_materials_variants: whole", "shiny"] {
        assert!(words.contains(said), "{said}: {words}");
    }
    let json: Value = serde_json::from_str(&folder.good("info triangle.gltf --json").stdout).unwrap();
    assert_eq!((&json["models"][0]["triangles"], &json["models"][0]["clips"][0]["name"]), (&1.into(), &"Rise".into()));
    fs::create_dir(folder.path("scenes")).unwrap();
    folder.good("convert triangle.gltf scenes/a.json");
    assert!(fs::read_to_string(folder.path("scenes/a.json")).unwrap().contains("\"../triangle.gltf\""));
    let hash = |scene: &str| folder.hash(&format!("{scene} --size 24x18 --samples 2 -o a.png"));
    assert_eq!(hash("scenes/a.json"), hash("triangle.gltf"));
}

#[test]
fn flags_select_variant_clip_and_scene_of_a_model() {
    let folder = with_triangle();
    let hash =
        |flags: &str| folder.hash(&format!("triangle.gltf {flags} --frame 15 --size 24x18 --samples 2 -o a.png"));
    assert_eq!(hash("--animation Rise"), hash(""));
    assert_eq!(hash("--animation 0 --model-scene first"), hash(""));
    assert_ne!(hash("--variant shiny"), hash(""));
    folder.good("convert triangle.gltf a.json --animation none");
    let scene: Value = serde_json::from_str(&fs::read_to_string(folder.path("a.json")).unwrap()).unwrap();
    assert_eq!(scene["objects"][0]["model"]["animation"], "none");
    for flags in ["--variant shyny", "--animation Fall", "--model-scene 7"] {
        let message = folder.bad(&format!("check triangle.gltf {flags}"), 1);
        assert!(message.contains(flags.split(' ').nth(1).unwrap()), "{message}");
    }
    let message = folder.bad("check juggler --variant shiny", 2);
    assert!(message.contains("--variant is for model files"), "{message}");
}

#[test]
fn a_scene_of_two_models_with_overrides_and_a_follower_is_the_same_when_written_anew() {
    let folder = with_triangle();
    let scene = |position: &str| {
        format!(
            r#"{{"version": 1, "render": {{"shutter": [0, 0.5]}}, "lights": [{{"ambient": {{}}}}], "materials": {{"clay": {{"diffuse": {{}}}}}},
            "camera": {{"perspective": {{"eye": [1, 2, 9], "look_at": [1, 1, 0]}}}}, "objects": [
            {{"model": {{"file": "triangle.gltf", "variant": "shiny"}}}},
            {{"model": {{"file": "triangle.gltf", "animation": "none", "materials": {{"Dull": "clay"}}}}, "transform": [{{"translate": [2, 0, 0]}}]}},
            {{"shape": {{"sphere": {{"radius": 0.25}}}}, "transform": [{{"translate": {position}}}]}}]}}"#
        )
    };
    let posed = r#"{"posed": {"file": "triangle.gltf", "node": "Top", "animation": "Rise", "point": [0.5, 0.25, 0]}}"#;
    let keys = r#"{"animate": {"keys": [[0, [0.5, 0.25, 0]], [1, [0.5, 2.25, 0]]], "repeat": "loop"}}"#;
    fs::write(folder.path("a.json"), scene(posed)).unwrap();
    fs::write(folder.path("keys.json"), scene(keys)).unwrap();
    fs::create_dir(folder.path("inner")).unwrap();
    folder.good("convert a.json inner/b.json");
    let hash = |scene: &str| folder.hash(&format!("{scene} --frame 12 --size 32x24 --samples 4 -o a.png"));
    assert_eq!(hash("inner/b.json"), hash("a.json"));
    assert_eq!(hash("keys.json"), hash("a.json"));
    assert!(folder.good("info a.json").stdout.contains("posed, triangle.gltf: Top"));
    fs::write(folder.path("a.json"), scene(&posed.replace("Top", "Tip"))).unwrap();
    let message = folder.bad("check a.json", 1);
    assert!(message.contains("there is no node `Tip`; did you mean `Top`?"), "{message}");
}

#[test]
fn unpacked_models_are_scenes_of_mesh_files_with_the_same_picture() {
    let folder = with_triangle();
    let hash = |scene: &str| folder.hash(&format!("{scene} --frame 15 --size 24x18 --samples 2 -o a.png"));
    let printed = folder.good("convert triangle.gltf --variant shiny --frame 15 --unpack parts").stdout;
    assert_eq!(Path::new(printed.trim_end()), Path::new("parts").join("triangle.json"));
    fs::remove_file(folder.path("triangle.bin")).unwrap();
    let mesh = fs::read(folder.path("parts/meshes/Top.ply")).unwrap();
    assert!(mesh.starts_with(b"ply\nformat binary_little_endian 1.0\nelement vertex 3\n"));
    let unpacked = hash("parts/triangle.json");
    let folder = with_triangle();
    assert_eq!(folder.hash("triangle.gltf --variant shiny --frame 15 --size 24x18 --samples 2 -o a.png"), unpacked);
    let run = folder.run("convert triangle.gltf --unpack parts --force");
    assert!(run.status == 0 && run.stderr.starts_with("note: the scene moves"), "{}", run.stderr);
    folder.good("convert one-sphere --unpack parts");
    folder.bad("convert triangle.gltf a.json --unpack parts", 2);
    folder.bad("convert triangle.gltf", 2);
    folder.bad("convert triangle.gltf --unpack triangle.gltf", 3);
}

#[test]
fn edited_scenes_are_replaced_only_with_force() {
    let folder = with_triangle();
    for (command, file) in [
        ("convert triangle.gltf a.json", "a.json"),
        ("convert triangle.gltf --frame 0 --unpack parts", "parts/triangle.json"),
    ] {
        folder.good(command);
        let written = fs::read_to_string(folder.path(file)).unwrap();
        folder.good(command);
        assert_eq!(fs::read_to_string(folder.path(file)).unwrap(), written, "the same scene again");
        for edited in ["{}".to_owned(), written.replace("Triangle", "My triangle") + " ".repeat(1000).as_str() + "//"] {
            fs::write(folder.path(file), &edited).unwrap();
            let message = folder.bad(command, 2);
            let name = Path::new(file).display();
            assert!(message.contains(&format!("`{name}` exists and contains another scene: --force")), "{message}");
            assert_eq!(fs::read_to_string(folder.path(file)).unwrap(), edited);
        }
        folder.good(&format!("{command} --force"));
        assert_eq!(fs::read_to_string(folder.path(file)).unwrap(), written);
    }
    fs::create_dir(folder.path("folder")).unwrap();
    folder.bad("convert triangle.gltf folder", 3);
}

#[test]
fn lost_pictures_are_gray_if_that_is_allowed() {
    let folder = with_triangle();
    let with_color = |pbr: &str, more: &str| {
        let dull = format!(r#"{{"name": "Dull", "pbrMetallicRoughness": {{{pbr}}}, "doubleSided": true}}"#);
        let model = TRIANGLE.replace(r#"{"name": "Dull", "doubleSided": true}"#, &dull);
        model.replacen('{', &format!("{{{more}"), 1)
    };
    let textures = r#""textures": [{"source": 0}], "images": [{"uri": "wood.png"}],"#;
    fs::write(folder.path("wood.gltf"), with_color(r#""baseColorTexture": {"index": 0}"#, textures)).unwrap();
    fs::write(folder.path("gray.gltf"), with_color(r#""baseColorFactor": [0.5, 0.5, 0.5, 1]"#, "")).unwrap();
    fs::write(folder.path("wood.obj"), "mtllib wood.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl w\nf 1 2 3\n").unwrap();
    fs::write(folder.path("wood.mtl"), "newmtl w\nKd 1 1 1\nmap_Kd wood.png\n").unwrap();
    for name in ["missing", "broken"] {
        if name == "broken" {
            fs::write(folder.path("wood.png"), b"no picture").unwrap();
        }
        for model in ["wood.gltf", "wood.obj"] {
            let run = folder.run(&format!("check {model}"));
            assert!(run.status == 1 && run.stderr.contains("wood.png"), "{name} {model}: {}", run.stderr);
            assert!(name == "broken" || run.stderr.contains("`--lenient` shows such pictures gray"), "{}", run.stderr);
            let run = folder.run(&format!("check {model} --lenient"));
            let says = run.stdout.clone() + &run.stderr;
            assert!(run.status == 0 && says.contains("the picture is shown gray"), "{name} {model}: {says}");
        }
        let hash = |scene: &str| folder.hash(&format!("{scene} --size 24x18 --samples 2 -o a.png"));
        assert_eq!(hash("wood.gltf --lenient"), hash("gray.gltf"));
    }
    let message = folder.bad("check ball.json --lenient", 2);
    assert!(message.contains("--lenient is for models"), "{message}");
}

#[test]
fn checkpoints_of_models_depend_on_the_meaning_of_their_files() {
    let folder = with_triangle();
    let line = "render triangle.gltf --size 16x12 --samples 2 -q -o a.png --checkpoint a.jfilm";
    folder.good(line);
    let value: Value = serde_json::from_str(TRIANGLE).unwrap();
    fs::write(folder.path("triangle.gltf"), serde_json::to_string_pretty(&value).unwrap() + "\n").unwrap();
    folder.good(line);
    fs::write(folder.path("triangle.gltf"), TRIANGLE.replace("\"Dull\"", "\"Flat\"")).unwrap();
    let message = folder.bad(line, 2);
    assert!(message.contains("file triangle.gltf: ") && !message.contains("triangle.bin"), "{message}");
    fs::write(folder.path("triangle.gltf"), TRIANGLE).unwrap();
    let mut bytes = fs::read(folder.path("triangle.bin")).unwrap();
    bytes[12] ^= 1;
    fs::write(folder.path("triangle.bin"), bytes).unwrap();
    let message = folder.bad(line, 2);
    assert!(message.contains("file triangle.bin: ") && !message.contains("triangle.gltf: "), "{message}");
}

#[test]
fn broken_pictures_are_named_by_their_place_in_the_model() {
    let folder = with_triangle();
    let textured = TRIANGLE.replace(
        r#"{"name": "Dull", "doubleSided": true}"#,
        r#"{"name": "Dull", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}, "doubleSided": true}"#,
    );
    let image = |image: &str| {
        let more = format!(r#"{{"textures": [{{"source": 1}}], "images": [{{"uri": "unused.png"}}, {image}],"#);
        fs::write(folder.path("wood.gltf"), textured.replacen('{', &more, 1)).unwrap();
    };
    fs::write(folder.path("broken.png"), b"no picture").unwrap();
    for (picture, place) in [
        (r#"{"uri": "broken.png"}"#, "wood.gltf: /images/1 (broken.png)"),
        (r#"{"uri": "data:,no%20picture", "name": "Oak"}"#, "wood.gltf: /images/1 (Oak)"),
        (r#"{"uri": "data:,no%20picture"}"#, "wood.gltf: /images/1"),
    ] {
        image(picture);
        for command in ["check wood.gltf", "render wood.gltf --size 8x6 --samples 1 -o a.png"] {
            let run = folder.run(command);
            assert!(run.status != 0 && run.stderr.contains(&format!("cannot read `{place}`: ")), "{}", run.stderr);
        }
        let run = folder.run("check wood.gltf --lenient");
        let place = place.trim_start_matches("wood.gltf: ");
        assert!(run.status == 0 && (run.stdout.clone() + &run.stderr).contains(place), "{}{}", run.stdout, run.stderr);
    }
    fs::write(folder.path("wood.obj"), "mtllib wood.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl w\nf 1 2 3\n").unwrap();
    fs::write(folder.path("wood.mtl"), "newmtl w\nmap_Kd broken.png\n").unwrap();
    let message = folder.run("check wood.obj").stderr;
    assert!(message.contains("cannot read `wood.mtl:2: broken.png`: "), "{message}");
}

#[test]
fn broken_models_are_refused_with_file_and_place() {
    let folder = with_triangle();
    fs::write(folder.path("cut.glb"), b"glTF\x02\0\0\0").unwrap();
    for command in ["render", "check", "info", "convert"] {
        let output = if command == "convert" { " a.json" } else { "" };
        let message = folder.bad(&format!("{command} cut.glb{output}"), if command == "check" { 1 } else { 2 });
        assert!(message.contains("cut.glb"), "{message}");
    }
    fs::remove_file(folder.path("triangle.bin")).unwrap();
    let message = folder.bad("check triangle.gltf", 1);
    assert!(message.contains("/buffers/0") && message.contains("no such file"), "{message}");
    assert!(!message.contains("--lenient"), "{message}");
}
