//! A worker's renderer: its own copy of the scene, and its share of the image.

use crate::compositor::RenderInfo;
use crate::pixel_rects::PixelRects;
use crate::share::WorkerShare;
use crate::worker_film::{WorkerFilm, coarse};
use juggler::Picture;
use juggler::imaging::Options;
use juggler::scene::Bundle;
use juggler_session::wire::EditMessage;
use juggler_session::{BuildRequest, Edit, EditEffect, Subject};
use serde::Serialize;
use std::sync::Arc;

/// Renderer of one share of an image.
pub struct WorkerRenderer {
    share: WorkerShare,
    scene: Option<OpenScene>,
}

/// Open scene and its rendering.
struct OpenScene {
    subject: Subject,
    film: WorkerFilm,
}

/// Status for the page's panel.
#[derive(Serialize)]
struct WorkerStatus {
    #[serde(rename = "outline")]
    info: RenderInfo,
    title: String,
    description: String,
    camera: String,
    cameras: Vec<String>,
    exposure: f32,
    /// Speed of the keys that move the camera, in scene units per second.
    flight_speed: f32,
    frame: f64,
    frames: u32,
    frame_rate: f64,
}

impl WorkerRenderer {
    /// Creates a renderer without a scene.
    pub fn new(share: WorkerShare) -> Self {
        Self { share, scene: None }
    }

    /// Opens a built-in scene, or one of the `files`. An error, worded as by `juggler check`,
    /// leaves the previous scene open.
    pub fn open(&mut self, name: &str, files: Vec<(String, Vec<u8>)>) -> Result<(), String> {
        let build = if files.is_empty() {
            BuildRequest::open(name, None)
        } else {
            BuildRequest::open(name, None).with_files(Bundle::from_iter(files))
        };
        let subject = build.run().map_err(|error| error.text)?;
        let film = WorkerFilm::new(subject.picture(), self.share);
        self.scene = Some(OpenScene { subject, film });
        Ok(())
    }

    /// Applies edits, an array of [`EditMessage`]s in JSON. Returns whether the samples so far are
    /// kept, and the error of an edit that was skipped.
    pub fn edit(&mut self, edits: &str) -> Result<(bool, Option<String>), String> {
        let edits: Vec<EditMessage> = serde_json::from_str(edits).map_err(|error| format!("error: {error}"))?;
        let OpenScene { mut subject, film } = self.scene.take().ok_or("error: no scene is open")?;
        let before = Arc::clone(subject.picture());
        let mut error = None;
        for edit in edits {
            if let Err(text) = edit.read().and_then(|edit| change(&mut subject, &edit)) {
                error = Some(text);
            }
        }
        let picture = subject.picture();
        // A tile may have more samples than the picture needs now, so the answer must not depend on
        // the worker's tiles.
        let kept = before.shares_samples(picture) && before.samples() <= picture.samples();
        let film = if kept { film.continued(picture, self.share) } else { WorkerFilm::new(picture, self.share) };
        self.scene = Some(OpenScene { subject, film });
        Ok((kept, error))
    }

    /// Renders the worker's rows of a coarse frame of this size.
    pub fn coarse(&self, size: [u32; 2]) -> PixelRects {
        let size = size.map(|edge| edge.max(1));
        self.scene.as_ref().map_or_else(PixelRects::default, |scene| coarse(scene.subject.picture(), self.share, size))
    }

    /// Renders for some milliseconds of the `clock`, and returns the updated tiles.
    pub fn refine(&mut self, milliseconds: f64, clock: &dyn Fn() -> f64) -> PixelRects {
        let Some(OpenScene { subject, film }) = &mut self.scene else { return PixelRects::default() };
        film.refine(subject.picture(), milliseconds, clock)
    }

    /// Returns whether the worker's tiles have all their samples.
    pub fn is_finished(&self) -> bool {
        self.scene.as_ref().is_none_or(|scene| scene.film.is_finished())
    }

    /// Returns the status in JSON.
    pub fn status(&self) -> String {
        let status = self.scene.as_ref().map(|scene| worker_status(&scene.subject));
        serde_json::to_string(&status).unwrap_or_default()
    }
}

fn change(subject: &mut Subject, edit: &Edit) -> Result<(), String> {
    if let EditEffect::Build(build) = subject.apply(edit)? {
        *subject = build.run().map_err(|error| error.text)?;
    }
    Ok(())
}

/// Returns the description of a picture for the page.
pub fn render_info(picture: &Picture) -> RenderInfo {
    let metadata = picture.header(Options::default()).metadata;
    let (tone, transparent) = (picture.tone().clone(), picture.aovs().is_transparent());
    RenderInfo { size: picture.size(), samples: picture.samples(), tone, transparent, metadata }
}

fn worker_status(subject: &Subject) -> WorkerStatus {
    let picture = subject.picture();
    let description = &subject.scene().description;
    let animation = subject.animation();
    WorkerStatus {
        info: render_info(picture),
        title: description.title.clone(),
        description: description.description.clone(),
        camera: picture.compiled().cameras.first().map(|(name, _)| name.clone()).unwrap_or_default(),
        cameras: subject.cameras(),
        exposure: picture.tone().exposure_stops,
        flight_speed: subject.flight_speed(),
        frame: subject.frame(),
        frames: animation.as_ref().map_or(0, |animation| animation.frames),
        frame_rate: animation.map_or(0.0, |animation| animation.frames_per_second),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::Value;

    const SCENE: &str = r#"{"version": 1, "include": "ground.json", "render": {"size": [20, 10], "samples": 3},
        "objects": [{"shape": {"mesh": {"file": "models/leaf.obj"}}}], "lights": [{"point": {"position": [0, 9, 9]}}]}"#;
    const GROUND: &str = r#"{"version": 1, "objects": [{"shape": {"plane": {}}}]}"#;
    const LEAF: &str = "v -1 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\n";

    fn files() -> Vec<(String, Vec<u8>)> {
        let file = |(name, text): (&str, &str)| (name.to_owned(), text.as_bytes().to_vec());
        [("scene.json", SCENE), ("ground.json", GROUND), ("leaf.obj", LEAF)].map(file).to_vec()
    }

    fn opened(index: u32, count: u32) -> WorkerRenderer {
        let mut renderer = WorkerRenderer::new(WorkerShare { index, count });
        renderer.open("scene.json", files()).unwrap();
        renderer
    }

    fn rendered(renderer: &mut WorkerRenderer) -> Vec<PixelRects> {
        let clock = || 0.0;
        std::iter::from_fn(|| (!renderer.is_finished()).then(|| renderer.refine(1.0, &clock))).collect()
    }

    fn status(renderer: &WorkerRenderer) -> Value {
        serde_json::from_str(&renderer.status()).unwrap()
    }

    #[test]
    fn bundled_files_open_as_a_scene() {
        let mut renderer = opened(0, 1);
        let film: Vec<PixelRects> = rendered(&mut renderer);
        let last = film.iter().rev().find(|rects| !rects.bounds.is_empty()).unwrap();
        assert!(last.radiance.iter().any(|radiance| *radiance > 0.0), "there is something to be seen");
        let status = status(&renderer);
        assert_eq!((&status["outline"]["size"], &status["frames"]), (&serde_json::json!([20, 10]), &0.into()));
        let speed = renderer.scene.as_ref().unwrap().subject.flight_speed();
        assert_eq!(status["flight_speed"].as_f64().map(|speed| speed as f32), Some(speed));
        let mut without = WorkerRenderer::new(WorkerShare { index: 0, count: 1 });
        let error = without.open("scene.json", files()[..2].to_vec()).unwrap_err();
        assert!(error.contains("cannot read `models/leaf.obj`: file not found"), "{error}");
        assert!(without.is_finished() && without.status() == "null");
    }

    #[test]
    fn workers_apply_the_same_edits_and_restart_only_if_needed() {
        let mut renderers = [opened(0, 2), opened(1, 2)];
        renderers.iter_mut().for_each(|renderer| drop(rendered(renderer)));
        let mut all = |edits: &str| renderers.each_mut().map(|renderer| renderer.edit(edits).unwrap());
        assert_eq!(all(r#"[{"setting": {"exposure": 1}}, {"setting": {"samples": 5}}]"#), [(true, None), (true, None)]);
        assert_eq!(all(r#"[{"setting": {"samples": 4}}]"#), [(false, None), (false, None)], "fewer than there may be");
        assert_eq!(all(r#"[{"setting": {"samples": 5}}]"#), [(true, None), (true, None)]);
        let [(kept, error), _] = all(r#"[{"fly": {"forward": 0.5}}, {"camera": "none"}, {"zoom": 1.5}]"#);
        assert!(!kept && error.unwrap().contains("no camera `none`"));
        let whole = {
            let mut single = opened(0, 1);
            single.edit(r#"[{"setting": {"samples": 5}}, {"fly": {"forward": 0.5}}, {"zoom": 1.5}]"#).unwrap();
            last_of(&rendered(&mut single))
        };
        let parts: Vec<_> = renderers.iter_mut().flat_map(|renderer| last_of(&rendered(renderer))).collect();
        let parts: std::collections::BTreeMap<_, _> = parts.into_iter().collect();
        assert_eq!(parts, whole);
    }

    /// Returns the newest state of each tile.
    fn last_of(rendered: &[PixelRects]) -> std::collections::BTreeMap<[u32; 2], (u32, Vec<u32>)> {
        let tiles = rendered.iter().flat_map(|rects| rects.iter());
        let bits = |radiance: &[f32]| radiance.iter().map(|value| value.to_bits()).collect();
        tiles.map(|(pixels, samples, radiance)| ([pixels.x, pixels.y], (samples, bits(radiance)))).collect()
    }

    #[test]
    fn missing_scenes_and_invalid_edits_are_errors() {
        let mut renderer = WorkerRenderer::new(WorkerShare { index: 0, count: 1 });
        assert!(renderer.edit("[]").unwrap_err().contains("no scene"));
        assert_eq!(renderer.coarse([4, 4]), PixelRects::default());
        renderer.open("scalablitz-pool", Vec::new()).unwrap();
        assert!(renderer.open("scalablitz-pol", Vec::new()).is_err());
        assert!(renderer.edit(r#"[{"swim": {}}]"#).is_err());
        let (kept, error) = renderer.edit(r#"[{"setting": {"tone": "agx2"}}, {"setting": {"exposure": 1}}]"#).unwrap();
        assert!(kept && status(&renderer)["exposure"] == 1.0, "the other edit is applied");
        assert_eq!(error.as_deref(), Some("error: there is no tone curve `agx2`; did you mean `agx`?"));
        assert_eq!(renderer.coarse([8, 8]).radiance.len(), 8 * 8 * 4, "what was open stays open");
    }
}
