//! The scene at the frames beside the one that is rendered, for layers that tell where things go.

use crate::{Aov, Error, LayerSet, Settings};
use juggler_camera::Shot;
use juggler_math::UVec2;
use juggler_scene::{Compiled, Scene};
use juggler_world::frames::{Frame, Frames};
use std::sync::Arc;

/// The frames beside one, with what tells them from others.
#[derive(Clone, Debug, Default)]
pub struct FramesBeside {
    /// Nothing where no layer asks.
    pub frames: Option<Arc<Frames>>,
    /// A hash; empty where nothing changes.
    pub fingerprint: String,
}

/// How often a world is built for these layers of a scene, beside its own.
pub fn more_worlds(scene: &Scene, aovs: &[Aov]) -> u64 {
    if scene.depends_on_time() {
        [Aov::Motion, Aov::MotionBack].iter().filter(|aov| aovs.contains(aov)).count() as u64
    } else {
        0
    }
}

impl FramesBeside {
    /// Of a scene that became `compiled` as the settings wish, seen by `shot`.
    pub fn of(
        scene: &Scene,
        settings: &Settings,
        compiled: &Compiled,
        shot: &Shot,
        layers: &LayerSet,
    ) -> Result<Self, Error> {
        let [back, on] = [Aov::MotionBack, Aov::Motion].map(|aov| layers.wanted().contains(&aov));
        if !back && !on {
            return Ok(Self::default());
        }
        let here = settings.apply(scene)?;
        let mut told = Vec::new();
        let mut beside = |is_wanted: bool, frames: f64| -> Result<Option<Frame>, Error> {
            if !is_wanted || !scene.depends_on_time() {
                return Ok(None);
            }
            let (frame, fingerprint) = frame(scene, settings, &here, compiled, frames).map_err(|error| {
                let which = if frames < 0.0 { "before" } else { "after" };
                Error::Settings(format!("the layers need the scene at the frame {which}: {error}"))
            })?;
            told.push(fingerprint);
            Ok(Some(frame))
        };
        let (previous, next) = (beside(back, -1.0)?, beside(on, 1.0)?);
        let frames = Some(Arc::new(Frames::new(shot.clone(), previous, next)));
        Ok(Self { frames, fingerprint: told.join(" ") })
    }

    /// The same seen by a camera that is the same at all frames.
    #[must_use]
    pub fn seen_from(&self, camera: &Shot) -> Self {
        let frames = self.frames.as_ref().map(|frames| Arc::new(frames.seen_from(camera)));
        Self { frames, fingerprint: self.fingerprint.clone() }
    }
}

/// The scene some frames away, and its fingerprint.
fn frame(
    scene: &Scene,
    settings: &Settings,
    here: &Scene,
    compiled: &Compiled,
    frames: f64,
) -> Result<(Frame, String), Error> {
    let there = settings.apply(&scene.later(frames)?)?;
    let compiled = there.compile_after(here, compiled)?;
    let [width, height] = there.description.render.size;
    let camera = compiled.shot(UVec2::new(width, height)).map_err(|error| Error::Settings(error.to_string()))?;
    let mut fingerprint = there.fingerprint();
    if let Some((_, camera)) = compiled.cameras.first() {
        fingerprint.set_camera(camera, &compiled.course);
    }
    Ok((Frame { world: compiled.world, camera }, fingerprint.hash()))
}
