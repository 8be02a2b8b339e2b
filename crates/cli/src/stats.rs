//! `--stats`: one JSON object about a render, with the keys that other people's scripts read.

use juggler::camera::film::Summary;
use juggler::film::counts::Spread;
use juggler::imaging::Viewpoint;
use juggler::render::Rays;
use juggler::{Limit, Outcome, Picture};
use serde::Serialize;
use serde_json::Value;

/// All of it.
#[derive(Debug, Serialize)]
pub struct Stats<'s> {
    version: u32,
    scene: &'s str,
    size: [u32; 2],
    /// Of a pixel, or the most of them.
    samples: u32,
    /// Where noise or time ends the picture.
    #[serde(skip_serializing_if = "Option::is_none")]
    samples_per_pixel: Option<Spread>,
    threads: usize,
    integrator: &'s str,
    integrator_reason: String,
    seconds: Seconds,
    rays: RayCounts,
    geometry: Geometry,
    memory: Memory,
    film: Film<'s>,
    /// From where the picture was taken.
    camera: Value,
    fingerprint: String,
}

/// How long each part took.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Seconds {
    /// Reading files.
    pub load: f64,
    /// Building the world.
    pub build: f64,
    /// Tracing rays.
    pub render: f64,
    /// Removing noise.
    pub denoise: f64,
    /// Encoding and writing the picture.
    pub write: f64,
    /// All of it.
    pub total: f64,
}

#[derive(Debug, Serialize)]
struct RayCounts {
    camera: u64,
    shadow: u64,
    secondary: u64,
    total: u64,
    per_second: f64,
    /// Samples of this run that were NaN, infinite or beyond 10^36, and count as black.
    not_finite: u64,
}

#[derive(Debug, Serialize)]
struct Geometry {
    shapes: u64,
    triangles: u64,
    unique_triangles: u64,
    instances: u64,
    lights: usize,
}

#[derive(Debug, Serialize)]
struct Film<'s> {
    mean: [f64; 3],
    hash: &'s str,
    #[serde(skip_serializing_if = "Option::is_none")]
    clamped: Option<Clamped>,
}

/// What clamping took away, where it is on.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Clamped {
    /// Off a pixel, the mean of all pixels and channels.
    mean: f64,
    /// Of all the light.
    share: f64,
}

impl Clamped {
    /// Of a picture that is clamped.
    pub fn of(film: &Summary) -> Self {
        Self { mean: film.clamped, share: film.clamped_share() }
    }
}

#[derive(Debug, Serialize)]
struct Memory {
    peak_rss_bytes: Option<u64>,
    expected_bytes: Option<u64>,
    geometry_bytes: usize,
    bvh_bytes: usize,
}

impl<'s> Stats<'s> {
    /// Of a finished picture.
    pub fn new(scene: &'s str, picture: &'s Picture, threads: usize, seconds: Seconds, outcome: &'s Outcome) -> Self {
        let Outcome { rays, film, .. } = outcome;
        let geometry = picture.world().geometry();
        Self {
            version: 1,
            scene,
            size: picture.size(),
            samples: outcome.samples.max,
            samples_per_pixel: (*picture.limit() != Limit::Samples).then_some(outcome.samples),
            threads,
            integrator: picture.integrator().name(),
            integrator_reason: picture.compiled().integrator.reason.to_string(),
            seconds,
            rays: RayCounts {
                camera: rays.camera,
                shadow: rays.shadow,
                secondary: rays.secondary,
                total: rays.total(),
                per_second: rays_per_second(rays, seconds.render),
                not_finite: rays.not_finite,
            },
            geometry: Geometry {
                shapes: geometry.shapes,
                triangles: geometry.triangles,
                unique_triangles: geometry.unique_triangles,
                instances: geometry.instances,
                lights: geometry.lights,
            },
            memory: Memory {
                peak_rss_bytes: peak_rss_bytes(),
                expected_bytes: None,
                geometry_bytes: geometry.geometry_bytes,
                bvh_bytes: geometry.bvh_bytes,
            },
            film: Film { mean: film.mean, hash: &film.hash, clamped: picture.is_clamped().then(|| Clamped::of(film)) },
            camera: camera(picture.viewpoint().as_ref()),
            fingerprint: picture.fingerprint().hash(),
        }
    }

    /// With the bytes that were thought to be needed before the world was built.
    pub fn expected_memory(&mut self, bytes: u64) {
        self.memory.expected_bytes = Some(bytes);
    }

    /// The object on one line.
    pub fn to_json(&self) -> String {
        serde_json::to_string(self).unwrap_or_default()
    }
}

/// From where a picture was taken: its matrices, each number as short as singles allow.
pub fn camera(viewpoint: Option<&Viewpoint>) -> Value {
    let text = serde_json::to_string(&viewpoint).unwrap_or_default();
    serde_json::from_str(&text).unwrap_or_default()
}

/// Rays a second of rendering.
pub fn rays_per_second(rays: &Rays, seconds: f64) -> f64 {
    rays.total() as f64 / seconds.max(1e-9)
}

/// The most memory that the process ever held, where the system says so.
fn peak_rss_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()?.checked_mul(1024)
}
