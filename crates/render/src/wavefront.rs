//! Wavefront path tracing: queues of rays pass through intersection, shading and shadow rays, and
//! the rays that continue form the next queues, until none is left (Laine, Karras, Aila:
//! Megakernels Considered Harmful, 2013).
//!
//! The result does not depend on tiles. Queues are in order of their slots (a slot is one sample of
//! one pixel) and are cut only between slots; a slot with more than [`GROUP_RAYS`] rays is cut into
//! pieces of that size, independently of its position in the queue. The order in which a sample's
//! contributions are added thus depends only on its own tree of rays. The same cuts bound the
//! memory.

use super::camera_rays::{PathStart, path_start, push_camera_rays};
use super::tile_samples::TileSamples;
use super::{Cancelled, Control, Job, RayCounts, Work};
use juggler_camera::film::{ClampedRadiance, PixelSamples, Rect, Tile, is_counted};
use juggler_integrator::{
    AovRecord, BentShadowRay, CameraRayWeight, ClampState, Integrator, PathBuffers, PathKind, PathState, Queue,
    ShadowQueue, VertexOutput,
};
use juggler_math::{Ray, Rgb};
use juggler_world::{ShadowMode, Vertex, World, WorldHit};
use std::ops::Range;

mod inspect;
pub mod pilot;
mod shadow_catchers;

use shadow_catchers::{catch, hits_shadow_catcher};

pub use inspect::{InspectedSample, LightContribution, PathVertex, inspect};

/// Number of samples in flight.
const PASS_SAMPLES: u64 = 1024;
const _: () = assert!(PASS_SAMPLES <= 1 << u16::BITS, "shadow rays keep their sample's number in 16 bits");
/// Maximum number of rays in a segment, unless a single slot has more.
const SEGMENT_RAYS: usize = 2048;
/// Maximum number of rays of one slot that are traced together.
const GROUP_RAYS: usize = 256;
/// Number of queued rays at which shading of a segment is suspended at the next slot.
const MAX_QUEUED_RAYS: usize = 16_384;

/// Renderer of one thread, with its buffers.
pub struct Engine<'j> {
    job: &'j Job<'j>,
    /// Initial state of camera paths.
    start: PathStart,
    shading: VertexShading<'j>,
    hits: Vec<WorldHit>,
    transmittance: Vec<Rgb>,
    buffers: PathBuffers,
    stack: Vec<Queue>,
    spare: Vec<Queue>,
    rays: RayCounts,
    /// World that rays are traced in: that of the job, except for paths from shadow catchers.
    world: &'j World,
    /// Rays that reached shadow catchers; `None` while these are surfaces as others.
    caught: Option<Queue>,
}

/// Shading of vertices by an integrator.
#[derive(Clone, Copy)]
struct VertexShading<'j> {
    integrator: &'j dyn Integrator,
    /// Whether vertices receive ray differentials, for texture filtering.
    has_ray_differentials: bool,
}

impl<'j> VertexShading<'j> {
    fn new(job: &Job<'j>) -> Self {
        let has_ray_differentials = job.world.has_image_textures() || job.integrator.filters_textures();
        Self { integrator: job.integrator, has_ray_differentials }
    }
}

impl<'j> Engine<'j> {
    pub fn new(job: &'j Job<'j>) -> Self {
        Self {
            job,
            start: path_start(job),
            shading: VertexShading::new(job),
            hits: Vec::new(),
            transmittance: Vec::new(),
            buffers: PathBuffers {
                clamping: job.integrator.clamp().map(ClampState::new),
                record: (!job.aovs.is_empty()).then(|| AovRecord::new(job.aovs, Some(job.camera), job.frames)),
                ..PathBuffers::default()
            },
            stack: Vec::new(),
            spare: Vec::new(),
            rays: RayCounts::default(),
            world: job.world,
            caught: job.world.unoccluded().map(|_| Queue::default()),
        }
    }

    /// Renders a piece of work.
    pub fn render(&mut self, work: &Work, control: &Control) -> Result<Tile, Cancelled> {
        self.split(control)?;
        let mut film = TileSamples::new(work, self.job.aovs);
        self.passes(work, control, |samples| film.add(samples))?;
        Ok(film.tile())
    }

    /// Sets the number of camera rays of each sample.
    fn split(&mut self, control: &Control) -> Result<(), Cancelled> {
        self.start.camera_rays = self.job.camera_rays.count(self.job, control)?;
        self.buffers.camera_ray_weight = CameraRayWeight::of(self.start.camera_rays);
        Ok(())
    }

    /// Renders pixels with a single sample each: the means, row by row, and the radiance that
    /// clamping removed. Equals the means of a tile, without its sums.
    pub fn render_single(&mut self, pixels: Rect, control: &Control) -> Result<(Vec<Rgb>, ClampedRadiance), Cancelled> {
        let mut means = Vec::with_capacity(pixels.area() as usize);
        let mut removed = ClampedRadiance::default();
        self.passes(&Work::first(pixels, 1), control, |PixelSamples { radiance, clamped, .. }| {
            let lost = radiance.iter().filter(|sample| !is_counted(**sample)).count() as u64;
            means.extend(radiance.iter().map(|sample| if is_counted(*sample) { *sample } else { Rgb::BLACK }));
            let finite = radiance.iter().zip(clamped).filter(|(sample, _)| is_counted(**sample));
            finite.for_each(|(_, clamped)| removed.add(f64::from(*clamped)));
            lost
        })?;
        Ok((means, removed))
    }

    /// Traces all samples and passes them to `consume` in order; `consume` returns how many were
    /// not finite.
    fn passes(
        &mut self,
        work: &Work,
        control: &Control,
        mut consume: impl FnMut(PixelSamples) -> u64,
    ) -> Result<(), Cancelled> {
        let samples = work.samples.len() as u64;
        let end = work.pixels.area() * samples;
        let mut first = 0;
        while first < end {
            let slots = first..end.min(first + PASS_SAMPLES);
            let count = slots.end - slots.start;
            self.pass(work, samples, slots, control)?;
            self.rays.not_finite += consume(self.buffers.samples());
            self.rays.camera += count * u64::from(self.start.camera_rays);
            control.add(count, &std::mem::take(&mut self.rays));
            first += count;
        }
        Ok(())
    }

    /// Traces the samples `slots`. Cancellation is tested at every vertex and every shadow queue,
    /// since a single vertex may take seconds.
    fn pass(&mut self, work: &Work, samples: u64, slots: Range<u64>, control: &Control) -> Result<(), Cancelled> {
        self.buffers.reset((slots.end - slots.start) as usize, self.job.world.lights().len());
        let mut camera = self.spare.pop().unwrap_or_default();
        push_camera_rays(self.job, &self.start, work, samples, slots, &mut camera);
        let first_rays = || camera.paths.iter().filter(|path| !path.history.is_split);
        let weights = || first_rays().map(|path| path.beta.r);
        if let Some(clamping) = &mut self.buffers.clamping {
            clamping.begin(weights());
        }
        if let Some(record) = &mut self.buffers.record {
            record.begin(weights());
        }
        self.stack.push(camera);
        self.trace(control)?;
        self.trace_shadow_catchers(control)
    }

    /// Traces all rays on the stack, and those that continue.
    fn trace(&mut self, control: &Control) -> Result<(), Cancelled> {
        while let Some(queue) = self.stack.pop() {
            if control.is_cancelled() {
                return Err(self.cancelled());
            }
            self.segment(queue, control);
        }
        if control.is_cancelled() { Err(self.cancelled()) } else { Ok(()) }
    }

    /// Discards all rays in flight.
    fn cancelled(&mut self) -> Cancelled {
        let PathBuffers { shadows, bent, pending, next, .. } = &mut self.buffers;
        self.stack.clear();
        self.caught.iter_mut().for_each(Queue::clear);
        next.clear();
        bent.clear();
        *pending = 0;
        shadows.iter_mut().for_each(ShadowQueue::clear);
        Cancelled
    }

    /// Advances a queue by one segment and stacks the remaining and continuing rays, the first ones
    /// on top.
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
        if queue.from_camera {
            self.world.closest_packet(&mut queue.rays, &mut self.hits);
        } else {
            self.rays.secondary += queue.len() as u64;
            self.world.closest_batch(&mut queue.rays, &mut self.hits);
        }
    }

    /// Shades the vertices of a queue. Stops between slots if too many rays are queued, or on
    /// cancellation. Returns the number of rays processed.
    fn shade(&mut self, queue: &Queue, control: &Control) -> usize {
        let (world, shading) = (self.world, self.shading);
        for (i, ((ray, path), hit)) in queue.rays.iter().zip(&queue.paths).zip(&self.hits).enumerate() {
            if control.is_cancelled() {
                return i;
            }
            match &mut self.caught {
                Some(caught) if hits_shadow_catcher(world, path, hit) => {
                    catch(caught, &mut self.buffers, ray, path);
                }
                // Most additional camera rays see no light.
                _ if path.history.is_split && world.blocks_sight(hit) => {}
                _ => {
                    shade_ray(world, shading, &mut self.buffers, ray, path, hit);
                }
            }
            let last_of_slot = queue.paths.get(i + 1).is_none_or(|next| next.slot != path.slot);
            if last_of_slot && self.buffers.next.len() + self.buffers.pending > MAX_QUEUED_RAYS {
                return i + 1;
            }
        }
        queue.len()
    }

    /// Traces the shadow rays, light by light, and adds the unoccluded contributions.
    fn shadows(&mut self, control: &Control) {
        let PathBuffers { radiance, clamping, record, shadows, pending, .. } = &mut self.buffers;
        *pending = 0;
        let last = shadows.len().saturating_sub(1);
        let mode = self.job.integrator.shadows();
        for (number, queue) in shadows.iter_mut().enumerate().take_while(|_| !control.is_cancelled()) {
            self.rays.shadow += queue.rays.len() as u64;
            self.transmittance.resize(queue.rays.len(), Rgb::BLACK);
            let (rays, transmittance) = (&queue.rays, &mut self.transmittance);
            match mode {
                ShadowMode::Physical if self.world.attenuates_shadows() => {
                    let inside = queue.contributions.iter().map(|contribution| contribution.interiors);
                    self.world.transmittance_inside(rays, inside, transmittance);
                }
                _ if number < last => self.world.transmittance_packet(rays, mode, transmittance),
                _ => self.world.transmittance_batch(rays, mode, transmittance),
            }
            for (contribution, transmittance) in queue.contributions.iter().zip(transmittance) {
                let (slot, mut more) = (usize::from(contribution.slot), contribution.radiance * *transmittance);
                if let Some(clamping) = clamping {
                    more = clamping.limit(slot, contribution.path_kind, more, 1.0);
                }
                if let Some(record) = record {
                    record.add_light(slot, contribution.path_kind, contribution.group, more);
                }
                radiance[slot] += more;
            }
            queue.clear();
        }
        self.trace_bent_shadow_rays();
    }

    /// Traces the shadow rays of specular paths, one segment of each path after the other, and adds
    /// the contributions of unoccluded paths.
    fn trace_bent_shadow_rays(&mut self) {
        let mut open: Vec<BentShadowRay> = std::mem::take(&mut self.buffers.bent);
        for segment in 0.. {
            let rays: Vec<Ray> = open.iter().filter_map(|bent| bent.segments.get(segment).copied()).collect();
            if rays.is_empty() {
                break;
            }
            self.rays.shadow += rays.len() as u64;
            self.transmittance.resize(rays.len(), Rgb::BLACK);
            self.world.transmittance_batch(&rays, ShadowMode::Physical, &mut self.transmittance);
            let mut transmittance = self.transmittance.iter();
            open.retain(|bent| {
                bent.segments.len() <= segment
                    || transmittance.next().is_some_and(|transmittance| !transmittance.is_black())
            });
        }
        for bent in open.drain(..) {
            self.buffers.add(bent.slot as usize, PathKind::Indirect, bent.group, bent.radiance);
        }
        self.buffers.bent = open;
    }

    /// Stacks the rays of a suspended segment.
    fn stack_rest(&mut self, queue: &Queue, done: usize) {
        if done < queue.len() {
            let mut rest = self.spare.pop().unwrap_or_default();
            rest.from_camera = queue.from_camera;
            for i in done..queue.len() {
                // Restore the maximum distance, so that the ray is intersected anew.
                let ray = Ray { t_max: f32::INFINITY, ..queue.rays[i] };
                rest.push(ray, queue.paths[i]);
            }
            self.stack.push(rest);
        }
    }

    /// Stacks the rays that continue, cut into segments, the first segment on top.
    fn stack_next(&mut self) {
        if self.buffers.next.is_empty() {
            return;
        }
        let mut next = std::mem::replace(&mut self.buffers.next, self.spare.pop().unwrap_or_default());
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

/// Passes a ray and its hit to the integrator. Returns the vertex, or `None` if the ray left the
/// world.
#[inline(always)]
fn shade_ray(
    world: &World,
    shading: VertexShading,
    buffers: &mut PathBuffers,
    ray: &Ray,
    path: &PathState,
    hit: &WorldHit,
) -> Option<Vertex> {
    let VertexShading { integrator, has_ray_differentials } = shading;
    let mut output = VertexOutput::new(buffers, path, ray.t_max - ray.t_min);
    if !hit.is_some() {
        integrator.escape(world, ray, path, &mut output);
        return None;
    }
    let mut vertex = world.vertex(ray, hit);
    if has_ray_differentials {
        world.ray_differentials(ray, hit, output.width(), &mut vertex);
    }
    integrator.vertex(world, ray, path, &vertex, &mut output);
    Some(vertex)
}

/// Cuts a queue between slots into segments of at most [`SEGMENT_RAYS`] rays. A slot of more than
/// [`GROUP_RAYS`] rays becomes segments of its own.
fn cut(queue: &Queue) -> Vec<Range<usize>> {
    let mut ranges = Vec::new();
    let (mut start, mut at) = (0, 0);
    for group in queue.paths.chunk_by(|a, b| a.slot == b.slot) {
        let end = at + group.len();
        if group.len() > GROUP_RAYS {
            ranges.push(start..at);
            ranges.extend((at..end).step_by(GROUP_RAYS).map(|piece| piece..end.min(piece + GROUP_RAYS)));
            start = end;
        } else if end - start > SEGMENT_RAYS {
            ranges.push(start..at);
            start = at;
        }
        at = end;
    }
    ranges.push(start..at);
    ranges.retain(|range| !range.is_empty());
    ranges
}
