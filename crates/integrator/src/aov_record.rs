//! Recording of AOVs: per-sample data beside radiance.

use super::{PathKind, PathLog, VertexOutput};
use juggler_bsdf::Scatter;
use juggler_camera::ShutterCamera;
use juggler_camera::aov::{self, DenoisingFeature, FilmAov, FilmAovs, LightGroup};
use juggler_camera::film::{HitIds, MASKS};
use juggler_material::Shading;
use juggler_math::{DVec2, Ray, Rgb, Vec3};
use juggler_world::frames::NeighborFrames;
use juggler_world::{Vertex, World};
use std::sync::Arc;

/// AOVs of the samples of a pass.
#[derive(Debug)]
pub struct AovRecord {
    aovs: FilmAovs,
    /// Camera of the rays, for planar depth.
    camera: Option<ShutterCamera>,
    /// Scene at neighboring frames, for motion vectors.
    frames: Option<Arc<NeighborFrames>>,
    /// Planes that receive light by number of path segments (emission, direct, indirect), and by
    /// light group.
    path_kinds: [Option<usize>; 3],
    groups: Vec<Option<usize>>,
    /// Plane that receives all light.
    color: Option<usize>,
    /// Planes of [`FilmAov::Alpha`] and [`FilmAov::ShadowCatcher`].
    alpha: Option<usize>,
    shadow_catcher: Option<usize>,
    /// Filter weight of each sample.
    weights: Vec<f32>,
    /// Whether the denoising features of each sample are recorded.
    has_features: Vec<bool>,
    /// AOV values, `aovs.planes.len()` per sample.
    pub planes: Vec<Rgb>,
    /// Object, material and shape of each sample, for masks; empty unless masks are recorded.
    pub hit_ids: Vec<HitIds>,
    /// Log of path events; `None` unless requested.
    pub log: Option<Box<PathLog>>,
}

impl AovRecord {
    /// Creates a record of `aovs` for rays of `camera`; `frames` are needed by motion vectors.
    pub fn new(aovs: &FilmAovs, camera: Option<&ShutterCamera>, frames: Option<&Arc<NeighborFrames>>) -> Self {
        let path_kinds = [FilmAov::Emission, FilmAov::Direct, FilmAov::Indirect].map(|aov| aovs.index_of(aov));
        let mut groups = Vec::new();
        for (plane, aov) in aovs.planes.iter().enumerate() {
            if let FilmAov::Group(LightGroup(number)) = *aov {
                let number = usize::from(number);
                groups.resize(groups.len().max(number + 1), None);
                groups[number] = Some(plane);
            }
        }
        let color = aovs.index_of(FilmAov::HalfFeature(DenoisingFeature::Color));
        let alpha = aovs.index_of(FilmAov::Alpha);
        let shadow_catcher = aovs.index_of(FilmAov::ShadowCatcher);
        let camera = camera.filter(|_| aovs.index_of(FilmAov::PlanarDepth).is_some()).cloned();
        let aovs = aovs.clone();
        Self {
            aovs,
            camera,
            frames: frames.map(Arc::clone),
            path_kinds,
            groups,
            color,
            alpha,
            shadow_catcher,
            weights: Vec::new(),
            has_features: Vec::new(),
            planes: Vec::new(),
            hit_ids: Vec::new(),
            log: None,
        }
    }

    /// Creates a record that only logs path events.
    pub fn logging() -> Self {
        Self { log: Some(Box::default()), ..Self::new(&aov::NO_AOVS, None, None) }
    }

    /// Starts samples with these filter weights.
    pub fn begin(&mut self, weights: impl Iterator<Item = f32>) {
        self.weights.clear();
        self.weights.extend(weights);
        self.has_features.clear();
        self.has_features.resize(self.weights.len(), false);
        self.planes.clear();
        self.planes.resize(self.weights.len() * self.aovs.planes.len(), Rgb::BLACK);
        // Camera rays see objects unless they reach the background.
        if let Some(plane) = self.alpha {
            for slot in 0..self.weights.len() {
                self.add(slot, Some(plane), Rgb::new(self.weights[slot], 0.0, 0.0));
            }
        }
        self.hit_ids.clear();
        if self.aovs.masks {
            self.hit_ids.resize(self.weights.len(), HitIds::EMPTY);
        }
    }

    fn add(&mut self, slot: usize, plane: Option<usize>, value: Rgb) {
        if let Some(plane) = plane {
            self.planes[slot * self.aovs.planes.len() + plane] += value;
        }
    }

    /// Adds light to the AOVs of a sample.
    #[inline]
    pub fn add_light(&mut self, slot: usize, path_kind: PathKind, group: LightGroup, radiance: Rgb) {
        if let Some(log) = &mut self.log {
            log.lights.push((slot, path_kind, group, radiance));
        }
        self.add(slot, self.color, radiance);
        self.add(slot, self.path_kinds[path_kind as usize], radiance);
        self.add(slot, self.groups.get(usize::from(group.0)).copied().flatten(), radiance);
    }

    /// Records the first hit of a sample's camera ray.
    fn record_hit(&mut self, slot: usize, hit: &SurfaceHit) {
        let SurfaceHit { ray, vertex, normal, albedo, .. } = *hit;
        let (surface, weight) = (&vertex.surface, self.weights[slot]);
        for plane in 0..self.aovs.planes.len() {
            let value = match self.aovs.planes[plane] {
                FilmAov::Coverage => Rgb::new(1.0, 0.0, 0.0),
                FilmAov::Albedo => albedo,
                FilmAov::Normal => to_rgb(normal),
                FilmAov::GeometricNormal => to_rgb(surface.normal),
                FilmAov::Depth => Rgb::new(ray.t_max, 1.0, 0.0),
                FilmAov::PlanarDepth => Rgb::new(self.planar_depth(ray), 1.0, 0.0),
                FilmAov::Position => to_rgb(surface.point),
                FilmAov::Motion(which) => {
                    match self
                        .frames
                        .as_deref()
                        .and_then(|frames| frames.motion_vector(which, hit.world, vertex, ray.time))
                    {
                        Some(motion) => motion_to_rgb(motion),
                        None => continue,
                    }
                }
                FilmAov::Uv => Rgb::new(surface.uv.x, surface.uv.y, 1.0),
                FilmAov::Feature(DenoisingFeature::Depth) | FilmAov::HalfFeature(DenoisingFeature::Depth) => {
                    Rgb::new(ray.t_max, 1.0, 0.0)
                }
                _ => continue,
            };
            self.add(slot, Some(plane), value * weight);
        }
        if let Some(hit_ids) = self.hit_ids.get_mut(slot) {
            let ids: [u32; MASKS] = [hit.world.entry_of(vertex.shape), vertex.material.0, vertex.shape];
            *hit_ids = HitIds { ids, weight };
        }
    }

    /// Distance from the camera to the end of a camera ray along the view direction. Rays of a lens
    /// start in the plane of the lens, which is perpendicular to the view.
    fn planar_depth(&self, ray: &Ray) -> f32 {
        let cosine = |camera: &ShutterCamera| camera.projection_at(ray.time).view_direction().dot(ray.direction);
        self.camera.as_ref().map_or(ray.t_max, |camera| ray.t_max * cosine(camera))
    }

    /// Records the motion vector of the background.
    fn record_miss(&mut self, slot: usize, ray: &Ray) {
        let Some(frames) = &self.frames else { return };
        for plane in 0..self.aovs.planes.len() {
            let FilmAov::Motion(which) = self.aovs.planes[plane] else { continue };
            if let Some(motion) = frames.background_motion_vector(which, ray.direction, ray.time) {
                self.planes[slot * self.aovs.planes.len() + plane] += motion_to_rgb(motion) * self.weights[slot];
            }
        }
    }

    /// Records that a camera ray reached the hidden background, also through glass, with the
    /// throughput `beta`, which contains the filter weight.
    fn record_transparency(&mut self, slot: usize, beta: Rgb) {
        let transmitted = self.filtered_luminance(slot, beta);
        self.add(slot, self.alpha, Rgb::new(-transmitted, transmitted, 0.0));
    }

    /// Records that a camera ray reached a shadow catcher, likewise.
    pub fn record_shadow_catcher(&mut self, slot: usize, beta: Rgb) {
        let caught = self.filtered_luminance(slot, beta);
        self.add(slot, self.alpha, Rgb::new(-caught, 0.0, caught));
    }

    /// Records the radiance of the shadow catchers of a sample, with all objects and without those
    /// that take light from them.
    pub fn record_caught_light(&mut self, slot: usize, lit: Rgb, unoccluded: Rgb) {
        self.add(slot, self.shadow_catcher, Rgb::new(lit.luminance(), unoccluded.luminance(), 0.0));
    }

    /// Luminance of a throughput that contains the filter weight: exactly the weight if nothing
    /// attenuates the ray.
    fn filtered_luminance(&self, slot: usize, beta: Rgb) -> f32 {
        let weight = self.weights[slot];
        if weight == 0.0 { 0.0 } else { weight * (beta / weight).luminance() }
    }

    /// Records denoising features: the first surface that is not specular, with the throughput
    /// `weight` of the specular path to it.
    fn record_features(&mut self, slot: usize, weight: Rgb, hit: &SurfaceHit) {
        if std::mem::replace(&mut self.has_features[slot], true) {
            return;
        }
        for plane in 0..self.aovs.planes.len() {
            let value = match self.aovs.planes[plane] {
                FilmAov::Feature(DenoisingFeature::Albedo) | FilmAov::HalfFeature(DenoisingFeature::Albedo) => {
                    hit.albedo * weight
                }
                FilmAov::Feature(DenoisingFeature::Normal) | FilmAov::HalfFeature(DenoisingFeature::Normal) => {
                    to_rgb(hit.normal) * self.weights[slot]
                }
                _ => continue,
            };
            self.add(slot, Some(plane), value);
        }
    }
}

/// The surface that a ray hit.
pub struct SurfaceHit<'a> {
    /// World of the surface.
    pub world: &'a World,
    /// Ray that ends at the surface.
    pub ray: &'a Ray,
    /// Vertex on the surface.
    pub vertex: &'a Vertex,
    /// Unit shading normal, after normal and bump mapping.
    pub normal: Vec3,
    /// Albedo of the surface.
    pub albedo: Rgb,
    /// Whether the BSDF is purely specular, so that features come from the surface behind it.
    pub is_specular: bool,
    /// Kind of scattering of the strongest lobe that is not specular.
    pub scatter: Scatter,
}

fn to_rgb(vector: Vec3) -> Rgb {
    Rgb::new(vector.x, vector.y, vector.z)
}

/// Encodes a motion vector, with 1 as the mark of validity.
fn motion_to_rgb(motion: DVec2) -> Rgb {
    Rgb::new(motion.x as f32, motion.y as f32, 1.0)
}

impl VertexOutput<'_> {
    /// Whether AOVs or a log are recorded.
    #[inline]
    pub fn is_recording(&self) -> bool {
        // Of the camera rays of a sample, the one that continues is recorded.
        let record = self.buffers.record.as_ref();
        record.is_some_and(|record| record.log.is_some() || !self.path.history.is_split)
    }

    /// Records that the ray left the world.
    pub fn record_miss(&mut self, ray: &Ray) {
        let slot = self.path.slot as usize;
        let Some(record) = self.buffers.record.as_mut().filter(|_| !self.path.history.is_split) else { return };
        if self.path.history.sees_backdrop {
            record.record_transparency(slot, self.beta);
        }
        if self.path.is_camera_ray() {
            record.record_miss(slot, ray);
        }
    }

    /// Records the surface that the path hit, as its material shades it.
    #[inline(always)]
    pub fn record_shading(&mut self, world: &World, ray: &Ray, vertex: &Vertex, shading: &Shading) {
        if self.is_recording() {
            self.record_shaded_hit(world, ray, vertex, shading);
        }
    }

    #[inline(never)]
    fn record_shaded_hit(&mut self, world: &World, ray: &Ray, vertex: &Vertex, shading: &Shading) {
        let (normal, albedo) = (shading.frame.normal, shading.albedo(-ray.direction));
        let (is_specular, scatter) = (shading.bsdf.is_specular(), shading.bsdf.scatter());
        self.record_hit(&SurfaceHit { world, ray, vertex, normal, albedo, is_specular, scatter });
    }

    /// Records the surface that a camera ray hit, for integrators that do not trace light.
    pub fn record_surface(&mut self, world: &World, ray: &Ray, vertex: &Vertex) {
        if self.is_recording() {
            self.record_shading(world, ray, vertex, &self.shade_surface(world, ray, vertex));
        }
    }

    /// Shading of the surface that a camera ray hit, for integrators that do not trace light.
    pub fn shade_surface(&self, world: &World, ray: &Ray, vertex: &Vertex) -> Shading {
        let choice = if world.is_simple(vertex) { 0.0 } else { self.path.sampler.skipped(0).next_1d() };
        world.shade(vertex, -ray.direction, 1.0, choice)
    }

    /// Records a surface that the path hit.
    pub fn record_hit(&mut self, hit: &SurfaceHit) {
        let (slot, history) = (self.path.slot as usize, &self.path.history);
        let Some(record) = &mut self.buffers.record else { return };
        if let Some(log) = &mut record.log {
            log.record_hit(slot, hit);
        }
        if history.is_split {
            return;
        }
        if self.path.is_camera_ray() {
            record.record_hit(slot, hit);
        }
        if history.events.is_only_specular() && !hit.is_specular {
            record.record_features(slot, self.beta, hit);
        }
    }
}
