//! How things stand.

use crate::Channel;
use juggler::camera::film::Rect;
use serde::Serialize;
use serde_json::Value;

/// What the session is at.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Stage {
    /// A scene is read, or its world is built. What is shown is of before.
    #[default]
    Loading,
    /// The camera moves, or time: frames follow each other.
    Moving,
    /// The picture gets better.
    Refining,
    /// It cannot get better; no thread does anything.
    Finished,
}

/// How things stand: everything that panels show. As JSON for pages.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Status {
    /// Counts up with every change of it.
    pub number: u64,
    /// Edits that are taken account of.
    pub revision: u64,
    /// What the session is at.
    pub stage: Stage,
    /// The scene's name: that of its file, or of a built-in one.
    pub scene: String,
    /// What is wrong with the scene or the last edit, as `juggler check` says it (no colours); what is shown is of before.
    pub error: Option<String>,
    /// Width and height of the whole picture.
    pub size: [u32; 2],
    /// The part that is refined, when it is not all.
    pub region: Option<Rect>,
    /// What is shown.
    pub channel: Channel,
    /// Samples of a pixel so far, the mean.
    pub samples: f32,
    /// Samples of a pixel in the end.
    pub samples_wanted: u32,
    /// The estimated relative error of the picture, the root mean square; not known before 64 samples.
    pub noise: Option<f32>,
    /// Which share of the light clamping has taken away, from 0 to 1; nothing where nothing is clamped, or known of it.
    pub clamped: Option<f32>,
    /// Frames a second, over the last ones of a motion.
    pub frames_per_second: f32,
    /// Rays a second, lately.
    pub rays_per_second: f32,
    /// The pixels of a coarse frame are squares of so many of the picture; 1 when it is not coarse.
    pub coarseness: u32,
    /// Threads that render.
    pub threads: usize,
    /// Who renders which pixels of a frame.
    pub scheduler: String,
    /// Integrator by name.
    pub integrator: String,
    /// Its longest path, when it has one.
    pub max_depth: Option<u32>,
    /// Whether the picture is to be shown denoised.
    pub denoise: bool,
    /// Whether what is shown is denoised.
    pub denoised: bool,
    /// Sampler by name.
    pub sampler: String,
    /// Tone curve by name.
    pub tone: String,
    /// Photographic stops.
    pub exposure: f32,
    /// The scene's groups of lights by name, with the factors on their light; none where it names none.
    pub light_groups: Vec<(String, [f32; 3])>,
    /// Names of the scene's cameras, bookmarks included.
    pub cameras: Vec<String>,
    /// The camera as scene files describe it.
    pub camera: Value,
    /// The point of interest, scene units.
    pub interest: [f32; 3],
    /// The diagonal of a box around everything that has an end, scene units: what speeds are measured by.
    pub extent: f32,
    /// The frame that is shown.
    pub frame: f64,
    /// How many frames the scene's animation has; 0 when it has none.
    pub frames: u32,
    /// Frames of the animation that make a second.
    pub frame_rate: f64,
    /// Whether it plays.
    pub playing: bool,
    /// When finished: the hash of the film, which is that of `juggler render`, with `--denoise` where [`Self::denoise`] is on.
    pub hash: Option<String>,
}
