//! Counts for reports: what is placed, and what is stored for it.

use super::merged::Merged;
use super::{Content, Level};
use juggler_shape::AnyShape;
use std::collections::BTreeSet;
use std::sync::Arc;

/// Counts for reports.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Geometry {
    /// Shapes, those of shared levels counted as often as they are placed.
    pub shapes: u64,
    /// Triangles of all meshes, polygons and triangles, counted as often as they are placed.
    pub triangles: u64,
    /// Triangles that are stored.
    pub unique_triangles: u64,
    /// Instances of shared levels, those within others counted as often as they are placed.
    pub instances: u64,
    /// Lights.
    pub lights: usize,
    /// Shapes that emit light and are sampled as lights, those of shared levels counted as often as they are placed.
    pub emitting_shapes: usize,
    /// Bytes of shapes.
    pub geometry_bytes: usize,
    /// Bytes of the hierarchies, over the objects and within meshes.
    pub bvh_bytes: usize,
    /// Bytes of what is sampled as light: surfaces that emit, and the tree over all emitters.
    pub emitter_bytes: usize,
    /// Bytes of the pictures that textures show.
    pub texture_bytes: usize,
    /// Bytes of the background's picture and tables.
    pub background_bytes: usize,
}

impl Geometry {
    /// Of everything below `top`.
    pub fn of(top: &Level, lights: usize) -> Self {
        let totals = top.totals();
        let mut geometry = Self {
            shapes: totals.shapes,
            triangles: totals.triangles,
            instances: totals.instances,
            lights,
            ..Self::default()
        };
        let mut stored = Stored::default();
        for level in levels(top) {
            geometry.bvh_bytes += level.bvh.bytes() + level.merged.as_ref().map_or(0, Merged::bytes);
            geometry.geometry_bytes += size_of_val(level.objects.as_slice()) + size_of_val(level.items.as_slice());
            let shapes = level.objects.iter().filter_map(|placed| placed.content.as_shape());
            shapes.for_each(|shape| stored.add(shape));
        }
        geometry.unique_triangles = stored.triangles;
        geometry.geometry_bytes += stored.bytes;
        geometry.bvh_bytes += stored.bvh_bytes;
        geometry
    }
}

/// Shapes, each counted once however many objects share it.
#[derive(Default)]
struct Stored {
    shapes: BTreeSet<usize>,
    /// The arrays of meshes, which clones of a mesh share.
    arrays: BTreeSet<usize>,
    triangles: u64,
    bytes: usize,
    bvh_bytes: usize,
}

impl Stored {
    fn add(&mut self, shape: &Arc<AnyShape>) {
        if Arc::strong_count(shape) > 1 && !self.shapes.insert(Arc::as_ptr(shape).addr()) {
            return;
        }
        self.bytes += size_of::<AnyShape>();
        if let AnyShape::Mesh(mesh) = &**shape
            && let Some(data) = mesh.data()
            && !self.arrays.insert(std::ptr::from_ref(data).addr())
        {
            return;
        }
        self.triangles += shape.triangles() as u64;
        self.bytes += shape.heap_bytes();
        self.bvh_bytes += shape.bvh_bytes();
    }
}

/// The level and all levels below it, each once.
pub fn levels(top: &Level) -> Vec<&Level> {
    let (mut found, mut seen, mut next) = (vec![top], BTreeSet::new(), 0);
    while let Some(level) = found.get(next).copied() {
        next += 1;
        if level.totals().instances == 0 {
            continue;
        }
        for placed in &level.objects {
            if let Content::Level(below) = &placed.content
                && seen.insert(Arc::as_ptr(below).addr())
            {
                found.push(below);
            }
        }
    }
    found
}
