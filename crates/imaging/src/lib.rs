//! Files of pixels and tone curves.
//!
//! Pictures are written as a stream of rows of linear light, so that a picture of 20,000 × 20,000 pixels
//! needs a few rows of memory (formats that need more say how much: [`Format::memory_needed`]). Reading gives a
//! whole [`juggler_math::Image`], for comparisons and textures.
//!
//! - [`tone`]: from linear light to levels of 8 or 16 bits;
//! - [`look`]: what may be done with the levels of a whole picture;
//! - [`codec`]: one file per format, writer and reader;
//! - [`layered`]: files of many layers;
//! - [`animation`]: files of moving pictures;
//! - [`output`], [`atomic`]: where bytes go; an existing picture is replaced only by a finished one;
//! - [`regular`]: opening files, and refusing what is no file;
//! - [`input`]: from a file to an image;
//! - [`raster`]: from a file to its samples as they are;
//! - [`mod@compare`]: how much two images differ;
//! - [`mod@flip`]: how different they look.

pub mod animation;
pub mod atomic;
pub mod codec;
pub mod compare;
mod error;
pub mod flip;
pub mod format;
pub mod input;
pub mod layered;
pub mod look;
pub mod output;
pub mod raster;
pub mod regular;
pub mod significance;
pub mod tone;
mod viewpoint;

pub use animation::{AnimationFormat, AnimationHeader, FrameWriter, animation_writer, create_animation};
pub use codec::{ExrCompression, Facts, Header, Options, RowWriter, SampleDepth, writer};
pub use compare::{Difference, compare};
pub use error::ImageError;
pub use flip::Flip;
pub use format::Format;
pub use input::{Limits, decode, inspect, read, read_within};
pub use look::Look;
pub use output::{Destination, create, to_standard_output, write_image};
pub use raster::{Encoding, Layout, Raster, Samples, decode_raster, inspect_raster};
pub use tone::{AnyCurve, Primaries, Tone, WhiteBalance};
pub use viewpoint::{Matrix4, Viewpoint};
