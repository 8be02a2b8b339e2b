//! Speed of opening and decoding: `JUGGLER_IMPORT_MEGABYTES=64 cargo test --release -p
//! juggler-import --test integration -- --nocapture speed::` measures larger arrays.

use juggler_import::gltf::document::Index;
use juggler_import::gltf::{Assembly, Gltf, Limits};
use std::collections::BTreeMap;
use std::time::Instant;

/// A binary file of a document and a buffer.
fn glb(json: &str, binary: &[u8]) -> Vec<u8> {
    let json = format!("{json:width$}", width = json.len().next_multiple_of(4));
    let mut bytes = b"glTF\x02\0\0\0".to_vec();
    bytes.extend(((28 + json.len() + binary.len()) as u32).to_le_bytes());
    for (kind, data) in [(b"JSON", json.as_bytes()), (b"BIN\0", binary)] {
        bytes.extend((data.len() as u32).to_le_bytes());
        bytes.extend(kind);
        bytes.extend(data);
    }
    bytes
}

fn megabytes() -> usize {
    std::env::var("JUGGLER_IMPORT_MEGABYTES").ok().and_then(|text| text.parse().ok()).unwrap_or(1)
}

/// Arrays of the shape of a real mesh: interleaved positions, normals and texture coordinates, and
/// indices.
#[test]
fn arrays_decode() {
    const STRIDE: usize = 32;
    let vertices = (megabytes() << 20) / (STRIDE + 24);
    let triangles = vertices * 2;
    let floats = (0..vertices * STRIDE / 4).map(|i| i as f32 * 0.25);
    let mut binary: Vec<u8> = floats.flat_map(f32::to_le_bytes).collect();
    let corner = |i: usize| (i.wrapping_mul(2_654_435_761) % (vertices - 2)) as u32;
    let indices = (0..triangles).flat_map(|i| [corner(i), corner(i) + 1, corner(i) + 2]);
    binary.extend(indices.flat_map(u32::to_le_bytes));
    let (split, rest) = (vertices * STRIDE, triangles * 12);
    let json = format!(
        r#"{{"asset": {{"version": "2.0"}}, "buffers": [{{"byteLength": {}}}],
             "bufferViews": [{{"buffer": 0, "byteLength": {split}, "byteStride": {STRIDE}}},
                             {{"buffer": 0, "byteOffset": {split}, "byteLength": {rest}}}],
             "accessors": [{{"bufferView": 0, "componentType": 5126, "count": {vertices}, "type": "VEC3"}},
                           {{"bufferView": 0, "byteOffset": 12, "componentType": 5126, "count": {vertices}, "type": "VEC3"}},
                           {{"bufferView": 0, "byteOffset": 24, "componentType": 5126, "count": {vertices}, "type": "VEC2"}},
                           {{"bufferView": 1, "componentType": 5125, "count": {}, "type": "SCALAR"}}],
             "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}}, "indices": 3}}]}}]}}"#,
        binary.len(),
        triangles * 3
    );
    let bytes = glb(&json, &binary);
    let size = bytes.len() as f64 / 1e6;
    let start = Instant::now();
    let data = Gltf::open("a.glb", bytes, &Limits::default()).unwrap().load(&BTreeMap::new()).unwrap();
    let opened = start.elapsed().as_secs_f64();
    let positions = data.vec3(Index::from(0)).unwrap();
    let strided = start.elapsed().as_secs_f64() - opened;
    let Assembly::Arrays(arrays) = data.assemble(0, 0).unwrap() else { panic!("no arrays") };
    let assembled = start.elapsed().as_secs_f64() - opened - strided;
    assert_eq!((positions.len(), arrays.faces.len()), (vertices, triangles));
    assert_eq!(arrays.vertices.positions[1].to_array(), [2.0, 2.25, 2.5]);
    let view = split as f64 / 1e6;
    eprintln!(
        "{size:.1} MB: opened in {:.2} ms, strided positions {:.0} MB/s of the view, all arrays {:.0} MB/s",
        1e3 * opened,
        view / strided,
        size / assembled
    );
}

/// A document of many nodes.
#[test]
fn documents_open() {
    let count = 20_000;
    let node = |i: usize| {
        format!(r#"{{"mesh": 0, "name": "node {i}", "translation": [{i}, 0.5, -1.25], "rotation": [0, 0.6, 0, 0.8]}}"#)
    };
    let nodes: Vec<String> = (0..count).map(node).collect();
    let roots: Vec<String> = (0..count).map(|node| node.to_string()).collect();
    let json = format!(
        r#"{{"asset": {{"version": "2.0"}}, "meshes": [{{"primitives": []}}], "scenes": [{{"nodes": [{}]}}], "nodes": [{}]}}"#,
        roots.join(","),
        nodes.join(",")
    );
    let (bytes, start) = (json.into_bytes(), Instant::now());
    let size = bytes.len();
    let gltf = Gltf::open("a.gltf", bytes, &Limits::default()).unwrap();
    assert_eq!(gltf.document.nodes.len(), count);
    eprintln!("{count} nodes, {size} bytes: opened in {:.1} ms", start.elapsed().as_secs_f64() * 1e3);
}
