//! Pictures in memory, as textures and surroundings read them.

mod half;
mod pyramid;
mod sample;
mod texels;

pub use pyramid::{Pyramid, Texel};
pub use sample::{Filter, Wrap};
