//! Cameras: from a point of the film to a ray.
//!
//! Film coordinates are pixels from the picture's top left corner, y down: pixel (i, j) covers
//! [i, i+1) × [j, j+1) and its centre is (i + 0.5, j + 0.5).

use juggler_math::{Ray, UVec2, Vec2, Vec3};

mod perspective;

/// Why a camera cannot be: the field at fault and what it should be.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{message}")]
pub struct InvalidCamera {
    /// The field, as in the scene file.
    pub field: &'static str,
    /// What is wrong, and what would be right.
    pub message: String,
}

/// A camera for one size of picture: all that a ray needs, nothing to look up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projection {
    /// The eye.
    pub origin: Vec3,
    /// From the eye to the film's top left corner.
    pub corner: Vec3,
    /// One pixel to the right.
    pub right: Vec3,
    /// One pixel down.
    pub down: Vec3,
}

impl Projection {
    /// The ray through a point of the film, for `lens` in the unit square; `None` where the film sees nothing.
    pub fn ray(&self, film: Vec2, _lens: Vec2, time: f32) -> Option<Ray> {
        let direction = self.corner + self.right * film.x + self.down * film.y;
        Some(Ray { time, ..Ray::new(self.origin, direction.normalize()) })
    }
}

/// A camera as the scene describes it.
pub trait Camera: Send + Sync {
    /// The camera for pictures of `size` pixels.
    fn project(&self, size: UVec2) -> Result<Projection, InvalidCamera>;
}

closed_set! {
    /// Every camera. In JSON: `{"perspective": {"eye": [0, 2, 6], "look_at": [0, 1, 0]}}`.
    pub enum AnyCamera: Camera { perspective::Perspective }
}
