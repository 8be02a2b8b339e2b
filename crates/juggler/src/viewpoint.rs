//! From where a picture is taken, for its file.

use crate::Picture;
use juggler_camera::{Finder, Matrix};
use juggler_imaging::{Matrix4, Viewpoint};

/// Of the time that the shutter is open, where the camera is told to stand: half way.
const MIDDLE: f32 = 0.5;

impl Picture {
    /// From where it is taken, half way between opening and closing of the shutter. Its pixels are those of the file: of the crop when
    /// there is one.
    pub fn viewpoint(&self) -> Option<Viewpoint> {
        let (projection, region) = (self.job().camera.at(MIDDLE), self.region());
        let mut matrix = Finder::new(&projection)?.matrix();
        for row in &mut matrix {
            row[0] = (row[0] - row[3] * f64::from(region.x)) / f64::from(region.width);
            row[1] = (row[1] - row[3] * f64::from(region.y)) / f64::from(region.height);
        }
        let (world_to_camera, world_to_ndc) = (rounded(projection.to_camera()), rounded(matrix));
        let is_finite = |matrix: &Matrix4| matrix.iter().flatten().all(|number| number.is_finite());
        [world_to_camera, world_to_ndc].iter().all(is_finite).then_some(Viewpoint { world_to_camera, world_to_ndc })
    }
}

fn rounded(matrix: Matrix) -> Matrix4 {
    // Nothing is below nothing: zeros have no sign.
    matrix.map(|row| row.map(|number| number as f32 + 0.0))
}
