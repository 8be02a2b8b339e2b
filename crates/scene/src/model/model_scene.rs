//! A scene that shows a model file that was given in place of a scene.

use super::model_light::background;
use super::{ModelChoice, ModelFile};
use crate::description::{Animation, Description, Model, Object, Render};
use crate::item::Item;
use juggler_imaging::{AnyCurve, Tone};
use juggler_integrator::Path as PathIntegrator;
use juggler_math::Vec3;
use std::path::Path;

/// Frames per second of a model's movie.
const FRAMES_PER_SECOND: f64 = 30.0;
/// Width of the picture in pixels.
const WIDTH: u32 = 960;
/// Height of the picture in pixels if no camera of the file has an aspect.
const HEIGHT: u32 = 720;
/// Largest height in pixels.
const MAX_HEIGHT: f32 = 3840.0;

/// Describes a scene that shows the model in `file`.
pub fn describe_model_scene(file: &str, model: &dyn ModelFile) -> Description {
    let title = Path::new(file).file_stem().map_or_else(|| file.to_owned(), |stem| stem.to_string_lossy().into_owned());
    // Errors of the content are reported when the scene is checked.
    let summary = model.summary(&ModelChoice::default()).unwrap_or_default();
    let aspect = summary.cameras.iter().find_map(|(_, aspect)| *aspect).filter(|aspect| *aspect > 0.0);
    let height = aspect.map_or(HEIGHT, |aspect| (WIDTH as f32 / aspect).round().clamp(1.0, MAX_HEIGHT) as u32);
    let seconds = summary.clip.and_then(|clip| summary.clips.get(clip)).map_or(0.0, |clip| clip.seconds);
    let render = Render {
        size: [WIDTH, height],
        samples: 64,
        integrator: Some(PathIntegrator::default().into()),
        ..Render::default()
    };
    let mut scene = Description {
        description: format!("Scene generated for the model {file}"),
        title: title.clone(),
        render: render.into(),
        tone: Tone { curve: AnyCurve::PbrNeutral(Default::default()), ..Tone::default() }.into(),
        animation: Animation { frames: frames_of(seconds), frames_per_second: FRAMES_PER_SECOND },
        background: background(&summary).map(Item::from),
        ..Description::default()
    };
    let object = Object::model(Model::new(file)).named(title);
    let object = if model.is_z_up() { object.rotated(Vec3::X, -90.0) } else { object };
    scene.objects.push(object.into());
    scene
}

/// Frames of a clip; 1 without clip.
pub fn frames_of(seconds: f64) -> u32 {
    (seconds * FRAMES_PER_SECOND).round().clamp(1.0, 1e6) as u32
}
