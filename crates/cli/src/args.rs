//! What was typed. What it means is worked out in [`crate::plan`].

use crate::command::Command as Task;
use crate::progress::Progress;
use crate::tips;
use crate::value::{self, FrameRange, Shard};
use clap::{Arg, Args as Arguments, ColorChoice, Command, CommandFactory, FromArgMatches, Parser};
use juggler::Denoiser;
use juggler::camera::film::Rect;
use juggler::imaging::{Look, Primaries, WhiteBalance};
use std::ffi::OsString;
use std::time::Duration;

/// A ray tracer whose pictures are the same to the bit everywhere.
#[derive(Debug, Parser)]
#[command(name = "juggler", version, propagate_version = true, max_term_width = 100)]
pub struct Args {
    /// What to do.
    #[command(subcommand)]
    pub command: Task,
}

impl Args {
    /// Reads a command line. A word after a flag whose value may be omitted is the value if it can
    /// be, else the scene; where neither fits, the error is that of the value.
    pub fn parse_words(words: &[OsString], color: ColorChoice) -> Result<Self, clap::Error> {
        let parse = |words: &[OsString]| {
            let matches = Self::command_line().color(color).try_get_matches_from(words)?;
            Self::from_arg_matches(&matches)
        };
        let parsed = parse(words).or_else(|error| parse(&with_optional_values(words)).map_err(|_| error));
        parsed.map_err(tips::mended)
    }

    /// All commands and their flags. A negative number after a flag is the flag's value, to be
    /// refused as such.
    pub fn command_line() -> Command {
        let numbers = |flag: Arg| {
            let takes_value = flag.get_long().is_some() && flag.get_action().takes_values();
            if takes_value { flag.allow_negative_numbers(true) } else { flag }
        };
        Self::command().mut_subcommands(|command| command.mut_args(numbers))
    }
}

/// Flags that say what a picture is of and how it is sampled, for all that render.
#[derive(Clone, Debug, Default, Arguments)]
pub struct ViewArgs {
    /// Width and height in pixels
    #[arg(long, value_name = "WxH", value_parser = value::size, help_heading = "Picture")]
    pub size: Option<[u32; 2]>,

    /// Samples per pixel
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=16_777_216), help_heading = "Picture")]
    pub samples: Option<u32>,

    /// How light is followed: classic, path, direct, normals ...
    #[arg(long, value_name = "NAME", help_heading = "Picture")]
    pub integrator: Option<String>,

    /// Maximum number of mirror and glass bounces (classic) or of path segments (path)
    #[arg(long, value_name = "N", help_heading = "Picture", hide_short_help = true)]
    pub max_depth: Option<u32>,

    /// One of the scene's cameras
    #[arg(long, value_name = "NAME", help_heading = "Picture")]
    pub camera: Option<String>,

    /// One frame of an animation, counted from 0
    #[arg(long, value_name = "N", conflicts_with = "at", help_heading = "Picture")]
    pub frame: Option<u32>,

    /// A moment of an animation
    #[arg(long, value_name = "SECONDS", value_parser = value::seconds, help_heading = "Picture", hide_short_help = true)]
    pub at: Option<f64>,

    /// When the shutter opens and closes, in frames from the frame's own time, such as 0..0.5
    ///
    /// What moves meanwhile is blurred [default: the scene's].
    #[arg(long, value_name = "A..B", value_parser = value::shutter, allow_hyphen_values = true, help_heading = "Picture", hide_short_help = true)]
    pub shutter: Option<[f64; 2]>,

    /// Another seed, another noise
    #[arg(long, value_name = "N", help_heading = "Picture", hide_short_help = true)]
    pub seed: Option<u64>,
}

/// Flags of `juggler render`.
#[derive(Clone, Debug, Default, Arguments)]
pub struct RenderArgs {
    /// A scene file, a mesh (PLY, OBJ, STL), a built-in scene (see `juggler scenes`), or `-` for standard input
    pub scene: String,

    /// Where the picture or movie goes; the ending says the format
    ///
    /// Pictures are .png .jpg .exr .hdr .webp .pfm, movies .mp4 .webp .apng .gif, parts of pictures
    /// .jfilm; `-` is standard output. The default is the scene's name with .png, in the current
    /// folder.
    #[arg(short, long, value_name = "FILE", help_heading = "Output")]
    pub output: Option<String>,

    /// The file format, instead of the one that the ending says
    #[arg(long, value_name = "FORMAT", help_heading = "Output", hide_short_help = true)]
    pub format: Option<String>,

    /// Bits of a channel: 8 or 16 in a PNG, 16 or 32 in an EXR
    #[arg(long, value_name = "N", help_heading = "Output", hide_short_help = true)]
    pub bits: Option<u8>,

    /// Quality of a JPEG [default: 95] or an MP4 [default: 80]
    #[arg(long, value_name = "1-100", value_parser = clap::value_parser!(u8).range(1..=100), help_heading = "Output", hide_short_help = true)]
    pub quality: Option<u8>,

    /// Frames a second of a movie [default: the scene's]
    #[arg(long, value_name = "N", value_parser = value::pace, help_heading = "Output", hide_short_help = true)]
    pub fps: Option<f64>,

    /// How often a movie is shown; 0 for over and over [default: 0]
    ///
    /// An MP4 leaves that to who shows it.
    #[arg(long, value_name = "N", help_heading = "Output", hide_short_help = true)]
    pub plays: Option<u16>,

    /// Tone curve: srgb, gamma, linear, reinhard, aces, agx or pbr_neutral
    ///
    /// It makes levels of linear light: EXR, HDR and PFM files have none.
    #[arg(long, value_name = "CURVE", help_heading = "Output")]
    pub tone: Option<String>,

    /// Stops by which the picture is brightened
    #[arg(long, value_name = "STOPS", help_heading = "Output", hide_short_help = true)]
    pub exposure: Option<f32>,

    /// The light that is to look white, by its color temperature, such as 3200
    ///
    /// And how far it is greener, such as 3200,5.
    #[arg(long, value_name = "KELVIN[,TINT]", value_parser = value::white_balance, help_heading = "Output", hide_short_help = true)]
    pub white_balance: Option<WhiteBalance>,

    /// The primaries of the file: srgb, display_p3 or rec2020 (PNG and EXR), acescg (EXR) [default: srgb]
    #[arg(long, value_name = "NAME", value_parser = value::primaries, help_heading = "Output", hide_short_help = true)]
    pub primaries: Option<Primaries>,

    /// Whether pictures of 8 bits are dithered, so that gradients show no steps [default: on]
    ///
    /// Movies and looks never are.
    #[arg(long, value_name = "ON|OFF", value_parser = value::switch, help_heading = "Output", hide_short_help = true)]
    pub dither: Option<bool>,

    /// A display look of old screens: ham or ham-dithered
    ///
    /// `ham` is the Amiga's 4,096 colors, held and modified (at home in 320x200), `ham-dithered`
    /// the same with what lies between them dithered.
    #[arg(long, value_name = "LOOK", value_parser = value::look, help_heading = "Output", hide_short_help = true)]
    pub look: Option<Look>,

    /// AOVs beside the picture: albedo,normal,depth ... or all
    ///
    /// light_groups, crypto_object and others; names of Blender, Arnold and V-Ray (Z, N,
    /// diffuse_albedo, cryptomatte) are understood. An EXR holds them itself, another picture has
    /// them beside it (NAME.layers.exr).
    #[arg(long, value_name = "LIST", help_heading = "Output")]
    pub aov: Option<String>,

    /// Take the noise out: own (the default) or oidn
    ///
    /// `own` is the program's filter, the same bits everywhere, `oidn` Intel's Open Image Denoise
    /// where it is installed (JUGGLER_OIDN may say where).
    #[arg(long, value_name = "WITH", num_args = 0..=1, default_missing_value = "own", value_parser = value::denoiser, help_heading = "Output")]
    pub denoise: Option<Denoiser>,

    /// Where the AOVs go: one .exr, or one .exr or .npy each where the name holds `{}` for the
    /// AOV's
    #[arg(long, value_name = "FILE", help_heading = "Output", hide_short_help = true)]
    pub aov_output: Option<String>,

    /// Write counts, times and the hash as JSON; `-` is standard output
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    pub stats: Option<String>,

    /// Show how far it is, on standard error
    #[arg(long, value_enum, default_value_t, help_heading = "Output", hide_short_help = true)]
    pub progress: Progress,

    /// Say nothing but errors
    #[arg(short, long, conflicts_with = "progress", help_heading = "Output")]
    pub quiet: bool,

    #[command(flatten)]
    pub view: ViewArgs,

    /// Stop when the relative error is at most this everywhere, such as 0.02
    ///
    /// The relative error of every part of the picture, 0.02 being 2 %; `--samples` is then the
    /// most.
    #[arg(long, value_name = "LEVEL", value_parser = value::noise, conflicts_with = "time", help_heading = "Picture")]
    pub noise: Option<f32>,

    /// Stop after so many seconds of rendering
    ///
    /// `--samples` is then the most.
    #[arg(long, value_name = "SECONDS", value_parser = value::duration, help_heading = "Picture")]
    pub time: Option<Duration>,

    /// Take as many samples everywhere as a picture or film part did that was ended by `--time`
    #[arg(long, value_name = "FILE", conflicts_with_all = ["samples", "noise", "time"], help_heading = "Picture", hide_short_help = true)]
    pub samples_from: Option<String>,

    /// Frames A up to, but without, B, as a movie or as numbered pictures
    ///
    /// `####` or `%04d` in the name of a picture becomes the number. Pictures that are there, made
    /// by the same command from the same scene, are left.
    #[arg(long, value_name = "A..B", value_parser = value::frames, conflicts_with_all = ["frame", "at"], help_heading = "Picture")]
    pub frames: Option<FrameRange>,

    /// A part of the picture
    #[arg(long, value_name = "X,Y,W,H", value_parser = value::crop, help_heading = "Picture")]
    pub crop: Option<Rect>,

    /// Keep the work in this film part (.jfilm), and go on with what is there
    ///
    /// Nothing is lost when the render is killed: the same command goes on. A finished picture goes
    /// on to more samples.
    #[arg(long, value_name = "FILE", help_heading = "Parts")]
    pub checkpoint: Option<String>,

    /// How often it is kept
    #[arg(long, value_name = "SECONDS", value_parser = value::pause, default_value = "60", requires = "checkpoint", help_heading = "Parts", hide_short_help = true)]
    pub checkpoint_every: f64,

    /// Part I of N parts that cost about the same, for `juggler merge`
    ///
    /// I counts from 0, `auto` takes it from SLURM_ARRAY_TASK_ID, JOB_COMPLETION_INDEX or
    /// HQ_TASK_ID. Of a picture it goes into a film part (.jfilm). Of the frames of a movie or of
    /// numbered pictures it is every N-th; of a movie, the same command without it then makes the
    /// movie of them.
    #[arg(long, value_name = "I/N", value_parser = value::shard, help_heading = "Parts")]
    pub shard: Option<Shard>,

    /// The samples A up to, but without, B of each pixel, into a film part; multiples of 16
    #[arg(long, value_name = "A..B", value_parser = value::samples, conflicts_with_all = ["noise", "time", "shard", "samples_from"], help_heading = "Parts", hide_short_help = true)]
    pub sample_range: Option<std::ops::Range<u32>>,

    /// Threads [default: one for each core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024), help_heading = "Machine")]
    pub threads: Option<u16>,

    /// Stay within so much memory, such as 4G
    ///
    /// Bands get smaller and threads fewer; what needs more is refused before it is read.
    #[arg(long, value_name = "SIZE", value_parser = value::memory, help_heading = "Machine", hide_short_help = true)]
    pub max_memory: Option<u64>,
}

/// The value that a flag has where its own is omitted, and whether a word is such a value; `None`
/// for flags whose value is never omitted.
fn optional_value(flag: &str, word: &str) -> Option<(&'static str, bool)> {
    match flag {
        "--denoise" => Some(("own", value::denoiser(word).is_ok())),
        "--fireflies" => Some(("10", word.parse::<u32>().is_ok())),
        _ => None,
    }
}

/// The words of a command line with omitted values filled in: `--denoise scene.json` denoises by
/// default and leaves the scene to be read as the scene.
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
    /// As `juggler render` reads these words.
    pub fn of<'w>(words: impl IntoIterator<Item = &'w str>) -> Result<Self, clap::Error> {
        let words: Vec<OsString> = ["juggler", "render"].into_iter().chain(words).map(OsString::from).collect();
        match Args::parse_words(&words, ColorChoice::Never)?.command {
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
    fn optional_values_leave_the_scene_alone() {
        assert_eq!(filled("render --denoise scene.json -q"), "render --denoise=own scene.json -q");
        assert_eq!(filled("render scene.json --denoise"), "render scene.json --denoise=own");
        assert_eq!(filled("render --denoise oidn scene.json"), "render --denoise oidn scene.json");
        assert_eq!(filled("render --denoise=oidn scene.json"), "render --denoise=oidn scene.json");
        assert_eq!(filled("probe --fireflies juggler"), "probe --fireflies=10 juggler");
        assert_eq!(filled("probe --fireflies 20 juggler"), "probe --fireflies 20 juggler");
        assert_eq!(filled("render -- --denoise"), "render -- --denoise");
    }
}
