//! Plan of a render, derived from the command line.

pub mod aovs;
pub mod effect;
mod movie;
mod parts;
mod view;

pub use movie::Movie;
pub use parts::{Checkpoint, Cut, Shard};
pub use view::end_warning;

use crate::args::RenderArgs;
use crate::encoding::{Encoding, EncodingChoice, OutputKind};
use crate::failure::Failure;
use crate::model_args::ModelArgs;
use crate::output::{STANDARD_OUTPUT, at_most_one_stream, has_number, numbered};
use crate::progress::Progress;
use crate::source;
use crate::target::Target;
use crate::value::FrameRange;
use juggler::film::shard::{self, FrameShard};
use juggler::imaging::Options;
use juggler::scene::Scene;
use juggler::{Limit, Settings, by_name};
use std::ops::Range;
use std::time::Duration;

/// Number of threads if the number of cores is unknown.
const FALLBACK_THREADS: usize = 1;

/// All choices of a `juggler render` command.
#[derive(Debug)]
pub struct Plan {
    /// Scene file or name of a built-in scene.
    pub scene: String,
    /// What a model file shows.
    pub model: ModelArgs,
    /// Overrides of the scene's settings.
    pub settings: Settings,
    /// Frames or time to render.
    pub times: TimeSelection,
    /// Whether existing pictures are kept, also single ones.
    pub resume: bool,
    /// Output file, possibly with `####`; `-` for standard output.
    pub output: String,
    /// Kind of output.
    pub output_kind: OutputKind,
    /// File for the AOVs, if given.
    pub aov_output: Option<String>,
    /// Movie to encode, if any.
    pub movie: Option<Movie>,
    /// Time limit of rendering.
    pub time: Option<Duration>,
    /// Picture or partial render whose numbers of samples are repeated.
    pub samples_from: Option<String>,
    /// Checkpoints, if any.
    pub checkpoint: Option<Checkpoint>,
    /// Shard of the picture or of the frames.
    pub shard: Shard,
    /// Pixels and samples of a partial render, from `--crop` and `--sample-range`.
    pub cut: Cut,
    /// Note that a turntable has one picture only, if it does.
    pub turn_note: Option<String>,
    /// File for the statistics.
    pub stats: Option<String>,
    /// Number of rendering threads.
    pub threads: usize,
    /// Memory limit, in bytes.
    pub max_memory: Option<u64>,
    /// Form of progress reports.
    pub progress: Progress,
    /// Whether to print errors only.
    pub quiet: bool,
}

/// Times of an animation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TimeSelection {
    /// A single frame.
    Frame(u32),
    /// Time in seconds.
    At(f64),
    /// A range of frames, one picture each.
    Frames(FrameRange),
}

/// A picture of a plan.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameOutput {
    /// Frame number; fractional for times between frames.
    pub frame: f64,
    /// Output file.
    pub output: String,
    /// File for the AOVs, if given.
    pub aov_output: Option<String>,
    /// File for the statistics.
    pub stats: Option<String>,
    /// Checkpoint file.
    pub checkpoint: Option<String>,
    /// Shard of this picture.
    pub shard: Shard,
}

impl Plan {
    /// Derives the plan from the arguments.
    ///
    /// # Errors
    ///
    /// Fails if flags contradict each other or the output.
    pub fn new(args: RenderArgs) -> Result<Self, Failure> {
        let output = args.output.clone().unwrap_or_else(|| format!("{}.png", source::stem(&args.scene)));
        if output.is_empty() {
            return Err(Failure::Invalid("--output needs the name of a file".into()));
        }
        at_most_one_stream(&output, args.stats.as_deref())?;
        let movie = Movie::new(&args, &output)?;
        let output = movie.as_ref().map_or(output, Movie::frames);
        let output_kind = output_kind(&args, movie.as_ref(), &output)?;
        let times = TimeSelection::new(&args, &output, movie.is_some())?;
        args.given.check(target(output_kind, movie.as_ref(), &times))?;
        args.model.stage.check_transparent(args.transparent)?;
        let aovs = aovs::requested(&args, &output)?;
        let cut = Cut::new(&args, output_kind);
        let checkpoint = Checkpoint::new(&args, movie.as_ref())?;
        let shard = Shard::new(args.shard, parts::variable)?;
        let cores = std::thread::available_parallelism().map_or(FALLBACK_THREADS, std::num::NonZero::get);
        Ok(Self {
            settings: Settings { aovs, ..settings(&args, output_kind)? },
            turn_note: view::turn_note(&args, &output, matches!(times, TimeSelection::Frame(_))),
            scene: args.scene,
            model: args.model.for_view(args.view.size, args.view.camera.as_deref())?,
            times,
            resume: args.resume,
            output,
            aov_output: args.aov_output,
            output_kind,
            movie,
            time: args.time,
            samples_from: args.samples_from,
            checkpoint,
            shard,
            cut,
            stats: args.stats,
            threads: args.threads.map_or(cores, usize::from),
            max_memory: args.max_memory,
            progress: if args.quiet { Progress::None } else { args.progress },
            quiet: args.quiet,
        })
    }

    /// Whether the picture or the statistics go to standard output.
    pub fn uses_standard_output(&self) -> bool {
        self.output == STANDARD_OUTPUT || self.stats.as_deref() == Some(STANDARD_OUTPUT)
    }

    /// Kind of file that the command writes in the end.
    pub fn target(&self) -> Target {
        target(self.output_kind, self.movie.as_ref(), &self.times)
    }

    /// Encoding options of the picture.
    pub fn options(&self) -> Options {
        match self.output_kind {
            OutputKind::Picture(encoding) => encoding.options,
            OutputKind::PartialRender => Options::default(),
        }
    }

    /// Whether the picture of a scene needs a film in memory instead of being written row by row.
    pub fn needs_film(&self, scene: &Scene, frame_output: &FrameOutput) -> bool {
        let is_kept = self.output_kind == OutputKind::PartialRender
            || frame_output.checkpoint.is_some()
            || self.settings.limit != Limit::Samples;
        is_kept
            || !self.settings.aovs.is_empty()
            || self.settings.denoiser.is_some()
            || self.settings.transparent_of(scene)
    }

    /// Whether existing pictures are kept if the same command made them from the same scene.
    pub fn keeps_existing(&self) -> bool {
        let OutputKind::Picture(encoding) = self.output_kind else { return false };
        (self.resume || matches!(self.times, TimeSelection::Frames(_))) && encoding.format.stores_metadata()
    }

    /// Pictures to render, for an animation of `length` frames.
    ///
    /// # Errors
    ///
    /// Fails if the range of frames is empty.
    pub fn frame_outputs(&self, length: u32, frames_per_second: f64) -> Result<Vec<FrameOutput>, Failure> {
        match self.times {
            TimeSelection::Frame(frame) => {
                let name = |name: &str| if has_number(name) { numbered(name, frame) } else { name.into() };
                Ok(vec![self.single(f64::from(frame), name)])
            }
            TimeSelection::At(seconds) => Ok(vec![self.single(seconds * frames_per_second, str::to_owned)]),
            TimeSelection::Frames(_) => {
                let frames = self.frames(length);
                if frames.is_empty() {
                    let first = frames.start;
                    return Err(Failure::Invalid(format!(
                        "--frames starts at {first}, beyond the end of the animation: its frames are 0 to {}",
                        length.saturating_sub(1)
                    )));
                }
                Ok(self.numbered(frames))
            }
        }
    }

    /// Requested frames over all shards, for an animation of `length` frames.
    pub fn frames(&self, length: u32) -> Range<u32> {
        match self.times {
            TimeSelection::Frames(range) => range.first..range.end.unwrap_or(length),
            TimeSelection::Frame(frame) => frame..frame.saturating_add(1),
            TimeSelection::At(_) => 0..1,
        }
    }

    /// One picture, whose files `name` names.
    fn single(&self, frame: f64, name: impl Fn(&str) -> String) -> FrameOutput {
        FrameOutput {
            frame,
            output: name(&self.output),
            aov_output: self.aov_output.as_deref().map(&name),
            stats: self.stats.as_deref().map(&name),
            checkpoint: self.checkpoint.as_ref().map(|checkpoint| name(&checkpoint.file)),
            shard: self.shard,
        }
    }

    fn numbered(&self, frames: Range<u32>) -> Vec<FrameOutput> {
        let name = |name: &str, frame| if name == STANDARD_OUTPUT { name.into() } else { numbered(name, frame) };
        let frame_output = |frame: u32, shard: Shard| FrameOutput {
            frame: f64::from(frame),
            output: name(&self.output, frame),
            aov_output: aovs::numbered(self.aov_output.as_deref(), frame),
            stats: self.stats.as_deref().map(|stats| name(stats, frame)),
            checkpoint: self.checkpoint.as_ref().map(|checkpoint| name(&checkpoint.file, frame)),
            shard,
        };
        let Shard { index, count } = self.shard;
        if self.output_kind != OutputKind::PartialRender {
            // Distribute whole pictures over the shards in turns.
            let own = frames.skip(index as usize).step_by(count as usize);
            return own.map(|frame| frame_output(frame, Shard::WHOLE)).collect();
        }
        let shards = shard::frames(frames, index, count).into_iter();
        shards.map(|FrameShard { frame, index, count }| frame_output(frame, Shard { index, count })).collect()
    }
}

/// Kind of the output; frames of a movie are pictures.
fn output_kind(args: &RenderArgs, movie: Option<&Movie>, output: &str) -> Result<OutputKind, Failure> {
    let RenderArgs { format, bits, quality, look, .. } = args;
    if movie.is_some() {
        let choice = EncodingChoice { look: *look, ..EncodingChoice::default() };
        return Ok(OutputKind::Picture(Encoding::new(choice, output)?));
    }
    OutputKind::new(EncodingChoice { format: format.as_deref(), bits: *bits, quality: *quality, look: *look }, output)
}

fn target(output_kind: OutputKind, movie: Option<&Movie>, times: &TimeSelection) -> Target {
    match (output_kind, movie) {
        (_, Some(movie)) => Target::Movie(movie.format),
        (OutputKind::Picture(encoding), None) if matches!(times, TimeSelection::Frames(_)) => {
            Target::NumberedPictures(encoding)
        }
        (output_kind, None) => Target::of_file(output_kind),
    }
}

/// Overrides of the scene's settings. The crop of a picture is its region; the crop of a partial
/// render is in [`Cut`].
fn settings(args: &RenderArgs, output_kind: OutputKind) -> Result<Settings, Failure> {
    Ok(Settings {
        limit: match (args.noise, args.time, &args.samples_from) {
            (Some(level), ..) => Limit::Noise(level),
            (_, None, None) => Limit::Samples,
            (None, time, _) => Limit::Time { seconds: time.map_or(0.0, |time| time.as_secs_f64()) },
        },
        crop: if output_kind == OutputKind::PartialRender { None } else { args.crop },
        curve: args.tone.as_deref().map(|name| by_name("tone curve", name)).transpose()?,
        exposure_stops: args.exposure,
        aovs: Vec::new(),
        denoiser: args.denoise,
        white_balance: args.white_balance,
        primaries: args.primaries,
        dither: args.dither,
        transparent: args.transparent.then_some(true),
        ..args.view.settings()?
    })
}

impl TimeSelection {
    /// Requested times; all frames by default if the output is a movie, or if a turning model has
    /// numbered pictures.
    fn new(args: &RenderArgs, output: &str, is_film: bool) -> Result<Self, Failure> {
        match (args.frames, args.view.frame, args.view.at) {
            (Some(_), ..) if output == STANDARD_OUTPUT => {
                Err(Failure::Invalid("several frames need files: standard output holds one picture".into()))
            }
            (Some(range), ..) => Ok(Self::Frames(range)),
            (_, Some(frame), _) => Ok(Self::Frame(frame)),
            (_, _, Some(seconds)) => Ok(Self::At(seconds)),
            _ if is_film || (args.turns_in_all_frames() && has_number(output)) => {
                Ok(Self::Frames(FrameRange { first: 0, end: None }))
            }
            _ => Ok(Self::Frame(0)),
        }
    }
}

#[cfg(test)]
mod tests;
