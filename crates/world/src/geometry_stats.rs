//! Counts and memory use of the geometry, for reports.

use super::instance::Instance;
use super::merged_meshes::MergedMeshes;
use super::{Content, Geometry};
use juggler_shape::{AnyShape, Mesh};
use std::collections::BTreeSet;
use std::sync::Arc;

/// Counts and memory use of the geometry. Counts include the contents of every instance unless
/// noted otherwise.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GeometryStats {
    /// Number of shapes.
    pub shapes: u64,
    /// Number of triangles, of meshes, polygons and triangle shapes.
    pub triangles: u64,
    /// Number of stored triangles, each counted once.
    pub unique_triangles: u64,
    /// Number of instances, including nested ones.
    pub instances: u64,
    /// Number of lights.
    pub lights: usize,
    /// Number of shapes that emit light and are sampled as lights.
    pub emitting_shapes: usize,
    /// Memory of shapes, in bytes.
    pub geometry_bytes: usize,
    /// Memory of all bounding volume hierarchies, in bytes.
    pub bvh_bytes: usize,
    /// Memory of emitters and the light tree, in bytes.
    pub emitter_bytes: usize,
    /// Memory of texture images, in bytes.
    pub texture_bytes: usize,
    /// Memory of the background's image and sampling tables, in bytes.
    pub background_bytes: usize,
}

impl GeometryStats {
    /// Counts everything below `top`.
    pub fn from_geometry(top: &Geometry, lights: usize) -> Self {
        let totals = top.totals();
        let mut stats = Self {
            shapes: totals.shapes,
            triangles: totals.triangles,
            instances: totals.instances,
            lights,
            ..Self::default()
        };
        let mut stored = StoredShapes::default();
        for geometry in geometries(top) {
            stats.bvh_bytes += geometry.bvh.bytes() + geometry.merged_meshes.as_ref().map_or(0, MergedMeshes::bytes);
            stats.geometry_bytes += size_of_val(geometry.objects.as_slice()) + size_of_val(geometry.items.as_slice());
            stats.geometry_bytes += geometry.attributes.bytes();
            stats.geometry_bytes += heap_bytes(&geometry.objects);
            let shapes = geometry.objects.iter().filter_map(|instance| instance.content.as_shape());
            shapes.for_each(|shape| stored.add(shape));
        }
        stats.unique_triangles = stored.triangles;
        stats.geometry_bytes += stored.bytes;
        stats.bvh_bytes += stored.bvh_bytes;
        stats
    }
}

/// Bytes beside the instances.
fn heap_bytes(instances: &[Instance]) -> usize {
    let first = instances.first().map_or(0, |first| first.heap_bytes(None));
    instances.iter().skip(1).zip(instances).fold(first, |sum, (next, previous)| sum + next.heap_bytes(Some(previous)))
}

/// Shapes counted once, however many objects share them.
#[derive(Default)]
struct StoredShapes {
    shapes: BTreeSet<usize>,
    /// Addresses of mesh arrays, which clones of a mesh share.
    arrays: BTreeSet<usize>,
    triangles: u64,
    bytes: usize,
    bvh_bytes: usize,
}

impl StoredShapes {
    fn add(&mut self, shape: &Arc<AnyShape>) {
        if Arc::strong_count(shape) > 1 && !self.shapes.insert(Arc::as_ptr(shape).addr()) {
            return;
        }
        self.bytes += size_of::<AnyShape>();
        if let Some(data) = shape.mesh().and_then(Mesh::data)
            && !self.arrays.insert(std::ptr::from_ref(data).addr())
        {
            return;
        }
        self.triangles += shape.triangles() as u64;
        self.bytes += shape.heap_bytes();
        self.bvh_bytes += shape.bvh_bytes();
    }
}

/// Collects a geometry and all geometries below it, each once.
pub fn geometries(top: &Geometry) -> Vec<&Geometry> {
    let (mut geometries, mut visited, mut next) = (vec![top], BTreeSet::new(), 0);
    while let Some(geometry) = geometries.get(next).copied() {
        next += 1;
        if geometry.totals().instances == 0 {
            continue;
        }
        for instance in &geometry.objects {
            if let Content::Geometry(below) = &instance.content
                && visited.insert(Arc::as_ptr(below).addr())
            {
                geometries.push(below);
            }
        }
    }
    geometries
}
