//! Film: sums of samples, in an order that depends only on the sample indices. `README.md` in this
//! folder explains why partial renders merge in any order.
//!
//! The samples of a pixel are summed in order within blocks of [`BLOCK_SAMPLES`] consecutive
//! indices, and block sums are added along a fixed binary tree over the block numbers. Every thread
//! and machine performs the same additions, so the result has the same bits.

mod aov_sums;
mod canvas;
mod clamped_radiance;
mod film_digest;
mod filter;
mod sum;
#[cfg(test)]
mod tests;
mod tile;
mod tiling;

pub use aov_sums::{AovSums, CoverageMask, HitIds, InvalidMask, MASKS};
pub use canvas::Film;
pub use clamped_radiance::ClampedRadiance;
pub use film_digest::{FilmDigest, FilmSummary};
pub use filter::{
    AnyFilter, Box, FilterSample, FilterSampler, FilterTable, Gaussian, Juggler, Mitchell, ReconstructionFilter, Tent,
};
pub use sum::is_counted;
pub use sum::{Accumulator, PixelSamples, Sum, runs};
pub use tile::{PixelStatistics, SampleRun, Tile, TileError};
pub use tiling::{Rect, TILE_EDGE, Tiling};

/// Samples in a block.
pub const BLOCK_SAMPLES: u32 = 16;
