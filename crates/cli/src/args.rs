//! Flags of `juggler render`, and flags that all rendering commands share. [`crate::plan`] derives
//! the plan of a render from them.

use crate::flags::GivenFlags;
use crate::model_args::ModelArgs;
use crate::progress::Progress;
use crate::value::{self, FrameRange, Shard};
use clap::Args;
use juggler::Denoiser;
use juggler::camera::film::Rect;
use juggler::imaging::{DisplayLook, Primaries, WhiteBalance};
use std::time::Duration;

/// Flags for the view and the sampling of a picture, shared by all commands that render.
#[derive(Clone, Debug, Default, Args)]
pub struct ViewArgs {
    /// Width and height in pixels
    #[arg(long, value_name = "WxH", value_parser = value::size)]
    pub size: Option<[u32; 2]>,

    /// Samples per pixel
    ///
    /// With `--noise` or `--time`, the maximum number of samples per pixel.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=16_777_216))]
    pub samples: Option<u32>,

    /// Integrator: path, classic, direct, normals and others
    ///
    /// The integrators are path, classic, direct, normals, albedo, depth and ambient_occlusion. If
    /// neither the flag nor the scene names one, the scene's materials and lights decide between
    /// classic and path; `juggler info` shows which and why.
    #[arg(long, value_name = "NAME")]
    pub integrator: Option<String>,

    /// Maximum length of light paths: 2 is direct light, each further 1 a bounce between surfaces
    ///
    /// The integrator path counts the segments between camera and light, one more than the bounces;
    /// the integrator classic counts reflections and refractions.
    #[arg(long, value_name = "N", hide_short_help = true)]
    pub max_depth: Option<u32>,

    /// Name of the camera in the scene
    #[arg(long, value_name = "NAME")]
    pub camera: Option<String>,

    /// Frame of an animation, counted from 0
    #[arg(long, value_name = "N", conflicts_with = "at")]
    pub frame: Option<u32>,

    /// Time in an animation, in seconds
    #[arg(long, value_name = "SECONDS", value_parser = value::seconds, hide_short_help = true)]
    pub at: Option<f64>,

    /// Shutter interval in frames, relative to the frame's time, such as 0..0.5
    ///
    /// Objects that move while the shutter is open are blurred [default: the scene's shutter].
    #[arg(long, value_name = "A..B", value_parser = value::shutter, allow_hyphen_values = true, hide_short_help = true)]
    pub shutter: Option<[f64; 2]>,

    /// Seed of the sampling pattern; another seed gives other noise
    #[arg(long, value_name = "N", hide_short_help = true)]
    pub seed: Option<u64>,
}

/// Flags of `juggler render`.
#[derive(Clone, Debug, Default, Args)]
pub struct RenderArgs {
    #[command(flatten)]
    pub given: GivenFlags,

    /// Scene file, model (glTF), mesh (PLY, OBJ, STL), built-in scene (see `juggler scenes`), folder of
    /// scene files, or `-` for standard input
    pub scene: String,

    /// Further scenes and folders of scene files
    ///
    /// They are rendered one after the other. A scene that fails does not stop the others.
    #[arg(value_name = "SCENE")]
    pub more_scenes: Vec<String>,

    #[command(flatten)]
    pub model: ModelArgs,

    /// Output file; its extension selects the format
    ///
    /// Pictures are .png .jpg .exr .hdr .webp .pfm, movies are .mp4 .webp .apng .gif, and partial
    /// renders are .jfilm; `-` writes to standard output. The default is the scene's name with
    /// .png, in the current folder. For several scenes, a folder, or a name in which `{}` becomes the
    /// name of the scene.
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<String>,

    /// Keep pictures that the same command made from the same scene
    ///
    /// PNG, EXR and HDR files store their command and a fingerprint of their scene: of all values, of
    /// its files and of the settings of the render. Pictures of `--frames` are kept without this flag.
    #[arg(long, hide_short_help = true)]
    pub resume: bool,

    /// File format, instead of the one that the extension selects
    #[arg(long, value_name = "FORMAT", hide_short_help = true)]
    pub format: Option<String>,

    /// Bits per channel: 8 or 16 for PNG, 16 or 32 for EXR
    #[arg(long, value_name = "N", hide_short_help = true)]
    pub bits: Option<u8>,

    /// Quality of a JPEG [default: 95] or an MP4 [default: 80]
    #[arg(long, value_name = "1-100", value_parser = clap::value_parser!(u8).range(1..=100), hide_short_help = true)]
    pub quality: Option<u8>,

    /// Frames per second of a movie [default: the scene's]
    #[arg(long, value_name = "N", value_parser = value::frame_rate, hide_short_help = true)]
    pub fps: Option<f64>,

    /// Number of times that a movie plays; 0 loops forever [default: 0]
    ///
    /// MP4 files do not store this number; the player decides.
    #[arg(long, value_name = "N", hide_short_help = true)]
    pub plays: Option<u16>,

    /// Tone curve: srgb, agx, aces, pbr_neutral and others
    ///
    /// The curves are srgb, gamma, linear, reinhard, aces, agx and pbr_neutral. The tone curve
    /// applies to PNG, JPEG and WebP pictures and to movies; EXR, HDR and PFM files store linear
    /// radiance.
    #[arg(long, value_name = "CURVE")]
    pub tone: Option<String>,

    /// Exposure in stops; each stop doubles the brightness
    #[arg(long, value_name = "STOPS", hide_short_help = true)]
    pub exposure: Option<f32>,

    /// Color temperature of the light that appears white, in kelvins, such as 3200
    ///
    /// 1667 to 25000. An optional tint, -50 to 50, is positive for a greener light, such as 3200,5.
    #[arg(long, value_name = "KELVIN[,TINT]", value_parser = value::white_balance, hide_short_help = true)]
    pub white_balance: Option<WhiteBalance>,

    /// Primaries of the file: srgb, display_p3, rec2020 (PNG and EXR) or acescg (EXR) [default:
    /// srgb]
    #[arg(long, value_name = "NAME", value_parser = value::primaries, hide_short_help = true)]
    pub primaries: Option<Primaries>,

    /// Dither 8-bit pictures, which hides banding in gradients [default: on]
    ///
    /// Movies and display looks are never dithered.
    #[arg(long, value_name = "ON|OFF", value_parser = value::switch, hide_short_help = true)]
    pub dither: Option<bool>,

    /// Display look of historic screens: ham or ham-dithered
    ///
    /// `ham` quantizes the picture to the 4,096 colors of the Amiga's hold-and-modify mode (best at
    /// 320x200); `ham-dithered` also dithers it.
    #[arg(long, value_name = "LOOK", value_parser = value::look, hide_short_help = true)]
    pub look: Option<DisplayLook>,

    /// Hide the background and write alpha
    ///
    /// The background's light stays. PNG, WebP, EXR and APNG files store alpha; GIF stores whether
    /// it is at least one half. Colors are straight in PNG, WebP and APNG, and multiplied by alpha in
    /// EXR.
    #[arg(long)]
    pub transparent: bool,

    /// AOVs to write: albedo,normal,depth and others, or all
    ///
    /// Others include light_groups and crypto_object; the names that Blender, Arnold and V-Ray use
    /// (Z, N, diffuse_albedo, cryptomatte) are accepted too. An EXR picture contains the AOVs as
    /// layers; other pictures get a file beside them (NAME.layers.exr).
    #[arg(long, value_name = "LIST")]
    pub aov: Option<String>,

    /// Remove noise: own (the default) or oidn
    ///
    /// `own` is the built-in denoiser, bit-identical on every machine. `oidn` is Intel Open Image
    /// Denoise, if it is installed; the environment variable JUGGLER_OIDN sets the path of its
    /// library.
    #[arg(long, value_name = "WITH", num_args = 0..=1, default_missing_value = "own", value_parser = value::denoiser)]
    pub denoise: Option<Denoiser>,

    /// File for the AOVs: one .exr, or one .exr or .npy per AOV if the name contains `{}`
    #[arg(long, value_name = "FILE", hide_short_help = true)]
    pub aov_output: Option<String>,

    /// Write statistics as JSON; `-` is standard output
    ///
    /// Statistics are counts of rays and objects, times, memory, and a hash of the picture.
    #[arg(long, value_name = "FILE", hide_short_help = true)]
    pub stats: Option<String>,

    /// Progress reports on standard error
    #[arg(long, value_enum, default_value_t, hide_short_help = true)]
    pub progress: Progress,

    /// Print errors only
    #[arg(short, long, conflicts_with = "progress")]
    pub quiet: bool,

    #[command(flatten)]
    pub view: ViewArgs,

    /// Stop at this relative error, such as 0.02
    ///
    /// Each tile gets samples until the root mean square of the relative errors of its pixels is at
    /// most LEVEL; 0.02 is 2 %. `--samples` is the maximum number of samples per pixel.
    #[arg(long, value_name = "LEVEL", value_parser = value::noise, conflicts_with = "time")]
    pub noise: Option<f32>,

    /// Stop after this many seconds of rendering
    ///
    /// `--samples` is the maximum number of samples per pixel.
    #[arg(long, value_name = "SECONDS", value_parser = value::duration)]
    pub time: Option<Duration>,

    /// Repeat the numbers of samples of a picture or partial render that `--time` ended
    #[arg(long, value_name = "FILE", conflicts_with_all = ["samples", "noise", "time"], hide_short_help = true)]
    pub samples_from: Option<String>,

    /// Frames A to B-1, as a movie or as numbered pictures
    ///
    /// `####` or `%04d` in the name of a picture becomes the frame number. Existing pictures are
    /// kept if the same command made them from the same scene.
    #[arg(long, value_name = "A..B", value_parser = value::frames, conflicts_with_all = ["frame", "at"])]
    pub frames: Option<FrameRange>,

    /// Region of the picture to render
    ///
    /// Left, top, width and height in pixels.
    #[arg(long, value_name = "X,Y,W,H", value_parser = value::crop, hide_short_help = true)]
    pub crop: Option<Rect>,

    /// Checkpoint file (.jfilm) to write and to resume from
    ///
    /// If the render is interrupted, the same command resumes from the checkpoint. A finished
    /// picture can be resumed with more samples.
    #[arg(long, value_name = "FILE", hide_short_help = true)]
    pub checkpoint: Option<String>,

    /// Time between checkpoints
    #[arg(long, value_name = "SECONDS", value_parser = value::interval, default_value = "60", requires = "checkpoint", hide_short_help = true)]
    pub checkpoint_every: f64,

    /// Render part I of N, to be joined by `juggler merge`
    ///
    /// All parts cost about the same. I counts from 0; `auto` reads it from SLURM_ARRAY_TASK_ID,
    /// JOB_COMPLETION_INDEX or HQ_TASK_ID. For a picture, the part is a partial render (.jfilm).
    /// For a movie or numbered pictures, it is every N-th frame; for a movie, the same command
    /// without --shard then encodes all frames.
    #[arg(long, value_name = "I/N", value_parser = value::shard, hide_short_help = true)]
    pub shard: Option<Shard>,

    /// Samples A to B-1 of each pixel, as a partial render; multiples of 16
    #[arg(long, value_name = "A..B", value_parser = value::samples, conflicts_with_all = ["noise", "time", "shard", "samples_from"], hide_short_help = true)]
    pub sample_range: Option<std::ops::Range<u32>>,

    /// Number of threads [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,

    /// Memory limit, such as 4G
    ///
    /// Smaller bands of pixels and fewer threads keep the render below the limit. A render that
    /// still needs more is refused before its files are read.
    #[arg(long, value_name = "SIZE", value_parser = value::memory, hide_short_help = true)]
    pub max_memory: Option<u64>,
}

impl RenderArgs {
    /// Whether a model turns and no frame is chosen, so that the command asks for all frames of the
    /// turn.
    pub fn turns_in_all_frames(&self) -> bool {
        self.model.stage.turntable.is_some() && self.view.frame.is_none() && self.view.at.is_none()
    }
}

#[cfg(test)]
impl RenderArgs {
    /// Parses the arguments of `juggler render`.
    pub fn from_words<'w>(words: impl IntoIterator<Item = &'w str>) -> Result<Self, clap::Error> {
        use crate::command::Command;
        use crate::command_line::CommandLine;
        let words: Vec<_> = ["juggler", "render"].into_iter().chain(words).map(std::ffi::OsString::from).collect();
        match CommandLine::parse_words(&words, clap::ColorChoice::Never)?.command {
            Command::Render(args) => Ok(*args),
            other => panic!("`render` is not {other:?}"),
        }
    }
}
