//! Settings that override values of a scene.

mod max_depth;

use crate::{Aov, Denoiser, Error};
use juggler_camera::film::{BLOCK_SAMPLES, Rect};
use juggler_camera::sampler::SamplerKind;
use juggler_imaging::{Primaries, Tone, ToneCurveKind, WhiteBalance};
use juggler_integrator::IntegratorKind;
use juggler_render::StopCriterion;
use juggler_scene::compile::{MAX_EDGE, MAX_PIXELS, MAX_SAMPLES, MAX_SHUTTER};
use juggler_scene::description::{CameraName, Render};
use juggler_scene::model::find_camera;
use juggler_scene::suggest::{closest, did_you_mean, list_of_known};
use juggler_scene::{IntegratorChoice, Scene};
use max_depth::limit_depth;

/// Default maximum number of samples per pixel under a noise limit.
const MAX_SAMPLES_NOISE: u32 = 1 << 16;
/// Default maximum number of samples per pixel under a time limit.
const MAX_SAMPLES_TIME: u32 = 1 << 24;

/// Maximum exposure in photographic stops, up or down.
const MAX_STOPS: f32 = 64.0;

/// Stop condition of a render.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Limit {
    /// Stops when all pixels have their samples.
    #[default]
    Samples,
    /// Stops when the relative error of each tile of 16 x 16 pixels is at most this value: the root
    /// mean square over its pixels, estimated from the samples (see [`StopCriterion::Noise`]).
    Noise(f32),
    /// Stops when the caller invokes [`Control::finish`](juggler_render::Control::finish), normally
    /// after some time.
    Time {
        /// Intended duration, in seconds.
        seconds: f64,
    },
}

impl Limit {
    /// Returns the stop condition of a tile.
    pub fn stop(&self) -> StopCriterion {
        match self {
            Self::Noise(level) => StopCriterion::Noise(*level),
            Self::Samples => StopCriterion::Samples,
            Self::Time { .. } => StopCriterion::Evenly,
        }
    }

    /// Fails for a relative error that is not a finite number above 0, and for a duration that is
    /// negative or not finite.
    fn check(&self) -> Result<(), Error> {
        match *self {
            Self::Noise(level) if !(level > 0.0 && level.is_finite()) => {
                Err(Error::setting("noise", format!("the noise limit must be a finite number above 0, not {level}")))
            }
            Self::Time { seconds } if !(seconds >= 0.0 && seconds.is_finite()) => {
                let message = format!("the time limit must be a finite number of seconds, not {seconds}");
                Err(Error::setting("time", message))
            }
            _ => Ok(()),
        }
    }

    /// Returns the default maximum number of samples per pixel.
    fn max_samples(&self, of_scene: u32) -> u32 {
        match self {
            Self::Samples => of_scene,
            Self::Noise(_) => MAX_SAMPLES_NOISE,
            Self::Time { .. } => MAX_SAMPLES_TIME,
        }
    }

    /// Returns the number of samples for which samplers choose their pattern. With an open end,
    /// each block of samples is well distributed.
    pub(crate) fn pattern_samples(&self, samples: u32) -> u32 {
        if *self == Self::Samples { samples } else { BLOCK_SAMPLES }
    }
}

/// Settings that override those of the scene; `None` keeps the scene's value.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Settings {
    /// Width and height in pixels.
    pub size: Option<[u32; 2]>,
    /// Samples per pixel; their maximum under a noise or time limit.
    pub samples: Option<u32>,
    /// Stop condition.
    pub limit: Limit,
    /// Integrator, with default parameters; the scene's parameters are kept if it is the scene's
    /// own integrator.
    pub integrator: Option<IntegratorKind>,
    /// Sampler; the scene's parameters are kept likewise.
    pub sampler: Option<SamplerKind>,
    /// Maximum number of specular bounces under the integrator `classic`, 0 to 1000, and of path
    /// segments under `path`, 1 to 10,000.
    pub max_depth: Option<u32>,
    /// Name of one of the scene's cameras.
    pub camera: Option<String>,
    /// Times at which the shutter opens and closes, in frames relative to the current frame.
    pub shutter: Option<[f64; 2]>,
    /// Seed of the sampler; another seed gives another noise pattern.
    pub seed: Option<u64>,
    /// Region to render, in pixels; `None` renders the whole image.
    pub crop: Option<Rect>,
    /// Whether the background is transparent.
    pub transparent: Option<bool>,
    /// Tone curve, with default parameters, for files that do not store linear radiance.
    pub curve: Option<ToneCurveKind>,
    /// Exposure in photographic stops, for such files; each stop doubles the brightness.
    pub exposure_stops: Option<f32>,
    /// Arbitrary output variables to render.
    pub aovs: Vec<Aov>,
    /// Denoiser; `None` keeps the noise.
    pub denoiser: Option<Denoiser>,
    /// Color of the light that appears white, for such files.
    pub white_balance: Option<WhiteBalance>,
    /// Color primaries of the file.
    pub primaries: Option<Primaries>,
    /// Whether 8-bit levels are dithered.
    pub dither: Option<bool>,
}

impl Settings {
    /// Returns the scene with these settings applied. Fails for an unknown camera and values out of
    /// range.
    pub fn apply(&self, scene: &Scene) -> Result<Scene, Error> {
        let camera = self.camera_of(scene)?;
        let mut scene = scene.clone();
        let description = &mut scene.description;
        if camera.is_some() {
            description.render.camera = camera;
        }
        if self.max_depth.is_some() && self.integrator.is_none() {
            description.render.integrator = Some(IntegratorChoice::for_scene(description).integrator);
        }
        self.apply_to(&mut description.render, &mut description.tone)?;
        Ok(scene)
    }

    /// Whole name of the camera that the settings select.
    fn camera_of(&self, scene: &Scene) -> Result<Option<CameraName>, Error> {
        let Some(name) = &self.camera else { return Ok(None) };
        // Models are expanded only if the scene itself has no such camera.
        if scene.description.cameras.contains_key(name) {
            return Ok(Some(CameraName(name.clone())));
        }
        let names = scene.camera_names();
        match find_camera(names.iter().map(String::as_str), name) {
            Some(found) => Ok(Some(CameraName(found.to_owned()))),
            None => Err(unknown_camera(name, &names)),
        }
    }

    /// Applies the settings other than the camera to render settings and tone. `max_depth` needs
    /// `render.integrator`.
    pub fn apply_to(&self, render: &mut Render, tone: &mut Tone) -> Result<(), Error> {
        self.limit.check()?;
        render.size = self.size.unwrap_or(render.size);
        render.samples = self.samples.unwrap_or(self.limit.max_samples(render.samples));
        render.shutter = self.shutter.unwrap_or(render.shutter);
        render.seed = self.seed.unwrap_or(render.seed);
        render.transparent = self.transparent.unwrap_or(render.transparent);
        let own = render.integrator.as_ref().map(IntegratorKind::from);
        if let Some(kind) = self.integrator.filter(|kind| Some(*kind) != own) {
            render.integrator = Some(kind.into());
        }
        if let Some(kind) = self.sampler.filter(|kind| *kind != SamplerKind::from(&render.sampler)) {
            render.sampler = kind.into();
        }
        if let (Some(depth), Some(integrator)) = (self.max_depth, &mut render.integrator) {
            limit_depth(integrator, depth)?;
        }
        if let Some(kind) = self.curve {
            tone.curve = kind.into();
        }
        tone.exposure_stops = self.exposure_stops.unwrap_or(tone.exposure_stops);
        tone.white_balance = self.white_balance.or(tone.white_balance);
        tone.primaries = self.primaries.unwrap_or(tone.primaries);
        tone.dither = self.dither.unwrap_or(tone.dither);
        Ok(())
    }

    /// Fails for numbers out of the ranges of the scene format, with the name of the setting. Without
    /// this, the check of the scene fails, with the place in the scene.
    pub fn check_ranges(&self) -> Result<(), Error> {
        if let Some([width, height]) = self.size {
            let edges = 1..=MAX_EDGE;
            if !edges.contains(&width) || !edges.contains(&height) {
                let message = format!("width and height are 1 to {MAX_EDGE} pixels, not {width} and {height}");
                return Err(Error::setting("size", message));
            }
            let pixels = u64::from(width) * u64::from(height);
            if pixels > MAX_PIXELS {
                return Err(Error::setting("size", format!("an image has at most {MAX_PIXELS} pixels, not {pixels}")));
            }
        }
        if let Some(samples) = self.samples.filter(|samples| !(1..=MAX_SAMPLES).contains(samples)) {
            return Err(Error::setting("samples", format!("a pixel has 1 to {MAX_SAMPLES} samples, not {samples}")));
        }
        if let Some([open, close]) = self.shutter
            && !(open <= close && open.abs() <= MAX_SHUTTER && close.abs() <= MAX_SHUTTER)
        {
            let message = format!(
                "the shutter must open before it closes, both within {MAX_SHUTTER} frames; found {open} to {close}"
            );
            return Err(Error::setting("shutter", message));
        }
        match self.exposure_stops {
            Some(stops) if !(-MAX_STOPS..=MAX_STOPS).contains(&stops) => {
                let message = format!("the exposure is -{MAX_STOPS} to {MAX_STOPS} stops, not {stops}");
                Err(Error::setting("exposure", message))
            }
            _ => Ok(()),
        }
    }

    /// Returns width and height, in pixels.
    pub fn size_of(&self, scene: &Scene) -> [u32; 2] {
        self.size.unwrap_or(scene.description.render.size)
    }

    /// Returns the number of samples per pixel, or their maximum.
    pub fn samples_of(&self, scene: &Scene) -> u32 {
        self.samples.unwrap_or(self.limit.max_samples(scene.description.render.samples))
    }

    /// Returns whether the background is transparent.
    pub fn transparent_of(&self, scene: &Scene) -> bool {
        self.transparent.unwrap_or(scene.description.render.transparent)
    }

    /// Returns the rendered region of an image of this size. Fails if the crop reaches beyond it.
    pub fn region(&self, [width, height]: [u32; 2]) -> Result<Rect, Error> {
        let Some(crop) = self.crop else { return Ok(Rect { x: 0, y: 0, width, height }) };
        let inside =
            |start: u32, length: u32, edge: u32| length > 0 && start.checked_add(length).is_some_and(|end| end <= edge);
        if inside(crop.x, crop.width, width) && inside(crop.y, crop.height, height) {
            return Ok(crop);
        }
        let Rect { x, y, width: w, height: h } = crop;
        if w == 0 || h == 0 {
            return Err(Error::setting("crop", format!("a crop of {w}x{h} pixels has none")));
        }
        let message = format!("the crop {x},{y},{w},{h} reaches beyond the picture of {width}x{height} pixels");
        Err(Error::setting("crop", message))
    }
}

/// Error for a camera that the scene does not have; it suggests a name and lists all.
fn unknown_camera(name: &str, names: &[String]) -> Error {
    let known = || names.iter().map(String::as_str);
    let near = closest(name, known()).map(did_you_mean);
    let help = match (near, list_of_known(known())) {
        (Some(near), Some(list)) if names.len() > 1 => format!("{near} {list}"),
        (Some(help), _) | (None, Some(help)) => help,
        (None, None) => "the scene has one camera, without a name".into(),
    };
    Error::Settings { setting: "camera".into(), message: format!("there is no camera `{name}`"), help: Some(help) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_integrator::{Classic, Normals};

    fn scene() -> Scene {
        let mut scene = Scene::new().size(20, 10);
        scene.description.render.integrator = Some(Classic { min_weight: 0.5, ..Classic::default() }.into());
        scene
    }

    #[test]
    fn settings_that_are_not_given_stay() {
        assert_eq!(Settings::default().apply(&scene()).unwrap().description, scene().description);
        let own = Settings { integrator: Some(IntegratorKind::Classic), max_depth: Some(3), ..Settings::default() };
        let expected = Classic { min_weight: 0.5, max_depth: 3, ..Classic::default() };
        assert_eq!(own.apply(&scene()).unwrap().description.render.integrator, Some(expected.into()));
    }

    #[test]
    fn numbers_out_of_range_are_named() {
        let with = |change: fn(&mut Settings)| {
            let mut settings = Settings::default();
            change(&mut settings);
            match settings.check_ranges() {
                Err(Error::Settings { setting, .. }) => setting,
                other => panic!("{other:?}"),
            }
        };
        assert_eq!(with(|settings| settings.size = Some([0, 4])), "size");
        assert_eq!(with(|settings| settings.size = Some([4, 65_537])), "size");
        assert_eq!(with(|settings| settings.size = Some([65_536, 65_536])), "size");
        assert_eq!(with(|settings| settings.samples = Some(0)), "samples");
        assert_eq!(with(|settings| settings.samples = Some(MAX_SAMPLES + 1)), "samples");
        assert_eq!(with(|settings| settings.shutter = Some([0.5, 0.0])), "shutter");
        assert_eq!(with(|settings| settings.shutter = Some([0.0, f64::NAN])), "shutter");
        assert_eq!(with(|settings| settings.shutter = Some([0.0, 1001.0])), "shutter");
        assert_eq!(with(|settings| settings.exposure_stops = Some(64.5)), "exposure");
        assert_eq!(with(|settings| settings.exposure_stops = Some(f32::NAN)), "exposure");
        let most = Settings { size: Some([65_536, 32_768]), samples: Some(MAX_SAMPLES), ..Settings::default() };
        assert!(most.check_ranges().is_ok());
    }

    #[test]
    fn another_integrator_comes_with_its_defaults() {
        let other = Settings { integrator: Some(IntegratorKind::Normals), ..Settings::default() };
        let scene = other.apply(&scene()).unwrap();
        assert_eq!(scene.description.render.integrator, Some(Normals::default().into()));
        let deep = Settings { max_depth: Some(3), ..other };
        assert!(deep.apply(&scene).unwrap_err().to_string().contains("normals"));
    }

    #[test]
    fn max_depth_is_set_in_the_integrator() {
        use IntegratorKind::{Classic, Path};
        let apply = |integrator, depth| {
            let settings = Settings { integrator: Some(integrator), max_depth: Some(depth), ..Settings::default() };
            settings.apply(&scene()).map(|scene| scene.description.render.integrator.clone())
        };
        let four = juggler_integrator::Path { max_depth: 4, ..juggler_integrator::Path::default() };
        assert_eq!(apply(Path, 4).unwrap(), Some(four.into()));
        assert!(apply(Classic, 0).is_ok() && apply(Path, 10_000).is_ok());
        for (integrator, depth) in [(Path, 0), (Path, 10_001), (Classic, 1001)] {
            assert!(apply(integrator, depth).unwrap_err().to_string().contains(" to 10"), "{integrator:?} {depth}");
        }
    }

    #[test]
    fn only_the_given_tone_settings_change() {
        let mut scene = scene();
        scene.description.tone.exposure_stops = 1.5;
        scene.description.tone.white_balance = Some(WhiteBalance::default());
        let settings = Settings { primaries: Some(Primaries::Rec2020), dither: Some(false), ..Settings::default() };
        let tone = settings.apply(&scene).unwrap().description.tone;
        let expected = Tone { primaries: Primaries::Rec2020, dither: false, ..(*scene.description.tone).clone() };
        assert_eq!(tone, expected);
    }

    #[test]
    fn crops_lie_inside() {
        let region = |x, y, width, height| {
            let crop = Some(Rect { x, y, width, height });
            Settings { crop, ..Settings::default() }.region([20, 10])
        };
        assert_eq!(region(5, 5, 15, 5).unwrap(), Rect { x: 5, y: 5, width: 15, height: 5 });
        for (x, y, width, height) in [(5, 5, 16, 5), (5, 5, 15, 6), (20, 0, 1, 1), (0, 0, 0, 1), (u32::MAX, 0, 2, 1)] {
            assert!(region(x, y, width, height).is_err());
        }
        assert_eq!(Settings::default().region([20, 10]).unwrap(), Rect { x: 0, y: 0, width: 20, height: 10 });
    }

    #[test]
    fn unknown_camera_names_are_errors() {
        let scene = scene().camera("left", juggler_camera::Perspective::default());
        let settings = Settings { camera: Some("lift".into()), ..Settings::default() };
        let error = settings.apply(&scene).unwrap_err();
        assert_eq!(error.to_string(), "there is no camera `lift`; did you mean `left`?");
        let Error::Settings { setting, message, help } = error else { panic!("{error}") };
        assert_eq!((setting.as_str(), message.as_str()), ("camera", "there is no camera `lift`"));
        assert_eq!(help.as_deref(), Some("did you mean `left`?"));
        let help = |scene: &Scene, name: &str| {
            let settings = Settings { camera: Some(name.into()), ..Settings::default() };
            settings.apply(scene).unwrap_err().to_string()
        };
        let scene = scene.camera("top", juggler_camera::Perspective::default());
        assert_eq!(help(&scene, "lift"), "there is no camera `lift`; did you mean `left`? known: `left`, `top`");
        assert_eq!(help(&scene, "foo"), "there is no camera `foo`; known: `left`, `top`");
        let bare = Scene::from_json(r#"{"version": 1, "objects": []}"#, "a.json").unwrap();
        assert_eq!(help(&bare, "foo"), "there is no camera `foo`; the scene has one camera, without a name");
    }
}
