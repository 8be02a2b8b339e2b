//! Scenes and names to choose from, and small pictures of the built-in scenes, rendered when somebody first looks.

use crate::edits::{MAX_EDGE, MAX_PIXELS, MAX_SAMPLES};
use crate::picture::jpeg;
use axum::body::Bytes;
use juggler::imaging::AnyCurve;
use juggler::scene::{BuiltIn, Scene, built_in_scenes};
use juggler::tracer::integrator::AnyIntegrator;
use juggler::tracer::render::Control;
use juggler::tracer::sampler::AnySampler;
use juggler::{Picture, Settings};
use juggler_session::Channel;
use juggler_session::screen::Toner;
use serde_json::{Value, json};
use std::path::Path;
use tokio::sync::{OnceCell, Semaphore};

/// Width of a small picture in pixels.
const WIDTH: u32 = 192;
/// Most of its height.
const MAX_HEIGHT: u32 = 192;
/// Samples of its pixels.
const SAMPLES: u32 = 4;
/// Quality of its JPEG.
const QUALITY: u8 = 85;

/// What there is to choose from.
pub struct Catalogue {
    text: String,
    pictures: Vec<(BuiltIn, OnceCell<Option<Bytes>>)>,
    rendering: Semaphore,
}

impl Catalogue {
    /// Of the built-in scenes, and the scene file that the server was started with.
    pub fn new(scene: Option<&str>) -> Self {
        let pictures = built_in_scenes().iter().map(|scene| (*scene, OnceCell::new())).collect();
        Self { text: listing(scene).to_string(), pictures, rendering: Semaphore::new(1) }
    }

    /// All names, as JSON.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The small picture of a built-in scene, a JPEG. One is rendered at a time, on one thread.
    pub async fn thumbnail(&self, name: &str) -> Option<Bytes> {
        let (scene, cell) = self.pictures.iter().find(|(scene, _)| scene.name == name)?;
        let picture = cell.get_or_init(|| async {
            let _turn = self.rendering.acquire().await.ok()?;
            let name = scene.name;
            tokio::task::spawn_blocking(move || render(name)).await.ok()?.map(Bytes::from)
        });
        picture.await.clone()
    }
}

fn listing(scene: Option<&str>) -> Value {
    let of = |scene: &BuiltIn| {
        let title = Scene::built_in(scene.name).map(|scene| scene.description.title).unwrap_or_default();
        json!({"name": scene.name, "title": title, "description": scene.description()})
    };
    let file = scene.filter(|name| built_in_scenes().iter().all(|one| one.name != *name) || Path::new(name).exists());
    json!({
        "version": env!("CARGO_PKG_VERSION"),
        "scenes": built_in_scenes().iter().map(of).collect::<Vec<_>>(),
        "file": file.map(|name| json!({"name": name, "title": Path::new(name).file_name().map(|n| n.to_string_lossy())})),
        "integrators": juggler::names::<AnyIntegrator>(),
        "samplers": juggler::names::<AnySampler>(),
        "tones": juggler::names::<AnyCurve>(),
        "schedulers": ["work-stealing", "row-queue", "static-rows"],
        "channels": Channel::ALL,
        "most": {"edge": MAX_EDGE, "pixels": MAX_PIXELS, "samples": MAX_SAMPLES},
    })
}

/// On a thread of its own, so that the picture that somebody looks at keeps the others.
fn render(name: &str) -> Option<Vec<u8>> {
    let scene = Scene::built_in(name).ok()?;
    let [width, height] = scene.description.render.size.map(u64::from);
    let fitting = (u64::from(WIDTH) * height).checked_div(width)?.clamp(1, u64::from(MAX_HEIGHT));
    let size = [WIDTH, u32::try_from(fitting).ok()?];
    let settings = Settings { size: Some(size), samples: Some(SAMPLES), ..Settings::default() };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().ok()?;
    pool.install(|| {
        let picture = Picture::new(&scene, &settings).ok()?;
        let image = picture.image(&Control::default()).ok()?;
        let toner = Toner::new(picture.tone());
        let rgba: Vec<u8> = image.pixels().iter().flat_map(|pixel| toner.rgba(*pixel)).collect();
        jpeg(&rgba, u16::try_from(size[0]).ok()?, u16::try_from(size[1]).ok()?, QUALITY)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[tokio::test]
    async fn every_built_in_scene_is_listed_and_some_are_drawn() {
        let catalogue = Catalogue::new(Some("mine.json"));
        let listing: Value = serde_json::from_str(catalogue.text()).unwrap();
        assert_eq!(listing["scenes"].as_array().unwrap().len(), built_in_scenes().len());
        assert!(listing["scenes"].as_array().unwrap().iter().all(|scene| scene["title"] != ""));
        assert_eq!(listing["file"]["name"], "mine.json");
        assert!(listing["integrators"].as_array().unwrap().contains(&json!("classic")));
        assert_eq!(listing["channels"][0], "color");
        let first = catalogue.thumbnail("one-sphere").await.unwrap();
        assert_eq!(first[..2], [0xff, 0xd8]);
        assert_eq!(catalogue.thumbnail("one-sphere").await.unwrap().as_ptr(), first.as_ptr(), "rendered once");
        assert!(catalogue.thumbnail("../one-sphere").await.is_none());
    }
}
