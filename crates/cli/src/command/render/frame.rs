//! What a command renders: its pictures, and the one that is being rendered.

use crate::failure::Failure;
use crate::output::STANDARD_OUTPUT;
use crate::plan::{FrameOutput, Plan};
use crate::progress::{FrameProgress, Reporter};
use juggler::Picture;
use juggler::imaging::{self, Header, ImageFormat, RowWriter};
use juggler::memory::Effort;
use juggler_raybench::clock::Stopwatch;
use std::path::Path;
use std::time::{Duration, Instant};

/// All pictures of one command.
pub struct RenderCommand {
    pub plan: Plan,
    pub reporter: Reporter,
}

/// Start time of a picture, and its position among the frames.
#[derive(Clone, Copy)]
pub struct RenderStart {
    pub time: Instant,
    pub frame_progress: Option<FrameProgress>,
}

/// A picture that is being rendered.
pub struct FrameRender<'t> {
    pub frame_output: &'t FrameOutput,
    pub picture: &'t Picture,
    pub effort: Effort,
    /// Memory estimate, in bytes.
    pub expected: u64,
    pub load: Duration,
    pub build: Duration,
    pub start: RenderStart,
    /// Runs since the world was built.
    pub stopwatch: Stopwatch,
}

impl RenderCommand {
    /// Writer of a picture to a file or to standard output.
    pub fn writer(&self, format: ImageFormat, output: &str, header: &Header) -> Result<Box<dyn RowWriter>, Failure> {
        Ok(match output {
            STANDARD_OUTPUT => imaging::to_standard_output(format, header)?,
            file => imaging::create(Path::new(file), format, header)?,
        })
    }
}
