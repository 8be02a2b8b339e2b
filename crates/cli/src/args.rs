//! Command-line arguments. [`crate::plan`] derives what to render from them.

use crate::command::Command as Task;
use crate::model_args::ModelArgs;
use crate::progress::Progress;
use crate::tips;
use crate::value::{self, FrameRange, Shard};
use clap::{Arg, Args as Arguments, ColorChoice, Command, CommandFactory, FromArgMatches, Parser};
use juggler::Denoiser;
use juggler::camera::film::Rect;
use juggler::imaging::{DisplayLook, Primaries, WhiteBalance};
use std::ffi::OsString;
use std::time::Duration;

/// Ray tracer whose pictures are bit-identical on every machine.
#[derive(Debug, Parser)]
#[command(name = "juggler", version, propagate_version = true, max_term_width = 100)]
pub struct Args {
    /// Command to run.
    #[command(subcommand)]
    pub command: Task,
}

impl Args {
    /// Parses a command line. A word after a flag with an optional value is that value if it parses
    /// as one, and the scene otherwise. If neither parses, the error is that of the flag's value.
    pub fn parse_arguments(words: &[OsString], color: ColorChoice) -> Result<Self, clap::Error> {
        let parse = |words: &[OsString]| {
            let matches = Self::command_line().color(color).try_get_matches_from(words)?;
            Self::from_arg_matches(&matches)
        };
        let parsed = parse(words).or_else(|error| parse(&with_optional_values(words)).map_err(|_| error));
        parsed.map_err(tips::with_tip)
    }

    /// All commands and their flags. A negative number after a flag is parsed as the flag's value,
    /// so that the error message names the flag.
    pub fn command_line() -> Command {
        let numbers = |flag: Arg| {
            let takes_value = flag.get_long().is_some() && flag.get_action().takes_values();
            if takes_value { flag.allow_negative_numbers(true) } else { flag }
        };
        Self::command().mut_subcommands(|command| command.mut_args(numbers))
    }
}

/// Flags for the view and the sampling of a picture, shared by all commands that render.
#[derive(Clone, Debug, Default, Arguments)]
pub struct ViewArgs {
    /// Width and height in pixels
    #[arg(long, value_name = "WxH", value_parser = value::size, help_heading = "Picture")]
    pub size: Option<[u32; 2]>,

    /// Samples per pixel
    ///
    /// With `--noise` or `--time`, the maximum number of samples per pixel.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=16_777_216), help_heading = "Picture")]
    pub samples: Option<u32>,

    /// Integrator: path, classic, direct, normals and others
    ///
    /// The integrators are path, classic, direct, normals, albedo, depth and ambient_occlusion. If
    /// neither the flag nor the scene names one, the scene's materials and lights decide between
    /// classic and path; `juggler info` shows which and why.
    #[arg(long, value_name = "NAME", help_heading = "Picture")]
    pub integrator: Option<String>,

    /// Maximum number of path segments (path) or of reflections and refractions (classic)
    #[arg(long, value_name = "N", help_heading = "Picture", hide_short_help = true)]
    pub max_depth: Option<u32>,

    /// Name of the camera in the scene
    #[arg(long, value_name = "NAME", help_heading = "Picture")]
    pub camera: Option<String>,

    /// Frame of an animation, counted from 0
    #[arg(long, value_name = "N", conflicts_with = "at", help_heading = "Picture")]
    pub frame: Option<u32>,

    /// Time in an animation, in seconds
    #[arg(long, value_name = "SECONDS", value_parser = value::seconds, help_heading = "Picture", hide_short_help = true)]
    pub at: Option<f64>,

    /// Shutter interval in frames, relative to the frame's time, such as 0..0.5
    ///
    /// Objects that move while the shutter is open are blurred [default: the scene's shutter].
    #[arg(long, value_name = "A..B", value_parser = value::shutter, allow_hyphen_values = true, help_heading = "Picture", hide_short_help = true)]
    pub shutter: Option<[f64; 2]>,

    /// Seed of the sampling pattern; another seed gives other noise
    #[arg(long, value_name = "N", help_heading = "Picture", hide_short_help = true)]
    pub seed: Option<u64>,
}

/// Flags of `juggler render`.
#[derive(Clone, Debug, Default, Arguments)]
pub struct RenderArgs {
    /// Scene file, model (glTF), mesh (PLY, OBJ, STL), built-in scene (see `juggler scenes`), or `-`
    /// for standard input
    pub scene: String,

    #[command(flatten)]
    pub model: ModelArgs,

    /// Output file; its extension selects the format
    ///
    /// Pictures are .png .jpg .exr .hdr .webp .pfm, movies are .mp4 .webp .apng .gif, and partial
    /// renders are .jfilm; `-` writes to standard output. The default is the scene's name with
    /// .png, in the current folder.
    #[arg(short, long, value_name = "FILE", help_heading = "Output")]
    pub output: Option<String>,

    /// File format, instead of the one that the extension selects
    #[arg(long, value_name = "FORMAT", help_heading = "Output", hide_short_help = true)]
    pub format: Option<String>,

    /// Bits per channel: 8 or 16 for PNG, 16 or 32 for EXR
    #[arg(long, value_name = "N", help_heading = "Output", hide_short_help = true)]
    pub bits: Option<u8>,

    /// Quality of a JPEG [default: 95] or an MP4 [default: 80]
    #[arg(long, value_name = "1-100", value_parser = clap::value_parser!(u8).range(1..=100), help_heading = "Output", hide_short_help = true)]
    pub quality: Option<u8>,

    /// Frames per second of a movie [default: the scene's]
    #[arg(long, value_name = "N", value_parser = value::frame_rate, help_heading = "Output", hide_short_help = true)]
    pub fps: Option<f64>,

    /// Number of times that a movie plays; 0 loops forever [default: 0]
    ///
    /// MP4 files do not store this number; the player decides.
    #[arg(long, value_name = "N", help_heading = "Output", hide_short_help = true)]
    pub plays: Option<u16>,

    /// Tone curve: srgb, agx, aces, pbr_neutral and others
    ///
    /// The curves are srgb, gamma, linear, reinhard, aces, agx and pbr_neutral. The tone curve
    /// applies to PNG, JPEG and WebP pictures and to movies; EXR, HDR and PFM files store linear
    /// radiance.
    #[arg(long, value_name = "CURVE", help_heading = "Output")]
    pub tone: Option<String>,

    /// Exposure in stops; each stop doubles the brightness
    #[arg(long, value_name = "STOPS", help_heading = "Output", hide_short_help = true)]
    pub exposure: Option<f32>,

    /// Color temperature of the light that appears white, in kelvins, such as 3200
    ///
    /// 1667 to 25000. An optional tint, -50 to 50, is positive for a greener light, such as 3200,5.
    #[arg(long, value_name = "KELVIN[,TINT]", value_parser = value::white_balance, help_heading = "Output", hide_short_help = true)]
    pub white_balance: Option<WhiteBalance>,

    /// Primaries of the file: srgb, display_p3, rec2020 (PNG and EXR) or acescg (EXR) [default:
    /// srgb]
    #[arg(long, value_name = "NAME", value_parser = value::primaries, help_heading = "Output", hide_short_help = true)]
    pub primaries: Option<Primaries>,

    /// Dither 8-bit pictures, which hides banding in gradients [default: on]
    ///
    /// Movies and display looks are never dithered.
    #[arg(long, value_name = "ON|OFF", value_parser = value::switch, help_heading = "Output", hide_short_help = true)]
    pub dither: Option<bool>,

    /// Display look of historic screens: ham or ham-dithered
    ///
    /// `ham` quantizes the picture to the 4,096 colors of the Amiga's hold-and-modify mode (best at
    /// 320x200); `ham-dithered` also dithers it.
    #[arg(long, value_name = "LOOK", value_parser = value::look, help_heading = "Output", hide_short_help = true)]
    pub look: Option<DisplayLook>,

    /// AOVs to write: albedo,normal,depth and others, or all
    ///
    /// Others include light_groups and crypto_object; the names that Blender, Arnold and V-Ray use
    /// (Z, N, diffuse_albedo, cryptomatte) are accepted too. An EXR picture contains the AOVs as
    /// layers; other pictures get a file beside them (NAME.layers.exr).
    #[arg(long, value_name = "LIST", help_heading = "Output")]
    pub aov: Option<String>,

    /// Remove noise: own (the default) or oidn
    ///
    /// `own` is the built-in denoiser, bit-identical on every machine. `oidn` is Intel Open Image
    /// Denoise, if it is installed; the environment variable JUGGLER_OIDN sets the path of its
    /// library.
    #[arg(long, value_name = "WITH", num_args = 0..=1, default_missing_value = "own", value_parser = value::denoiser, help_heading = "Output")]
    pub denoise: Option<Denoiser>,

    /// File for the AOVs: one .exr, or one .exr or .npy per AOV if the name contains `{}`
    #[arg(long, value_name = "FILE", help_heading = "Output", hide_short_help = true)]
    pub aov_output: Option<String>,

    /// Write statistics as JSON; `-` is standard output
    ///
    /// Statistics are counts of rays and objects, times, memory, and a hash of the picture.
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    pub stats: Option<String>,

    /// Progress reports on standard error
    #[arg(long, value_enum, default_value_t, help_heading = "Output", hide_short_help = true)]
    pub progress: Progress,

    /// Print errors only
    #[arg(short, long, conflicts_with = "progress", help_heading = "Output")]
    pub quiet: bool,

    #[command(flatten)]
    pub view: ViewArgs,

    /// Stop at this relative error, such as 0.02
    ///
    /// Each tile gets samples until the root mean square of the relative errors of its pixels is at
    /// most LEVEL; 0.02 is 2 %. `--samples` is the maximum number of samples per pixel.
    #[arg(long, value_name = "LEVEL", value_parser = value::noise, conflicts_with = "time", help_heading = "Picture")]
    pub noise: Option<f32>,

    /// Stop after this many seconds of rendering
    ///
    /// `--samples` is the maximum number of samples per pixel.
    #[arg(long, value_name = "SECONDS", value_parser = value::duration, help_heading = "Picture")]
    pub time: Option<Duration>,

    /// Repeat the numbers of samples of a picture or partial render that `--time` ended
    #[arg(long, value_name = "FILE", conflicts_with_all = ["samples", "noise", "time"], help_heading = "Picture", hide_short_help = true)]
    pub samples_from: Option<String>,

    /// Frames A to B-1, as a movie or as numbered pictures
    ///
    /// `####` or `%04d` in the name of a picture becomes the frame number. Existing pictures are
    /// kept if the same command made them from the same scene.
    #[arg(long, value_name = "A..B", value_parser = value::frames, conflicts_with_all = ["frame", "at"], help_heading = "Picture")]
    pub frames: Option<FrameRange>,

    /// Region of the picture to render
    ///
    /// Left, top, width and height in pixels.
    #[arg(long, value_name = "X,Y,W,H", value_parser = value::crop, help_heading = "Picture")]
    pub crop: Option<Rect>,

    /// Checkpoint file (.jfilm) to write and to resume from
    ///
    /// If the render is interrupted, the same command resumes from the checkpoint. A finished
    /// picture can be resumed with more samples.
    #[arg(long, value_name = "FILE", help_heading = "Partial renders")]
    pub checkpoint: Option<String>,

    /// Time between checkpoints
    #[arg(long, value_name = "SECONDS", value_parser = value::interval, default_value = "60", requires = "checkpoint", help_heading = "Partial renders", hide_short_help = true)]
    pub checkpoint_every: f64,

    /// Render part I of N, to be joined by `juggler merge`
    ///
    /// All parts cost about the same. I counts from 0; `auto` reads it from SLURM_ARRAY_TASK_ID,
    /// JOB_COMPLETION_INDEX or HQ_TASK_ID. For a picture, the part is a partial render (.jfilm).
    /// For a movie or numbered pictures, it is every N-th frame; for a movie, the same command
    /// without --shard then encodes all frames.
    #[arg(long, value_name = "I/N", value_parser = value::shard, help_heading = "Partial renders")]
    pub shard: Option<Shard>,

    /// Samples A to B-1 of each pixel, as a partial render; multiples of 16
    #[arg(long, value_name = "A..B", value_parser = value::samples, conflicts_with_all = ["noise", "time", "shard", "samples_from"], help_heading = "Partial renders", hide_short_help = true)]
    pub sample_range: Option<std::ops::Range<u32>>,

    /// Number of threads [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024), help_heading = "Machine")]
    pub threads: Option<u16>,

    /// Memory limit, such as 4G
    ///
    /// Smaller bands of pixels and fewer threads keep the render below the limit. A render that
    /// still needs more is refused before its files are read.
    #[arg(long, value_name = "SIZE", value_parser = value::memory, help_heading = "Machine", hide_short_help = true)]
    pub max_memory: Option<u64>,
}

/// Default value of a flag whose value is optional, and whether `word` parses as its value. Returns
/// `None` for all other flags.
fn optional_value(flag: &str, word: &str) -> Option<(&'static str, bool)> {
    match flag {
        "--denoise" => Some(("own", value::denoiser(word).is_ok())),
        "--fireflies" => Some(("10", word.parse::<u32>().is_ok())),
        _ => None,
    }
}

/// Inserts the omitted optional values of a command line: `--denoise scene.json` uses the default
/// denoiser and leaves the scene as an argument.
fn with_optional_values(words: &[OsString]) -> Vec<OsString> {
    let end = words.iter().position(|word| word == "--").unwrap_or(words.len());
    let filled = |(at, word): (usize, &OsString)| {
        let next = words.get(at + 1).and_then(|next| next.to_str()).unwrap_or_default();
        match word.to_str().filter(|_| at < end).and_then(|flag| Some((flag, optional_value(flag, next)?))) {
            Some((flag, (default, false))) => format!("{flag}={default}").into(),
            _ => word.clone(),
        }
    };
    words.iter().enumerate().map(filled).collect()
}

#[cfg(test)]
impl RenderArgs {
    /// Parses the arguments of `juggler render`.
    pub fn from_words<'w>(words: impl IntoIterator<Item = &'w str>) -> Result<Self, clap::Error> {
        let words: Vec<OsString> = ["juggler", "render"].into_iter().chain(words).map(OsString::from).collect();
        match Args::parse_arguments(&words, ColorChoice::Never)?.command {
            Task::Render(args) => Ok(*args),
            other => panic!("`render` is not {other:?}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn filled(line: &str) -> String {
        let words: Vec<OsString> = line.split(' ').map(OsString::from).collect();
        with_optional_values(&words).into_iter().map(|word| word.into_string().unwrap()).collect::<Vec<_>>().join(" ")
    }

    #[test]
    fn flags_with_optional_values_do_not_consume_the_scene() {
        assert_eq!(filled("render --denoise scene.json -q"), "render --denoise=own scene.json -q");
        assert_eq!(filled("render scene.json --denoise"), "render scene.json --denoise=own");
        assert_eq!(filled("render --denoise oidn scene.json"), "render --denoise oidn scene.json");
        assert_eq!(filled("render --denoise=oidn scene.json"), "render --denoise=oidn scene.json");
        assert_eq!(filled("probe --fireflies juggler"), "probe --fireflies=10 juggler");
        assert_eq!(filled("probe --fireflies 20 juggler"), "probe --fireflies 20 juggler");
        assert_eq!(filled("render -- --denoise"), "render -- --denoise");
    }
}
