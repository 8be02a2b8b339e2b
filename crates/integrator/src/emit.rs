//! What an integrator may do at a vertex.

use super::{Clamping, Cone, Record, Trail, Way};
use arrayvec::ArrayVec;
use juggler_camera::film::Samples;
use juggler_camera::layer::LightGroup;
use juggler_camera::sampler::Sampler;
use juggler_material::medium::Interiors;
use juggler_math::{Ray, Rgb};

/// What a ray in flight carries along.
#[derive(Clone, Copy, Debug)]
pub struct PathState {
    /// What its radiance is worth to the sample.
    pub weight: Rgb,
    /// Vertices before the next one.
    pub depth: u32,
    /// Numbers of the next vertex.
    pub sampler: Sampler,
    /// What a path of light remembers of its last vertex.
    pub trail: Trail,
    /// How wide it is.
    pub cone: Cone,
    /// Sample of the engine's pass.
    pub slot: u32,
}

/// Rays in flight, in order of their slots.
#[derive(Debug, Default)]
pub struct Queue {
    /// Rays in world space.
    pub rays: Vec<Ray>,
    /// State of the path that each ray belongs to.
    pub paths: Vec<PathState>,
}

impl Queue {
    /// Appends a ray.
    #[inline]
    pub fn push(&mut self, ray: Ray, path: PathState) {
        self.rays.push(ray);
        self.paths.push(path);
    }

    /// Number of rays.
    #[inline]
    pub fn len(&self) -> usize {
        self.rays.len()
    }

    /// Whether the queue holds no ray.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.rays.is_empty()
    }

    /// Removes all rays; memory is kept.
    pub fn clear(&mut self) {
        self.rays.clear();
        self.paths.clear();
    }
}

/// Questions whether a light is seen, and what it adds when it is.
#[derive(Debug, Default)]
pub struct ShadowQueue {
    /// Shadow rays in world space, which end before the light.
    pub rays: Vec<Ray>,
    /// What each ray adds to which slot.
    pub gains: Vec<Gain>,
}

impl ShadowQueue {
    /// Removes all rays; memory is kept.
    pub fn clear(&mut self) {
        self.rays.clear();
        self.gains.clear();
    }
}

/// What a shadow ray adds when it comes through.
#[derive(Clone, Copy, Debug)]
pub struct Gain {
    /// To which sample: passes are short enough.
    pub slot: u16,
    /// How far it has come.
    pub way: Way,
    /// Which group of lights it is of.
    pub group: LightGroup,
    /// How much.
    pub radiance: Rgb,
    /// The solids that the ray starts in.
    pub inside: Interiors,
}

/// A light that is seen, if all stretches of a way to it are free.
#[derive(Clone, Debug)]
pub struct Bent {
    /// Shadow rays along the segments of the path, in world space.
    pub legs: ArrayVec<Ray, 3>,
    /// To which sample.
    pub slot: u32,
    /// Which group of lights it is of.
    pub group: LightGroup,
    /// How much.
    pub radiance: Rgb,
}

/// Everything that a segment of the queue brings forth; kept and emptied by the engine.
#[derive(Debug, Default)]
pub struct Harvest {
    /// What each sample has gathered.
    pub radiance: Vec<Rgb>,
    /// What limits that.
    pub clamping: Option<Clamping>,
    /// What else is kept of each.
    pub record: Option<Record>,
    /// One queue a light, whose rays run much the same way, and at the end one for rays that do not.
    pub shadows: Vec<ShadowQueue>,
    /// Ways around a corner to lights.
    pub bent: Vec<Bent>,
    /// Shadow rays that wait, in all queues.
    pub pending: usize,
    /// Rays that go on.
    pub next: Queue,
}

impl Harvest {
    /// For samples 0..`slots` and a world of `lights` lights.
    pub fn reset(&mut self, slots: usize, lights: usize) {
        self.radiance.clear();
        self.radiance.resize(slots, Rgb::BLACK);
        self.shadows.resize_with(lights.min(MAX_LIGHT_QUEUES) + 1, ShadowQueue::default);
    }

    /// All samples, as they are gathered.
    pub fn samples(&self) -> Samples<'_> {
        let clamped = self.clamping.as_ref().map_or(&[][..], |clamping| &clamping.taken);
        let (planes, marks) = self.record.as_ref().map_or((&[][..], &[][..]), |record| (&record.planes, &record.marks));
        Samples { radiance: &self.radiance, clamped, planes, marks }
    }

    /// Adds to a sample what limits leave of it.
    #[inline]
    pub fn add(&mut self, slot: usize, way: Way, group: LightGroup, mut radiance: Rgb) {
        if let Some(clamping) = &mut self.clamping {
            radiance = clamping.limit(slot, way, radiance);
        }
        if let Some(record) = &mut self.record {
            record.light(slot, way, group, radiance);
        }
        self.radiance[slot] += radiance;
    }
}

/// More lights than this share queues.
const MAX_LIGHT_QUEUES: usize = 64;

/// What an integrator may do at a vertex: add, ask, go on.
pub struct Emit<'a> {
    pub(super) harvest: &'a mut Harvest,
    pub(super) path: &'a PathState,
    /// What radiance from here is worth to the sample.
    pub(super) weight: Rgb,
    /// How wide the ray is here.
    cone: Cone,
}

impl<'a> Emit<'a> {
    /// Of a path that has come `distance` far since its last vertex; infinitely when it leaves the world.
    #[inline]
    pub fn new(harvest: &'a mut Harvest, path: &'a PathState, distance: f32) -> Self {
        let cone = if distance < f32::INFINITY { path.cone.after(distance) } else { path.cone };
        Self { harvest, path, weight: path.weight, cone }
    }

    /// How wide the ray is here.
    #[inline]
    pub fn width(&self) -> f32 {
        self.cone.width
    }

    /// What radiance from here is worth to the sample.
    #[inline]
    pub fn weight(&self) -> Rgb {
        self.weight
    }

    /// From now on all counts `factor` times as much: what became of light on its way here.
    #[inline]
    pub fn scale(&mut self, factor: Rgb) {
        self.weight *= factor;
    }

    /// Adds to the sample, times the path's weight, light of a group of lights.
    #[inline]
    pub fn add(&mut self, radiance: Rgb, group: LightGroup) {
        let way = Way::of(self.path.depth.saturating_add(1));
        self.harvest.add(self.path.slot as usize, way, group, radiance * self.weight);
    }

    /// Adds, times the path's weight, what of `radiance` comes through along `ray` from light number `light`.
    #[inline]
    pub fn if_light_visible(&mut self, light: usize, ray: Ray, radiance: Rgb, group: LightGroup) {
        let queues = self.harvest.shadows.len() - 1;
        let queue = if light < queues { light } else { light % queues.max(1) };
        self.push_shadow(queue, ray, radiance, group, Interiors::NONE);
    }

    /// The same for a ray of no particular direction.
    #[inline]
    pub fn if_visible(&mut self, ray: Ray, radiance: Rgb, group: LightGroup) {
        self.if_visible_inside(ray, radiance, group, Interiors::NONE);
    }

    /// The same for a ray that starts in solids, whose media take their share of it.
    #[inline]
    pub fn if_visible_inside(&mut self, ray: Ray, radiance: Rgb, group: LightGroup, inside: Interiors) {
        self.push_shadow(self.harvest.shadows.len() - 1, ray, radiance, group, inside);
    }

    /// Adds, times the path's weight, `radiance` if all of the rays come through.
    pub fn if_all_free(&mut self, legs: ArrayVec<Ray, 3>, radiance: Rgb, group: LightGroup) {
        let radiance = radiance * self.weight;
        if !radiance.is_black() {
            self.harvest.pending += legs.len();
            self.harvest.bent.push(Bent { legs, slot: self.path.slot, group, radiance });
        }
    }

    fn push_shadow(&mut self, queue: usize, ray: Ray, radiance: Rgb, group: LightGroup, inside: Interiors) {
        let radiance = radiance * self.weight;
        if radiance.is_black() {
            return;
        }
        self.harvest.pending += 1;
        let queue = &mut self.harvest.shadows[queue];
        queue.rays.push(ray);
        let way = Way::of(self.path.depth.saturating_add(2));
        queue.gains.push(Gain { slot: self.path.slot as u16, way, group, radiance, inside });
    }

    /// Follows `ray`, the `child`-th that leaves this vertex; what it finds counts `weight` times as much.
    #[inline]
    pub fn go_on(&mut self, ray: Ray, weight: Rgb, child: u32) {
        let path = PathState {
            weight: self.weight * weight,
            depth: self.path.depth + 1,
            sampler: self.path.sampler.branch(child),
            cone: self.cone,
            ..*self.path
        };
        self.harvest.next.push(ray, path);
    }

    /// Follows `ray` as the one path that goes on from here, `steps` vertices further.
    #[inline]
    pub fn follow(&mut self, ray: Ray, weight: Rgb, trail: Trail, steps: u32) {
        let path = PathState {
            weight: self.weight * weight,
            depth: self.path.depth + steps,
            sampler: self.path.sampler.branch(0),
            trail,
            cone: self.cone.scattered(trail.pdf),
            ..*self.path
        };
        self.harvest.next.push(ray, path);
    }
}
