//! What a path of light remembers of where it last was scattered.

use super::path::Sampling;
use juggler_material::medium::Interiors;
use juggler_math::Vec3;
use juggler_world::{CasterId, Receiver};

/// What a path of light remembers of its last vertex, to know how else it might have come to the next one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trail {
    /// Where it last was scattered, but for mirrors and clear glass.
    pub from: Vec3,
    /// Bound on the distance between `from` and the true surface along the surface's normal; 0 in
    /// media.
    pub error: f32,
    /// Unit normal there, on the side that light comes to; zero where it may come from everywhere.
    pub normal: Vec3,
    /// Density per steradian with which its direction was chosen; infinite after the camera, a mirror or clear glass,
    /// from where no light would have been asked.
    pub pdf: f32,
    /// How many lights were asked there.
    pub asked: u16,
    /// Squared ratio of the indices of refraction behind and before: what radiance loses on its way into denser things
    /// and gains on its way out, which roulette must not count.
    pub ior_scale: f32,
    /// The solids that it is in.
    pub inside: Interiors,
    /// How often it went through holes since it was scattered.
    pub passed: u16,
    /// How often it was scattered so far, by kind.
    pub scattered: Counts,
    /// By which ball it came since.
    pub chain: Chain,
}

/// What a path has met since it was scattered where lights were asked by way of polished balls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chain {
    /// How far it has come.
    pub stage: Stage,
    /// Density per steradian with which its direction was chosen there.
    pub pdf: f32,
    /// Sine of the angle at which it met the ball.
    pub sine: f32,
}

/// How far a path has come on a way by a ball.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// No light would have been asked on its way.
    Elsewhere,
    /// On its way to what may be a ball.
    Asked,
    /// In a ball.
    Inside(CasterId),
    /// It has left the ball.
    Done(CasterId),
}

impl Counts {
    /// Whether no light was asked yet.
    #[inline]
    pub fn is_first(&self) -> bool {
        self.diffuse == 0 && self.glossy == 0 && self.volume == 0
    }
}

impl Chain {
    /// Of a path that no light would have been asked for.
    pub const NONE: Self = Self { stage: Stage::Elsewhere, pdf: 0.0, sine: 0.0 };
}

/// How often a path was scattered, by kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// By matte surfaces.
    pub diffuse: u16,
    /// By rough mirrors and rough glass.
    pub glossy: u16,
    /// By mirrors and clear glass.
    pub specular: u16,
    /// By media.
    pub volume: u16,
}

impl Trail {
    /// Of a ray from the camera.
    pub const CAMERA: Self = Self {
        from: Vec3::ZERO,
        error: 0.0,
        normal: Vec3::ZERO,
        pdf: f32::INFINITY,
        asked: 1,
        ior_scale: 1.0,
        inside: Interiors::NONE,
        passed: 0,
        scattered: Counts { diffuse: 0, glossy: 0, specular: 0, volume: 0 },
        chain: Chain::NONE,
    };

    /// As what light comes to.
    #[inline]
    pub fn receiver(&self, time: f32) -> Receiver {
        Receiver { point: self.from, error: self.error, normal: self.normal, time }
    }

    /// Weight of light that this path has hit, where each light sample finds it with the density
    /// `light`.
    #[inline]
    pub fn weight(&self, sampling: Sampling, light: impl FnOnce() -> f32) -> f32 {
        if self.pdf == f32::INFINITY { 1.0 } else { sampling.bsdf_weight(self.pdf, light() * f32::from(self.asked)) }
    }
}
