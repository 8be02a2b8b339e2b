//! What `juggler render` was asked for, from what was typed.

use crate::args::RenderArgs;
use crate::failure::Failure;
use crate::output::{self, STANDARD_OUTPUT};
use crate::progress::Progress;
use crate::source;
use crate::value::FrameRange;
use juggler::Settings;
use juggler::imaging::{Format, Options, SampleDepth};
use std::ops::Range;
use std::path::Path;

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
    /// How it is written.
    pub encoding: Encoding,
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

/// A file format with what it was asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Encoding {
    /// The format.
    pub format: Format,
    /// The choices that it leaves.
    pub options: Options,
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
    /// The statistics' file.
    pub stats: Option<String>,
}

impl Plan {
    /// Works out what was meant, or says why it cannot be.
    pub fn new(args: RenderArgs) -> Result<Self, Failure> {
        let output = args.output.clone().unwrap_or_else(|| format!("{}.png", source::stem(&args.scene)));
        if output.is_empty() {
            return Err(Failure::Wrong("the output has no name".into()));
        }
        output::at_most_one_stream(&output, args.stats.as_deref())?;
        let encoding = Encoding::new(args.format.as_deref(), args.bits, args.quality, &output)?;
        let moments = match (args.frames, args.frame, args.at) {
            (Some(_), ..) if output == STANDARD_OUTPUT => {
                return Err(Failure::Wrong("several frames need files: standard output holds one picture".into()));
            }
            (Some(range), ..) => Moments::Frames(range),
            (_, Some(frame), _) => Moments::Frame(f64::from(frame)),
            (_, _, Some(seconds)) => Moments::At(seconds),
            _ => Moments::Frame(0.0),
        };
        let cores = std::thread::available_parallelism().map_or(FALLBACK_THREADS, std::num::NonZero::get);
        Ok(Self {
            settings: Settings {
                size: args.size,
                samples: args.samples,
                integrator: args.integrator,
                max_depth: args.max_depth,
                camera: args.camera,
                seed: args.seed,
                crop: args.crop,
                curve: args.tone,
                exposure_stops: args.exposure,
            },
            scene: args.scene,
            moments,
            output,
            encoding,
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

    /// The pictures, for an animation of this length and pace.
    pub fn shots(&self, length: u32, frames_per_second: f64) -> Result<Vec<Shot>, Failure> {
        let single = |frame: f64| Shot { frame, output: self.output.clone(), stats: self.stats.clone() };
        match self.moments {
            Moments::Frame(frame) => Ok(vec![single(frame)]),
            Moments::At(seconds) => Ok(vec![single(seconds * frames_per_second)]),
            Moments::Frames(range) => {
                let frames = range.first..range.end.unwrap_or(length);
                if frames.is_empty() {
                    let first = range.first;
                    return Err(Failure::Wrong(format!(
                        "no frame is left from {first} on: the animation has {length}"
                    )));
                }
                Ok(self.numbered(frames))
            }
        }
    }

    fn numbered(&self, frames: Range<u32>) -> Vec<Shot> {
        let name =
            |name: &str, frame| if name == STANDARD_OUTPUT { name.into() } else { output::numbered(name, frame) };
        let shot = |frame: u32| Shot {
            frame: f64::from(frame),
            output: name(&self.output, frame),
            stats: self.stats.as_deref().map(|stats| name(stats, frame)),
        };
        frames.map(shot).collect()
    }
}

impl Encoding {
    /// What was asked for, or what the output's ending says.
    pub fn new(format: Option<&str>, bits: Option<u8>, quality: Option<u8>, output: &str) -> Result<Self, Failure> {
        let wrong = |message: String| Failure::Wrong(message);
        let format = match format {
            Some(name) => Format::from_path(Path::new(&format!("picture.{name}")))
                .map_err(|_| wrong(format!("no format is called `{name}`; known are {}", Format::endings())))?,
            None if output == STANDARD_OUTPUT => Format::Png,
            None => Format::from_path(Path::new(output)).map_err(|error| wrong(error.to_string()))?,
        };
        let mut options = Options::default();
        if let Some(bits) = bits {
            set_bits(&mut options, format, bits)?;
        }
        if let Some(quality) = quality {
            if format != Format::Jpeg {
                return Err(wrong(format!("--quality is for JPEG files; a {format} file has none")));
            }
            options.jpeg_quality = quality;
        }
        Ok(Self { format, options })
    }
}

fn set_bits(options: &mut Options, format: Format, bits: u8) -> Result<(), Failure> {
    let possible: &[u8] = match format {
        Format::Png => &[8, 16],
        Format::Exr => &[16, 32],
        Format::Pfm => &[32],
        Format::Jpeg | Format::Webp | Format::Hdr => &[8],
    };
    if !possible.contains(&bits) {
        let possible = possible.iter().map(u8::to_string).collect::<Vec<_>>().join(" or ");
        return Err(Failure::Wrong(format!("a {format} file has {possible} bits a channel, not {bits}")));
    }
    options.png_16_bit = bits == 16;
    options.exr_depth = if bits == 16 { SampleDepth::Half } else { SampleDepth::Float };
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plan(line: &str) -> Result<Plan, Failure> {
        Plan::new(RenderArgs::of(line.split(' ')).unwrap())
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
        assert_eq!(plan("a -o b.exr").unwrap().encoding.format, Format::Exr);
        assert_eq!(plan("a -o -").unwrap().encoding.format, Format::Png);
        assert_eq!(plan("a -o - --format jpg").unwrap().encoding.format, Format::Jpeg);
        assert!(refused("a -o b.tga").contains(".png"));
        assert!(refused("a -o - --format tga").contains("tga"));
    }

    #[test]
    fn bits_and_quality_fit_the_format() {
        assert!(plan("a --bits 16").unwrap().encoding.options.png_16_bit);
        let exr = |line| plan(line).unwrap().encoding.options.exr_depth;
        assert_eq!((exr("a -o b.exr --bits 16"), exr("a -o b.exr")), (SampleDepth::Half, SampleDepth::Float));
        assert_eq!(plan("a -o b.jpg --quality 7").unwrap().encoding.options.jpeg_quality, 7);
        assert!(refused("a -o b.jpg --bits 16").contains("8 bits"));
        assert!(refused("a --quality 7").contains("JPEG"));
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
