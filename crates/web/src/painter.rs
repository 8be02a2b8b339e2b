//! A worker's side: a scene of its own, and its share of the picture.

use crate::board::Outline;
use crate::patches::Patches;
use crate::share::Share;
use crate::slice::{Slices, coarse};
use juggler::Picture;
use juggler::imaging::Options;
use juggler::scene::{Bundle, Scene};
use juggler_session::{Build, Change, Edit, Subject, text_of};
use serde::Serialize;
use std::sync::Arc;

/// Renders one share of a picture.
pub struct Painter {
    share: Share,
    shown: Option<Shown>,
}

/// What is rendered.
struct Shown {
    subject: Subject,
    slices: Slices,
}

/// How things stand, for the page's panel.
#[derive(Serialize)]
struct Report {
    outline: Outline,
    title: String,
    description: String,
    camera: String,
    cameras: Vec<String>,
    exposure: f32,
    /// The diagonal of everything, scene units: what steps are measured by.
    extent: f32,
    frame: f64,
    frames: u32,
    frame_rate: f64,
}

impl Painter {
    /// Without a scene.
    pub fn new(share: Share) -> Self {
        Self { share, shown: None }
    }

    /// Opens a built-in scene, or one of the `files`. After an error what was shown stays. The text of an error is that
    /// of `juggler check`.
    pub fn open(&mut self, name: &str, files: Vec<(String, Vec<u8>)>) -> Result<(), String> {
        let build = if files.is_empty() {
            Build::open(name, None)
        } else {
            let scene = Scene::from_bundle(Bundle::from_iter(files), name);
            Build::of(scene.map_err(|error| text_of(&error.into()))?, name, None)
        };
        let subject = build.run().map_err(|mistake| mistake.text)?;
        let slices = Slices::new(subject.picture(), self.share);
        self.shown = Some(Shown { subject, slices });
        Ok(())
    }

    /// Makes changes, each an [`Edit`] in JSON. Whether all samples so far are samples of the new picture too; and what
    /// was wrong with edits that were left out.
    pub fn edit(&mut self, edits: &str) -> Result<(bool, Option<String>), String> {
        let edits: Vec<Edit> = serde_json::from_str(edits).map_err(|error| format!("error: {error}"))?;
        let Shown { mut subject, slices } = self.shown.take().ok_or("error: no scene is open")?;
        let before = Arc::clone(subject.picture());
        let mut error = None;
        for edit in edits {
            if let Err(text) = change(&mut subject, &edit) {
                error = Some(text);
            }
        }
        let picture = subject.picture();
        // Tiles may have more samples than are wanted now: all workers must come to the same answer.
        let kept = before.shares_samples(picture) && before.samples() <= picture.samples();
        let slices = if kept { slices.resumed(picture, self.share) } else { Slices::new(picture, self.share) };
        self.shown = Some(Shown { subject, slices });
        Ok((kept, error))
    }

    /// Its rows of a coarse frame of this size.
    pub fn coarse(&self, size: [u32; 2]) -> Patches {
        let size = size.map(|edge| edge.max(1));
        self.shown.as_ref().map_or_else(Patches::default, |shown| coarse(shown.subject.picture(), self.share, size))
    }

    /// Renders for some milliseconds by the `clock`, and gives the tiles that have become better.
    pub fn refine(&mut self, milliseconds: f64, clock: &dyn Fn() -> f64) -> Patches {
        let Some(Shown { subject, slices }) = &mut self.shown else { return Patches::default() };
        slices.refine(subject.picture(), milliseconds, clock)
    }

    /// Whether all of its tiles have their samples.
    pub fn is_finished(&self) -> bool {
        self.shown.as_ref().is_none_or(|shown| shown.slices.is_finished())
    }

    /// How things stand, in JSON.
    pub fn status(&self) -> String {
        let report = self.shown.as_ref().map(|shown| report(&shown.subject));
        serde_json::to_string(&report).unwrap_or_default()
    }
}

fn change(subject: &mut Subject, edit: &Edit) -> Result<(), String> {
    if let Change::Build(build) = subject.apply(edit)? {
        *subject = build.run().map_err(|mistake| mistake.text)?;
    }
    Ok(())
}

/// What the page's board needs to know of a picture.
pub fn outline(picture: &Picture) -> Outline {
    let metadata = picture.header(Options::default()).metadata;
    Outline { size: picture.size(), samples: picture.samples(), tone: picture.tone().clone(), metadata }
}

fn report(subject: &Subject) -> Report {
    let picture = subject.picture();
    let description = &subject.scene().description;
    let animation = subject.animation();
    Report {
        outline: outline(picture),
        title: description.title.clone(),
        description: description.description.clone(),
        camera: picture.compiled().cameras.first().map(|(name, _)| name.clone()).unwrap_or_default(),
        cameras: subject.cameras(),
        exposure: picture.tone().exposure_stops,
        extent: subject.extent(),
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

    fn opened(index: u32, of: u32) -> Painter {
        let mut painter = Painter::new(Share { index, of });
        painter.open("scene.json", files()).unwrap();
        painter
    }

    fn rendered(painter: &mut Painter) -> Vec<Patches> {
        let clock = || 0.0;
        std::iter::from_fn(|| (!painter.is_finished()).then(|| painter.refine(1.0, &clock))).collect()
    }

    fn status(painter: &Painter) -> Value {
        serde_json::from_str(&painter.status()).unwrap()
    }

    #[test]
    fn files_in_memory_are_a_scene() {
        let mut painter = opened(0, 1);
        let film: Vec<Patches> = rendered(&mut painter);
        let last = film.iter().rev().find(|patches| !patches.places.is_empty()).unwrap();
        assert!(last.light.iter().any(|light| *light > 0.0), "there is something to be seen");
        let status = status(&painter);
        assert_eq!((&status["outline"]["size"], &status["frames"]), (&serde_json::json!([20, 10]), &0.into()));
        let mut without = Painter::new(Share { index: 0, of: 1 });
        let error = without.open("scene.json", files()[..2].to_vec()).unwrap_err();
        assert!(error.contains("cannot read `models/leaf.obj`: there is no such file"), "{error}");
        assert!(without.is_finished() && without.status() == "null");
    }

    #[test]
    fn workers_make_the_same_edits_and_begin_anew_only_when_they_must() {
        let mut painters = [opened(0, 2), opened(1, 2)];
        painters.iter_mut().for_each(|painter| drop(rendered(painter)));
        let mut all = |edits: &str| painters.each_mut().map(|painter| painter.edit(edits).unwrap());
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
        let parts: Vec<_> = painters.iter_mut().flat_map(|painter| last_of(&rendered(painter))).collect();
        let parts: std::collections::BTreeMap<_, _> = parts.into_iter().collect();
        assert_eq!(parts, whole);
    }

    /// The newest state of each tile.
    fn last_of(rendered: &[Patches]) -> std::collections::BTreeMap<[u32; 2], (u32, Vec<u32>)> {
        let tiles = rendered.iter().flat_map(|patches| patches.iter());
        let bits = |light: &[f32]| light.iter().map(|value| value.to_bits()).collect();
        tiles.map(|(pixels, samples, light)| ([pixels.x, pixels.y], (samples, bits(light)))).collect()
    }

    #[test]
    fn a_worker_without_a_scene_and_wrong_edits_do_no_harm() {
        let mut painter = Painter::new(Share { index: 0, of: 1 });
        assert!(painter.edit("[]").unwrap_err().contains("no scene"));
        assert_eq!(painter.coarse([4, 4]), Patches::default());
        painter.open("scalablitz-pool", Vec::new()).unwrap();
        assert!(painter.open("scalablitz-pol", Vec::new()).is_err());
        assert!(painter.edit(r#"[{"swim": {}}]"#).is_err());
        assert_eq!(painter.coarse([8, 8]).light.len(), 8 * 8 * 3, "what was open stays open");
    }
}
