//! `--stats`: a JSON object about a render, whose keys are a stable interface for scripts.

use juggler::camera::film::FilmSummary;
use juggler::film::counts::SampleCountStats;
use juggler::imaging::Viewpoint;
use juggler::render::RayCounts;
use juggler::world::simd_levels;
use juggler::{Limit, Picture, RenderStats};
use serde::Serialize;
use serde_json::Value;

/// Statistics of a render.
#[derive(Debug, Serialize)]
pub struct Stats<'s> {
    version: u32,
    program: ProgramStats,
    scene: &'s str,
    size: [u32; 2],
    /// Samples per pixel; the maximum if they vary.
    samples: u32,
    /// Numbers of samples per pixel, if a noise level or a time limit ended the render.
    #[serde(skip_serializing_if = "Option::is_none")]
    samples_per_pixel: Option<SampleCountStats>,
    threads: usize,
    integrator: &'s str,
    integrator_reason: String,
    seconds: Seconds,
    rays: RayStats,
    geometry: GeometryStats,
    memory: MemoryStats,
    film: FilmStats<'s>,
    /// Camera matrices.
    camera: Value,
    fingerprint: String,
}

/// Times of the phases, in seconds.
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
    /// All phases.
    pub total: f64,
    /// CPU time of all threads for rendering, removing noise, encoding and writing.
    pub cpu: f64,
}

/// The program itself.
#[derive(Debug, Serialize)]
struct ProgramStats {
    version: &'static str,
    /// Compiler of the program with its version.
    compiler: &'static str,
    /// Vector instructions that the program uses, such as `avx2`.
    simd: String,
}

#[derive(Debug, Serialize)]
struct RayStats {
    camera: u64,
    shadow: u64,
    secondary: u64,
    total: u64,
    per_second: f64,
    /// Samples of this run that were NaN, infinite or beyond 10^36, and count as black.
    not_finite: u64,
}

#[derive(Debug, Serialize)]
struct GeometryStats {
    shapes: u64,
    triangles: u64,
    unique_triangles: u64,
    instances: u64,
    lights: usize,
}

#[derive(Debug, Serialize)]
struct FilmStats<'s> {
    mean: [f64; 3],
    hash: &'s str,
    #[serde(skip_serializing_if = "Option::is_none")]
    clamped: Option<ClampStats>,
}

/// Radiance that clamping removed.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct ClampStats {
    /// Mean over all pixels and channels.
    mean: f64,
    /// Fraction of the total, 0 to 1.
    share: f64,
}

impl ClampStats {
    /// Clamping of a picture.
    pub fn of(film: &FilmSummary) -> Self {
        Self { mean: film.clamped, share: film.clamped_fraction() }
    }
}

#[derive(Debug, Serialize)]
struct MemoryStats {
    peak_rss_bytes: Option<u64>,
    expected_bytes: Option<u64>,
    geometry_bytes: usize,
    bvh_bytes: usize,
}

impl ProgramStats {
    fn new() -> Self {
        // The name of the level, without the fields of its debug text.
        let level = simd_levels().last().map(|level| format!("{level:?}")).unwrap_or_default();
        let name = level.split('(').next().unwrap_or_default();
        Self { version: env!("CARGO_PKG_VERSION"), compiler: env!("JUGGLER_COMPILER"), simd: name.to_ascii_lowercase() }
    }
}

impl RayStats {
    fn new(rays: &RayCounts, seconds: f64) -> Self {
        Self {
            camera: rays.camera,
            shadow: rays.shadow,
            secondary: rays.secondary,
            total: rays.total(),
            per_second: rays_per_second(rays, seconds),
            not_finite: rays.not_finite,
        }
    }
}

impl<'s> Stats<'s> {
    /// Statistics of a finished picture.
    pub fn new(
        scene: &'s str,
        picture: &'s Picture,
        threads: usize,
        seconds: Seconds,
        outcome: &'s RenderStats,
    ) -> Self {
        let RenderStats { rays, film, .. } = outcome;
        let geometry = picture.world().geometry_stats();
        Self {
            version: 1,
            program: ProgramStats::new(),
            scene,
            size: picture.size(),
            samples: outcome.samples.max,
            samples_per_pixel: (*picture.limit() != Limit::Samples).then_some(outcome.samples),
            threads,
            integrator: picture.integrator().name(),
            integrator_reason: picture.compiled().integrator.reason.to_string(),
            seconds,
            rays: RayStats::new(rays, seconds.render),
            geometry: GeometryStats {
                shapes: geometry.shapes,
                triangles: geometry.triangles,
                unique_triangles: geometry.unique_triangles,
                instances: geometry.instances,
                lights: geometry.lights,
            },
            memory: MemoryStats {
                peak_rss_bytes: peak_rss_bytes(),
                expected_bytes: None,
                geometry_bytes: geometry.geometry_bytes,
                bvh_bytes: geometry.bvh_bytes,
            },
            film: FilmStats {
                mean: film.mean,
                hash: &film.hash,
                clamped: picture.is_clamped().then(|| ClampStats::of(film)),
            },
            camera: camera(picture.viewpoint().as_ref()),
            fingerprint: picture.fingerprint().hash(),
        }
    }

    /// Sets the memory estimate made before the world was built, in bytes.
    pub fn expected_memory(&mut self, bytes: u64) {
        self.memory.expected_bytes = Some(bytes);
    }

    /// JSON object on one line.
    pub fn to_json(&self) -> String {
        serde_json::to_string(self).unwrap_or_default()
    }
}

/// Camera matrices as JSON, with the shortest decimal form of each `f32`.
pub fn camera(viewpoint: Option<&Viewpoint>) -> Value {
    let text = serde_json::to_string(&viewpoint).unwrap_or_default();
    serde_json::from_str(&text).unwrap_or_default()
}

/// Rays per second of rendering.
pub fn rays_per_second(rays: &RayCounts, seconds: f64) -> f64 {
    rays.total() as f64 / seconds.max(1e-9)
}

/// Peak resident memory of the process in bytes, if the system reports it.
fn peak_rss_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()?.checked_mul(1024)
}
