//! Mesh files: the output of `info`, and sharing between objects.

use crate::harness::Folder;
use serde_json::Value;
use std::fmt::Write;
use std::fs;

/// A floor of 2 * 32 * 32 triangles, plus a degenerate one.
fn with_floor() -> Folder {
    let folder = Folder::new();
    let mut text = String::from("usemtl grey\n");
    (0..33 * 33).for_each(|i| writeln!(text, "v {} 0 {}", i % 33, i / 33).unwrap());
    for i in (0..32 * 33).filter(|i| i % 33 < 32) {
        writeln!(text, "f {} {} {}\nf {} {} {}", i + 1, i + 34, i + 2, i + 2, i + 34, i + 35).unwrap();
    }
    text += "f 1 2 3\n";
    fs::write(folder.path("floor.obj"), text).unwrap();
    folder
}

#[test]
fn info_describes_a_mesh() {
    let folder = with_floor();
    let words = folder.good("info floor.obj").stdout;
    for said in [
        "triangles    2049\n",
        "vertices     1089\n",
        "with         positions only\n",
        "bounds       [0, 0, 0] to [32, 0, 32]\n",
        " shapes, ",
        " MB/s)",
        "note         ignored statements: 1 'usemtl'\n",
        "note         1 degenerate triangle ignored\n",
    ] {
        assert!(words.contains(said), "{said}: {words}");
    }
    let json: Value = serde_json::from_str(&folder.good("info floor.obj --json").stdout).unwrap();
    let keys: Vec<&String> = json.as_object().unwrap().keys().collect();
    let expected = "version mesh triangles vertices normals uvs bounds memory file_bytes seconds warnings";
    assert_eq!(keys, expected.split(' ').collect::<Vec<_>>());
    assert_eq!((&json["triangles"], &json["uvs"]), (&2049.into(), &false.into()));
    let arrays = 1089 * 12 + 2049 * 12;
    let held = json["memory"]["geometry_bytes"].as_u64().unwrap();
    assert!((arrays..arrays + 1000).contains(&held), "{held}");
    assert!(json["memory"]["bvh_bytes"].as_u64().unwrap() > 2048 * 36, "{json}");
}

#[test]
fn unreadable_mesh_is_reported() {
    let folder = Folder::new();
    fs::write(folder.path("broken.ply"), "ply\nformat ascii 1.0\nelement x\n").unwrap();
    assert!(
        folder.bad("info broken.ply", 2).contains("cannot read `broken.ply`: line 3: expected the number of elements")
    );
    fs::write(folder.path("flat.obj"), "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n").unwrap();
    assert!(folder.bad("info flat.obj", 2).contains("all 1 are degenerate"));
    fs::create_dir(folder.path("folder.stl")).unwrap();
    folder.bad("info folder.stl", 3);
    folder.bad("info none.stl", 3);
}

#[test]
fn objects_share_a_mesh_and_its_hierarchy() {
    let folder = with_floor();
    fs::create_dir(folder.path("sub")).unwrap();
    let memory = |files: &[&str]| {
        let object = |file: &&str| format!(r#"{{"shape": {{"mesh": {{"file": "{file}"}}}}}}"#);
        let objects: Vec<String> = files.iter().map(object).collect();
        fs::write(folder.path("s.json"), format!(r#"{{"version": 1, "objects": [{}]}}"#, objects.join(", "))).unwrap();
        let run = folder.run("info s.json --json");
        assert_eq!(run.status, 0, "{}", run.stderr);
        let json: Value = serde_json::from_str(&run.stdout).unwrap();
        assert_eq!(json["geometry"]["triangles"], 2049 * files.len());
        ["geometry_bytes", "bvh_bytes"].map(|key| json["memory"][key].as_u64().unwrap())
    };
    let one = memory(&["floor.obj"]);
    let many = memory(&["floor.obj", "./floor.obj", "sub/../floor.obj", "floor.obj"]);
    for (one, many) in one.into_iter().zip(many) {
        assert!(one > 25_000 && many < one + 4000, "{one} {many}");
    }
}

/// A mesh can be rendered and checked like a scene, and converts to a scene with the same picture.
#[test]
fn mesh_is_rendered_like_a_scene() {
    let folder = Folder::new();
    fs::write(folder.path("tri.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    folder.good("render tri.obj --size 24x18 --samples 2 --quiet");
    assert_eq!(folder.files(), ["tri.obj", "tri.png"]);
    assert!(folder.good("check tri.obj").stdout.starts_with("tri.obj: no mistakes; "));
    assert!(folder.good("info tri.obj").stdout.contains("triangles    1\n"));
    fs::create_dir(folder.path("scenes")).unwrap();
    folder.good("convert tri.obj scenes/tri.json");
    let text = fs::read_to_string(folder.path("scenes/tri.json")).unwrap();
    assert!(text.contains("\"file\": \"../tri.obj\""), "{text}");
    let hash = |scene: &str| folder.hash(&format!("{scene} --size 24x18 --samples 2 -o a.png"));
    assert_eq!(hash("scenes/tri.json"), hash("tri.obj"));
    let message = folder.bad("render tri.obj --max-memory 1K -o b.png", 2);
    assert!(message.contains("memory"), "{message}");
}

#[test]
fn files_of_other_programs_are_named() {
    let folder = Folder::new();
    fs::write(folder.path("car.fbx"), b"Kaydara FBX Binary  \0").unwrap();
    fs::write(folder.path("room.pov"), "sphere { 0, 1 }").unwrap();
    for command in ["render", "check", "info", "convert"] {
        let output = if command == "convert" { " a.json" } else { "" };
        let status = if command == "check" { 1 } else { 2 };
        let message = folder.bad(&format!("{command} car.fbx{output}"), status);
        assert_eq!(
            message,
            "error: `car.fbx`: FBX is not supported: export the model as glTF (.glb), OBJ, PLY or STL\n"
        );
        assert!(
            folder
                .bad(&format!("{command} room.pov{output}"), status)
                .contains("POV-Ray's scene language is not supported")
        );
    }
}
