//! Statistics of a render.

use juggler_camera::film::FilmSummary;
use juggler_film::counts::SampleCountStats;
use juggler_render::RayCounts;
use std::time::Duration;

/// Statistics of a finished render.
#[derive(Clone, Debug, PartialEq)]
pub struct RenderStats {
    /// Hash and mean of the linear pixels.
    pub film: FilmSummary,
    /// Samples per pixel.
    pub samples: SampleCountStats,
    /// Number of traced rays.
    pub rays: RayCounts,
    /// Time spent on tracing rays.
    pub render: Duration,
    /// Time spent on denoising.
    pub denoise: Duration,
    /// Time spent on encoding and writing.
    pub write: Duration,
}
