//! Paths at surfaces: what a light brings, and where to go on.

use super::super::{Chain, Counts, Emit, PathState, Trail};
use super::{Dimension, Path, Sampling};
use juggler_bsdf::{Bsdf, BsdfSample, Scatter};
use juggler_material::Shade;
use juggler_material::medium::{InteriorId, Interiors};
use juggler_math::{Ray, Rgb, Vec3};
use juggler_shape::surface::Surface;
use juggler_world::{Lighting, MAX_PASSED, Origin, Prospect, Receiver, Vertex, World};

/// A vertex as seen by the one who looks.
pub struct Seen<'a> {
    pub surface: &'a Surface,
    pub shade: &'a Shade,
    /// Unit, towards where the ray came from, in the world and in the frame of the scattering function.
    wo: Vec3,
    pub local: Vec3,
    pub time: f32,
    interior: Option<InteriorId>,
    /// Specular spheres visible from the vertex; `None` where the path samples no light through them.
    pub prospect: Option<&'a Prospect>,
}

/// Goes straight on as if nothing had been there.
pub fn pass(world: &World, ray: &Ray, path: &PathState, vertex: &Vertex, emit: &mut Emit) {
    if path.trail.passed < MAX_PASSED {
        let inside = crossed(path, vertex.surface.normal.dot(ray.direction) < 0.0, world.interior(vertex));
        emit.pass(ray);
        let trail = Trail { passed: path.trail.passed + 1, inside, chain: Chain::NONE, ..path.trail };
        emit.follow(vertex.surface.spawn(ray.direction, ray.time), Rgb::WHITE, trail, 0);
    }
}

/// The solids that a path is in once it has crossed the surface of one, inwards or outwards.
fn crossed(path: &PathState, inwards: bool, interior: Option<InteriorId>) -> Interiors {
    let inside = path.trail.inside;
    interior.map_or(inside, |id| inside.crossed(id, inwards))
}

/// Whether a surface is not there, because a solid of higher priority is.
pub fn is_covered(world: &World, ray: &Ray, path: &PathState, vertex: &Vertex, id: InteriorId) -> bool {
    let inwards = vertex.surface.normal.dot(ray.direction) < 0.0;
    path.trail.inside.hide(id, inwards, world.interiors())
}

/// Index of refraction around a solid that a path meets.
pub fn around(world: &World, path: &PathState, interior: Option<InteriorId>) -> f32 {
    let inside = path.trail.inside;
    if inside.is_empty() {
        return 1.0;
    }
    let others = interior.map_or(inside, |id| inside.left(id));
    others.top(world.interiors()).map_or(1.0, |interior| interior.ior)
}

impl<'a> Seen<'a> {
    #[inline]
    pub fn new(ray: &Ray, vertex: &'a Vertex, shade: &'a Shade, interior: Option<InteriorId>) -> Self {
        let wo = -ray.direction;
        let local = shade.frame.to_local(wo);
        Self { surface: &vertex.surface, shade, wo, local, time: ray.time, interior, prospect: None }
    }

    /// Factor of a light sample's contribution: its multiple importance sampling weight over
    /// `light_pdf`. `bsdf_pdf` is the density of BSDF sampling for the same direction.
    #[inline]
    pub fn light_sample_weight(&self, sampling: Sampling, light: &Lighting, light_pdf: f32, bsdf_pdf: f32) -> f32 {
        let share = if light.can_be_met { sampling.light_weight(light_pdf, bsdf_pdf) } else { 1.0 };
        let scale = if matches!(light.origin, Origin::Lamp(_)) { self.shade.lamp_scale } else { 1.0 };
        share * scale / light_pdf
    }

    /// Finds the specular spheres that the vertex sees; `prospect` is empty before.
    #[inline]
    pub fn look_for_casters(&mut self, world: &World, prospect: &'a mut Prospect) {
        if world.has_casters() {
            world.fill_prospect(&self.receiver(), prospect);
            self.prospect = Some(prospect);
        }
    }

    /// As what light comes to.
    fn receiver(&self) -> Receiver {
        Receiver {
            point: self.surface.point,
            error: self.surface.error,
            normal: self.receiving_normal(),
            time: self.time,
        }
    }

    /// What is scattered, and the density with which a path goes on in that direction.
    pub fn eval_pdf(&self, direction: Vec3, wi: Vec3) -> (Rgb, f32) {
        let (scattered, pdf) = self.shade.bsdf.eval_pdf(self.local, wi);
        match self.prospect {
            Some(prospect) => {
                let share = self.guided(prospect);
                (scattered, pdf * (1.0 - share) + share * prospect.pdf(direction))
            }
            None => (scattered, pdf),
        }
    }

    /// The share of directions that are those of balls. Light that may also go through has an index of refraction that only the
    /// scattering function knows.
    fn guided(&self, prospect: &Prospect) -> f32 {
        if self.shade.transmissive { 0.0 } else { prospect.share() }
    }

    /// A direction in which a path may go on.
    fn sample(&self, path: &PathState) -> Option<(Vec3, BsdfSample)> {
        let mut u = path.sampler.at(Dimension::Scatter as u32).next_2d();
        let (frame, bsdf) = (&self.shade.frame, &self.shade.bsdf);
        let choice = if bsdf.has_choice() { path.sampler.at(Dimension::Facet as u32).next_1d() } else { 0.0 };
        let Some(prospect) = self.prospect else {
            let sample = bsdf.sample(self.local, u, choice)?;
            return Some((frame.to_world(sample.wi), sample));
        };
        let share = self.guided(prospect);
        let (is_guided, rest) = juggler_bsdf::choose(u.x, share);
        u.x = rest;
        if is_guided {
            let direction = prospect.sample(u)?;
            let wi = frame.to_local(direction);
            let (scattered, pdf) = self.eval_pdf(direction, wi);
            let scatter = bsdf.scatter();
            return (pdf > 0.0)
                .then(|| (direction, BsdfSample { wi, weight: scattered / pdf, pdf, scatter, ior: 1.0 }));
        }
        let sample = bsdf.sample(self.local, u, choice)?;
        let direction = frame.to_world(sample.wi);
        if sample.scatter == Scatter::Specular {
            return Some((direction, BsdfSample { weight: sample.weight * (1.0 / (1.0 - share)), ..sample }));
        }
        let pdf = sample.pdf * (1.0 - share) + share * prospect.pdf(direction);
        let weight = sample.weight * (sample.pdf / pdf);
        Some((direction, BsdfSample { weight, pdf, ..sample }))
    }

    /// What some lights bring.
    pub fn ask_lights(&self, count: u16, sampling: Sampling, world: &World, path: &PathState, emit: &mut Emit) {
        let to = self.receiver();
        let sampler = path.sampler.at(Dimension::Light as u32);
        for part in 0..u32::from(count) {
            let u = sampler.part(part, u32::from(count)).next_2d();
            if let Some(light) = world.sample_light(&to, u) {
                let pdf = light.pdf * f32::from(count);
                self.ask_light(&Lighting { pdf, ..light }, sampling, world, path, emit);
            }
        }
    }

    /// What a light brings that is picked with its density.
    fn ask_light(&self, light: &Lighting, sampling: Sampling, world: &World, path: &PathState, emit: &mut Emit) {
        let wi = self.shade.frame.to_local(light.wi);
        if !self.agree(light.wi, wi) {
            return;
        }
        let (scattered, pdf) = self.eval_pdf(light.wi, wi);
        if scattered.is_black() {
            return;
        }
        let ray = self.surface.spawn_to(light.wi, light.distance, self.time);
        let inside = self.inside(path, wi);
        let radiance = light.radiance * scattered * self.light_sample_weight(sampling, light, light.pdf, pdf);
        emit.if_visible_inside(ray, radiance, world.light_group(light.origin), inside);
    }

    /// The solids that a path is in that goes on from here in the direction `wi`, which is local.
    pub fn inside(&self, path: &PathState, wi: Vec3) -> Interiors {
        if wi.z * self.local.z < 0.0 {
            crossed(path, self.surface.normal.dot(self.wo) > 0.0, self.interior)
        } else {
            path.trail.inside
        }
    }

    /// The normal on the side that light comes to; zero where it may come from both.
    fn receiving_normal(&self) -> Vec3 {
        if self.shade.transmissive { Vec3::ZERO } else { self.shade.frame.normal }
    }

    /// Whether the true surface has the direction `wi`, which is `local` in the frame, on the side on which the shading
    /// normal has it.
    pub fn agree(&self, wi: Vec3, local: Vec3) -> bool {
        let normal = self.surface.normal;
        (normal.dot(wi) * normal.dot(self.wo) < 0.0) == (local.z * self.local.z < 0.0)
    }

    fn trail(&self, world: &World, object: u32, path: &PathState, sample: &BsdfSample, asked: u16) -> Trail {
        let mut scattered = path.trail.scattered;
        let count = match sample.scatter {
            Scatter::Diffuse => &mut scattered.diffuse,
            Scatter::Glossy => &mut scattered.glossy,
            Scatter::Specular => &mut scattered.specular,
        };
        *count = count.saturating_add(1);
        let ior_scale = path.trail.ior_scale * sample.ior * sample.ior;
        let (inside, passed) = (self.inside(path, sample.wi), 0);
        let chain = self.chain(world, object, path, sample, inside);
        if sample.scatter == Scatter::Specular {
            return Trail { pdf: f32::INFINITY, ior_scale, inside, passed, scattered, chain, ..path.trail };
        }
        let Receiver { point: from, error, normal, .. } = self.receiver();
        Trail { from, error, normal, pdf: sample.pdf, asked, ior_scale, inside, passed, scattered, chain }
    }
}

impl Path {
    /// Takes away the ways of scattering that a path has had as often as it may: for lights that are asked and for
    /// directions that are followed alike, since both share the light between them.
    #[inline]
    pub fn limit(&self, bsdf: &mut Bsdf, path: &PathState) {
        if self.max_diffuse.is_some() || self.max_glossy.is_some() || self.max_specular.is_some() {
            self.mute(bsdf, path);
        }
    }

    fn mute(&self, bsdf: &mut Bsdf, path: &PathState) {
        let Counts { diffuse, glossy, specular, .. } = path.trail.scattered;
        let is_done = |count: u16, most: Option<u32>| most.is_some_and(|most| u32::from(count) >= most);
        bsdf.mute(|scatter| match scatter {
            Scatter::Diffuse => is_done(diffuse, self.max_diffuse),
            Scatter::Glossy => is_done(glossy, self.max_glossy),
            Scatter::Specular => is_done(specular, self.max_specular),
        });
    }

    /// The direction that the material chooses.
    pub fn go_on(&self, seen: &Seen, world: &World, object: u32, path: &PathState, emit: &mut Emit) {
        let Some((wi, sample)) = seen.sample(path) else { return };
        if !seen.agree(wi, sample.wi) {
            return;
        }
        let trail = seen.trail(world, object, path, &sample, self.asked(world, path));
        let throughput = emit.weight() * sample.weight * trail.ior_scale;
        if throughput.is_black() {
            return;
        }
        if let Some(chance) = self.survival(path, throughput) {
            emit.follow(seen.surface.spawn(wi, seen.time), sample.weight * (1.0 / chance), trail, 1);
        }
    }
}
