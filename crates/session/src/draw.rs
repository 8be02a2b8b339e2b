//! One look at a world: a ray through the centre of each pixel, coarse or not.

use crate::Channel;
use crate::screen::{Draft, color_of};
use juggler::camera::film::{Film, Layout, Rect};
use juggler::camera::layer::{self, LightGroup};
use juggler::integrator::{Albedo, Depth, Emit, Integrator, Normals, PathState};
use juggler::math::{Ray, Rgb, UVec2};
use juggler::render::{self, Control, Job, Schedule, Scheduler, Stop, Stopped};
use juggler::world::{Vertex, World};
use juggler::{LayerSet, Picture};

/// Numbers of objects, or of materials, as colours.
enum Numbers {
    Objects,
    Materials,
}

impl Integrator for Numbers {
    fn vertex(&self, _world: &World, _ray: &Ray, _path: &PathState, vertex: &Vertex, emit: &mut Emit) {
        let number = match self {
            Self::Objects => vertex.object,
            Self::Materials => vertex.material.0,
        };
        emit.add(color_of(number), LightGroup::REST);
    }
}

/// The picture with the light of groups times their gains, one sample a pixel.
fn relit(job: &Job, region: Rect, layers: &LayerSet, gains: &[Rgb], control: &Control) -> Result<Vec<Rgb>, Stopped> {
    let film = Film::new(Layout::new(region), 0..1);
    render::expose(job, &film, Stop::Samples, control)?;
    let mut pixels = vec![Rgb::BLACK; region.area() as usize];
    film.tiles().for_each(|(_, tile)| tile.pixels().copy(&layers.relit(&tile, gains), &region, &mut pixels));
    Ok(pixels)
}

/// Renders `size` pixels of a picture, one ray each, on the threads of the current rayon pool. The channels `samples`
/// and `noise` are of films: here they are the picture itself. Where there are `gains`, groups of lights are mixed by them.
pub fn draw(
    picture: &Picture,
    size: [u32; 2],
    channel: Channel,
    gains: &[Rgb],
    scheduler: Scheduler,
    control: &Control,
) -> Result<Draft, Stopped> {
    let job = picture.job();
    let [width, height] = size;
    let camera = job.camera.resampled(UVec2::from_array(picture.size()), UVec2::new(width, height));
    let integrator: &dyn Integrator = match channel {
        Channel::Color | Channel::Samples | Channel::Noise => job.integrator,
        Channel::Albedo => &Albedo {},
        Channel::Normals => &Normals {},
        Channel::Depth => &Depth { far: None },
        Channel::Objects => &Numbers::Objects,
        Channel::Materials => &Numbers::Materials,
    };
    let job = Job { camera: &camera, integrator, samples: 1, ..job };
    let region = Rect { x: 0, y: 0, width, height };
    if !gains.is_empty() && channel.is_light() {
        return Ok(Draft { size, pixels: relit(&job, region, picture.layers(), gains, control)? });
    }
    let job = Job { layers: &layer::NONE, ..job };
    let mut pixels = Vec::new();
    let schedule = Schedule { scheduler, ..Schedule::default() };
    render::render(&job, region, schedule, control, |rows| {
        if pixels.is_empty() {
            // All of it, mostly.
            pixels = rows;
        } else {
            pixels.extend(rows);
        }
        Ok::<(), Stopped>(())
    })?;
    if channel == Channel::Depth {
        let far = pixels.iter().fold(0.0, |far: f32, pixel| far.max(pixel.r));
        let scale = if far > 0.0 { 1.0 / far } else { 0.0 };
        pixels.iter_mut().for_each(|pixel| *pixel = *pixel * scale);
    }
    Ok(Draft { size, pixels })
}
