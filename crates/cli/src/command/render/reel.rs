//! From finished frames to a film. Frames are kept as pictures beside the film until it is complete: what ends early
//! leaves them, and the same command goes on with them, to the same bytes.

use super::folder::{Folder, Use};
use crate::failure::Failure;
use crate::output::STANDARD_OUTPUT;
use crate::plan::{Reel, Shot};
use juggler::imaging::{self, AnimationHeader, FrameWriter, Header};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::{self, JoinHandle};

/// Frames that wait to be encoded while the next are rendered.
const WAITING: usize = 2;

/// The text of a picture that says its tone, where it is not the usual one.
pub const TONE: &str = "Tone";

/// Puts finished frames into a film while the next are rendered.
pub struct Encoder {
    frames: Option<SyncSender<PathBuf>>,
    thread: Option<JoinHandle<Result<(), Failure>>>,
    folder: Option<Folder>,
    taken: Vec<PathBuf>,
}

impl Encoder {
    /// For a film whose format takes it.
    pub fn start(reel: &Reel, header: AnimationHeader) -> Result<Self, Failure> {
        let folder = Folder::open(&reel.folder(), Use::Alone)?;
        let (sender, receiver) = sync_channel(WAITING);
        let reel = reel.clone();
        let thread = thread::Builder::new().name("film".into()).spawn(move || encode(&reel, &header, &receiver));
        let thread = thread.map_err(|error| Failure::System(format!("cannot start a thread: {error}")))?;
        Ok(Self { frames: Some(sender), thread: Some(thread), folder: Some(folder), taken: Vec::new() })
    }

    /// The next frame is there; `false` when something went wrong with an earlier one, which [`Encoder::finish`] tells.
    pub fn take(&mut self, frame: &str) -> bool {
        self.taken.push(frame.into());
        self.frames.as_ref().is_some_and(|frames| frames.send(frame.into()).is_ok())
    }

    /// Completes the film and clears the frames away.
    pub fn finish(mut self) -> Result<(), Failure> {
        self.join()?;
        self.folder.take().map_or(Ok(()), |folder| folder.clear(&self.taken))
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

fn encode(reel: &Reel, header: &AnimationHeader, frames: &Receiver<PathBuf>) -> Result<(), Failure> {
    let mut writer: Option<Box<dyn FrameWriter>> = None;
    for frame in frames {
        let image = imaging::read(&frame)?;
        let writer = match &mut writer {
            Some(writer) => writer,
            none => none.insert(imaging::create_animation(Path::new(&reel.file), reel.format, header)?),
        };
        writer.write_frame(image.pixels())?;
    }
    writer.map_or(Ok(()), |writer| Ok(writer.finish()?))
}

/// Whether a picture is there already, made by the same command from the same scene, and its statistics with it.
pub fn is_made(shot: &Shot, header: &Header) -> bool {
    let has_stats = |file: &String| file != STANDARD_OUTPUT && Path::new(file).exists();
    shot.stats.as_ref().is_none_or(has_stats)
        && imaging::inspect(Path::new(&shot.output)).is_ok_and(|facts| {
            let same_size = (facts.width, facts.height) == (header.width, header.height);
            let has_tone = |texts: &[(String, String)]| texts.iter().any(|(key, _)| key == TONE);
            same_size
                && header.metadata.iter().all(|text| facts.metadata.contains(text))
                && has_tone(&facts.metadata) == has_tone(&header.metadata)
        })
}
