//! Caustics of specular spheres: light sampled through a sphere, and emitters that a path hits
//! behind one. Both are weighted by multiple importance sampling (Veach 1997, section 9.2.2), so
//! that light which only one of them finds is neither lost nor counted twice.

use super::super::{CausticStage, CausticState, PathState, VertexOutput};
use super::surface::ShadingPoint;
use super::{Dimension, Path, Sampling};
use arrayvec::ArrayVec;
use juggler_bsdf::{BsdfSample, Scatter};
use juggler_material::medium::Interiors;
use juggler_math::{Ray, Rgb, Vec2, Vec3, robust};
use juggler_shape::surface::Surface;
use juggler_world::manifold::{Connection, EndPoint, SpecularPath, connections, solid_angle_ratio};
use juggler_world::{CausticCaster, EmitterId, EmitterSample, LightSampleContext, Vertex, World};

/// Length that the shadow ray to a sphere stops short, in radii: at grazing incidence it must not
/// hit the sphere too early.
const RAY_MARGIN: f32 = 1e-4;

/// Emitter that a path hit.
#[derive(Clone, Copy)]
pub enum HitEmitter {
    /// A point on an emissive surface.
    Surface(Vec3),
    /// The background.
    Background,
}

/// Context of light samples at the sphere's center.
fn center_context(caster: &CausticCaster, time: f32) -> LightSampleContext {
    LightSampleContext { point: caster.sphere.center, error: 0.0, normal: Vec3::ZERO, time }
}

/// Ratio of an emitter's solid angle along `hit_ray` to that along `center_ray`, without the factor
/// of distance; 0 if the rays see different sides of it.
pub fn emitter_cosine_ratio(center_ray: &Ray, hit_ray: &Ray, vertex: &Vertex) -> f32 {
    cosine_ratio(vertex.surface.normal, center_ray.direction, hit_ray.direction)
}

fn cosine_ratio(normal: Vec3, numerator: Vec3, denominator: Vec3) -> f32 {
    let ratio = normal.dot(numerator) / normal.dot(denominator);
    if ratio > 0.0 { ratio } else { 0.0 }
}

impl Path {
    /// Multiple importance sampling weight of emission that a path hit along `ray`. `light` is the
    /// density of light sampling from the last vertex, and `bent` that of light sampling from a
    /// sphere's center.
    pub fn emission_weight(
        &self,
        world: &World,
        path: &PathState,
        ray: &Ray,
        light: impl FnOnce() -> f32,
        hit: HitEmitter,
        bent: impl FnOnce(&LightSampleContext, &Ray) -> f32,
    ) -> f32 {
        let CausticState { stage: CausticStage::Exited(id), pdf, sine } = path.history.caustic else {
            return path.history.emission_weight(self.sampling, light);
        };
        let Some((caster, kind)) = world.caster(id) else { return 1.0 };
        let center = caster.sphere.center;
        let (direction, to) = match hit {
            HitEmitter::Surface(point) => ((point - center).normalize_or_zero(), caster.sphere.end_point(point)),
            HitEmitter::Background => (ray.direction, Some(EndPoint::infinity(ray.direction))),
        };
        let from = path.history.light_sample_context(ray.time);
        let (Some(start), Some(end)) = (caster.sphere.end_point(from.point), to) else { return 1.0 };
        let light_pdf = bent(&center_context(caster, ray.time), &Ray { time: ray.time, ..Ray::new(center, direction) });
        let light_pdf =
            light_pdf * solid_angle_ratio(kind, &start, &end, sine) * world.visible_casters(&from).probability(id);
        if light_pdf > 0.0 { self.sampling.bsdf_weight(pdf, light_pdf) } else { 1.0 }
    }

    /// Samples one light through one specular sphere.
    pub fn sample_caustics(&self, point: &ShadingPoint, world: &World, path: &PathState, output: &mut VertexOutput) {
        // Select a sphere and a kind of specular path.
        let Some(visible_casters) = point.visible_casters else { return };
        let picked = visible_casters.pick(path.sampler.skipped(Dimension::CausticCaster as u32).next_1d());
        let Some((id, probability)) = picked else { return };
        let Some((caster, kind)) = world.caster(id).filter(|(_, kind)| self.allows(*kind, path)) else { return };
        // Sample a light from the center of the sphere.
        let u = path.sampler.skipped(Dimension::CausticLight as u32).next_2d();
        let Some(light) = world.sample_light(&center_context(caster, point.time), u) else { return };
        let light_point = caster.sphere.center + light.wi * light.distance;
        let to = if light.distance < f32::INFINITY {
            caster.sphere.end_point(light_point)
        } else {
            Some(EndPoint::infinity(light.wi))
        };
        let (Some(start), Some(end)) = (caster.sphere.end_point(point.scattering.point), to) else { return };
        // Connect both by all specular paths.
        for connection in connections(kind, &start, &end) {
            let pdf = probability * light.pdf * solid_angle_ratio(kind, &start, &end, connection.sine);
            let sample =
                CausticSample { world, caster, kind, light: &light, light_point, pdf, sampling: self.sampling };
            point.add_caustic_sample(&sample, &connection, path, output);
        }
    }

    /// Whether the path limits allow the vertices that the specular path adds.
    fn allows(&self, kind: SpecularPath, path: &PathState) -> bool {
        let more = if kind == SpecularPath::Reflected { 1 } else { 2 };
        let specular = u32::from(path.history.events.specular) + more;
        path.depth + 1 + more < self.max_depth && self.max_specular.is_none_or(|limit| specular <= limit)
    }
}

/// A light sample through a specular sphere.
struct CausticSample<'a> {
    world: &'a World,
    caster: &'a CausticCaster,
    kind: SpecularPath,
    light: &'a EmitterSample,
    /// Sampled point on the light, if the light is finite.
    light_point: Vec3,
    /// Density per steradian of the sampled path.
    pdf: f32,
    sampling: Sampling,
}

impl CausticSample<'_> {
    /// Radiance from the light along the specular path, and the density of that path.
    fn light_along(&self, last: Vec3, time: f32) -> Option<(Rgb, f32)> {
        let EmitterSample { radiance, distance, emitter, normal, wi, .. } = *self.light;
        if distance == f32::INFINITY {
            return Some((radiance, self.pdf));
        }
        let to_light = self.light_point - last;
        let EmitterId::Light(index) = emitter else {
            let ratio = if normal == Vec3::ZERO { 0.0 } else { cosine_ratio(normal, wi, to_light.normalize_or_zero()) };
            return (ratio > 0.0).then_some((radiance, self.pdf * ratio));
        };
        let there =
            self.world.point_light(index, &LightSampleContext { point: last, error: 0.0, normal: Vec3::ZERO, time })?;
        Some((there.radiance * (to_light.length_squared() / (distance * distance)), self.pdf))
    }

    /// Shadow rays along the segments of the specular path, each of which ends before the next
    /// surface.
    fn shadow_rays(&self, from: &Surface, connection: &Connection, time: f32) -> ArrayVec<Ray, 3> {
        let sphere = self.caster.sphere;
        let error = robust::gamma(8) * (sphere.center.abs().max_element() + sphere.radius);
        let on_sphere =
            connection.vertices.map(|to| Surface::new(sphere.center + to * sphere.radius, error, to, Vec2::ZERO));
        let shadow_ray = |from: &Surface, to: Vec3, short: f32| {
            let (offset, distance) = (to - from.point, (to - from.point).length());
            from.spawn_ray_to(offset / distance, distance - short, time)
        };
        let [first, last] = &on_sphere;
        let mut segments = ArrayVec::new();
        segments.push(shadow_ray(from, first.point, RAY_MARGIN * sphere.radius));
        if self.kind != SpecularPath::Reflected {
            segments.push(shadow_ray(first, last.point, RAY_MARGIN * sphere.radius));
        }
        segments.push(match self.light.distance {
            f32::INFINITY => last.spawn_ray(self.light.wi, time),
            _ => shadow_ray(last, self.light_point, 0.0),
        });
        segments
    }
}

impl ShadingPoint<'_> {
    fn add_caustic_sample(
        &self,
        sample: &CausticSample,
        connection: &Connection,
        path: &PathState,
        output: &mut VertexOutput,
    ) {
        // Evaluate the BSDF in the direction of the path.
        let wi = self.shading.frame.to_local(connection.direction);
        if !self.scatters_into(connection.direction, wi) || !self.interiors_towards(path, wi).is_empty() {
            return;
        }
        if sample.kind != SpecularPath::Reflected
            && self.replaces_by_backdrop(sample.light.emitter, sample.world, path, wi)
        {
            return;
        }
        let (scattered, bsdf_pdf) = self.eval_pdf(connection.direction, wi);
        // Compute the radiance that leaves the light along the path, and the density of the path.
        let last = sample.caster.sphere.center + connection.vertices[1] * sample.caster.sphere.radius;
        let Some((radiance, pdf)) = sample.light_along(last, self.time).filter(|_| !scattered.is_black()) else {
            return;
        };
        if !(pdf > 0.0 && pdf < f32::INFINITY) {
            return;
        }
        // Add the contribution if all segments are unoccluded.
        let contribution = radiance * scattered * sample.caster.throughput(sample.kind, connection.sine);
        let group = sample.world.light_group(sample.light.emitter);
        let segments = sample.shadow_rays(self.scattering, connection, self.time);
        let weight = self.light_sample_weight(sample.sampling, sample.light, pdf, bsdf_pdf);
        output.add_bent_shadow_ray(segments, contribution * weight, group);
    }

    /// State of the path through specular spheres after it continues from the surface of `shape`
    /// by `sample`, into the solids `inside`.
    pub fn caustic_state(
        &self,
        world: &World,
        shape: u32,
        path: &PathState,
        sample: &BsdfSample,
        inside: Interiors,
    ) -> CausticState {
        if !world.has_casters() {
            return CausticState::NONE;
        }
        if sample.scatter != Scatter::Specular {
            let stage = if inside.is_empty() { CausticStage::Approaching } else { CausticStage::Untracked };
            return CausticState { stage, pdf: sample.pdf, sine: 0.0 };
        }
        let caustic = path.history.caustic;
        let goes_through = sample.wi.z * self.bsdf.wo().z < 0.0;
        let stage = match caustic.stage {
            CausticStage::Approaching if path.history.interiors.is_empty() && self.bsdf.wo().z > 0.0 => {
                let wo = self.bsdf.wo();
                let sine = (wo.x * wo.x + wo.y * wo.y).sqrt();
                let caster = world.caster_of_shape(shape, goes_through);
                let stage =
                    if goes_through { caster.map(CausticStage::Inside) } else { caster.map(CausticStage::Exited) };
                return CausticState { stage: stage.unwrap_or(CausticStage::Untracked), sine, ..caustic };
            }
            CausticStage::Inside(id) if goes_through && inside.is_empty() => {
                let is_same = world.caster(id).is_some_and(|(caster, _)| caster.has_shape(shape));
                if is_same { CausticStage::Exited(id) } else { CausticStage::Untracked }
            }
            _ => CausticStage::Untracked,
        };
        CausticState { stage, ..caustic }
    }
}
