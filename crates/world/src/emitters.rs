//! Light sampling over all emitters: selection by estimated contribution, and the matching
//! densities.

use super::emissive_shape::EmissiveShape;
use super::emissive_surfaces::{EmissiveSurfaces, NO_SURFACE};
use super::infinite_lights::{InfiniteLight, InfiniteLights};
use super::{SceneLight, Vertex, World};
use juggler_bvh::SimdLevel;
use juggler_light::LightSample;
use juggler_light::background::AnyBackground;
use juggler_light::emitter::{AreaEmitter, LightBounds, LightTree, LightTreeSample};
use juggler_math::{BuildControl, Cancelled, Ray, Rgb, Vec2, Vec3, robust};
use std::collections::BTreeSet;

/// Maximum number of triangles of all emissive meshes up to which each triangle is an emitter. With
/// more, a mesh that is placed several times is one emitter per placement, whose points are sampled
/// by area.
pub const MAX_SPLIT_TRIANGLES: u64 = 1 << 18;

/// All emitters of a world.
#[derive(Clone, Debug, Default)]
pub(super) struct Emitters {
    /// Light tree over `finite`, in the same order.
    tree: LightTree,
    finite: Vec<Emitter>,
    /// Infinite lights.
    pub(super) infinite: InfiniteLights,
    /// Emissive shapes, sorted by shape index.
    shapes: Vec<EmissiveShapeEntry>,
}

/// An emissive shape and the range of its emitters.
#[derive(Clone, Debug)]
struct EmissiveShapeEntry {
    shape: EmissiveShape,
    /// Index of its first emitter.
    first_emitter: u32,
    /// Index of the emitter of each primitive, relative to `first_emitter`; empty if there is only
    /// one.
    emitter_indices: Box<[u32]>,
}

/// A finite emitter.
#[derive(Clone, Debug)]
enum Emitter {
    /// A light of the scene, by index.
    Light(u32),
    /// A surface of the emissive shape with that index.
    Area(AreaEmitter, u32),
    /// The whole emissive shape with that index.
    Shape(u32),
}

/// A sample of incident light from one emitter.
#[derive(Clone, Copy, Debug)]
pub struct EmitterSample {
    /// Unit vector towards the sampled point.
    pub wi: Vec3,
    /// Distance to the sampled point; infinite for an infinite light.
    pub distance: f32,
    /// Unoccluded incident radiance; for lights without an extent, the irradiance of a surface that
    /// faces them.
    pub radiance: Rgb,
    /// Density per steradian; for lights without an extent, the selection probability.
    pub pdf: f32,
    /// Whether a BSDF-sampled ray can hit the emitter.
    pub can_be_bsdf_sampled: bool,
    /// Emitter of the sample.
    pub emitter: EmitterId,
    /// Unit normal at the sampled point; zero if it lies on no surface.
    pub normal: Vec3,
}

/// Emitter of a light sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EmitterId {
    /// A light of the scene, by index.
    Light(u32),
    /// An emissive shape, by index.
    Shape(u32),
    /// The background.
    Background,
}

/// A point that receives light.
#[derive(Clone, Copy, Debug)]
pub struct LightSampleContext {
    /// The point, in world space.
    pub point: Vec3,
    /// Bound on the distance between `point` and the true surface along the surface's normal; 0 in
    /// media.
    pub error: f32,
    /// Unit normal on the illuminated side; zero if light arrives from all directions.
    pub normal: Vec3,
    /// Time, 0 to 1 over the shutter interval.
    pub time: f32,
}

impl LightSampleContext {
    /// Whether the receiver lies, up to rounding, in the plane of an emissive surface of this unit
    /// normal, at `distance` in the direction `wi`. Such a surface emits nothing towards the
    /// receiver, but rounding produces a spurious contribution.
    #[inline]
    pub(super) fn is_coplanar(&self, wi: Vec3, distance: f32, normal: Vec3) -> bool {
        // Bound on the receiver's height above the plane: the errors of receiver, emitter, `wi` and
        // `normal`.
        let bound = 2.0 * self.error + robust::gamma(8) * distance;
        (wi.dot(normal) * distance).abs() <= bound
    }
}

/// Address of the arrays of a mesh, which its copies share; `None` for other shapes.
fn mesh_address(shape: &EmissiveShape) -> Option<usize> {
    Some(std::ptr::from_ref(shape.shape().mesh()?.data()?).addr())
}

/// Meshes that are placed several times, if all emissive meshes have more than
/// [`MAX_SPLIT_TRIANGLES`] triangles.
fn repeated_meshes(shapes: &[EmissiveShapeEntry]) -> BTreeSet<usize> {
    let meshes = shapes.iter().filter_map(|entry| entry.shape.shape().mesh());
    if meshes.map(|mesh| mesh.arrays().triangles.len() as u64).sum::<u64>() <= MAX_SPLIT_TRIANGLES {
        return BTreeSet::new();
    }
    let (mut seen, mut repeated) = (BTreeSet::new(), BTreeSet::new());
    for address in shapes.iter().filter_map(|entry| mesh_address(&entry.shape)) {
        if !seen.insert(address) {
            repeated.insert(address);
        }
    }
    repeated
}

impl Emitters {
    /// Creates the emitters of lights, emissive shapes and background. `radius` is that of a sphere
    /// around all bounded objects.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] if `control` is cancelled.
    pub fn new(
        lights: &[SceneLight],
        emissive_shapes: Vec<EmissiveShape>,
        background: &AnyBackground,
        radius: f32,
        control: &BuildControl,
    ) -> Result<Self, Cancelled> {
        let mut emitters = Self::default();
        let (mut bounds, mut infinite): (Vec<LightBounds>, Vec<(InfiniteLight, f32)>) = (Vec::new(), Vec::new());
        // Lights with a surface are among the emissive shapes.
        for (index, light) in (0..).zip(lights).filter(|(_, light)| !light.is_surface) {
            match light.bounds(radius) {
                Some(light_bounds) => {
                    emitters.finite.push(Emitter::Light(index));
                    bounds.push(light_bounds);
                }
                None => infinite.push((InfiniteLight::Light(index), light.power(1.0))),
            }
        }
        if !background.mean_radiance().is_black() {
            infinite.push((InfiniteLight::Background, background.power(1.0)));
        }
        emitters.infinite = InfiniteLights::new(infinite);
        emitters.add(emissive_shapes, &mut bounds, control);
        emitters.tree = LightTree::build_with_control(&bounds, control)?;
        Ok(emitters)
    }

    /// Sets the SIMD instruction set of the light tree.
    pub fn with_simd_level(mut self, level: SimdLevel) -> Self {
        self.tree = self.tree.with_simd_level(level);
        self
    }

    /// Adds the emitters of shapes, not all if `control` is cancelled. Moves the list of shapes before
    /// the lists of emitters grow, so that millions of emissive shapes are never stored twice.
    fn add(&mut self, emissive_shapes: Vec<EmissiveShape>, bounds: &mut Vec<LightBounds>, control: &BuildControl) {
        let entry = |shape| EmissiveShapeEntry { shape, first_emitter: 0, emitter_indices: Box::default() };
        self.shapes = emissive_shapes.into_iter().map(entry).collect();
        // The list is mostly sorted already, and indices are unique.
        self.shapes.sort_unstable_by_key(|entry| entry.shape.shape_index);
        let repeated = repeated_meshes(&self.shapes);
        self.finite.reserve(self.shapes.len());
        bounds.reserve(self.shapes.len());
        for (entry_index, EmissiveShapeEntry { shape, first_emitter, emitter_indices }) in (0..).zip(&mut self.shapes) {
            if control.is_cancelled() {
                return;
            }
            *first_emitter = self.finite.len() as u32;
            let is_split = mesh_address(shape).is_none_or(|mesh| !repeated.contains(&mesh));
            let transform = shape.static_transform().filter(|_| is_split);
            let Some(emissive) =
                transform.and_then(|transform| EmissiveSurfaces::from_shape(shape.shape(), &transform))
            else {
                bounds.push(shape.bounds());
                self.finite.push(Emitter::Shape(entry_index));
                continue;
            };
            for surface in emissive.surfaces {
                bounds.push(surface.light_bounds(shape.luminance(), shape.is_two_sided()));
                self.finite.push(Emitter::Area(surface, entry_index));
            }
            *emitter_indices = emissive.surface_indices.into_boxed_slice();
        }
    }

    /// Heap memory, in bytes.
    pub fn heap_bytes(&self) -> usize {
        let surface =
            |emitter: &Emitter| if let Emitter::Area(surface, _) = emitter { surface.heap_bytes() } else { 0 };
        let surfaces: usize = self.finite.iter().map(surface).sum();
        let index_bytes: usize = self.shapes.iter().map(|shape| size_of_val(&*shape.emitter_indices)).sum();
        let listed = size_of_val(self.finite.as_slice()) + size_of_val(self.shapes.as_slice());
        listed + index_bytes + surfaces + self.tree.heap_bytes()
    }

    /// Indices of the emissive shapes, ascending.
    pub fn emissive_shapes(&self) -> impl Iterator<Item = u32> {
        self.shapes.iter().map(|entry| entry.shape.shape_index)
    }

    /// Probability of sampling an infinite light: each counts as much as all finite emitters
    /// together.
    fn infinite_probability(&self) -> f32 {
        let (infinite, finite) = (self.infinite.len(), usize::from(!self.finite.is_empty()));
        if infinite == 0 { 0.0 } else { infinite as f32 / (infinite + finite) as f32 }
    }

    fn finite_probability(&self) -> f32 {
        1.0 - self.infinite_probability()
    }

    /// Selects a finite emitter.
    #[inline]
    fn pick(&self, context: &LightSampleContext, u: f32) -> Option<LightTreeSample> {
        match self.finite.len() {
            1 => Some(LightTreeSample { index: 0, probability: 1.0, u_remapped: u }),
            _ => self.tree.sample(context.point, context.normal, u),
        }
    }

    /// Probability of selecting the finite emitter `index`.
    #[inline]
    fn selection_probability(&self, context: &LightSampleContext, index: u32) -> f32 {
        match self.finite.len() {
            1 => 1.0,
            _ => self.tree.probability(context.point, context.normal, index),
        }
    }

    /// Density with which [`World::sample_light`] picks the point of an emissive shape that a ray
    /// hit.
    fn pdf(&self, from: &LightSampleContext, vertex: &Vertex) -> Option<f32> {
        let at = self.shapes.binary_search_by_key(&vertex.shape, |entry| entry.shape.shape_index).ok()?;
        let entry = self.shapes.get(at)?;
        let relative = entry.emitter_indices.get(vertex.primitive as usize).copied().unwrap_or(0);
        if relative == NO_SURFACE {
            return None;
        }
        let index = entry.first_emitter + relative;
        let offset = vertex.surface.point - from.point;
        let distance = offset.length();
        if from.is_coplanar(offset / distance, distance, vertex.surface.normal) {
            return None;
        }
        let probability = self.selection_probability(from, index) * self.finite_probability();
        let pdf = || match self.finite.get(index as usize) {
            Some(Emitter::Area(area, _)) => area.pdf(from.point, vertex.surface.point),
            Some(Emitter::Shape(_)) => entry.shape.pdf(from, vertex),
            _ => 0.0,
        };
        (probability > 0.0).then(|| probability * pdf())
    }
}

impl World {
    /// Whether the world has more than one emitter.
    #[inline]
    pub fn has_many_emitters(&self) -> bool {
        self.emitters.finite.len() + self.emitters.infinite.len() > 1
    }

    /// Samples incident light at a point: selects an emitter by `u.x`, then a point on it.
    #[inline]
    pub fn sample_light(&self, context: &LightSampleContext, u: Vec2) -> Option<EmitterSample> {
        let emitters = &self.emitters;
        let infinite = emitters.infinite_probability();
        // Sample an infinite light.
        if u.x < infinite {
            let (picked, probability, rest) = emitters.infinite.pick((u.x / infinite).min(1f32.next_down()))?;
            let (probability, rest) = (probability * infinite, Vec2::new(rest, u.y));
            return match picked {
                InfiniteLight::Light(index) => self.sample_scene_light(index, context, rest, probability),
                InfiniteLight::Background => self.sample_background(context, rest, probability),
            };
        }
        // Select a finite emitter by the light tree, and sample it.
        let finite = emitters.finite_probability();
        let pick = emitters.pick(context, ((u.x - infinite) / finite).min(1f32.next_down()))?;
        let (probability, rest) = (pick.probability * finite, Vec2::new(pick.u_remapped, u.y));
        match emitters.finite.get(pick.index as usize)? {
            Emitter::Light(index) => self.sample_scene_light(*index, context, rest, probability),
            Emitter::Area(area, shape) => {
                let sample = area.sample(context.point, rest)?;
                if context.is_coplanar(sample.wi, sample.distance, sample.normal) {
                    return None;
                }
                let shape = &emitters.shapes.get(*shape as usize)?.shape;
                let radiance = shape.radiance(&self.materials, context, sample.wi, sample.normal)?;
                let emitter = EmitterId::Shape(shape.shape_index);
                Some(bsdf_sampled(
                    emitter,
                    sample.wi,
                    sample.distance,
                    radiance,
                    sample.pdf * probability,
                    sample.normal,
                ))
            }
            Emitter::Shape(shape) => {
                emitters.shapes.get(*shape as usize)?.shape.sample(&self.materials, context, rest, probability)
            }
        }
    }

    fn sample_scene_light(
        &self,
        index: u32,
        context: &LightSampleContext,
        u: Vec2,
        probability: f32,
    ) -> Option<EmitterSample> {
        let sample = self.lights.get(index as usize)?.at(context.time).light.sample(context.point, u)?;
        Some(EmitterSample {
            wi: sample.wi,
            distance: sample.distance,
            radiance: sample.radiance,
            pdf: sample.pdf * probability,
            can_be_bsdf_sampled: false,
            emitter: EmitterId::Light(index),
            normal: Vec3::ZERO,
        })
    }

    /// Incident light at a point from a light of the scene without an extent.
    pub fn point_light(&self, index: u32, context: &LightSampleContext) -> Option<LightSample> {
        let light = &self.lights.get(index as usize)?.at(context.time).light;
        light.is_delta().then(|| light.sample(context.point, Vec2::ZERO))?
    }

    fn sample_background(&self, context: &LightSampleContext, u: Vec2, probability: f32) -> Option<EmitterSample> {
        let sample = self.background.sample(u)?;
        // Skip the lookup for directions below the horizon: environment maps are large.
        if sample.wi.dot(context.normal) < 0.0 {
            return None;
        }
        let radiance = self.background.radiance(&Ray { time: context.time, ..Ray::new(context.point, sample.wi) });
        (!radiance.is_black()).then(|| {
            bsdf_sampled(
                EmitterId::Background,
                sample.wi,
                f32::INFINITY,
                radiance,
                sample.pdf * probability,
                Vec3::ZERO,
            )
        })
    }

    /// Density per steradian with which [`World::sample_light`] picks the direction of a ray that
    /// left the world.
    #[inline]
    pub fn background_pdf(&self, direction: Vec3) -> f32 {
        let probability = self.emitters.infinite.probability(InfiniteLight::Background);
        if probability > 0.0 {
            self.background.pdf(direction) * (probability * self.emitters.infinite_probability())
        } else {
            0.0
        }
    }

    /// Density per steradian with which [`World::sample_light`] picks, at `from`, the point
    /// `vertex` of an emitter that a ray hit.
    #[inline]
    pub fn light_pdf(&self, from: &LightSampleContext, vertex: &Vertex) -> f32 {
        self.emitters.pdf(from, vertex).unwrap_or(0.0)
    }
}

/// Creates a sample of an emitter that BSDF-sampled rays can hit, too.
pub(super) fn bsdf_sampled(
    emitter: EmitterId,
    wi: Vec3,
    distance: f32,
    radiance: Rgb,
    pdf: f32,
    normal: Vec3,
) -> EmitterSample {
    EmitterSample { wi, distance, radiance, pdf, can_be_bsdf_sampled: true, emitter, normal }
}
