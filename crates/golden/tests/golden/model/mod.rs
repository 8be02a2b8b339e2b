//! Minimal glTF reader: positions and triangles of the first mesh.

use juggler::math::Vec3;
use juggler_golden::skipped;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Vertices and triangles of a file's first mesh, without node transforms.
pub struct Model {
    pub positions: Vec<Vec3>,
    pub triangles: Vec<[u32; 3]>,
}

impl Model {
    /// Reads the model `name` in the folder `gltf` of the test assets. `JUGGLER_ASSETS` is their
    /// folder, by default `../shared/assets` beside the workspace; `None` if it does not exist.
    pub fn asset(name: &str) -> Option<Self> {
        let beside = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/assets");
        let folder = std::env::var_os("JUGGLER_ASSETS").map_or_else(beside, PathBuf::from);
        if !folder.is_dir() {
            skipped(&format!("test assets: none in {}, set JUGGLER_ASSETS to their folder", folder.display()));
            return None;
        }
        let path = folder.join("gltf").join(name);
        let bytes = std::fs::read(&path).unwrap();
        let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
        // A binary file: 12 bytes, then length, type and bytes of the JSON chunk, then the same of
        // the buffer.
        if bytes.starts_with(b"glTF") {
            let buffer = 20 + word(12) + 8;
            return Some(Self::new(&serde_json::from_slice(&bytes[20..buffer - 8]).unwrap(), &bytes[buffer..]));
        }
        let document: Value = serde_json::from_slice(&bytes).unwrap();
        let buffer = path.with_file_name(document["buffers"][0]["uri"].as_str().unwrap());
        Some(Self::new(&document, &std::fs::read(buffer).unwrap()))
    }

    fn new(document: &Value, buffer: &[u8]) -> Self {
        let mesh = &document["meshes"][0]["primitives"][0];
        let bytes = |accessor: &Value, size: usize| {
            let accessor = &document["accessors"][number(accessor)];
            let view = &document["bufferViews"][number(&accessor["bufferView"])];
            let start = number(&view["byteOffset"]) + number(&accessor["byteOffset"]);
            buffer[start..start + number(&accessor["count"]) * size].chunks_exact(size)
        };
        let float = |bytes: &[u8]| f32::from_le_bytes(bytes.try_into().unwrap());
        let point = |p: &[u8]| Vec3::new(float(&p[0..4]), float(&p[4..8]), float(&p[8..12]));
        let positions: Vec<Vec3> = bytes(&mesh["attributes"]["POSITION"], 12).map(point).collect();
        let corners: Vec<u32> = match &mesh["indices"] {
            Value::Null => (0..positions.len() as u32).collect(),
            indices => bytes(indices, 2).map(|b| u16::from_le_bytes([b[0], b[1]]).into()).collect(),
        };
        let triangles = corners.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect();
        Self { positions, triangles }
    }

    /// Returns a scaled copy.
    pub fn scaled(&self, factor: f32) -> Self {
        Self { positions: self.positions.iter().map(|p| *p * factor).collect(), triangles: self.triangles.clone() }
    }

    /// Minimum and maximum coordinates.
    pub fn corners(&self) -> (Vec3, Vec3) {
        let all = || self.positions.iter().copied();
        (all().fold(Vec3::INFINITY, Vec3::min), all().fold(Vec3::NEG_INFINITY, Vec3::max))
    }
}

/// An integer of the document; a missing one is 0.
fn number(value: &Value) -> usize {
    value.as_u64().unwrap_or(0) as usize
}
