//! Moving pictures in one file: frames in order, each written as soon as it is there.

mod apng;
mod changes;
mod check;
mod gif;
#[cfg(feature = "av1")]
mod mp4;
mod pace;
mod webp;

pub use check::PACES;

use crate::output::{self, Destination};
use crate::tone::Tone;
use crate::{ImageError, atomic};
use juggler_math::Rgb;
use std::fmt;
use std::path::Path;

/// Quality where nobody chooses it: see docs/benchmarks.md for what it costs and gives.
pub const DEFAULT_QUALITY: u8 = 80;

/// A file format for moving pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AnimationFormat {
    /// PNG with further frames, 8 bits, lossless.
    Apng,
    /// GIF: 256 colours a frame, times in hundredths of a second.
    Gif,
    /// MP4 with AV1: small, for video players and pages; something is lost.
    #[cfg(feature = "av1")]
    Mp4,
    /// WebP with several frames, 8 bits, lossless, times in thousandths of a second.
    Webp,
}

impl AnimationFormat {
    /// All of them.
    pub const ALL: &[Self] = &[
        Self::Apng,
        Self::Gif,
        #[cfg(feature = "av1")]
        Self::Mp4,
        Self::Webp,
    ];

    /// By the file's ending, whatever its case.
    pub fn from_path(path: &Path) -> Option<Self> {
        let ending = path.extension()?.to_str()?.to_ascii_lowercase();
        Self::ALL.iter().copied().find(|format| format.ending() == ending)
    }

    /// The usual ending, without a dot.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Apng => "apng",
            Self::Gif => "gif",
            #[cfg(feature = "av1")]
            Self::Mp4 => "mp4",
            Self::Webp => "webp",
        }
    }

    /// All endings, for messages.
    pub fn endings() -> String {
        Self::ALL.iter().map(|format| format!(".{}", format.ending())).collect::<Vec<_>>().join(" ")
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

/// What a file of moving pictures says besides its frames.
#[derive(Clone, Debug, PartialEq)]
pub struct AnimationHeader {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// From linear light to levels.
    pub tone: Tone,
    /// How many frames there will be, at least 1.
    pub frames: u32,
    /// Frames a second, above 0.
    pub frames_per_second: f64,
    /// How often it is shown; 0: over and over. MP4 leaves that to who shows it.
    pub plays: u16,
    /// From small, 1, to good, 100; where nothing is lost, it says nothing.
    pub quality: u8,
}

/// Takes frames in order.
pub trait FrameWriter: Send {
    /// The next frame: all pixels in linear light, row by row from the top.
    fn write_frame(&mut self, pixels: &[Rgb]) -> Result<(), ImageError>;

    /// Completes the file, after the last frame. Without this call there is no valid file.
    fn finish(self: Box<Self>) -> Result<(), ImageError>;
}

/// A writer for a format. Wrong sizes and paces are refused here, before anything is written.
pub fn animation_writer(
    format: AnimationFormat,
    destination: Destination,
    header: &AnimationHeader,
) -> Result<Box<dyn FrameWriter>, ImageError> {
    let place = destination.name().to_owned();
    format.check(&place, header)?;
    let inner: Box<dyn FrameWriter> = match format {
        AnimationFormat::Apng => Box::new(apng::Writer::new(destination, header)?),
        AnimationFormat::Gif => Box::new(gif::Writer::new(destination, header)?),
        #[cfg(feature = "av1")]
        AnimationFormat::Mp4 => Box::new(mp4::Writer::new(destination, header)?),
        AnimationFormat::Webp => Box::new(webp::Writer::new(destination, header)?),
    };
    let pixels = u64::from(header.width) * u64::from(header.height);
    Ok(Box::new(Counted { inner, place, pixels, left: header.frames }))
}

/// A writer to a file, which takes its place when finished and not before.
pub fn create_animation(
    path: &Path,
    format: AnimationFormat,
    header: &AnimationHeader,
) -> Result<Box<dyn FrameWriter>, ImageError> {
    let (destination, file) = output::whole_file(path)?;
    let place = destination.name().to_owned();
    let frames = animation_writer(format, destination, header)?;
    Ok(Box::new(WholeFile { frames, file, place }))
}

fn refused(place: &str, message: impl Into<String>) -> ImageError {
    ImageError::Animation { place: place.to_owned(), message: message.into() }
}

/// Sees to it that the formats' writers get whole frames, and neither too many nor too few.
struct Counted {
    inner: Box<dyn FrameWriter>,
    place: String,
    /// Of a frame.
    pixels: u64,
    left: u32,
}

impl FrameWriter for Counted {
    fn write_frame(&mut self, pixels: &[Rgb]) -> Result<(), ImageError> {
        let given = pixels.len() as u64;
        if given != self.pixels {
            return Err(refused(&self.place, format!("a frame has {} pixels, not {given}", self.pixels)));
        }
        self.left = self.left.checked_sub(1).ok_or_else(|| refused(&self.place, "all its frames are there already"))?;
        self.inner.write_frame(pixels)
    }

    fn finish(self: Box<Self>) -> Result<(), ImageError> {
        if self.left > 0 {
            return Err(refused(&self.place, format!("{} of its frames are missing", self.left)));
        }
        self.inner.finish()
    }
}

/// Puts the file in its place once it is complete.
struct WholeFile {
    frames: Box<dyn FrameWriter>,
    file: Option<atomic::AtomicFile>,
    place: String,
}

impl FrameWriter for WholeFile {
    fn write_frame(&mut self, pixels: &[Rgb]) -> Result<(), ImageError> {
        self.frames.write_frame(pixels)
    }

    fn finish(self: Box<Self>) -> Result<(), ImageError> {
        self.frames.finish()?;
        let place = self.place;
        self.file.map_or(Ok(()), |file| file.commit().map_err(|source| ImageError::Write { place, source }))
    }
}
