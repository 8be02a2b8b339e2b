//! Images in memory, for textures and backgrounds.

pub mod half;
mod mip_map;
mod sample;
mod texels;

pub use mip_map::{MipMap, Texel};
pub use sample::{Filter, Wrap};
