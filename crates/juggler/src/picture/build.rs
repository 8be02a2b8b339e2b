//! Pictures from scenes: compilation with settings.

use super::Picture;
use crate::neighbor_scenes::NeighborScenes;
use crate::scene_fingerprint::SceneFingerprint;
use crate::{AovSet, Error, Settings};
use juggler_math::{BuildControl, UVec2};
use juggler_render::{BAND_PIXELS, CameraRays};
use juggler_scene::{Compiled, IntegratorReason, Scene};
use std::sync::{Arc, OnceLock};

impl Picture {
    /// Compiles a scene with settings and builds its world.
    pub fn new(scene: &Scene, settings: &Settings) -> Result<Self, Error> {
        Self::new_with_control(scene, settings, &BuildControl::default())
    }

    /// [`Picture::new`], which ends early if `control` is cancelled, and reports its progress to it.
    /// A render passes the control of its [`Control`](juggler_render::Control)
    /// ([`Control::build`](juggler_render::Control::build)).
    ///
    /// # Errors
    ///
    /// As [`Picture::new`], and [`Error::Cancelled`] if `control` is cancelled.
    pub fn new_with_control(scene: &Scene, settings: &Settings, control: &BuildControl) -> Result<Self, Error> {
        control.check()?;
        let adjusted = settings.apply(scene)?;
        let compiled = adjusted.compile_with_control(control)?;
        Self::from_compiled(scene, &adjusted, settings, compiled, control)
    }

    /// Compiles an edited scene. `before` is the scene of this picture, whose world is reused where
    /// it still holds ([`Scene::compile_after`]).
    pub fn rebuild(&self, before: &Scene, scene: &Scene, settings: &Settings) -> Result<Self, Error> {
        self.rebuild_with_control(before, scene, settings, &BuildControl::default())
    }

    /// [`Picture::rebuild`], which `control` can cancel as in [`Picture::new_with_control`].
    ///
    /// # Errors
    ///
    /// As [`Picture::new_with_control`].
    pub fn rebuild_with_control(
        &self,
        before: &Scene,
        scene: &Scene,
        settings: &Settings,
        control: &BuildControl,
    ) -> Result<Self, Error> {
        control.check()?;
        let (adjusted, before) = (settings.apply(scene)?, settings.apply(before)?);
        let compiled = adjusted.compile_after_with_control(&before, &self.compiled, control)?;
        Self::from_compiled(scene, &adjusted, settings, compiled, control)
    }

    /// Completes a picture of `plain`, which the settings turned into `scene`.
    fn from_compiled(
        plain: &Scene,
        scene: &Scene,
        settings: &Settings,
        mut compiled: Compiled,
        control: &BuildControl,
    ) -> Result<Self, Error> {
        compiled.integrator.reason = reason(plain, settings);
        let [width, height] = scene.description.render.size;
        let region = settings.region([width, height])?;
        let camera = compiled.cameras.first().ok_or_else(|| Error::setting("camera", "the scene has no camera"))?;
        let shutter_camera =
            compiled.shutter_camera(UVec2::new(width, height)).map_err(|e| Error::setting("camera", e.to_string()))?;
        let (tone, limit) = ((*scene.description.tone).clone(), settings.limit);
        let scene_fingerprint =
            SceneFingerprint::from_scene(scene.clone(), camera.1.clone(), compiled.camera_keys.clone());
        let aovs =
            Arc::new(AovSet::new(&settings.aovs, settings.denoiser, &compiled.names, compiled.settings.transparent));
        aovs.check()?;
        let neighbors = NeighborScenes::build(plain, settings, &compiled, &shutter_camera, &aovs, control)?;
        Ok(Self {
            shutter_camera,
            region,
            camera_rays: Arc::new(CameraRays::new(UVec2::new(width, height))),
            tone,
            limit,
            fingerprint: OnceLock::new(),
            scene_fingerprint,
            compiled,
            band_pixels: BAND_PIXELS,
            aovs,
            neighbors,
        })
    }
}

/// Returns the reason for the choice of the integrator under these settings.
fn reason(scene: &Scene, settings: &Settings) -> IntegratorReason {
    if settings.integrator.is_some() { IntegratorReason::Settings } else { scene.integrator_choice().reason }
}
