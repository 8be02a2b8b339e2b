//! A light that shines from somewhere, with what is asked of it at every vertex.

use juggler_camera::layer::LightGroup;
use juggler_light::AnyLight;
use juggler_light::emitter::LightBounds;
use juggler_math::{Rgb, Vec3};

/// A light, still or moving.
#[derive(Clone, Debug)]
pub struct Lamp {
    /// [`Light::shadow_samples`](juggler_light::Light::shadow_samples), at least 1.
    pub samples: u32,
    /// [`Light::is_point`](juggler_light::Light::is_point).
    pub is_point: bool,
    /// [`Light::is_surface`](juggler_light::Light::is_surface).
    pub is_surface: bool,
    /// Which group of lights it is of.
    pub group: LightGroup,
    /// Light from everywhere, in the mean of its time.
    pub(super) ambient: Rgb,
    /// In the first of as many parts of the time that the shutter is open as there are sources.
    first: Source,
    /// In the other parts.
    others: Box<[Source]>,
}

/// A light as it is for a while.
#[derive(Clone, Debug)]
pub struct Source {
    /// The light.
    pub light: AnyLight,
    /// [`Light::ball`](juggler_light::Light::ball).
    ball: Option<(Vec3, f32)>,
}

impl From<AnyLight> for Lamp {
    fn from(light: AnyLight) -> Self {
        Self::moving(&light, &[])
    }
}

impl Lamp {
    /// A light that is as `first` and the `others` say, each for the same part of the time that the shutter is open.
    pub fn moving(first: &AnyLight, others: &[AnyLight]) -> Self {
        let all = || std::iter::once(first).chain(others);
        let count = (others.len() + 1) as f32;
        Self {
            samples: all().map(|light| light.shadow_samples()).fold(1, u32::max),
            is_point: all().all(|light| light.is_point()),
            is_surface: all().any(|light| light.is_surface()),
            group: LightGroup::REST,
            ambient: all().fold(Rgb::BLACK, |sum, light| sum + light.ambient()) / count,
            first: Source::new(first.clone()),
            others: others.iter().cloned().map(Source::new).collect(),
        }
    }

    /// What the light tree needs to know, over all its time; `None` for one without a place. `world_radius` bounds the
    /// scene.
    pub fn bounds(&self, world_radius: f32) -> Option<LightBounds> {
        let all = || std::iter::once(&self.first).chain(&self.others);
        let mut bounds: Option<LightBounds> = None;
        for source in all() {
            let next = source.light.bounds(world_radius)?;
            bounds = Some(bounds.map_or(next, |before| LightBounds {
                bounds: before.bounds.union(next.bounds),
                power: before.power.max(next.power),
                // It may have turned.
                axis: Vec3::Z,
                cos_theta_o: -1.0,
                ..next
            }));
        }
        bounds
    }

    /// Mean of [`Light::power`](juggler_light::Light::power) over its time.
    pub fn power(&self, world_radius: f32) -> f32 {
        let all = || std::iter::once(&self.first).chain(&self.others);
        all().map(|source| source.light.power(world_radius)).sum::<f32>() / all().count() as f32
    }

    /// Whether it is not always the same.
    pub fn moves(&self) -> bool {
        !self.others.is_empty()
    }

    /// What it is at a time between 0 and 1.
    #[inline]
    pub fn at(&self, time: f32) -> &Source {
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

impl Source {
    fn new(mut light: AnyLight) -> Self {
        light.prepare();
        let ball = light.ball();
        Self { light, ball }
    }

    /// Whether all of it lies below the plane through `point`: it cannot light what faces along `normal` there.
    #[inline]
    pub fn is_below(&self, point: Vec3, normal: Vec3) -> bool {
        self.ball.is_some_and(|(centre, radius)| (centre - point).dot(normal) < -radius)
    }
}
