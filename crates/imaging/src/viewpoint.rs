//! Camera matrices stored with an image.

use serde::Serialize;

/// Matrix in row-vector convention: `[x, y, z, 1]` times the matrix, divided by the fourth
/// component of the product.
pub type Matrix4 = [[f32; 4]; 4];

/// Camera matrices as defined by OpenEXR's standard attributes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Viewpoint {
    /// World space to camera space, in scene units: x to the right, y up, z into the image.
    pub world_to_camera: Matrix4,
    /// World space to image coordinates: (0, 0) is the upper left corner, (1, 1) the lower right
    /// one.
    pub world_to_ndc: Matrix4,
}
