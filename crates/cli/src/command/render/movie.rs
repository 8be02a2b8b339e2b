//! Encodes finished frames as a movie. Frames are kept as pictures beside the movie until it is
//! complete, so that the same command resumes an interrupted render, with an identical result.

use super::folder::{Access, FrameFolder};
use crate::failure::Failure;
use crate::output::STANDARD_OUTPUT;
use crate::plan::{FrameOutput, Movie};
use juggler::TONE;
use juggler::imaging::{self, AnimationHeader, ExrWindows, FrameWriter, Header};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::{self, JoinHandle};

/// Number of frames that may wait for the encoder.
const WAITING: usize = 2;

/// Encodes finished frames on its own thread while the next ones render.
pub struct MovieEncoder {
    frames: Option<SyncSender<PathBuf>>,
    thread: Option<JoinHandle<Result<(), Failure>>>,
    folder: Option<FrameFolder>,
    frame_files: Vec<PathBuf>,
}

impl MovieEncoder {
    /// Locks the folder of frames and starts the encoder's thread.
    pub fn start(movie: &Movie, header: AnimationHeader) -> Result<Self, Failure> {
        let folder = FrameFolder::open(&movie.folder(), Access::Exclusive)?;
        let (sender, receiver) = sync_channel(WAITING);
        let movie = movie.clone();
        let thread = thread::Builder::new().name("film".into()).spawn(move || encode(&movie, &header, &receiver));
        let thread = thread.map_err(|error| Failure::System(format!("cannot start a thread: {error}")))?;
        Ok(Self { frames: Some(sender), thread: Some(thread), folder: Some(folder), frame_files: Vec::new() })
    }

    /// Passes the next frame to the encoder. Returns `false` if an earlier frame failed;
    /// [`MovieEncoder::finish`] returns the error.
    pub fn push(&mut self, frame: &str) -> bool {
        self.frame_files.push(frame.into());
        self.frames.as_ref().is_some_and(|frames| frames.send(frame.into()).is_ok())
    }

    /// Completes the movie and removes the frames.
    pub fn finish(mut self) -> Result<(), Failure> {
        self.join()?;
        self.folder.take().map_or(Ok(()), |folder| folder.clear(&self.frame_files))
    }

    fn join(&mut self) -> Result<(), Failure> {
        self.frames = None;
        let Some(thread) = self.thread.take() else { return Ok(()) };
        thread.join().map_err(|_| Failure::System("the movie's encoder has failed".into()))?
    }
}

/// Stops the thread, which removes an incomplete movie.
impl Drop for MovieEncoder {
    fn drop(&mut self) {
        let _ = self.join();
    }
}

fn encode(movie: &Movie, header: &AnimationHeader, frames: &Receiver<PathBuf>) -> Result<(), Failure> {
    let mut writer: Option<Box<dyn FrameWriter>> = None;
    for frame in frames {
        let image = imaging::read_with_alpha(&frame)?;
        let writer = match &mut writer {
            Some(writer) => writer,
            none => none.insert(imaging::create_animation(Path::new(&movie.file), movie.format, header)?),
        };
        writer.write_frame(image.rows())?;
    }
    writer.map_or(Ok(()), |writer| Ok(writer.finish()?))
}

/// Whether the picture and its statistics exist already, made by the same command from the same
/// scene.
pub fn is_rendered(frame_output: &FrameOutput, header: &Header) -> bool {
    let has_stats = |file: &String| file != STANDARD_OUTPUT && Path::new(file).exists();
    frame_output.stats.as_ref().is_none_or(has_stats)
        && imaging::inspect(Path::new(&frame_output.output)).is_ok_and(|facts| {
            let size = [header.width, header.height];
            let same_size = match facts.windows {
                Some(windows) => windows == ExrWindows::new(size, header.crop),
                None => [facts.width, facts.height] == size,
            };
            let has_tone = |texts: &[(String, String)]| texts.iter().any(|(key, _)| key == TONE);
            same_size
                && header.metadata.iter().all(|text| facts.metadata.contains(text))
                && has_tone(&facts.metadata) == has_tone(&header.metadata)
        })
}
