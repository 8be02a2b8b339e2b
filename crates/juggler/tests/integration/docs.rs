//! JSON blocks of the documentation are scenes, or parts of scenes, without mistakes.

use std::fs;
use std::path::Path;

/// A glTF file that has what the documentation names.
const MODEL: &str = r#"{"asset": {"version": "2.0"}, "extensionsUsed": ["KHR_materials_variants"],
    "extensions": {"KHR_materials_variants": {"variants": [{"name": "red"}]}},
    "scene": 0, "scenes": [{"nodes": [0, 1]}],
    "nodes": [{"name": "b_Head_05", "mesh": 0}, {"name": "Driver", "mesh": 0}], "materials": [{"name": "Tire"}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0,
        "extensions": {"KHR_materials_variants": {"mappings": [{"material": 0, "variants": [0]}]}}}]}],
    "animations": [
        {"name": "Run", "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
            "samplers": [{"input": 1, "output": 2}]},
        {"name": "Survey", "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
            "samplers": [{"input": 1, "output": 2}]}],
    "buffers": [{"uri": "model.bin", "byteLength": 68}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 8},
        {"buffer": 0, "byteOffset": 44, "byteLength": 24}],
    "accessors": [
        {"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3, "min": [0, 0, 0], "max": [1, 1, 0]},
        {"bufferView": 1, "componentType": 5126, "type": "SCALAR", "count": 2, "min": [0], "max": [2]},
        {"bufferView": 2, "componentType": 5126, "type": "VEC3", "count": 2}]}"#;

/// Files that the documentation names.
fn write_files(folder: &Path) {
    let numbers = [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    fs::write(folder.join("model.bin"), numbers.map(f32::to_le_bytes).concat()).unwrap();
    fs::write(folder.join("fox.glb"), MODEL).unwrap();
    fs::write(folder.join("car.glb"), MODEL).unwrap();
    fs::write(folder.join("car.obj"), "mtllib car.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl paint\nf 1 2 3\n").unwrap();
    fs::write(folder.join("car.mtl"), "newmtl paint\nKd 1 0 0\n").unwrap();
}

/// The scene of a block: itself, or a scene with the block as its part. `None` for settings of editors.
fn scene(block: &str) -> Option<String> {
    let block = block.trim();
    let animation = r#""animation": {"frames": 24, "frames_per_second": 24}"#;
    if block.contains("\"version\"") {
        return Some(block.to_owned());
    }
    if block.contains("\"json.schemas\"") {
        return None;
    }
    Some(match block {
        _ if block.starts_with('"') => {
            let sphere = r#"{"shape": "sphere", "material": {"diffuse": {}}}"#;
            format!(r#"{{"version": 1, "objects": [{sphere}], {block}}}"#)
        }
        _ if block.starts_with(r#"{"integrator""#) => {
            format!(r#"{{"version": 1, "objects": [{{"shape": "sphere"}}], "render": {block}}}"#)
        }
        _ if block.starts_with(r#"{"translate""#) => {
            format!(r#"{{"version": 1, {animation}, "objects": [{{"shape": "sphere", "transform": {block}}}]}}"#)
        }
        _ => format!(r#"{{"version": 1, {animation}, "objects": [{block}]}}"#),
    })
}

#[test]
fn json_blocks_of_the_documentation_have_no_mistakes() {
    let folder = tempfile::tempdir().unwrap();
    write_files(folder.path());
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs");
    let pages = fs::read_dir(docs).unwrap().map(|entry| entry.unwrap().path());
    let mut checked = 0;
    for page in pages.filter(|path| path.extension().is_some_and(|extension| extension == "md")) {
        let text = fs::read_to_string(&page).unwrap();
        let blocks = text.split("```json").skip(1).filter_map(|rest| rest.split_once('\n')?.1.split("```").next());
        for text in blocks.filter_map(scene) {
            let path = folder.path().join("block.json");
            fs::write(&path, &text).unwrap();
            let shown = || format!("{}: {text}", page.display());
            let loaded = juggler::loader().load(&path).unwrap_or_else(|error| panic!("{}\n{error}", shown()));
            let problems = loaded.check();
            assert_eq!(problems.errors(), 0, "{}\n{problems}", shown());
            let unknown = problems.list().iter().find(|problem| problem.message.contains("is read as"));
            assert!(unknown.is_none(), "{}\n{problems}", shown());
            checked += 1;
        }
    }
    assert!(checked >= 17, "{checked} blocks");
}
