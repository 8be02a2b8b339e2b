//! Interactive pixel probe.

use crate::screen::relative_error;
use crate::subject::Subject;
use juggler::camera::film::{Film, TILE_EDGE};
use juggler::scene::compile::ShapePlace;

/// Data of one pixel of the displayed image.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PixelInfo {
    /// Column and row, from the top left.
    pub pixel: [u32; 2],
    /// Linear RGB radiance, the mean of the samples so far, with light group gains applied; `None`
    /// without samples.
    pub color: Option<[f32; 3]>,
    /// Number of samples so far.
    pub samples: u32,
    /// Estimated relative error; `None` for fewer than two blocks of samples.
    pub noise: Option<f32>,
    /// Distance to the visible point at the pixel center, in scene units; `None` if the ray
    /// escapes, as are the members below.
    pub depth: Option<f32>,
    /// Visible point, in world space.
    pub position: Option<[f32; 3]>,
    /// Unit shading normal at that point, in world space.
    pub normal: Option<[f32; 3]>,
    /// Index of the visible object, as in the channel `objects`.
    pub object: Option<u32>,
    /// Kind of shape, and path of its description in the scene, such as `objects[3]`.
    pub shape: Option<String>,
    /// Name of the material, or the path of its description.
    pub material: Option<String>,
}

impl PixelInfo {
    /// Probes a pixel: reads the film and traces a ray through the pixel center.
    pub fn at_pixel(subject: &Subject, film: Option<&Film>, pixel: [u32; 2]) -> Self {
        let mut info = Self { pixel, ..Self::default() };
        let [width, height] = subject.picture().size();
        let [x, y] = pixel;
        if x >= width || y >= height {
            return info;
        }
        let place =
            |film: &Film| (y / TILE_EDGE) as usize * film.tiling().columns() as usize + (x / TILE_EDGE) as usize;
        if let Some(tile) = film.and_then(|film| film.tile(place(film))) {
            let area = tile.pixels();
            let at = (y.saturating_sub(area.y) as usize) * area.width as usize + x.saturating_sub(area.x) as usize;
            info.samples = tile.samples_per_pixel();
            info.color = subject
                .light(&tile, &subject.gains())
                .get(at)
                .filter(|_| tile.samples_per_pixel() > 0)
                .map(|color| color.to_array());
            info.noise = relative_error(&tile, at).map(|error| error as f32);
        }
        let center = pixel.map(|at| at as f32 + 0.5);
        let Some((point, vertex)) = subject.pick(center) else { return info };
        let eye = subject.ray(center).origin;
        info.depth = Some((point - eye).length());
        info.position = Some(point.to_array());
        info.normal = Some(vertex.surface.shading_normal.to_array());
        info.object = Some(vertex.shape);
        if let Some(part) = ShapePlace::find(&subject.scene().description, vertex.shape) {
            info.shape = Some(format!("{} {}", part.kind, part.path));
            info.material = Some(part.material);
        }
        info
    }
}
