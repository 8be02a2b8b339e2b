//! Materials that scatter as physics says, in classic pictures: lit by lamps, seen in mirrors and glass, one ray for what
//! is glossy; nothing diffuse lights anything else but by the ambient light.

use super::Classic;
use crate::{Emit, PathState};
use juggler_bsdf::{BsdfSample, Scatter};
use juggler_camera::sampler::Sampler;
use juggler_material::Shade;
use juggler_math::{Ray, Rgb, Vec2, Vec3};
use juggler_world::{Lamp, Vertex, World};

/// A vertex as seen by the one who looks.
struct Seen<'a> {
    vertex: &'a Vertex,
    shade: &'a Shade,
    /// Unit, towards where the ray came from, in the frame of the scattering function.
    wo: Vec3,
    time: f32,
}

impl Classic {
    /// A vertex whose material is not the classic one.
    pub(super) fn physical(&self, world: &World, ray: &Ray, path: &PathState, vertex: &Vertex, emit: &mut Emit) {
        let mut sampler = path.sampler.at(1);
        let choices = if world.is_simple(vertex) { Vec2::ZERO } else { path.sampler.at(0).next_2d() };
        let shade = world.shade(vertex, -ray.direction, 1.0, choices.x);
        let room = path.depth < self.max_depth;
        if shade.opacity < 1.0 && choices.y >= shade.opacity {
            if room {
                emit.go_on(vertex.surface.spawn(ray.direction, ray.time), Rgb::WHITE, 0);
            }
            return;
        }
        let wo = shade.frame.to_local(-ray.direction);
        let seen = Seen { vertex, shade: &shade, wo, time: ray.time };
        let ambient = world.ambient();
        let reflected = if ambient.is_black() { Rgb::BLACK } else { seen.shade.bsdf.albedo(wo) * ambient };
        emit.see_shaded(world, ray, vertex, &shade);
        emit.add(seen.shade.emission + reflected, world.shape_group(vertex.object));
        if !seen.shade.bsdf.is_specular() {
            for (number, lamp) in (0..).zip(world.lamps()) {
                seen.light(lamp, number as usize, &sampler.at(number), emit);
            }
        }
        sampler.skip(world.lamps().len() as u32);
        if room {
            self.reflect(&seen, path, sampler, emit);
        }
    }

    /// Mirrors and clear glass, each with a ray of its own, and one ray for all that is glossy.
    fn reflect(&self, seen: &Seen, path: &PathState, mut sampler: Sampler, emit: &mut Emit) {
        let deltas = seen.shade.bsdf.deltas(seen.wo);
        for (child, sample) in (0..).zip(&deltas) {
            self.follow_sample(seen, path, sample, child, emit);
        }
        if !seen.shade.bsdf.is_glossy() {
            return;
        }
        let sample = seen.shade.bsdf.sample(seen.wo, sampler.next_2d(), sampler.next_1d());
        if let Some(glossy) = sample.filter(|sample| sample.scatter == Scatter::Glossy) {
            self.follow_sample(seen, path, &glossy, deltas.len() as u32, emit);
        }
    }

    fn follow_sample(&self, seen: &Seen, path: &PathState, sample: &BsdfSample, child: u32, emit: &mut Emit) {
        if (path.weight * sample.weight).max_channel() >= self.min_weight && !sample.weight.is_black() {
            let direction = seen.shade.frame.to_world(sample.wi);
            emit.go_on(seen.vertex.surface.spawn(direction, seen.time), sample.weight, child);
        }
    }
}

impl Seen<'_> {
    /// What one light brings, from one or more places on it.
    fn light(&self, lamp: &Lamp, number: usize, sampler: &Sampler, emit: &mut Emit) {
        let Lamp { samples, is_point, is_surface, .. } = lamp;
        let scale = if *is_surface { 1.0 } else { self.shade.lamp_scale };
        let share = scale / *samples as f32;
        for i in 0..*samples {
            let u = if *is_point { Vec2::ZERO } else { sampler.part(i, *samples).next_2d() };
            let Some(sample) = lamp.at(self.time).light.sample(self.vertex.surface.point, u) else { continue };
            let (scattered, _) = self.shade.bsdf.eval_pdf(self.wo, self.shade.frame.to_local(sample.wi));
            if !scattered.is_black() {
                let ray = self.vertex.surface.spawn_to(sample.wi, sample.distance, self.time);
                emit.if_light_visible(number, ray, sample.radiance * scattered * (share / sample.pdf), lamp.group);
            }
        }
    }
}
