//! How much memory a render takes, told before it starts; and how it takes less.

use crate::frames;
use crate::{Error, LayerSet, Picture, Settings};
use juggler_camera::film::{Extras, Film, Rect, TILE};
use juggler_camera::layer::Layers;
use juggler_render::BAND_PIXELS;
use juggler_scene::compile::{Needs, estimate_panorama, estimate_picture};
use juggler_scene::import;
use juggler_scene::{Names, Scene};
use std::ops::Range;

/// Bytes of the program itself; unoptimized code takes more.
pub const PROGRAM: u64 = if cfg!(debug_assertions) { 36 << 20 } else { 20 << 20 };
/// Bytes of a thread: queues of rays, pieces of files.
const THREAD: u64 = 2 << 20;
/// Rays of a sample that are followed side by side, and bytes of each ray and shadow ray that one of them may send on,
/// waiting ones included.
const GROUP: u64 = 256;
const RAY: u64 = 1024;
const SHADOW: u64 = 96;
/// Bytes of an object that is stored, while the world is built.
const OBJECT: u64 = 768;
/// Bytes of a shape that emits light, while the world is built.
const EMITTER: u64 = 768;
/// Bytes of a triangle that stands in the scene itself, while the world is built.
const TRIANGLE: u64 = 160;

/// What worlds are called that stand beside the one that is rendered.
const BESIDE: &str = "the scene at the frames beside";

/// Something that takes memory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Part {
    /// What it is.
    pub what: String,
    /// How much it takes.
    pub bytes: u64,
}

/// How much of the machine a render may use. No picture depends on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effort {
    /// Threads, at least 1.
    pub threads: usize,
    /// Pixels that are held in memory at once when rows go straight to the file, see [`Picture::with_bands`].
    pub band_pixels: u64,
}

/// The memory of a render: an upper bound of the most that it holds at once, first while its world is built, then
/// while rays are traced.
///
/// ```
/// use juggler::memory::Memory;
/// use juggler::prelude::*;
///
/// let scene = Scene::new().size(20_000, 20_000).add(Object::new(Sphere::default()));
/// let memory = Memory::of(&scene, &Settings::default())?;
/// let effort = memory.fit(64 << 20, 4).unwrap();
/// assert!(effort.threads == 4 && memory.bytes(&effort) <= 64 << 20);
/// assert!(memory.fit(10 << 20, 4).is_err());
/// # Ok::<(), juggler::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Memory {
    building: Vec<Part>,
    /// What stays of that.
    world: Vec<Part>,
    /// What else rendering takes, but bands and threads.
    rendering: Vec<Part>,
    /// Bytes of the scene's texts.
    text: u64,
    /// Bytes of one thread's queues.
    thread: u64,
    region: Rect,
    samples: u32,
    /// Whether rows go straight to the file.
    in_bands: bool,
    /// What a film keeps beside radiance.
    layers: Layers,
}

impl Memory {
    /// Of a scene before its files are read and its world is built. A file's part is told from its size and head.
    pub fn of(scene: &Scene, settings: &Settings) -> Result<Self, Error> {
        let needs = scene.needs();
        let mut building = vec![part("the program", PROGRAM), part("the scene", of_scene(&needs))];
        let mut world = building.clone();
        // One after the other: only one is on its way from a file to a mesh.
        let mut most = 0;
        for file in &needs.files {
            // A file that cannot be read is reported by who reads it.
            let estimate = import::estimate(file).unwrap_or_default();
            most = most.max(estimate.peak.saturating_sub(estimate.kept));
            let name = file.file_name().unwrap_or_default().to_string_lossy();
            world.push(part(format!("the mesh `{name}`"), estimate.kept));
        }
        let pictures = needs.pictures.iter().map(|file| (file, estimate_picture(file)));
        let panoramas = needs.panoramas.iter().map(|file| (file, estimate_panorama(file)));
        for (file, estimate) in pictures.chain(panoramas) {
            most = most.max(estimate.peak.saturating_sub(estimate.kept));
            let name = file.file_name().unwrap_or_default().to_string_lossy();
            world.push(part(format!("the picture `{name}`"), estimate.kept));
        }
        if needs.images > 0 {
            world.push(part("images in memory", needs.images));
        }
        let more = frames::more_worlds(scene, &settings.aovs);
        world.push(part(BESIDE, more.saturating_mul(of_scene(&needs))));
        building.extend_from_slice(world.get(2..).unwrap_or_default());
        building.push(part("reading files and building trees", most));
        Ok(Self {
            building,
            world,
            rendering: Vec::new(),
            text: needs.text,
            thread: THREAD + GROUP.saturating_mul(needs.rays * RAY + needs.shadows * SHADOW),
            region: settings.region(settings.size_of(scene))?,
            samples: settings.samples_of(scene),
            in_bands: true,
            layers: LayerSet::new(&settings.aovs, settings.denoiser, &Names::of(&scene.description)).layers().clone(),
        })
    }

    /// With numbers that are known when the world is built.
    #[must_use]
    pub fn of_built(mut self, picture: &Picture) -> Self {
        let geometry = picture.world().geometry();
        let world = [part("the scene", self.text), part("shapes", geometry.geometry_bytes as u64)];
        self.world.truncate(1);
        self.world.extend(world);
        self.world.push(part("trees", geometry.bvh_bytes as u64));
        self.world.push(part("emitters", geometry.emitter_bytes as u64));
        // Meshes that keep their shape are held once; they are counted here all the same.
        let more = picture.worlds_beside().saturating_mul(geometry.geometry_bytes.saturating_add(geometry.bvh_bytes));
        self.world.push(part(BESIDE, more as u64));
        self.world.push(part("textures", geometry.texture_bytes as u64));
        self.world.push(part("the background", geometry.background_bytes as u64));
        self.building.clear();
        self
    }

    /// With something else that is held while rendering, such as what writes the file.
    #[must_use]
    pub fn and(mut self, what: impl Into<String>, bytes: u64) -> Self {
        self.rendering.push(part(what, bytes));
        self
    }

    /// With a film that is kept: one of `shards` of the pixels `crop`, or of all, with the `samples`, or all.
    #[must_use]
    pub fn on_film(mut self, crop: Option<Rect>, samples: Option<Range<u32>>, shards: u32) -> Self {
        const UNIT: u64 = 160;
        let tile = u64::from(TILE * TILE);
        let area = crop.map_or(self.region, |crop| crop.intersection(&self.region)).area();
        let (tiles, shards) = (area.div_ceil(tile), u64::from(shards.max(1)));
        let pixels = (area / shards).saturating_add(2 * tile).min(area.max(tile));
        // Where tiles are few, their samples are dealt out too.
        let runs = juggler_render::most_runs(&samples.unwrap_or(0..self.samples)) + usize::from(tiles < 8 * shards);
        let dealing = tiles.max(16 * shards).saturating_mul(UNIT);
        let row = u64::from(self.region.width) * u64::from(TILE) * 16;
        self.in_bands = false;
        let film = Film::bytes(pixels, runs, Extras::bytes_a_pixel(self.layers.planes.len(), self.layers.masks));
        self.and("the film", film.saturating_add(dealing).saturating_add(row))
    }

    /// The pixels of the whole picture.
    pub fn region(&self) -> Rect {
        self.region
    }

    fn building_with(&self, effort: &Effort) -> Vec<Part> {
        let threads = part("threads", THREAD.saturating_mul(effort.threads as u64));
        self.building.iter().cloned().chain([threads]).collect()
    }

    fn rendering_with(&self, effort: &Effort) -> Vec<Part> {
        let band = if self.in_bands { juggler_render::band_bytes(self.region, effort.band_pixels) } else { 0 };
        let queues = self.thread.saturating_mul(effort.threads as u64);
        let rest = [part("finished rows", band), part("threads and their queues of rays", queues)];
        self.world.iter().chain(&self.rendering).cloned().chain(rest).collect()
    }

    /// What is held at the worst moment, what takes nothing left out.
    pub fn parts(&self, effort: &Effort) -> Vec<Part> {
        let steps = [self.building_with(effort), self.rendering_with(effort)];
        let mut worst = steps.into_iter().max_by_key(|parts| sum(parts)).unwrap_or_default();
        worst.retain(|part| part.bytes > 0);
        worst
    }

    /// The most that is held at once, in bytes.
    pub fn bytes(&self, effort: &Effort) -> u64 {
        sum(&self.building_with(effort)).max(sum(&self.rendering_with(effort)))
    }

    /// The effort of up to `threads` threads that takes no more than `most` bytes: smaller bands are tried first, then
    /// fewer threads. What takes how much at least, when nothing helps.
    pub fn fit(&self, most: u64, threads: usize) -> Result<Effort, Vec<Part>> {
        let least = |threads| Effort { threads, band_pixels: 0 };
        let fits = |threads: &usize| self.bytes(&least(*threads)) <= most;
        let Some(threads) = (1..=threads.max(1)).rev().find(fits) else { return Err(self.parts(&least(1))) };
        // Bands are halved: their heights are whole rows of tiles anyway.
        let sizes = std::iter::successors(Some(BAND_PIXELS), |pixels| (*pixels > 1).then_some(pixels / 2));
        let efforts = sizes.map(|band_pixels| Effort { threads, band_pixels });
        Ok(efforts.into_iter().find(|effort| self.bytes(effort) <= most).unwrap_or(least(threads)))
    }
}

fn of_scene(needs: &Needs) -> u64 {
    let objects = needs.objects.saturating_mul(OBJECT);
    let triangles = needs.triangles.saturating_mul(TRIANGLE);
    let emitters = needs.emitters.saturating_mul(EMITTER);
    [objects, triangles, emitters].into_iter().fold(needs.text, u64::saturating_add)
}

fn part(what: impl Into<String>, bytes: u64) -> Part {
    Part { what: what.into(), bytes }
}

/// Bytes of all parts.
pub fn sum(parts: &[Part]) -> u64 {
    parts.iter().map(|part| part.bytes).fold(0, u64::saturating_add)
}
