//! Light that comes by way of polished balls: asked for, and met by chance. Both share what both can find (Veach 1997,
//! section 9.2.2), so that what only one of them finds is never lost, nor counted twice.

use super::super::{Chain, Emit, PathState, Stage};
use super::surface::Seen;
use super::{Dimension, Path, Sampling};
use arrayvec::ArrayVec;
use juggler_bsdf::{BsdfSample, Scatter};
use juggler_material::medium::Interiors;
use juggler_math::{Ray, Rgb, Vec2, Vec3, robust};
use juggler_shape::surface::Surface;
use juggler_world::manifold::{Bend, End, Way, bends, spread};
use juggler_world::{Caster, Lighting, Origin, Receiver, Vertex, World};

/// How much of a stretch to a ball, as a share of its radius, is left out at the end: one that comes in flat must not meet
/// the ball before it is there.
const SHORT_OF: f32 = 1e-4;

/// What a path met at its end.
#[derive(Clone, Copy)]
pub enum Met {
    /// A place that shines.
    Surface(Vec3),
    /// What lies behind everything.
    Background,
}

/// A ball as what light comes to.
fn from_center(caster: &Caster, time: f32) -> Receiver {
    Receiver { point: caster.ball.center, error: 0.0, normal: Vec3::ZERO, time }
}

/// Solid angle of a place along `seen` over that along `way`, but for the distance: 0 where they see different sides of
/// it.
pub fn tilt(way: &Ray, seen: &Ray, vertex: &Vertex) -> f32 {
    ratio(vertex.surface.normal, way.direction, seen.direction)
}

fn ratio(normal: Vec3, way: Vec3, seen: Vec3) -> f32 {
    let ratio = normal.dot(way) / normal.dot(seen);
    if ratio > 0.0 { ratio } else { 0.0 }
}

impl Path {
    /// The weight of light that a path has met along `ray`. `light` is the density with which it
    /// would have been asked straight, `bent` that with which a ball would have asked it, along a
    /// ray from its centre.
    pub fn met_weight(
        &self,
        world: &World,
        path: &PathState,
        ray: &Ray,
        light: impl FnOnce() -> f32,
        met: Met,
        bent: impl FnOnce(&Receiver, &Ray) -> f32,
    ) -> f32 {
        let Chain { stage: Stage::Done(id), pdf, sine } = path.trail.chain else {
            return path.trail.weight(self.sampling, light);
        };
        let Some((caster, way)) = world.caster(id) else { return 1.0 };
        let center = caster.ball.center;
        let (direction, to) = match met {
            Met::Surface(place) => ((place - center).normalize_or_zero(), caster.ball.end(place)),
            Met::Background => (ray.direction, Some(End::infinity(ray.direction))),
        };
        let from = path.trail.receiver(ray.time);
        let (Some(start), Some(end)) = (caster.ball.end(from.point), to) else { return 1.0 };
        let asked = bent(&from_center(caster, ray.time), &Ray { time: ray.time, ..Ray::new(center, direction) });
        let asked = asked * spread(way, &start, &end, sine) * world.prospect(&from).chance(id);
        if asked > 0.0 { self.sampling.bsdf_weight(pdf, asked) } else { 1.0 }
    }

    /// Asks one light by way of one ball.
    pub fn ask_by_ball(&self, seen: &Seen, world: &World, path: &PathState, emit: &mut Emit) {
        let Some(prospect) = seen.prospect else { return };
        let picked = prospect.pick(path.sampler.at(Dimension::Caster as u32).next_1d());
        let Some((id, chance)) = picked else { return };
        let Some((caster, way)) = world.caster(id).filter(|(_, way)| self.allows(*way, path)) else { return };
        let u = path.sampler.at(Dimension::CasterLight as u32).next_2d();
        let Some(light) = world.sample_light(&from_center(caster, seen.time), u) else { return };
        let place = caster.ball.center + light.wi * light.distance;
        let to = if light.distance < f32::INFINITY { caster.ball.end(place) } else { Some(End::infinity(light.wi)) };
        let (Some(start), Some(end)) = (caster.ball.end(seen.surface.point), to) else { return };
        for bend in bends(way, &start, &end) {
            let asked = chance * light.pdf * spread(way, &start, &end, bend.sine);
            let asked = Asked { world, caster, way, light: &light, place, asked, sampling: self.sampling };
            seen.ask_along(&asked, &bend, path, emit);
        }
    }

    /// Whether a path may have as many more vertices.
    fn allows(&self, way: Way, path: &PathState) -> bool {
        let more = if way == Way::Mirrored { 1 } else { 2 };
        let specular = u32::from(path.trail.scattered.specular) + more;
        path.depth + 1 + more < self.max_depth && self.max_specular.is_none_or(|most| specular <= most)
    }
}

/// A light that is asked by way of a ball.
struct Asked<'a> {
    world: &'a World,
    caster: &'a Caster,
    way: Way,
    light: &'a Lighting,
    /// Where it shines from, if it has a place.
    place: Vec3,
    /// Density per steradian of the way.
    asked: f32,
    sampling: Sampling,
}

impl Asked<'_> {
    /// What leaves the light along the way, as seen from the centre of the ball, and the density of the way.
    fn light(&self, last: Vec3, time: f32) -> Option<(Rgb, f32)> {
        let Lighting { radiance, distance, origin, normal, wi, .. } = *self.light;
        if distance == f32::INFINITY {
            return Some((radiance, self.asked));
        }
        let way = self.place - last;
        let Origin::Lamp(lamp) = origin else {
            let tilt = if normal == Vec3::ZERO { 0.0 } else { ratio(normal, wi, way.normalize_or_zero()) };
            return (tilt > 0.0).then_some((radiance, self.asked * tilt));
        };
        let there = self.world.point_light(lamp, &Receiver { point: last, error: 0.0, normal: Vec3::ZERO, time })?;
        Some((there.radiance * (way.length_squared() / (distance * distance)), self.asked))
    }

    /// The stretches of the way, each short of what it ends on.
    fn legs(&self, from: &Surface, bend: &Bend, time: f32) -> ArrayVec<Ray, 3> {
        let ball = self.caster.ball;
        let error = robust::gamma(8) * (ball.center.abs().max_element() + ball.radius);
        let on_ball = bend.touches.map(|to| Surface::new(ball.center + to * ball.radius, error, to, Vec2::ZERO));
        let leg = |from: &Surface, to: Vec3, short: f32| {
            let (way, distance) = (to - from.point, (to - from.point).length());
            from.spawn_to(way / distance, distance - short, time)
        };
        let [first, last] = &on_ball;
        let mut legs = ArrayVec::new();
        legs.push(leg(from, first.point, SHORT_OF * ball.radius));
        if self.way != Way::Mirrored {
            legs.push(leg(first, last.point, SHORT_OF * ball.radius));
        }
        legs.push(match self.light.distance {
            f32::INFINITY => last.spawn(self.light.wi, time),
            _ => leg(last, self.place, 0.0),
        });
        legs
    }
}

impl Seen<'_> {
    fn ask_along(&self, ask: &Asked, bend: &Bend, path: &PathState, emit: &mut Emit) {
        let wi = self.shade.frame.to_local(bend.direction);
        if !self.agree(bend.direction, wi) || !self.inside(path, wi).is_empty() {
            return;
        }
        let (scattered, pdf) = self.eval_pdf(bend.direction, wi);
        let last = ask.caster.ball.center + bend.touches[1] * ask.caster.ball.radius;
        let Some((radiance, asked)) = ask.light(last, self.time).filter(|_| !scattered.is_black()) else { return };
        if !(asked > 0.0 && asked < f32::INFINITY) {
            return;
        }
        let thrown = radiance * scattered * ask.caster.throughput(ask.way, bend.sine);
        let group = ask.world.light_group(ask.light.origin);
        let legs = ask.legs(self.surface, bend, self.time);
        let weight = self.light_sample_weight(ask.sampling, ask.light, asked, pdf);
        emit.if_all_free(legs, thrown * weight, group);
    }

    /// What a path knows of balls that goes on from here, `object`, as `sample` says, into the solids `inside`.
    pub fn chain(&self, world: &World, object: u32, path: &PathState, sample: &BsdfSample, inside: Interiors) -> Chain {
        if !world.has_casters() {
            return Chain::NONE;
        }
        if sample.scatter != Scatter::Specular {
            let stage = if inside.is_empty() { Stage::Asked } else { Stage::Elsewhere };
            return Chain { stage, pdf: sample.pdf, sine: 0.0 };
        }
        let chain = path.trail.chain;
        let goes_through = sample.wi.z * self.local.z < 0.0;
        let stage = match chain.stage {
            Stage::Asked if path.trail.inside.is_empty() && self.local.z > 0.0 => {
                let sine = (self.local.x * self.local.x + self.local.y * self.local.y).sqrt();
                let caster = world.caster_of(object, goes_through);
                let stage = if goes_through { caster.map(Stage::Inside) } else { caster.map(Stage::Done) };
                return Chain { stage: stage.unwrap_or(Stage::Elsewhere), sine, ..chain };
            }
            Stage::Inside(id) if goes_through && inside.is_empty() => {
                let is_same = world.caster(id).is_some_and(|(caster, _)| caster.is(object));
                if is_same { Stage::Done(id) } else { Stage::Elsewhere }
            }
            _ => Stage::Elsewhere,
        };
        Chain { stage, ..chain }
    }
}
