//! Scenes that are built, and renders of them.

use crate::denoise::library;
use crate::settings::RenderSettings;
use crate::task::{Fault, Monitor};
use juggler::camera::film::Film;
use juggler::memory::Effort;
use juggler::render::{Control, estimate_noise};
use juggler::scene::Scene;
use juggler::{BuildControl, Error, Limit, Picture, RenderedImage, Settings};
use std::sync::Arc;
use std::time::Instant;

/// Scene with its world, at one frame and with all settings.
pub struct Built {
    /// The scene that was built, with the settings applied.
    pub scene: Scene,
    /// World, camera and settings.
    pub picture: Picture,
    /// Frame.
    pub frame: f64,
}

/// Frame that the settings select, which may lie between two.
pub fn frame(scene: &Scene, settings: &RenderSettings) -> f64 {
    settings.at.map_or(settings.frame, |seconds| seconds * scene.description.animation.frames_per_second)
}

/// Builds a scene at a frame, unless `control` is cancelled. The world of `before` is reused where it
/// still holds.
pub fn build(
    scene: &Scene,
    frame: f64,
    settings: &Settings,
    before: Option<Arc<Built>>,
    control: &BuildControl,
) -> Result<Arc<Built>, Error> {
    let moved = if frame == 0.0 { scene.clone() } else { scene.at_frame(frame)? };
    // Apply the shutter first, since it decides what moves.
    let scene = settings.apply(&moved)?;
    if settings.denoiser.is_some() && scene.description.render.samples < 2 {
        let message = "`denoise` needs at least 2 samples per pixel to estimate the noise";
        return Err(Error::setting("denoise", message));
    }
    let before = before.filter(|before| before.frame == frame || scene.has_world_of(&before.scene));
    let picture = match &before {
        Some(before) if before.frame == frame && before.scene == scene => return Ok(Arc::clone(before)),
        Some(before) => before.picture.rebuild_with_control(&before.scene, &scene, settings, control)?,
        None => Picture::new_with_control(&scene, settings, control)?,
    };
    Ok(Arc::new(Built { scene, picture, frame }))
}

/// Renders into memory, and reports the progress.
pub fn render(built: &Built, effort: &Effort, monitor: &Monitor) -> Result<RenderedImage, Fault> {
    let picture = &built.picture;
    if picture.needs_film() {
        let (film, start) = (Arc::new(picture.film()), Instant::now());
        return finish(picture, &film, start, monitor);
    }
    let picture = picture.clone().with_band_pixels(effort.band_pixels);
    monitor.set_estimate(of_samples(picture.total_samples(), Instant::now()));
    Ok(picture.render_in_memory(None, &monitor.control)?)
}

/// Renders what a film lacks, and develops it.
pub fn finish(picture: &Picture, film: &Arc<Film>, start: Instant, monitor: &Monitor) -> Result<RenderedImage, Fault> {
    let missing = film.requested_samples().saturating_sub(film.samples());
    match *picture.limit() {
        Limit::Samples => monitor.set_estimate(of_samples(missing, start)),
        Limit::Time { seconds } => monitor.set_estimate(move |_| {
            let left = (seconds - start.elapsed().as_secs_f64()).max(0.0);
            (1.0 - left / seconds, Some(left))
        }),
        Limit::Noise(level) => {
            let film = Arc::clone(film);
            monitor.set_estimate(move |_| {
                let share = estimate_noise(&film, level).map_or(0.0, |so_far| so_far.fraction);
                (share, seconds_left(share, start))
            });
        }
    }
    picture.render_to_limit(film, &monitor.control)?;
    let library = library();
    Ok(picture.develop_in_memory(film, start.elapsed(), library.as_deref(), &monitor.control)?)
}

/// Progress of a render of this many samples.
fn of_samples(total: u64, start: Instant) -> impl Fn(&Control) -> (f64, Option<f64>) + Send {
    move |control| {
        let share = control.samples() as f64 / total.max(1) as f64;
        (share, seconds_left(share, start))
    }
}

fn seconds_left(share: f64, start: Instant) -> Option<f64> {
    (share > 0.0).then(|| start.elapsed().as_secs_f64() * (1.0 - share).max(0.0) / share)
}
