//! Status of a session. `wire.rs` has its JSON.

use crate::edit::Channel;
use crate::model_status::ModelStatus;
use juggler::camera::AnyCamera;
use juggler::camera::film::Rect;
use juggler::camera::sampler::SamplerKind;
use juggler::imaging::ToneCurveKind;
use juggler::integrator::IntegratorKind;
use juggler::render::Scheduler;

/// Stage of a session.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Stage {
    /// A scene is being read or its world is being built; the previous image stays on display.
    #[default]
    Loading,
    /// Camera or time is moving: coarse frames follow each other.
    Moving,
    /// The image at rest is being refined.
    Refining,
    /// The image is complete; the session is idle.
    Finished,
}

/// Status of a session: all data that panels display. Before the first scene is built, it has no
/// integrator, sampler, tone curve and camera.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Status {
    /// Sequence number, which increases with every change.
    pub number: u64,
    /// Number of edits that have been applied.
    pub revision: u64,
    /// Current stage.
    pub stage: Stage,
    /// Name of the scene: its file, or a built-in scene.
    pub scene: String,
    /// Errors of the scene or the last edit, as `juggler check` prints them, without colors. The
    /// last valid image stays on display.
    pub error: Option<String>,
    /// Width and height of the whole image, in pixels.
    pub size: [u32; 2],
    /// Region that is refined; `None` for the whole image.
    pub region: Option<Rect>,
    /// Displayed channel.
    pub channel: Channel,
    /// Mean number of samples per pixel so far.
    pub samples: f32,
    /// Number of samples per pixel of the finished image.
    pub samples_wanted: u32,
    /// Estimated relative error of the image, the root mean square over its pixels; `None` before
    /// 64 samples.
    pub noise: Option<f32>,
    /// Fraction of the radiance that clamping removed, 0 to 1; `None` without clamping, or before
    /// it is known.
    pub clamped: Option<f32>,
    /// Moving average of the frames per second during a motion.
    pub frames_per_second: f32,
    /// Rays per second of the current render.
    pub rays_per_second: f32,
    /// Edge length of a coarse frame's pixel blocks, in pixels; 1 at full resolution.
    pub coarseness: u32,
    /// Number of render threads.
    pub threads: usize,
    /// Distribution of a frame's pixels to threads.
    pub scheduler: Scheduler,
    /// Integrator.
    pub integrator: Option<IntegratorKind>,
    /// Maximum path depth: specular bounces under `classic`, path segments under `path`; `None`
    /// for integrators without one.
    pub max_depth: Option<u32>,
    /// Smallest and largest maximum path depth of the integrator; zeros if it has none.
    pub depth_range: [u32; 2],
    /// Whether denoising is switched on.
    pub denoise: bool,
    /// Whether the displayed frame is denoised.
    pub denoised: bool,
    /// Sampler.
    pub sampler: Option<SamplerKind>,
    /// Tone curve.
    pub tone: Option<ToneCurveKind>,
    /// Exposure in photographic stops.
    pub exposure: f32,
    /// Light groups of the scene by name, with their RGB gains; empty if the scene has none.
    pub light_groups: Vec<(String, [f32; 3])>,
    /// Models of the scene that have variants or clips.
    pub models: Vec<ModelStatus>,
    /// Names of the scene's cameras, including bookmarks.
    pub cameras: Vec<String>,
    /// Current camera.
    pub camera: Option<AnyCamera>,
    /// Point of interest, in world space.
    pub interest: [f32; 3],
    /// Length of the diagonal of the box around all bounded objects, in scene units.
    pub extent: f32,
    /// Speed of the keys that move the camera, in scene units per second; see
    /// [`Subject::flight_speed`](crate::Subject::flight_speed).
    pub flight_speed: f32,
    /// Displayed frame of the animation.
    pub frame: f64,
    /// Number of frames of the animation; 0 without one.
    pub frames: u32,
    /// Frames per second of the animation.
    pub frame_rate: f64,
    /// Whether the animation is playing.
    pub playing: bool,
    /// BLAKE3 hash of the finished film: equal to that of `juggler render`, with `--denoise` if
    /// [`Self::denoise`] is on.
    pub hash: Option<String>,
}

#[cfg(test)]
mod tests {
    use super::Status;
    use crate::{BuildRequest, Edit, Setting, Subject};
    use juggler::integrator::IntegratorKind;
    use juggler::scene::Scene;

    fn depth(subject: &Subject) -> (Option<u32>, [u32; 2]) {
        let mut status = Status::default();
        subject.write_status(&mut status);
        (status.max_depth, status.depth_range)
    }

    #[test]
    fn the_maximum_depth_is_that_of_the_integrator() {
        let text =
            r#"{"version": 1, "render": {"size": [8, 6], "integrator": {"path": {"max_depth": 7}}}, "objects": []}"#;
        let scene = Scene::from_json(text, "scene.json").unwrap();
        let mut subject = BuildRequest::from_scene(scene, "scene.json", None).run().unwrap();
        assert_eq!(depth(&subject), (Some(7), [1, 10_000]));
        let mut set = |setting| {
            let done = subject.apply(&Edit::Setting(setting)).map(drop);
            (done.is_ok(), depth(&subject))
        };
        assert_eq!(set(Setting::MaxDepth(3)), (true, (Some(3), [1, 10_000])));
        assert_eq!(set(Setting::MaxDepth(0)), (false, (Some(3), [1, 10_000])));
        // Another integrator has a depth of its own.
        use IntegratorKind::{Classic, Normals, Path};
        for (kind, expected) in [(Classic, Some(10)), (Normals, None), (Path, Some(7))] {
            let (done, (depth, range)) = set(Setting::Integrator(kind));
            assert!(
                done && depth == expected && (range == [0, 0]) == expected.is_none(),
                "{kind:?}: {depth:?} {range:?}"
            );
        }
    }
}
