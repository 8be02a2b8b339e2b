//! Preview frames: one camera ray through the center of each pixel, at any resolution.

use crate::edit::Channel;
use crate::screen::{Preview, index_color};
use juggler::camera::aov::{self, LightGroup};
use juggler::camera::film::{Film, Rect, Tiling};
use juggler::integrator::{Albedo, Depth, Integrator, Normals, PathState, VertexOutput};
use juggler::math::{Ray, Rgb, UVec2};
use juggler::render::{self, Cancelled, Control, Job, Schedule, Scheduler, StopCriterion};
use juggler::world::{Vertex, World};
use juggler::{AovSet, Picture};

/// Integrator that maps object or material indices to colors.
enum IndexColors {
    Objects,
    Materials,
}

impl Integrator for IndexColors {
    fn vertex(&self, _world: &World, _ray: &Ray, _path: &PathState, vertex: &Vertex, output: &mut VertexOutput) {
        let number = match self {
            Self::Objects => vertex.shape,
            Self::Materials => vertex.material.0,
        };
        output.add(index_color(number), LightGroup::REST);
    }
}

/// Renders one sample per pixel into a film, which has light groups and alpha. The light groups are scaled
/// by their gains, if there are any.
fn developed(job: &Job, region: Rect, layers: &AovSet, gains: &[Rgb], control: &Control) -> Result<Preview, Cancelled> {
    let film = Film::new(Tiling::new(region), 0..1);
    render::render_progressive(job, &film, StopCriterion::Samples, control)?;
    let mut pixels = vec![Rgb::BLACK; region.area() as usize];
    let mut alpha = layers.is_transparent().then(|| vec![0.0; pixels.len()]);
    for (_, tile) in film.tiles() {
        let area = tile.pixels();
        let colors = if gains.is_empty() { tile.means() } else { layers.relight(&tile, gains) };
        area.copy_into(&colors, &region, &mut pixels);
        let own = layers.alpha(&area, std::slice::from_ref(&tile));
        own.iter().zip(&mut alpha).for_each(|(own, all)| area.copy_into(own, &region, all));
    }
    Ok(Preview { size: [region.width, region.height], pixels, alpha })
}

/// Renders a preview of `size` pixels with one ray per pixel, on the threads of the current rayon
/// pool. `gains` are the factors of the light groups; an empty slice leaves them unscaled. The
/// channels `samples` and `noise` describe a film, so they render as `color` here.
pub fn render_preview(
    picture: &Picture,
    size: [u32; 2],
    channel: Channel,
    gains: &[Rgb],
    scheduler: Scheduler,
    control: &Control,
) -> Result<Preview, Cancelled> {
    let job = picture.job();
    let [width, height] = size;
    let camera = job.camera.resampled(UVec2::from_array(picture.size()), UVec2::new(width, height));
    let integrator: &dyn Integrator = match channel {
        Channel::Color | Channel::Samples | Channel::Noise => job.integrator,
        Channel::Albedo => &Albedo {},
        Channel::Normals => &Normals {},
        Channel::Depth => &Depth { far: None },
        Channel::Objects => &IndexColors::Objects,
        Channel::Materials => &IndexColors::Materials,
    };
    let job = Job { camera: &camera, integrator, samples: 1, ..job };
    let region = Rect { x: 0, y: 0, width, height };
    let needs_film = !gains.is_empty() || picture.aovs().is_transparent();
    if needs_film && channel.is_light() {
        return developed(&job, region, picture.aovs(), gains, control);
    }
    let job = Job { aovs: &aov::NO_AOVS, ..job };
    let mut pixels = Vec::new();
    let schedule = Schedule { scheduler, ..Schedule::default() };
    render::render(&job, region, schedule, control, |rows| {
        if pixels.is_empty() {
            // The first band usually is the whole image.
            pixels = rows;
        } else {
            pixels.extend(rows);
        }
        Ok::<(), Cancelled>(())
    })?;
    if channel == Channel::Depth {
        let far = pixels.iter().fold(0.0, |far: f32, pixel| far.max(pixel.r));
        let scale = if far > 0.0 { 1.0 / far } else { 0.0 };
        pixels.iter_mut().for_each(|pixel| *pixel = *pixel * scale);
    }
    Ok(Preview { size, pixels, alpha: None })
}
