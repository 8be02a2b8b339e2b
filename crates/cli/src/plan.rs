//! What `juggler render` was asked for, from what was typed.

pub mod layers;
mod parts;
mod product;
mod reel;
mod view;

pub use parts::{Checkpoint, Cut, Shard};
pub use product::{Encoding, PART_ENDING, Product};
pub use reel::Reel;

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
    Frame(f64),
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
            Some(_) => Product::Picture(Encoding::new(None, None, None, &output)?.with_look(args.look)?),
            None => Product::new(&args, &output)?,
        };
        let aovs = layers::wanted(&args, &output, product, reel.is_some())?;
        let moments = Moments::new(&args, &output, reel.is_some())?;
        let cut = Cut::new(&args, product, matches!(moments, Moments::Frames(_)))?;
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
            Moments::Frame(frame) => Ok(vec![single(frame)]),
            Moments::At(seconds) => Ok(vec![single(seconds * frames_per_second)]),
            Moments::Frames(_) => {
                let frames = self.frames(length);
                if frames.is_empty() {
                    let first = frames.start;
                    return Err(Failure::Wrong(format!(
                        "no frame is left from {first} on: the animation has {length}"
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
            Moments::Frame(_) | Moments::At(_) => 0..1,
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
            (_, Some(frame), _) => Ok(Self::Frame(f64::from(frame))),
            (_, _, Some(seconds)) => Ok(Self::At(seconds)),
            _ if is_film => Ok(Self::Frames(FrameRange { first: 0, end: None })),
            _ => Ok(Self::Frame(0.0)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler::imaging::{Format, Look, SampleDepth};
    use juggler::tracer::film::Rect;

    fn plan(line: &str) -> Result<Plan, Failure> {
        Plan::new(RenderArgs::of(line.split(' ')).unwrap())
    }

    fn encoding(line: &str) -> Encoding {
        match plan(line).unwrap().product {
            Product::Picture(encoding) => encoding,
            Product::Part => panic!("{line}: a part"),
        }
    }

    fn refused(line: &str) -> String {
        match plan(line) {
            Err(Failure::Wrong(message)) => message,
            other => panic!("{line}: {other:?}"),
        }
    }

    #[test]
    fn the_output_is_named_after_the_scene() {
        assert_eq!(plan("juggler").unwrap().output, "juggler.png");
        assert_eq!(plan("scenes/pawn.json").unwrap().output, "pawn.png");
        assert_eq!(encoding("a -o b.exr").format, Format::Exr);
        assert_eq!(encoding("a -o -").format, Format::Png);
        assert_eq!(encoding("a -o - --format jpg").format, Format::Jpeg);
        assert!(refused("a -o b.tga").contains(".png"));
        assert!(refused("a -o - --format tga").contains("tga"));
    }

    #[test]
    fn bits_and_quality_fit_the_format() {
        assert!(encoding("a --bits 16").options.png_16_bit);
        let exr = |line| encoding(line).options.exr_depth;
        assert_eq!((exr("a -o b.exr --bits 16"), exr("a -o b.exr")), (SampleDepth::Half, SampleDepth::Float));
        assert_eq!(encoding("a -o b.jpg --quality 7").options.jpeg_quality, 7);
        assert!(refused("a -o b.jpg --bits 16").contains("8 bits"));
        assert!(refused("a --quality 7").contains("JPEG"));
        assert_eq!(encoding("a --look ham -o b.webp").options.look, Look::Ham);
        assert_eq!(plan("a --look ham-dithered -o b.gif").unwrap().options().look, Look::HamDithered);
        assert!(
            refused("a --look ham -o b.exr").contains("light") && refused("a --look ham -o b.jfilm").contains("--look")
        );
    }

    #[test]
    fn films_are_known_by_their_ending_and_are_of_all_frames() {
        let film = plan("a -o b.gif --plays 2").unwrap();
        let reel = film.reel.clone().unwrap();
        assert_eq!((reel.file.as_str(), reel.plays, reel.frames_per_second), ("b.gif", 2, None));
        let shots = film.shots(3, 24.0).unwrap();
        assert_eq!(shots.len(), 3);
        assert_eq!(shots[2].output, "b.gif.frames/frame_0002.png");
        assert_eq!(film.product, Product::Picture(encoding("a -o b.png")));
        assert!(plan("a -o b --format apng").unwrap().reel.is_some());
        assert!(plan("a -o b.png").unwrap().reel.is_none());
    }

    #[test]
    fn webps_are_pictures_unless_frames_go_into_one() {
        let is_film = |line: &str| plan(line).unwrap().reel.is_some();
        assert!(is_film("a -o b.webp --frames 0..3") && is_film("a -o b.webp --fps 5") && is_film("a -o b.mp4"));
        assert!(!is_film("a -o b.webp") && !is_film("a -o b_##.webp --frames 0..3"));
    }

    #[test]
    fn frames_are_shared_in_turns() {
        for output in ["f_##.png", "f.gif"] {
            let frames = |shard: &str| {
                let shots = plan(&format!("a --frames 3..8 -o {output} {shard}")).unwrap().shots(30, 24.0).unwrap();
                shots.iter().map(|shot| (shot.frame, shot.shard)).collect::<Vec<_>>()
            };
            assert_eq!(frames("--shard 0/2"), [3.0, 5.0, 7.0].map(|frame| (frame, Shard::WHOLE)));
            assert_eq!(frames("--shard 1/2"), [4.0, 6.0].map(|frame| (frame, Shard::WHOLE)));
            assert!(frames("--shard 5/9").is_empty());
        }
        let kept = plan("a -o b.gif").unwrap().shots(2, 24.0).unwrap();
        assert_eq!(kept[1].checkpoint.as_deref(), Some("b.gif.frames/frame_0001.jfilm"));
    }

    #[test]
    fn parts_are_known_by_their_ending_and_kept_on_film() {
        assert_eq!(plan("a -o b.jfilm").unwrap().product, Product::Part);
        assert_eq!(plan("a -o b --format jfilm").unwrap().product, Product::Part);
        for line in ["a -o b.jfilm", "a --checkpoint c.jfilm", "a --noise 0.1", "a --time 1", "a --samples-from b.png"]
        {
            let plan = plan(line).unwrap();
            assert!(plan.needs_film(&plan.shots(1, 1.0).unwrap()[0]), "{line}");
        }
        let plain = plan("a").unwrap();
        assert!(!plain.needs_film(&plain.shots(1, 1.0).unwrap()[0]));
        assert!(refused("a -o b.jfilm --bits 16").contains("--bits"));
        assert!(refused("a -o - --format jfilm").contains("standard output"));
        // A picture's crop is all that the picture shows; a part's is where it lies.
        let crops = |line: &str| plan(line).map(|plan| (plan.settings.crop, plan.cut.crop)).unwrap();
        let crop = Some(Rect { x: 0, y: 0, width: 16, height: 16 });
        assert_eq!((crops("a --crop 0,0,16,16"), crops("a --crop 0,0,16,16 -o b.jfilm")), ((crop, None), (None, crop)));
        let kept = plan("a --checkpoint c.jfilm --frames 0..2").unwrap().shots(2, 24.0).unwrap();
        assert_eq!(kept[1].checkpoint.as_deref(), Some("c_0001.jfilm"));
    }

    #[test]
    fn moments_become_shots() {
        let shots = |line: &str| plan(line).unwrap().shots(30, 24.0).unwrap();
        let frames = |line: &str| shots(line).iter().map(|shot| shot.frame).collect::<Vec<_>>();
        assert_eq!(frames("a"), [0.0]);
        assert_eq!(frames("a --frame 7"), [7.0]);
        assert_eq!(frames("a --at 0.5"), [12.0]);
        assert_eq!(frames("a --frames 2..4"), [2.0, 3.0]);
        assert_eq!(frames("a --frames 28.."), [28.0, 29.0]);
        assert_eq!(frames("a --frames ..").len(), 30);
        assert!(matches!(plan("a --frames 30..").unwrap().shots(30, 24.0), Err(Failure::Wrong(_))));
        let last = shots("a --frames 0..12 -o f_##.png --stats s.json").pop().unwrap();
        assert_eq!((last.output.as_str(), last.stats.as_deref()), ("f_11.png", Some("s_0011.json")));
        assert_eq!(shots("a --frames 3..4 --stats -").first().unwrap().stats.as_deref(), Some("-"));
    }

    #[test]
    fn standard_output_holds_one_thing() {
        assert!(refused("a -o - --frames 0..2").contains("one picture"));
        assert!(refused("a -o - --stats -").contains("standard output"));
        assert!(plan("a -o -").unwrap().stream_taken() && plan("a --stats -").unwrap().stream_taken());
        assert!(!plan("a --stats s.json").unwrap().stream_taken());
    }

    #[test]
    fn flags_that_exclude_each_other() {
        for line in ["a --frame 1 --at 2", "a --frame 1 --frames 1..2", "a --frames 1..2 --at 1", "a -q --progress bar"]
        {
            assert!(RenderArgs::of(line.split(' ')).is_err(), "{line}");
        }
    }
}
