//! Backgrounds: the radiance of rays that leave the scene, and importance sampling of it.

use juggler_math::{MAX_LIGHT, Ray, Rgb, Vec2, Vec3, warp};

mod atmosphere;
mod direction_table;
mod dome;
mod elevation_gradient;
mod environment;
mod gradient;
mod orientation;
mod sky;
mod solid;
mod studio;

#[cfg(test)]
mod contract;

pub use environment::Panorama;
pub use gradient::Blend;
pub use sky::PreparedSky;

/// Error in a background's description: the field at fault and its valid values.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{message}")]
pub struct InvalidBackground {
    /// Name of the field in the scene file.
    pub field: &'static str,
    /// Message that states the error and the valid values.
    pub message: String,
}

/// Direction sampled by its radiance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BackgroundSample {
    /// Unit direction towards the light.
    pub wi: Vec3,
    /// Density per steradian of `wi`, above 0.
    pub pdf: f32,
}

/// Background as the scene describes it: the radiance of rays that leave the scene.
pub trait Background: Send + Sync {
    /// Checks the fields, but not the contents of files.
    fn check(&self) -> Result<(), InvalidBackground>;
    /// Checks everything and computes the tables that the other methods use. Called once before
    /// them, after files are loaded.
    fn prepare(&mut self) -> Result<(), InvalidBackground> {
        self.check()
    }
    /// Radiance along a ray with a unit direction.
    fn radiance(&self, ray: &Ray) -> Rgb;
    /// Radiance that camera rays see instead, directly and through glass, if it differs. It lights
    /// nothing.
    fn visible_as(&self) -> Option<Rgb> {
        None
    }
    /// Samples a direction of the sphere with `u` in the unit square; `None` if the background is
    /// black.
    fn sample(&self, u: Vec2) -> Option<BackgroundSample> {
        let wi = warp::uniform_sphere(u);
        let lit = !self.mean_radiance().is_black();
        lit.then_some(BackgroundSample { wi, pdf: warp::UNIFORM_SPHERE_PDF })
    }
    /// Density per steradian with which [`Background::sample`] samples a unit direction; above 0
    /// wherever there is light.
    fn pdf(&self, _direction: Vec3) -> f32 {
        if self.mean_radiance().is_black() { 0.0 } else { warp::UNIFORM_SPHERE_PDF }
    }
    /// Mean radiance over all directions, as seen from the origin.
    fn mean_radiance(&self) -> Rgb;
    /// Luminance of the power that enters a sphere of radius `world_radius`, for light selection.
    fn power(&self, world_radius: f32) -> f32 {
        const PI: f32 = std::f32::consts::PI;
        4.0 * PI * PI * world_radius * world_radius * self.mean_radiance().luminance()
    }
    /// Heap memory in bytes.
    fn heap_bytes(&self) -> usize {
        0
    }
}

juggler_math::closed_set! {
    /// Background of any kind. In JSON: `{"solid": {"color": [0, 0, 0]}}`.
    pub enum AnyBackground: Background {
        solid::Solid,
        gradient::Gradient,
        dome::Dome,
        environment::Environment,
        sky::Sky,
        studio::Studio,
    }
}

impl From<Rgb> for AnyBackground {
    /// Creates a background of uniform radiance.
    fn from(color: Rgb) -> Self {
        Solid { color }.into()
    }
}

impl From<[f32; 3]> for AnyBackground {
    /// Creates a background of uniform radiance, linear red, green and blue.
    fn from(channels: [f32; 3]) -> Self {
        Rgb::from(channels).into()
    }
}

/// Rejects a color with a channel below 0, above [`MAX_LIGHT`] or NaN.
fn check_color(field: &'static str, color: Rgb) -> Result<(), InvalidBackground> {
    color.to_array().iter().try_for_each(|channel| orientation::in_range(field, *channel, 0.0, MAX_LIGHT))
}
