//! Memory estimates of a render before it starts, and settings that fit it into a limit.

use crate::neighbor_scenes;
use crate::{AovSet, Error, Picture, Settings};
use juggler_camera::aov::FilmAovs;
use juggler_camera::film::{AovSums, Film, Rect, TILE_EDGE};
use juggler_render::BAND_PIXELS;
use juggler_scene::compile::{DECODED_AT_ONCE, Needs, PictureNeeds};
use juggler_scene::model::ModelNeeds;
use juggler_scene::{Names, Scene};
use std::cmp::Reverse;
use std::ops::Range;
use std::path::Path;

/// Bytes of the program itself; unoptimized code takes more.
pub const PROGRAM: u64 = if cfg!(debug_assertions) { 44 << 20 } else { 26 << 20 };
/// Bytes of a thread: ray queues and file buffers.
const THREAD: u64 = 2 << 20;
/// Rays of a sample that are traced together, then bytes of each ray and each shadow ray that one
/// of them may spawn, including queued ones.
const GROUP: u64 = 256;
const RAY: u64 = 1024;
const SHADOW: u64 = 96;
/// Bytes of a stored object while the world is built.
const OBJECT: u64 = 768;
/// Bytes of an instance of a shape, from a list of an object, while the world is built.
const INSTANCE: u64 = 448;
/// Bytes of an emitting shape while the world is built.
const EMITTER: u64 = 768;
/// Bytes of a triangle of a mesh in the scene itself beside its arrays, while the world is built.
const TRIANGLE: u64 = 120;

/// Bytes of a mesh in the scene itself beside its arrays and triangles, while the world is built.
const MESH: u64 = 2200;
/// Bytes of the arrays of a point or a line segment while its model file is read.
const SOLID: u64 = 160;

/// Description of the worlds at the neighboring frames.
const NEIGHBOR_WORLDS: &str = "the scene at the neighboring frames";

/// Memory of one component of a render.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MemoryPart {
    /// Description of the component.
    pub what: String,
    /// Size in bytes.
    pub bytes: u64,
}

/// Share of the machine that a render may use. It does not affect the image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effort {
    /// Number of threads, at least 1.
    pub threads: usize,
    /// Number of pixels held in memory when rows are written directly to a file, see
    /// [`Picture::with_band_pixels`].
    pub band_pixels: u64,
}

/// Upper bound of a render's peak memory, first while its world is built, then while rays are
/// traced.
///
/// ```
/// use juggler::memory::Memory;
/// use juggler::prelude::*;
///
/// let scene = Scene::new().size(20_000, 20_000).add(Object::new(Sphere::default()));
/// let memory = Memory::estimate(&scene, &Settings::default())?;
/// let effort = memory.fit(96 << 20, 4).unwrap();
/// assert!(effort.threads == 4 && memory.bytes(&effort) <= 96 << 20);
/// assert!(memory.fit(10 << 20, 4).is_err());
/// # Ok::<(), juggler::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Memory {
    building: Vec<MemoryPart>,
    /// Bytes that the reading of the largest file needs meanwhile, since files are read one after
    /// the other.
    reading: u64,
    /// Bytes that the decoding of each picture needs meanwhile, in descending order. Several
    /// pictures are decoded at once.
    decoding: Vec<u64>,
    /// Components of the built world.
    world: Vec<MemoryPart>,
    /// Other components while rendering, without bands and threads.
    rendering: Vec<MemoryPart>,
    /// Bytes of the scene's texts and of arrays of instances.
    text: u64,
    /// Bytes of one thread's queues.
    thread: u64,
    region: Rect,
    samples: u32,
    /// Whether rows are written directly to the file.
    in_bands: bool,
    /// AOVs that the film stores.
    film_aovs: FilmAovs,
}

/// Contents of files and arrays that a scene needs, from sizes and headers of the files.
#[derive(Default)]
struct Contents {
    /// What stays in memory.
    parts: Vec<MemoryPart>,
    /// As [`Memory::reading`].
    reading: u64,
    /// As [`Memory::decoding`].
    decoding: Vec<u64>,
    /// Bytes of the arrays of instances.
    instances: u64,
}

impl Contents {
    fn new(needs: &Needs) -> Self {
        // The reader reports a file that cannot be read.
        let mut all = Self { instances: needs.instance_arrays, ..Self::default() };
        for file in &needs.files {
            let estimate = juggler_mesh::estimate(file).unwrap_or_default();
            all.add_file("mesh", file, [estimate.peak_bytes, estimate.resident_bytes]);
        }
        for PictureNeeds { name, estimate } in needs.pictures.iter().chain(&needs.panoramas) {
            all.parts.push(part(format!("the picture `{name}`"), estimate.resident_bytes));
        }
        let readings = needs.panoramas.iter().map(|panorama| panorama.estimate.temporary_bytes());
        all.reading = readings.fold(all.reading, u64::max);
        all.decoding = needs.pictures.iter().map(|picture| picture.estimate.temporary_bytes()).collect();
        all.decoding.sort_by_key(|bytes| Reverse(*bytes));
        all.add_arrays("meshes in memory", needs.meshes);
        all.add_arrays("model files", needs.models);
        for file in &needs.instance_files {
            let estimate = juggler_mesh::estimate_points(file).unwrap_or_default();
            all.instances = all.instances.saturating_add(estimate.resident_bytes);
            all.add_file("instances", file, [estimate.peak_bytes, estimate.resident_bytes]);
        }
        all.add_arrays("arrays of instances", needs.instance_arrays);
        all.add_arrays("images in memory", needs.images);
        all
    }

    /// Adds a file and the bytes that it needs: at most, and after it is read.
    fn add_file(&mut self, kind: &str, file: &Path, [peak, resident]: [u64; 2]) {
        self.reading = self.reading.max(peak.saturating_sub(resident));
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        self.parts.push(part(format!("the {kind} `{name}`"), resident));
    }

    fn add_arrays(&mut self, name: &str, bytes: u64) {
        if bytes > 0 {
            self.parts.push(part(name, bytes));
        }
    }
}

impl Memory {
    /// Estimates the memory of a scene before its files are read and its world is built, from sizes
    /// and headers of the files.
    pub fn estimate(scene: &Scene, settings: &Settings) -> Result<Self, Error> {
        let needs = scene.needs();
        let mut building = vec![part("the program", PROGRAM), part("the scene", scene_bytes(&needs))];
        let mut world = building.clone();
        let contents = Contents::new(&needs);
        world.extend_from_slice(&contents.parts);
        let more = neighbor_scenes::extra_worlds(scene, &settings.aovs);
        world.push(part(NEIGHBOR_WORLDS, more.saturating_mul(scene_bytes(&needs))));
        building.extend_from_slice(world.get(2..).unwrap_or_default());
        Ok(Self {
            building,
            reading: contents.reading,
            decoding: contents.decoding,
            world,
            rendering: Vec::new(),
            text: needs.text.saturating_add(contents.instances).saturating_add(needs.models),
            thread: THREAD + GROUP.saturating_mul(needs.rays * RAY + needs.shadows * SHADOW),
            region: settings.region(settings.size_of(scene))?,
            samples: settings.samples_of(scene),
            in_bands: true,
            film_aovs: film_aovs(scene, settings),
        })
    }

    /// Replaces estimates by the sizes of the built world.
    #[must_use]
    pub fn with_world(mut self, picture: &Picture) -> Self {
        let geometry = picture.world().geometry_stats();
        let world = [part("the scene", self.text), part("shapes", geometry.geometry_bytes as u64)];
        self.world.truncate(1);
        self.world.extend(world);
        self.world.push(part("trees", geometry.bvh_bytes as u64));
        self.world.push(part("emitters", geometry.emitter_bytes as u64));
        // Meshes that do not deform are shared; the upper bound counts them nonetheless.
        let more = picture.neighbor_worlds().saturating_mul(geometry.geometry_bytes.saturating_add(geometry.bvh_bytes));
        self.world.push(part(NEIGHBOR_WORLDS, more as u64));
        self.world.push(part("textures", geometry.texture_bytes as u64));
        self.world.push(part("the background", geometry.background_bytes as u64));
        self.building.clear();
        (self.reading, self.decoding) = Default::default();
        self
    }

    /// Adds a component that is held while rendering, such as a file writer.
    #[must_use]
    pub fn with_part(mut self, what: impl Into<String>, bytes: u64) -> Self {
        self.rendering.push(part(what, bytes));
        self
    }

    /// Adds a film that is kept: one of `shards` shards of the pixels in `crop` and of `samples`;
    /// `None` takes all.
    #[must_use]
    pub fn with_film(mut self, crop: Option<Rect>, samples: Option<Range<u32>>, shards: u32) -> Self {
        const UNIT: u64 = 160;
        let tile = u64::from(TILE_EDGE * TILE_EDGE);
        let area = crop.map_or(self.region, |crop| crop.intersection(&self.region)).area();
        let (tiles, shards) = (area.div_ceil(tile), u64::from(shards.max(1)));
        let pixels = (area / shards).saturating_add(2 * tile).min(area.max(tile));
        // Few tiles are split by samples too.
        let runs = juggler_render::max_runs(&samples.unwrap_or(0..self.samples)) + usize::from(tiles < 8 * shards);
        let dealing = tiles.max(16 * shards).saturating_mul(UNIT);
        let row = u64::from(self.region.width) * u64::from(TILE_EDGE) * 16;
        self.in_bands = false;
        let film =
            Film::max_bytes(pixels, runs, AovSums::bytes_per_pixel(self.film_aovs.planes.len(), self.film_aovs.masks));
        self.with_part("the film", film.saturating_add(dealing).saturating_add(row))
    }

    /// Returns the pixels of the rendered region.
    pub fn region(&self) -> Rect {
        self.region
    }

    fn building_with(&self, effort: &Effort) -> Vec<MemoryPart> {
        let threads = part("threads", THREAD.saturating_mul(effort.threads as u64));
        let reading = self.reading.max(self.decoding_bytes(effort.threads));
        let reading = part("reading files and building trees", reading);
        self.building.iter().cloned().chain([reading, threads]).collect()
    }

    /// Bytes that the decoding of pictures needs at most beside the pictures.
    fn decoding_bytes(&self, threads: usize) -> u64 {
        let bound = self.decoding.first().copied().unwrap_or_default().max(DECODED_AT_ONCE);
        self.decoding.iter().take(threads).copied().fold(0, u64::saturating_add).min(bound)
    }

    fn rendering_with(&self, effort: &Effort) -> Vec<MemoryPart> {
        let band = if self.in_bands { juggler_render::band_bytes(self.region, effort.band_pixels) } else { 0 };
        let queues = self.thread.saturating_mul(effort.threads as u64);
        let rest = [part("finished rows", band), part("threads and their queues of rays", queues)];
        self.world.iter().chain(&self.rendering).cloned().chain(rest).collect()
    }

    /// Returns the components at the peak, without empty ones.
    pub fn parts(&self, effort: &Effort) -> Vec<MemoryPart> {
        let steps = [self.building_with(effort), self.rendering_with(effort)];
        let mut worst = steps.into_iter().max_by_key(|parts| sum(parts)).unwrap_or_default();
        worst.retain(|part| part.bytes > 0);
        worst
    }

    /// Returns the peak memory in bytes.
    pub fn bytes(&self, effort: &Effort) -> u64 {
        sum(&self.building_with(effort)).max(sum(&self.rendering_with(effort)))
    }

    /// Returns an effort of up to `threads` threads whose peak is at most `most` bytes; it reduces
    /// the bands first, then the threads. Fails with the components of the smallest effort.
    pub fn fit(&self, most: u64, threads: usize) -> Result<Effort, Vec<MemoryPart>> {
        let least = |threads| Effort { threads, band_pixels: 0 };
        let fits = |threads: &usize| self.bytes(&least(*threads)) <= most;
        let Some(threads) = (1..=threads.max(1)).rev().find(fits) else { return Err(self.parts(&least(1))) };
        // Halve the bands; their heights are rounded to whole rows of tiles anyway.
        let sizes = std::iter::successors(Some(BAND_PIXELS), |pixels| (*pixels > 1).then_some(pixels / 2));
        let efforts = sizes.map(|band_pixels| Effort { threads, band_pixels });
        Ok(efforts.into_iter().find(|effort| self.bytes(effort) <= most).unwrap_or(least(threads)))
    }
}

/// Bytes to open models and to build a world of the spheres and cylinders that their points and
/// lines become; 0 without models.
pub fn model_bytes(needs: &ModelNeeds) -> u64 {
    let solids = needs.solids.saturating_mul(SOLID.saturating_add(INSTANCE));
    let bytes = needs.bytes.saturating_add(solids);
    if bytes == 0 { 0 } else { PROGRAM.saturating_add(bytes) }
}

/// AOVs that the film of a scene with these settings stores.
fn film_aovs(scene: &Scene, settings: &Settings) -> FilmAovs {
    let names = Names::from_scene(&scene.description);
    AovSet::new(&settings.aovs, settings.denoiser, &names, settings.transparent_of(scene)).film_aovs().clone()
}

fn scene_bytes(needs: &Needs) -> u64 {
    let objects = needs.objects.saturating_mul(OBJECT);
    let instances = needs.instances.saturating_mul(INSTANCE);
    let triangles = needs.triangles.saturating_mul(TRIANGLE).saturating_add(needs.arrays);
    let emitters = needs.emitters.saturating_mul(EMITTER);
    let meshes = needs.inline_meshes.saturating_mul(MESH);
    [objects, instances, meshes, triangles, emitters].into_iter().fold(needs.text, u64::saturating_add)
}

fn part(what: impl Into<String>, bytes: u64) -> MemoryPart {
    MemoryPart { what: what.into(), bytes }
}

/// Returns the bytes of all components.
pub fn sum(parts: &[MemoryPart]) -> u64 {
    parts.iter().map(|part| part.bytes).fold(0, u64::saturating_add)
}
