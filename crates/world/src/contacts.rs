//! Regions in which a transparent solid may touch other surfaces. Outside of them, a surface of the
//! solid has no other one at its place, so that a path crosses it without a search.

use super::{Content, Geometry, Vertex};
use crate::instance::Instance;
use arrayvec::ArrayVec;
use juggler_material::MaterialTable;
use juggler_math::{Aabb, Vec3};
use juggler_shape::AnyShape;

/// Maximum number of pairs of a solid and another object that are compared.
const MAX_PAIRS: usize = 1 << 22;
/// Maximum number of triangles of a mesh of which each is compared.
const MAX_TRIANGLES: usize = 1 << 12;
/// Maximum number of regions of a solid; more are merged.
const MAX_REGIONS: usize = 4;
/// Width of the margin around a solid, as a fraction of its largest coordinate.
const MARGIN: f32 = 1.0 / 4096.0;

/// Contact regions of convex solids.
#[derive(Clone, Debug, Default)]
pub struct Contacts {
    /// Each solid by the index of its shape, in ascending order.
    solids: Vec<(u32, Regions)>,
}

/// Boxes in world space that contain all points at which a solid may touch another surface.
#[derive(Clone, Debug)]
struct Regions {
    /// Distance between surfaces that the boxes allow for.
    margin: f32,
    boxes: ArrayVec<Aabb, MAX_REGIONS>,
}

impl Contacts {
    /// Compares each convex solid that transmits light with all other objects of the top level.
    pub fn new(top: &Geometry, materials: &MaterialTable) -> Self {
        let is_solid = |instance: &Instance| {
            let transmits = |id| materials.interior(id).is_some() || materials.is_transparent(id);
            let transmits = instance.material().is_some_and(transmits);
            transmits && matches!(&instance.content, Content::Shape(shape) if is_convex(shape))
        };
        let solids: Vec<usize> = (0..top.objects.len()).filter(|i| is_solid(&top.objects[*i])).collect();
        if solids.len().saturating_mul(top.objects.len()) > MAX_PAIRS {
            return Self::default();
        }
        let bounds: Vec<Aabb> = if solids.is_empty() { Vec::new() } else { top.objects.iter().map(extent).collect() };
        let regions = |solid: usize| {
            let coordinates = bounds[solid].min.abs().max(bounds[solid].max.abs());
            let margin = coordinates.max_element() * MARGIN;
            let own = bounds[solid].grown(margin);
            let mut regions = Regions { margin, boxes: ArrayVec::new() };
            for (other, bounds) in bounds.iter().enumerate() {
                if other != solid && !intersection(&own, bounds).is_empty() {
                    regions.add_object(&top.objects[other], &own, bounds);
                }
            }
            regions
        };
        Self { solids: solids.into_iter().map(|solid| (top.first_shape(solid as u32), regions(solid))).collect() }
    }

    /// Whether no other surface is within the distance `reach` of a vertex.
    #[inline]
    pub fn is_apart(&self, vertex: &Vertex, reach: f32) -> bool {
        let Ok(index) = self.solids.binary_search_by_key(&vertex.shape, |(shape, _)| *shape) else { return false };
        let regions = &self.solids[index].1;
        reach <= regions.margin && !regions.boxes.iter().any(|region| region.contains(vertex.surface.point))
    }
}

impl Regions {
    /// Adds the surfaces of an object inside the solid's bounding box `own`.
    fn add_object(&mut self, object: &Instance, own: &Aabb, bounds: &Aabb) {
        let Content::Shape(shape) = &object.content else { return self.add(own, bounds) };
        match (object.motion.still(), shape.mesh().and_then(|mesh| mesh.data())) {
            (Some(transform), _) if shape.is_plane() => {
                let section = section(own, |point| transform.point_to_local(point).y);
                self.add(own, &section.grown(self.margin));
            }
            (Some(transform), Some(mesh)) if mesh.triangles.len() <= MAX_TRIANGLES => {
                for corners in &mesh.triangles {
                    let corner = |index: &u32| mesh.positions.get(*index as usize).copied();
                    let corners = corners.iter().filter_map(corner).map(|corner| transform.point(corner));
                    self.add(own, &Aabb::from_points(corners).grown(self.margin));
                }
            }
            _ => self.add(own, bounds),
        }
    }

    /// Adds the part of a box inside the solid's bounding box `own`. If there are too many boxes,
    /// grows the one whose area grows the least.
    fn add(&mut self, own: &Aabb, bounds: &Aabb) {
        let region = intersection(own, &bounds.grown(self.margin));
        if region.is_empty() {
            return;
        }
        if self.boxes.try_push(region).is_ok() {
            return;
        }
        let growth = |other: &Aabb| other.union(region).area() - other.area();
        if let Some(nearest) = self.boxes.iter_mut().min_by(|a, b| growth(a).total_cmp(&growth(b))) {
            *nearest = nearest.union(region);
        }
    }
}

/// Whether the surface of a shape nowhere touches itself.
fn is_convex(shape: &AnyShape) -> bool {
    matches!(shape, AnyShape::Sphere(_) | AnyShape::Cuboid(_))
}

/// Bounding box of an object over the shutter interval, which may be infinite.
fn extent(instance: &Instance) -> Aabb {
    let bounds = instance.content.bounds(&instance.motion);
    if instance.content.is_bounded_by(&bounds) { bounds } else { Aabb::INFINITE }
}

/// Points that two boxes have in common.
fn intersection(a: &Aabb, b: &Aabb) -> Aabb {
    Aabb { min: a.min.max(b.min), max: a.max.min(b.max) }
}

/// Bounding box of the section of a box with the plane on which `height`, a linear function, is 0.
fn section(bounds: &Aabb, height: impl Fn(Vec3) -> f32) -> Aabb {
    let corners = bounds.corners().map(|corner| (corner, height(corner)));
    let mut section = Aabb::EMPTY;
    for (from, from_height) in &corners {
        for (to, to_height) in &corners {
            // Diagonals of the box cross the plane inside the section.
            if *from_height <= 0.0 && *to_height >= 0.0 {
                let range = to_height - from_height;
                let fraction = if range > 0.0 { -from_height / range } else { 0.0 };
                section = section.with_point(*from + (*to - *from) * fraction);
            }
        }
    }
    section
}

#[cfg(test)]
mod tests;
