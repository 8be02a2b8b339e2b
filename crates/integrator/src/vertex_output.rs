//! Output of an integrator at a vertex: radiance, shadow rays and the rays that continue.

use super::{AovRecord, ClampState, PathHistory, PathKind, RayCone};
use arrayvec::ArrayVec;
use juggler_camera::aov::LightGroup;
use juggler_camera::film::PixelSamples;
use juggler_camera::sampler::Sampler;
use juggler_material::medium::Interiors;
use juggler_math::{Ray, Rgb};

/// State of a path along a ray.
#[derive(Clone, Copy, Debug)]
pub struct PathState {
    /// Throughput (beta) times the sample's filter weight.
    pub beta: Rgb,
    /// Number of vertices before the next one.
    pub depth: u32,
    /// Sampler of the next vertex.
    pub sampler: Sampler,
    /// History of the path since its last scattering event.
    pub history: PathHistory,
    /// Ray cone, for texture filtering.
    pub cone: RayCone,
    /// Index of the sample in the current pass.
    pub slot: u32,
}

/// Rays to trace, in order of their samples.
#[derive(Debug, Default)]
pub struct Queue {
    /// Rays in world space.
    pub rays: Vec<Ray>,
    /// State of the path that each ray belongs to.
    pub paths: Vec<PathState>,
    /// Whether the rays are camera rays. Rays that passed straight through a surface are not, even
    /// though their paths have no vertex yet.
    pub from_camera: bool,
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
        self.from_camera = false;
    }
}

/// Shadow rays towards one light, with their contributions.
#[derive(Debug, Default)]
pub struct ShadowQueue {
    /// Shadow rays in world space; they end before the light.
    pub rays: Vec<Ray>,
    /// Contribution of each ray.
    pub contributions: Vec<ShadowContribution>,
}

impl ShadowQueue {
    /// Removes all rays; memory is kept.
    pub fn clear(&mut self) {
        self.rays.clear();
        self.contributions.clear();
    }
}

/// Contribution of an unoccluded shadow ray.
#[derive(Clone, Copy, Debug)]
pub struct ShadowContribution {
    /// Index of the sample; passes have at most 65,536 samples.
    pub slot: u16,
    /// Number of path segments, by which contributions are clamped and sorted into AOVs.
    pub path_kind: PathKind,
    /// Light group.
    pub group: LightGroup,
    /// Radiance times throughput.
    pub radiance: Rgb,
    /// Solids that contain the ray's origin.
    pub interiors: Interiors,
}

/// Contribution of a path through a specular sphere, if all its shadow rays are unoccluded.
#[derive(Clone, Debug)]
pub struct BentShadowRay {
    /// Shadow rays along the segments of the path, in world space.
    pub segments: ArrayVec<Ray, 3>,
    /// Index of the sample.
    pub slot: u32,
    /// Light group.
    pub group: LightGroup,
    /// Radiance times throughput.
    pub radiance: Rgb,
}

/// Weight of the light that each camera ray of a sample sees directly: 1 over their number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraRayWeight(f32);

impl CameraRayWeight {
    /// Weight of `count` camera rays a sample; none counts as one.
    pub fn of(count: u32) -> Self {
        Self(1.0 / count.max(1) as f32)
    }
}

impl Default for CameraRayWeight {
    fn default() -> Self {
        Self(1.0)
    }
}

/// Output of all vertices of one wave of rays; the renderer keeps and reuses the buffers.
#[derive(Debug, Default)]
pub struct PathBuffers {
    /// Radiance of each sample.
    pub radiance: Vec<Rgb>,
    /// Weight of the light that camera rays see directly.
    pub camera_ray_weight: CameraRayWeight,
    /// Limits of contributions, if there are any.
    pub clamping: Option<ClampState>,
    /// AOVs of the samples, if any are recorded.
    pub record: Option<AovRecord>,
    /// One queue per light, whose shadow rays are coherent, and a last one for incoherent rays.
    pub shadows: Vec<ShadowQueue>,
    /// Light samples through specular spheres.
    pub bent: Vec<BentShadowRay>,
    /// Number of shadow rays in all queues.
    pub pending: usize,
    /// Rays that continue.
    pub next: Queue,
}

impl PathBuffers {
    /// Clears the radiance of samples 0..`slots` and prepares queues for `lights` lights.
    pub fn reset(&mut self, slots: usize, lights: usize) {
        self.radiance.clear();
        self.radiance.resize(slots, Rgb::BLACK);
        self.shadows.resize_with(lights.min(MAX_LIGHT_QUEUES) + 1, ShadowQueue::default);
    }

    /// Results of all samples.
    pub fn samples(&self) -> PixelSamples<'_> {
        let clamped = self.clamping.as_ref().map_or(&[][..], |clamping| &clamping.removed);
        let (planes, hit_ids) =
            self.record.as_ref().map_or((&[][..], &[][..]), |record| (&record.planes, &record.hit_ids));
        PixelSamples { radiance: &self.radiance, clamped, planes, hit_ids }
    }

    /// Adds a contribution to a sample, after clamping; emission that the camera sees by its weight
    /// among the sample's camera rays.
    #[inline]
    pub fn add(&mut self, slot: usize, path_kind: PathKind, group: LightGroup, mut radiance: Rgb) {
        let weight = if path_kind == PathKind::Emission { self.camera_ray_weight.0 } else { 1.0 };
        if let Some(clamping) = &mut self.clamping {
            radiance = clamping.limit(slot, path_kind, radiance, weight);
        }
        radiance = radiance * weight;
        if let Some(record) = &mut self.record {
            record.add_light(slot, path_kind, group, radiance);
        }
        self.radiance[slot] += radiance;
    }
}

/// Maximum number of shadow-ray queues; further lights share them.
const MAX_LIGHT_QUEUES: usize = 64;

/// Interface through which an integrator adds radiance, requests shadow rays and continues paths at
/// a vertex.
pub struct VertexOutput<'a> {
    pub(super) buffers: &'a mut PathBuffers,
    pub(super) path: &'a PathState,
    /// Throughput (beta) times filter weight, at this vertex.
    pub(super) beta: Rgb,
    /// Ray cone at the vertex.
    cone: RayCone,
}

impl<'a> VertexOutput<'a> {
    /// Creates the output of a path's next vertex, at `distance` from the last one; infinite if the
    /// ray left the world.
    #[inline]
    pub fn new(buffers: &'a mut PathBuffers, path: &'a PathState, distance: f32) -> Self {
        let cone = if distance < f32::INFINITY { path.cone.after(distance) } else { path.cone };
        Self { buffers, path, beta: path.beta, cone }
    }

    /// Diameter of the ray cone at the vertex, in scene units.
    #[inline]
    pub fn width(&self) -> f32 {
        self.cone.width
    }

    /// Throughput (beta) times filter weight.
    #[inline]
    pub fn beta(&self) -> Rgb {
        self.beta
    }

    /// Multiplies the throughput by `factor`, such as the transmittance of a medium.
    #[inline]
    pub fn scale(&mut self, factor: Rgb) {
        self.beta *= factor;
    }

    /// Adds radiance times throughput to the sample, under a light group.
    #[inline]
    pub fn add(&mut self, radiance: Rgb, group: LightGroup) {
        let path_kind = PathKind::from_segments(self.path.depth.saturating_add(1));
        self.buffers.add(self.path.slot as usize, path_kind, group, radiance * self.beta);
    }

    /// Adds `radiance` times throughput times the transmittance along `ray`, a shadow ray to the
    /// light of index `light`.
    #[inline]
    pub fn add_light_shadow_ray(&mut self, light: usize, ray: Ray, radiance: Rgb, group: LightGroup) {
        let queues = self.buffers.shadows.len() - 1;
        let queue = if light < queues { light } else { light % queues.max(1) };
        self.push_shadow(queue, ray, radiance, group, Interiors::NONE);
    }

    /// [`VertexOutput::add_light_shadow_ray`] for an incoherent shadow ray.
    #[inline]
    pub fn add_shadow_ray(&mut self, ray: Ray, radiance: Rgb, group: LightGroup) {
        self.add_shadow_ray_inside(ray, radiance, group, Interiors::NONE);
    }

    /// [`VertexOutput::add_shadow_ray`] for a shadow ray that starts inside solids, whose media
    /// attenuate it.
    #[inline]
    pub fn add_shadow_ray_inside(&mut self, ray: Ray, radiance: Rgb, group: LightGroup, inside: Interiors) {
        self.push_shadow(self.buffers.shadows.len() - 1, ray, radiance, group, inside);
    }

    /// Adds `radiance` times throughput if all shadow rays are unoccluded.
    pub fn add_bent_shadow_ray(&mut self, segments: ArrayVec<Ray, 3>, radiance: Rgb, group: LightGroup) {
        let radiance = radiance * self.beta;
        if !radiance.is_black() {
            self.buffers.pending += segments.len();
            self.buffers.bent.push(BentShadowRay { segments, slot: self.path.slot, group, radiance });
        }
    }

    fn push_shadow(&mut self, queue: usize, ray: Ray, radiance: Rgb, group: LightGroup, inside: Interiors) {
        let radiance = radiance * self.beta;
        if radiance.is_black() {
            return;
        }
        self.buffers.pending += 1;
        let queue = &mut self.buffers.shadows[queue];
        queue.rays.push(ray);
        let path_kind = PathKind::from_segments(self.path.depth.saturating_add(2));
        queue.contributions.push(ShadowContribution {
            slot: self.path.slot as u16,
            path_kind,
            group,
            radiance,
            interiors: inside,
        });
    }

    /// Traces `ray` as the `child`-th branch of a ray tree, with the throughput times `weight`.
    /// `sees_backdrop` as in [`PathHistory`].
    #[inline]
    pub fn trace_branch(&mut self, ray: Ray, weight: Rgb, sees_backdrop: bool, child: u32) {
        let path = PathState {
            beta: self.beta * weight,
            depth: self.path.depth + 1,
            sampler: self.path.sampler.branch(child),
            history: PathHistory { sees_backdrop, ..self.path.history },
            cone: self.cone,
            ..*self.path
        };
        self.buffers.next.push(ray, path);
    }

    /// Output of the same vertex for another state of its path, behind a surface at the same place.
    #[inline]
    pub fn at<'b>(&'b mut self, path: &'b PathState) -> VertexOutput<'b> {
        VertexOutput { buffers: self.buffers, path, beta: path.beta, cone: self.cone }
    }

    /// Continues the ray of the path behind surfaces that it passes straight through. `path` is its
    /// state there.
    pub fn continue_straight(&mut self, ray: Ray, path: &PathState) {
        self.buffers.next.push(ray, PathState { cone: self.cone, ..*path });
    }

    /// Continues the path by `ray`, with the throughput times `weight`. `steps` is the increase of
    /// the depth.
    #[inline]
    pub fn continue_path(&mut self, ray: Ray, weight: Rgb, history: PathHistory, steps: u32) {
        let path = PathState {
            beta: self.beta * weight,
            depth: self.path.depth + steps,
            sampler: self.path.sampler.branch(0),
            history,
            cone: self.cone.scattered(history.pdf),
            ..*self.path
        };
        self.buffers.next.push(ray, path);
    }
}
