//! The container `.jfilm`. `README.md` of this crate describes it byte by byte.

mod chunk;
mod description;
mod error;
mod format;
mod layers;
mod pack;
mod read;
#[cfg(test)]
mod tests;
mod write;

pub use chunk::Chunk;
pub use description::{Description, Layered, MAX_PLANES, Mismatch, Share, Stop};
pub use error::PartError;
pub use read::{Part, Reader, is_part};
pub use write::{PartWriter, write};
