//! The fixed parts of the format: prelude, head, index, seal.

use super::Description;
use serde::{Deserialize, Serialize};

/// Begins every file: a byte that is no text, the name, and a line end that a transfer as text would change.
pub(super) const MAGIC: [u8; 8] = *b"\x89JFILM\r\n";
/// The version that this program writes and reads.
pub(super) const VERSION: u32 = 1;
/// Bytes before the head.
pub(super) const PRELUDE: usize = 32;
/// Bytes of an entry of the index.
pub(super) const ENTRY: usize = 44;
/// Bytes of the hash at the end.
pub(super) const SEAL: usize = 32;
/// Most bytes that a head may have.
pub(super) const MAX_HEAD: u32 = 1 << 24;

/// The first bytes of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Prelude {
    pub version: u32,
    /// Bytes of the head.
    pub head: u32,
    /// Bytes of the whole file.
    pub length: u64,
    /// How many chunks there are.
    pub chunks: u64,
}

impl Prelude {
    pub fn to_bytes(self) -> [u8; PRELUDE] {
        let mut bytes = [0; PRELUDE];
        let parts: [&[u8]; 5] = [
            &MAGIC,
            &self.version.to_le_bytes(),
            &self.head.to_le_bytes(),
            &self.length.to_le_bytes(),
            &self.chunks.to_le_bytes(),
        ];
        bytes.iter_mut().zip(parts.concat()).for_each(|(byte, value)| *byte = value);
        bytes
    }

    /// Of bytes that begin with [`MAGIC`].
    pub fn of_bytes(bytes: &[u8; PRELUDE]) -> Self {
        let [.., a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v, w, x] = *bytes;
        Self {
            version: u32::from_le_bytes([a, b, c, d]),
            head: u32::from_le_bytes([e, f, g, h]),
            length: u64::from_le_bytes([i, j, k, l, m, n, o, p]),
            chunks: u64::from_le_bytes([q, r, s, t, u, v, w, x]),
        }
    }

    /// Where the chunks begin and where the index does; `None` when the numbers do not fit each other.
    pub fn places(&self) -> Option<(u64, u64)> {
        let chunks = PRELUDE as u64 + u64::from(self.head);
        let index = self.length.checked_sub(SEAL as u64)?.checked_sub(self.chunks.checked_mul(ENTRY as u64)?)?;
        (chunks <= index).then_some((chunks, index))
    }
}

/// What the index says of a chunk. Chunks follow each other without a gap, in the order of the index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Entry {
    /// Number of the tile in the region's layout.
    pub tile: u64,
    /// Bytes of the chunk.
    pub length: u32,
    /// Its hash.
    pub hash: [u8; 32],
}

impl Entry {
    pub fn append_to(&self, bytes: &mut Vec<u8>) {
        bytes.extend_from_slice(&self.tile.to_le_bytes());
        bytes.extend_from_slice(&self.length.to_le_bytes());
        bytes.extend_from_slice(&self.hash);
    }

    pub fn of_bytes(bytes: &[u8; ENTRY]) -> Self {
        let [a, b, c, d, e, f, g, h, i, j, k, l, hash @ ..] = *bytes;
        Self { tile: u64::from_le_bytes([a, b, c, d, e, f, g, h]), length: u32::from_le_bytes([i, j, k, l]), hash }
    }
}

/// The head: JSON that people can read.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Head {
    /// What a chunk holds for each run of samples, in this order.
    pub layers: Vec<Layer>,
    /// The rest.
    pub part: Description,
}

/// Values of each pixel that belong together.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Layer {
    pub name: String,
    pub channels: Vec<String>,
}

/// What chunks of this version hold of each pixel of a picture.
pub(super) fn layers(picture: &Description) -> Vec<Layer> {
    let layer = |name: &str, channels: &[&str]| Layer {
        name: name.into(),
        channels: channels.iter().map(ToString::to_string).collect(),
    };
    let mut layers = vec![layer("radiance", &["R", "G", "B"])];
    if picture.clamped {
        layers.push(layer("clamped", &["mean"]));
    }
    if picture.layers.planes > 0 {
        layers.push(layer("planes", &["R", "G", "B"]));
    }
    if picture.layers.masks {
        layers.push(layer("masks", &["entry", "material", "shape"]));
    }
    layers
}

/// `radiance (R, G, B)`.
pub(super) fn in_words(layers: &[Layer]) -> String {
    let word = |layer: &Layer| format!("{} ({})", layer.name, layer.channels.join(", "));
    layers.iter().map(word).collect::<Vec<_>>().join(", ")
}
