//! Entries of a geometry's hierarchy: bounding boxes of objects, over the whole shutter interval or
//! over equal segments of it.
//!
//! The box of an object that moves far on a curve is mostly empty. The hierarchy contains such an
//! object once for each segment of time, with the box of that segment; a ray intersects only the
//! entry of its time (Woop, Áfra and Benthin, "STBVH: A Spatial-Temporal BVH for Efficient
//! Multi-Segment Motion Blur", 2017). Hits are the same.

use super::instance::{Instance, LeafItem, SphereKeys};
use super::{Content, Object};
use juggler_math::{Aabb, BuildControl, Motion};

/// Maximum number of segments of an object.
const MAX_SEGMENTS: usize = 256;
/// Number of entries that the segments of all objects of a geometry share.
const MAX_ENTRIES: usize = 1 << 20;
/// Cost of an entry that a ray rejects by its time, relative to an intersection with the object.
const REJECTION_COST: f32 = 0.1;
/// Segments must lower the estimated cost to less than this ratio.
const MIN_GAIN: f32 = 0.7;

/// Entries of a hierarchy.
#[derive(Debug, Default)]
pub struct HierarchyEntries {
    /// Index of the object of each entry.
    pub objects: Vec<u32>,
    /// Bounding box of each entry.
    pub boxes: Vec<Aabb>,
    /// Times from which and to which each entry counts; empty if all count at all times.
    times: Vec<[f32; 2]>,
}

impl HierarchyEntries {
    /// Entries of the objects `bounded`; incomplete if `control` is cancelled. `boxes` holds the bounds
    /// of all objects.
    pub fn new(objects: &[Object], bounded: Vec<u32>, boxes: Vec<Aabb>, control: &BuildControl) -> Self {
        let bounds = |index: &u32| boxes.get(*index as usize).copied().unwrap_or(Aabb::EMPTY);
        let moving = objects.iter().filter(|object| object.motion.moves()).count();
        let limit = (MAX_ENTRIES / moving.max(1)).min(MAX_SEGMENTS);
        if moving == 0 || limit < 2 {
            if bounded.len() == boxes.len() {
                return Self { boxes, objects: bounded, times: Vec::new() };
            }
            return Self { boxes: bounded.iter().map(bounds).collect(), objects: bounded, times: Vec::new() };
        }
        let mut entries = Self::default();
        for index in bounded.into_iter().take_while(|_| !control.is_cancelled()) {
            let segments = objects.get(index as usize).map_or_else(Vec::new, |object| segments(object, limit));
            if segments.is_empty() {
                entries.add(index, bounds(&index), [0.0, 1.0]);
            }
            let count = segments.len() as f32;
            for (segment, bounds) in segments.into_iter().enumerate() {
                entries.add(index, bounds, [segment as f32 / count, (segment + 1) as f32 / count]);
            }
        }
        entries
    }

    /// Leaf entries in the given order of the entries, for the built `objects` of the same geometry.
    pub fn items(&self, order: &[u32], objects: &[Instance], shape_index: impl Fn(u32) -> u32) -> Vec<LeafItem> {
        let item = |entry: &u32| {
            let (object_index, times) = (self.objects[*entry as usize], self.times(*entry as usize));
            LeafItem::new(&objects[object_index as usize], object_index, shape_index(object_index), times)
        };
        order.iter().map(item).collect()
    }

    fn add(&mut self, object: u32, bounds: Aabb, times: [f32; 2]) {
        self.objects.push(object);
        self.boxes.push(bounds);
        self.times.push(times);
    }

    /// Times from which and to which an entry counts; `None` if it counts at all times.
    pub fn times(&self, entry: usize) -> Option<[f32; 2]> {
        self.times.get(entry).copied().filter(|times| *times != [0.0, 1.0])
    }
}

/// Boxes of an object in equal segments of the shutter interval, at most `limit`; empty if one box
/// is as good.
fn segments(object: &Object, limit: usize) -> Vec<Aabb> {
    let (motion, local) = match SphereKeys::from_object(object) {
        Some(SphereKeys::Moving(keys)) => {
            (SphereKeys::motion(&keys), Aabb { min: -juggler_math::Vec3::ONE, max: juggler_math::Vec3::ONE })
        }
        _ => (Some(object.motion.clone()), local_bounds(object)),
    };
    let Some(motion) = motion.filter(Motion::moves) else { return Vec::new() };
    let count = 1 << limit.max(1).ilog2();
    let time = |segment: usize| segment as f32 / count as f32;
    let finest = (0..count).map(|segment| motion.aabb_between(&local, time(segment), time(segment + 1)));
    let mut boxes: Vec<Aabb> = finest.collect();
    let mut best: (f32, Vec<Aabb>) = (f32::INFINITY, Vec::new());
    while boxes.len() > 1 {
        let cost = cost(&boxes);
        if cost < best.0 {
            best = (cost, boxes.clone());
        }
        boxes = boxes.chunks(2).map(|pair| pair.iter().copied().fold(Aabb::EMPTY, Aabb::union)).collect();
    }
    if best.0 < MIN_GAIN * cost(&boxes) { best.1 } else { Vec::new() }
}

fn local_bounds(object: &Object) -> Aabb {
    match &object.content {
        Content::Shape(shape) => shape.bounds(),
        Content::Geometry(geometry) => geometry.bounds(),
    }
}

/// Estimated cost of the entries of one object: the probability that a ray hits a box, in
/// proportion to its area, times the cost of the object if the time fits, else of the rejection.
fn cost(boxes: &[Aabb]) -> f32 {
    let area: f32 = boxes.iter().map(Aabb::area).sum();
    area * (REJECTION_COST + 1.0 / boxes.len() as f32)
}
