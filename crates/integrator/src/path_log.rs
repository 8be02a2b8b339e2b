//! What paths did, step by step: for those who ask why a pixel is as it is. Nothing of it is kept while pictures are made.

use super::{PathState, Sight, Way};
use juggler_bsdf::{Scatter, fresnel};
use juggler_camera::layer::LightGroup;
use juggler_math::{Ray, Rgb, Vec3};
use juggler_world::{Vertex, World};

/// How far a direction may lie beside that of a mirror and count as mirrored by it.
const STRAIGHT: f32 = 1e-3;

/// What a path did at a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Scattering {
    /// Scattered by a matt surface.
    Diffuse,
    /// Scattered by a rough mirror or rough glass.
    Glossy,
    /// Mirrored or refracted by what is smooth.
    Specular,
    /// Scattered by a medium.
    Volume,
    /// It went on as if nothing had been there: a hole.
    Passed,
}

/// What a path did at a place, and to which side of the surface it went on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Event {
    /// How it was scattered.
    pub scattering: Scattering,
    /// Whether it goes on behind the surface.
    pub transmitted: bool,
}

/// What samples did since the log was emptied.
#[derive(Clone, Debug, Default)]
pub struct PathLog {
    /// Light, in the order in which samples gather it: the slot, how far it came, its group, and how much.
    pub lights: Vec<(usize, Way, LightGroup, Rgb)>,
    /// What paths met that is no hole: the slot, and what is known of the place.
    pub seen: Vec<(usize, Seen)>,
}

/// A place as it was seen.
#[derive(Clone, Copy, Debug)]
pub struct Seen {
    /// Unit shading normal there, as maps have turned it.
    pub normal: Vec3,
    /// How most of what is no delta is scattered.
    pub scatter: Scatter,
}

impl PathLog {
    /// Removes all entries.
    pub fn clear(&mut self) {
        self.lights.clear();
        self.seen.clear();
    }

    /// Records the first hit of the sample in `slot`.
    pub fn see(&mut self, slot: usize, sight: &Sight) {
        self.seen.push((slot, Seen { normal: sight.normal, scatter: sight.scatter }));
    }
}

impl From<Scatter> for Scattering {
    fn from(scatter: Scatter) -> Self {
        match scatter {
            Scatter::Diffuse => Self::Diffuse,
            Scatter::Glossy => Self::Glossy,
            Scatter::Specular => Self::Specular,
        }
    }
}

impl Event {
    /// Mirrored by what is smooth.
    pub const MIRRORED: Self = Self { scattering: Scattering::Specular, transmitted: false };
    /// Refracted by it.
    pub const REFRACTED: Self = Self { scattering: Scattering::Specular, transmitted: true };
    /// Scattered by a medium.
    pub const VOLUME: Self = Self { scattering: Scattering::Volume, transmitted: false };
    /// It went through a hole.
    pub const PASSED: Self = Self { scattering: Scattering::Passed, transmitted: true };
}

/// A ray on its way, and what it met.
#[derive(Clone, Copy)]
pub struct Arrival<'a> {
    /// Ray that arrived.
    pub ray: &'a Ray,
    /// State of its path before the vertex.
    pub path: &'a PathState,
    /// Surface that the ray hit, if any.
    pub vertex: Option<&'a Vertex>,
    /// Shading normal and scattering there, if the surface is no opacity gap.
    pub seen: Option<&'a Seen>,
}

impl Arrival<'_> {
    /// What became of it that goes on as `ray`.
    pub fn event(&self, world: &World, ray: &Ray, next: &PathState) -> Event {
        let (before, after) = (self.path.trail, next.trail);
        if after.scattered.volume > before.scattered.volume {
            return Event::VOLUME;
        }
        let (Some(vertex), Some(seen)) = (self.vertex, self.seen) else { return Event::PASSED };
        if after.passed > before.passed {
            return Event::PASSED;
        }
        let normal = vertex.surface.normal;
        let transmitted = normal.dot(ray.direction) * normal.dot(self.ray.direction) > 0.0;
        let (a, b) = (before.scattered, after.scattered);
        let scattering = match (b.diffuse > a.diffuse, b.glossy > a.glossy, b.specular > a.specular) {
            (true, ..) => Scattering::Diffuse,
            (_, true, _) => Scattering::Glossy,
            (_, _, true) => Scattering::Specular,
            // Classic rays do not count.
            _ => self.classic(world, vertex, seen, ray, transmitted),
        };
        Event { scattering, transmitted }
    }

    /// Whether a classic ray is one of a bundle.
    fn classic(&self, world: &World, vertex: &Vertex, seen: &Seen, ray: &Ray, transmitted: bool) -> Scattering {
        let is_spread = match (world.phong(vertex), transmitted) {
            (Some(phong), false) => phong.glossy.half_angle_radians > 0.0,
            (Some(phong), true) => phong.blurry.half_angle_radians > 0.0,
            (None, true) => seen.scatter != Scatter::Specular,
            (None, false) => {
                let wo = -self.ray.direction;
                let normal = if seen.normal.dot(wo) < 0.0 { -seen.normal } else { seen.normal };
                (fresnel::reflect(wo, normal) - ray.direction).length() > STRAIGHT
            }
        };
        if is_spread { Scattering::Glossy } else { Scattering::Specular }
    }

    /// How light that was asked for is scattered: as most is; by the medium where the path never came to the surface.
    pub fn lit(&self) -> Event {
        match self.seen {
            Some(seen) => Event { scattering: seen.scatter.into(), transmitted: false },
            None => Event::VOLUME,
        }
    }
}
