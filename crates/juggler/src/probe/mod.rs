//! Why a pixel is as it is: its samples, traced again as the picture took them, with all that their paths did.
//!
//! ```
//! use juggler::prelude::*;
//! use juggler::probe::{Detail, Prober};
//!
//! let scene = Scene::new().size(8, 8).add(Object::new(Sphere::default()));
//! let picture = Picture::new(&scene, &Settings { samples: Some(4), ..Settings::default() })?;
//! let image = picture.image(&Control::default())?;
//! let prober = Prober::new(&scene, picture);
//! let probe = prober.pixel([4, 4], &Detail::default(), &Control::default())?;
//! assert_eq!(probe.mean, image.pixels()[4 * 8 + 4].to_array());
//! # Ok::<(), juggler::Error>(())
//! ```

mod chain;
mod fireflies;
mod names;
mod outliers;
mod shares;
mod tree;

pub use chain::{Contribution, Place, SampleProbe, Step};
pub use fireflies::{Fireflies, Firefly, Kind};
pub use shares::{Light, Share, Shares};
pub use tree::{Branch, Others};

use crate::{Error, Picture};
use chain::Brightest;
use juggler_camera::film::Statistics;
use juggler_integrator::AnyIntegrator;
use juggler_math::{Rgb, Vec2};
use juggler_render::{Control, Inspected, Job};
use juggler_scene::Scene;
use juggler_world::{LightsApart, Vertex};
use names::Namer;
use serde::Serialize;
use shares::Sums;
use std::sync::Arc;
use tree::Tree;

/// How often a ray goes on through holes.
const MOST_HOLES: usize = 64;
/// Less of a surface than this, and the middle of a pixel sees what is behind it.
const THERE: f32 = 0.5;

/// How much is told.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Detail {
    /// Places in a row that the tree of paths tells apart.
    pub depth: u32,
    /// Branches of each place; the smaller ones are summed.
    pub branches: usize,
    /// Samples that are told one by one, the brightest first.
    pub brightest: usize,
}

impl Default for Detail {
    fn default() -> Self {
        Self { depth: 5, branches: 5, brightest: 5 }
    }
}

/// What is known of one pixel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Probe {
    /// Column and row, from the top left.
    pub pixel: [u32; 2],
    /// Width and height of the picture.
    pub size: [u32; 2],
    /// How light was followed.
    pub integrator: &'static str,
    /// Samples of the pixel.
    pub samples: u32,
    /// How many of them were no finite numbers, and counted as black.
    pub not_finite: u32,
    /// The pixel, linear RGB: that of the picture to the bit.
    pub mean: [f32; 3],
    /// Standard error of the mean; nothing of a single sample.
    pub standard_error: Option<[f64; 3]>,
    /// What clamping took off the pixel: the mean of the channels.
    pub clamped: f64,
    /// What the middle of the pixel sees first, if anything.
    pub seen: Option<Sight>,
    /// Where its light comes from; nothing of integrators that follow no paths.
    pub light: Option<Light>,
}

/// What a ray met.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Sight {
    /// The entry of the scene's objects: its name, or `objects[3]`.
    pub object: String,
    /// Where its shape is described, where that is not the entry itself: `groups.tree[2]`.
    pub part: Option<String>,
    /// The kind of the shape.
    pub shape: Option<String>,
    /// Its number among all shapes, instances one by one, from 1 on as layers count.
    pub instance: u32,
    /// The material's name, or where it is described.
    pub material: String,
    /// Where it is, world space.
    pub point: [f32; 3],
    /// Unit shading normal there.
    pub normal: [f32; 3],
    /// Distance from where the ray began, in scene units.
    pub distance: f32,
    /// Surface coordinates.
    pub uv: [f32; 2],
}

/// Asks about pixels of one picture.
pub struct Prober<'s> {
    picture: Picture,
    apart: LightsApart,
    scene: &'s Scene,
}

impl<'s> Prober<'s> {
    /// Of a picture of that scene. The picture's world is copied where somebody else has it too.
    pub fn new(scene: &'s Scene, picture: Picture) -> Self {
        let (picture, apart) = picture.with_lights_apart();
        Self { picture, apart, scene }
    }

    /// The picture.
    pub fn picture(&self) -> &Picture {
        &self.picture
    }

    fn namer(&self) -> Namer<'_> {
        Namer::new(&self.scene.description, &self.picture, &self.apart)
    }

    /// Whether samples are followed along paths that can be told.
    fn follows_paths(&self) -> bool {
        let integrator = self.picture.integrator();
        matches!(integrator, AnyIntegrator::Path(_) | AnyIntegrator::Direct(_) | AnyIntegrator::Classic(_))
    }

    /// An error where the pixel is not in the picture.
    fn check(&self, [x, y]: [u32; 2]) -> Result<(), Error> {
        let region = self.picture.region();
        let is_in = |at: u32, start: u32, length: u32| at.checked_sub(start).is_some_and(|from| from < length);
        if is_in(x, region.x, region.width) && is_in(y, region.y, region.height) {
            return Ok(());
        }
        let (last_x, last_y) = (region.x + region.width.max(1) - 1, region.y + region.height.max(1) - 1);
        Err(Error::Settings(format!(
            "the pixel {x},{y} is not in the picture: X goes from {} to {last_x}, Y from {} to {last_y}",
            region.x, region.y
        )))
    }

    /// Traces the samples of a pixel, column and row from the top left, and tells what they did.
    pub fn pixel(&self, pixel: [u32; 2], detail: &Detail, control: &Control) -> Result<Probe, Error> {
        self.check(pixel)?;
        let (job, mut namer) = (self.picture.job(), self.namer());
        let mut tree = Tree::new(detail.depth);
        let mut sums = Sums::default();
        let mut brightest = Brightest::new(detail.brightest);
        let mut spread = Spread::default();
        let (mean, statistics) = juggler_render::inspect(&job, pixel, control, |sample| {
            spread.add(&sample);
            if self.follows_paths() {
                sums.add(&namer, &sample);
                tree.add(&mut namer, &sample);
                brightest.add(sample);
            }
        })?;
        let light = self.follows_paths().then(|| {
            let scale = shares::Scale::new(job.samples, &sums);
            let brightest = brightest.told(&mut namer, spread.total);
            Light {
                shares: sums.told(&namer, &scale),
                paths: tree.told(&mut namer, &scale, detail.branches),
                brightest,
            }
        });
        Ok(Probe {
            pixel,
            size: self.picture.compiled().settings.size,
            integrator: self.picture.integrator().name(),
            samples: job.samples,
            not_finite: spread.not_finite,
            mean: mean.to_array(),
            standard_error: spread.standard_error(&statistics),
            clamped: spread.clamped / f64::from(job.samples.max(1)),
            seen: seen(&job, pixel).map(|(vertex, distance)| sight(&mut namer, &vertex, distance)),
            light,
        })
    }
}

impl Picture {
    /// The same picture of a world in which each light is a group of its own.
    fn with_lights_apart(mut self) -> (Self, LightsApart) {
        let (world, apart) = Arc::unwrap_or_clone(self.compiled.world).with_lights_apart();
        self.compiled.world = Arc::new(world);
        (self, apart)
    }
}

/// How much samples differ.
#[derive(Default)]
struct Spread {
    count: u32,
    not_finite: u32,
    clamped: f64,
    total: [f64; 3],
    squares: [f64; 3],
}

impl Spread {
    fn add(&mut self, sample: &Inspected) {
        self.count += 1;
        if !sample.radiance.is_finite() {
            self.not_finite += 1;
            return;
        }
        self.clamped += f64::from(sample.clamped);
        for (i, channel) in sample.radiance.to_array().into_iter().map(f64::from).enumerate() {
            self.total[i] += channel;
            self.squares[i] += channel * channel;
        }
    }

    /// By how much blocks of samples differ, as the film knows it; of fewer than two by how much samples do.
    fn standard_error(&self, statistics: &Statistics) -> Option<[f64; 3]> {
        let count = f64::from(self.count);
        match (statistics.blocks, self.count) {
            (2.., _) => Some(statistics.variance.map(f64::sqrt)),
            (_, 2..) => Some(std::array::from_fn(|i| {
                let variance = (self.squares[i] - self.total[i] * self.total[i] / count) / (count - 1.0);
                (variance.max(0.0) / count).sqrt()
            })),
            _ => None,
        }
    }
}

/// What the ray through the middle of a pixel, of the lens and of the time meets first, holes left out, and how far away it is.
fn seen(job: &Job, pixel: [u32; 2]) -> Option<(Vertex, f32)> {
    let film = Vec2::new(pixel[0] as f32, pixel[1] as f32) + 0.5;
    let mut ray = job.camera.at(0.5).ray(film, Vec2::splat(0.5), 0.5);
    if !(ray.origin.is_finite() && ray.direction.is_finite()) {
        return None;
    }
    let from = ray.origin;
    for _ in 0..MOST_HOLES {
        let hit = job.world.closest(&mut ray);
        if !hit.is_some() {
            return None;
        }
        let vertex = job.world.vertex(&ray, &hit);
        if job.world.shade(&vertex, -ray.direction, 1.0, THERE).opacity >= THERE {
            return Some((vertex, (vertex.surface.point - from).length()));
        }
        ray = vertex.surface.spawn(ray.direction, ray.time);
    }
    None
}

fn sight(namer: &mut Namer, vertex: &Vertex, distance: f32) -> Sight {
    let part = namer.part(vertex.object);
    let object = namer.object_of(vertex.object);
    let path = part.as_ref().map(|part| part.path.clone());
    Sight {
        part: path.filter(|path| path.starts_with("groups") || path.contains("].")),
        shape: part.map(|part| part.kind),
        instance: vertex.object.saturating_add(1),
        material: namer.material(vertex.material.0, vertex.object),
        object,
        point: vertex.surface.point.to_array(),
        normal: vertex.surface.shading_normal.to_array(),
        distance,
        uv: vertex.surface.uv.to_array(),
    }
}

/// Luminance of linear light.
fn luminance([r, g, b]: [f64; 3]) -> f64 {
    let [kr, kg, kb] = [Rgb::new(1.0, 0.0, 0.0), Rgb::new(0.0, 1.0, 0.0), Rgb::new(0.0, 0.0, 1.0)];
    let weights = [kr, kg, kb].map(|primary| f64::from(primary.luminance()));
    weights[0] * r + weights[1] * g + weights[2] * b
}
