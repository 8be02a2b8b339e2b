//! What is known about one pixel.

use serde::Serialize;

/// What is known about one pixel.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Probe {
    /// The pixel, from the top left.
    pub pixel: [u32; 2],
    /// Linear light, the mean of the samples so far; nothing when there is none.
    pub color: Option<[f32; 3]>,
    /// Samples so far.
    pub samples: u32,
    /// Estimated relative error, when there are enough samples.
    pub noise: Option<f32>,
    /// Distance to what is seen through the pixel's centre, scene units; the rest is nothing when that is nothing.
    pub depth: Option<f32>,
    /// Where that is.
    pub position: Option<[f32; 3]>,
    /// Its shading normal.
    pub normal: Option<[f32; 3]>,
    /// Its number, as the channel `objects` counts.
    pub object: Option<u32>,
    /// The kind of shape, and the place in the scene where the object is described, such as `objects[3]`.
    pub shape: Option<String>,
    /// The material's name, or where it is described.
    pub material: Option<String>,
}
