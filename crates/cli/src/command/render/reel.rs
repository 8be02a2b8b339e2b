//! From finished frames to a film. Frames are kept as pictures beside the film until it is complete: what ends early
//! leaves them, and the same command goes on with them, to the same bytes.

use super::film::forget;
use crate::failure::Failure;
use crate::output::STANDARD_OUTPUT;
use crate::plan::{Reel, Shot};
use juggler::imaging::{self, AnimationHeader, FrameWriter, Header};
use std::fs::{self, File, TryLockError};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// Frames that wait to be encoded while the next are rendered.
const WAITING: usize = 2;
/// The file in a folder of frames by which processes know of each other.
const LOCK: &str = ".lock";
/// How long to wait for it.
const PATIENCE: Duration = Duration::from_secs(2);

/// The text of a picture that says its tone, where it is not the usual one.
pub const TONE: &str = "Tone";

/// How a process uses a folder of frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Use {
    /// It puts frames there, as others may.
    Shared,
    /// It makes the film and clears the frames away.
    Alone,
}

/// A folder of frames. The system lets go of the lock when the process ends, however it ends.
pub struct Folder {
    path: String,
    _lock: Option<File>,
}

impl Folder {
    /// Makes it where there is none.
    pub fn open(path: &str, purpose: Use) -> Result<Self, Failure> {
        match fs::create_dir(path) {
            Err(error) if error.kind() != ErrorKind::AlreadyExists => {
                return Err(Failure::file("create", path, &error));
            }
            _ => {}
        }
        let name = format!("{path}/{LOCK}");
        let file = File::options().create(true).append(true).open(&name);
        let file = file.map_err(|error| Failure::file("write", &name, &error))?;
        match locked(&file, purpose) {
            Ok(()) => Ok(Self { path: path.into(), _lock: Some(file) }),
            Err(TryLockError::WouldBlock) => Err(Failure::System(format!(
                "other processes are at work in `{path}`: the same command can make the film when they are done"
            ))),
            // Some network disks know no locks; frames appear whole or not at all in any case.
            Err(TryLockError::Error(_)) => Ok(Self { path: path.into(), _lock: None }),
        }
    }

    /// Clears away what processes that were killed left of these frames, and the folder unless somebody keeps something
    /// else in it.
    fn clear(self, frames: &[PathBuf]) -> Result<(), Failure> {
        for frame in frames {
            fs::remove_file(frame).map_err(|error| Failure::file("remove", frame.display(), &error))?;
            forget(&frame.with_extension("jfilm").to_string_lossy());
        }
        for entry in fs::read_dir(&self.path).into_iter().flatten().flatten() {
            let name = entry.file_name();
            let name = name.to_string_lossy();
            if name.starts_with(".frame_") && name.ends_with(".part") || name == LOCK {
                let _ = fs::remove_file(entry.path());
            }
        }
        let _ = fs::remove_dir(&self.path);
        Ok(())
    }
}

/// Takes the lock. A process that was killed a moment ago may still have it until the system has cleared it away.
fn locked(file: &File, purpose: Use) -> Result<(), TryLockError> {
    let patient_until = Instant::now() + PATIENCE;
    loop {
        let locked = if purpose == Use::Shared { file.try_lock_shared() } else { file.try_lock() };
        match locked {
            Err(TryLockError::WouldBlock) if Instant::now() < patient_until => thread::sleep(PATIENCE / 40),
            other => return other,
        }
    }
}

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
