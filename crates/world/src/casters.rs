//! Polished balls, by way of which lights light other things: paths from there would find the lights by chance only.

use super::standing::{Standing, standing};
use super::{Level, Receiver, World};
use crate::manifold::{Ball, Way, cosine};
use arrayvec::ArrayVec;
use juggler_bsdf::Bsdf;
use juggler_material::medium::Medium;
use juggler_material::{MaterialId, MaterialTable, View};
use juggler_math::{Frame, Motion, Rgb, Vec2, Vec3, warp};
use juggler_shape::AnyShape;
use juggler_shape::surface::Surface;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::f32::consts::TAU;

/// More balls than this and only the largest are asked: asking takes a look at each.
const MOST: usize = 16;

/// Of more than this only the first are looked at: with instances there may be any number.
const MOST_FOUND: usize = 1 << 12;

/// What all balls together must look like, as a share of half the sky times what they reflect, for one to be asked for sure.
const ALWAYS: f32 = 0.5;

/// The share of directions that are those of balls: at most, and by what they are worth.
const GUIDED: f32 = 0.15;
const GUIDED_BY_WORTH: f32 = 8.0;

/// Balls whose surfaces are nowhere further apart than this, in radii, coincide.
const COINCIDENT: f32 = 2e-4;

/// A polished ball in its place.
#[derive(Clone, Debug)]
pub struct Caster {
    /// Where it is.
    pub ball: Ball,
    /// Numbers of the shapes: several where balls of the same material lie in the same place, any
    /// of which a ray may hit.
    objects: Vec<u32>,
    polish: Polish,
}

/// What a polished ball is made of.
#[derive(Clone, Debug)]
struct Polish {
    /// How it scatters, from outside, z outwards.
    bsdf: Bsdf,
    /// What it mirrors, roughly, and what it lets through: 0 for a way that it does not offer.
    strengths: [f32; 2],
    ior: f32,
    medium: Medium,
}

impl Polish {
    /// Of a material that is the same everywhere, if it mirrors or is clear.
    fn of(id: MaterialId, materials: &MaterialTable) -> Option<Self> {
        if materials.is_textured(id) || !materials.is_simple(id) {
            return None;
        }
        let surface = Surface::new(Vec3::ZERO, 0.0, Vec3::Z, Vec2::ZERO);
        let bsdf = materials.shade(id, &View::of(&surface)).bsdf;
        let interior = materials.interior(id).and_then(|id| materials.interiors().get(id.place()));
        // Well off the axis: about what it mirrors on average.
        let deltas = bsdf.deltas(Vec3::new(0.8, 0.0, 0.6));
        let of = |is_up: bool| {
            let weights = deltas.iter().filter(|delta| (delta.wi.z > 0.0) == is_up).map(|delta| delta.weight);
            weights.fold(0.0, |sum: f32, weight| sum + weight.max_channel())
        };
        let clear = interior.filter(|interior| bsdf.is_specular() && interior.ior > 1.0 && !interior.medium.scatters());
        let through = if clear.is_some() { (1.0 - of(true)).max(0.0) } else { 0.0 };
        let (ior, medium) = interior.map_or((1.0, Medium::default()), |interior| (interior.ior, interior.medium));
        let strengths = [of(true), through];
        (strengths != [0.0; 2]).then_some(Self { bsdf, strengths, ior, medium })
    }

    /// Whether two materials do the same to light.
    fn equals(&self, other: &Self) -> bool {
        let weights = |polish: &Self| {
            [Vec3::new(0.8, 0.0, 0.6), Vec3::new(0.2, 0.0, 0.98), Vec3::new(0.8, 0.0, -0.6)]
                .map(|wo| polish.bsdf.deltas(wo).iter().fold(Rgb::BLACK, |sum, delta| sum + delta.weight))
        };
        (self.strengths, self.ior, self.medium) == (other.strengths, other.ior, other.medium)
            && weights(self) == weights(other)
    }
}

/// A ball and a way by it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CasterId {
    place: u16,
    is_refracted: bool,
}

impl Caster {
    /// The polished balls among the shapes of a world.
    pub(super) fn all(top: &Level, materials: &MaterialTable) -> Vec<Self> {
        // Each material once: balls may be many.
        let polishes = RefCell::new(BTreeMap::new());
        let has_polish = |id| polishes.borrow_mut().entry(id).or_insert_with(|| Polish::of(id, materials)).is_some();
        let is_polished = |shape: &AnyShape, id| matches!(shape, AnyShape::Sphere(_)) && has_polish(id);
        let balls = standing(top, MOST_FOUND, &is_polished);
        let polishes = polishes.into_inner();
        let polish = |ball: &Standing| polishes.get(&ball.material)?.as_ref();
        let mut casters: Vec<Self> = balls.iter().filter_map(|ball| Self::new(ball, polish(ball)?)).collect();
        casters.sort_by(|a, b| b.ball.radius.total_cmp(&a.ball.radius));
        let mut casters = Self::without_coincident(casters);
        casters.truncate(MOST);
        casters
    }

    /// Joins balls of one material in exactly the same place. Leaves out balls that nearly
    /// coincide, or whose materials differ: which of them a ray hits is up to rounding, so that
    /// their light must be found by the path alone.
    fn without_coincident(casters: Vec<Self>) -> Vec<Self> {
        let mut joined: Vec<(Self, bool)> = Vec::with_capacity(casters.len());
        for caster in casters {
            // Sorted by radius: balls about as large stand at the end.
            let nearby =
                joined.iter_mut().rev().take_while(|(other, _)| other.ball.radius <= caster.ball.radius * 1.01);
            let mut coincident = nearby.filter(|(other, _)| other.coincides(&caster)).peekable();
            let is_free = coincident.peek().is_none();
            for (other, is_usable) in coincident {
                if *is_usable && other.ball == caster.ball && other.polish.equals(&caster.polish) {
                    other.objects.extend(&caster.objects);
                } else {
                    *is_usable = false;
                }
            }
            if is_free {
                joined.push((caster, true));
            }
        }
        joined.into_iter().filter_map(|(caster, is_usable)| is_usable.then_some(caster)).collect()
    }

    /// Whether the surfaces of two balls are so near each other everywhere that rounding may swap
    /// them.
    fn coincides(&self, other: &Self) -> bool {
        let (a, b) = (self.ball, other.ball);
        (a.center - b.center).length() + (a.radius - b.radius).abs() <= COINCIDENT * a.radius
    }

    /// Whether a shape is this ball, or coincides with it.
    pub fn is(&self, object: u32) -> bool {
        self.objects.contains(&object)
    }

    fn new(standing: &Standing, polish: &Polish) -> Option<Self> {
        let (AnyShape::Sphere(sphere), Motion::Still(transform)) = (&*standing.shape, &standing.motion) else {
            return None;
        };
        let radius = sphere.radius * transform.uniform_scale()?;
        let ball = Ball { center: transform.origin(), radius };
        Some(Self { ball, objects: vec![standing.number], polish: polish.clone() })
    }

    /// How light goes by it.
    #[inline]
    fn way(&self, is_refracted: bool) -> Way {
        if is_refracted { Way::Refracted { ior: self.polish.ior } } else { Way::Mirrored }
    }

    /// What it leaves of light on a way of incidence `sine`.
    pub fn throughput(&self, way: Way, sine: f32) -> Rgb {
        let scattered = |wo: Vec3, is_up: bool| {
            let deltas = self.polish.bsdf.deltas(wo);
            deltas.iter().filter(|delta| (delta.wi.z > 0.0) == is_up).fold(Rgb::BLACK, |sum, delta| sum + delta.weight)
        };
        let Way::Refracted { ior } = way else { return scattered(Vec3::new(sine, 0.0, cosine(sine)), true) };
        let inside = sine / ior;
        let cos_inside = cosine(inside);
        let in_and_out =
            scattered(Vec3::new(sine, 0.0, cosine(sine)), false) * scattered(Vec3::new(inside, 0.0, -cos_inside), true);
        in_and_out * self.polish.medium.transmittance(2.0 * self.ball.radius * cos_inside)
    }

    /// As it is seen from a place; worth nothing from within, or where it lies below the plane.
    #[inline]
    fn sight(&self, to: &Receiver) -> Sight {
        let Ball { center, radius } = self.ball;
        let below = to.normal != Vec3::ZERO && to.normal.dot(center - to.point) <= -radius;
        let Some(end) = self.ball.end(to.point).filter(|_| !below) else { return Sight::NONE };
        let seen = Ball::seen(end.nearness);
        Sight { worths: self.polish.strengths.map(|strength| strength * seen), toward: end.toward, seen }
    }
}

/// A ball as a place sees it.
#[derive(Clone, Copy, Debug)]
struct Sight {
    /// What its ways are worth.
    worths: [f32; 2],
    /// Unit, from its centre towards the place.
    toward: Vec3,
    /// One less the cosine of the half angle under which it is seen.
    seen: f32,
}

impl Sight {
    const NONE: Self = Self { worths: [0.0; 2], toward: Vec3::ZERO, seen: 0.0 };

    fn worth(&self) -> f32 {
        self.worths[0] + self.worths[1]
    }
}

/// The polished balls as a place sees them.
pub struct Prospect {
    sights: ArrayVec<Sight, MOST>,
    /// What all are worth.
    total: f32,
}

impl Prospect {
    /// Without spheres.
    #[inline(always)]
    pub fn empty() -> Self {
        Self { sights: ArrayVec::new(), total: 0.0 }
    }

    /// A way by which light may come, and its chance; none as often as there is little to see.
    pub fn pick(&self, u: f32) -> Option<(CasterId, f32)> {
        let all = self.total.max(ALWAYS);
        let mut target = u * all;
        for (place, sight) in (0..).zip(&self.sights) {
            for (is_refracted, worth) in [false, true].into_iter().zip(sight.worths) {
                if target < worth {
                    return Some((CasterId { place, is_refracted }, worth / all));
                }
                target -= worth;
            }
        }
        None
    }

    /// The chance with which [`Prospect::pick`] picks that one.
    pub fn chance(&self, id: CasterId) -> f32 {
        let sight = self.sights.get(usize::from(id.place));
        sight.map_or(0.0, |sight| sight.worths[usize::from(id.is_refracted)]) / self.total.max(ALWAYS)
    }

    /// The share of directions that are to be those of balls.
    pub fn share(&self) -> f32 {
        (GUIDED_BY_WORTH * self.total).min(GUIDED)
    }

    /// A direction in which a ball is seen.
    pub fn sample(&self, u: Vec2) -> Option<Vec3> {
        let mut target = u.x * self.total;
        for sight in &self.sights {
            let worth = sight.worth();
            if target < worth {
                let u = Vec2::new((target / worth).min(1f32.next_down()), u.y);
                return Some(Frame::around(-sight.toward).to_world(warp::uniform_cone(u, sight.seen)));
            }
            target -= worth;
        }
        None
    }

    /// Density per steradian of [`Prospect::sample`].
    pub fn pdf(&self, direction: Vec3) -> f32 {
        let of = |sight: &Sight| {
            // The same way round as in sampling, whose rounding must not lead out of the cone.
            let is_seen = 1.0 + direction.dot(sight.toward) <= sight.seen + 1e-6;
            (sight.worth() > 0.0 && is_seen).then(|| sight.worth() / (self.total * TAU * sight.seen))
        };
        self.sights.iter().filter_map(of).sum()
    }
}

impl World {
    /// The ball of a way.
    #[inline]
    pub fn caster(&self, id: CasterId) -> Option<(&Caster, Way)> {
        self.casters.get(usize::from(id.place)).map(|caster| (caster, caster.way(id.is_refracted)))
    }

    /// Whether there are polished balls.
    #[inline]
    pub fn has_casters(&self) -> bool {
        !self.casters.is_empty()
    }

    /// The way by a shape, by its number, if it is a polished ball.
    pub fn caster_of(&self, object: u32, is_refracted: bool) -> Option<CasterId> {
        let place = self.casters.iter().position(|caster| caster.is(object))?;
        Some(CasterId { place: place as u16, is_refracted })
    }

    /// The polished balls as a place sees them.
    #[inline(always)]
    pub fn prospect(&self, from: &Receiver) -> Prospect {
        let mut prospect = Prospect::empty();
        self.fill_prospect(from, &mut prospect);
        prospect
    }

    /// [`World::prospect`] into an empty `prospect`, which is too large to be handed on by value.
    pub fn fill_prospect(&self, from: &Receiver, prospect: &mut Prospect) {
        for caster in self.casters.iter().take(MOST) {
            let sight = caster.sight(from);
            prospect.total = prospect.total + sight.worths[0] + sight.worths[1];
            prospect.sights.push(sight);
        }
    }
}

#[cfg(test)]
mod tests;
