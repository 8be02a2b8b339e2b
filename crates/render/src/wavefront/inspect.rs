//! Inspection of a pixel: traces its samples as a render does, and records the vertices and
//! contributions of their paths.
//!
//! Each sample is traced alone. A render cuts queues between samples and a sample's own rays at
//! [`GROUP_RAYS`], so contributions are added in the same order and the radiance is bit-identical.
//! Within a segment each ray has a slot of its own, by which the log identifies the ray of a
//! contribution.

use super::{Engine, GROUP_RAYS, hits_shadow_catcher, shade_ray};
use crate::camera_rays::push_camera_rays;
use crate::tile_samples::TileSamples;
use crate::{Cancelled, Control, Job, RayCounts, Work};
use juggler_camera::aov::LightGroup;
use juggler_camera::film::{PixelSamples, PixelStatistics, Rect, Tile};
use juggler_integrator::{AovRecord, HitRecord, PathKind, PathLog, PathState, Queue, ScatterEvent, ShadingPoint};
use juggler_math::{Ray, Rgb, Vec3};
use juggler_world::Vertex;

/// Maximum number of vertices recorded per sample. The radiance includes the others.
const MAX_VERTICES: usize = 1 << 20;

/// Contribution of a light to a sample at one vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightContribution {
    /// Light group.
    pub group: LightGroup,
    /// Kind of path, by its number of segments.
    pub path_kind: PathKind,
    /// Number of path segments from the camera to the light.
    pub segments: u32,
    /// Radiance times throughput and filter weight, after clamping.
    pub radiance: Rgb,
    /// Whether the contribution is a light sample; otherwise the path hit the emitter.
    pub is_light_sample: bool,
    /// Specular sphere of a light sample through a sphere, and whether the sphere reflects
    /// (otherwise it refracts).
    pub sphere: Option<(Vertex, bool)>,
}

/// A vertex of a path.
#[derive(Clone, Debug, PartialEq)]
pub struct PathVertex {
    /// Index of the previous vertex; `None` for the first.
    pub parent: Option<u32>,
    /// Scattering event at the previous vertex.
    pub event: Option<ScatterEvent>,
    /// Number of scattering vertices before this one.
    pub depth: u32,
    /// Ray that arrived; it ends at the hit.
    pub ray: Ray,
    /// Throughput (beta) times the filter weight.
    pub weight: Rgb,
    /// Surface that the ray hit; `None` if it left the world.
    pub hit: Option<Vertex>,
    /// Point in world space at which a medium scattered the path before it reached the surface.
    pub scattered_at: Option<Vec3>,
    /// Scattering event of light samples at this vertex.
    pub light_sample_event: ScatterEvent,
    /// Whether the surface was shaded; `false` if its opacity let the path pass, if a medium
    /// scattered the path before it, or if there is no surface.
    pub is_shaded: bool,
    /// Contributions at this vertex.
    pub contributions: Vec<LightContribution>,
}

/// A sample, with the vertices of its paths.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct InspectedSample {
    /// Index of the sample in its pixel.
    pub index: u32,
    /// Weight of the sample by the reconstruction filter.
    pub weight: f32,
    /// Contribution to the pixel, as the film receives it.
    pub radiance: Rgb,
    /// Radiance that clamping removed, averaged over the channels.
    pub clamped: f32,
    /// Vertices of all paths; each follows its parent.
    pub vertices: Vec<PathVertex>,
    /// Contributions of vertices beyond the maximum number recorded.
    pub unrecorded: Rgb,
}

/// Traces all samples of a pixel and passes each to `each`. Returns the color of the pixel as in
/// the finished picture, and its statistics.
///
/// # Errors
///
/// [`Cancelled`] if `control` is cancelled.
pub fn inspect(
    job: &Job,
    pixel: [u32; 2],
    control: &Control,
    mut each: impl FnMut(InspectedSample),
) -> Result<(Rgb, PixelStatistics), Cancelled> {
    let pixels = Rect { x: pixel[0], y: pixel[1], width: 1, height: 1 };
    let work = Work::first(pixels, job.samples);
    let mut film = TileSamples::new(&work, &juggler_camera::aov::NO_AOVS);
    let mut inspector = Inspector { engine: Engine::new(job), control, sample: InspectedSample::default() };
    inspector.engine.buffers.record = Some(AovRecord::logging());
    inspector.engine.split(control)?;
    for index in 0..job.samples {
        let sample = inspector.sample(&Work { samples: index..index + 1, ..work.clone() });
        if control.is_cancelled() {
            return Err(Cancelled);
        }
        let InspectedSample { radiance, clamped, .. } = sample;
        film.add(PixelSamples { radiance: &[radiance], clamped: &[clamped], ..PixelSamples::default() });
        control.add(1, &RayCounts::default());
        each(sample);
    }
    let tile: Tile = film.tile();
    Ok((tile.means().first().copied().unwrap_or(Rgb::BLACK), tile.statistics(0)))
}

/// Traces and records one sample at a time.
struct Inspector<'j> {
    engine: Engine<'j>,
    control: &'j Control,
    /// Current sample; incomplete if `control` is cancelled.
    sample: InspectedSample,
}

/// Rays in flight; `from` holds the vertex that each ray left and the scattering event there.
struct RecordedQueue {
    queue: Queue,
    from: Vec<Option<(u32, ScatterEvent)>>,
}

/// Hits of one segment's rays.
#[derive(Default)]
struct SegmentHits {
    /// Index of each ray's vertex, if recorded.
    vertex_indices: Vec<Option<u32>>,
    vertices: Vec<Option<Vertex>>,
    shading_points: Vec<Option<ShadingPoint>>,
    /// Number of light samples that do not pass a specular sphere.
    direct_count: usize,
    /// Light samples through specular spheres, by ray.
    bent: Vec<Option<BentPath>>,
}

/// Light sample through a specular sphere: number of path segments, and the sphere if it is
/// visible.
#[derive(Clone, Copy)]
struct BentPath {
    segments: u32,
    sphere: Option<(Vertex, bool)>,
}

impl Inspector<'_> {
    fn sample(&mut self, work: &Work) -> InspectedSample {
        let mut camera = Queue::default();
        push_camera_rays(self.engine.job, &self.engine.start, work, 1, 0..1, &mut camera);
        let weight = camera.paths.first().map_or(1.0, |path| path.beta.r);
        self.sample = InspectedSample { index: work.samples.start, weight, ..InspectedSample::default() };
        let mut stack = vec![RecordedQueue { from: vec![None; camera.len()], queue: camera }];
        while let Some(recorded) = stack.pop()
            && !self.control.is_cancelled()
        {
            self.segment(recorded, &mut stack);
        }
        std::mem::take(&mut self.sample)
    }

    fn segment(&mut self, mut recorded: RecordedQueue, stack: &mut Vec<RecordedQueue>) {
        let count = recorded.queue.len();
        (0..).zip(&mut recorded.queue.paths).for_each(|(slot, path)| path.slot = slot);
        self.begin(count);
        self.engine.nearest(&mut recorded.queue);
        let mut segment =
            SegmentHits { bent: vec![None; count], shading_points: vec![None; count], ..SegmentHits::default() };
        let Engine { world, shading, caught, hits, buffers, .. } = &mut self.engine;
        for ((ray, path), hit) in recorded.queue.rays.iter().zip(&recorded.queue.paths).zip(hits.iter()) {
            // Shadow catchers have no radiance in the picture.
            let is_caught = caught.is_some() && hits_shadow_catcher(world, path, hit);
            let vertex = if is_caught { None } else { shade_ray(world, *shading, buffers, ray, path, hit) };
            segment.vertices.push(vertex);
        }
        let emission_count = self.log().map_or(0, |log| log.lights.len());
        segment.direct_count = self.engine.buffers.shadows.iter().map(|queue| queue.contributions.len()).sum();
        self.find_bent_paths(&recorded.queue, &mut segment);
        self.engine.shadows(self.control);
        self.record_vertices(&recorded, &mut segment);
        self.record_contributions(&recorded.queue, &segment, emission_count);
        self.stack_next(&recorded.queue, &segment, stack);
    }

    fn begin(&mut self, count: usize) {
        let weight = self.sample.weight;
        let buffers = &mut self.engine.buffers;
        buffers.reset(count, self.engine.job.world.lights().len());
        if let Some(clamping) = &mut buffers.clamping {
            clamping.begin(std::iter::repeat_n(weight, count));
        }
        if let Some(record) = &mut buffers.record {
            record.begin(std::iter::repeat_n(weight, count));
            record.log.iter_mut().for_each(|log| log.clear());
        }
    }

    fn log(&self) -> Option<&PathLog> {
        self.engine.buffers.record.as_ref()?.log.as_deref()
    }

    /// Determines the lengths and the spheres of light samples through specular spheres.
    fn find_bent_paths(&self, queue: &Queue, segment: &mut SegmentHits) {
        let world = self.engine.job.world;
        for bent in &self.engine.buffers.bent {
            let slot = bent.slot as usize;
            let (Some(entry), Some(path), Some(first)) =
                (segment.bent.get_mut(slot), queue.paths.get(slot), bent.segments.first())
            else {
                continue;
            };
            let mut ray = Ray { t_max: f32::INFINITY, ..*first };
            let hit = world.closest(&mut ray);
            // An object in front of the sphere blocks this path only.
            let is_free = hit.is_some() && ray.t_max >= first.t_max;
            let sphere = is_free.then(|| (world.vertex(&ray, &hit), bent.segments.len() == 2));
            let known = entry.and_then(|bent_path| bent_path.sphere);
            *entry = Some(BentPath { segments: path.depth + 1 + bent.segments.len() as u32, sphere: known.or(sphere) });
        }
    }

    /// Records the vertices of a segment.
    fn record_vertices(&mut self, recorded: &RecordedQueue, segment: &mut SegmentHits) {
        for (slot, shading_point) in self.log().map_or(&[][..], |log| &log.hits) {
            if let Some(place) = segment.shading_points.get_mut(*slot) {
                *place = Some(*shading_point);
            }
        }
        // Of several surfaces at one place, keep the one that the path interacted with.
        for (vertex, shading_point) in segment.vertices.iter_mut().zip(&segment.shading_points) {
            *vertex = shading_point.map(|point| point.vertex).or(*vertex);
        }
        let rays = recorded.queue.rays.iter().zip(&recorded.queue.paths).zip(&recorded.from);
        for (((ray, path), from), (vertex, shading_point)) in
            rays.zip(segment.vertices.iter().zip(&segment.shading_points))
        {
            let place = self.sample.vertices.len();
            let is_kept = place < MAX_VERTICES && (path.depth == 0 || from.is_some());
            segment.vertex_indices.push(is_kept.then_some(place as u32));
            if is_kept {
                let light_sample_event =
                    HitRecord { ray, path, vertex: vertex.as_ref(), shading_point: shading_point.as_ref() }
                        .light_sample_event();
                self.sample.vertices.push(PathVertex {
                    parent: from.map(|(parent, _)| parent),
                    event: from.map(|(_, event)| event),
                    depth: path.depth,
                    ray: *ray,
                    weight: path.beta,
                    hit: *vertex,
                    scattered_at: None,
                    light_sample_event,
                    is_shaded: shading_point.is_some(),
                    contributions: Vec::new(),
                });
            }
        }
    }

    /// Adds up the contributions of a segment, in order: the first `emission_count` are emission
    /// that paths hit; light samples through specular spheres come last.
    fn record_contributions(&mut self, queue: &Queue, segment: &SegmentHits, emission_count: usize) {
        let lights = self.log().map(|log| log.lights.clone()).unwrap_or_default();
        for (number, (slot, path_kind, group, radiance)) in lights.into_iter().enumerate() {
            self.sample.radiance += radiance;
            let depth = queue.paths.get(slot).map_or(0, |path| path.depth);
            let bent =
                segment.bent.get(slot).copied().flatten().filter(|_| number >= emission_count + segment.direct_count);
            let segments = match bent {
                Some(BentPath { segments, .. }) => segments,
                None => depth + 1 + u32::from(number >= emission_count),
            };
            let sphere = bent.and_then(|bent_path| bent_path.sphere);
            let contribution = LightContribution {
                group,
                path_kind,
                segments,
                radiance,
                is_light_sample: number >= emission_count,
                sphere,
            };
            let place = segment.vertex_indices.get(slot).copied().flatten();
            match place.and_then(|place| self.sample.vertices.get_mut(place as usize)) {
                Some(_) if radiance.is_black() => {}
                Some(vertex) => vertex.contributions.push(contribution),
                None => self.sample.unrecorded += radiance,
            }
        }
        let removed = self.engine.buffers.clamping.as_ref().map_or(&[][..], |clamping| &clamping.removed);
        self.sample.clamped = removed.iter().fold(self.sample.clamped, |sum, removed| sum + removed);
    }

    /// Stacks the rays that continue, the first on top.
    fn stack_next(&mut self, queue: &Queue, segment: &SegmentHits, stack: &mut Vec<RecordedQueue>) {
        let next = std::mem::take(&mut self.engine.buffers.next);
        let mut from = Vec::with_capacity(next.len());
        for (ray, path) in next.rays.iter().zip(&next.paths) {
            from.push(self.event(queue, segment, ray, path));
        }
        let pieces = next.rays.chunks(GROUP_RAYS).zip(next.paths.chunks(GROUP_RAYS)).zip(from.chunks(GROUP_RAYS));
        for ((rays, paths), from) in pieces.rev() {
            let queue = Queue { rays: rays.to_vec(), paths: paths.to_vec(), from_camera: false };
            stack.push(RecordedQueue { queue, from: from.to_vec() });
        }
    }

    /// Vertex that a continuing ray left, and the scattering event there.
    fn event(
        &mut self,
        queue: &Queue,
        segment: &SegmentHits,
        ray: &Ray,
        path: &PathState,
    ) -> Option<(u32, ScatterEvent)> {
        let slot = path.slot as usize;
        let place = segment.vertex_indices.get(slot).copied().flatten()?;
        let vertex = segment.vertices.get(slot)?.as_ref();
        let shading_point = segment.shading_points.get(slot)?.as_ref();
        let arrival = HitRecord { ray: queue.rays.get(slot)?, path: queue.paths.get(slot)?, vertex, shading_point };
        let event = arrival.event(self.engine.job.world, ray, path);
        if event == ScatterEvent::VOLUME {
            self.sample.vertices.get_mut(place as usize)?.scattered_at = Some(ray.origin);
        }
        Some((place, event))
    }
}
