//! Neighboring frames, which motion vectors need.

use crate::{Aov, AovSet, Error, Settings};
use juggler_camera::ShutterCamera;
use juggler_math::{BuildControl, UVec2};
use juggler_scene::{Compiled, Scene};
use juggler_world::frames::{NeighborFrame, NeighborFrames};
use std::sync::Arc;

/// World and camera at the previous and next frame, with a fingerprint.
#[derive(Clone, Debug, Default)]
pub struct NeighborScenes {
    /// Neighboring frames; `None` if no AOV needs them.
    pub frames: Option<Arc<NeighborFrames>>,
    /// Hash of both scenes; empty if the scene does not change.
    pub fingerprint: String,
}

/// Returns how many worlds these AOVs need in addition to the scene's own.
pub fn extra_worlds(scene: &Scene, aovs: &[Aov]) -> u64 {
    if scene.depends_on_time() {
        [Aov::Motion, Aov::MotionBack].iter().filter(|aov| aovs.contains(aov)).count() as u64
    } else {
        0
    }
}

impl NeighborScenes {
    /// Builds the neighboring frames of a scene that was compiled with these settings and is seen
    /// through `shutter_camera`, unless `control` is cancelled.
    pub fn build(
        scene: &Scene,
        settings: &Settings,
        compiled: &Compiled,
        shutter_camera: &ShutterCamera,
        aovs: &AovSet,
        control: &BuildControl,
    ) -> Result<Self, Error> {
        let [back, on] = [Aov::MotionBack, Aov::Motion].map(|aov| aovs.selected().contains(&aov));
        if !back && !on {
            return Ok(Self::default());
        }
        let here = settings.apply(scene)?;
        let mut fingerprints = Vec::new();
        let mut neighbor = |is_needed: bool, frames: f64| -> Result<Option<NeighborFrame>, Error> {
            if !is_needed || !scene.depends_on_time() {
                return Ok(None);
            }
            let known = (&here, compiled);
            let (frame, fingerprint) = frame(scene, settings, known, frames, control).map_err(|error| match error {
                Error::Cancelled(cancelled) => Error::Cancelled(cancelled),
                error => {
                    let which = if frames < 0.0 { "before" } else { "after" };
                    Error::setting("aovs", format!("the AOVs need the scene at the frame {which}: {error}"))
                }
            })?;
            fingerprints.push(fingerprint);
            Ok(Some(frame))
        };
        let (previous, next) = (neighbor(back, -1.0)?, neighbor(on, 1.0)?);
        let frames = Some(Arc::new(NeighborFrames::new(shutter_camera.clone(), previous, next)));
        Ok(Self { frames, fingerprint: fingerprints.join(" ") })
    }

    /// Returns the same worlds seen through a camera that does not move.
    #[must_use]
    pub fn with_camera(&self, camera: &ShutterCamera) -> Self {
        let frames = self.frames.as_ref().map(|frames| Arc::new(frames.with_camera(camera)));
        Self { frames, fingerprint: self.fingerprint.clone() }
    }
}

/// Compiles the scene `frames` frames later, and returns its fingerprint too. `here` and `compiled` are
/// the scene at its own frame.
fn frame(
    scene: &Scene,
    settings: &Settings,
    (here, compiled): (&Scene, &Compiled),
    frames: f64,
    control: &BuildControl,
) -> Result<(NeighborFrame, String), Error> {
    let there = settings.apply(&scene.later(frames)?)?;
    let compiled = there.compile_after_with_control(here, compiled, control)?;
    let [width, height] = there.description.render.size;
    let camera = compiled
        .shutter_camera(UVec2::new(width, height))
        .map_err(|error| Error::setting("camera", error.to_string()))?;
    let mut fingerprint = there.fingerprint();
    if let Some((_, camera)) = compiled.cameras.first() {
        fingerprint.set_camera(camera, &compiled.camera_keys);
    }
    Ok((NeighborFrame { world: compiled.world, camera }, fingerprint.hash()))
}
