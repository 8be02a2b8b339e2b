//! What `juggler render` was asked for, from what was typed.

pub mod effect;
pub mod layers;
mod parts;
mod product;
mod reel;
mod view;

pub use effect::Target;
pub use parts::{Checkpoint, Cut, Shard};
pub use product::{Encoding, PART_ENDING, Product};
pub use reel::Reel;
pub use view::beyond_the_end;

use crate::args::RenderArgs;
use crate::failure::Failure;
use crate::output::{self, STANDARD_OUTPUT};
use crate::progress::Progress;
use crate::source;
use crate::value::FrameRange;
use juggler::film::share::{self, FrameShare};
use juggler::imaging::Options;
use juggler::{Limit, Settings};
use std::ops::Range;
use std::time::Duration;

/// Threads when the system does not say how many cores there are.
const FALLBACK_THREADS: usize = 1;

/// A render, ready to be done.
#[derive(Debug)]
pub struct Plan {
    /// The scene's file or name.
    pub scene: String,
    /// What is wished for beyond what the scene says.
    pub settings: Settings,
    /// Which moments of it.
    pub moments: Moments,
    /// The picture's file, `-` for standard output; perhaps with `####`.
    pub output: String,
    /// What it holds.
    pub product: Product,
    /// Where its layers go, if somebody said.
    pub layers_output: Option<String>,
    /// The film that the pictures are frames of.
    pub reel: Option<Reel>,
    /// How long rendering may take.
    pub time: Option<Duration>,
    /// The picture or part whose numbers of samples are taken.
    pub samples_from: Option<String>,
    /// Where work is kept.
    pub checkpoint: Option<Checkpoint>,
    /// Which part of the picture or the frames.
    pub shard: Shard,
    /// The pixels and samples that a part is cut to by hand.
    pub cut: Cut,
    /// The statistics' file.
    pub stats: Option<String>,
    /// How many threads render.
    pub threads: usize,
    /// The most memory, in bytes.
    pub max_memory: Option<u64>,
    /// How progress is shown.
    pub progress: Progress,
    /// Whether nothing is said about what was done.
    pub quiet: bool,
}

/// Moments of an animation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Moments {
    /// One frame.
    Frame(u32),
    /// Seconds from the start.
    At(f64),
    /// Frames, one picture each.
    Frames(FrameRange),
}

/// One picture of a plan.
#[derive(Clone, Debug, PartialEq)]
pub struct Shot {
    /// The frame, perhaps between two.
    pub frame: f64,
    /// The picture's file.
    pub output: String,
    /// Its layers' file, if somebody said.
    pub layers_output: Option<String>,
    /// The statistics' file.
    pub stats: Option<String>,
    /// Where its work is kept.
    pub checkpoint: Option<String>,
    /// Which part of this picture.
    pub shard: Shard,
}

impl Plan {
    /// Works out what was meant, or says why it cannot be.
    pub fn new(args: RenderArgs) -> Result<Self, Failure> {
        let output = args.output.clone().unwrap_or_else(|| format!("{}.png", source::stem(&args.scene)));
        if output.is_empty() {
            return Err(Failure::Wrong("the output has no name".into()));
        }
        output::at_most_one_stream(&output, args.stats.as_deref())?;
        let reel = Reel::new(&args, &output)?;
        let output = reel.as_ref().map_or(output, Reel::frames);
        let product = match reel {
            Some(_) => Product::Picture(Encoding::new(None, None, None, &output)?.with_look(args.look)),
            None => Product::new(&args, &output)?,
        };
        let moments = Moments::new(&args, &output, reel.is_some())?;
        let target = Target::new(product, reel.as_ref());
        effect::check(target, &effect::given(&args, matches!(moments, Moments::Frames(_))))?;
        let aovs = layers::wanted(&args, &output)?;
        let cut = Cut::new(&args, product);
        let checkpoint = Checkpoint::new(&args, reel.as_ref())?;
        let shard = Shard::new(args.shard, parts::variable)?;
        let cores = std::thread::available_parallelism().map_or(FALLBACK_THREADS, std::num::NonZero::get);
        Ok(Self {
            settings: Settings { aovs, ..settings(&args, product) },
            scene: args.scene,
            moments,
            output,
            layers_output: args.aov_output,
            product,
            reel,
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

    /// Whether standard output is taken by the picture or the statistics.
    pub fn stream_taken(&self) -> bool {
        self.output == STANDARD_OUTPUT || self.stats.as_deref() == Some(STANDARD_OUTPUT)
    }

    /// What is written in the end.
    pub fn target(&self) -> Target {
        Target::new(self.product, self.reel.as_ref())
    }

    /// How the picture is written.
    pub fn options(&self) -> Options {
        match self.product {
            Product::Picture(encoding) => encoding.options,
            Product::Part => Options::default(),
        }
    }

    /// Whether a picture is made on a film that is kept, not row by row.
    pub fn needs_film(&self, shot: &Shot) -> bool {
        let is_kept =
            self.product == Product::Part || shot.checkpoint.is_some() || self.settings.limit != Limit::Samples;
        is_kept || !self.settings.aovs.is_empty() || self.settings.denoiser.is_some()
    }

    /// Whether a picture that is there already, made by the same command from the same scene, is left as it is.
    pub fn leaves_what_is_there(&self) -> bool {
        let Product::Picture(encoding) = self.product else { return false };
        matches!(self.moments, Moments::Frames(_)) && encoding.format.keeps_texts()
    }

    /// The pictures, for an animation of this length and pace.
    pub fn shots(&self, length: u32, frames_per_second: f64) -> Result<Vec<Shot>, Failure> {
        let single = |frame: f64| Shot {
            frame,
            output: self.output.clone(),
            layers_output: self.layers_output.clone(),
            stats: self.stats.clone(),
            checkpoint: self.checkpoint.as_ref().map(|checkpoint| checkpoint.file.clone()),
            shard: self.shard,
        };
        match self.moments {
            Moments::Frame(frame) => Ok(vec![single(f64::from(frame))]),
            Moments::At(seconds) => Ok(vec![single(seconds * frames_per_second)]),
            Moments::Frames(_) => {
                let frames = self.frames(length);
                if frames.is_empty() {
                    let first = frames.start;
                    return Err(Failure::Wrong(format!(
                        "no frame is left from {first} on: the animation has {length}, 0 to {}",
                        length.saturating_sub(1)
                    )));
                }
                Ok(self.numbered(frames))
            }
        }
    }

    /// The frames that are asked for, those of other shards too, for an animation of this length.
    pub fn frames(&self, length: u32) -> Range<u32> {
        match self.moments {
            Moments::Frames(range) => range.first..range.end.unwrap_or(length),
            Moments::Frame(frame) => frame..frame.saturating_add(1),
            Moments::At(_) => 0..1,
        }
    }

    fn numbered(&self, frames: Range<u32>) -> Vec<Shot> {
        let name =
            |name: &str, frame| if name == STANDARD_OUTPUT { name.into() } else { output::numbered(name, frame) };
        let shot = |frame: u32, shard: Shard| Shot {
            frame: f64::from(frame),
            output: name(&self.output, frame),
            layers_output: layers::numbered(self.layers_output.as_deref(), frame),
            stats: self.stats.as_deref().map(|stats| name(stats, frame)),
            checkpoint: self.checkpoint.as_ref().map(|checkpoint| name(&checkpoint.file, frame)),
            shard,
        };
        let Shard { index, count } = self.shard;
        if self.product != Product::Part {
            // Pictures are shared whole, in turns.
            let own = frames.skip(index as usize).step_by(count as usize);
            return own.map(|frame| shot(frame, Shard::WHOLE)).collect();
        }
        let shares = share::frames(frames, index, count).into_iter();
        shares.map(|FrameShare { frame, index, count }| shot(frame, Shard { index, count })).collect()
    }
}

/// What is wished for beyond what the scene says. A picture's crop is the picture, a part's is a piece of it.
fn settings(args: &RenderArgs, product: Product) -> Settings {
    Settings {
        limit: match (args.noise, args.time, &args.samples_from) {
            (Some(level), ..) => Limit::Noise(level),
            (_, None, None) => Limit::Samples,
            (None, time, _) => Limit::Time { seconds: time.map_or(0.0, |time| time.as_secs_f64()) },
        },
        crop: if product == Product::Part { None } else { args.crop },
        curve: args.tone.clone(),
        exposure_stops: args.exposure,
        aovs: Vec::new(),
        denoiser: args.denoise,
        white_balance: args.white_balance,
        primaries: args.primaries,
        dither: args.dither,
        ..args.view.settings()
    }
}

impl Moments {
    /// Of a film, all frames where nothing else is said.
    fn new(args: &RenderArgs, output: &str, is_film: bool) -> Result<Self, Failure> {
        match (args.frames, args.view.frame, args.view.at) {
            (Some(_), ..) if output == STANDARD_OUTPUT => {
                Err(Failure::Wrong("several frames need files: standard output holds one picture".into()))
            }
            (Some(range), ..) => Ok(Self::Frames(range)),
            (_, Some(frame), _) => Ok(Self::Frame(frame)),
            (_, _, Some(seconds)) => Ok(Self::At(seconds)),
            _ if is_film => Ok(Self::Frames(FrameRange { first: 0, end: None })),
            _ => Ok(Self::Frame(0)),
        }
    }
}

#[cfg(test)]
mod tests;
