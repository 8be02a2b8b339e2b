//! Models of the format glTF: seeds made here, and the reader under test.

use juggler_import::gltf::document::Index;
use juggler_import::gltf::{Assembly, Faces, Gltf, GltfData, Limits, PrimitiveArrays};
use std::collections::BTreeMap;

/// Maximum number of decoded bytes of a model.
const MODEL_BYTES: u64 = 256 << 20;

/// Members of a document that refer to [`buffer`]: all types of components, sparse elements, a
/// compressed view, a skin, morph targets, an animation, materials and lights. `#` is the buffer.
const DOCUMENT: &str = r##"{"asset": {"version": "2.0", "generator": "a"},
 "extensionsUsed": ["KHR_materials_clearcoat", "KHR_materials_volume", "KHR_lights_punctual", "KHR_texture_transform",
  "EXT_mesh_gpu_instancing", "EXT_meshopt_compression", "KHR_materials_variants"], "scene": 0, "scenes": [{"nodes": [0, 3, 4]}],
 "nodes": [{"mesh": 0, "skin": 0, "children": [1, 2], "weights": [0.5]}, {"translation": [0, 1, 0], "rotation": [0, 0.6, 0, 0.8]},
  {"matrix": [2,0,0,0, 0,1,0,0, 0,0,1,0, 0,3,0,1], "camera": 0}, {"extensions": {"KHR_lights_punctual": {"light": 0}}},
  {"mesh": 1, "extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 0}}}}],
 "cameras": [{"type": "perspective", "perspective": {"yfov": 0.7, "aspectRatio": 1.5, "znear": 0.1}}],
 "skins": [{"joints": [1, 2]}], "animations": [{"samplers": [{"input": 4, "output": 0, "interpolation": "CUBICSPLINE"}],
  "channels": [{"sampler": 0, "target": {"node": 1, "path": "translation"}}]}],
 "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 0, "TEXCOORD_0": 1, "COLOR_0": 2, "JOINTS_0": 3,
   "WEIGHTS_0": 2}, "indices": 5, "mode": 5, "material": 0, "targets": [{"POSITION": 6}],
   "extensions": {"KHR_materials_variants": {"mappings": [{"variants": [0], "material": 0}]}}}]},
  {"primitives": [{"attributes": {"POSITION": 0}, "mode": 6}, {"attributes": {"POSITION": 7, "_A": 7}, "mode": 2}]}],
 "materials": [{"name": "a", "pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0.25, 1], "metallicFactor": 0,
   "baseColorTexture": {"index": 0, "extensions": {"KHR_texture_transform": {"offset": [0, 1], "scale": [2, 2]}}}},
  "alphaMode": "MASK", "doubleSided": true, "extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 1},
   "KHR_materials_volume": {"thicknessFactor": 1, "attenuationDistance": 2}}}],
 "textures": [{"source": 0, "sampler": 0}], "samplers": [{"magFilter": 9729, "wrapS": 33071}], "images": [{"bufferView": 1}],
 "accessors": [{"bufferView": 0, "componentType": 5126, "count": 6, "type": "VEC3", "min": [0, 0, 0], "max": [17, 18, 19]},
  {"bufferView": 1, "componentType": 5123, "count": 6, "type": "VEC2", "normalized": true},
  {"bufferView": 1, "componentType": 5121, "count": 6, "type": "VEC4", "normalized": true},
  {"bufferView": 1, "componentType": 5121, "count": 6, "type": "VEC4"},
  {"bufferView": 3, "componentType": 5126, "count": 2, "type": "SCALAR"},
  {"bufferView": 2, "componentType": 5121, "count": 6, "type": "SCALAR"},
  {"componentType": 5126, "count": 6, "type": "VEC3", "sparse": {"count": 2, "indices": {"bufferView": 2, "componentType": 5121},
   "values": {"bufferView": 0}}}, {"bufferView": 4, "componentType": 5126, "count": 3, "type": "VEC3"},
  {"bufferView": 1, "componentType": 5120, "count": 2, "type": "MAT3"}],
 "bufferViews": [{"buffer": 0, "byteLength": 72}, {"buffer": 0, "byteOffset": 72, "byteLength": 24},
  {"buffer": 0, "byteOffset": 96, "byteLength": 6}, {"buffer": 0, "byteOffset": 104, "byteLength": 8},
  {"buffer": 0, "byteOffset": 0, "byteLength": 36, "byteStride": 12, "extensions": {"EXT_meshopt_compression": {"buffer": 0,
   "byteOffset": 112, "byteLength": 45, "byteStride": 12, "count": 3, "mode": "ATTRIBUTES"}}}],
 "extensions": {"KHR_lights_punctual": {"lights": [{"type": "spot", "spot": {"outerConeAngle": 0.5}}]},
  "KHR_materials_variants": {"variants": [{"name": "a"}]}}, "buffers": [{"byteLength": 157#}]}"##;

/// Texts with the buffer as data URI.
pub fn texts() -> Vec<Vec<u8>> {
    let uri = format!(r#", "uri": "data:application/octet-stream;base64,{}""#, base64(&buffer()));
    let small = r#"{"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"name": "a"}]}"#;
    vec![DOCUMENT.replace('#', &uri).into_bytes(), small.as_bytes().to_vec()]
}

/// Binary files.
pub fn binaries() -> Vec<Vec<u8>> {
    let json = DOCUMENT.replace('#', "");
    vec![glb(json.as_bytes(), &buffer()), glb(br#"{"asset": {"version": "2.0"}}"#, &[])]
}

/// Positions, other numbers, indices, times and a compressed array.
fn buffer() -> Vec<u8> {
    let mut bytes: Vec<u8> = (0..18_u8).map(|i| f32::from(i % 7)).flat_map(f32::to_le_bytes).collect();
    bytes.extend([0, 1, 0, 255, 3, 4, 127, 128, 8, 0, 1, 1, 200, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23]);
    bytes.extend([0, 1, 2, 3, 4, 5, 0, 0]);
    bytes.extend([0.0_f32, 1.5].into_iter().flat_map(f32::to_le_bytes));
    // A stream of three elements that all equal the one at its end: zeros.
    bytes.push(0xa0);
    bytes.extend([0; 44]);
    bytes
}

/// A binary file of a text and a buffer, padded to multiples of four bytes.
fn glb(json: &[u8], buffer: &[u8]) -> Vec<u8> {
    let chunk = |kind: &[u8], data: &[u8], fill: u8| {
        let padding = vec![fill; data.len().next_multiple_of(4) - data.len()];
        let length = (data.len() + padding.len()) as u32;
        [&length.to_le_bytes(), kind, data, &padding].concat()
    };
    let body = [chunk(b"JSON", json, b' '), chunk(b"BIN\0", buffer, 0)].concat();
    [&b"glTF\x02\0\0\0"[..], &(body.len() as u32 + 12).to_le_bytes(), &body].concat()
}

/// Base64 of bytes (RFC 4648).
fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let triple = |bytes: &[u8]| {
        let bits = (0..3).fold(0_u32, |bits, i| bits << 8 | bytes.get(i).copied().map_or(0, u32::from));
        let digits = (0..4).map(move |i| (i, (bits >> (18 - 6 * i)) & 63));
        let length = bytes.len();
        digits
            .map(move |(i, digit)| if i > length { '=' } else { char::from(DIGITS[digit as usize]) })
            .collect::<Vec<_>>()
    };
    bytes.chunks(3).flat_map(triple).collect()
}

/// Recomputes the lengths of the file and of its first two chunks, if the second is still found.
pub fn repair(bytes: &mut [u8]) {
    if !bytes.starts_with(b"glTF") {
        return;
    }
    let total = bytes.len();
    let Some(kind) = bytes.windows(4).position(|four| four == b"BIN\0") else { return };
    let (Some(json), Some(binary)) = (kind.checked_sub(24), total.checked_sub(kind + 4)) else { return };
    for (at, length) in [(8, total), (12, json), (kind - 4, binary)] {
        bytes.iter_mut().skip(at).zip((length as u32).to_le_bytes()).for_each(|(byte, new)| *byte = new);
    }
}

/// Opens a file, decodes all accessors and assembles all primitives; whether all are valid.
pub fn read(name: &str, bytes: &[u8]) -> bool {
    let limits = Limits { decoded_bytes: MODEL_BYTES, ..Limits::default() };
    let data = Gltf::open(name, bytes.to_vec(), &limits).and_then(|gltf| gltf.load(&BTreeMap::new()));
    let data = match data {
        Ok(data) => data,
        Err(error) => {
            let text = error.to_string();
            assert!(text.starts_with(&format!("{name}: ")) && !text.contains('\u{1b}'), "no plain words: {text}");
            return false;
        }
    };
    let accessors = 0..u32::try_from(data.gltf.document.accessors.len()).unwrap_or(u32::MAX);
    let decoded = accessors.fold(true, |all, accessor| all & accepts_accessor(&data, Index::from(accessor)));
    let meshes = data.gltf.document.meshes.iter().enumerate();
    let parts = meshes.flat_map(|(mesh, found)| (0..found.primitives.len()).map(move |part| (mesh, part)));
    parts.fold(decoded, |all, (mesh, part)| all & accepts_primitive(&data, mesh, part))
}

fn accepts_accessor(data: &GltfData, accessor: Index) -> bool {
    data.numbers(accessor).is_ok_and(|numbers| {
        assert!(numbers.iter().all(|number| number.is_finite()), "a number is not finite");
        true
    })
}

fn accepts_primitive(data: &GltfData, mesh: usize, part: usize) -> bool {
    match data.assemble(mesh, part) {
        Ok(Assembly::Arrays(arrays)) => {
            check(&arrays);
            true
        }
        Ok(_) => true,
        Err(_) => false,
    }
}

/// Checks what users of the arrays rely on.
fn check(arrays: &PrimitiveArrays) {
    let vertices = &arrays.vertices;
    let count = vertices.positions.len();
    let is_valid = |index: &u32| (*index as usize) < count;
    let all_valid = match &arrays.faces {
        Faces::Points(points) => points.iter().all(is_valid),
        Faces::Lines(lines) => lines.iter().flatten().all(is_valid),
        Faces::Triangles(triangles) => triangles.iter().flatten().all(is_valid),
    };
    assert!(all_valid, "an index is out of range");
    let lengths = [vertices.normals.len(), vertices.tangents.len(), vertices.colors.len()];
    let sets = vertices.texcoords.iter().map(Vec::len).chain(arrays.joints.iter().map(|set| set.weights.len()));
    assert!(
        lengths.into_iter().chain(sets).all(|length| length == 0 || length == count),
        "an array has another length"
    );
}
