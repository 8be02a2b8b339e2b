//! Rays in queues: camera rays of some pixels → nearest hits → what the integrator makes of them → shadow
//! rays → the rays that go on, until none is left.
//!
//! Why the bits cannot depend on tiles: queues are in order of their slots (a slot is one sample of one
//! pixel), and are only ever cut between slots; a slot whose own rays outgrow [`GROUP`] is cut in pieces of
//! that size wherever it stands. So the order in which a sample's contributions are added follows from its
//! own tree of rays alone. The same cuts bound the memory.

use super::expose::{Start, expose, start};
use super::exposed::Exposed;
use super::{Control, Job, Rays, Stopped, Work};
use juggler_camera::film::{Clamped, Rect, Samples, Tile, is_counted};
use juggler_integrator::{Bent, Clamping, Emit, Harvest, PathState, Queue, Record, ShadowQueue, Way};
use juggler_math::{Ray, Rgb};
use juggler_world::{Shadows, Vertex, WorldHit};
use std::ops::Range;

mod inspect;

pub use inspect::{Inspected, LightGain, PathVertex, inspect};

/// Samples in flight at once.
const PASS: u64 = 1024;
const _: () = assert!(PASS <= 1 << u16::BITS, "shadow rays keep their sample's number in 16 bits");
/// Rays of a segment, unless one slot alone has more.
const SEGMENT: usize = 2048;
/// Rays of one slot that are followed side by side.
const GROUP: usize = 256;
/// Waiting rays at which a segment is left for later, at the next slot.
const WAITING: usize = 16_384;

/// The buffers of one thread.
pub struct Engine<'j> {
    job: &'j Job<'j>,
    /// How paths begin.
    start: Start,
    /// Whether vertices are told how wide rays are.
    measures: bool,
    hits: Vec<WorldHit>,
    through: Vec<Rgb>,
    harvest: Harvest,
    stack: Vec<Queue>,
    spare: Vec<Queue>,
    rays: Rays,
}

impl<'j> Engine<'j> {
    pub fn new(job: &'j Job<'j>) -> Self {
        Self {
            job,
            start: start(job),
            measures: job.world.has_pictures() || job.integrator.fades_patterns(),
            hits: Vec::new(),
            through: Vec::new(),
            harvest: Harvest {
                clamping: job.integrator.clamp().map(Clamping::new),
                record: (!job.layers.is_empty()).then(|| Record::new(job.layers, job.frames)),
                ..Harvest::default()
            },
            stack: Vec::new(),
            spare: Vec::new(),
            rays: Rays::default(),
        }
    }

    /// Renders one piece of work.
    pub fn render(&mut self, work: &Work, control: &Control) -> Result<Tile, Stopped> {
        let mut film = Exposed::new(work, self.job.layers);
        self.passes(work, control, |samples| film.add(samples))?;
        Ok(film.tile())
    }

    /// The pixels of a picture of one sample each, row by row, and what clamping took off them. They need no sums, only
    /// what a tile's means would be.
    pub fn render_single(&mut self, pixels: Rect, control: &Control) -> Result<(Vec<Rgb>, Clamped), Stopped> {
        let mut means = Vec::with_capacity(pixels.area() as usize);
        let mut taken = Clamped::default();
        self.passes(&Work::first(pixels, 1), control, |Samples { radiance, clamped, .. }| {
            let lost = radiance.iter().filter(|sample| !is_counted(**sample)).count() as u64;
            means.extend(radiance.iter().map(|sample| if is_counted(*sample) { *sample } else { Rgb::BLACK }));
            let finite = radiance.iter().zip(clamped).filter(|(sample, _)| is_counted(**sample));
            finite.for_each(|(_, clamped)| taken.add(f64::from(*clamped)));
            lost
        })?;
        Ok((means, taken))
    }

    /// Traces all samples and hands them to `take` in order; `take` says how many were no finite numbers.
    fn passes(&mut self, work: &Work, control: &Control, mut take: impl FnMut(Samples) -> u64) -> Result<(), Stopped> {
        let samples = work.samples.len() as u64;
        let end = work.pixels.area() * samples;
        let mut first = 0;
        while first < end {
            let slots = first..end.min(first + PASS);
            let count = slots.end - slots.start;
            self.pass(work, samples, slots, control)?;
            self.rays.not_finite += take(self.harvest.samples());
            self.rays.camera += count;
            control.add(count, &std::mem::take(&mut self.rays));
            first += count;
        }
        Ok(())
    }

    /// Traces the samples `slots` to their ends. One vertex may cost seconds, so every vertex and every queue of shadow rays
    /// looks whether the render was cancelled.
    fn pass(&mut self, work: &Work, samples: u64, slots: Range<u64>, control: &Control) -> Result<(), Stopped> {
        self.harvest.reset((slots.end - slots.start) as usize, self.job.world.lamps().len());
        let mut camera = self.spare.pop().unwrap_or_default();
        expose(self.job, &self.start, work, samples, slots, &mut camera);
        let weights = || camera.paths.iter().map(|path| path.weight.r);
        if let Some(clamping) = &mut self.harvest.clamping {
            clamping.begin(weights());
        }
        if let Some(record) = &mut self.harvest.record {
            record.begin(weights());
        }
        self.stack.push(camera);
        while let Some(queue) = self.stack.pop() {
            if control.is_cancelled() {
                return Err(self.stopped());
            }
            self.segment(queue, control);
        }
        if control.is_cancelled() { Err(self.stopped()) } else { Ok(()) }
    }

    /// Drops all rays in flight, for the next work to begin anew.
    fn stopped(&mut self) -> Stopped {
        let Harvest { shadows, bent, pending, next, .. } = &mut self.harvest;
        self.stack.clear();
        next.clear();
        bent.clear();
        *pending = 0;
        shadows.iter_mut().for_each(ShadowQueue::clear);
        Stopped
    }

    /// Takes a queue one step further and stacks what comes of it, so that the first of it is next.
    fn segment(&mut self, mut queue: Queue, control: &Control) {
        self.nearest(&mut queue);
        let done = self.shade(&queue, control);
        self.shadows(control);
        self.stack_rest(&queue, done);
        self.stack_next();
        queue.clear();
        self.spare.push(queue);
    }

    fn nearest(&mut self, queue: &mut Queue) {
        self.hits.resize(queue.len(), WorldHit::NONE);
        let from_camera = queue.paths.first().is_some_and(|path| path.depth == 0);
        if from_camera {
            self.job.world.closest_packet(&mut queue.rays, &mut self.hits);
        } else {
            self.rays.secondary += queue.len() as u64;
            self.job.world.closest_batch(&mut queue.rays, &mut self.hits);
        }
    }

    /// Hands each vertex to the integrator; stops between slots when too many rays wait. Returns how many
    /// rays were done, fewer than there are when the render was cancelled.
    fn shade(&mut self, queue: &Queue, control: &Control) -> usize {
        for (i, ((ray, path), hit)) in queue.rays.iter().zip(&queue.paths).zip(&self.hits).enumerate() {
            if control.is_cancelled() {
                return i;
            }
            meet(self.job, self.measures, &mut self.harvest, ray, path, hit);
            let last_of_slot = queue.paths.get(i + 1).is_none_or(|next| next.slot != path.slot);
            if last_of_slot && self.harvest.next.len() + self.harvest.pending > WAITING {
                return i + 1;
            }
        }
        queue.len()
    }

    /// Answers the shadow rays, light by light, and adds what comes through.
    fn shadows(&mut self, control: &Control) {
        let Harvest { radiance, clamping, record, shadows, pending, .. } = &mut self.harvest;
        *pending = 0;
        let last = shadows.len().saturating_sub(1);
        let kept = self.job.integrator.shadows();
        for (number, queue) in shadows.iter_mut().enumerate().take_while(|_| !control.is_cancelled()) {
            self.rays.shadow += queue.rays.len() as u64;
            self.through.resize(queue.rays.len(), Rgb::BLACK);
            let (rays, through) = (&queue.rays, &mut self.through);
            match kept {
                Shadows::Physical if self.job.world.dims_shadows() => {
                    let inside = queue.gains.iter().map(|gain| gain.inside);
                    self.job.world.transmittance_inside(rays, inside, through);
                }
                _ if number < last => self.job.world.transmittance_packet(rays, kept, through),
                _ => self.job.world.transmittance_batch(rays, kept, through),
            }
            for (gain, through) in queue.gains.iter().zip(through) {
                let (slot, mut more) = (usize::from(gain.slot), gain.radiance * *through);
                if let Some(clamping) = clamping {
                    more = clamping.limit(slot, gain.way, more);
                }
                if let Some(record) = record {
                    record.light(slot, gain.way, gain.group, more);
                }
                radiance[slot] += more;
            }
            queue.clear();
        }
        self.bent();
    }

    /// Answers the ways around corners: one leg of each after the other, as long as they are free.
    fn bent(&mut self) {
        let mut open: Vec<Bent> = std::mem::take(&mut self.harvest.bent);
        for leg in 0.. {
            let rays: Vec<Ray> = open.iter().filter_map(|bent| bent.legs.get(leg).copied()).collect();
            if rays.is_empty() {
                break;
            }
            self.rays.shadow += rays.len() as u64;
            self.through.resize(rays.len(), Rgb::BLACK);
            self.job.world.transmittance_batch(&rays, Shadows::Physical, &mut self.through);
            let mut through = self.through.iter();
            open.retain(|bent| bent.legs.len() <= leg || through.next().is_some_and(|through| !through.is_black()));
        }
        for bent in open.drain(..) {
            self.harvest.add(bent.slot as usize, Way::Indirect, bent.group, bent.radiance);
        }
        self.harvest.bent = open;
    }

    /// The rays of a segment that was left early.
    fn stack_rest(&mut self, queue: &Queue, done: usize) {
        if done < queue.len() {
            let mut rest = self.spare.pop().unwrap_or_default();
            for i in done..queue.len() {
                // The hits are found again: a ray keeps no memory of having been traced.
                let ray = Ray { t_max: f32::INFINITY, ..queue.rays[i] };
                rest.push(ray, queue.paths[i]);
            }
            self.stack.push(rest);
        }
    }

    /// The rays that go on, cut into segments, the first on top.
    fn stack_next(&mut self) {
        if self.harvest.next.is_empty() {
            return;
        }
        let mut next = std::mem::replace(&mut self.harvest.next, self.spare.pop().unwrap_or_default());
        let segments = cut(&next);
        if segments.len() == 1 {
            self.stack.push(next);
            return;
        }
        for range in segments.into_iter().rev() {
            let mut queue = self.spare.pop().unwrap_or_default();
            queue.rays.extend_from_slice(&next.rays[range.clone()]);
            queue.paths.extend_from_slice(&next.paths[range]);
            self.stack.push(queue);
        }
        next.clear();
        self.spare.push(next);
    }
}

/// Hands one ray to the integrator; returns what it met.
#[inline(always)]
fn meet(
    job: &Job,
    measures: bool,
    harvest: &mut Harvest,
    ray: &Ray,
    path: &PathState,
    hit: &WorldHit,
) -> Option<Vertex> {
    let Job { world, integrator, .. } = job;
    let mut emit = Emit::new(harvest, path, ray.t_max);
    if !hit.is_some() {
        integrator.escape(world, ray, path, &mut emit);
        return None;
    }
    let mut vertex = world.vertex(ray, hit);
    if measures {
        world.measure(ray, hit, emit.width(), &mut vertex);
    }
    integrator.vertex(world, ray, path, &vertex, &mut emit);
    Some(vertex)
}

/// Cuts a queue between slots into segments of at most [`SEGMENT`] rays; a slot of more than [`GROUP`] rays
/// becomes segments of its own.
fn cut(queue: &Queue) -> Vec<Range<usize>> {
    let mut ranges = Vec::new();
    let (mut start, mut at) = (0, 0);
    for group in queue.paths.chunk_by(|a, b| a.slot == b.slot) {
        let end = at + group.len();
        if group.len() > GROUP {
            ranges.push(start..at);
            ranges.extend((at..end).step_by(GROUP).map(|piece| piece..end.min(piece + GROUP)));
            start = end;
        } else if end - start > SEGMENT {
            ranges.push(start..at);
            start = at;
        }
        at = end;
    }
    ranges.push(start..at);
    ranges.retain(|range| !range.is_empty());
    ranges
}
