//! Cameras: from a point of the film to a ray.
//!
//! Film coordinates are pixels from the picture's top left corner, y down: pixel (i, j) covers
//! [i, i+1) × [j, j+1) and its centre is (i + 0.5, j + 0.5).
//!
//! Every camera shares the fields of its pose (see the page `pose.rs` for their exact meaning):
//!
//! ```json
//! {"eye": [0, 2, 6], "look_at": [0, 1, 0], "up": [0, 1, 0],
//!  "yaw_degrees": 0, "pitch_degrees": 0, "roll_degrees": 0, "move": {"right": 0, "up": 0, "forward": 0}}
//! ```

use juggler_math::{UVec2, Vec3};

mod field_of_view;
pub mod film;
mod finder;
pub mod layer;
mod orthographic;
mod perspective;
mod pose;
mod projection;
pub mod sampler;
mod shot;
mod thin_lens;

#[cfg(test)]
mod contract;

pub use field_of_view::{Screen, ViewPlane};
pub use finder::{Finder, Matrix};
pub use pose::{Axes, Move};
pub use projection::{LANES, Projection};
pub use shot::Shot;

/// Why a camera cannot be: the field at fault and what it should be.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{message}")]
pub struct InvalidCamera {
    /// The field, as in the scene file.
    pub field: &'static str,
    /// What is wrong, and what would be right.
    pub message: String,
}

impl InvalidCamera {
    fn new(field: &'static str, message: impl Into<String>) -> Self {
        Self { field, message: message.into() }
    }
}

/// A camera as the scene describes it.
pub trait Camera: Send + Sync {
    /// The camera for pictures of `size` pixels.
    fn project(&self, size: UVec2) -> Result<Projection, InvalidCamera>;
    /// Where it stands and how it is turned.
    fn axes(&self) -> Result<Axes, InvalidCamera>;
    /// Stands at `eye` and looks along `direction`, its top leaning to `up`; nothing else of its pose is left.
    fn stand(&mut self, eye: Vec3, direction: Vec3, up: Vec3);
    /// Point that the scene has it look at, by `look_at`; none where the scene gives a direction, or after [`Self::stand`].
    fn target(&self) -> Option<Vec3>;
    /// Direction to which the picture's top leans before it is turned, of any length.
    fn upward(&self) -> Vec3;
    /// Divides the tangent of half its field of view, or the area that it shows, by `factor`, as far as pictures allow.
    fn zoom(&mut self, factor: f32);
    /// Makes what is `distance` ahead sharp, if it has a lens.
    fn focus(&mut self, _distance: f32) {}
}

juggler_math::closed_set! {
    /// Every camera. In JSON: `{"perspective": {"eye": [0, 2, 6], "look_at": [0, 1, 0]}}`.
    pub enum AnyCamera: Camera {
        perspective::Perspective,
        thin_lens::ThinLens,
        orthographic::Orthographic,
    }
}
