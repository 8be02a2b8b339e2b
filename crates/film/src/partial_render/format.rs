//! Fixed structures of the format: prelude, header, index, seal.

use super::RenderDescription;
use serde::{Deserialize, Serialize};

/// Magic number: a byte that is not ASCII, the name, and a line end that text-mode transfers would
/// change.
pub(super) const MAGIC: [u8; 8] = *b"\x89JFILM\r\n";
/// Format version that this program writes and reads.
pub(super) const VERSION: u32 = 1;
/// Length of the prelude in bytes.
pub(super) const PRELUDE: usize = 32;
/// Length of an index entry in bytes.
pub(super) const ENTRY: usize = 44;
/// Length of the closing hash in bytes.
pub(super) const SEAL: usize = 32;
/// Maximum length of the header in bytes.
pub(super) const MAX_HEADER: u32 = 1 << 24;

/// The prelude: the fixed first bytes of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Prelude {
    pub version: u32,
    /// Length of the header in bytes.
    pub header: u32,
    /// Length of the whole file in bytes.
    pub length: u64,
    /// Number of chunks.
    pub chunks: u64,
}

impl Prelude {
    pub fn to_bytes(self) -> [u8; PRELUDE] {
        let mut bytes = [0; PRELUDE];
        let parts: [&[u8]; 5] = [
            &MAGIC,
            &self.version.to_le_bytes(),
            &self.header.to_le_bytes(),
            &self.length.to_le_bytes(),
            &self.chunks.to_le_bytes(),
        ];
        bytes.iter_mut().zip(parts.concat()).for_each(|(byte, value)| *byte = value);
        bytes
    }

    /// Parses bytes that begin with [`MAGIC`].
    pub fn from_bytes(bytes: &[u8; PRELUDE]) -> Self {
        let [.., a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v, w, x] = *bytes;
        Self {
            version: u32::from_le_bytes([a, b, c, d]),
            header: u32::from_le_bytes([e, f, g, h]),
            length: u64::from_le_bytes([i, j, k, l, m, n, o, p]),
            chunks: u64::from_le_bytes([q, r, s, t, u, v, w, x]),
        }
    }

    /// Offsets of the first chunk and of the index; `None` if the lengths contradict each other.
    pub fn offsets(&self) -> Option<(u64, u64)> {
        let chunks = PRELUDE as u64 + u64::from(self.header);
        let index = self.length.checked_sub(SEAL as u64)?.checked_sub(self.chunks.checked_mul(ENTRY as u64)?)?;
        (chunks <= index).then_some((chunks, index))
    }
}

/// Index entry of a chunk. Chunks are contiguous and in index order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Entry {
    /// Number of the tile in the region's layout.
    pub tile: u64,
    /// Length of the chunk in bytes.
    pub length: u32,
    /// BLAKE3 hash of the chunk.
    pub hash: [u8; 32],
}

impl Entry {
    pub fn append_to(&self, bytes: &mut Vec<u8>) {
        bytes.extend_from_slice(&self.tile.to_le_bytes());
        bytes.extend_from_slice(&self.length.to_le_bytes());
        bytes.extend_from_slice(&self.hash);
    }

    pub fn from_bytes(bytes: &[u8; ENTRY]) -> Self {
        let [a, b, c, d, e, f, g, h, i, j, k, l, hash @ ..] = *bytes;
        Self { tile: u64::from_le_bytes([a, b, c, d, e, f, g, h]), length: u32::from_le_bytes([i, j, k, l]), hash }
    }
}

/// The header: human-readable JSON.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Header {
    /// Layers that a chunk stores for each run of samples, in this order.
    pub layers: Vec<Layer>,
    /// Description of the partial render.
    #[serde(rename = "part")]
    pub partial_render: RenderDescription,
}

/// A named group of per-pixel channels.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Layer {
    pub name: String,
    pub channels: Vec<String>,
}

/// Layers that chunks of this version store for an image.
pub(super) fn layers(picture: &RenderDescription) -> Vec<Layer> {
    let layer = |name: &str, channels: &[&str]| Layer {
        name: name.into(),
        channels: channels.iter().map(ToString::to_string).collect(),
    };
    let mut layers = vec![layer("radiance", &["R", "G", "B"])];
    if picture.clamped {
        layers.push(layer("clamped", &["mean"]));
    }
    if picture.aovs.planes > 0 {
        layers.push(layer("planes", &["R", "G", "B"]));
    }
    if picture.aovs.masks {
        layers.push(layer("masks", &["entry", "material", "shape"]));
    }
    layers
}

/// Formats layers for messages, such as `radiance (R, G, B)`.
pub(super) fn describe(layers: &[Layer]) -> String {
    let word = |layer: &Layer| format!("{} ({})", layer.name, layer.channels.join(", "));
    layers.iter().map(word).collect::<Vec<_>>().join(", ")
}
