//! One picture, from the scene to the file: what the program, Rust and all other users share.

use crate::frames::FramesBeside;
use crate::{Error, LayerSet, Limit, Settings};
use juggler_camera::film::{Digest, Filter, Rect, Summary};
use juggler_camera::{AnyCamera, Perspective, Shot};
use juggler_film::counts::Spread;
use juggler_imaging::{Format, Header, Options, RowWriter, Tone};
use juggler_integrator::{AnyIntegrator, Clamp};
use juggler_math::{Image, Rgb, UVec2};
use juggler_render::{BAND_PIXELS, Control, Job, Rays, Schedule, Scheduler, Stopped};
use juggler_scene::description::Render;
use juggler_scene::{Compiled, Fingerprint, IntegratorChoice, IntegratorReason, Scene, SceneError};
use juggler_world::{SimdLevel, World};
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// The program as files name it.
pub(crate) const SOFTWARE: &str = concat!("Juggler ", env!("CARGO_PKG_VERSION"));

/// A scene compiled for one picture: every number is settled.
#[derive(Clone)]
pub struct Picture {
    pub(crate) compiled: Compiled,
    shot: Shot,
    region: Rect,
    tone: Tone,
    limit: Limit,
    fingerprint: Fingerprint,
    /// The scene's part of it.
    of_scene: Fingerprint,
    band_pixels: u64,
    layers: Arc<LayerSet>,
    beside: FramesBeside,
}

/// From where a world is looked at, and how: all that can change without building it anew.
#[derive(Clone, Debug, PartialEq)]
pub struct View {
    /// From where.
    pub camera: AnyCamera,
    /// Size, samples, integrator and the like; without an integrator the picture keeps its own.
    pub render: Render,
    /// From linear light to what files keep.
    pub tone: Tone,
}

/// What is to be known about a render besides its pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// Hash and mean of the linear pixels.
    pub film: Summary,
    /// Samples per pixel.
    pub samples: Spread,
    /// Rays traced.
    pub rays: Rays,
    /// Time spent on tracing rays.
    pub render: Duration,
    /// Time spent on taking the noise out.
    pub denoise: Duration,
    /// Time spent on encoding and writing.
    pub write: Duration,
}

impl Picture {
    /// Builds the world for a scene and what is wished for beyond it.
    pub fn new(scene: &Scene, settings: &Settings) -> Result<Self, Error> {
        let wished = settings.apply(scene)?;
        let compiled = wished.compile()?;
        Self::of(scene, &wished, settings, compiled)
    }

    /// The same, with what still serves of this picture's world, which was made of the scene `before`
    /// ([`Scene::compile_after`]).
    pub fn after(&self, before: &Scene, scene: &Scene, settings: &Settings) -> Result<Self, Error> {
        let (wished, before) = (settings.apply(scene)?, settings.apply(before)?);
        let compiled = wished.compile_after(&before, &self.compiled)?;
        Self::of(scene, &wished, settings, compiled)
    }

    /// `scene` is as it is wished for, and `compiled` what became of it; `plain` is what it was.
    fn of(plain: &Scene, scene: &Scene, settings: &Settings, mut compiled: Compiled) -> Result<Self, Error> {
        compiled.integrator.reason = reason(plain, settings);
        let [width, height] = scene.description.render.size;
        let region = settings.region([width, height])?;
        let camera = compiled.cameras.first().ok_or_else(|| Error::Settings("the scene has no camera".into()))?;
        let shot = compiled.shot(UVec2::new(width, height)).map_err(|e| Error::Settings(e.to_string()))?;
        let (tone, limit, mut of_scene) = ((*scene.description.tone).clone(), settings.limit, scene.fingerprint());
        of_scene.set_camera(&camera.1, &compiled.course);
        let fingerprint = of_scene.clone();
        let layers = Arc::new(LayerSet::new(&settings.aovs, settings.denoiser, &compiled.names));
        layers.check()?;
        let beside = FramesBeside::of(plain, settings, &compiled, &shot, &layers)?;
        let band_pixels = BAND_PIXELS;
        let mut picture =
            Self { shot, region, tone, limit, fingerprint, of_scene, compiled, band_pixels, layers, beside };
        picture.complete_fingerprint();
        Ok(picture)
    }

    /// How its world is looked at.
    pub fn view(&self) -> View {
        let camera = self.compiled.cameras.first().map(|(_, camera)| camera.clone());
        View {
            camera: camera.unwrap_or_else(|| Perspective::default().into()),
            render: Render { integrator: Some(self.integrator().clone()), ..self.compiled.settings.clone() },
            tone: self.tone.clone(),
        }
    }

    /// The same world looked at otherwise: all of it, until its samples are there. The camera's name stays. Layers that tell where
    /// things go are those of a camera that stands still.
    pub fn seen(&self, mut view: View) -> Result<Self, Error> {
        let integrator = view.render.integrator.get_or_insert_with(|| self.integrator().clone()).clone();
        let mut scene = Scene::new();
        let description = &mut scene.description;
        (description.render, description.tone) = (view.render.clone().into(), view.tone.clone().into());
        description.render.camera = None;
        description.camera = Some(view.camera.clone().into());
        let problems = scene.check();
        if problems.errors() > 0 {
            return Err(SceneError::Problems(problems).into());
        }
        let [width, height] = view.render.size;
        let mut picture = self.clone();
        if view.camera != self.view().camera {
            picture.compiled.course.clear();
        }
        picture.region = Rect { x: 0, y: 0, width, height };
        (picture.tone, picture.limit) = (view.tone, Limit::Samples);
        if let Some((_, camera)) = picture.compiled.cameras.first_mut() {
            *camera = view.camera.clone();
        }
        let shot = picture.compiled.shot(UVec2::new(width, height));
        picture.shot = shot.map_err(|error| Error::Settings(error.to_string()))?;
        picture.beside = self.beside.seen_from(&picture.shot);
        picture.of_scene = self.of_scene.seen_as(&scene.fingerprint());
        picture.of_scene.set_camera(&view.camera, &picture.compiled.course);
        picture.fingerprint = picture.of_scene.clone();
        picture.compiled.settings = view.render;
        if integrator != *self.integrator() {
            picture.compiled.integrator = IntegratorChoice { integrator, reason: IntegratorReason::Settings };
        }
        picture.complete_fingerprint();
        Ok(picture)
    }

    /// Whether all samples of both are the same, so that a film of one can go on as one of the other.
    pub fn shares_samples(&self, other: &Self) -> bool {
        let (a, b) = (self.job(), other.job());
        Arc::ptr_eq(self.world(), other.world())
            && self.region == other.region
            && (a.camera, a.pattern, a.seed) == (b.camera, b.pattern, b.seed)
            && a.filter == b.filter
            && self.integrator() == other.integrator()
            && (a.samples == 1) == (b.samples == 1)
            && a.layers == b.layers
    }

    /// The same picture for another vector unit than the best of this machine: for tests and measurements.
    pub fn with_simd_level(mut self, level: SimdLevel) -> Self {
        self.compiled.world = Arc::new(Arc::unwrap_or_clone(self.compiled.world).with_simd_level(level));
        self
    }

    /// Has fewer or more pixels in memory at once when rows go straight to their file, rounded to whole rows of tiles;
    /// without, some four million. No picture depends on it.
    #[must_use]
    pub fn with_bands(mut self, pixels: u64) -> Self {
        self.band_pixels = pixels;
        self
    }

    /// Width and height of what is rendered: of the crop when there is one.
    pub fn size(&self) -> [u32; 2] {
        [self.region.width, self.region.height]
    }

    /// Samples per pixel.
    pub fn samples(&self) -> u32 {
        self.compiled.settings.samples
    }

    /// Samples of all pixels.
    pub fn total_samples(&self) -> u64 {
        self.region.area().saturating_mul(u64::from(self.samples()))
    }

    /// What can be seen.
    pub fn world(&self) -> &Arc<World> {
        &self.compiled.world
    }

    /// The integrator that makes it; [`Compiled::integrator`] says why.
    pub fn integrator(&self) -> &AnyIntegrator {
        &self.compiled.integrator.integrator
    }

    /// World, cameras and settings.
    pub fn compiled(&self) -> &Compiled {
        &self.compiled
    }

    /// Everything that decides the pixels. Pictures with the same can be extended and joined.
    pub fn fingerprint(&self) -> &Fingerprint {
        &self.fingerprint
    }

    /// The scene's fingerprint says nothing of the program, nor of patterns that follow from the number of samples.
    fn complete_fingerprint(&mut self) {
        let Job { pattern, filter, samples, layers, .. } = self.job();
        let grid =
            if let Filter::Juggler(side) = filter { format!(", filter for {side} x {side}") } else { String::new() };
        let single = if samples == 1 { ", one through the centre" } else { "" };
        let halves = if layers.has_halves() { ", halves apart" } else { "" };
        self.fingerprint.insert("juggler", env!("CARGO_PKG_VERSION"));
        self.fingerprint.insert("pattern of samples", &format!("{pattern:?}{grid}{single}{halves}"));
    }

    /// What ends it.
    pub fn limit(&self) -> &Limit {
        &self.limit
    }

    /// The pixels that are rendered.
    pub fn region(&self) -> Rect {
        self.region
    }

    /// From linear light to what files keep.
    pub fn tone(&self) -> &Tone {
        &self.tone
    }

    /// The head of its file; the texts say which program made it, and the fingerprint, seed and
    /// samples, if their number ends the picture.
    pub fn header(&self, options: Options) -> Header {
        let [width, height] = self.size();
        let text = |key: &str, value: &str| (key.to_owned(), value.to_owned());
        let mut metadata = vec![
            text("Software", SOFTWARE),
            text("Fingerprint", &self.fingerprint.hash()),
            text("Seed", &self.compiled.settings.seed.to_string()),
        ];
        // How many samples noise or time will allow is known in the end.
        if self.limit == Limit::Samples {
            metadata.push(text("Samples", &self.samples().to_string()));
        }
        if let Some(Clamp { direct, indirect }) = self.integrator().clamp() {
            let limits =
                [("direct", direct), ("indirect", indirect)].into_iter().filter(|(_, limit)| limit.is_finite());
            let limits: Vec<String> = limits.map(|(light, limit)| format!("{light} light at {limit}")).collect();
            metadata.push(text("Clamping", &limits.join(", ")));
        }
        let viewpoint = self.viewpoint();
        Header { tone: self.tone.clone(), options, metadata, viewpoint, ..Header::new(width, height) }
    }

    /// What is asked for beside it.
    pub fn layers(&self) -> &LayerSet {
        &self.layers
    }

    /// A hash of what the scene is at the frames beside, where its layers tell of that and it changes; else empty.
    pub(crate) fn beside(&self) -> &str {
        &self.beside.fingerprint
    }

    /// How many worlds it holds but its own.
    pub(crate) fn worlds_beside(&self) -> usize {
        self.beside.frames.as_ref().map_or(0, |frames| frames.worlds_beside(self.world()))
    }

    /// The engine's view of it.
    pub fn job(&self) -> Job<'_> {
        let settings = &self.compiled.settings;
        let samples = self.limit.spread_over(settings.samples);
        let layers = self.layers.layers();
        let of_stream = if layers.has_halves() { samples.div_ceil(2) } else { samples };
        Job {
            world: &self.compiled.world,
            camera: &self.shot,
            integrator: &**self.integrator(),
            filter: settings.filter.filter(samples),
            pattern: settings.sampler.pattern(of_stream),
            samples,
            seed: settings.seed,
            layers,
            frames: self.beside.frames.as_ref(),
        }
    }

    /// Renders and hands whole finished rows to `rows`, from top to bottom; only a band of them is in memory
    /// at once.
    pub fn render<E: From<Stopped>>(
        &self,
        scheduler: Scheduler,
        control: &Control,
        mut rows: impl FnMut(&[Rgb]) -> Result<(), E>,
    ) -> Result<Summary, E> {
        let [width, height] = self.size();
        let mut digest = Digest::new(width, height);
        let schedule = Schedule { scheduler, band_pixels: self.band_pixels };
        juggler_render::render(&self.job(), self.region, schedule, control, |band| {
            digest.update(&band);
            rows(&band)
        })
        .map(|clamped| {
            digest.clamp(clamped);
            digest.finish()
        })
    }

    /// Renders into a file, or whatever else the writer writes to.
    pub fn write(&self, mut writer: Box<dyn RowWriter>, control: &Control) -> Result<Outcome, Error> {
        let start = Instant::now();
        let mut write = Duration::ZERO;
        let film = self.render(Scheduler::default(), control, |rows| {
            let start = Instant::now();
            writer.write_rows(rows)?;
            write += start.elapsed();
            Ok::<(), Error>(())
        })?;
        let render = start.elapsed().saturating_sub(write);
        let finish = Instant::now();
        writer.finish()?;
        let (denoise, write) = (Duration::ZERO, write + finish.elapsed());
        let samples = Spread::even(self.samples());
        Ok(Outcome { film, samples, rays: control.rays(), render, denoise, write })
    }

    /// Renders into memory.
    pub fn image(&self, control: &Control) -> Result<Image, Stopped> {
        let [width, height] = self.size();
        let mut image = Image::filled(width, height, Rgb::BLACK);
        let mut rest = image.pixels_mut();
        self.render(Scheduler::default(), control, |rows| {
            let (these, others) = std::mem::take(&mut rest).split_at_mut(rows.len());
            these.copy_from_slice(rows);
            rest = others;
            Ok::<(), Stopped>(())
        })?;
        Ok(image)
    }
}

/// Renders a scene into memory, on the threads of the current rayon pool.
///
/// ```
/// use juggler::prelude::*;
///
/// let scene = Scene::new().size(8, 8).add(Object::new(Sphere::default()));
/// let image = juggler::render(&scene, &Settings { samples: Some(1), ..Settings::default() })?;
/// assert!(image.pixels().iter().any(|pixel| pixel.luminance() > 0.5));
/// # Ok::<(), juggler::Error>(())
/// ```
pub fn render(scene: &Scene, settings: &Settings) -> Result<Image, Error> {
    Ok(Picture::new(scene, settings)?.image(&Control::default())?)
}

/// Renders a scene into a file of any size, row by row; the ending picks the format. An existing file is
/// replaced when the new one is complete.
pub fn render_to_file(scene: &Scene, settings: &Settings, path: impl AsRef<Path>) -> Result<Outcome, Error> {
    let path = path.as_ref();
    let format = Format::from_path(path)?;
    let picture = Picture::new(scene, settings)?;
    let writer = juggler_imaging::create(path, format, &picture.header(Options::default()))?;
    picture.write(writer, &Control::default())
}

/// Why a scene is rendered with its integrator, with these settings beside it.
fn reason(scene: &Scene, settings: &Settings) -> IntegratorReason {
    if settings.integrator.is_some() { IntegratorReason::Settings } else { scene.integrator_choice().reason }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seen_otherwise_it_is_the_picture_of_a_scene_that_says_so() {
        let object = juggler_scene::Object::new(juggler_shape::Sphere::default());
        let plain = Scene::new().size(16, 12).add(object);
        let camera = Perspective { vertical_fov_degrees: Some(30.0), ..Perspective::default() };
        let named = plain.clone().camera("left", Perspective::default()).camera("right", camera);
        for (scene, name) in [(plain, None), (named.clone(), None), (named, Some("right".to_owned()))] {
            let few = Settings { camera: name.clone(), ..Settings::default() };
            let many = Settings { samples: Some(7), camera: name, ..Settings::default() };
            let picture = Picture::new(&scene, &few).unwrap();
            let wanted = Picture::new(&scene, &many).unwrap();
            let seen = picture.seen(View { render: wanted.view().render, ..picture.view() }).unwrap();
            assert_eq!(seen.fingerprint(), wanted.fingerprint());
            let other = Perspective { vertical_fov_degrees: Some(50.0), ..Perspective::default() };
            let moved = picture.seen(View { camera: other.into(), ..picture.view() }).unwrap();
            assert_ne!(moved.fingerprint(), picture.fingerprint());
        }
    }
}
