//! What people change. In JSON each is an object with one member: `{"fly": {"forward": 0.5, "yaw_degrees": 3}}`.

use juggler::camera::film::Rect;
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// A wish. Wishes that come faster than pictures are all kept; the next picture shows their sum.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Edit {
    /// Another scene: a file, or the name of a built-in one. Its first camera is taken.
    Scene(String),
    /// The files again. A scene with mistakes leaves the last good picture, with [`Status::error`](crate::Status).
    Reload,
    /// Steps along, and turns about, the camera's own axes.
    Fly(Fly),
    /// Round the point of interest, which stays where it is in the picture.
    Orbit(Orbit),
    /// Narrows the field of view by this factor (of the tangent of its half), 0.1 to 10; below 1 widens it.
    Zoom(f32),
    /// What is seen at this pixel becomes the point of interest, round which one orbits; a lens is focused on it.
    Focus([f32; 2]),
    /// What is seen at this pixel becomes the point that orbits turn about, unless the camera has a `look_at` in view or a
    /// point was chosen. Windows ask for it where a drag begins.
    Pivot([f32; 2]),
    /// Moves the camera, its direction kept, so that what is seen at this pixel fills the picture; everything, when there is
    /// none, or nothing is seen there.
    Frame(Option<[f32; 2]>),
    /// One of the scene's cameras, as the scene has it.
    Camera(String),
    /// Any camera, as scene files describe it: `{"perspective": {"eye": ...}}`.
    Look(Value),
    /// Keeps the camera under a name: in the scene's file, whose other text stays as it is, or for a built-in scene in
    /// memory, where [`Session::bookmarks`](crate::Session::bookmarks) finds it.
    Bookmark(String),
    /// A value of the scene, by its place (a JSON pointer): `/materials/red/phong/diffuse`. `null` takes it away.
    Set {
        /// Where.
        path: String,
        /// What.
        value: Value,
    },
    /// How the picture is made.
    Setting(Setting),
    /// A moment of the animation, as a frame that may lie between two.
    At(f64),
    /// Plays the animation from where it is, in a loop; or stops.
    Play(bool),
    /// What of the picture is shown.
    Show(Channel),
    /// Only this part of the picture is refined, in pixels; `null`: all of it.
    Region(Option<Rect>),
    /// Undoes all but [`Edit::Scene`]: the scene as its file has it.
    Reset,
}

impl Edit {
    /// Whether nothing that comes before it matters any more.
    pub fn supersedes(&self) -> bool {
        matches!(self, Self::Scene(_))
    }

    /// Whether it leaves no trace of the edit just before it.
    pub fn replaces(&self, before: &Self) -> bool {
        match (self, before) {
            (Self::At(_), Self::At(_)) | (Self::Reload, Self::Reload) | (Self::Scene(_), _) => true,
            (Self::Set { path: a, .. }, Self::Set { path: b, .. }) => a == b,
            _ => false,
        }
    }
}

/// Steps and turns, by the camera's own axes; none by default.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Fly {
    /// To the right, scene units.
    pub right: f32,
    /// Up, scene units.
    pub up: f32,
    /// Forward, scene units.
    pub forward: f32,
    /// To the right.
    pub yaw_degrees: f32,
    /// Up.
    pub pitch_degrees: f32,
    /// The top to the right.
    pub roll_degrees: f32,
}

/// Turns round the point of interest.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Orbit {
    /// The camera goes to the left, so that the scene turns to the right.
    pub yaw_degrees: f32,
    /// The camera rises; not beyond the poles of the scene's upward axis.
    pub pitch_degrees: f32,
    /// The distance is divided by this.
    pub closer: f32,
}

impl Default for Orbit {
    fn default() -> Self {
        Self { yaw_degrees: 0.0, pitch_degrees: 0.0, closer: 1.0 }
    }
}

/// How the picture is made; names are those of the scene format.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Setting {
    /// Width and height in pixels.
    Size([u32; 2]),
    /// Samples of a pixel after which the picture is finished.
    Samples(u32),
    /// Integrator by name, with its defaults.
    Integrator(String),
    /// Sampler by name, with its defaults.
    Sampler(String),
    /// How often a path may be mirrored or refracted.
    MaxDepth(u32),
    /// Tone curve by name.
    Tone(String),
    /// Photographic stops.
    Exposure(f32),
    /// Factors on red, green and blue of the light of one group of lights, by name.
    Gain(String, [f32; 3]),
    /// Whether the picture is shown denoised when nothing moves; at most 2^21 pixels. The film begins anew, for it keeps what
    /// guides the filter, as `juggler render --denoise` does.
    Denoise(bool),
    /// Another seed, another noise.
    Seed(u64),
    /// Threads that render.
    Threads(usize),
    /// Who renders which pixels of a frame: `work-stealing`, `row-queue`, `static-rows`.
    Scheduler(String),
}

/// What of the picture is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Channel {
    /// The picture.
    #[default]
    Color,
    /// Colours without light.
    Albedo,
    /// Shading normals.
    Normals,
    /// Distances, white where the farthest is.
    Depth,
    /// Each object in a colour of its own.
    Objects,
    /// Each material in a colour of its own.
    Materials,
    /// How many samples each tile has.
    Samples,
    /// The estimated relative error of each pixel: black 0, white 10 % and more.
    Noise,
}

impl Channel {
    /// Whether it is of light, and thus of the film.
    pub fn is_light(self) -> bool {
        matches!(self, Self::Color | Self::Samples | Self::Noise)
    }

    /// All of them.
    pub const ALL: [Self; 8] = [
        Self::Color,
        Self::Albedo,
        Self::Normals,
        Self::Depth,
        Self::Objects,
        Self::Materials,
        Self::Samples,
        Self::Noise,
    ];
}
