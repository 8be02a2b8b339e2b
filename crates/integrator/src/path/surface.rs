//! Path vertices on surfaces: light sampling and BSDF sampling.

use super::super::{PathHistory, PathState, ScatterCounts, VertexOutput};
use super::crossing::Interface;
use super::{Dimension, Path, Sampling};
use juggler_bsdf::{Bsdf, BsdfSample, BsdfView, Scatter};
use juggler_material::Shading;
use juggler_material::medium::Interiors;
use juggler_math::{Ray, Rgb, Vec2, Vec3};
use juggler_shape::surface::Surface;
use juggler_world::{EmitterId, EmitterSample, LightSampleContext, Vertex, VisibleCasters, World};

/// Number of specular events after which a solid releases the light that it holds by total
/// reflection about perturbed normals. Such light has lost the picture of where it came from.
const MAX_HELD: u16 = 8;

/// A shading point: a vertex with its evaluated material and the direction of view.
pub struct ShadingPoint<'a> {
    pub surface: &'a Surface,
    /// Surface that scatters light: on meshes with shading normals the smooth surface that they
    /// describe, else `surface`. Specular reflection and transmission leave from `surface`.
    pub scattering: &'a Surface,
    pub shading: &'a Shading,
    /// BSDF for the viewer at the origin of the ray.
    pub bsdf: BsdfView<'a>,
    /// Cosine between `wo` and the geometric normal.
    cos_geometric: f32,
    pub time: f32,
    interface: &'a Interface,
    /// Context of light samples at the vertex.
    pub light_sample_context: LightSampleContext,
    /// Specular spheres visible from the vertex; `None` where the path samples no light through
    /// them.
    pub visible_casters: Option<&'a VisibleCasters>,
}

/// Writes the shading of a vertex on an interface into a black `shading`. Returns a random number in
/// [0, 1) that decides whether the path passes through by opacity.
#[inline(always)]
pub fn shade_into(
    world: &World,
    ray: &Ray,
    path: &PathState,
    vertex: &Vertex,
    interface: &Interface,
    shading: &mut Shading,
) -> f32 {
    let choice =
        if world.is_simple(vertex) { Vec2::ZERO } else { path.sampler.skipped(Dimension::Choice as u32).next_2d() };
    world.shade_into(vertex, -ray.direction, interface.exterior_ior(world, path), choice.x, shading);
    choice.y
}

impl<'a> ShadingPoint<'a> {
    #[inline]
    pub fn new(
        ray: &Ray,
        [surface, scattering]: [&'a Surface; 2],
        shading: &'a Shading,
        bsdf: BsdfView<'a>,
        interface: &'a Interface,
    ) -> Self {
        let (time, cos_geometric, visible_casters) = (ray.time, surface.normal.dot(-ray.direction), None);
        // Shading normal on the illuminated side; zero if light may arrive from both.
        let normal = if shading.transmissive { Vec3::ZERO } else { shading.frame.normal };
        let light_sample_context =
            LightSampleContext { point: scattering.point, error: scattering.position_error, normal, time };
        Self {
            surface,
            scattering,
            shading,
            bsdf,
            cos_geometric,
            time,
            interface,
            light_sample_context,
            visible_casters,
        }
    }

    /// Factor of a light sample's contribution: its multiple importance sampling weight over
    /// `light_pdf`. `bsdf_pdf` is the density of BSDF sampling for the same direction.
    #[inline]
    pub fn light_sample_weight(&self, sampling: Sampling, light: &EmitterSample, light_pdf: f32, bsdf_pdf: f32) -> f32 {
        let mis_weight = if light.can_be_bsdf_sampled { sampling.light_weight(light_pdf, bsdf_pdf) } else { 1.0 };
        let scale = if matches!(light.emitter, EmitterId::Light(_)) { self.shading.light_scale } else { 1.0 };
        mis_weight * scale / light_pdf
    }

    /// Finds the specular spheres visible from the vertex. `visible_casters` must be empty.
    #[inline]
    pub fn find_visible_casters(&mut self, world: &World, visible_casters: &'a mut VisibleCasters) {
        if world.has_casters() {
            world.fill_visible_casters(&self.light_sample_context, visible_casters);
            self.visible_casters = Some(visible_casters);
        }
    }

    /// Evaluates the BSDF times cosine, and the density of [`ShadingPoint::sample`], for a
    /// direction.
    pub fn eval_pdf(&self, direction: Vec3, wi: Vec3) -> (Rgb, f32) {
        let (scattered, pdf) = self.bsdf.eval_pdf(wi);
        match self.visible_casters {
            Some(visible_casters) => {
                let fraction = self.guided_fraction(visible_casters);
                (scattered, pdf * (1.0 - fraction) + fraction * visible_casters.pdf(direction))
            }
            None => (scattered, pdf),
        }
    }

    /// Fraction of BSDF samples replaced by directions towards specular spheres. It is 0 for
    /// transmissive materials, since only the BSDF knows the index of refraction of a sample.
    fn guided_fraction(&self, visible_casters: &VisibleCasters) -> f32 {
        if self.shading.transmissive { 0.0 } else { visible_casters.guided_fraction() }
    }

    /// Samples the direction of the next segment.
    fn sample(&self, path: &PathState) -> Option<(Vec3, BsdfSample)> {
        let mut u = path.sampler.skipped(Dimension::Scatter as u32).next_2d();
        let (frame, lobes) = (&self.shading.frame, &self.shading.bsdf);
        let choice = if lobes.uses_u_choice() { path.sampler.skipped(Dimension::Facet as u32).next_1d() } else { 0.0 };
        let Some(visible_casters) = self.visible_casters else {
            let sample = self.bsdf.sample(u, choice)?;
            return Some((frame.to_world(sample.wi), sample));
        };
        let fraction = self.guided_fraction(visible_casters);
        let (is_guided, rest) = juggler_bsdf::choose(u.x, fraction);
        u.x = rest;
        // Sample a direction towards a specular sphere.
        if is_guided {
            let direction = visible_casters.sample(u)?;
            let wi = frame.to_local(direction);
            let (scattered, pdf) = self.eval_pdf(direction, wi);
            let scatter = lobes.scatter();
            return (pdf > 0.0)
                .then(|| (direction, BsdfSample { wi, weight: scattered / pdf, pdf, scatter, ior: 1.0 }));
        }
        let sample = self.bsdf.sample(u, choice)?;
        let direction = frame.to_world(sample.wi);
        if sample.scatter == Scatter::Specular {
            return Some((direction, BsdfSample { weight: sample.weight * (1.0 / (1.0 - fraction)), ..sample }));
        }
        let pdf = sample.pdf * (1.0 - fraction) + fraction * visible_casters.pdf(direction);
        let weight = sample.weight * (sample.pdf / pdf);
        Some((direction, BsdfSample { weight, pdf, ..sample }))
    }

    /// Sample that replaces a total reflection about a perturbed normal: see
    /// [`BsdfView::sample_exit`].
    #[cold]
    #[inline(never)]
    fn sample_exit(&self, path: &PathState, reflected: &BsdfSample) -> Option<BsdfSample> {
        self.bsdf.sample_exit(reflected, path.sampler.skipped(Dimension::Exit as u32).next_2d())
    }

    /// Samples `count` lights.
    pub fn sample_lights(
        &self,
        count: u16,
        sampling: Sampling,
        world: &World,
        path: &PathState,
        output: &mut VertexOutput,
    ) {
        let sampler = path.sampler.skipped(Dimension::Light as u32);
        for part in 0..u32::from(count) {
            let u = sampler.subsequence(part, u32::from(count)).next_2d();
            if let Some(light) = world.sample_light(&self.light_sample_context, u) {
                let pdf = light.pdf * f32::from(count);
                self.add_light_sample(&EmitterSample { pdf, ..light }, sampling, world, path, output);
            }
        }
    }

    /// Adds the contribution of a light sample, if its shadow ray is unoccluded.
    fn add_light_sample(
        &self,
        light: &EmitterSample,
        sampling: Sampling,
        world: &World,
        path: &PathState,
        output: &mut VertexOutput,
    ) {
        let wi = self.shading.frame.to_local(light.wi);
        if !self.scatters_into(light.wi, wi) {
            return;
        }
        if self.replaces_by_backdrop(light.emitter, world, path, wi) {
            return;
        }
        let (scattered, pdf) = self.eval_pdf(light.wi, wi);
        if scattered.is_black() {
            return;
        }
        let ray = self.scattering.spawn_ray_to(light.wi, light.distance, self.time);
        let ray = self.before_others(ray, self.scattering, wi);
        let inside = self.interiors_towards(path, wi);
        let radiance = light.radiance * scattered * self.light_sample_weight(sampling, light, light.pdf, pdf);
        output.add_shadow_ray_inside(ray, radiance, world.light_group(light.emitter), inside);
    }

    /// A ray that leaves the surface `from` in the direction `wi`, in the shading frame: it starts
    /// before other surfaces at the place of a sheet that transmits it.
    #[inline]
    fn before_others(&self, ray: Ray, from: &Surface, wi: Vec3) -> Ray {
        if !self.interface.has_others_behind || wi.z * self.bsdf.wo().z >= 0.0 {
            return ray;
        }
        Ray { origin: from.spawn_ray(-ray.direction, self.time).origin, ..ray }
    }

    /// Solids that contain a ray that continues in the direction `wi`, in the shading frame.
    pub fn interiors_towards(&self, path: &PathState, wi: Vec3) -> Interiors {
        if wi.z * self.bsdf.wo().z < 0.0 {
            self.interface.interiors_behind(path, self.cos_geometric > 0.0)
        } else {
            path.history.interiors
        }
    }

    /// Whether a path that continues in the direction `wi`, in the shading frame, sees the backdrop:
    /// only transmission through glass has changed its direction since the camera.
    fn sees_backdrop(&self, path: &PathState, wi: Vec3) -> bool {
        path.history.sees_backdrop && wi.z * self.bsdf.wo().z < 0.0 && !self.shading.bsdf.transmits_diffusely()
    }

    /// Whether a path that continues in the direction `wi`, in the shading frame, sees the backdrop in
    /// place of the light of `emitter`. Only BSDF samples add the backdrop.
    #[inline]
    pub fn replaces_by_backdrop(&self, emitter: EmitterId, world: &World, path: &PathState, wi: Vec3) -> bool {
        emitter == EmitterId::Background && world.backdrop().is_some() && self.sees_backdrop(path, wi)
    }

    /// Whether the geometric and the shading normal have `wi` on the same side of the surface.
    /// `local` is `wi` in the shading frame.
    fn same_hemisphere(&self, wi: Vec3, local: Vec3) -> bool {
        (self.surface.normal.dot(wi) * self.cos_geometric < 0.0) == (local.z * self.bsdf.wo().z < 0.0)
    }

    /// Whether light may be scattered into `wi`, which is `local` in the shading frame, but for
    /// specular reflection: also behind the triangle, where the smooth surface is in front.
    pub fn scatters_into(&self, wi: Vec3, local: Vec3) -> bool {
        self.same_hemisphere(wi, local)
            || !std::ptr::eq(self.surface, self.scattering)
                && local.z * self.bsdf.wo().z >= 0.0
                && self.surface.shading_normal.dot(wi) * self.cos_geometric > 0.0
    }

    fn history(
        &self,
        world: &World,
        shape: u32,
        path: &PathState,
        sample: &BsdfSample,
        light_samples: u16,
    ) -> PathHistory {
        let mut events = path.history.events;
        let count = match sample.scatter {
            Scatter::Diffuse => &mut events.diffuse,
            Scatter::Glossy => &mut events.glossy,
            Scatter::Specular => &mut events.specular,
        };
        *count = count.saturating_add(1);
        let eta_scale = path.history.eta_scale * sample.ior * sample.ior;
        let (interiors, pass_throughs) = (self.interiors_towards(path, sample.wi), 0);
        let caustic = self.caustic_state(world, shape, path, sample, interiors);
        let sees_backdrop = self.sees_backdrop(path, sample.wi);
        if sample.scatter == Scatter::Specular {
            return PathHistory {
                pdf: f32::INFINITY,
                eta_scale,
                interiors,
                pass_throughs,
                events,
                caustic,
                sees_backdrop,
                ..path.history
            };
        }
        let LightSampleContext { point: from, error, normal, .. } = self.light_sample_context;
        PathHistory {
            from,
            error,
            normal,
            pdf: sample.pdf,
            light_samples,
            eta_scale,
            interiors,
            wavelength: path.history.wavelength,
            pass_throughs,
            events,
            caustic,
            sees_backdrop,
            is_split: false,
        }
    }
}

impl Path {
    /// Removes the lobes whose limit of scattering events the path has reached, for light sampling
    /// and BSDF sampling alike, since multiple importance sampling combines them.
    #[inline]
    pub fn limit_lobes(&self, bsdf: &mut Bsdf, path: &PathState) {
        if self.max_diffuse.is_some() || self.max_glossy.is_some() || self.max_specular.is_some() {
            self.remove_lobes(bsdf, path);
        }
    }

    fn remove_lobes(&self, bsdf: &mut Bsdf, path: &PathState) {
        let ScatterCounts { diffuse, glossy, specular, .. } = path.history.events;
        let is_done = |count: u16, limit: Option<u32>| limit.is_some_and(|limit| u32::from(count) >= limit);
        bsdf.remove_scattering(|scatter| match scatter {
            Scatter::Diffuse => is_done(diffuse, self.max_diffuse),
            Scatter::Glossy => is_done(glossy, self.max_glossy),
            Scatter::Specular => is_done(specular, self.max_specular),
        });
    }

    /// Samples the BSDF and continues the path.
    pub fn continue_path(
        &self,
        point: &ShadingPoint,
        world: &World,
        shape: u32,
        path: &PathState,
        output: &mut VertexOutput,
    ) {
        let Some((mut wi, mut sample)) = point.sample(path) else { return };
        if path.history.events.specular >= MAX_HELD
            && let Some(exit) = point.sample_exit(path, &sample)
        {
            (wi, sample) = (point.shading.frame.to_world(exit.wi), exit);
        }
        let is_specular = sample.scatter == Scatter::Specular;
        let (from, goes_on) = if is_specular {
            (point.surface, point.same_hemisphere(wi, sample.wi))
        } else {
            (point.scattering, point.scatters_into(wi, sample.wi))
        };
        if !goes_on {
            return;
        }
        let history = point.history(world, shape, path, &sample, self.light_sample_count(world, path));
        // Terminate by Russian roulette.
        let throughput = output.beta() * sample.weight * history.eta_scale;
        if throughput.is_black() {
            return;
        }
        if let Some(probability) = self.roulette_survival(path, throughput) {
            let ray = point.before_others(from.spawn_ray(wi, point.time), from, sample.wi);
            output.continue_path(ray, sample.weight * (1.0 / probability), history, 1);
        }
    }
}
