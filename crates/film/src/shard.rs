//! Splits an image into shards of about equal cost. The split is a pure function, so that machines
//! agree on it without communication.
//!
//! Tiles are sorted in Morton order (Morton, "A computer oriented geodetic data base", 1966), in
//! which neighbors are close to each other, and dealt in rounds: each round gives every shard one
//! tile of a neighborhood, in an order derived from a hash of the round. Hence neither an expensive
//! corner nor a regular pattern falls to a single shard. If tiles are few, their samples are split
//! as well, at block boundaries. Units of lower cost (tiles at the edge, the remaining samples) are
//! dealt last, to the shards with the least load.

mod units;

pub use units::{UnitRun, Units};

use crate::partial_render::{RenderDescription, Stop};
use juggler_camera::film::{BLOCK_SAMPLES, Film, Rect, TILE_EDGE, Tiling};
use juggler_math::hash;
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::ops::Range;

/// Minimum number of units per shard, so that their costs average out.
const MIN_UNITS: u64 = 8;
/// Maximum number of units to aim for when splitting samples.
const MAX_UNITS: u64 = 1 << 20;

/// A range of samples of one tile, the unit of work.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WorkUnit {
    /// Number of the tile in the region's layout.
    pub tile: u64,
    /// Range of samples.
    pub samples: Range<u32>,
}

/// The work to split into shards.
#[derive(Clone, Debug, PartialEq)]
pub struct Work {
    /// Layout of the tiles.
    pub tiling: Tiling,
    /// Restricts the work to tiles that overlap this rectangle.
    pub crop: Option<Rect>,
    /// Samples of each pixel.
    pub samples: Range<u32>,
    /// Rule that ends the render. Samples are split only if their number does; noise and time
    /// limits apply to whole tiles.
    pub stop: Stop,
}

impl Work {
    /// The work of a partial render's image.
    pub fn from_description(description: &RenderDescription) -> Self {
        Self {
            tiling: description.tiling(),
            crop: description.shard.crop,
            samples: description.shard.samples.clone(),
            stop: description.stop,
        }
    }

    /// Units of shard `index` of `count`, sorted by tile and sample. Shards are disjoint and cover
    /// all work.
    pub fn shard(&self, index: u32, count: u32) -> Vec<WorkUnit> {
        let mut units: Vec<WorkUnit> =
            self.assign(count).into_iter().filter(|(shard, _)| *shard == index).map(|(_, unit)| unit).collect();
        units.sort_unstable_by_key(|unit| (unit.tile, unit.samples.start));
        units
    }

    /// Assigns every unit to one of `count` shards.
    pub fn assign(&self, count: u32) -> Vec<(u32, WorkUnit)> {
        let units = self.units(count);
        // If there are more shards than units, the last shards stay empty.
        let busy = u64::from(count).min(units.len() as u64) as u32;
        let mut queue: BinaryHeap<_> = (0..busy).map(|shard| Reverse((0, hash::combine(0, shard), 0, shard))).collect();
        let mut assigned = Vec::with_capacity(units.len());
        for (cost, unit) in units {
            let Some(Reverse((load, _, round, shard))) = queue.pop() else { break };
            let round: u32 = round + 1;
            queue.push(Reverse((load + cost, hash::combine(round, shard), round, shard)));
            assigned.push((shard, unit));
        }
        assigned
    }

    /// Units that `film` lacks, cut from those of `count` shards, by descending cost, then in Morton
    /// order. A noise limit decides how many samples a tile needs, so a tile that has samples counts
    /// as finished.
    pub fn missing(&self, film: &Film, count: u32) -> Vec<WorkUnit> {
        let lacking = |unit: WorkUnit| {
            let tile = film.tile_of(unit.tile);
            let is_finished = self.stop != Stop::Samples && tile.as_ref().is_some_and(|tile| !tile.is_empty());
            let ranges = match tile {
                Some(tile) if !is_finished => tile.all_missing(unit.samples),
                _ => Vec::new(),
            };
            ranges.into_iter().map(move |samples| WorkUnit { tile: unit.tile, samples })
        };
        self.units(count).into_iter().flat_map(|(_, unit)| lacking(unit)).collect()
    }

    /// Units with their costs in pixel samples, by descending cost, then in Morton order.
    fn units(&self, count: u32) -> Vec<(u64, WorkUnit)> {
        let mut tiles: Vec<(u64, u64, u64)> = (0..self.tiling.tile_count())
            .filter_map(|number| Some((number, self.tiling.tile(number)?)))
            .filter(|(_, pixels)| self.crop.is_none_or(|crop| crop.intersection(pixels).area() > 0))
            .map(|(number, pixels)| (z_order(pixels.x / TILE_EDGE, pixels.y / TILE_EDGE), number, pixels.area()))
            .collect();
        tiles.sort_unstable();
        let ranges = self.split_samples(tiles.len() as u64, count);
        let unit = |tile: u64, area: u64, samples: &Range<u32>| {
            (area * u64::from(samples.end - samples.start), WorkUnit { tile, samples: samples.clone() })
        };
        let mut units: Vec<(u64, WorkUnit)> = tiles
            .into_iter()
            .flat_map(|(_, tile, area)| ranges.iter().map(move |samples| unit(tile, area, samples)))
            .collect();
        units.sort_by_key(|(cost, _)| Reverse(*cost));
        units
    }

    /// Splits a tile's samples into nodes of the block tree, as long as the number of units allows.
    fn split_samples(&self, tiles: u64, count: u32) -> Vec<Range<u32>> {
        let Range { start, end } = self.samples;
        if start >= end {
            return Vec::new();
        }
        let target = (MIN_UNITS * u64::from(count)).min(MAX_UNITS);
        let first = start / BLOCK_SAMPLES;
        let blocks = end.div_ceil(BLOCK_SAMPLES) - first;
        let number = |length: u32| u64::from(blocks.div_ceil(length)) * tiles;
        let mut length = blocks.next_power_of_two();
        while length > 1 && number(length) < target {
            length /= 2;
        }
        if self.stop != Stop::Samples || number(blocks) >= target {
            return std::iter::once(start..end).collect();
        }
        let from =
            (first / length..end.div_ceil(BLOCK_SAMPLES).div_ceil(length)).map(|node| node * length * BLOCK_SAMPLES);
        from.map(|from| from.max(start)..from.saturating_add(length * BLOCK_SAMPLES).min(end)).collect()
    }
}

/// Morton code: interleaves the bits of column and row.
fn z_order(column: u32, row: u32) -> u64 {
    let spread = |value: u32| {
        let mut x = u64::from(value);
        for (shift, mask) in [
            (16, 0x0000_ffff_0000_ffff),
            (8, 0x00ff_00ff_00ff_00ff),
            (4, 0x0f0f_0f0f_0f0f_0f0f),
            (2, 0x3333_3333_3333_3333),
            (1, 0x5555_5555_5555_5555),
        ] {
            x = (x | x << shift) & mask;
        }
        x
    };
    spread(column) | spread(row) << 1
}

/// Expands a crop to whole tiles of `region`, since partial renders are split at tile boundaries.
pub fn whole_tiles(region: &Rect, crop: &Rect) -> Rect {
    let down = |at: u32, least: u32| (at - at % TILE_EDGE).max(least);
    let up = |at: u32, most: u32| at.div_ceil(TILE_EDGE).saturating_mul(TILE_EDGE).min(most);
    let (x, y) = (down(crop.x, region.x), down(crop.y, region.y));
    let right = up(crop.x.saturating_add(crop.width), region.x.saturating_add(region.width));
    let bottom = up(crop.y.saturating_add(crop.height), region.y.saturating_add(region.height));
    Rect { x, y, width: right.saturating_sub(x), height: bottom.saturating_sub(y) }
}

/// A shard's portion of one frame of an animation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameShard {
    /// Frame number.
    pub frame: u32,
    /// Index of the frame's shard, 0 to `count` - 1.
    pub index: u32,
    /// Number of shards of the frame; 1 if the frame is not split.
    pub count: u32,
}

/// Frames of shard `index` of `count`: as many whole frames as divide evenly, in turn, and a shard
/// of each remaining frame.
pub fn frames(frames: Range<u32>, index: u32, count: u32) -> Vec<FrameShard> {
    let length = frames.end.saturating_sub(frames.start);
    let whole = length.checked_div(count).unwrap_or(0) * count;
    let shard = |offset: u32| FrameShard { frame: frames.start + offset, index, count };
    let own = (0..whole).skip(index as usize).step_by(count.max(1) as usize);
    own.map(|offset| FrameShard { index: 0, count: 1, ..shard(offset) }).chain((whole..length).map(shard)).collect()
}

#[cfg(test)]
mod tests;
