//! Path tracing: light as it is (Kajiya, The Rendering Equation, 1986).
//!
//! At each vertex one light is asked (next-event estimation) and one direction is followed that the material chooses.
//! What both ways could have found is weighted by the power heuristic (Veach 1997, section 9.2.2).
//!
//! ```json
//! {"path": {"max_depth": 16, "roulette_depth": 4}}
//! ```

use super::{Clamp, Emit, Integrator, PathState};
use caustic::Met;
use juggler_material::Shade;
use juggler_math::{Ray, Rgb, Vec2};
use juggler_world::{Prospect, Receiver, Shadows, Vertex, World};
pub use sampling::Sampling;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use surface::Seen;

mod caustic;
mod sampling;
mod surface;
mod volume;

/// Sampler dimensions of a path vertex. Each value belongs to one decision: two variants of an enum
/// cannot share a value.
#[derive(Clone, Copy, Debug)]
enum Dimension {
    /// Choice among several materials, and whether the surface is transparent at this point.
    Choice = 0,
    /// Choice of a light and of a point on it.
    Light = 1,
    /// Direction of the next path segment.
    Scatter = 2,
    /// Russian roulette.
    Roulette = 3,
    /// Distance to the next scattering event in a medium.
    Flight = 4,
    /// Whether a microfacet of rough glass reflects or refracts.
    Facet = 5,
    /// Choice of a specular sphere for light sampling.
    Caster = 6,
    /// Choice of a light, and of a point on it, as seen from the specular sphere.
    CasterLight = 7,
}

/// Lights that are asked at the first vertex where there are several.
const SEVERAL: u32 = 2;

/// Path tracing: light as it is, of every way that it may take.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Path {
    /// Stretches of a path from the camera to a light, at most: 1 sees what shines, 2 what it lights.
    #[schemars(range(min = 1, max = 10_000))]
    pub max_depth: u32,
    /// How often a path may be scattered by matte surfaces.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(max = 10_000))]
    pub max_diffuse: Option<u32>,
    /// How often a path may be scattered by rough mirrors and rough glass.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(max = 10_000))]
    pub max_glossy: Option<u32>,
    /// How often a path may be mirrored or refracted by what is smooth.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(max = 10_000))]
    pub max_specular: Option<u32>,
    /// How often a path may be scattered by media.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(max = 10_000))]
    pub max_volume: Option<u32>,
    /// Stretches after which paths that are worth little may end by chance (Russian roulette), which costs no
    /// correctness; nothing for never.
    #[schemars(range(min = 1, max = 10_000))]
    pub roulette_depth: Option<u32>,
    /// Lights that are asked at the first surface that is not smooth, where most of the noise comes from; nothing for two
    /// where there are several lights, else one.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1, max = 64))]
    pub light_samples: Option<u32>,
    /// Strategy for light that a ray can hit: `mis` combines light samples and BSDF samples and has
    /// the least noise; `light` and `bsdf` use one of them alone, for comparisons.
    #[serde(skip_serializing_if = "Sampling::is_default")]
    pub sampling: Sampling,
    /// The most that light on a way of up to two stretches may bring to a sample: its brightest channel is limited, its
    /// hue stays. Nothing for no limit. What this takes away is reported.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1e-6, max = 1e30))]
    pub clamp_direct: Option<f32>,
    /// The same for light on longer ways: fewer bright specks, and less light than there is.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1e-6, max = 1e30))]
    pub clamp_indirect: Option<f32>,
}

impl Path {
    /// What lights light, and nothing that other things reflect.
    pub(super) const DIRECT: Self = Self {
        max_depth: 2,
        max_diffuse: None,
        max_glossy: None,
        max_specular: None,
        max_volume: None,
        roulette_depth: None,
        light_samples: None,
        sampling: Sampling::Mis,
        clamp_direct: None,
        clamp_indirect: None,
    };

    /// How many lights are asked at a vertex.
    fn asked(&self, world: &World, path: &PathState) -> u16 {
        let first = || self.light_samples.unwrap_or(if world.has_many_emitters() { SEVERAL } else { 1 });
        if path.trail.scattered.is_first() { first().clamp(1, 64) as u16 } else { 1 }
    }

    /// The chance with which a path of this throughput goes on, when it does.
    fn survival(&self, path: &PathState, throughput: Rgb) -> Option<f32> {
        if self.roulette_depth.is_none_or(|depth| path.depth + 1 < depth) {
            return Some(1.0);
        }
        // Filters may weight samples by less than nothing.
        let chance = throughput.map(f32::abs).max_channel().min(1.0);
        (path.sampler.at(Dimension::Roulette as u32).next_1d() < chance).then_some(chance)
    }
}

impl Default for Path {
    fn default() -> Self {
        Self { max_depth: 64, roulette_depth: Some(4), ..Self::DIRECT }
    }
}

impl Integrator for Path {
    fn vertex(&self, world: &World, ray: &Ray, path: &PathState, vertex: &Vertex, emit: &mut Emit) {
        if self.flies(world, ray, ray.t_max, path, emit) {
            return;
        }
        let interior = world.interior(vertex);
        if interior.is_some_and(|id| surface::is_covered(world, ray, path, vertex, id)) {
            return surface::pass(world, ray, path, vertex, emit);
        }
        let around = surface::around(world, path, interior);
        let choice =
            if world.is_simple(vertex) { Vec2::ZERO } else { path.sampler.at(Dimension::Choice as u32).next_2d() };
        let mut shade = Shade::black();
        world.fill_shade(vertex, -ray.direction, around, choice.x, &mut shade);
        if shade.opacity < 1.0 && choice.y >= shade.opacity {
            return surface::pass(world, ray, path, vertex, emit);
        }
        emit.see_shaded(world, ray, vertex, &shade);
        if !shade.emission.is_black() {
            let light = || world.light_pdf(&path.trail.receiver(ray.time), vertex);
            let bent = |to: &Receiver, way: &Ray| world.light_pdf(to, vertex) * caustic::tilt(way, ray, vertex);
            let end = Met::Surface(vertex.surface.point);
            let weight = self.met_weight(world, path, ray, light, end, bent);
            emit.add(shade.emission * weight, world.shape_group(vertex.object));
        }
        if path.depth + 1 >= self.max_depth {
            return;
        }
        self.limit(&mut shade.bsdf, path);
        let mut prospect = Prospect::empty();
        let mut seen = Seen::new(ray, vertex, &shade, interior);
        if !seen.shade.bsdf.is_specular() {
            seen.look_for_casters(world, &mut prospect);
            seen.ask_lights(self.asked(world, path), self.sampling, world, path, emit);
            self.ask_by_ball(&seen, world, path, emit);
        }
        self.go_on(&seen, world, vertex.object, path, emit);
    }

    fn escape(&self, world: &World, ray: &Ray, path: &PathState, emit: &mut Emit) {
        if !self.flies(world, ray, f32::INFINITY, path, emit) {
            emit.miss(ray);
            let light = || world.background_pdf(ray.direction);
            let weight = self.met_weight(world, path, ray, light, Met::Background, |_, _| light());
            emit.add(world.background(ray) * weight, world.background_group());
        }
    }

    fn fades_patterns(&self) -> bool {
        true
    }

    fn shadows(&self) -> Shadows {
        Shadows::Physical
    }

    fn clamp(&self) -> Option<Clamp> {
        let [direct, indirect] = [self.clamp_direct, self.clamp_indirect].map(|limit| limit.unwrap_or(f32::INFINITY));
        (direct < f32::INFINITY || indirect < f32::INFINITY).then_some(Clamp { direct, indirect })
    }
}

#[cfg(any(test, feature = "testing"))]
impl Path {
    /// For the contract tests.
    pub fn examples() -> Vec<Self> {
        let clamped = Self { clamp_direct: Some(4.0), clamp_indirect: Some(0.5), ..Self::default() };
        vec![Self::default(), Self { max_depth: 3, max_diffuse: Some(1), ..Self::DIRECT }, clamped]
    }
}
