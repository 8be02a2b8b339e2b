//! Several frames in one file of moving pictures.

use crate::args::RenderArgs;
use crate::failure::Failure;
use crate::output::{self, STANDARD_OUTPUT};
use juggler::imaging::animation::DEFAULT_QUALITY;
use juggler::imaging::{AnimationFormat, AnimationHeader, Tone};
use std::path::Path;

/// The ending of films that only a program with the feature `av1` makes.
const MP4: &str = "mp4";

/// Several frames in one file of moving pictures.
#[derive(Clone, Debug, PartialEq)]
pub struct Reel {
    /// The format.
    pub format: AnimationFormat,
    /// The file.
    pub file: String,
    /// Frames a second; without, the scene's.
    pub frames_per_second: Option<f64>,
    /// How often it is shown; 0: over and over.
    pub plays: u16,
    /// From small, 1, to good, 100.
    pub quality: u8,
}

impl Reel {
    /// What the output's name and the flags ask for; `None` for pictures.
    pub fn new(args: &RenderArgs, output: &str) -> Result<Option<Self>, Failure> {
        let wrong = |message: String| Err(Failure::Wrong(message));
        let named = args.format.as_ref().map(|name| format!("film.{name}"));
        let named = Path::new(named.as_deref().unwrap_or(output));
        let format = AnimationFormat::from_path(named).filter(|format| is_wanted(*format, args, output));
        let Some(format) = format else {
            if named.extension().is_some_and(|ending| ending.eq_ignore_ascii_case(MP4)) {
                return wrong(format!("`{output}`: this program was built without MP4 (the feature `av1`)"));
            }
            return Ok(None);
        };
        if output == STANDARD_OUTPUT {
            return wrong(format!("a film needs a file: {format} cannot go to standard output"));
        }
        let (file, frames_per_second) = (output.to_owned(), args.fps);
        let (plays, quality) = (args.plays.unwrap_or(0), args.quality.unwrap_or(DEFAULT_QUALITY));
        Ok(Some(Self { format, file, frames_per_second, plays, quality }))
    }

    /// Where the finished frames are until the film is complete.
    pub fn folder(&self) -> String {
        format!("{}.frames", self.file)
    }

    /// How they are called.
    pub fn frames(&self) -> String {
        format!("{}/frame_####.png", self.folder())
    }

    /// Where a frame under way is kept.
    pub fn checkpoints(&self) -> String {
        format!("{}/frame_####.jfilm", self.folder())
    }

    /// What the film says besides its frames, of which there are so many; `pace` is the scene's.
    pub fn header(&self, [width, height]: [u32; 2], frames: usize, pace: f64) -> AnimationHeader {
        AnimationHeader {
            width,
            height,
            tone: Tone::default(),
            frames: u32::try_from(frames).unwrap_or(u32::MAX),
            frames_per_second: self.frames_per_second.unwrap_or(pace),
            plays: self.plays,
            quality: self.quality,
        }
    }

    /// Whether the format can take such a film.
    pub fn check(&self, header: &AnimationHeader) -> Result<(), Failure> {
        self.format.check(&self.file, header).map_err(|error| Failure::Wrong(error.to_string()))
    }
}

/// A `.webp` is a picture unless several frames go into one file.
fn is_wanted(format: AnimationFormat, args: &RenderArgs, output: &str) -> bool {
    let several = args.frames.is_some() && !output::has_number(output);
    format != AnimationFormat::Webp || several || args.fps.is_some() || args.plays.is_some()
}
