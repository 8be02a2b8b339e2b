//! Parts of pictures on disk: no work is ever lost.
//!
//! - [`checkpoint`]: work kept while it is done, and gone on with;
//! - [`part`]: the container `.jfilm`, any part of a picture with all that is known of it, every byte under a hash;
//!   `README.md` of this crate describes it byte by byte;
//! - [`counts`]: how many samples each tile got, as a text, and how many that is per pixel;
//! - [`share`]: how one picture, or a range of frames, is cut into parts that cost about the same;
//! - [`mod@merge`]: parts that belong together become one picture, or one part, with the bits of a single render.

pub mod checkpoint;
pub mod counts;
pub mod merge;
pub mod part;
pub mod share;
#[cfg(test)]
mod testing;

pub use checkpoint::{Checkpoint, Found, ResumeError, resume};
pub use merge::{Complaint, Merge, MergeError, ToDo, Wanted};
pub use part::{
    Chunk, Description, Layered, Mismatch, Part, PartError, PartWriter, Reader, Share, Stop, is_part, write,
};
