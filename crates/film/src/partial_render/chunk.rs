//! Encoding of one tile: its runs, each with its sample range and its compressed sums.

use super::RenderDescription;
use super::aovs;
use super::pack::{pack, unpack};
use juggler_camera::film::{Rect, SampleRun, Tile};

/// Maximum number of runs of a tile in a file.
pub(super) const MAX_RUNS: usize = 4096;
/// Bytes before a run's compressed sums: first sample, end, compressed length.
const RUN: usize = 12;

/// An encoded tile with its hash. Encoding needs no shared state, so render threads can do it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Chunk {
    pub(super) pixels: Rect,
    pub(super) runs: usize,
    /// Whether the sums include the radiance removed by clamping.
    pub(super) clamped: bool,
    pub(super) bytes: Vec<u8>,
    pub(super) hash: [u8; 32],
}

impl Chunk {
    /// Encodes a tile; `clamped` says whether its image clamps samples.
    pub fn encode(tile: &Tile, clamped: bool) -> Self {
        let mut bytes = Vec::new();
        for run in tile.runs() {
            let packed = pack(&run.sums, clamped);
            bytes.extend_from_slice(&run.samples.start.to_le_bytes());
            bytes.extend_from_slice(&run.samples.end.to_le_bytes());
            // The sums of a tile take a few kilobytes, so the length fits 32 bits.
            bytes.extend_from_slice(&(packed.len() as u32).to_le_bytes());
            bytes.extend_from_slice(&packed);
            bytes.extend_from_slice(&aovs::pack(&run.aov_sums, run.sums.len()));
        }
        let hash = *blake3::hash(&bytes).as_bytes();
        Self { pixels: tile.pixels(), runs: tile.runs().len(), clamped, bytes, hash }
    }
}

/// Decodes a chunk's bytes into the tile at `pixels`, or says what is wrong with them.
pub(super) fn decode(mut bytes: &[u8], pixels: Rect, picture: &RenderDescription) -> Result<Tile, String> {
    let RenderDescription { samples, clamped, ref aovs, .. } = *picture;
    let mut tile = Tile::new(pixels);
    let mut runs = 0;
    while !bytes.is_empty() {
        let (header, rest) = bytes.split_first_chunk::<RUN>().ok_or("a run of samples ends too early")?;
        let [a, b, c, d, e, f, g, h, i, j, k, l] = *header;
        let range = u32::from_le_bytes([a, b, c, d])..u32::from_le_bytes([e, f, g, h]);
        let length = u32::from_le_bytes([i, j, k, l]) as usize;
        let (packed, rest) = rest.split_at_checked(length).ok_or("a run of samples ends too early")?;
        runs += 1;
        if runs > MAX_RUNS {
            return Err(format!("it has more than {MAX_RUNS} runs of samples"));
        }
        if range.end > samples {
            return Err(format!("it has samples up to {}, but its picture has {samples}", range.end));
        }
        let sums = unpack(packed, pixels.area() as usize, clamped).ok_or("packed sums cannot be unpacked")?;
        let unpacked = aovs::unpack(rest, sums.len(), aovs);
        let (aov_sums, rest) = unpacked.ok_or("packed AOVs cannot be unpacked")?;
        tile.add(SampleRun { samples: range, sums, aov_sums }).map_err(|error| error.to_string())?;
        bytes = rest;
    }
    Ok(tile)
}
