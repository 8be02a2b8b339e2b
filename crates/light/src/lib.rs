//! Lights, backgrounds and emitters, and the sampling of their light at a point.

use crate::emitter::LightBounds;
use juggler_math::{Rgb, Transform, Vec2, Vec3, range};
use strength::Strength;

mod ambient;
mod area;
pub mod background;
mod directional;
pub mod emitter;
mod finite_light;
mod ies;
mod photometry;
mod point;
mod spot;
mod spot_falloff;
mod strength;

#[cfg(test)]
mod constructors;
#[cfg(test)]
mod contract;

pub use area::AreaShape;
pub use finite_light::{Attenuation, Extent};
pub use ies::{Ies, IesProfile};
pub use photometry::InvalidIes;
pub use spot_falloff::SpotFalloff;

/// Sample of the light that arrives at a point without occlusion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSample {
    /// Unit direction towards the light.
    pub wi: Vec3,
    /// Distance of the sampled point of the light, in scene units; infinite for a directional
    /// light.
    pub distance: f32,
    /// Incident light per channel, attenuation included, without the BSDF and the cosine at the
    /// surface. With a `pdf` of 1 it is the irradiance on a plane perpendicular to `wi`.
    pub radiance: Rgb,
    /// Density per steradian of `wi`, by which the estimator divides `radiance`. 1 for lights whose
    /// points all have the same weight.
    pub pdf: f32,
}

/// Error in a light's description: the field at fault and its valid values.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{message}")]
pub struct InvalidLight {
    /// Name of the field in the scene file.
    pub field: &'static str,
    /// Message that states the error and the valid values.
    pub message: String,
}

/// Light as the scene describes it.
pub trait Light: Send + Sync {
    /// Checks the fields; called once before any other method.
    fn check(&self) -> Result<(), InvalidLight>;
    /// Samples the light at point `from`, both in world space, with `u` in the unit square. `None`
    /// if no light arrives.
    fn sample(&self, from: Vec3, u: Vec2) -> Option<LightSample>;
    /// Number of shadow rays per shading point in the classic integrator; above 1 for soft shadows.
    fn shadow_samples(&self) -> u32 {
        1
    }
    /// Whether the light is a single point or direction, so that [`Light::sample`] ignores `u`.
    fn is_delta(&self) -> bool;
    /// Whether the light is a surface, which paths hit and sample as a shape of the world.
    /// [`LightSample::radiance`] is then in physical units.
    fn is_surface(&self) -> bool {
        false
    }
    /// Precomputes values that all samples share, such as the intensity of a given power.
    fn prepare(&mut self) {}
    /// Center and radius of a sphere around all points of the light, in world space; `None` for an
    /// infinite or ambient light.
    fn bounding_sphere(&self) -> Option<(Vec3, f32)> {
        None
    }
    /// Bounds for the light tree; `None` for an infinite or ambient light. `world_radius` bounds
    /// the scene, as in [`Light::power`].
    fn bounds(&self, _world_radius: f32) -> Option<LightBounds> {
        None
    }
    /// Photometric file of the light, which the caller loads.
    fn ies(&mut self) -> Option<&mut Ies> {
        None
    }
    /// Name of the light group whose AOV receives this light.
    fn light_group(&self) -> Option<&str> {
        None
    }
    /// The field of [`Light::light_group`].
    fn light_group_mut(&mut self) -> Option<&mut Option<String>> {
        None
    }
    /// The light as a surface that the scene places, with its description; `None` for other lights.
    fn area(&self) -> Option<&Area> {
        None
    }
    /// Transforms position and direction. Intensities stay.
    fn transform(&mut self, _transform: &Transform) {}
    /// Ambient radiance, which arrives at every point from all directions without occlusion.
    fn ambient(&self) -> Rgb {
        Rgb::BLACK
    }
    /// Luminance of the emitted power, for light selection. `world_radius` is the radius of a
    /// sphere around the scene; a light without inverse-square falloff counts by the power through
    /// that sphere.
    fn power(&self, world_radius: f32) -> f32;
}

juggler_math::closed_set! {
    /// Light of any kind. In JSON: `{"point": {"position": [0, 4, 0], "color": [1, 1, 1],
    /// "intensity": 60}}`.
    pub enum AnyLight: Light {
        ambient::Ambient,
        area::Area,
        directional::Directional,
        point::Point,
        spot::Spot,
    }
}

/// Unit direction after a transform; unchanged if it vanishes.
fn transformed_direction(transform: &Transform, direction: Vec3) -> Vec3 {
    transform.vector(direction).normalize_or(direction)
}

/// Rejects numbers outside `low..=high` and NaN.
fn in_range(field: &'static str, value: f32, low: f32, high: f32) -> Result<(), InvalidLight> {
    let wrong = range::range_error(field, value, low, high);
    wrong.map_or(Ok(()), |message| Err(InvalidLight { field, message }))
}

/// Rejects two fields that exclude each other.
fn check_exclusive(
    (field, has): (&'static str, bool),
    (other, has_other): (&'static str, bool),
) -> Result<(), InvalidLight> {
    let message = || format!("`{field}` replaces `{other}`: write one of them, not both");
    if has && has_other { Err(InvalidLight { field, message: message() }) } else { Ok(()) }
}

fn check_color(color: Rgb, intensity: f32) -> Result<(), InvalidLight> {
    Strength { field: "intensity", value: Some(intensity), power: None }.check(color, color * intensity)
}

fn check_position(position: Vec3) -> Result<(), InvalidLight> {
    if position.is_finite() {
        return Ok(());
    }
    Err(InvalidLight { field: "position", message: "`position` must be finite".into() })
}

fn check_direction(direction: Vec3) -> Result<(), InvalidLight> {
    let squared = direction.length_squared();
    if squared >= f32::MIN_POSITIVE && squared.is_finite() {
        return Ok(());
    }
    let message = format!("`direction` must have a finite length above 0; it is {direction}");
    Err(InvalidLight { field: "direction", message })
}
