//! Positions of surface points at another frame, for motion vectors.

use super::{Content, Geometry, Vertex, World};
use juggler_math::Vec3;
use std::ops::Range;

impl World {
    /// World-space position of a vertex in `other`, the same scene at another frame. The point
    /// moves with its shape, at the same `time` within the shutter interval. It keeps its position
    /// if its scene entry has another number of shapes there.
    pub fn reproject(&self, vertex: &Vertex, time: f32, other: &Self) -> Vec3 {
        let point = vertex.surface.point;
        if self.labels.entries.len() != other.labels.entries.len() {
            return point;
        }
        let entry = self.entry_of(vertex.shape) as usize;
        let (here, there) = (self.shapes_of(entry), other.shapes_of(entry));
        let Some(offset) = vertex.shape.checked_sub(here.start).filter(|_| here.len() == there.len()) else {
            return point;
        };
        let shapes = [vertex.shape, there.start + offset];
        self.top.reproject(&other.top, shapes, vertex.primitive, point, time).unwrap_or(point)
    }

    /// Shape indices of a scene entry.
    fn shapes_of(&self, entry: usize) -> Range<u32> {
        let all = u32::try_from(self.top.totals().shapes).unwrap_or(u32::MAX);
        let first = |entry: usize, otherwise: u32| self.labels.entries.get(entry).copied().unwrap_or(otherwise);
        first(entry, 0)..first(entry + 1, all)
    }
}

impl Geometry {
    /// Position in `other` of a point of the shape `shapes[0]`, which is the shape `shapes[1]`
    /// there; both in their geometry's space. `None` if the geometries differ in structure.
    fn reproject(&self, other: &Self, shapes: [u32; 2], primitive: u32, point: Vec3, time: f32) -> Option<Vec3> {
        let [(here, shape), (there, other_shape)] = [self.find(shapes[0]), other.find(shapes[1])];
        let (from, to) = (here.motion.at(time), there.motion.at(time));
        let local = from.point_to_local(point);
        let local_there = match (&here.content, &there.content) {
            (Content::Shape(shape), Content::Shape(other)) => shape.reproject(other, primitive, local, time),
            (Content::Geometry(geometry), Content::Geometry(other))
                if geometry.totals().shapes == other.totals().shapes =>
            {
                geometry.reproject(other, [shape, other_shape], primitive, local, time)?
            }
            _ => return None,
        };
        // Avoid rounding by the round trip through object space if nothing moves.
        Some(if from == to && local_there == local { point } else { to.point(local_there) })
    }
}
