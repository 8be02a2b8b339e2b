//! Paths in media: how far they come, what lights bring to where they are scattered.

use super::super::{Chain, Emit, PathState, Trail};
use super::{Dimension, Path};
use juggler_material::medium::HenyeyGreenstein;
use juggler_math::{Ray, Rgb};
use juggler_world::{Receiver, World};

/// How little of a shadow ray's way to a light is left out at its end, so that it does not meet the light.
const SHORT_OF: f32 = 1.0 - 1e-4;

impl Path {
    /// Takes a path through the medium that it is in, `distance` far; whether it ends there or is scattered.
    pub fn flies(&self, world: &World, ray: &Ray, distance: f32, path: &PathState, emit: &mut Emit) -> bool {
        let Some(interior) = path.trail.inside.top(world.interiors()) else { return false };
        let medium = &interior.medium;
        if medium.is_clear() {
            return false;
        }
        let u = path.sampler.at(Dimension::Flight as u32).next_2d();
        let flight = medium.sample(distance, emit.weight(), u.x, u.y);
        emit.scale(flight.weight);
        let Some(t) = flight.scattered_at else { return false };
        let volume = u32::from(path.trail.scattered.volume);
        if path.depth + 1 < self.max_depth && self.max_volume.is_none_or(|most| volume < most) {
            let phase = HenyeyGreenstein { anisotropy: medium.anisotropy };
            self.scatter(world, &Ray { origin: ray.at(t), ..*ray }, path, phase, emit);
        }
        true
    }

    /// A path that came along `ray` is scattered where that now begins.
    fn scatter(&self, world: &World, ray: &Ray, path: &PathState, phase: HenyeyGreenstein, emit: &mut Emit) {
        let from = |direction| Ray { time: ray.time, ..Ray::new(ray.origin, direction) };
        let to = Receiver { point: ray.origin, error: 0.0, normal: juggler_math::Vec3::ZERO, time: ray.time };
        if let Some(light) = world.sample_light(&to, path.sampler.at(Dimension::Light as u32).next_2d()) {
            let scattered = phase.eval(ray.direction.dot(light.wi));
            let share = if light.can_be_met { self.sampling.light_weight(light.pdf, scattered) } else { 1.0 };
            let shadow = from(light.wi).up_to(light.distance * SHORT_OF);
            let (radiance, group) = (light.radiance * (scattered * share / light.pdf), world.light_group(light.origin));
            emit.if_visible_inside(shadow, radiance, group, path.trail.inside);
        }
        let wi = phase.sample(ray.direction, path.sampler.at(Dimension::Scatter as u32).next_2d());
        let mut scattered = path.trail.scattered;
        scattered.volume = scattered.volume.saturating_add(1);
        let pdf = phase.eval(ray.direction.dot(wi));
        let trail = Trail {
            from: to.point,
            error: 0.0,
            normal: to.normal,
            pdf,
            asked: 1,
            passed: 0,
            scattered,
            chain: Chain::NONE,
            ..path.trail
        };
        if let Some(chance) = self.survival(path, emit.weight() * trail.ior_scale) {
            emit.follow(from(wi), Rgb::splat(1.0 / chance), trail, 1);
        }
    }
}
