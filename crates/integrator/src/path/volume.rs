//! Path vertices in media: free-flight sampling, light sampling and phase functions.

use super::super::{CausticState, PathHistory, PathState, VertexOutput};
use super::{Dimension, Path};
use juggler_material::medium::HenyeyGreenstein;
use juggler_math::{Ray, Rgb};
use juggler_world::{LightSampleContext, World};

/// Fraction of the distance to a light that a shadow ray covers, so that it does not hit the light.
const SHADOW_RAY_FRACTION: f32 = 1.0 - 1e-4;

impl Path {
    /// Samples a collision in the current medium within `distance` of the ray's `t_min`. Returns
    /// whether there is one; the path then scatters or ends there.
    pub fn sample_medium(
        &self,
        world: &World,
        ray: &Ray,
        distance: f32,
        path: &PathState,
        output: &mut VertexOutput,
    ) -> bool {
        let Some(interior) = path.history.interiors.top(world.interiors()) else { return false };
        let medium = &interior.medium;
        if medium.is_clear() {
            return false;
        }
        // Sample the free flight distance.
        let u = path.sampler.skipped(Dimension::Flight as u32).next_2d();
        let flight = medium.sample(distance, output.beta(), u.x, u.y);
        output.scale(flight.weight);
        let Some(t) = flight.scattered_at else { return false };
        // Scatter the path unless it is an additional camera ray or a limit is reached.
        let volume = u32::from(path.history.events.volume);
        let may_scatter = !path.history.is_split && path.depth + 1 < self.max_depth;
        if may_scatter && self.max_volume.is_none_or(|limit| volume < limit) {
            let phase = HenyeyGreenstein { anisotropy: medium.anisotropy };
            self.scatter(world, &Ray { origin: ray.at(ray.t_min + t), ..*ray }, path, phase, output);
        }
        true
    }

    /// Scatters a path that arrives along `ray` in a medium, at the origin of `ray`.
    fn scatter(&self, world: &World, ray: &Ray, path: &PathState, phase: HenyeyGreenstein, output: &mut VertexOutput) {
        let spawn_ray = |direction| Ray { time: ray.time, ..Ray::new(ray.origin, direction) };
        // Sample direct illumination.
        let context =
            LightSampleContext { point: ray.origin, error: 0.0, normal: juggler_math::Vec3::ZERO, time: ray.time };
        if let Some(light) = world.sample_light(&context, path.sampler.skipped(Dimension::Light as u32).next_2d()) {
            let scattered = phase.eval(ray.direction.dot(light.wi));
            let mis_weight =
                if light.can_be_bsdf_sampled { self.sampling.light_weight(light.pdf, scattered) } else { 1.0 };
            let shadow = spawn_ray(light.wi).with_t_max(light.distance * SHADOW_RAY_FRACTION);
            let (radiance, group) =
                (light.radiance * (scattered * mis_weight / light.pdf), world.light_group(light.emitter));
            output.add_shadow_ray_inside(shadow, radiance, group, path.history.interiors);
        }
        // Sample the phase function.
        let wi = phase.sample(ray.direction, path.sampler.skipped(Dimension::Scatter as u32).next_2d());
        let mut events = path.history.events;
        events.volume = events.volume.saturating_add(1);
        let pdf = phase.eval(ray.direction.dot(wi));
        let history = PathHistory {
            from: context.point,
            error: 0.0,
            normal: context.normal,
            pdf,
            light_samples: 1,
            pass_throughs: 0,
            events,
            caustic: CausticState::NONE,
            sees_backdrop: false,
            ..path.history
        };
        // Terminate by Russian roulette.
        if let Some(probability) = self.roulette_survival(path, output.beta() * history.eta_scale) {
            output.continue_path(spawn_ray(wi), Rgb::splat(1.0 / probability), history, 1);
        }
    }
}
