//! The samples of one pixel as the engine takes them, with all that their paths did: for those who ask why a pixel is as it is.
//!
//! Each sample is traced alone. As queues are cut between samples, and a sample's own rays at [`GROUP`], its light is added in
//! the same order as in a picture: the radiance is the same to the bit. Within a segment each ray has a slot of its own, so that the log
//! tells whose light is whose.

use super::{Engine, GROUP, meet};
use crate::expose::expose;
use crate::exposed::Exposed;
use crate::{Control, Job, Rays, Stopped, Work};
use juggler_camera::film::{Rect, Samples, Statistics, Tile};
use juggler_camera::layer::LightGroup;
use juggler_integrator::{Arrival, Event, PathLog, PathState, Queue, Record, Seen, Way};
use juggler_math::{Ray, Rgb, Vec3};
use juggler_world::Vertex;

/// Places of one sample that are kept; its light is right whatever their number.
const MOST_VERTICES: usize = 1 << 20;

/// Light that a sample gathers at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightGain {
    /// Its group of lights.
    pub group: LightGroup,
    /// How far it came.
    pub way: Way,
    /// Stretches from the camera to the light.
    pub stretches: u32,
    /// What it adds to the sample.
    pub radiance: Rgb,
    /// Whether the light was asked for; otherwise the path met it.
    pub asked: bool,
    /// The polished ball by whose way it was asked for: the number of its shape, its material, and whether it mirrors.
    pub by: Option<(Vertex, bool)>,
}

/// A place where a path was.
#[derive(Clone, Debug, PartialEq)]
pub struct PathVertex {
    /// The place before it among the sample's; nothing for the first.
    pub parent: Option<u32>,
    /// What the path did there to come here.
    pub came: Option<Event>,
    /// Vertices before it.
    pub depth: u32,
    /// The ray that led here; it ends at what was met.
    pub ray: Ray,
    /// What radiance from here is worth to the sample.
    pub weight: Rgb,
    /// The surface that the ray met; nothing where it left the world.
    pub met: Option<Vertex>,
    /// Where the path was scattered by a medium before it came there.
    pub scattered_at: Option<Vec3>,
    /// How light is scattered here that was asked for.
    pub lit: Event,
    /// Whether the surface was there, and no hole.
    pub is_seen: bool,
    /// Light that was added here.
    pub lights: Vec<LightGain>,
}

/// A sample, and what its paths did.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Inspected {
    /// Which sample of its pixel.
    pub index: u32,
    /// What the pixel's filter makes of it.
    pub weight: f32,
    /// What it adds to the pixel, as the film takes it.
    pub radiance: Rgb,
    /// What clamping took off it: the mean of its channels.
    pub clamped: f32,
    /// All places of its paths; each comes after the one before it.
    pub vertices: Vec<PathVertex>,
    /// Light of places beyond the most that are kept.
    pub untold: Rgb,
}

/// Takes all samples of a pixel and hands each to `each`. Returns the pixel of the finished picture, as the film has it, and its
/// statistics.
pub fn inspect(
    job: &Job,
    pixel: [u32; 2],
    control: &Control,
    mut each: impl FnMut(Inspected),
) -> Result<(Rgb, Statistics), Stopped> {
    let pixels = Rect { x: pixel[0], y: pixel[1], width: 1, height: 1 };
    let work = Work::first(pixels, job.samples);
    let mut film = Exposed::new(&work, &juggler_camera::layer::NONE);
    let mut inspector = Inspector { engine: Engine::new(job), control, sample: Inspected::default() };
    inspector.engine.harvest.record = Some(Record::logging());
    for index in 0..job.samples {
        let sample = inspector.sample(&Work { samples: index..index + 1, ..work.clone() });
        if control.is_cancelled() {
            return Err(Stopped);
        }
        let Inspected { radiance, clamped, .. } = sample;
        film.add(Samples { radiance: &[radiance], clamped: &[clamped], ..Samples::default() });
        control.add(1, &Rays::default());
        each(sample);
    }
    let tile: Tile = film.tile();
    Ok((tile.means().first().copied().unwrap_or(Rgb::BLACK), tile.statistics(0)))
}

/// One sample after the other.
struct Inspector<'j> {
    engine: Engine<'j>,
    control: &'j Control,
    /// The sample that is traced; not all of it when `control` is cancelled.
    sample: Inspected,
}

/// Rays on their way, and where each comes from: the place, and what happened there.
struct Flight {
    queue: Queue,
    from: Vec<Option<(u32, Event)>>,
}

/// What one segment's rays met.
#[derive(Default)]
struct Segment {
    /// The place of each ray, where it is kept.
    places: Vec<Option<u32>>,
    met: Vec<Option<Vertex>>,
    seen: Vec<Option<Seen>>,
    /// How many lights were asked for straight.
    straight: usize,
    /// Stretches of ways by balls, and the ball.
    bent: Vec<Option<Bend>>,
}

/// A way by a ball: how many stretches it makes, and the ball, where one sees it.
#[derive(Clone, Copy)]
struct Bend {
    stretches: u32,
    ball: Option<(Vertex, bool)>,
}

impl Inspector<'_> {
    fn sample(&mut self, work: &Work) -> Inspected {
        let mut camera = Queue::default();
        expose(self.engine.job, &self.engine.start, work, 1, 0..1, &mut camera);
        let weight = camera.paths.first().map_or(1.0, |path| path.weight.r);
        self.sample = Inspected { index: work.samples.start, weight, ..Inspected::default() };
        let mut stack = vec![Flight { from: vec![None; camera.len()], queue: camera }];
        while let Some(flight) = stack.pop()
            && !self.control.is_cancelled()
        {
            self.segment(flight, &mut stack);
        }
        std::mem::take(&mut self.sample)
    }

    fn segment(&mut self, mut flight: Flight, stack: &mut Vec<Flight>) {
        let count = flight.queue.len();
        (0..).zip(&mut flight.queue.paths).for_each(|(slot, path)| path.slot = slot);
        self.begin(count);
        self.engine.nearest(&mut flight.queue);
        let mut segment = Segment { bent: vec![None; count], seen: vec![None; count], ..Segment::default() };
        let Engine { job, measures, hits, harvest, .. } = &mut self.engine;
        for ((ray, path), hit) in flight.queue.rays.iter().zip(&flight.queue.paths).zip(hits.iter()) {
            segment.met.push(meet(job, *measures, harvest, ray, path, hit));
        }
        let met = self.log().map_or(0, |log| log.lights.len());
        segment.straight = self.engine.harvest.shadows.iter().map(|queue| queue.gains.len()).sum();
        self.ways_by_balls(&flight.queue, &mut segment);
        self.engine.shadows(self.control);
        self.keep(&flight, &mut segment);
        self.gains(&flight.queue, &segment, met);
        self.go_on(&flight.queue, &segment, stack);
    }

    fn begin(&mut self, count: usize) {
        let weight = self.sample.weight;
        let harvest = &mut self.engine.harvest;
        harvest.reset(count, self.engine.job.world.lamps().len());
        if let Some(clamping) = &mut harvest.clamping {
            clamping.begin(std::iter::repeat_n(weight, count));
        }
        if let Some(record) = &mut harvest.record {
            record.begin(std::iter::repeat_n(weight, count));
            record.log.iter_mut().for_each(|log| log.clear());
        }
    }

    fn log(&self) -> Option<&PathLog> {
        self.engine.harvest.record.as_ref()?.log.as_deref()
    }

    /// How long the ways are by which lights were asked by way of balls, and by which balls.
    fn ways_by_balls(&self, queue: &Queue, segment: &mut Segment) {
        let world = self.engine.job.world;
        for bent in &self.engine.harvest.bent {
            let slot = bent.slot as usize;
            let (Some(way), Some(path), Some(first)) =
                (segment.bent.get_mut(slot), queue.paths.get(slot), bent.legs.first())
            else {
                continue;
            };
            let mut ray = Ray { t_max: f32::INFINITY, ..*first };
            let hit = world.closest(&mut ray);
            // What stands before the ball hides this way, and says nothing of the others.
            let is_free = hit.is_some() && ray.t_max >= first.t_max;
            let ball = is_free.then(|| (world.vertex(&ray, &hit), bent.legs.len() == 2));
            let known = way.and_then(|bend| bend.ball);
            *way = Some(Bend { stretches: path.depth + 1 + bent.legs.len() as u32, ball: known.or(ball) });
        }
    }

    /// Keeps the places of a segment.
    fn keep(&mut self, flight: &Flight, segment: &mut Segment) {
        for (slot, seen) in self.log().map_or(&[][..], |log| &log.seen) {
            if let Some(place) = segment.seen.get_mut(*slot) {
                *place = Some(*seen);
            }
        }
        let rays = flight.queue.rays.iter().zip(&flight.queue.paths).zip(&flight.from);
        for (((ray, path), from), (met, seen)) in rays.zip(segment.met.iter().zip(&segment.seen)) {
            let place = self.sample.vertices.len();
            let is_kept = place < MOST_VERTICES && (path.depth == 0 || from.is_some());
            segment.places.push(is_kept.then_some(place as u32));
            if is_kept {
                let lit = Arrival { ray, path, vertex: met.as_ref(), seen: seen.as_ref() }.lit();
                self.sample.vertices.push(PathVertex {
                    parent: from.map(|(parent, _)| parent),
                    came: from.map(|(_, event)| event),
                    depth: path.depth,
                    ray: *ray,
                    weight: path.weight,
                    met: *met,
                    scattered_at: None,
                    lit,
                    is_seen: seen.is_some(),
                    lights: Vec::new(),
                });
            }
        }
    }

    /// Adds up the light of a segment, in order. The first `met` contributions are what paths met; ways by balls come last.
    fn gains(&mut self, queue: &Queue, segment: &Segment, met: usize) {
        let lights = self.log().map(|log| log.lights.clone()).unwrap_or_default();
        for (number, (slot, way, group, radiance)) in lights.into_iter().enumerate() {
            self.sample.radiance += radiance;
            let depth = queue.paths.get(slot).map_or(0, |path| path.depth);
            let bent = segment.bent.get(slot).copied().flatten().filter(|_| number >= met + segment.straight);
            let stretches = match bent {
                Some(Bend { stretches, .. }) => stretches,
                None => depth + 1 + u32::from(number >= met),
            };
            let by = bent.and_then(|bend| bend.ball);
            let gain = LightGain { group, way, stretches, radiance, asked: number >= met, by };
            let place = segment.places.get(slot).copied().flatten();
            match place.and_then(|place| self.sample.vertices.get_mut(place as usize)) {
                Some(_) if radiance.is_black() => {}
                Some(vertex) => vertex.lights.push(gain),
                None => self.sample.untold += radiance,
            }
        }
        let taken = self.engine.harvest.clamping.as_ref().map_or(&[][..], |clamping| &clamping.taken);
        self.sample.clamped = taken.iter().fold(self.sample.clamped, |sum, taken| sum + taken);
    }

    /// Stacks the rays that go on, the first of them on top.
    fn go_on(&mut self, queue: &Queue, segment: &Segment, stack: &mut Vec<Flight>) {
        let next = std::mem::take(&mut self.engine.harvest.next);
        let mut from = Vec::with_capacity(next.len());
        for (ray, path) in next.rays.iter().zip(&next.paths) {
            from.push(self.event(queue, segment, ray, path));
        }
        let pieces = next.rays.chunks(GROUP).zip(next.paths.chunks(GROUP)).zip(from.chunks(GROUP));
        for ((rays, paths), from) in pieces.rev() {
            let queue = Queue { rays: rays.to_vec(), paths: paths.to_vec() };
            stack.push(Flight { queue, from: from.to_vec() });
        }
    }

    /// Where a ray that goes on comes from, and what happened there.
    fn event(&mut self, queue: &Queue, segment: &Segment, ray: &Ray, path: &PathState) -> Option<(u32, Event)> {
        let slot = path.slot as usize;
        let place = segment.places.get(slot).copied().flatten()?;
        let vertex = segment.met.get(slot)?.as_ref();
        let seen = segment.seen.get(slot)?.as_ref();
        let arrival = Arrival { ray: queue.rays.get(slot)?, path: queue.paths.get(slot)?, vertex, seen };
        let event = arrival.event(self.engine.job.world, ray, path);
        if event == Event::VOLUME {
            self.sample.vertices.get_mut(place as usize)?.scattered_at = Some(ray.origin);
        }
        Some((place, event))
    }
}
