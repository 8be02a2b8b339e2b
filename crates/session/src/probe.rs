//! What is known about one pixel.

use crate::screen::relative_error;
use crate::subject::Subject;
use juggler::camera::film::{Film, TILE};
use juggler::scene::compile::Part;
use serde::Serialize;

/// What is known about one pixel.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Probe {
    /// The pixel, from the top left.
    pub pixel: [u32; 2],
    /// Linear light, the mean of the samples so far, groups of lights mixed; nothing when there is none.
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

impl Probe {
    /// What a film of the subject's picture and one ray tell about a pixel.
    pub fn of(subject: &Subject, film: Option<&Film>, pixel: [u32; 2]) -> Self {
        let mut probe = Self { pixel, ..Self::default() };
        let [width, height] = subject.picture().size();
        let [x, y] = pixel;
        if x >= width || y >= height {
            return probe;
        }
        let place = |film: &Film| (y / TILE) as usize * film.layout().columns() as usize + (x / TILE) as usize;
        if let Some(tile) = film.and_then(|film| film.tile(place(film))) {
            let area = tile.pixels();
            let at = (y.saturating_sub(area.y) as usize) * area.width as usize + x.saturating_sub(area.x) as usize;
            probe.samples = tile.count();
            probe.color = subject
                .light(&tile, &subject.gains())
                .get(at)
                .filter(|_| tile.count() > 0)
                .map(|color| color.to_array());
            probe.noise = relative_error(&tile, at).map(|error| error as f32);
        }
        let center = pixel.map(|at| at as f32 + 0.5);
        let Some((point, vertex)) = subject.seen_at(center) else { return probe };
        let eye = subject.ray(center).origin;
        probe.depth = Some((point - eye).length());
        probe.position = Some(point.to_array());
        probe.normal = Some(vertex.surface.shading_normal.to_array());
        probe.object = Some(vertex.object);
        if let Some(part) = Part::of(&subject.scene().description, vertex.object) {
            probe.shape = Some(format!("{} {}", part.kind, part.path));
            probe.material = Some(part.material);
        }
        probe
    }
}
