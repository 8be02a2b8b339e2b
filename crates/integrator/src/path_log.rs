//! Log of path events, with which the probe explains a pixel. Renders do not keep it.

use super::{PathKind, PathState, SurfaceHit};
use juggler_bsdf::{Scatter, fresnel};
use juggler_camera::aov::LightGroup;
use juggler_math::{Ray, Rgb, Vec3};
use juggler_world::{Vertex, World};

/// Maximum distance between unit directions that still counts as specular reflection.
const REFLECTION_TOLERANCE: f32 = 1e-3;

/// What a path did at a vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Scattering {
    /// Diffuse scattering.
    Diffuse,
    /// Glossy scattering, by rough metal or rough glass.
    Glossy,
    /// Specular reflection or refraction.
    Specular,
    /// Scattering in a medium.
    Volume,
    /// Straight passage through a surface, because of its opacity.
    PassThrough,
}

/// A scattering event, and the side of the surface on which the path continues.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct ScatterEvent {
    /// Kind of scattering.
    pub scattering: Scattering,
    /// Whether the path continues on the other side of the surface.
    pub transmitted: bool,
}

/// Path events since the log was cleared.
#[derive(Clone, Debug, Default)]
pub struct PathLog {
    /// Contributions in the order in which samples receive them: sample index, number of path
    /// segments, light group, radiance.
    pub lights: Vec<(usize, PathKind, LightGroup, Rgb)>,
    /// Surfaces that paths hit, except those passed through because of opacity: sample index and
    /// surface.
    pub hits: Vec<(usize, ShadingPoint)>,
}

/// Shading data of a surface that a path hit.
#[derive(Clone, Copy, Debug)]
pub struct ShadingPoint {
    /// Unit shading normal, after normal and bump mapping.
    pub normal: Vec3,
    /// Kind of scattering of the strongest lobe that is not specular.
    pub scatter: Scatter,
    /// The surface, of all those at its place.
    pub vertex: Vertex,
}

impl PathLog {
    /// Removes all entries.
    pub fn clear(&mut self) {
        self.lights.clear();
        self.hits.clear();
    }

    /// Records a surface that a path of the sample `slot` hit.
    pub fn record_hit(&mut self, slot: usize, hit: &SurfaceHit) {
        self.hits.push((slot, ShadingPoint { normal: hit.normal, scatter: hit.scatter, vertex: *hit.vertex }));
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

impl ScatterEvent {
    /// Specular reflection.
    pub const REFLECTED: Self = Self { scattering: Scattering::Specular, transmitted: false };
    /// Specular refraction.
    pub const REFRACTED: Self = Self { scattering: Scattering::Specular, transmitted: true };
    /// Scattering in a medium.
    pub const VOLUME: Self = Self { scattering: Scattering::Volume, transmitted: false };
    /// Straight passage through a surface.
    pub const PASS_THROUGH: Self = Self { scattering: Scattering::PassThrough, transmitted: true };
}

/// A ray and the surface that it hit.
#[derive(Clone, Copy)]
pub struct HitRecord<'a> {
    /// Ray that arrived.
    pub ray: &'a Ray,
    /// State of its path before the vertex.
    pub path: &'a PathState,
    /// Surface that the ray hit, if any.
    pub vertex: Option<&'a Vertex>,
    /// Shading normal and scattering there, unless opacity lets the path pass.
    pub shading_point: Option<&'a ShadingPoint>,
}

impl HitRecord<'_> {
    /// Derives the event at this vertex from the state of the path that continues along `ray`.
    pub fn event(&self, world: &World, ray: &Ray, next: &PathState) -> ScatterEvent {
        let (before, after) = (self.path.history, next.history);
        if after.events.volume > before.events.volume {
            return ScatterEvent::VOLUME;
        }
        let (Some(vertex), Some(point)) = (self.vertex, self.shading_point) else { return ScatterEvent::PASS_THROUGH };
        if after.pass_throughs > before.pass_throughs {
            return ScatterEvent::PASS_THROUGH;
        }
        let normal = vertex.surface.normal;
        let transmitted = normal.dot(ray.direction) * normal.dot(self.ray.direction) > 0.0;
        let (a, b) = (before.events, after.events);
        let scattering = match (b.diffuse > a.diffuse, b.glossy > a.glossy, b.specular > a.specular) {
            (true, ..) => Scattering::Diffuse,
            (_, true, _) => Scattering::Glossy,
            (_, _, true) => Scattering::Specular,
            // The classic integrator does not count scattering events.
            _ => self.classic(world, vertex, point, ray, transmitted),
        };
        ScatterEvent { scattering, transmitted }
    }

    /// Classifies a classic ray: glossy if it belongs to a bundle, else specular.
    fn classic(
        &self,
        world: &World,
        vertex: &Vertex,
        point: &ShadingPoint,
        ray: &Ray,
        transmitted: bool,
    ) -> Scattering {
        let is_spread = match (world.phong(vertex), transmitted) {
            (Some(phong), false) => phong.glossy.half_angle_radians > 0.0,
            (Some(phong), true) => phong.blurry.half_angle_radians > 0.0,
            (None, true) => point.scatter != Scatter::Specular,
            (None, false) => {
                let wo = -self.ray.direction;
                let normal = if point.normal.dot(wo) < 0.0 { -point.normal } else { point.normal };
                (fresnel::reflect(wo, normal) - ray.direction).length() > REFLECTION_TOLERANCE
            }
        };
        if is_spread { Scattering::Glossy } else { Scattering::Specular }
    }

    /// Event of a light sample: the surface's kind of scattering, or the medium's if the path did
    /// not reach the surface.
    pub fn light_sample_event(&self) -> ScatterEvent {
        match self.shading_point {
            Some(point) => ScatterEvent { scattering: point.scatter.into(), transmitted: false },
            None => ScatterEvent::VOLUME,
        }
    }
}
