//! Paths at surfaces: what a light brings, and where to go on.

use super::super::trail::power_heuristic;
use super::super::{Counts, Emit, PathState, Trail};
use super::{Path, dimension};
use crate::bsdf::{Bsdf, BsdfSample, Scatter};
use crate::material::Shade;
use crate::medium::InteriorId;
use crate::surface::Surface;
use crate::world::{MAX_PASSED, Receiver, Vertex, World};
use juggler_math::{Ray, Rgb, Vec3};

/// A vertex as seen by the one who looks.
pub struct Seen<'a> {
    surface: &'a Surface,
    pub shade: Shade,
    /// Unit, towards where the ray came from, in the world and in the frame of the scattering function.
    wo: Vec3,
    local: Vec3,
    time: f32,
    interior: Option<InteriorId>,
}

/// Goes straight on as if nothing had been there.
pub fn pass(world: &World, ray: &Ray, path: &PathState, vertex: &Vertex, emit: &mut Emit) {
    if path.trail.passed < MAX_PASSED {
        let inside = crossed(path, vertex.surface.normal.dot(ray.direction) < 0.0, world.interior(vertex));
        let trail = Trail { passed: path.trail.passed + 1, inside, ..path.trail };
        emit.follow(vertex.surface.spawn(ray.direction, ray.time), Rgb::WHITE, trail, 0);
    }
}

/// The solids that a path is in once it has crossed the surface of one, inwards or outwards.
fn crossed(path: &PathState, inwards: bool, interior: Option<InteriorId>) -> crate::medium::Interiors {
    let inside = path.trail.inside;
    match interior {
        Some(id) if inwards => inside.entered(id),
        Some(id) => inside.left(id),
        None => inside,
    }
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
    pub fn new(ray: &Ray, vertex: &'a Vertex, shade: Shade, interior: Option<InteriorId>) -> Self {
        let wo = -ray.direction;
        let local = shade.frame.to_local(wo);
        Self { surface: &vertex.surface, shade, wo, local, time: ray.time, interior }
    }

    /// What one light brings.
    pub fn ask_light(&self, world: &World, path: &PathState, emit: &mut Emit) {
        let to = Receiver { point: self.surface.point, normal: self.receiving_normal(), time: self.time };
        let Some(light) = world.sample_light(&to, path.sampler.at(dimension::LIGHT).next_2d()) else { return };
        let wi = self.shade.frame.to_local(light.wi);
        if !self.agree(light.wi, wi) {
            return;
        }
        let (scattered, pdf) = self.shade.bsdf.eval_pdf(self.local, wi);
        if scattered.is_black() {
            return;
        }
        let share = if light.can_be_met { power_heuristic(light.pdf, pdf) } else { 1.0 };
        let scale = if light.is_lamp { self.shade.lamp_scale } else { 1.0 };
        let ray = self.surface.spawn_to(light.wi, light.distance, self.time);
        let inside = if wi.z * self.local.z < 0.0 { self.crossed(path) } else { path.trail.inside };
        emit.if_visible_inside(ray, light.radiance * scattered * (share * scale / light.pdf), inside);
    }

    /// The solids that a path is in that goes through here.
    fn crossed(&self, path: &PathState) -> crate::medium::Interiors {
        crossed(path, self.surface.normal.dot(self.wo) > 0.0, self.interior)
    }

    /// The normal on the side that light comes to; zero where it may come from both.
    fn receiving_normal(&self) -> Vec3 {
        if self.shade.transmissive { Vec3::ZERO } else { self.shade.frame.normal }
    }

    /// Whether the true surface has the direction `wi`, which is `local` in the frame, on the side on which the shading
    /// normal has it.
    fn agree(&self, wi: Vec3, local: Vec3) -> bool {
        let normal = self.surface.normal;
        (normal.dot(wi) * normal.dot(self.wo) < 0.0) == (local.z * self.local.z < 0.0)
    }

    fn trail(&self, path: &PathState, sample: &BsdfSample) -> Trail {
        let through = sample.wi.z * self.local.z < 0.0;
        let mut scattered = path.trail.scattered;
        let count = match sample.scatter {
            Scatter::Diffuse => &mut scattered.diffuse,
            Scatter::Glossy => &mut scattered.glossy,
            Scatter::Specular => &mut scattered.specular,
        };
        *count = count.saturating_add(1);
        let is_delta = sample.scatter == Scatter::Specular;
        Trail {
            from: self.surface.point,
            normal: self.receiving_normal(),
            pdf: if is_delta { f32::INFINITY } else { sample.pdf },
            ior_scale: path.trail.ior_scale * sample.ior * sample.ior,
            inside: if through { self.crossed(path) } else { path.trail.inside },
            passed: 0,
            scattered,
        }
    }
}

impl Path {
    /// Takes away the ways of scattering that a path has had as often as it may: for lights that are asked and for
    /// directions that are followed alike, since both share the light between them.
    pub fn limit(&self, bsdf: &mut Bsdf, path: &PathState) {
        if [self.max_diffuse, self.max_glossy, self.max_specular] == [None; 3] {
            return;
        }
        let Counts { diffuse, glossy, specular, .. } = path.trail.scattered;
        let is_done = |count: u16, most: Option<u32>| most.is_some_and(|most| u32::from(count) >= most);
        bsdf.mute(|scatter| match scatter {
            Scatter::Diffuse => is_done(diffuse, self.max_diffuse),
            Scatter::Glossy => is_done(glossy, self.max_glossy),
            Scatter::Specular => is_done(specular, self.max_specular),
        });
    }

    /// The direction that the material chooses.
    pub fn go_on(&self, seen: &Seen, path: &PathState, emit: &mut Emit) {
        let u = path.sampler.at(dimension::SCATTER).next_2d();
        let Some(sample) = seen.shade.bsdf.sample(seen.local, u) else { return };
        let wi = seen.shade.frame.to_world(sample.wi);
        if !seen.agree(wi, sample.wi) {
            return;
        }
        let trail = seen.trail(path, &sample);
        let throughput = emit.weight() * sample.weight * trail.ior_scale;
        if throughput.is_black() {
            return;
        }
        if let Some(chance) = self.survival(path, throughput) {
            emit.follow(seen.surface.spawn(wi, seen.time), sample.weight * (1.0 / chance), trail, 1);
        }
    }
}
