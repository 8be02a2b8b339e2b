//! Where the camera stood that a picture was taken with.

use serde::Serialize;

/// A matrix that row vectors are multiplied by: `[x, y, z, 1]` times it, and the last of the four numbers divides the others.
pub type Matrix4 = [[f32; 4]; 4];

/// Where the camera stood that a picture was taken with, as OpenEXR's standard attributes have it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Viewpoint {
    /// From the world to the camera: x to the picture's right, y to its top, z into it, in scene units.
    pub world_to_camera: Matrix4,
    /// From the world to the file's pixels: (0, 0) is its upper left corner and (1, 1) its lower right one.
    pub world_to_ndc: Matrix4,
}
