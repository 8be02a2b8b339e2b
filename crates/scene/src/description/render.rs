//! How the picture is made.
//!
//! ```json
//! {"render": {"size": [640, 360], "samples": 16, "seed": 0, "integrator": "path"}}
//! ```

use juggler_camera::film::AnyFilter;
use juggler_camera::sampler::AnySampler;
use juggler_integrator::AnyIntegrator;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How the picture is made.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Render {
    /// Width and height in pixels.
    #[schemars(inner(range(min = 1, max = 65_536)))]
    pub size: [u32; 2],
    /// Samples per pixel.
    #[schemars(range(min = 1, max = 16_777_216))]
    pub samples: u32,
    /// Number that all random choices come from: another seed, another noise.
    pub seed: u64,
    /// Name of the camera; the first when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub camera: Option<CameraName>,
    /// When the shutter opens and closes, in frames from the frame's own time: what moves meanwhile is blurred.
    /// `[0, 0.5]` is a film camera's half turn; `[0, 0]`, the default, an instant.
    #[serde(skip_serializing_if = "is_instant")]
    #[schemars(inner(range(min = -1000, max = 1000)))]
    pub shutter: [f64; 2],
    /// How light is followed. Without it, `path` as soon as the scene holds anything that `classic` cannot light
    /// by or shade: an `emissive` material, an `area` light, an `environment` or a `sky`, a medium, any
    /// material but `phong` and what is made of it; else `classic`. `juggler info` says which, and why.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub integrator: Option<AnyIntegrator>,
    /// How samples are spread.
    pub sampler: AnySampler,
    /// How samples make a pixel.
    pub filter: AnyFilter,
}

impl Default for Render {
    fn default() -> Self {
        Self {
            size: [640, 360],
            samples: 16,
            seed: 0,
            camera: None,
            shutter: [0.0, 0.0],
            integrator: None,
            sampler: AnySampler::default(),
            filter: AnyFilter::default(),
        }
    }
}

fn is_instant(shutter: &[f64; 2]) -> bool {
    *shutter == [0.0, 0.0]
}

/// Name of one of the scene's cameras.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct CameraName(pub String);
