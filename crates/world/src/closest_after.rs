//! Nearest hit behind another hit of the same ray. Surfaces at one place are passed one by one,
//! without moving the origin of the ray, so none of them is lost.

use super::geometry::Geometry;
use super::instance::{Instance, LeafItem, is_within};
use super::{Content, Vertex, World, WorldHit};
use juggler_bvh::Leaf;
use juggler_math::Ray;
use juggler_shape::{Mesh, intersect_sphere};
use std::cmp::Ordering;
use std::ops::Range;

/// Place of a hit in the order of all hits along a ray: by distance, at equal distance by shape, and
/// within a shape by primitive. Instances preserve distances, so keys compare across levels.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct HitKey {
    /// Distance along the ray, in units of the length of its direction.
    pub t: f32,
    /// Index of the shape, counting the contents of every instance.
    pub shape: u32,
    /// Index of the triangle or face within the shape.
    pub primitive: u32,
}

impl HitKey {
    /// Key of the hit at `vertex`, at the distance `t`.
    #[inline]
    pub fn new(t: f32, vertex: &Vertex) -> Self {
        Self { t, shape: vertex.shape, primitive: vertex.primitive }
    }

    /// Distance and primitive up to which hits of the shape of index `shape` are passed; without a
    /// primitive, hits at the distance are not.
    #[inline]
    fn within(&self, shape: u32) -> (f32, Option<u32>) {
        match shape.cmp(&self.shape) {
            Ordering::Less => (self.t.next_up(), None),
            Ordering::Equal => (self.t, Some(self.primitive)),
            Ordering::Greater => (self.t, None),
        }
    }

    /// The ray behind all hits of the shape of index `shape` up to this key. A shape that is no mesh
    /// has one hit at a distance.
    #[inline]
    fn clip(&self, ray: &Ray, shape: u32) -> Ray {
        let t_min = if shape > self.shape { self.t } else { self.t.next_up() };
        Ray { t_min, ..*ray }
    }
}

impl WorldHit {
    /// Place of this hit in the order of hits along the ray.
    #[inline]
    pub fn key(&self) -> HitKey {
        HitKey { t: self.hit.t, shape: self.shape, primitive: self.hit.primitive }
    }
}

/// Leaf visitor that keeps the nearest hit behind a key.
struct NearestAfter<'a> {
    geometry: &'a Geometry,
    key: HitKey,
    /// Index of the geometry's first shape.
    first: u32,
    hit: &'a mut WorldHit,
}

impl Leaf for NearestAfter<'_> {
    fn closest(&mut self, _lane: usize, ray: &mut Ray, range: Range<u32>) {
        for item in &self.geometry.items[range.start as usize..range.end as usize] {
            item.closest_after(&self.geometry.objects, ray, &self.key, self.first, self.hit);
        }
    }

    fn any(&mut self, _lane: usize, _ray: &Ray, _range: Range<u32>) -> bool {
        false
    }
}

impl LeafItem {
    fn closest_after(&self, objects: &[Instance], ray: &mut Ray, key: &HitKey, first: u32, best: &mut WorldHit) {
        match *self {
            Self::Sphere { center, radius, shape_index } => {
                if let Some(hit) = intersect_sphere(center, radius, &key.clip(ray, first + shape_index)) {
                    best.keep_nearer(hit, first + shape_index, ray);
                }
            }
            Self::Shape { object_index, shape_index } | Self::Geometry { object_index, shape_index } => {
                objects[object_index as usize].closest_after(ray, key, first + shape_index, best);
            }
            Self::Segment { times, object_index, shape_index } => {
                if is_within(ray, times) {
                    objects[object_index as usize].closest_after(ray, key, first + shape_index, best);
                }
            }
        }
    }
}

impl Instance {
    /// Replaces `best` by a nearer hit behind `key`. `shape_index` is the index of the object's first
    /// shape.
    fn closest_after(&self, ray: &mut Ray, key: &HitKey, shape_index: u32, best: &mut WorldHit) {
        match &self.content {
            Content::Geometry(geometry) => {
                let mut local = self.ray_to_object(ray);
                geometry.closest_after(&mut local, key, shape_index, best);
                ray.t_max = local.t_max;
            }
            Content::Shape(shape) if shape.mesh().is_some() => {
                let after = |mesh: &Mesh| mesh.intersect_after(&self.ray_to_object(ray), key.within(shape_index));
                if let Some(hit) = shape.mesh().and_then(after) {
                    best.keep_nearer(hit, shape_index, ray);
                }
            }
            Content::Shape(_) => {
                let mut clipped = key.clip(ray, shape_index);
                self.closest(&mut clipped, shape_index, best);
                ray.t_max = clipped.t_max;
            }
        }
    }
}

impl Geometry {
    /// Replaces `best` by a nearer hit behind `key`. `first` is the index of this geometry's first
    /// shape.
    fn closest_after(&self, ray: &mut Ray, key: &HitKey, first: u32, best: &mut WorldHit) {
        // A triangle may be hit an ulp beyond its farthest corner, so its own test excludes the key.
        ray.t_min = key.t * (1.0 - 8.0 * f32::EPSILON);
        for object_index in &self.unbounded {
            let shape_index = first + self.first_shape(*object_index);
            self.objects[*object_index as usize].closest_after(ray, key, shape_index, best);
        }
        self.bvh.closest(ray, &mut NearestAfter { geometry: self, key: *key, first, hit: best });
        for large_mesh in &self.large_meshes {
            if large_mesh.bounds.clip(ray).is_some() {
                let instance = &self.objects[large_mesh.object_index as usize];
                instance.closest_after(ray, key, first + large_mesh.shape_index, best);
            }
        }
        if let Some((hit, shape_index)) =
            self.merged_meshes.as_ref().and_then(|merged_meshes| merged_meshes.closest_after(ray, key))
        {
            best.keep_nearer(hit, shape_index, ray);
        }
    }
}

impl World {
    /// Finds the first hit behind `key` in the order of hits along the ray, up to the ray's `t_max`,
    /// and shortens the ray to it.
    pub fn closest_after(&self, ray: &mut Ray, key: &HitKey) -> WorldHit {
        let mut hit = WorldHit::NONE;
        self.top.closest_after(ray, key, 0, &mut hit);
        hit
    }
}
