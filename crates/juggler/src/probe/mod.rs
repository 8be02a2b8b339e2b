//! Explanation of a pixel: its samples are traced again, bit-identical to the render, and their
//! paths are recorded.
//!
//! ```
//! use juggler::prelude::*;
//! use juggler::probe::{Detail, Prober};
//!
//! let scene = Scene::new().size(8, 8).add(Object::new(Sphere::default()));
//! let picture = Picture::new(&scene, &Settings { samples: Some(4), ..Settings::default() })?;
//! let image = picture.render_image(&Control::default())?;
//! let prober = Prober::new(&scene, picture);
//! let probe = prober.probe_pixel([4, 4], &Detail::default(), &Control::default())?;
//! assert_eq!(probe.mean, image.pixels()[4 * 8 + 4].to_array());
//! # Ok::<(), juggler::Error>(())
//! ```

mod fireflies;
mod names;
mod outliers;
mod path;
mod shares;
mod text;
mod tree;

pub use fireflies::{Fireflies, Firefly, PathGroup};
pub use path::{Contribution, PathEvent, ProbeVertex, SampleProbe};
pub use shares::{LightOrigins, Share, Shares};
pub use text::{number, percent, vector};
pub use tree::{Branch, Others};

use crate::{Error, Picture};
use juggler_camera::film::PixelStatistics;
use juggler_integrator::AnyIntegrator;
use juggler_math::{Rgb, Vec2};
use juggler_render::{Control, InspectedSample, Job};
use juggler_scene::Scene;
use juggler_world::{SeparateLights, Vertex};
use names::Namer;
use path::Brightest;
use serde::Serialize;
use shares::Sums;
use std::sync::Arc;
use tree::PathTree;

/// Maximum number of opacity masks that the pixel's center ray passes.
const MAX_PASSED_SURFACES: usize = 64;
/// Opacity from which the center ray hits a surface rather than passes it.
const MIN_OPACITY: f32 = 0.5;

/// Level of detail of a probe.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Detail {
    /// Maximum number of vertices of the paths in the tree.
    pub depth: u32,
    /// Maximum number of branches per vertex; smaller ones are merged.
    pub branches: usize,
    /// Number of samples to list, brightest first.
    pub brightest: usize,
}

impl Default for Detail {
    fn default() -> Self {
        Self { depth: 5, branches: 5, brightest: 5 }
    }
}

/// Explanation of one pixel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Probe {
    /// Column and row, from the top left.
    pub pixel: [u32; 2],
    /// Width and height of the image, in pixels.
    pub size: [u32; 2],
    /// Name of the integrator.
    pub integrator: &'static str,
    /// Number of samples of the pixel.
    pub samples: u32,
    /// Number of samples that were not finite and count as black.
    pub not_finite: u32,
    /// Radiance of the pixel, linear RGB, bit-identical to the rendered image.
    pub mean: [f32; 3],
    /// Standard error of the mean; `None` for a single sample.
    pub standard_error: Option<[f64; 3]>,
    /// Radiance removed by clamping, the mean of the channels.
    pub clamped: f64,
    /// First surface at the center of the pixel.
    #[serde(rename = "seen")]
    pub first_hit: Option<FirstHit>,
    /// Origins of the light; `None` for integrators without paths.
    pub light: Option<LightOrigins>,
}

/// First intersection of a ray.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FirstHit {
    /// Entry of the scene's objects: its name, or `objects[3]`.
    pub object: String,
    /// Path of the shape's description if it differs from the entry: `groups.tree[2]`.
    pub part: Option<String>,
    /// Kind of the shape.
    pub shape: Option<String>,
    /// Index among all shapes, with instances counted separately, from 1 as in the AOV
    /// `instance_id`.
    pub instance: u32,
    /// Name of the material, or the path of its description.
    pub material: String,
    /// Position, in world space.
    pub point: [f32; 3],
    /// Unit shading normal, in world space.
    pub normal: [f32; 3],
    /// Distance from the ray's origin, in scene units.
    pub distance: f32,
    /// Texture coordinates.
    pub uv: [f32; 2],
}

/// Probe of the pixels of one picture.
pub struct Prober<'s> {
    picture: Picture,
    separate_lights: SeparateLights,
    scene: &'s Scene,
}

impl<'s> Prober<'s> {
    /// Creates a probe for a picture of that scene. The picture's world is copied if it is shared.
    pub fn new(scene: &'s Scene, picture: Picture) -> Self {
        let (picture, separate_lights) = picture.with_separate_lights();
        Self { picture, separate_lights, scene }
    }

    /// Returns the picture.
    pub fn picture(&self) -> &Picture {
        &self.picture
    }

    fn namer(&self) -> Namer<'_> {
        Namer::new(&self.scene.description, &self.picture, &self.separate_lights)
    }

    /// Returns whether the integrator traces paths that can be recorded.
    fn follows_paths(&self) -> bool {
        let integrator = self.picture.integrator();
        matches!(integrator, AnyIntegrator::Path(_) | AnyIntegrator::Direct(_) | AnyIntegrator::Classic(_))
    }

    /// Checks that a pixel lies in the rendered region.
    fn check(&self, [x, y]: [u32; 2]) -> Result<(), Error> {
        let region = self.picture.region();
        let is_in = |at: u32, start: u32, length: u32| at.checked_sub(start).is_some_and(|from| from < length);
        if is_in(x, region.x, region.width) && is_in(y, region.y, region.height) {
            return Ok(());
        }
        let (last_x, last_y) = (region.x + region.width.max(1) - 1, region.y + region.height.max(1) - 1);
        let message = format!(
            "the pixel {x},{y} is outside the picture: X is {} to {last_x}, Y is {} to {last_y}",
            region.x, region.y
        );
        Err(Error::setting("pixel", message))
    }

    /// Traces all samples of a pixel, given by column and row from the top left, and explains their
    /// light. Fails if the pixel is outside the rendered region, or `control` is cancelled.
    pub fn probe_pixel(&self, pixel: [u32; 2], detail: &Detail, control: &Control) -> Result<Probe, Error> {
        self.check(pixel)?;
        let (job, mut namer) = (self.picture.job(), self.namer());
        let mut tree = PathTree::new(detail.depth);
        let mut sums = Sums::default();
        let mut brightest = Brightest::new(detail.brightest);
        let mut sample_statistics = SampleStatistics::default();
        let (mean, statistics) = juggler_render::inspect(&job, pixel, control, |sample| {
            sample_statistics.add(&sample);
            if self.follows_paths() {
                sums.add(&namer, &sample);
                tree.add(&mut namer, &sample);
                brightest.add(sample);
            }
        })?;
        let light = self.follows_paths().then(|| {
            let scale = shares::Scale::new(job.samples, &sums);
            let brightest = brightest.report(&mut namer, sample_statistics.total);
            LightOrigins {
                shares: sums.report(&namer, &scale),
                paths: tree.report(&mut namer, &scale, detail.branches),
                brightest,
            }
        });
        Ok(Probe {
            pixel,
            size: self.picture.compiled().settings.size,
            integrator: self.picture.integrator().name(),
            samples: job.samples,
            not_finite: sample_statistics.not_finite,
            mean: mean.to_array(),
            standard_error: sample_statistics.standard_error(&statistics),
            clamped: sample_statistics.clamped / f64::from(job.samples.max(1)),
            first_hit: center_hit(&job, pixel).map(|(vertex, distance)| first_hit(&mut namer, &vertex, distance)),
            light,
        })
    }
}

impl Picture {
    /// Replaces the world by one in which each light has its own light group.
    fn with_separate_lights(mut self) -> (Self, SeparateLights) {
        let (world, separate_lights) = Arc::unwrap_or_clone(self.compiled.world).with_separate_lights();
        self.compiled.world = Arc::new(world);
        (self, separate_lights)
    }
}

/// Sample statistics of a pixel.
#[derive(Default)]
struct SampleStatistics {
    count: u32,
    not_finite: u32,
    clamped: f64,
    total: [f64; 3],
    squares: [f64; 3],
}

impl SampleStatistics {
    fn add(&mut self, sample: &InspectedSample) {
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

    /// Returns the standard error from the film's blocks, or from the samples for fewer than two
    /// blocks.
    fn standard_error(&self, statistics: &PixelStatistics) -> Option<[f64; 3]> {
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

/// Returns the first surface on the ray through the center of pixel, lens and shutter interval, and
/// its distance. The ray passes surfaces of low opacity.
fn center_hit(job: &Job, pixel: [u32; 2]) -> Option<(Vertex, f32)> {
    let film = Vec2::new(pixel[0] as f32, pixel[1] as f32) + 0.5;
    let mut ray = job.camera.projection_at(0.5).ray(film, Vec2::splat(0.5), 0.5);
    if !(ray.origin.is_finite() && ray.direction.is_finite()) {
        return None;
    }
    let from = ray.origin;
    for _ in 0..MAX_PASSED_SURFACES {
        let hit = job.world.closest(&mut ray);
        if !hit.is_some() {
            return None;
        }
        let vertex = job.world.vertex(&ray, &hit);
        if job.world.shade(&vertex, -ray.direction, 1.0, MIN_OPACITY).opacity >= MIN_OPACITY {
            return Some((vertex, (vertex.surface.point - from).length()));
        }
        ray = vertex.surface.spawn_ray(ray.direction, ray.time);
    }
    None
}

fn first_hit(namer: &mut Namer, vertex: &Vertex, distance: f32) -> FirstHit {
    let part = namer.part(vertex.shape);
    let object = namer.object_of(vertex.shape);
    let path = part.as_ref().map(|part| part.path.clone());
    FirstHit {
        part: path.filter(|path| path.starts_with("groups") || path.contains("].")),
        shape: part.map(|part| part.kind),
        instance: vertex.shape.saturating_add(1),
        material: namer.material(vertex.material.0, vertex.shape),
        object,
        point: vertex.surface.point.to_array(),
        normal: vertex.surface.shading_normal.to_array(),
        distance,
        uv: vertex.surface.uv.to_array(),
    }
}

/// Returns the luminance of linear RGB.
fn luminance([r, g, b]: [f64; 3]) -> f64 {
    let [kr, kg, kb] = [Rgb::new(1.0, 0.0, 0.0), Rgb::new(0.0, 1.0, 0.0), Rgb::new(0.0, 0.0, 1.0)];
    let weights = [kr, kg, kb].map(|primary| f64::from(primary.luminance()));
    weights[0] * r + weights[1] * g + weights[2] * b
}
