//! Specular spheres through which paths sample lights (caustics). Without these samples, a path
//! from a diffuse surface finds such lights only when a BSDF sample happens to hit a sphere.

use super::world_shapes::{WorldShape, collect_shapes};
use super::{Geometry, LightSampleContext, World};
use crate::manifold::{SpecularPath, SpecularSphere, cos_from_sin};
use arrayvec::ArrayVec;
use juggler_bsdf::Bsdf;
use juggler_material::medium::Medium;
use juggler_material::{MaterialId, MaterialTable, ShadingView};
use juggler_math::{Frame, Rgb, Vec2, Vec3, warp};
use juggler_shape::AnyShape;
use juggler_shape::surface::Surface;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::f32::consts::TAU;

/// Maximum number of sampled spheres: only the largest are kept, since each vertex evaluates all of
/// them.
const MAX_CASTERS: usize = 16;

/// Maximum number of candidate shapes examined, because instancing may multiply them without limit.
const MAX_CANDIDATES: usize = 1 << 12;

/// Total weight from which [`VisibleCasters::pick`] always selects a sphere. The weight of a
/// visible sphere is its reflectance or transmittance times its solid angle, divided by 2π.
const FULL_WEIGHT: f32 = 0.5;

/// Maximum fraction of BSDF samples that are replaced by directions towards spheres.
const MAX_GUIDED: f32 = 0.15;
/// Fraction of BSDF samples to replace, per unit of the total weight.
const GUIDED_PER_WEIGHT: f32 = 8.0;

/// Two spheres coincide if their surfaces are nowhere further apart than this, in radii.
const COINCIDENT: f32 = 2e-4;

/// A sphere of specular material in world space.
#[derive(Clone, Debug)]
pub struct CausticCaster {
    /// Center and radius, in world space.
    pub sphere: SpecularSphere,
    /// Indices of the shapes: several if spheres of the same material coincide exactly, any of
    /// which a ray may hit.
    shapes: Vec<u32>,
    material: SpecularMaterial,
}

/// Specular material of a sphere.
#[derive(Clone, Debug)]
struct SpecularMaterial {
    /// BSDF on the outside, in a frame whose z axis is the outward normal.
    bsdf: Bsdf,
    /// Approximate reflectance and transmittance; 0 for a path that the material does not support.
    strengths: [f32; 2],
    ior: f32,
    medium: Medium,
}

impl SpecularMaterial {
    /// Extracts the specular properties of a material that does not vary over the surface; `None`
    /// if it neither reflects specularly nor transmits clearly.
    fn from_material(id: MaterialId, materials: &MaterialTable) -> Option<Self> {
        if materials.is_textured(id) || !materials.is_simple(id) {
            return None;
        }
        let surface = Surface::new(Vec3::ZERO, 0.0, Vec3::Z, Vec2::ZERO);
        let bsdf = materials.shade(id, &ShadingView::along_normal(&surface)).bsdf;
        let interior = materials.interior(id).and_then(|id| materials.interiors().get(id.index()));
        // Evaluate at oblique incidence, where the reflectance approximates the average.
        let wo = Vec3::new(0.8, 0.0, 0.6);
        let total_weight = |is_up: bool| {
            let weights =
                bsdf.deltas(wo).into_iter().filter(|delta| (delta.wi.z > 0.0) == is_up).map(|delta| delta.weight);
            weights.fold(0.0, |sum: f32, weight| sum + weight.max_channel())
        };
        // Exclude dispersive glass: light samples through a sphere have no wavelength.
        if interior.is_some_and(|interior| interior.dispersion > 0.0) {
            return None;
        }
        let clear = interior.filter(|interior| bsdf.is_specular() && interior.ior > 1.0 && !interior.medium.scatters());
        let transmittance = if clear.is_some() { (1.0 - total_weight(true)).max(0.0) } else { 0.0 };
        let (ior, medium) = interior.map_or((1.0, Medium::default()), |interior| (interior.ior, interior.medium));
        let strengths = [total_weight(true), transmittance];
        (strengths != [0.0; 2]).then_some(Self { bsdf, strengths, ior, medium })
    }

    /// Whether two materials scatter alike.
    fn equals(&self, other: &Self) -> bool {
        let weights = |material: &Self| {
            [Vec3::new(0.8, 0.0, 0.6), Vec3::new(0.2, 0.0, 0.98), Vec3::new(0.8, 0.0, -0.6)]
                .map(|wo| material.bsdf.deltas(wo).iter().fold(Rgb::BLACK, |sum, delta| sum + delta.weight))
        };
        (self.strengths, self.ior, self.medium) == (other.strengths, other.ior, other.medium)
            && weights(self) == weights(other)
    }
}

/// A sphere and the kind of specular path: reflection or refraction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CasterId {
    index: u16,
    is_refracted: bool,
}

impl CausticCaster {
    /// Collects the specular spheres of a world, largest first.
    pub(super) fn collect(top: &Geometry, materials: &MaterialTable) -> Vec<Self> {
        // Compile each material once, since there may be many spheres.
        let specular_materials = RefCell::new(BTreeMap::new());
        let is_specular = |id| {
            specular_materials
                .borrow_mut()
                .entry(id)
                .or_insert_with(|| SpecularMaterial::from_material(id, materials))
                .is_some()
        };
        let is_specular_sphere = |shape: &AnyShape, id| shape.sphere().is_some() && is_specular(id);
        let spheres = collect_shapes(top, MAX_CANDIDATES, &is_specular_sphere);
        let specular_materials = specular_materials.into_inner();
        let material = |sphere: &WorldShape| specular_materials.get(&sphere.material)?.as_ref();
        let mut casters: Vec<Self> = spheres.iter().filter_map(|sphere| Self::new(sphere, material(sphere)?)).collect();
        casters.sort_by(|a, b| b.sphere.radius.total_cmp(&a.sphere.radius));
        let mut casters = Self::without_coincident(casters);
        casters.truncate(MAX_CASTERS);
        casters
    }

    /// Joins spheres of one material that coincide exactly. Removes spheres that nearly coincide,
    /// or whose materials differ: rounding decides which of them a ray hits, so only BSDF sampling
    /// may find light through them.
    fn without_coincident(casters: Vec<Self>) -> Vec<Self> {
        let mut joined: Vec<(Self, bool)> = Vec::with_capacity(casters.len());
        for caster in casters {
            // Casters are sorted by radius, so those of similar radius are at the end.
            let nearby =
                joined.iter_mut().rev().take_while(|(other, _)| other.sphere.radius <= caster.sphere.radius * 1.01);
            let mut coincident = nearby.filter(|(other, _)| other.coincides(&caster)).peekable();
            let is_free = coincident.peek().is_none();
            for (other, is_usable) in coincident {
                if *is_usable && other.sphere == caster.sphere && other.material.equals(&caster.material) {
                    other.shapes.extend(&caster.shapes);
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

    /// Whether the surfaces of both spheres are so close everywhere that rounding may swap them.
    fn coincides(&self, other: &Self) -> bool {
        let (a, b) = (self.sphere, other.sphere);
        (a.center - b.center).length() + (a.radius - b.radius).abs() <= COINCIDENT * a.radius
    }

    /// Whether a shape is this sphere or coincides with it exactly.
    pub fn has_shape(&self, shape: u32) -> bool {
        self.shapes.contains(&shape)
    }

    fn new(world_shape: &WorldShape, material: &SpecularMaterial) -> Option<Self> {
        let transform = world_shape.motion.static_transform()?;
        let radius = world_shape.shape.sphere()?.radius * transform.uniform_scale()?;
        let sphere = SpecularSphere { center: transform.origin(), radius };
        Some(Self { sphere, shapes: vec![world_shape.shape_index], material: material.clone() })
    }

    /// Kind of specular path.
    #[inline]
    fn path_kind(&self, is_refracted: bool) -> SpecularPath {
        if is_refracted { SpecularPath::Refracted { ior: self.material.ior } } else { SpecularPath::Reflected }
    }

    /// Throughput of a specular path whose angle of incidence has this `sine`: reflectance, or
    /// transmittance of both interfaces and of the medium between them.
    pub fn throughput(&self, kind: SpecularPath, sine: f32) -> Rgb {
        let scattered = |wo: Vec3, is_up: bool| {
            let numbers = self.material.bsdf.lobe_numbers(wo);
            let deltas = self.material.bsdf.view(wo, numbers.as_ref()).deltas();
            deltas.filter(|delta| (delta.wi.z > 0.0) == is_up).fold(Rgb::BLACK, |sum, delta| sum + delta.weight)
        };
        let SpecularPath::Refracted { ior } = kind else {
            return scattered(Vec3::new(sine, 0.0, cos_from_sin(sine)), true);
        };
        let sin_inside = sine / ior;
        let cos_inside = cos_from_sin(sin_inside);
        let in_and_out = scattered(Vec3::new(sine, 0.0, cos_from_sin(sine)), false)
            * scattered(Vec3::new(sin_inside, 0.0, -cos_inside), true);
        in_and_out * self.material.medium.transmittance(2.0 * self.sphere.radius * cos_inside)
    }

    /// Evaluates the sphere as seen from `to`. The weights are 0 if `to` lies inside the sphere, or
    /// the sphere below the horizon of `to`.
    #[inline]
    fn view_from(&self, context: &LightSampleContext) -> CasterView {
        let SpecularSphere { center, radius } = self.sphere;
        let is_below = context.normal != Vec3::ZERO && context.normal.dot(center - context.point) <= -radius;
        let Some(end) = self.sphere.end_point(context.point).filter(|_| !is_below) else { return CasterView::NONE };
        let one_minus_cos = SpecularSphere::one_minus_cos(end.inverse_distance);
        CasterView {
            weights: self.material.strengths.map(|strength| strength * one_minus_cos),
            toward: end.toward,
            one_minus_cos,
        }
    }
}

/// A caster as seen from a point.
#[derive(Clone, Copy, Debug)]
struct CasterView {
    /// Selection weights of reflection and refraction: strength times solid angle over 2π.
    weights: [f32; 2],
    /// Unit vector from the sphere's center towards the point.
    toward: Vec3,
    /// 1 - cos θ, with θ half the angle that the sphere subtends.
    one_minus_cos: f32,
}

impl CasterView {
    const NONE: Self = Self { weights: [0.0; 2], toward: Vec3::ZERO, one_minus_cos: 0.0 };

    fn weight(&self) -> f32 {
        self.weights[0] + self.weights[1]
    }
}

/// All casters as seen from a point, with their selection weights.
pub struct VisibleCasters {
    views: ArrayVec<CasterView, MAX_CASTERS>,
    /// Sum of the weights.
    total_weight: f32,
}

impl VisibleCasters {
    /// Creates an empty set.
    #[inline(always)]
    pub fn empty() -> Self {
        Self { views: ArrayVec::new(), total_weight: 0.0 }
    }

    /// Selects a caster and a kind of path, and returns both with their probability. The smaller
    /// the total weight is, the more often it returns `None`.
    pub fn pick(&self, u: f32) -> Option<(CasterId, f32)> {
        let all = self.total_weight.max(FULL_WEIGHT);
        let mut target = u * all;
        for (index, view) in (0..).zip(&self.views) {
            let [reflected, refracted] = view.weights;
            if target < reflected {
                return Some((CasterId { index, is_refracted: false }, reflected / all));
            }
            target -= reflected;
            if target < refracted {
                return Some((CasterId { index, is_refracted: true }, refracted / all));
            }
            target -= refracted;
        }
        None
    }

    /// Probability with which [`VisibleCasters::pick`] selects `id`.
    pub fn probability(&self, id: CasterId) -> f32 {
        let view = self.views.get(usize::from(id.index));
        view.map_or(0.0, |view| view.weights[usize::from(id.is_refracted)]) / self.total_weight.max(FULL_WEIGHT)
    }

    /// Fraction of BSDF samples to replace by [`VisibleCasters::sample`].
    pub fn guided_fraction(&self) -> f32 {
        (GUIDED_PER_WEIGHT * self.total_weight).min(MAX_GUIDED)
    }

    /// Samples a direction towards a caster, uniformly within the cone that it subtends.
    pub fn sample(&self, u: Vec2) -> Option<Vec3> {
        let mut target = u.x * self.total_weight;
        for view in &self.views {
            let weight = view.weight();
            if target < weight {
                let u = Vec2::new((target / weight).min(1f32.next_down()), u.y);
                return Some(Frame::around(-view.toward).to_world(warp::uniform_cone(u, view.one_minus_cos)));
            }
            target -= weight;
        }
        None
    }

    /// Density per steradian of [`VisibleCasters::sample`].
    pub fn pdf(&self, direction: Vec3) -> f32 {
        let pdf_of = |view: &CasterView| {
            // The same arithmetic as in sampling, so that rounding cannot put a sampled direction
            // outside its cone.
            let is_in_cone = 1.0 + direction.dot(view.toward) <= view.one_minus_cos + 1e-6;
            (view.weight() > 0.0 && is_in_cone).then(|| view.weight() / (self.total_weight * TAU * view.one_minus_cos))
        };
        self.views.iter().filter_map(pdf_of).sum()
    }
}

impl World {
    /// Caster and kind of path of an id.
    #[inline]
    pub fn caster(&self, id: CasterId) -> Option<(&CausticCaster, SpecularPath)> {
        self.casters.get(usize::from(id.index)).map(|caster| (caster, caster.path_kind(id.is_refracted)))
    }

    /// Whether the world has casters.
    #[inline]
    pub fn has_casters(&self) -> bool {
        !self.casters.is_empty()
    }

    /// Id of the caster that has the shape `shape`, if there is one.
    pub fn caster_of_shape(&self, shape: u32, is_refracted: bool) -> Option<CasterId> {
        let index = self.casters.iter().position(|caster| caster.has_shape(shape))?;
        Some(CasterId { index: index as u16, is_refracted })
    }

    /// Evaluates all casters as seen from `from`.
    #[inline(always)]
    pub fn visible_casters(&self, from: &LightSampleContext) -> VisibleCasters {
        let mut visible_casters = VisibleCasters::empty();
        self.fill_visible_casters(from, &mut visible_casters);
        visible_casters
    }

    /// Writes the result of [`World::visible_casters`] to `visible_casters`, which must be empty.
    /// The structure is too large to return by value cheaply.
    pub fn fill_visible_casters(&self, from: &LightSampleContext, visible_casters: &mut VisibleCasters) {
        let mut total_weight = visible_casters.total_weight;
        for caster in &self.casters {
            let view = caster.view_from(from);
            total_weight = total_weight + view.weights[0] + view.weights[1];
            _ = visible_casters.views.try_push(view);
        }
        visible_casters.total_weight = total_weight;
    }
}

#[cfg(test)]
mod tests;
