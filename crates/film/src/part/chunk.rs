//! The bytes of one tile: its runs, each with its samples' range and its packed sums.

use super::Description;
use super::layers;
use super::pack::{pack, unpack};
use juggler_camera::film::{Rect, Run, Tile};

/// Most runs that a tile in a file may have.
pub(super) const MAX_RUNS: usize = 4096;
/// Bytes before the packed sums of a run.
const RUN: usize = 12;

/// One tile as it stands in a file. Making it needs nothing else, so that many threads can.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Chunk {
    pub(super) pixels: Rect,
    pub(super) runs: usize,
    /// Whether it says what clamping took off the pixels.
    pub(super) clamped: bool,
    pub(super) bytes: Vec<u8>,
    pub(super) hash: [u8; 32],
}

impl Chunk {
    /// Packs a tile of a picture that is clamped or not.
    pub fn encode(tile: &Tile, clamped: bool) -> Self {
        let mut bytes = Vec::new();
        for run in tile.runs() {
            let packed = pack(&run.sums, clamped);
            bytes.extend_from_slice(&run.samples.start.to_le_bytes());
            bytes.extend_from_slice(&run.samples.end.to_le_bytes());
            // A tile's sums are a few kilobytes.
            bytes.extend_from_slice(&(packed.len() as u32).to_le_bytes());
            bytes.extend_from_slice(&packed);
            bytes.extend_from_slice(&layers::pack(&run.extras, run.sums.len()));
        }
        let hash = *blake3::hash(&bytes).as_bytes();
        Self { pixels: tile.pixels(), runs: tile.runs().len(), clamped, bytes, hash }
    }
}

/// The tile that a chunk's bytes describe, for this picture; or what is wrong with them.
pub(super) fn decode(mut bytes: &[u8], pixels: Rect, picture: &Description) -> Result<Tile, String> {
    let Description { samples, clamped, layers: ref kept, .. } = *picture;
    let mut tile = Tile::new(pixels);
    let mut runs = 0;
    while !bytes.is_empty() {
        let (head, rest) = bytes.split_first_chunk::<RUN>().ok_or("a run of samples ends too early")?;
        let [a, b, c, d, e, f, g, h, i, j, k, l] = *head;
        let range = u32::from_le_bytes([a, b, c, d])..u32::from_le_bytes([e, f, g, h]);
        let length = u32::from_le_bytes([i, j, k, l]) as usize;
        let (packed, rest) = rest.split_at_checked(length).ok_or("a run of samples ends too early")?;
        runs += 1;
        if runs > MAX_RUNS {
            return Err(format!("it has more than {MAX_RUNS} runs of samples"));
        }
        if range.end > samples {
            return Err(format!("it has samples up to {}, its picture {samples}", range.end));
        }
        let sums = unpack(packed, pixels.area() as usize, clamped).ok_or("packed sums cannot be unpacked")?;
        let unpacked = layers::unpack(rest, sums.len(), kept);
        let (extras, rest) = unpacked.ok_or("packed layers cannot be unpacked")?;
        tile.add(Run { samples: range, sums, extras }).map_err(|error| error.to_string())?;
        bytes = rest;
    }
    Ok(tile)
}
