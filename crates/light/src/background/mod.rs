//! Backgrounds: what a ray sees that leaves the world, and light from there.

use juggler_math::{MAX_LIGHT, Ray, Rgb, Vec2, Vec3, warp};

mod atmosphere;
mod bands;
mod directions;
mod dome;
mod environment;
mod gradient;
mod orientation;
mod sky;
mod solid;

#[cfg(test)]
mod contract;

pub use environment::Panorama;
pub use gradient::Blend;
pub use sky::PreparedSky;

/// Why a background cannot be: the field at fault and what it should be.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{message}")]
pub struct InvalidBackground {
    /// The field, as in the scene file.
    pub field: &'static str,
    /// What is wrong, and what would be right.
    pub message: String,
}

/// A direction that was picked for its light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BackgroundSample {
    /// Unit direction towards the light.
    pub wi: Vec3,
    /// Density per steradian with which it was picked, above 0.
    pub pdf: f32,
}

/// What a ray sees that leaves the world.
pub trait Background: Send + Sync {
    /// Checks the numbers, those in files left out.
    fn check(&self) -> Result<(), InvalidBackground>;
    /// Checks everything and makes the tables that light comes from. Called once, before all below, when what is in files
    /// has been loaded.
    fn prepare(&mut self) -> Result<(), InvalidBackground> {
        self.check()
    }
    /// Light from that way; the ray's direction is a unit vector.
    fn radiance(&self, ray: &Ray) -> Rgb;
    /// A direction picked by `u` in the unit square for its light, all over the sphere; `None` when there is none.
    fn sample(&self, u: Vec2) -> Option<BackgroundSample> {
        let wi = warp::uniform_sphere(u);
        let lit = !self.mean().is_black();
        lit.then_some(BackgroundSample { wi, pdf: warp::UNIFORM_SPHERE_PDF })
    }
    /// Density per steradian with which [`Background::sample`] picks a unit direction; above 0 wherever there is
    /// light.
    fn pdf(&self, _direction: Vec3) -> f32 {
        if self.mean().is_black() { 0.0 } else { warp::UNIFORM_SPHERE_PDF }
    }
    /// Mean radiance over all directions, from the origin.
    fn mean(&self) -> Rgb;
    /// Luminance of the power that enters a ball of this radius, for choosing among lights.
    fn power(&self, world_radius: f32) -> f32 {
        const PI: f32 = std::f32::consts::PI;
        4.0 * PI * PI * world_radius * world_radius * self.mean().luminance()
    }
    /// Bytes on the heap.
    fn heap_bytes(&self) -> usize {
        0
    }
}

juggler_math::closed_set! {
    /// Every background. In JSON: `{"solid": {"color": [0, 0, 0]}}`.
    pub enum AnyBackground: Background {
        solid::Solid,
        gradient::Gradient,
        dome::Dome,
        environment::Environment,
        sky::Sky,
    }
}

impl From<Rgb> for AnyBackground {
    /// The same radiance in every direction.
    fn from(color: Rgb) -> Self {
        Solid { color }.into()
    }
}

/// Refuses a color with a channel below 0 or above [`MAX_LIGHT`].
fn check_color(field: &'static str, color: Rgb) -> Result<(), InvalidBackground> {
    color.to_array().iter().try_for_each(|channel| orientation::in_range(field, *channel, 0.0, MAX_LIGHT))
}
