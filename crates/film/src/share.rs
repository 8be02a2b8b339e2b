//! How a picture is cut into shares that cost about the same: a pure function, so that machines which never speak to
//! each other agree.
//!
//! Tiles are put in Z order (Morton, "A computer oriented geodetic data base", 1966), in which neighbours are near each
//! other, and dealt like cards: each round gives every share one tile of a neighbourhood, in an order that a hash of
//! the round decides. So neither a costly corner nor a pattern as regular as the dealing falls to one share. Where tiles
//! are few, their samples are cut too, between blocks. What costs less (tiles at the edge, the rest of the samples)
//! is dealt last, to those who have least.

use crate::part::{Description, Stop};
use juggler_camera::film::{BLOCK, Layout, Rect, TILE};
use juggler_math::hash;
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::ops::Range;

/// Units that each share should have at least, so that their costs even out.
const UNITS: u64 = 8;
/// Most units that samples are cut into.
const MAX_UNITS: u64 = 1 << 20;

/// Samples of a tile that are rendered together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unit {
    /// Number of the tile in the region's layout.
    pub tile: u64,
    /// Which samples.
    pub samples: Range<u32>,
}

/// What there is to share.
#[derive(Clone, Debug, PartialEq)]
pub struct Work {
    /// The tiles.
    pub layout: Layout,
    /// Only tiles in here, when there is one.
    pub crop: Option<Rect>,
    /// The samples of each pixel.
    pub samples: Range<u32>,
    /// Samples are only cut when their number ends the picture: noise and time are judged tile by tile.
    pub stop: Stop,
}

impl Work {
    /// What the shares of a part's picture are cut from.
    pub fn of(description: &Description) -> Self {
        Self {
            layout: description.layout(),
            crop: description.share.crop,
            samples: description.share.samples.clone(),
            stop: description.stop,
        }
    }

    /// The units of share `index` of `count`, by tile and sample. All shares are disjoint and together everything.
    pub fn share(&self, index: u32, count: u32) -> Vec<Unit> {
        let mut units: Vec<Unit> =
            self.deal(count).into_iter().filter(|(share, _)| *share == index).map(|(_, unit)| unit).collect();
        units.sort_unstable_by_key(|unit| (unit.tile, unit.samples.start));
        units
    }

    /// Every unit, with the share of `count` that it falls to.
    pub fn deal(&self, count: u32) -> Vec<(u32, Unit)> {
        let units = self.units(count);
        // With more shares than units the last ones have nothing to do.
        let busy = u64::from(count).min(units.len() as u64) as u32;
        let mut hands: BinaryHeap<_> = (0..busy).map(|share| Reverse((0, hash::combine(0, share), 0, share))).collect();
        let mut dealt = Vec::with_capacity(units.len());
        for (cost, unit) in units {
            let Some(Reverse((load, _, round, share))) = hands.pop() else { break };
            let round: u32 = round + 1;
            hands.push(Reverse((load + cost, hash::combine(round, share), round, share)));
            dealt.push((share, unit));
        }
        dealt
    }

    /// Units with their costs in samples of pixels, the dearest first, then in Z order.
    fn units(&self, count: u32) -> Vec<(u64, Unit)> {
        let mut tiles: Vec<(u64, u64, u64)> = (0..self.layout.tiles())
            .filter_map(|number| Some((number, self.layout.tile(number)?)))
            .filter(|(_, pixels)| self.crop.is_none_or(|crop| crop.intersection(pixels).area() > 0))
            .map(|(number, pixels)| (z_order(pixels.x / TILE, pixels.y / TILE), number, pixels.area()))
            .collect();
        tiles.sort_unstable();
        let pieces = self.pieces(tiles.len() as u64, count);
        let unit = |tile: u64, area: u64, samples: &Range<u32>| {
            (area * u64::from(samples.end - samples.start), Unit { tile, samples: samples.clone() })
        };
        let mut units: Vec<(u64, Unit)> = tiles
            .into_iter()
            .flat_map(|(_, tile, area)| pieces.iter().map(move |samples| unit(tile, area, samples)))
            .collect();
        units.sort_by_key(|(cost, _)| Reverse(*cost));
        units
    }

    /// The samples of a tile, cut into nodes of the tree of blocks: as long ones as give enough units.
    fn pieces(&self, tiles: u64, count: u32) -> Vec<Range<u32>> {
        let Range { start, end } = self.samples;
        if start >= end {
            return Vec::new();
        }
        let wanted = (UNITS * u64::from(count)).min(MAX_UNITS);
        let first = start / BLOCK;
        let blocks = end.div_ceil(BLOCK) - first;
        let number = |length: u32| u64::from(blocks.div_ceil(length)) * tiles;
        let mut length = blocks.next_power_of_two();
        while length > 1 && number(length) < wanted {
            length /= 2;
        }
        if self.stop != Stop::Samples || number(blocks) >= wanted {
            return std::iter::once(start..end).collect();
        }
        let from = (first / length..end.div_ceil(BLOCK).div_ceil(length)).map(|piece| piece * length * BLOCK);
        from.map(|from| from.max(start)..from.saturating_add(length * BLOCK).min(end)).collect()
    }
}

/// Bits of column and row by turns.
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

/// A crop of a region, widened to whole tiles: parts are cut between tiles only.
pub fn whole_tiles(region: &Rect, crop: &Rect) -> Rect {
    let down = |at: u32, least: u32| (at - at % TILE).max(least);
    let up = |at: u32, most: u32| at.div_ceil(TILE).saturating_mul(TILE).min(most);
    let (x, y) = (down(crop.x, region.x), down(crop.y, region.y));
    let right = up(crop.x.saturating_add(crop.width), region.x.saturating_add(region.width));
    let bottom = up(crop.y.saturating_add(crop.height), region.y.saturating_add(region.height));
    Rect { x, y, width: right.saturating_sub(x), height: bottom.saturating_sub(y) }
}

/// What a share has of one frame of an animation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameShare {
    /// The frame.
    pub frame: u32,
    /// Which share of it.
    pub index: u32,
    /// Of how many: 1 when the frame is not cut.
    pub count: u32,
}

/// What share `index` of `count` has of a range of frames: as many whole frames as every share can have, in turns,
/// and a share of each frame that is left.
pub fn frames(frames: Range<u32>, index: u32, count: u32) -> Vec<FrameShare> {
    let length = frames.end.saturating_sub(frames.start);
    let whole = length.checked_div(count).unwrap_or(0) * count;
    let share = |offset: u32| FrameShare { frame: frames.start + offset, index, count };
    let own = (0..whole).skip(index as usize).step_by(count.max(1) as usize);
    own.map(|offset| FrameShare { index: 0, count: 1, ..share(offset) }).chain((whole..length).map(share)).collect()
}

#[cfg(test)]
mod tests;
