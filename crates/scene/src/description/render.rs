//! Render settings.
//!
//! ```json
//! {"render": {"size": [640, 360], "samples": 16, "seed": 0, "integrator": "path"}}
//! ```

use juggler_camera::film::AnyFilter;
use juggler_camera::sampler::AnySampler;
use juggler_integrator::AnyIntegrator;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Render settings: image size, sampling, shutter and integrator.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Render {
    /// Width and height of the image in pixels; at most 2³¹ pixels in total.
    #[schemars(inner(range(min = 1, max = 65_536)), extend("x-unit" = "pixels"))]
    pub size: [u32; 2],
    /// Samples per pixel. Four times as many samples halve the noise and take four times as long.
    #[schemars(range(min = 1, max = 16_777_216), extend("x-unit" = "samples"))]
    pub samples: u32,
    /// Seed of the sampler. The same seed reproduces an image bit for bit; another seed gives other
    /// noise.
    pub seed: u64,
    /// Name of the camera to render with. Defaults to the first camera.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub camera: Option<CameraName>,
    /// Times at which the shutter opens and closes, in frames relative to the frame's own time, in
    /// this order. Motion in between is blurred. `[0, 0.5]` is the 180° shutter of a movie camera;
    /// the default `[0, 0]` disables motion blur.
    #[serde(skip_serializing_if = "is_instant")]
    #[schemars(inner(range(min = -1000, max = 1000)), extend("x-unit" = "frames"))]
    pub shutter: [f64; 2],
    /// Whether the background is transparent: the camera does not see it, also through glass, and
    /// PNG, WebP and EXR files store alpha. Its light stays.
    #[serde(skip_serializing_if = "is_false")]
    pub transparent: bool,
    /// Light transport algorithm. Defaults to `path` if the scene contains anything that `classic`
    /// does not support: an `emissive` material, an `area` light, an `environment` or a `sky`, a
    /// medium, any material except `phong` and combinations of it. Otherwise defaults to `classic`.
    /// `juggler info` prints the choice and its reason.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub integrator: Option<AnyIntegrator>,
    /// Sampler: distribution of the samples in pixel, lens, time and light dimensions.
    pub sampler: AnySampler,
    /// Reconstruction filter, which weights the samples near a pixel.
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
            transparent: false,
            integrator: None,
            sampler: AnySampler::default(),
            filter: AnyFilter::default(),
        }
    }
}

fn is_instant(shutter: &[f64; 2]) -> bool {
    *shutter == [0.0, 0.0]
}

/// Whether a flag has its default, `false`.
pub(super) fn is_false(flag: &bool) -> bool {
    !flag
}

/// Name of one of the scene's cameras.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct CameraName(pub String);
