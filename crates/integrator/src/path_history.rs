//! History of a path since its last scattering event.

use super::path::Sampling;
use juggler_material::medium::{Interiors, Wavelength};
use juggler_math::Vec3;
#[cfg(doc)]
use juggler_world::World;
use juggler_world::{CasterId, LightSampleContext};

/// History of a path: the data of its last vertex that multiple importance sampling needs at the
/// next one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathHistory {
    /// Last scattering vertex, in world space; specular surfaces do not count.
    pub from: Vec3,
    /// Bound on the distance between `from` and the true surface along the surface's normal; 0 in
    /// media.
    pub error: f32,
    /// Unit normal at `from`, on the illuminated side; zero if light arrives from all directions.
    pub normal: Vec3,
    /// Density per steradian of the direction chosen there; infinite after the camera or a specular
    /// surface, where lights are not sampled.
    pub pdf: f32,
    /// Number of light samples taken at `from`.
    pub light_samples: u16,
    /// Product of η² over all refractions (pbrt's `etaScale`). Russian roulette compensates by it
    /// the scaling of radiance at refractive interfaces.
    pub eta_scale: f32,
    /// Solids that contain the path.
    pub interiors: Interiors,
    /// Wavelength of the path since its first dispersive surface; `None` for white light.
    pub wavelength: Option<Wavelength>,
    /// Number of surfaces passed through because of opacity, or hidden by priority, since the last
    /// scattering event.
    pub pass_throughs: u16,
    /// Number of scattering events so far, by kind.
    pub events: ScatterCounts,
    /// Specular sphere that the path has followed since `from`.
    pub caustic: CausticState,
    /// Whether the path is a camera ray that has only been transmitted so far, by clear or rough
    /// glass. The background shows it its backdrop ([`World::backdrop`]), if there is one.
    pub sees_backdrop: bool,
    /// Whether the path is an additional camera ray of its sample, which adds only the light that it
    /// sees directly and then ends (splitting; Arvo and Kirk, Particle Transport and Image Synthesis,
    /// 1990).
    pub is_split: bool,
}

/// State of a path on its way through a specular sphere, since the vertex where lights may have
/// been sampled through it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CausticState {
    /// Progress along the specular path.
    pub stage: CausticStage,
    /// Density per steradian of the direction chosen at that vertex.
    pub pdf: f32,
    /// Sine of the angle of incidence on the sphere.
    pub sine: f32,
}

/// Progress of a path through a specular sphere.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CausticStage {
    /// Light sampling could not have generated this path.
    Untracked,
    /// On the way from the vertex to a possible sphere.
    Approaching,
    /// Inside a sphere.
    Inside(CasterId),
    /// Reflected by the sphere, or refracted out of it.
    Exited(CasterId),
}

impl ScatterCounts {
    /// Whether no event occurred, so that the path is a camera ray still.
    #[inline]
    pub fn is_none(&self) -> bool {
        self.is_only_specular() && self.specular == 0
    }

    /// Whether no event but specular ones occurred, so that lights have not been sampled yet.
    #[inline]
    pub fn is_only_specular(&self) -> bool {
        self.diffuse == 0 && self.glossy == 0 && self.volume == 0
    }
}

impl CausticState {
    /// State of a path that light sampling through spheres cannot generate.
    pub const NONE: Self = Self { stage: CausticStage::Untracked, pdf: 0.0, sine: 0.0 };
}

/// Number of scattering events of a path, by kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ScatterCounts {
    /// Diffuse reflection or transmission.
    pub diffuse: u16,
    /// Glossy reflection or transmission.
    pub glossy: u16,
    /// Specular reflection or refraction.
    pub specular: u16,
    /// Scattering in media.
    pub volume: u16,
}

impl PathHistory {
    /// State of a camera ray.
    pub const CAMERA: Self = Self {
        from: Vec3::ZERO,
        error: 0.0,
        normal: Vec3::ZERO,
        pdf: f32::INFINITY,
        light_samples: 1,
        eta_scale: 1.0,
        interiors: Interiors::NONE,
        wavelength: None,
        pass_throughs: 0,
        events: ScatterCounts { diffuse: 0, glossy: 0, specular: 0, volume: 0 },
        caustic: CausticState::NONE,
        sees_backdrop: true,
        is_split: false,
    };

    /// Context of light samples at `from`.
    #[inline]
    pub fn light_sample_context(&self, time: f32) -> LightSampleContext {
        LightSampleContext { point: self.from, error: self.error, normal: self.normal, time }
    }

    /// Multiple importance sampling weight of emission that this path hit. `light` is the density
    /// of one light sample.
    #[inline]
    pub fn emission_weight(&self, sampling: Sampling, light: impl FnOnce() -> f32) -> f32 {
        if self.pdf == f32::INFINITY {
            1.0
        } else {
            sampling.bsdf_weight(self.pdf, light() * f32::from(self.light_samples))
        }
    }
}
