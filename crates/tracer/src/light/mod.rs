//! Lights: what arrives at a point, and from where.

use juggler_math::{Rgb, Vec2, Vec3};

mod point;

/// Light that would arrive at a point if nothing stood in the way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSample {
    /// Unit direction towards the light.
    pub wi: Vec3,
    /// How far the light is; infinite for a directional one.
    pub distance: f32,
    /// What arrives there, before the surface's own factors: the classic intensity, attenuation included.
    pub radiance: Rgb,
    /// Density per steradian with which `wi` was chosen; 1 for a light that is a single point.
    pub pdf: f32,
}

/// A source of light.
pub trait Light: Send + Sync {
    /// Light from one place of the source, chosen by `u` in the unit square; `None` when nothing arrives.
    fn sample(&self, from: Vec3, u: Vec2) -> Option<LightSample>;
    /// How many places of the source the classic integrator asks per sample: more than 1 for soft shadows.
    fn shadow_samples(&self) -> u32 {
        1
    }
    /// Light that is everywhere, from nowhere.
    fn ambient(&self) -> Rgb {
        Rgb::BLACK
    }
    /// Total power, for choosing among many; `world_radius` bounds the scene.
    fn power(&self, world_radius: f32) -> f32;
}

closed_set! {
    /// Every light. In JSON: `{"point": {"position": [0, 4, 0], "color": [1, 1, 1], "intensity": 60}}`.
    pub enum AnyLight: Light { point::Point }
}
