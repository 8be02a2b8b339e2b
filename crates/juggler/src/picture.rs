//! Rendering of one image, from the scene to the file.

use crate::neighbor_scenes::NeighborScenes;
use crate::scene_fingerprint::SceneFingerprint;
use crate::{AovSet, Error, Limit, RenderStats};
use juggler_camera::film::{FilmDigest, FilmSummary, FilterSampler, Rect};
use juggler_camera::{AnyCamera, Perspective, ShutterCamera};
use juggler_film::counts::SampleCountStats;
use juggler_imaging::{CropFrame, Header, Options, RowWriter, Tone};
use juggler_integrator::{AnyIntegrator, Clamp};
use juggler_math::{Image, Rgb, UVec2};
use juggler_render::{CameraRays, Cancelled, Control, Job, Schedule, Scheduler};
use juggler_scene::description::Render;
use juggler_scene::{Compiled, Fingerprint, IntegratorChoice, IntegratorReason, Scene, SceneError};
use juggler_world::{SimdLevel, World};
use std::sync::{Arc, OnceLock};
use std::time::{Duration, Instant};

mod build;

/// Name of the program in files.
pub(crate) const SOFTWARE: &str = concat!("Juggler ", env!("CARGO_PKG_VERSION"));

/// Scene compiled for rendering one image, with all settings resolved.
#[derive(Clone)]
pub struct Picture {
    pub(crate) compiled: Compiled,
    shutter_camera: ShutterCamera,
    region: Rect,
    camera_rays: Arc<CameraRays>,
    tone: Tone,
    limit: Limit,
    /// Fingerprint, once it was needed.
    fingerprint: OnceLock<Fingerprint>,
    scene_fingerprint: SceneFingerprint,
    band_pixels: u64,
    aovs: Arc<AovSet>,
    neighbors: NeighborScenes,
}

/// Camera and settings that can change without rebuilding the world.
#[derive(Clone, Debug, PartialEq)]
pub struct View {
    /// Camera.
    pub camera: AnyCamera,
    /// Size, samples, integrator and the like. Without an integrator the picture's is kept.
    pub render: Render,
    /// Conversion from linear radiance to pixels of files.
    pub tone: Tone,
}

impl Picture {
    /// Returns the current view.
    pub fn view(&self) -> View {
        let camera = self.compiled.cameras.first().map(|(_, camera)| camera.clone());
        View {
            camera: camera.unwrap_or_else(|| Perspective::default().into()),
            render: Render { integrator: Some(self.integrator().clone()), ..self.compiled.settings.clone() },
            tone: self.tone.clone(),
        }
    }

    /// Returns another view of the same world, without crop and limits. The camera's name is kept;
    /// motion vectors assume a static camera.
    pub fn with_view(&self, mut view: View) -> Result<Self, Error> {
        let integrator = view.render.integrator.get_or_insert_with(|| self.integrator().clone()).clone();
        let mut scene = Scene::new();
        let description = &mut scene.description;
        (description.render, description.tone) = (view.render.clone().into(), view.tone.clone().into());
        description.render.camera = None;
        description.camera = Some(view.camera.clone().into());
        let problems = scene.check();
        if problems.errors() > 0 {
            // The scene has a view alone.
            return Err(SceneError::Problems(problems.without_warnings()).into());
        }
        let [width, height] = view.render.size;
        let mut picture = self.clone();
        if view.camera != self.view().camera {
            picture.compiled.camera_keys.clear();
        }
        picture.region = Rect { x: 0, y: 0, width, height };
        picture.camera_rays = Arc::new(CameraRays::new(UVec2::new(width, height)));
        (picture.tone, picture.limit) = (view.tone, Limit::Samples);
        if let Some((_, camera)) = picture.compiled.cameras.first_mut() {
            *camera = view.camera.clone();
        }
        let shutter_camera = picture.compiled.shutter_camera(UVec2::new(width, height));
        picture.shutter_camera = shutter_camera.map_err(|error| Error::setting("camera", error.to_string()))?;
        picture.neighbors = self.neighbors.with_camera(&picture.shutter_camera);
        let camera_keys = picture.compiled.camera_keys.clone();
        picture.scene_fingerprint = self.scene_fingerprint.with_view(scene, view.camera, camera_keys);
        picture.fingerprint = OnceLock::new();
        if view.render.transparent != self.aovs.is_transparent() {
            let (aovs, transparent) = (&self.aovs, view.render.transparent);
            let set = AovSet::new(aovs.selected(), aovs.denoiser(), &self.compiled.names, transparent);
            picture.aovs = Arc::new(set);
        }
        picture.compiled = picture.compiled.with_hidden_background(view.render.transparent);
        picture.compiled.settings = view.render;
        if integrator != *self.integrator() {
            picture.compiled.integrator = IntegratorChoice { integrator, reason: IntegratorReason::Settings };
        }
        Ok(picture)
    }

    /// Returns whether the samples of both are equal, so that one can continue the other's film.
    pub fn shares_samples(&self, other: &Self) -> bool {
        let (a, b) = (self.job(), other.job());
        Arc::ptr_eq(self.world(), other.world())
            && self.region == other.region
            && (a.camera, a.pattern, a.seed) == (b.camera, b.pattern, b.seed)
            && a.filter == b.filter
            && self.integrator() == other.integrator()
            && (a.samples == 1) == (b.samples == 1)
            && a.aovs == b.aovs
    }

    /// Selects the vector instructions; for tests and benchmarks.
    pub fn with_simd_level(mut self, level: SimdLevel) -> Self {
        self.compiled.world = Arc::new(Arc::unwrap_or_clone(self.compiled.world).with_simd_level(level));
        self
    }

    /// Sets how many pixels are in memory when rows are written directly to a file, rounded to
    /// whole rows of tiles. The default is 2^22; the image does not depend on it.
    #[must_use]
    pub fn with_band_pixels(mut self, pixels: u64) -> Self {
        self.band_pixels = pixels;
        self
    }

    /// Returns width and height of the rendered region: the crop's, if there is one.
    pub fn size(&self) -> [u32; 2] {
        [self.region.width, self.region.height]
    }

    /// Returns the number of samples per pixel.
    pub fn samples(&self) -> u32 {
        self.compiled.settings.samples
    }

    /// Returns the number of samples of all pixels.
    pub fn total_samples(&self) -> u64 {
        self.region.area().saturating_mul(u64::from(self.samples()))
    }

    /// Returns the world.
    pub fn world(&self) -> &Arc<World> {
        &self.compiled.world
    }

    /// Returns the integrator; [`Compiled::integrator`] gives the reason of its choice.
    pub fn integrator(&self) -> &AnyIntegrator {
        &self.compiled.integrator.integrator
    }

    /// Returns world, cameras and settings.
    pub fn compiled(&self) -> &Compiled {
        &self.compiled
    }

    /// Returns the fingerprint of everything that determines the pixels. Films of equal
    /// fingerprints can be continued and merged. The first call computes the fingerprint.
    pub fn fingerprint(&self) -> &Fingerprint {
        self.fingerprint.get_or_init(|| self.complete(self.scene_fingerprint.compute()))
    }

    /// Adds program version and sampling pattern to the scene's fingerprint.
    fn complete(&self, mut fingerprint: Fingerprint) -> Fingerprint {
        let Job { pattern, filter, samples, aovs, .. } = self.job();
        let grid = if let FilterSampler::Juggler(side) = filter {
            format!(", filter for {side} x {side}")
        } else {
            String::new()
        };
        let single = if samples == 1 { ", one through the centre" } else { "" };
        let halves = if aovs.has_halves() { ", halves apart" } else { "" };
        fingerprint.insert("juggler", env!("CARGO_PKG_VERSION"));
        fingerprint.insert("pattern of samples", &format!("{pattern:?}{grid}{single}{halves}"));
        fingerprint
    }

    /// Returns the stop condition.
    pub fn limit(&self) -> &Limit {
        &self.limit
    }

    /// Returns width and height of the camera's whole frame.
    pub fn frame_size(&self) -> [u32; 2] {
        self.compiled.settings.size
    }

    /// Returns the rendered region, in pixels.
    pub fn region(&self) -> Rect {
        self.region
    }

    /// Returns the conversion from linear radiance to pixels of files.
    pub fn tone(&self) -> &Tone {
        &self.tone
    }

    /// Returns the header of the image file. Its metadata give program, fingerprint and seed, and
    /// the number of samples unless noise or time decides it.
    pub fn header(&self, options: Options) -> Header {
        let [width, height] = self.size();
        let text = |key: &str, value: &str| (key.to_owned(), value.to_owned());
        let mut metadata = vec![
            text("Software", SOFTWARE),
            text("Fingerprint", &self.fingerprint().hash()),
            text("Seed", &self.compiled.settings.seed.to_string()),
        ];
        // The final number of samples is unknown under a noise or time limit.
        if self.limit == Limit::Samples {
            metadata.push(text("Samples", &self.samples().to_string()));
        }
        if let Some(Clamp { direct, indirect }) = self.integrator().clamp() {
            let limits =
                [("direct", direct), ("indirect", indirect)].into_iter().filter(|(_, limit)| limit.is_finite());
            let limits: Vec<String> = limits.map(|(light, limit)| format!("{light} light at {limit}")).collect();
            metadata.push(text("Clamping", &limits.join(", ")));
        }
        let (viewpoint, corner) = (self.viewpoint(), [self.region.x, self.region.y]);
        let crop = CropFrame::new(self.frame_size(), corner, [width, height]);
        let transparent = self.aovs.is_transparent();
        let tone = self.tone.clone();
        Header { tone, options, transparent, metadata, viewpoint, crop, ..Header::new(width, height) }
    }

    /// Returns the AOVs.
    pub fn aovs(&self) -> &AovSet {
        &self.aovs
    }

    /// Returns a hash of the neighboring frames; empty if no AOV needs them or nothing changes.
    pub(crate) fn neighbor_fingerprint(&self) -> &str {
        &self.neighbors.fingerprint
    }

    /// Returns the number of worlds in addition to the picture's own.
    pub(crate) fn neighbor_worlds(&self) -> usize {
        self.neighbors.frames.as_ref().map_or(0, |frames| frames.count_other_worlds(self.world()))
    }

    /// Returns the render job for the engine.
    pub fn job(&self) -> Job<'_> {
        let settings = &self.compiled.settings;
        let samples = self.limit.pattern_samples(settings.samples);
        let aovs = self.aovs.film_aovs();
        let of_stream = if aovs.has_halves() { samples.div_ceil(2) } else { samples };
        Job {
            world: &self.compiled.world,
            camera: &self.shutter_camera,
            integrator: &**self.integrator(),
            filter: settings.filter.sampler(samples),
            pattern: settings.sampler.point_set(of_stream),
            samples,
            seed: settings.seed,
            camera_rays: &self.camera_rays,
            aovs,
            frames: self.neighbors.frames.as_ref(),
        }
    }

    /// Renders and passes finished rows to `rows`, from the top, without alpha; memory holds two bands
    /// at a time.
    pub fn render<E: From<Cancelled>>(
        &self,
        scheduler: Scheduler,
        control: &Control,
        mut rows: impl FnMut(&[Rgb]) -> Result<(), E>,
    ) -> Result<FilmSummary, E> {
        let [width, height] = self.size();
        let mut digest = FilmDigest::new(width, height);
        let schedule = Schedule { scheduler, band_pixels: self.band_pixels };
        juggler_render::render(&self.job(), self.region, schedule, control, |band| {
            digest.update(&band);
            rows(&band)
        })
        .map(|clamped| {
            digest.add_clamped(clamped);
            digest.finish()
        })
    }

    /// Renders to the destination of `writer`, without alpha. A transparent picture needs a film:
    /// [`Picture::write_film`].
    pub fn write(&self, mut writer: Box<dyn RowWriter>, control: &Control) -> Result<RenderStats, Error> {
        let start = Instant::now();
        let mut write = Duration::ZERO;
        let film = self.render(Scheduler::default(), control, |rows| {
            let start = Instant::now();
            writer.write_rows(rows.into())?;
            write += start.elapsed();
            Ok::<(), Error>(())
        })?;
        let render = start.elapsed().saturating_sub(write);
        let finish = Instant::now();
        writer.finish()?;
        let (denoise, write) = (Duration::ZERO, write + finish.elapsed());
        let samples = SampleCountStats::uniform(self.samples());
        Ok(RenderStats { film, samples, rays: control.rays(), render, denoise, write })
    }

    /// Renders the samples of each pixel into memory. A noise or time limit, a denoiser, AOVs and alpha
    /// do not act here, but in [`Picture::render_in_memory`].
    pub fn render_image(&self, control: &Control) -> Result<Image, Cancelled> {
        let [width, height] = self.size();
        let mut image = Image::filled(width, height, Rgb::BLACK);
        let mut rest = image.pixels_mut();
        self.render(Scheduler::default(), control, |rows| {
            let (these, others) = std::mem::take(&mut rest).split_at_mut(rows.len());
            these.copy_from_slice(rows);
            rest = others;
            Ok::<(), Cancelled>(())
        })?;
        Ok(image)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Settings;

    #[test]
    fn changed_camera_equals_a_scene_with_that_camera() {
        let object = juggler_scene::Object::new(juggler_shape::Sphere::default());
        let plain = Scene::new().size(16, 12).add(object);
        let camera = Perspective { vertical_fov_degrees: Some(30.0), ..Perspective::default() };
        let named = plain.clone().camera("left", Perspective::default()).camera("right", camera);
        for (scene, name) in [(plain, None), (named.clone(), None), (named, Some("right".to_owned()))] {
            let few = Settings { camera: name.clone(), ..Settings::default() };
            let many = Settings { samples: Some(7), camera: name, ..Settings::default() };
            let picture = Picture::new(&scene, &few).unwrap();
            let expected = Picture::new(&scene, &many).unwrap();
            let viewed = picture.with_view(View { render: expected.view().render, ..picture.view() }).unwrap();
            assert_eq!(viewed.fingerprint(), expected.fingerprint());
            let other = Perspective { vertical_fov_degrees: Some(50.0), ..Perspective::default() };
            let moved = picture.with_view(View { camera: other.into(), ..picture.view() }).unwrap();
            assert_ne!(moved.fingerprint(), picture.fingerprint());
        }
    }
}
