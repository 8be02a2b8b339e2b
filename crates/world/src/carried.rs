//! Where points of surfaces are when the same scene is a world at another frame.

use super::{Content, Level, Vertex, World};
use juggler_math::Vec3;
use std::ops::Range;

impl World {
    /// Where the point of a vertex is in `other`, which is the same scene at another frame: it goes along with its shape, at the same
    /// `time` of the shutter. It stays where it is when the entry of the scene that it belongs to is made of more or fewer
    /// shapes there.
    pub fn carried(&self, vertex: &Vertex, time: f32, other: &Self) -> Vec3 {
        let point = vertex.surface.point;
        if self.labels.entries.len() != other.labels.entries.len() {
            return point;
        }
        let entry = self.entry_of(vertex.object) as usize;
        let (here, there) = (self.shapes_of(entry), other.shapes_of(entry));
        let Some(number) = vertex.object.checked_sub(here.start).filter(|_| here.len() == there.len()) else {
            return point;
        };
        let numbers = [vertex.object, there.start + number];
        self.top.carried(&other.top, numbers, vertex.part, point, time).unwrap_or(point)
    }

    /// The numbers of an entry's shapes.
    fn shapes_of(&self, entry: usize) -> Range<u32> {
        let all = u32::try_from(self.top.totals().shapes).unwrap_or(u32::MAX);
        let first = |entry: usize, otherwise: u32| self.labels.entries.get(entry).copied().unwrap_or(otherwise);
        first(entry, 0)..first(entry + 1, all)
    }
}

impl Level {
    /// Where a point, in this level's space, of its shape number `numbers[0]` is in the space of `other`, whose shape is number
    /// `numbers[1]`; nothing where both are not built alike.
    fn carried(&self, other: &Self, numbers: [u32; 2], part: u32, point: Vec3, time: f32) -> Option<Vec3> {
        let [(here, number), (there, other_number)] = [self.find(numbers[0]), other.find(numbers[1])];
        let (from, to) = (here.motion.at(time), there.motion.at(time));
        let local = from.point_to_local(point);
        let moved = match (&here.content, &there.content) {
            (Content::Shape(shape), Content::Shape(other)) => shape.carried(other, part, local, time),
            (Content::Level(level), Content::Level(other)) if level.totals().shapes == other.totals().shapes => {
                level.carried(other, [number, other_number], part, local, time)?
            }
            _ => return None,
        };
        // What stands still is not rounded on its way through its own space.
        Some(if from == to && moved == local { point } else { to.point(moved) })
    }
}
