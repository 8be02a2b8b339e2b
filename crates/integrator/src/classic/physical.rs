//! Physically based materials in classic pictures: lights illuminate them, specular lobes are
//! traced, and one ray samples all glossy lobes. Their diffuse interreflection is limited to the
//! ambient light.

use super::crossing::opacity_choice;
use super::{Classic, sample_weight};
use crate::{PathState, VertexOutput};
use juggler_bsdf::{BsdfSample, BsdfView, Scatter};
use juggler_camera::sampler::Sampler;
use juggler_material::Shading;
use juggler_math::{Ray, Rgb, Vec2};
use juggler_shape::surface::Surface;
use juggler_world::{SceneLight, Vertex, World};

/// A shading point: a vertex with its evaluated material and the direction of view.
struct ShadingPoint<'a> {
    surface: &'a Surface,
    /// Surface that scatters light but for specular lobes: see [`World::lifted_surface`].
    scattering: &'a Surface,
    shading: &'a Shading,
    /// BSDF for the viewer at the origin of the ray.
    bsdf: BsdfView<'a>,
    time: f32,
}

impl Classic {
    /// Shades a vertex whose material is not the classic one, with this index of refraction outside
    /// of it. Returns `false` if opacity lets the ray pass.
    #[inline(always)]
    pub(super) fn physical(
        &self,
        world: &World,
        ray: &Ray,
        path: &PathState,
        vertex: &Vertex,
        outside_ior: f32,
        output: &mut VertexOutput,
    ) -> bool {
        let mut sampler = path.sampler.skipped(1);
        let choices = if world.is_simple(vertex) { Vec2::ZERO } else { opacity_choice(path) };
        let mut shading = Shading::black();
        world.shade_into(vertex, -ray.direction, outside_ior, choices.x, &mut shading);
        let room = path.depth < self.max_depth;
        if shading.opacity < 1.0 && choices.y >= shading.opacity {
            return false;
        }
        let wo = shading.frame.to_local(-ray.direction);
        let lifted = if shading.transmissive { None } else { world.lifted_surface(ray, vertex) };
        let scattering = lifted.as_ref().unwrap_or(&vertex.surface);
        let numbers = shading.bsdf.lobe_numbers(wo);
        let bsdf = shading.bsdf.view(wo, numbers.as_ref());
        let point = ShadingPoint { surface: &vertex.surface, scattering, shading: &shading, bsdf, time: ray.time };
        // Add emission and ambient light.
        let ambient = world.ambient();
        let reflected = if ambient.is_black() { Rgb::BLACK } else { point.shading.bsdf.albedo(wo) * ambient };
        output.record_shading(world, ray, vertex, &shading);
        let emitted = point.shading.emission + reflected;
        if !emitted.is_black() {
            output.add(emitted, world.shape_group(vertex.shape));
        }
        // Add direct illumination.
        if !point.shading.bsdf.is_specular() {
            for (number, light) in (0..).zip(world.lights()) {
                point.add_light(light, number as usize, &sampler.skipped(number), output);
            }
        }
        // Trace specular and glossy lobes.
        sampler.skip(world.lights().len() as u32);
        if room {
            self.reflect(&point, path, sampler, output);
        }
        true
    }

    /// Traces one ray for each specular lobe, and one for all glossy lobes.
    #[inline(always)]
    fn reflect(&self, point: &ShadingPoint, path: &PathState, mut sampler: Sampler, output: &mut VertexOutput) {
        let mut child = 0;
        point.bsdf.deltas().for_each(|sample| {
            self.trace_sample(point, path, &sample, child, output);
            child += 1;
        });
        if !point.shading.bsdf.is_glossy() {
            return;
        }
        let sample = point.bsdf.sample(sampler.next_2d(), sampler.next_1d());
        if let Some(glossy) = sample.filter(|sample| sample.scatter == Scatter::Glossy) {
            self.trace_sample(point, path, &glossy, child, output);
        }
    }

    fn trace_sample(
        &self,
        point: &ShadingPoint,
        path: &PathState,
        sample: &BsdfSample,
        child: u32,
        output: &mut VertexOutput,
    ) {
        if (path.beta * sample.weight).max_channel() >= self.min_weight && !sample.weight.is_black() {
            let direction = point.shading.frame.to_world(sample.wi);
            let sees_backdrop = path.history.sees_backdrop && sample.wi.z * point.bsdf.wo().z < 0.0;
            let from = if sample.scatter == Scatter::Specular { point.surface } else { point.scattering };
            output.trace_branch(from.spawn_ray(direction, point.time), sample.weight, sees_backdrop, child);
        }
    }
}

impl ShadingPoint<'_> {
    /// Adds a light's contribution, by one or more shadow rays.
    #[inline(always)]
    fn add_light(&self, light: &SceneLight, number: usize, sampler: &Sampler, output: &mut VertexOutput) {
        let SceneLight { samples, is_delta, is_surface, .. } = light;
        let scale = if *is_surface { 1.0 } else { self.shading.light_scale };
        for i in 0..*samples {
            let u = if *is_delta { Vec2::ZERO } else { sampler.subsequence(i, *samples).next_2d() };
            let Some(sample) = light.at(self.time).light.sample(self.scattering.point, u) else { continue };
            let (scattered, _) = self.bsdf.eval_pdf(self.shading.frame.to_local(sample.wi));
            if !scattered.is_black() {
                let ray = self.scattering.spawn_ray_to(sample.wi, sample.distance, self.time);
                let weight = sample_weight(scale, *samples, sample.pdf);
                output.add_light_shadow_ray(number, ray, sample.radiance * scattered * weight, light.group);
            }
        }
    }
}
