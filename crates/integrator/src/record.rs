//! Recording layers: what samples have beside their radiance.

use super::{Emit, PathLog, Way};
use juggler_bsdf::Scatter;
use juggler_camera::film::{MASKS, Mark};
use juggler_camera::layer::{self, Guide, Layer, Layers, LightGroup};
use juggler_material::Shade;
use juggler_math::{DVec2, Ray, Rgb, Vec3};
use juggler_world::frames::Frames;
use juggler_world::{Vertex, World};
use std::sync::Arc;

/// The layers of some samples.
#[derive(Debug)]
pub struct Record {
    layers: Layers,
    /// What the scene is at other frames, where that is known.
    frames: Option<Arc<Frames>>,
    /// Where light goes by its way, and by its group.
    ways: [Option<usize>; 3],
    groups: Vec<Option<usize>>,
    /// Where all light goes.
    color: Option<usize>,
    /// What the filter makes of each sample.
    weights: Vec<f32>,
    /// How far the camera's ray of each has come through holes.
    passed: Vec<f32>,
    /// Whether it is known what denoising of each sample is guided by.
    is_guided: Vec<bool>,
    /// As many a sample as there are layers.
    pub planes: Vec<Rgb>,
    /// What each sample shows; nothing where nobody asks.
    pub marks: Vec<Mark>,
    /// What paths did; nothing where nobody asks.
    pub log: Option<Box<PathLog>>,
}

impl Record {
    /// Creates a record of `layers`; `frames` are needed by motion layers.
    pub fn new(layers: &Layers, frames: Option<&Arc<Frames>>) -> Self {
        let ways = [Layer::Emission, Layer::Direct, Layer::Indirect].map(|layer| layers.place(layer));
        let mut groups = Vec::new();
        for (place, layer) in layers.planes.iter().enumerate() {
            if let Layer::Group(LightGroup(number)) = *layer {
                let number = usize::from(number);
                groups.resize(groups.len().max(number + 1), None);
                groups[number] = Some(place);
            }
        }
        let color = layers.place(Layer::Half(Guide::Color));
        let layers = layers.clone();
        Self {
            layers,
            frames: frames.map(Arc::clone),
            ways,
            groups,
            color,
            weights: Vec::new(),
            passed: Vec::new(),
            is_guided: Vec::new(),
            planes: Vec::new(),
            marks: Vec::new(),
            log: None,
        }
    }

    /// Of what paths did, and nothing else.
    pub fn logging() -> Self {
        Self { log: Some(Box::default()), ..Self::new(&layer::NONE, None) }
    }

    /// For samples of these weights in the filter.
    pub fn begin(&mut self, weights: impl Iterator<Item = f32>) {
        self.weights.clear();
        self.weights.extend(weights);
        self.passed.clear();
        self.passed.resize(self.weights.len(), 0.0);
        self.is_guided.clear();
        self.is_guided.resize(self.weights.len(), false);
        self.planes.clear();
        self.planes.resize(self.weights.len() * self.layers.planes.len(), Rgb::BLACK);
        self.marks.clear();
        if self.layers.masks {
            self.marks.resize(self.weights.len(), Mark::EMPTY);
        }
    }

    fn add(&mut self, slot: usize, place: Option<usize>, value: Rgb) {
        if let Some(place) = place {
            self.planes[slot * self.layers.planes.len() + place] += value;
        }
    }

    /// Light that a sample gathers.
    #[inline]
    pub fn light(&mut self, slot: usize, way: Way, group: LightGroup, radiance: Rgb) {
        if let Some(log) = &mut self.log {
            log.lights.push((slot, way, group, radiance));
        }
        self.add(slot, self.color, radiance);
        self.add(slot, self.ways[way as usize], radiance);
        self.add(slot, self.groups.get(usize::from(group.0)).copied().flatten(), radiance);
    }

    /// What the camera's ray of a sample met first.
    fn see(&mut self, slot: usize, sight: &Sight) {
        let Sight { ray, vertex, normal, albedo, .. } = *sight;
        let (surface, weight) = (&vertex.surface, self.weights[slot]);
        for place in 0..self.layers.planes.len() {
            let value = match self.layers.planes[place] {
                Layer::Coverage => Rgb::new(1.0, 0.0, 0.0),
                Layer::Albedo => albedo,
                Layer::Normal => color(normal),
                Layer::GeometricNormal => color(surface.normal),
                Layer::Depth => Rgb::new(self.passed[slot] + ray.t_max, 1.0, 0.0),
                Layer::Position => color(surface.point),
                Layer::Motion(which) => {
                    match self.frames.as_deref().and_then(|frames| frames.way(which, sight.world, vertex, ray.time)) {
                        Some(way) => pixels(way),
                        None => continue,
                    }
                }
                Layer::Uv => Rgb::new(surface.uv.x, surface.uv.y, 1.0),
                Layer::Guide(Guide::Depth) | Layer::Half(Guide::Depth) => Rgb::new(ray.t_max, 1.0, 0.0),
                _ => continue,
            };
            self.add(slot, Some(place), value * weight);
        }
        if let Some(mark) = self.marks.get_mut(slot) {
            let things: [u32; MASKS] = [sight.world.entry_of(vertex.object), vertex.material.0, vertex.object];
            *mark = Mark { things, weight };
        }
    }

    /// Where the camera's ray of a sample goes that met nothing.
    fn miss(&mut self, slot: usize, ray: &Ray) {
        let Some(frames) = &self.frames else { return };
        for place in 0..self.layers.planes.len() {
            let Layer::Motion(which) = self.layers.planes[place] else { continue };
            if let Some(way) = frames.way_of_direction(which, ray.direction, ray.time) {
                self.planes[slot * self.layers.planes.len() + place] += pixels(way) * self.weights[slot];
            }
        }
    }

    /// What it met behind mirrors and clear glass, which colour it by `weight`.
    fn guide(&mut self, slot: usize, weight: Rgb, sight: &Sight) {
        if std::mem::replace(&mut self.is_guided[slot], true) {
            return;
        }
        for place in 0..self.layers.planes.len() {
            let value = match self.layers.planes[place] {
                Layer::Guide(Guide::Albedo) | Layer::Half(Guide::Albedo) => sight.albedo * weight,
                Layer::Guide(Guide::Normal) | Layer::Half(Guide::Normal) => color(sight.normal) * self.weights[slot],
                _ => continue,
            };
            self.add(slot, Some(place), value);
        }
    }
}

/// What a ray met.
pub struct Sight<'a> {
    /// Where that is.
    pub world: &'a World,
    /// Its end drawn in.
    pub ray: &'a Ray,
    /// The place.
    pub vertex: &'a Vertex,
    /// Unit shading normal there, as maps have turned it.
    pub normal: Vec3,
    /// The colour that it has without light.
    pub albedo: Rgb,
    /// Whether it only mirrors or refracts, so that what is behind it is what counts.
    pub is_smooth: bool,
    /// How most of what is no delta is scattered.
    pub scatter: Scatter,
}

fn color(vector: Vec3) -> Rgb {
    Rgb::new(vector.x, vector.y, vector.z)
}

/// A way on the film, and that it is known.
fn pixels(way: DVec2) -> Rgb {
    Rgb::new(way.x as f32, way.y as f32, 1.0)
}

impl Emit<'_> {
    /// Whether anybody asks what is seen.
    #[inline]
    pub fn records(&self) -> bool {
        self.harvest.record.is_some()
    }

    /// Records that the path goes on through a hole as if nothing had been there.
    pub fn pass(&mut self, ray: &Ray) {
        if let Some(record) = self.harvest.record.as_mut().filter(|_| self.path.depth == 0) {
            record.passed[self.path.slot as usize] += ray.t_max;
        }
    }

    /// Records that the path met nothing.
    pub fn miss(&mut self, ray: &Ray) {
        let slot = self.path.slot as usize;
        if let Some(record) = self.harvest.record.as_mut().filter(|_| self.path.depth == 0) {
            record.miss(slot, ray);
        }
    }

    /// Records the surface that the path hit, as its material shades it.
    #[inline]
    pub fn see_shaded(&mut self, world: &World, ray: &Ray, vertex: &Vertex, shade: &Shade) {
        if self.records() {
            let (normal, albedo) = (shade.frame.normal, shade.albedo(-ray.direction));
            let (is_smooth, scatter) = (shade.bsdf.is_specular(), shade.bsdf.scatter());
            self.see(&Sight { world, ray, vertex, normal, albedo, is_smooth, scatter });
        }
    }

    /// Records the surface that a camera ray hit, for integrators that do not trace light.
    pub fn see_unlit(&mut self, world: &World, ray: &Ray, vertex: &Vertex) {
        if self.records() {
            let choice = if world.is_simple(vertex) { 0.0 } else { self.path.sampler.at(0).next_1d() };
            self.see_shaded(world, ray, vertex, &world.shade(vertex, -ray.direction, 1.0, choice));
        }
    }

    /// Records what the path met.
    pub fn see(&mut self, sight: &Sight) {
        let (slot, trail) = (self.path.slot as usize, &self.path.trail);
        let Some(record) = &mut self.harvest.record else { return };
        if let Some(log) = &mut record.log {
            log.see(slot, sight);
        }
        if self.path.depth == 0 {
            record.see(slot, sight);
        }
        if trail.scattered.is_first() && !sight.is_smooth {
            record.guide(slot, self.weight, sight);
        }
    }
}
