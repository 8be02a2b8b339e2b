//! From finished frames to a film. Frames are kept as pictures beside the film until it is complete: what ends early
//! leaves them, and the same command goes on with them, to the same bytes.

use crate::failure::Failure;
use crate::plan::Reel;
use juggler::imaging::{self, AnimationHeader, FrameWriter, Header, Tone};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::{self, JoinHandle};

/// Frames that wait to be encoded while the next are rendered.
const WAITING: usize = 2;

/// Puts finished frames into a film while the next are rendered.
pub struct Encoder {
    frames: Option<SyncSender<PathBuf>>,
    thread: Option<JoinHandle<Result<(), Failure>>>,
    folder: String,
    taken: Vec<PathBuf>,
}

impl Encoder {
    /// For so many frames.
    pub fn start(reel: &Reel, frames: usize, frames_per_second: f64) -> Result<Self, Failure> {
        let folder = reel.folder();
        match std::fs::create_dir(&folder) {
            Err(error) if error.kind() != ErrorKind::AlreadyExists => {
                return Err(Failure::file("create", &folder, &error));
            }
            _ => {}
        }
        let (sender, receiver) = sync_channel(WAITING);
        let frames = u32::try_from(frames).unwrap_or(u32::MAX);
        let pace = reel.frames_per_second.unwrap_or(frames_per_second);
        let reel = reel.clone();
        let thread = thread::Builder::new().name("film".into()).spawn(move || encode(&reel, frames, pace, &receiver));
        let thread = thread.map_err(|error| Failure::System(format!("cannot start a thread: {error}")))?;
        Ok(Self { frames: Some(sender), thread: Some(thread), folder, taken: Vec::new() })
    }

    /// The next frame is there; `false` when something went wrong with an earlier one, which [`Encoder::finish`] tells.
    pub fn take(&mut self, frame: &str) -> bool {
        self.taken.push(frame.into());
        self.frames.as_ref().is_some_and(|frames| frames.send(frame.into()).is_ok())
    }

    /// Completes the film and clears the frames away.
    pub fn finish(mut self) -> Result<(), Failure> {
        self.join()?;
        for frame in &self.taken {
            std::fs::remove_file(frame).map_err(|error| Failure::file("remove", frame.display(), &error))?;
        }
        // Somebody may keep something else in it.
        let _ = std::fs::remove_dir(&self.folder);
        Ok(())
    }

    fn join(&mut self) -> Result<(), Failure> {
        self.frames = None;
        let Some(thread) = self.thread.take() else { return Ok(()) };
        thread.join().map_err(|_| Failure::System("the film's encoder has failed".into()))?
    }
}

/// A film that is not completed leaves no file behind: its thread clears it away.
impl Drop for Encoder {
    fn drop(&mut self) {
        let _ = self.join();
    }
}

fn encode(reel: &Reel, count: u32, frames_per_second: f64, frames: &Receiver<PathBuf>) -> Result<(), Failure> {
    let mut writer: Option<Box<dyn FrameWriter>> = None;
    for frame in frames {
        let image = imaging::read(&frame)?;
        let writer = match &mut writer {
            Some(writer) => writer,
            none => {
                let (width, height, tone) = (image.width(), image.height(), Tone::default());
                let (frames, plays) = (count, reel.plays);
                let header = AnimationHeader { width, height, tone, frames, frames_per_second, plays };
                none.insert(imaging::create_animation(Path::new(&reel.file), reel.format, &header)?)
            }
        };
        writer.write_frame(image.pixels())?;
    }
    writer.map_or(Ok(()), |writer| Ok(writer.finish()?))
}

/// Whether a frame's picture is there already, made by the same command from the same scene.
pub fn is_made(file: &str, header: &Header) -> bool {
    imaging::inspect(Path::new(file)).is_ok_and(|facts| {
        let same_size = (facts.width, facts.height) == (header.width, header.height);
        same_size && header.metadata.iter().all(|text| facts.metadata.contains(text))
    })
}
