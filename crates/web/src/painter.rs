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
        let subject = build.run()?;
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
        let kept = Arc::ptr_eq(&before, picture) || before.shares_samples(picture);
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
        *subject = build.run()?;
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
        frame_rate: animation.map_or(0.0, |animation| f64::from(animation.frames_per_second)),
    }
}
