//! Movies: several frames in one file.

use crate::args::RenderArgs;
use crate::failure::Failure;
use crate::output::{self, STANDARD_OUTPUT};
use juggler::imaging::animation::DEFAULT_QUALITY;
use juggler::imaging::{AnimationFormat, AnimationHeader, Tone};
use std::path::Path;

/// Extension of movies that need the feature `av1`.
const MP4: &str = "mp4";

/// A movie to encode.
#[derive(Clone, Debug, PartialEq)]
pub struct Movie {
    /// File format.
    pub format: AnimationFormat,
    /// Output file.
    pub file: String,
    /// Frames per second; `None` for the scene's.
    pub frames_per_second: Option<f64>,
    /// Number of times that the movie plays; 0 loops forever.
    pub plays: u16,
    /// Quality, 1 to 100.
    pub quality: u8,
}

impl Movie {
    /// Movie from the output's extension and the flags; `None` for pictures.
    pub fn new(args: &RenderArgs, output: &str) -> Result<Option<Self>, Failure> {
        let wrong = |message: String| Err(Failure::Invalid(message));
        let named = args.format.as_ref().map(|name| format!("film.{name}"));
        let named = Path::new(named.as_deref().unwrap_or(output));
        let format = AnimationFormat::from_path(named).filter(|format| is_wanted(*format, args, output));
        let Some(format) = format else {
            if named.extension().is_some_and(|ending| ending.eq_ignore_ascii_case(MP4)) {
                return wrong(format!("`{output}`: this program was built without MP4 support (feature `av1`)"));
            }
            return Ok(None);
        };
        if output == STANDARD_OUTPUT {
            return wrong(format!("a movie needs a file: {format} cannot be written to standard output"));
        }
        let (file, frames_per_second) = (output.to_owned(), args.fps);
        let (plays, quality) = (args.plays.unwrap_or(0), args.quality.unwrap_or(DEFAULT_QUALITY));
        Ok(Some(Self { format, file, frames_per_second, plays, quality }))
    }

    /// Folder for the frames until the movie is complete.
    pub fn folder(&self) -> String {
        format!("{}.frames", self.file)
    }

    /// File name pattern of the frames.
    pub fn frames(&self) -> String {
        format!("{}/frame_####.png", self.folder())
    }

    /// File name pattern of the frames' checkpoints.
    pub fn checkpoints(&self) -> String {
        format!("{}/frame_####.jfilm", self.folder())
    }

    /// Header of an opaque movie of `frames` frames; `pace` is the scene's number of frames per second.
    pub fn header(&self, [width, height]: [u32; 2], frames: usize, pace: f64) -> AnimationHeader {
        AnimationHeader {
            width,
            height,
            tone: Tone::default(),
            frames: u32::try_from(frames).unwrap_or(u32::MAX),
            frames_per_second: self.frames_per_second.unwrap_or(pace),
            plays: self.plays,
            quality: self.quality,
            transparent: false,
        }
    }

    /// Fails if the format does not support the movie.
    pub fn check(&self, header: &AnimationHeader) -> Result<(), Failure> {
        self.format.check(&self.file, header).map_err(|error| Failure::Invalid(error.to_string()))
    }
}

/// Whether the output is a movie: `.webp` is a picture unless several frames go into one file.
fn is_wanted(format: AnimationFormat, args: &RenderArgs, output: &str) -> bool {
    let several = (args.frames.is_some() || args.turns_in_all_frames()) && !output::has_number(output);
    format != AnimationFormat::Webp || several || args.fps.is_some() || args.plays.is_some()
}
