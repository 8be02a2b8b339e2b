//! Movie files: frames are encoded in order, each as soon as it is rendered.

mod apng;
mod changes;
mod check;
mod frame_time;
mod gif;
#[cfg(feature = "av1")]
mod mp4;
mod webp;

pub use check::FRAME_RATES;

use crate::output::{self, Destination};
use crate::tone::Tone;
use crate::{ImageError, atomic};
use juggler_math::PixelRows;
use std::fmt;
use std::path::Path;

/// Default quality of lossy formats; docs/benchmarks.md compares sizes and errors.
pub const DEFAULT_QUALITY: u8 = 80;

/// Movie file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum AnimationFormat {
    /// Animated PNG, 8 bits per channel, lossless.
    Apng,
    /// GIF, 256 colors per frame, times in 1/100 s.
    Gif,
    /// MP4 with AV1 video, lossy: the smallest files, for video players and browsers.
    #[cfg(feature = "av1")]
    Mp4,
    /// Animated WebP, 8 bits per channel, lossless, times in 1/1000 s.
    Webp,
}

impl AnimationFormat {
    /// All movie formats.
    pub const ALL: &[Self] = &[
        Self::Apng,
        Self::Gif,
        #[cfg(feature = "av1")]
        Self::Mp4,
        Self::Webp,
    ];

    /// Format for the path's file extension, ignoring case.
    pub fn from_path(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?.to_ascii_lowercase();
        Self::ALL.iter().copied().find(|format| format.extension() == extension)
    }

    /// File extension without the dot.
    pub fn extension(self) -> &'static str {
        match self {
            Self::Apng => "apng",
            Self::Gif => "gif",
            #[cfg(feature = "av1")]
            Self::Mp4 => "mp4",
            Self::Webp => "webp",
        }
    }

    /// All file extensions, for messages.
    pub fn extensions() -> String {
        Self::ALL.iter().map(|format| format!(".{}", format.extension())).collect::<Vec<_>>().join(" ")
    }
}

impl fmt::Display for AnimationFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Apng => "APNG",
            Self::Gif => "GIF",
            #[cfg(feature = "av1")]
            Self::Mp4 => "MP4",
            Self::Webp => "WebP",
        })
    }
}

/// Properties of a movie file besides its frames.
#[derive(Clone, Debug, PartialEq)]
pub struct AnimationHeader {
    /// Frame width in pixels.
    pub width: u32,
    /// Frame height in pixels.
    pub height: u32,
    /// Tone mapping from linear RGB to 8-bit levels.
    pub tone: Tone,
    /// Number of frames, at least 1.
    pub frames: u32,
    /// Frames per second, above 0.
    pub frames_per_second: f64,
    /// How often the movie plays; 0 loops forever. MP4 ignores it.
    pub plays: u16,
    /// Quality from 1 (smallest file) to 100 (best); lossless formats ignore it.
    pub quality: u8,
    /// Whether the frames have alpha; GIF stores whether it is at least ½.
    pub transparent: bool,
}

impl AnimationHeader {
    /// Creates a header for a movie in sRGB that loops forever, at quality 80.
    pub fn new(width: u32, height: u32, frames: u32, frames_per_second: f64) -> Self {
        let (tone, quality) = (Tone::default(), DEFAULT_QUALITY);
        Self { width, height, tone, frames, frames_per_second, plays: 0, quality, transparent: false }
    }

    /// Whether the movie has alpha: colors over the backdrop of the tone are opaque.
    fn has_alpha(&self) -> bool {
        self.transparent && self.tone.backdrop.is_none()
    }
}

/// Encoder that takes frames in order.
pub trait FrameWriter: Send {
    /// Encodes the next frame, given all pixels in linear RGB, row by row from the top. Their alpha
    /// counts if the movie is transparent.
    fn write_frame(&mut self, pixels: PixelRows) -> Result<(), ImageError>;

    /// Completes the file after the last frame; without this call the file is invalid.
    fn finish(self: Box<Self>) -> Result<(), ImageError>;
}

/// Creates a writer for a format. Invalid sizes, frame rates and qualities are rejected before
/// anything is written.
pub fn animation_writer(
    format: AnimationFormat,
    destination: Destination,
    header: &AnimationHeader,
) -> Result<Box<dyn FrameWriter>, ImageError> {
    let file = destination.name().to_owned();
    format.check(&file, header)?;
    let header = &AnimationHeader { transparent: header.has_alpha(), ..header.clone() };
    let inner: Box<dyn FrameWriter> = match format {
        AnimationFormat::Apng => Box::new(apng::Writer::new(destination, header)?),
        AnimationFormat::Gif => Box::new(gif::Writer::new(destination, header)?),
        #[cfg(feature = "av1")]
        AnimationFormat::Mp4 => Box::new(mp4::Writer::new(destination, header)?),
        AnimationFormat::Webp => Box::new(webp::Writer::new(destination, header)?),
    };
    let pixels = u64::from(header.width) * u64::from(header.height);
    Ok(Box::new(FrameCountCheck { inner, file, pixels, left: header.frames }))
}

/// Creates a writer to a file; the file appears at `path` only once it is finished.
pub fn create_animation(
    path: &Path,
    format: AnimationFormat,
    header: &AnimationHeader,
) -> Result<Box<dyn FrameWriter>, ImageError> {
    let (destination, file) = output::whole_file(path)?;
    let name = destination.name().to_owned();
    let frames = animation_writer(format, destination, header)?;
    Ok(Box::new(WholeFile { frames, file, name }))
}

fn refused(file: &str, message: impl Into<String>) -> ImageError {
    ImageError::Animation { file: file.to_owned(), message: message.into() }
}

/// Checks that the encoder gets complete frames, as many as the header announces.
struct FrameCountCheck {
    inner: Box<dyn FrameWriter>,
    file: String,
    /// Pixels of a frame.
    pixels: u64,
    left: u32,
}

impl FrameWriter for FrameCountCheck {
    fn write_frame(&mut self, pixels: PixelRows) -> Result<(), ImageError> {
        let given = pixels.len() as u64;
        if given != self.pixels {
            return Err(refused(&self.file, format!("a frame has {} pixels, not {given}", self.pixels)));
        }
        self.left =
            self.left.checked_sub(1).ok_or_else(|| refused(&self.file, "all of its frames have been written"))?;
        self.inner.write_frame(pixels)
    }

    fn finish(self: Box<Self>) -> Result<(), ImageError> {
        if self.left > 0 {
            return Err(refused(&self.file, format!("{} of its frames are missing", self.left)));
        }
        self.inner.finish()
    }
}

/// Moves the completed file to its destination.
struct WholeFile {
    frames: Box<dyn FrameWriter>,
    file: Option<atomic::AtomicFile>,
    name: String,
}

impl FrameWriter for WholeFile {
    fn write_frame(&mut self, pixels: PixelRows) -> Result<(), ImageError> {
        self.frames.write_frame(pixels)
    }

    fn finish(self: Box<Self>) -> Result<(), ImageError> {
        self.frames.finish()?;
        let name = self.name;
        self.file.map_or(Ok(()), |file| file.commit().map_err(|source| ImageError::Write { file: name, source }))
    }
}
