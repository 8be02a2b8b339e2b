//! Backgrounds: what a ray sees that leaves the world.

use juggler_math::{Ray, Rgb};

mod dome;
mod gradient;
mod solid;

#[cfg(test)]
mod contract;

pub use gradient::Blend;

/// Why a background cannot be: the field at fault and what it should be.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{message}")]
pub struct InvalidBackground {
    /// The field, as in the scene file.
    pub field: &'static str,
    /// What is wrong, and what would be right.
    pub message: String,
}

/// What a ray sees that leaves the world.
pub trait Background: Send + Sync {
    /// Checks the numbers; called once, before the background is used.
    fn check(&self) -> Result<(), InvalidBackground>;
    /// Light from that way; the ray's direction is a unit vector.
    fn radiance(&self, ray: &Ray) -> Rgb;
}

closed_set! {
    /// Every background. In JSON: `{"solid": {"color": [0, 0, 0]}}`.
    pub enum AnyBackground: Background {
        solid::Solid,
        gradient::Gradient,
        dome::Dome,
    }
}

/// Refuses light that is negative or not finite.
fn check_color(field: &'static str, color: Rgb) -> Result<(), InvalidBackground> {
    if color.to_array().iter().all(|v| *v >= 0.0 && v.is_finite()) {
        return Ok(());
    }
    Err(InvalidBackground { field, message: format!("`{field}` must be 0 or more in every channel") })
}
