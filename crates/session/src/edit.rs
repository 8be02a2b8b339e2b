//! Edits of an interactive session. `wire.rs` has their JSON.

use juggler::camera::AnyCamera;
use juggler::camera::film::Rect;
use juggler::camera::sampler::SamplerKind;
use juggler::imaging::ToneCurveKind;
use juggler::integrator::IntegratorKind;
use juggler::render::Scheduler;
use juggler::scene::Bundle;
use serde_json::Value;

/// Change requested by a client. Edits that arrive faster than frames are rendered are all applied;
/// the next frame shows their combined effect.
#[derive(Clone, Debug, PartialEq)]
pub enum Edit {
    /// Opens another scene, a file or a built-in scene by name, and uses its initial camera.
    Scene(String),
    /// Opens a scene of files in memory, such as files that were dropped on a page. No JSON stands
    /// for this edit.
    Files(SceneFiles),
    /// Reads the scene's files again. If they have errors, the last valid image stays and
    /// [`Status::error`](crate::Status) reports them.
    Reload,
    /// Rotates the camera about its own axes, then translates it along them.
    Fly(Fly),
    /// Rotates the camera about the point of interest, which keeps its position in the image.
    Orbit(Orbit),
    /// Divides the tangent of half the field of view by this factor, clamped to 0.1 to 10. Values
    /// above 1 narrow the view, values below 1 widen it.
    Zoom(f32),
    /// Makes the visible point at this pixel the point of interest, and focuses a thin lens on it.
    Focus([f32; 2]),
    /// Makes the visible point at this pixel the center of orbits, unless the camera has a
    /// `look_at` in view or a point was chosen. Windows send it when a drag begins.
    Pivot([f32; 2]),
    /// Moves the camera along its view direction until the object at this pixel fills the image.
    /// `null`, or a pixel without an object, frames the whole scene.
    Frame(Option<[f32; 2]>),
    /// Switches to one of the scene's cameras or bookmarks, by name.
    Camera(String),
    /// Switches to this camera.
    Look(AnyCamera),
    /// Bookmarks the camera under a name: in the scene's file, whose other text is preserved, or in
    /// memory for a built-in scene; see [`Session::bookmarks`](crate::Session::bookmarks).
    Bookmark(String),
    /// Sets a value of the scene format by its JSON pointer, such as
    /// `/materials/red/phong/diffuse`. `null` removes it.
    Set {
        /// JSON pointer into the scene.
        path: String,
        /// New value, or `null` to remove the old one.
        value: Value,
    },
    /// Changes a render setting.
    Setting(Setting),
    /// Moves to a frame of the animation, clamped to its length. Fractions lie between two frames.
    At(f64),
    /// `true` plays the animation in a loop from the current frame, `false` stops it.
    Play(bool),
    /// Selects the displayed channel.
    Show(Channel),
    /// Restricts refinement to this rectangle, in pixels; `null` refines the whole image.
    Region(Option<Rect>),
    /// Restores the scene as its file describes it, with its camera and settings. Denoising and
    /// bookmarks are kept.
    Reset,
}

impl Edit {
    /// Returns whether all earlier edits become irrelevant.
    pub fn supersedes(&self) -> bool {
        matches!(self, Self::Scene(_) | Self::Files(_))
    }

    /// Returns whether this edit overwrites the effect of the edit directly `before` it.
    pub fn replaces(&self, before: &Self) -> bool {
        match (self, before) {
            (Self::At(_), Self::At(_)) | (Self::Reload, Self::Reload) | (Self::Scene(_) | Self::Files(_), _) => true,
            // Each removal removes another element of an array.
            (Self::Set { path: a, value: new }, Self::Set { path: b, value: old }) => {
                a == b && !new.is_null() && !old.is_null()
            }
            _ => false,
        }
    }
}

/// Scene of files in memory.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneFiles {
    /// Name of the scene, model or mesh among the files.
    pub name: String,
    /// All files. The scene cannot read others.
    pub files: Bundle,
}

/// Translation and rotation along the camera's own axes; all 0 by default.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Fly {
    /// Translation to the right, in scene units.
    pub right: f32,
    /// Translation upwards, in scene units.
    pub up: f32,
    /// Translation forwards, in scene units.
    pub forward: f32,
    /// Rotation of the view direction to the right, in degrees.
    pub yaw_degrees: f32,
    /// Rotation of the view direction upwards, in degrees.
    pub pitch_degrees: f32,
    /// Rotation of the camera's up vector to its right, in degrees.
    pub roll_degrees: f32,
}

/// Rotation about the point of interest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orbit {
    /// Rotation of the camera to the left about the scene's up axis, in degrees: the scene turns to
    /// the right.
    pub yaw_degrees: f32,
    /// Increase of the camera's elevation, in degrees. The elevation is at most 89.9 degrees.
    pub pitch_degrees: f32,
    /// Divisor of the distance to the point of interest, clamped to 0.001 to 1000. 1 by default,
    /// which is also used for values that are not positive.
    pub closer: f32,
}

impl Default for Orbit {
    fn default() -> Self {
        Self { yaw_degrees: 0.0, pitch_degrees: 0.0, closer: 1.0 }
    }
}

/// Render setting.
#[derive(Clone, Debug, PartialEq)]
pub enum Setting {
    /// Width and height of the image, in pixels, at most 2^25 pixels in total.
    Size([u32; 2]),
    /// Number of samples per pixel after which the image is finished.
    Samples(u32),
    /// Integrator, with the scene's parameters if it is the scene's own, otherwise with its default
    /// parameters.
    Integrator(IntegratorKind),
    /// Sampler, with parameters as for the integrator.
    Sampler(SamplerKind),
    /// Maximum path depth: specular bounces under `classic`, 0 to 1000; path segments under `path`,
    /// 1 to 10,000.
    MaxDepth(u32),
    /// Tone curve, with its default parameters.
    Tone(ToneCurveKind),
    /// Exposure in photographic stops; each stop doubles the brightness.
    Exposure(f32),
    /// RGB gain of a light group, by name; each factor is 0 to 1,000,000.
    Gain(String, [f32; 3]),
    /// Whether the image is displayed denoised while the camera is at rest. It may have at most
    /// 2^21 pixels. A change restarts the film, which has to store the denoiser's features, as with
    /// `juggler render --denoise`.
    Denoise(bool),
    /// Seed of the sampler; another seed gives another noise pattern.
    Seed(u64),
    /// Number of render threads, at most 1024; 0 uses all cores.
    Threads(usize),
    /// Distribution of a frame's pixels to threads.
    Scheduler(Scheduler),
}

/// Displayed channel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Channel {
    /// Rendered radiance.
    #[default]
    Color,
    /// Surface albedo, without lighting.
    Albedo,
    /// Shading normals.
    Normals,
    /// Distance along the camera ray; the farthest visible point is white.
    Depth,
    /// One color per object.
    Objects,
    /// One color per material.
    Materials,
    /// Number of samples of each tile, relative to the number wanted.
    Samples,
    /// Estimated relative error of each pixel: black is 0, white is 10 % or more.
    Noise,
}

impl Channel {
    /// Returns whether the channel is computed from the film.
    pub fn is_light(self) -> bool {
        matches!(self, Self::Color | Self::Samples | Self::Noise)
    }

    /// All channels, in the order in which user interfaces list them.
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
