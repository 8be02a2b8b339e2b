//! Partial renders on disk (`.jfilm` files) and in memory: checkpoints, shards and merging.
//!
//! - [`checkpoint`]: saves a render in progress and resumes it;
//! - [`partial_render`]: the `.jfilm` container, which holds any samples of any tiles of one image
//!   with a description; hashes protect every byte, and this crate's `README.md` specifies the
//!   format;
//! - [`counts`]: samples per pixel of each tile, as text and as statistics;
//! - [`ledger`]: adds partial renders of several workers to one film, in any order;
//! - [`shard`]: splits an image or a range of frames into shards of about equal cost;
//! - [`mod@merge`]: merges partial renders into an image or a larger one, bit-identical to a
//!   single render.

pub mod checkpoint;
pub mod counts;
pub mod ledger;
pub mod merge;
pub mod partial_render;
pub mod shard;
#[cfg(test)]
mod testing;

pub use checkpoint::{Checkpoint, OpenedCheckpoint, ResumeError, resume};
pub use ledger::{AddError, Added};
pub use merge::{Merge, MergeError, MergeGoal, MergeProblem, RemainingWork};
pub use partial_render::{
    AovDescription, Chunk, Mismatch, PartialRender, PartialRenderError, PartialRenderWriter, RenderDescription,
    ShardDescription, Stop, TileReader, is_partial_render, write,
};
