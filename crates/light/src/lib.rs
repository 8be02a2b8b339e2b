//! Lights: what arrives at a point, and from where.

use crate::emitter::LightBounds;
use juggler_math::{Rgb, Vec2, Vec3, range};
use strength::Strength;

mod ambient;
mod area;
pub mod background;
mod directional;
pub mod emitter;
mod ies;
mod photometry;
mod point;
mod source;
mod spot;
mod strength;

#[cfg(test)]
mod contract;

pub use area::AreaShape;
pub use ies::{Ies, Profile};
pub use photometry::InvalidIes;
pub use source::{Attenuation, Extent};

/// Light that would arrive at a point if nothing stood in the way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSample {
    /// Unit direction towards the light.
    pub wi: Vec3,
    /// How far the light is; infinite for a directional one.
    pub distance: f32,
    /// What arrives there, before the surface's own factors: the classic intensity, attenuation included.
    pub radiance: Rgb,
    /// What to divide by, so that the mean over samples is the light that arrives: the density per steradian
    /// with which `wi` was chosen. 1 for the classic lights, whose places all count the same.
    pub pdf: f32,
}

/// Why a light cannot be: the field at fault and what it should be.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{message}")]
pub struct InvalidLight {
    /// The field, as in the scene file.
    pub field: &'static str,
    /// What is wrong, and what would be right.
    pub message: String,
}

/// A source of light.
pub trait Light: Send + Sync {
    /// Checks the numbers; called once, before the light is used.
    fn check(&self) -> Result<(), InvalidLight>;
    /// Light from one place of the source, chosen by `u` in the unit square; `None` when nothing arrives.
    fn sample(&self, from: Vec3, u: Vec2) -> Option<LightSample>;
    /// How many places of the source the classic integrator asks per sample: more than 1 for soft shadows.
    fn shadow_samples(&self) -> u32 {
        1
    }
    /// Whether it shines from a single place or direction, so that [`Light::sample`] asks nothing of `u`.
    fn is_point(&self) -> bool;
    /// Whether it is a surface, which paths meet and sample as a shape of the world; [`LightSample::radiance`] then is what
    /// arrives in physical units.
    fn is_surface(&self) -> bool {
        false
    }
    /// Works out once what every sample would work out anew: an intensity from a power.
    fn prepare(&mut self) {}
    /// Centre and radius of a ball that holds all places it shines from; `None` for one without a place.
    fn ball(&self) -> Option<(Vec3, f32)> {
        None
    }
    /// Its bounds in a light tree; `None` for one without a place. `world_radius` bounds the scene, as in [`Light::power`].
    fn bounds(&self, _world_radius: f32) -> Option<LightBounds> {
        None
    }
    /// The photometric file that it shines by, to be loaded.
    fn ies(&mut self) -> Option<&mut Ies> {
        None
    }
    /// The group of lights that it is kept apart with in layers.
    fn light_group(&self) -> Option<&str> {
        None
    }
    /// Light that is everywhere, from nowhere.
    fn ambient(&self) -> Rgb {
        Rgb::BLACK
    }
    /// Total power (its luminance), for choosing among many; `world_radius` bounds the scene. A light that
    /// does not fall off with the square of the distance counts by what arrives at that radius.
    fn power(&self, world_radius: f32) -> f32;
}

juggler_math::closed_set! {
    /// Every light. In JSON: `{"point": {"position": [0, 4, 0], "color": [1, 1, 1], "intensity": 60}}`.
    pub enum AnyLight: Light {
        ambient::Ambient,
        area::Area,
        directional::Directional,
        point::Point,
        spot::Spot,
    }
}

/// Refuses a number outside `low..=high`, and what is no number.
fn in_range(field: &'static str, value: f32, low: f32, high: f32) -> Result<(), InvalidLight> {
    let wrong = range::outside(field, value, low, high);
    wrong.map_or(Ok(()), |message| Err(InvalidLight { field, message }))
}

/// Refuses two fields that say the same.
fn either((field, has): (&'static str, bool), (other, has_other): (&'static str, bool)) -> Result<(), InvalidLight> {
    let message = || format!("`{field}` stands in place of `{other}`: write one of them, not both");
    if has && has_other { Err(InvalidLight { field, message: message() }) } else { Ok(()) }
}

fn check_color(color: Rgb, intensity: f32) -> Result<(), InvalidLight> {
    Strength { name: "intensity", value: Some(intensity), power: None }.check(color, color * intensity)
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
    let message = format!("`direction` must have a length, neither zero nor without end; it is {direction}");
    Err(InvalidLight { field: "direction", message })
}
