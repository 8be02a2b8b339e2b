//! Cameras, which map points of the film to rays.
//!
//! Film coordinates are in pixels from the picture's top left corner, y down: pixel (i, j) covers
//! [i, i+1) × [j, j+1), and its center is (i + 0.5, j + 0.5).
//!
//! All cameras share the fields of their pose; `pose.rs` states their exact meaning:
//!
//! ```json
//! {"eye": [0, 2, 6], "look_at": [0, 1, 0], "up": [0, 1, 0],
//!     "yaw_degrees": 0, "pitch_degrees": 0, "roll_degrees": 0,
//!     "move": {"right": 0, "up": 0, "forward": 0}}
//! ```

use juggler_math::{Transform, UVec2, Vec3};

pub mod aov;
mod field_of_view;
pub mod film;
mod framing;
mod orthographic;
mod perspective;
mod pose;
mod projection;
pub mod sampler;
mod shutter_camera;
mod thin_lens;
mod world_to_film;

#[cfg(test)]
mod constructors;
#[cfg(test)]
mod contract;

pub use field_of_view::{ViewPlane, VirtualScreen};
pub use framing::Framing;
pub use pose::{CameraAxes, LocalTranslation};
pub use projection::{LANES, Projection};
pub use shutter_camera::ShutterCamera;
pub use world_to_film::{Matrix, WorldToFilm};

/// Error in a camera's description: the field at fault and its valid values.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{message}")]
pub struct InvalidCamera {
    /// Name of the field in the scene file.
    pub field: &'static str,
    /// Message that states the error and the valid values.
    pub message: String,
}

impl InvalidCamera {
    fn new(field: &'static str, message: impl Into<String>) -> Self {
        Self { field, message: message.into() }
    }
}

/// Camera as the scene describes it.
pub trait Camera: Send + Sync {
    /// Projection for pictures of `size` pixels.
    fn projection(&self, size: UVec2) -> Result<Projection, InvalidCamera>;
    /// Position and axes of the camera.
    fn axes(&self) -> Result<CameraAxes, InvalidCamera>;
    /// Moves the camera to `eye`, looking along `direction` with its top towards `up`, and resets
    /// all other fields of the pose.
    fn set_pose(&mut self, eye: Vec3, direction: Vec3, up: Vec3);
    /// Transforms the pose, which then has a direction in place of a target.
    fn transform(&mut self, transform: &Transform) {
        // A camera without valid axes is refused later.
        if let Ok(axes) = self.axes() {
            let [direction, up] = [axes.forward, axes.up].map(|v| transform.vector(v).normalize_or(v));
            self.set_pose(transform.point(axes.eye), direction, up);
        }
    }
    /// Point given by `look_at`; `None` if the scene gives a direction, or after
    /// [`Self::set_pose`].
    fn target(&self) -> Option<Vec3>;
    /// Up direction of the description, before yaw, pitch and roll, of any length.
    fn up(&self) -> Vec3;
    /// Divides the tangent of half the field of view, or the edges of the visible area, by
    /// `factor`, within limits.
    fn zoom(&mut self, factor: f32);
    /// Sets the focus distance of a camera with a lens.
    fn focus(&mut self, _distance: f32) {}
    /// Name of the object whose middle is in focus, if the description gives one.
    fn focused_object(&self) -> Option<&str> {
        None
    }
}

juggler_math::closed_set! {
    /// Camera of any kind. In JSON: `{"perspective": {"eye": [0, 2, 6], "look_at": [0, 1, 0]}}`.
    pub enum AnyCamera: Camera {
        perspective::Perspective,
        thin_lens::ThinLens,
        orthographic::Orthographic,
    }
}
