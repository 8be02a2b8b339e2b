//! Lights of the scene, and the properties that every vertex needs.

use juggler_camera::aov::LightGroup;
use juggler_light::AnyLight;
use juggler_light::emitter::LightBounds;
use juggler_math::{Rgb, Vec3};

/// A light, static or animated.
#[derive(Clone, Debug)]
pub struct SceneLight {
    /// [`Light::shadow_samples`](juggler_light::Light::shadow_samples), at least 1.
    pub samples: u32,
    /// [`Light::is_delta`](juggler_light::Light::is_delta).
    pub is_delta: bool,
    /// [`Light::is_surface`](juggler_light::Light::is_surface).
    pub is_surface: bool,
    /// Light group whose AOV receives its light.
    pub group: LightGroup,
    /// Ambient radiance, averaged over the shutter interval.
    pub(super) ambient: Rgb,
    /// The light during the first of the equal parts of the shutter interval, one for each state.
    first: LightState,
    /// The light during the other parts.
    others: Box<[LightState]>,
}

/// State of a light during a part of the shutter interval.
#[derive(Clone, Debug)]
pub struct LightState {
    /// The light in this state.
    pub light: AnyLight,
    /// [`Light::bounding_sphere`](juggler_light::Light::bounding_sphere).
    bounding_sphere: Option<(Vec3, f32)>,
}

impl From<AnyLight> for SceneLight {
    fn from(light: AnyLight) -> Self {
        Self::from_states(&light, &[])
    }
}

impl SceneLight {
    /// Creates a light with the states `first` and `others`, each for an equal part of the shutter
    /// interval.
    pub fn from_states(first: &AnyLight, others: &[AnyLight]) -> Self {
        let all = || std::iter::once(first).chain(others);
        let count = (others.len() + 1) as f32;
        Self {
            samples: all().map(|light| light.shadow_samples()).fold(1, u32::max),
            is_delta: all().all(|light| light.is_delta()),
            is_surface: all().any(|light| light.is_surface()),
            group: LightGroup::REST,
            ambient: all().fold(Rgb::BLACK, |sum, light| sum + light.ambient()) / count,
            first: LightState::new(first.clone()),
            others: others.iter().cloned().map(LightState::new).collect(),
        }
    }

    /// Bounds for the light tree over the shutter interval; `None` for an infinite light.
    /// `world_radius` is the radius of a sphere around the scene.
    pub fn bounds(&self, world_radius: f32) -> Option<LightBounds> {
        let all = || std::iter::once(&self.first).chain(&self.others);
        let mut bounds: Option<LightBounds> = None;
        for state in all() {
            let next = state.light.bounds(world_radius)?;
            bounds = Some(bounds.map_or(next, |before| LightBounds {
                bounds: before.bounds.union(next.bounds),
                power: before.power.max(next.power),
                // The light may rotate.
                axis: Vec3::Z,
                cos_theta_o: -1.0,
                ..next
            }));
        }
        bounds
    }

    /// Mean of [`Light::power`](juggler_light::Light::power) over the shutter interval.
    pub fn power(&self, world_radius: f32) -> f32 {
        let all = || std::iter::once(&self.first).chain(&self.others);
        all().map(|state| state.light.power(world_radius)).sum::<f32>() / all().count() as f32
    }

    /// Whether the light changes while the shutter is open.
    pub fn moves(&self) -> bool {
        !self.others.is_empty()
    }

    /// State of the light at a time, 0 to 1 over the shutter interval.
    #[inline]
    pub fn at(&self, time: f32) -> &LightState {
        if self.others.is_empty() {
            return &self.first;
        }
        let part = (time * (self.others.len() + 1) as f32) as usize;
        match part.min(self.others.len()).checked_sub(1) {
            Some(other) => &self.others[other],
            None => &self.first,
        }
    }
}

impl LightState {
    fn new(mut light: AnyLight) -> Self {
        light.prepare();
        let bounding_sphere = light.bounding_sphere();
        Self { light, bounding_sphere }
    }

    /// Whether the whole light lies below the tangent plane at `point`, so that it cannot
    /// illuminate a surface with this `normal`.
    #[inline]
    pub fn is_below(&self, point: Vec3, normal: Vec3) -> bool {
        self.bounding_sphere.is_some_and(|(center, radius)| (center - point).dot(normal) < -radius)
    }
}
