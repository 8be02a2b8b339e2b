//! The film: sums of samples, in an order that nothing but the sample indices decides. `README.md` in this folder
//! explains why parts can be joined in any order.
//!
//! A pixel's samples are summed in blocks of [`BLOCK`] consecutive indices, each block in order, and blocks are joined
//! along a fixed binary tree over their numbers. Whoever renders which block, on which thread or machine, the
//! additions are the same ones, so the bits are too.

mod canvas;
mod clamped;
mod digest;
mod extras;
mod filter;
mod layout;
mod sum;
#[cfg(test)]
mod tests;
mod tile;

pub use canvas::Film;
pub use clamped::Clamped;
pub use digest::{Digest, Summary};
pub use extras::{Extras, InvalidMask, MASKS, Mark, Mask};
pub use filter::{AnyFilter, Box, Filter, FilterSample, Gaussian, Juggler, Mitchell, Reconstruction, Table, Tent};
pub use layout::{Layout, Rect, TILE};
pub use sum::is_counted;
pub use sum::{Accumulator, Samples, Sum, runs};
pub use tile::{Run, Statistics, Tile, TileError};

/// Samples in a block.
pub const BLOCK: u32 = 16;
