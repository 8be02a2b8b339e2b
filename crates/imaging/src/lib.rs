//! Image and movie files, and tone mapping.
//!
//! Writers take a stream of rows in linear RGB, so that an image of 20,000 × 20,000 pixels needs
//! memory for a few rows only ([`ImageFormat::memory_needed`] tells which formats need more).
//! Readers return a whole [`juggler_math::Image`], for comparisons and textures.
//!
//! - [`tone`]: tone mapping from linear RGB to levels of 8 or 16 bits;
//! - [`look`]: display looks, which emulate old display modes on the levels of a whole image;
//! - [`codec`]: writer and reader of each image format;
//! - [`layered`]: files with several layers;
//! - [`animation`]: movie files;
//! - [`output`], [`atomic`]: destinations; a file is replaced only when the new one is complete;
//! - [`regular`]: opens regular files and rejects devices and pipes;
//! - [`input`]: reads files as linear images;
//! - [`raster`]: reads files as stored samples, for textures;
//! - [`raster_file`]: writes stored samples;
//! - [`mod@compare`]: error metrics between two images;
//! - [`mod@flip`]: perceived difference between two images;
//! - [`mod@significance`]: statistical test of whether two noisy images have the same mean.

pub mod animation;
pub mod atomic;
mod clamp_count;
pub mod codec;
pub mod compare;
mod error;
mod exr_windows;
pub mod flip;
pub mod format;
pub mod input;
pub mod layered;
pub mod look;
mod orientation;
pub mod output;
pub mod raster;
pub mod raster_file;
pub mod regular;
pub mod significance;
pub mod tone;
mod viewpoint;

pub use animation::{AnimationFormat, AnimationHeader, FrameWriter, animation_writer, create_animation};
pub use clamp_count::ClampCount;
pub use codec::{ExrCompression, GifLength, Header, ImageInfo, Options, RowWriter, SampleDepth, gif_length, writer};
pub use compare::{Difference, compare};
pub use error::ImageError;
pub use exr_windows::{CropFrame, ExrWindows, PixelWindow};
pub use flip::Flip;
pub use format::ImageFormat;
pub use input::{AlphaImage, Limits, decode, inspect, read, read_with_alpha, read_within};
pub use look::DisplayLook;
pub use output::{Destination, create, to_memory, to_standard_output, write_image};
pub use raster::{
    Raster, RasterHead, RasterLayout, RasterSamples, TransferFunction, decode_raster, inspect_raster, raster_head,
};
pub use raster_file::raster_bytes;
pub use tone::{AnyCurve, Matrix, Primaries, Tone, ToneCurveKind, WhiteBalance};
pub use viewpoint::{Matrix4, Viewpoint};
