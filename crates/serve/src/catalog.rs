//! Scenes and names to choose from.

use crate::edits::{MAX_EDGE, MAX_PIXELS, MAX_SAMPLES};
use juggler::camera::sampler::SamplerKind;
use juggler::imaging::ToneCurveKind;
use juggler::integrator::IntegratorKind;
use juggler::math::NamedKind;
use juggler::render::Scheduler;
use juggler::scene::{BuiltIn, Scene, built_in_scenes};
use juggler_session::Channel;
use serde_json::{Value, json};
use std::path::Path;

/// Scenes, integrators, samplers, tone curves and limits, as JSON.
pub struct Catalog {
    text: String,
}

impl Catalog {
    /// Lists the built-in scenes, the scene file with which the server was started, and the maximum
    /// size of dropped files.
    pub fn new(scene: Option<&str>, dropped_bytes: u64) -> Self {
        Self { text: listing(scene, dropped_bytes).to_string() }
    }

    /// Returns the JSON text.
    pub fn text(&self) -> &str {
        &self.text
    }
}

fn listing(scene: Option<&str>, dropped_bytes: u64) -> Value {
    let of = |scene: &BuiltIn| {
        let title = Scene::built_in(scene.name).map(|scene| scene.description.title).unwrap_or_default();
        json!({"name": scene.name, "title": title, "description": scene.description()})
    };
    let file = scene.filter(|name| built_in_scenes().iter().all(|one| one.name != *name) || Path::new(name).exists());
    json!({
        "version": env!("CARGO_PKG_VERSION"),
        "scenes": built_in_scenes().iter().map(of).collect::<Vec<_>>(),
        "file": file.map(|name| json!({"name": name, "title": Path::new(name).file_name().map(|n| n.to_string_lossy())})),
        "integrators": names::<IntegratorKind>(),
        "samplers": names::<SamplerKind>(),
        "tones": names::<ToneCurveKind>(),
        "schedulers": names::<Scheduler>(),
        "channels": Channel::ALL,
        "most": {"edge": MAX_EDGE, "pixels": MAX_PIXELS, "samples": MAX_SAMPLES, "upload": dropped_bytes},
    })
}

fn names<Kind: NamedKind>() -> Vec<&'static str> {
    juggler::names::<Kind>().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds_and_channels_are_listed_by_name() {
        let listing: Value = serde_json::from_str(Catalog::new(None, 7).text()).unwrap();
        let integrators = ["classic", "path", "direct", "ambient_occlusion", "albedo", "normals", "depth"];
        assert_eq!(listing["integrators"], json!(integrators));
        assert_eq!(listing["samplers"], json!(["sobol", "stratified", "independent", "blue_noise"]));
        assert_eq!(listing["tones"], json!(["srgb", "gamma", "linear", "reinhard", "aces", "agx", "pbr_neutral"]));
        assert_eq!(listing["schedulers"], json!(["work-stealing", "row-queue", "static-rows"]));
        let channels = ["color", "albedo", "normals", "depth", "objects", "materials", "samples", "noise"];
        assert_eq!(listing["channels"], json!(channels));
    }

    #[test]
    fn every_built_in_scene_is_listed() {
        let catalog = Catalog::new(Some("mine.json"), 7);
        let listing: Value = serde_json::from_str(catalog.text()).unwrap();
        assert_eq!(listing["scenes"].as_array().unwrap().len(), built_in_scenes().len());
        assert!(listing["scenes"].as_array().unwrap().iter().all(|scene| scene["title"] != ""));
        assert_eq!(listing["file"]["name"], "mine.json");
        assert!(listing["integrators"].as_array().unwrap().contains(&json!("classic")));
        assert_eq!((&listing["channels"][0], &listing["most"]["upload"]), (&json!("color"), &json!(7)));
    }
}
