//! The `.jfilm` container, which this crate's `README.md` specifies byte by byte.

mod aovs;
mod chunk;
mod description;
mod error;
mod format;
mod pack;
mod read;
mod storage;
#[cfg(test)]
mod tests;
mod write;

pub use chunk::Chunk;
pub use description::{AovDescription, MAX_PLANES, Mismatch, RenderDescription, ShardDescription, Stop};
pub use error::PartialRenderError;
pub use read::{PartialRender, TileReader, is_partial_render};
pub use write::{PartialRenderWriter, write};
