//! Samples of the light of all emitters, and the matching densities.

use super::{Emitter, EmitterId, EmitterSample, LightSampleContext, bsdf_sampled};
use crate::infinite_lights::InfiniteLight;
use crate::{Vertex, World};
use juggler_light::LightSample;
use juggler_light::emitter::LightTreeSample;
use juggler_math::{Ray, Vec2, Vec3};

impl World {
    /// Whether the world has more than one emitter.
    #[inline]
    pub fn has_many_emitters(&self) -> bool {
        self.emitters.finite.len() + self.emitters.infinite.len() > 1
    }

    /// Samples incident light at a point: selects an emitter by `u.x`, then a point on it.
    #[inline]
    pub fn sample_light(&self, context: &LightSampleContext, u: Vec2) -> Option<EmitterSample> {
        self.sample_selected(context, u, |u| self.emitters.pick(context, u))
    }

    /// [`World::sample_light`] for several numbers at one point, with the same results. What does not
    /// depend on the numbers is computed once.
    #[inline]
    pub fn sample_lights(
        &self,
        context: &LightSampleContext,
        numbers: impl Iterator<Item = Vec2>,
    ) -> impl Iterator<Item = EmitterSample> {
        let mut root = None;
        numbers
            .filter_map(move |u| self.sample_selected(context, u, |u| self.emitters.pick_again(context, &mut root, u)))
    }

    /// Samples incident light at a point; `select` selects a finite emitter.
    #[inline]
    fn sample_selected(
        &self,
        context: &LightSampleContext,
        u: Vec2,
        select: impl FnOnce(f32) -> Option<LightTreeSample>,
    ) -> Option<EmitterSample> {
        let emitters = &self.emitters;
        let infinite = emitters.infinite_probability();
        // Sample an infinite light.
        if u.x < infinite {
            let (picked, probability, rest) = emitters.infinite.pick((u.x / infinite).min(1f32.next_down()))?;
            let (probability, rest) = (probability * infinite, Vec2::new(rest, u.y));
            return match picked {
                InfiniteLight::Light(index) => self.sample_scene_light(index, context, rest, probability),
                InfiniteLight::Background => self.sample_background(context, rest, probability),
            };
        }
        // Select a finite emitter by the light tree, and sample it.
        let finite = emitters.finite_probability();
        let pick = select(((u.x - infinite) / finite).min(1f32.next_down()))?;
        let (probability, rest) = (pick.probability * finite, Vec2::new(pick.u_remapped, u.y));
        match emitters.finite.get(pick.index as usize)? {
            Emitter::Light(index) => self.sample_scene_light(*index, context, rest, probability),
            Emitter::Area(area, shape) => {
                let sample = area.sample(context.point, rest)?;
                if context.is_coplanar(sample.wi, sample.distance, sample.normal) {
                    return None;
                }
                let shape = &emitters.shapes.get(*shape as usize)?.shape;
                let radiance = shape.radiance(&self.materials, context, sample.wi, sample.normal)?;
                let emitter = EmitterId::Shape(shape.shape_index);
                Some(bsdf_sampled(
                    emitter,
                    sample.wi,
                    sample.distance,
                    radiance,
                    sample.pdf * probability,
                    sample.normal,
                ))
            }
            Emitter::Shape(shape) => {
                emitters.shapes.get(*shape as usize)?.shape.sample(&self.materials, context, rest, probability)
            }
        }
    }

    fn sample_scene_light(
        &self,
        index: u32,
        context: &LightSampleContext,
        u: Vec2,
        probability: f32,
    ) -> Option<EmitterSample> {
        let sample = self.lights.get(index as usize)?.at(context.time).light.sample(context.point, u)?;
        Some(EmitterSample {
            wi: sample.wi,
            distance: sample.distance,
            radiance: sample.radiance,
            pdf: sample.pdf * probability,
            can_be_bsdf_sampled: false,
            emitter: EmitterId::Light(index),
            normal: Vec3::ZERO,
        })
    }

    /// Incident light at a point from a light of the scene without an extent.
    pub fn point_light(&self, index: u32, context: &LightSampleContext) -> Option<LightSample> {
        let light = &self.lights.get(index as usize)?.at(context.time).light;
        light.is_delta().then(|| light.sample(context.point, Vec2::ZERO))?
    }

    fn sample_background(&self, context: &LightSampleContext, u: Vec2, probability: f32) -> Option<EmitterSample> {
        let sample = self.background.sample(u)?;
        // Skip the lookup for directions below the horizon: environment maps are large.
        if sample.wi.dot(context.normal) < 0.0 {
            return None;
        }
        let radiance = self.background.radiance(&Ray { time: context.time, ..Ray::new(context.point, sample.wi) });
        (!radiance.is_black()).then(|| {
            bsdf_sampled(
                EmitterId::Background,
                sample.wi,
                f32::INFINITY,
                radiance,
                sample.pdf * probability,
                Vec3::ZERO,
            )
        })
    }

    /// Density per steradian with which [`World::sample_light`] picks the direction of a ray that
    /// left the world.
    #[inline]
    pub fn background_pdf(&self, direction: Vec3) -> f32 {
        let probability = self.emitters.infinite.probability(InfiniteLight::Background);
        if probability > 0.0 {
            self.background.pdf(direction) * (probability * self.emitters.infinite_probability())
        } else {
            0.0
        }
    }

    /// Density per steradian with which [`World::sample_light`] picks, at `from`, the point
    /// `vertex` of an emitter that a ray hit.
    #[inline]
    pub fn light_pdf(&self, from: &LightSampleContext, vertex: &Vertex) -> f32 {
        self.emitters.pdf(from, vertex).unwrap_or(0.0)
    }
}
