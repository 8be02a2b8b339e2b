//! Viewpoint metadata of image files.

use crate::Picture;
use juggler_camera::{Matrix, WorldToFilm};
use juggler_imaging::{Matrix4, Viewpoint};

/// Shutter time of the viewpoint, from 0 (open) to 1 (closed).
const SHUTTER_CENTER: f32 = 0.5;

impl Picture {
    /// Returns the camera matrices at the middle of the shutter interval, relative to the whole frame,
    /// which is the display window of an EXR file. `None` for a camera without finite matrices.
    pub fn viewpoint(&self) -> Option<Viewpoint> {
        let projection = self.job().camera.projection_at(SHUTTER_CENTER);
        let [width, height] = self.frame_size().map(f64::from);
        let mut matrix = WorldToFilm::new(&projection)?.matrix();
        for row in &mut matrix {
            row[0] /= width;
            row[1] /= height;
        }
        let (world_to_camera, world_to_ndc) = (rounded(projection.to_camera()), rounded(matrix));
        let is_finite = |matrix: &Matrix4| matrix.iter().flatten().all(|number| number.is_finite());
        [world_to_camera, world_to_ndc].iter().all(is_finite).then_some(Viewpoint { world_to_camera, world_to_ndc })
    }
}

fn rounded(matrix: Matrix) -> Matrix4 {
    // Adding 0 turns negative zeros positive.
    matrix.map(|row| row.map(|number| number as f32 + 0.0))
}
