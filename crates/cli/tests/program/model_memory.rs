//! Memory of models: pictures count by their heads, nodes and arrays by the document, before any of
//! them is decoded.

use crate::harness::Folder;
use juggler::memory::PROGRAM;
use serde_json::Value;
use std::fmt::Write as _;
use std::fs;

const MIB: u64 = 1 << 20;

/// A budget of this many MiB beside the program.
fn budget(mib: u64) -> u64 {
    PROGRAM + mib * MIB
}

/// Chunk of a PNG.
fn chunk(kind: &[u8], data: &[u8]) -> Vec<u8> {
    let body = [kind, data].concat();
    let step = |crc: u32, _| if crc & 1 == 1 { crc >> 1 ^ 0xedb8_8320 } else { crc >> 1 };
    let crc = body.iter().fold(u32::MAX, |crc, byte| (0..8).fold(crc ^ u32::from(*byte), step));
    [&(data.len() as u32).to_be_bytes(), body.as_slice(), &(!crc).to_be_bytes()].concat()
}

/// A PNG of RGB pixels that declares `side`² of them, as many as its length allows, and ends in the
/// first rows.
fn cut_png(side: u32) -> Vec<u8> {
    let size = [side.to_be_bytes(), side.to_be_bytes()].concat();
    let head = chunk(b"IHDR", &[size.as_slice(), &[8, 2, 0, 0, 0]].concat());
    // One stored block of deflate, which is not the last.
    let rows = [&[0x78, 1, 0, 0xff, 0xff, 0, 0][..], &[0; 0xffff]].concat();
    [b"\x89PNG\r\n\x1a\n", head.as_slice(), &chunk(b"IDAT", &rows)].concat()
}

/// Writes a glTF of `nodes` triangles, whose materials show `images`.
fn write_gltf(folder: &Folder, name: &str, nodes: u32, images: &[&str]) {
    let corners = [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0];
    fs::write(folder.path("triangle.bin"), corners.map(f32::to_le_bytes).as_flattened()).unwrap();
    let each = |text: &dyn Fn(usize) -> String| (0..images.len()).map(text).collect::<Vec<_>>().join(", ");
    let sources = each(&|i| format!(r#"{{"uri": "{}"}}"#, images[i]));
    let textures = each(&|i| format!(r#"{{"source": {i}}}"#));
    let materials = each(&|i| format!(r#"{{"pbrMetallicRoughness": {{"baseColorTexture": {{"index": {i}}}}}}}"#));
    let shown = |i| if images.is_empty() { String::new() } else { format!(r#", "material": {i}"#) };
    let primitive = |i| format!(r#"{{"attributes": {{"POSITION": 0, "TEXCOORD_0": 1}} {}}}"#, shown(i));
    let primitives = (0..images.len().max(1)).map(primitive).collect::<Vec<_>>().join(", ");
    let mut list = String::new();
    for i in 0..nodes {
        let comma = if i > 0 { "," } else { "" };
        write!(list, r#"{comma}{{"mesh": 0, "translation": [{}, {}, 0]}}"#, i % 300, i / 300).unwrap();
    }
    let roots = (0..nodes).map(|i| i.to_string()).collect::<Vec<_>>().join(",");
    let accessor =
        |view, kind| format!(r#"{{"bufferView": {view}, "componentType": 5126, "type": "{kind}", "count": 3}}"#);
    let pictures = match images {
        [] => String::new(),
        _ => format!(r#""images": [{sources}], "textures": [{textures}], "materials": [{materials}],"#),
    };
    let text = format!(
        r#"{{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [{roots}]}}], "nodes": [{list}], {pictures}
            "buffers": [{{"uri": "triangle.bin", "byteLength": 60}}], "meshes": [{{"primitives": [{primitives}]}}],
            "bufferViews": [{{"buffer": 0, "byteLength": 36}}, {{"buffer": 0, "byteOffset": 36, "byteLength": 24}}],
            "accessors": [{}, {}]}}"#,
        accessor(0, "VEC3"),
        accessor(1, "VEC2"),
    );
    fs::write(folder.path(name), text).unwrap();
}

fn peaks(stats: &Value) -> (u64, u64) {
    let number = |key: &str| stats["memory"][key].as_u64().unwrap();
    (number("peak_rss_bytes"), number("expected_bytes"))
}

/// The pictures end after their heads: a command that decodes them fails.
#[test]
fn pictures_of_models_count_by_their_heads_and_are_checked_by_them() {
    let folder = Folder::new();
    fs::write(folder.path("a.png"), cut_png(4000)).unwrap();
    fs::write(folder.path("b.png"), cut_png(3000)).unwrap();
    write_gltf(&folder, "a.gltf", 1, &["a.png", "b.png"]);
    fs::write(folder.path("a.mtl"), "newmtl a\nmap_Kd a.png\nmap_d b.png\n").unwrap();
    fs::write(folder.path("a.obj"), "mtllib a.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n")
        .unwrap();
    fs::write(folder.path("a.json"), r#"{"version": 1, "objects": [{"model": {"file": "a.gltf"}}]}"#).unwrap();
    for model in ["a.gltf", "a.obj", "a.json"] {
        let line = format!("render {model} --size 8x8 --samples 1 -o o.png");
        let message = folder.bad(&format!("{line} --max-memory {}", budget(90)), 2);
        assert!(message.contains("the picture `a/images/") && message.contains("more than --max-memory"), "{message}");
        assert!(folder.bad(&line, 2).contains("unexpected end"), "{model}");
        let check = folder.run(&format!("check {model}"));
        assert_eq!(check.status, 0, "{}", check.stderr);
        let info: Value = serde_json::from_str(&folder.good(&format!("info {model} --json")).stdout).unwrap();
        let bytes = info["memory"]["texture_bytes"].as_u64().unwrap();
        let texels = (4000 * 4000 + 3000 * 3000) * 3;
        assert!((texels..texels * 4 / 3 + 1000).contains(&bytes), "{model}: {bytes}");
    }
    fs::write(folder.path("a.png"), "no picture").unwrap();
    let message = folder.bad("check a.gltf", 1);
    assert!(message.contains("its first bytes match no supported format"), "{message}");
}

#[test]
fn nodes_count_before_they_become_objects() {
    let folder = Folder::new();
    let count = 30_000;
    write_gltf(&folder, "nodes.gltf", count, &[]);
    let line = "nodes.gltf --size 8x8 --samples 1 -o a.png --threads 2";
    let stats = folder.stats(line);
    let (peak, expected) = peaks(&stats);
    assert!(peak <= expected && expected <= peak * 3 / 2 + 30 * MIB, "{peak} of {expected}");
    assert!(peak - PROGRAM.min(peak) < 1536 * u64::from(count) + 8 * MIB, "{peak}");
    let message = folder.bad(&format!("render {line} --max-memory {}", budget(10)), 2);
    assert!(message.contains("to be read, more than --max-memory"), "{message}");
    let scene = r#"{"version": 1, "objects": [{"model": {"file": "nodes.gltf"}}]}"#;
    fs::write(folder.path("nodes.json"), scene).unwrap();
    let message = folder.bad(&format!("render nodes.json -o a.png --max-memory {}", budget(10)), 2);
    assert!(message.contains("to be read, more than --max-memory"), "{message}");
}

#[test]
fn groups_of_an_obj_count() {
    let folder = Folder::new();
    let mut text = String::new();
    for i in 0..20_000 {
        let (x, y) = (i % 200, i / 200);
        write!(text, "g part{i}\nv {x} {y} 0\nv {} {y} 0\nv {x} {} 0\nf -1 -2 -3\n", x + 1, y + 1).unwrap();
    }
    fs::write(folder.path("groups.obj"), text).unwrap();
    fs::write(folder.path("groups.json"), r#"{"version": 1, "objects": [{"model": {"file": "groups.obj"}}]}"#).unwrap();
    let line = "groups.json --size 8x8 --samples 1 -o a.png --threads 2";
    let (peak, expected) = peaks(&folder.stats(line));
    assert!(peak <= expected && expected <= peak * 3 / 2 + 30 * MIB, "{peak} of {expected}");
    let message = folder.bad(&format!("render {line} --max-memory {}", budget(10)), 2);
    assert!(message.contains("to be read, more than --max-memory"), "{message}");
}

/// Statistics of a render at the least limit that the program accepts, by the needs that its refusals
/// name.
fn at_the_limit_that_is_named(folder: &Folder, line: &str) -> Result<(u64, Value), String> {
    let mut limit = MIB;
    for _ in 0..6 {
        let limited = format!("{line} --max-memory {limit}");
        let run = folder.run(&format!("render {limited} --quiet"));
        if run.status == 0 {
            return Ok((limit, folder.stats(&limited)));
        }
        let named = run.stderr.split_once("needs about ").and_then(|(_, rest)| rest.split_once(" MiB"));
        let Some(named) = named.and_then(|(number, _)| number.parse::<f64>().ok()) else { return Err(run.stderr) };
        // Messages round to tenths.
        limit = limit.max(((named + 0.1) * MIB as f64) as u64);
    }
    Err(format!("{line}: no limit that is named is accepted"))
}

#[test]
fn committed_models_keep_to_the_limit_that_is_named() {
    let folder = Folder::new();
    let scenes = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let files = ["models", "gallery/models"].map(|below| fs::read_dir(scenes.join(below)).unwrap());
    let files = files.into_iter().flatten().map(|file| file.unwrap().path());
    let is_model = |file: &std::path::PathBuf| file.extension().is_some_and(|end| end == "glb" || end == "ply");
    let models: Vec<_> = files.filter(is_model).collect();
    assert!(models.len() > 25, "{models:?}");
    for model in models {
        let line = format!("{} --size 64x36 --samples 1 -o a.png", model.to_str().unwrap());
        let (limit, stats) = at_the_limit_that_is_named(&folder, &line).unwrap();
        let (peak, expected) = peaks(&stats);
        assert!(peak <= limit && expected <= limit, "{line}: {peak} of {expected} of {limit}");
    }
}
