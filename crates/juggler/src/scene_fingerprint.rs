//! Fingerprint of the scene of a picture, computed on first use.

use juggler_camera::AnyCamera;
use juggler_scene::{Fingerprint, Scene};
use std::sync::{Arc, LazyLock};

/// Part of a picture's fingerprint that the scene determines. The fingerprint is computed on first
/// use, because hashing the arrays of a mesh takes time; a picture that is only shown needs none.
#[derive(Clone)]
pub struct SceneFingerprint {
    scene: Arc<LazyLock<Fingerprint, Box<dyn FnOnce() -> Fingerprint + Send>>>,
    /// Scene whose camera and settings replace those of the scene.
    view: Option<Arc<Scene>>,
    camera: AnyCamera,
    camera_keys: Vec<AnyCamera>,
}

impl SceneFingerprint {
    /// Creates the fingerprint of a scene that is seen through `camera`, which has the poses
    /// `camera_keys` while the shutter is open; none if the camera does not move.
    pub fn from_scene(scene: Scene, camera: AnyCamera, camera_keys: Vec<AnyCamera>) -> Self {
        let compute = Box::new(move || scene.fingerprint());
        Self { scene: Arc::new(LazyLock::new(compute)), view: None, camera, camera_keys }
    }

    /// Returns the fingerprint with the settings of the scene `view` and another camera.
    #[must_use]
    pub fn with_view(&self, view: Scene, camera: AnyCamera, camera_keys: Vec<AnyCamera>) -> Self {
        Self { scene: Arc::clone(&self.scene), view: Some(Arc::new(view)), camera, camera_keys }
    }

    /// Computes the fingerprint.
    pub fn compute(&self) -> Fingerprint {
        let mut fingerprint = match &self.view {
            Some(view) => self.scene.with_view_of(&view.fingerprint()),
            None => (**self.scene).clone(),
        };
        fingerprint.set_camera(&self.camera, &self.camera_keys);
        fingerprint
    }
}
