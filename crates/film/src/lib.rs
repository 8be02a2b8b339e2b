//! Parts of pictures on disk: no work is ever lost.
//!
//! - [`part`]: the container `.jfilm`, any part of a picture with all that is known of it, every byte under a hash;
//!   `README.md` of this crate describes it byte by byte.

pub mod part;
#[cfg(test)]
mod testing;

pub use part::{Chunk, Description, Mismatch, Part, PartError, PartWriter, Reader, Share, Stop, is_part, write};
