//! Validation of partial renders before they are merged.

use super::MergeGoal;
use super::problem::{MergeError, MergeProblem, RemainingWork};
use crate::partial_render::{PartialRender, PartialRenderError, RenderDescription, ShardDescription, Stop};
use crate::shard::Work;
use juggler_camera::film::Tile;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::path::Path;

/// Maximum number of tiles for which missing shards are determined; dealing takes about 100 bytes a
/// tile.
const MAX_ASSIGNED_TILES: u64 = 1 << 20;

/// Contiguous range of samples of one tile in one partial render.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Span {
    tile: u64,
    start: u32,
    end: u32,
    partial_render: u32,
}

/// Opens all files. Returns the partial renders, and a problem for each that cannot be opened.
pub(super) fn open<P: AsRef<Path>>(files: &[P]) -> (Vec<PartialRender>, Vec<MergeProblem>) {
    let mut problems = Vec::new();
    let mut partial_renders = Vec::new();
    for file in files {
        match PartialRender::open(file.as_ref()) {
            Ok(partial_render) => partial_renders.push(partial_render),
            Err(error) => problems.push(MergeProblem::Unreadable(error)),
        }
    }
    (partial_renders, problems)
}

/// Verifies all partial renders. Returns the compatible partial renders and the description of the
/// merged result, or every problem at once. `problems` are those of opening the files, and `names` has
/// the name of every partial render, also of one that could not be opened.
pub(super) fn check(
    names: Vec<String>,
    partial_renders: Vec<PartialRender>,
    mut problems: Vec<MergeProblem>,
    goal: MergeGoal,
) -> Result<(Vec<PartialRender>, RenderDescription), MergeError> {
    let refused = |problems| Err(MergeError { files: names, problems });
    if partial_renders.is_empty() && problems.is_empty() {
        problems.push(MergeProblem::None);
    }
    let partial_renders = without_foreign(partial_renders, &mut problems);
    let (partial_renders, mut spans) = verified(partial_renders, &mut problems);
    spans.sort_unstable();
    problems.extend(duplicates(&partial_renders, &spans));
    let Some(first) = partial_renders
        .iter()
        .min_by_key(|partial_render| (partial_render.description().shard.index, partial_render.name()))
    else {
        return refused(problems);
    };
    let samples = first.description().samples;
    let coverage = Coverage::new(first.description(), &partial_renders, &spans);
    let finished = coverage.is_whole();
    let description =
        RenderDescription { shard: ShardDescription::whole(samples), finished, ..first.description().clone() };
    if goal == MergeGoal::Whole && !finished {
        let unfinished =
            partial_renders.iter().filter(|partial_render| !partial_render.description().finished).map(name);
        problems.extend(unfinished.map(|file| MergeProblem::Unfinished { file }));
        problems.push(MergeProblem::Missing(coverage.remaining_work(&partial_renders)));
    }
    if problems.is_empty() { Ok((partial_renders, description)) } else { refused(problems) }
}

fn name(partial_render: &PartialRender) -> String {
    partial_render.name().to_owned()
}

/// Keeps the largest group of partial renders with equal settings and reports every other one as
/// belonging to another image.
fn without_foreign(partial_renders: Vec<PartialRender>, problems: &mut Vec<MergeProblem>) -> Vec<PartialRender> {
    let mut groups: Vec<Vec<PartialRender>> = Vec::new();
    for partial_render in partial_renders {
        let same = |group: &&mut Vec<PartialRender>| {
            group.first().is_some_and(|first| first.description().mismatches(partial_render.description()).is_empty())
        };
        match groups.iter_mut().find(same) {
            Some(group) => group.push(partial_render),
            None => groups.push(vec![partial_render]),
        }
    }
    // Among groups of equal size, the first one wins.
    let largest = groups.iter().enumerate().rev().max_by_key(|(_, group)| group.len()).map_or(0, |(at, _)| at);
    if groups.is_empty() {
        return Vec::new();
    }
    let chosen = groups.swap_remove(largest);
    let Some(first) = chosen.first() else { return chosen };
    for partial_render in groups.iter().flatten() {
        let mismatches = first.description().mismatches(partial_render.description());
        problems.push(MergeProblem::OtherImage { file: name(partial_render), other: name(first), mismatches });
    }
    chosen
}

/// Reads every tile of every partial render and returns the valid partial renders with their sample
/// ranges.
fn verified(partial_renders: Vec<PartialRender>, problems: &mut Vec<MergeProblem>) -> (Vec<PartialRender>, Vec<Span>) {
    let mut whole = Vec::new();
    let mut spans = Vec::new();
    for partial_render in partial_renders {
        match own_spans(&partial_render, whole.len() as u32) {
            Ok(own) => {
                spans.extend(own);
                whole.push(partial_render);
            }
            Err(error) => problems.push(MergeProblem::Unreadable(error)),
        }
    }
    (whole, spans)
}

fn own_spans(partial_render: &PartialRender, number: u32) -> Result<Vec<Span>, PartialRenderError> {
    let mut reader = partial_render.reader()?;
    let mut spans = Vec::new();
    for tile in partial_render.tiles() {
        let samples = reader.tile(tile)?;
        spans.extend(ranges(&samples).map(|Range { start, end }| Span { tile, start, end, partial_render: number }));
    }
    Ok(spans)
}

/// Sample ranges of a tile, adjacent runs merged.
fn ranges(tile: &Tile) -> impl Iterator<Item = Range<u32>> {
    let alone = tile.runs().chunk_by(|a, b| a.samples.end == b.samples.start);
    alone.filter_map(|runs| Some(runs.first()?.samples.start..runs.last()?.samples.end))
}

/// Pairs of partial renders that hold the same samples, with the number of tiles affected.
fn duplicates(partial_renders: &[PartialRender], spans: &[Span]) -> Vec<MergeProblem> {
    let mut tiles: BTreeMap<[u32; 2], u64> = BTreeMap::new();
    for tile in spans.chunk_by(|a, b| a.tile == b.tile) {
        let mut pairs = BTreeSet::new();
        let mut farthest: Option<&Span> = None;
        for span in tile {
            if let Some(other) = farthest.filter(|other| other.end > span.start) {
                pairs.insert([
                    other.partial_render.min(span.partial_render),
                    other.partial_render.max(span.partial_render),
                ]);
            }
            if farthest.is_none_or(|other| other.end < span.end) {
                farthest = Some(span);
            }
        }
        pairs.into_iter().for_each(|pair| *tiles.entry(pair).or_default() += 1);
    }
    let file = |number: u32| partial_renders.get(number as usize).map(name).unwrap_or_default();
    tiles.into_iter().map(|(pair, tiles)| MergeProblem::Duplicate { files: pair.map(file), tiles }).collect()
}

/// Samples that no partial render holds.
struct Coverage<'a> {
    picture: &'a RenderDescription,
    /// Runs of tiles with missing samples, in ascending order.
    missing_runs: Vec<MissingRun>,
}

/// Consecutive tiles that lack the same samples.
struct MissingRun {
    tiles: Range<u64>,
    samples: Vec<Range<u32>>,
}

impl<'a> Coverage<'a> {
    fn new(picture: &'a RenderDescription, partial_renders: &[PartialRender], spans: &[Span]) -> Self {
        let mut missing_runs: Vec<MissingRun> = Vec::new();
        let mut add = |tiles: Range<u64>, spans: &[Span]| {
            let samples = missing(picture, partial_renders, spans);
            if !tiles.is_empty() && !samples.is_empty() {
                missing_runs.push(MissingRun { tiles, samples });
            }
        };
        let mut next = 0;
        for own in spans.chunk_by(|a, b| a.tile == b.tile) {
            let Some(tile) = own.first().map(|span| span.tile) else { continue };
            add(next..tile, &[]);
            add(tile..tile + 1, own);
            next = tile + 1;
        }
        add(next..picture.tiling().tile_count(), &[]);
        Self { picture, missing_runs }
    }

    fn is_whole(&self) -> bool {
        self.missing_runs.is_empty()
    }

    /// Shards that cover the missing samples, or the missing sample ranges if the partial renders
    /// are not shards.
    fn remaining_work(&self, partial_renders: &[PartialRender]) -> RemainingWork {
        let whole = ShardDescription::whole(self.picture.samples);
        let mut counts: BTreeMap<u32, usize> = BTreeMap::new();
        for shard in partial_renders.iter().map(|partial_render| &partial_render.description().shard) {
            if shard.count > 1 && shard.samples == whole.samples && shard.crop.is_none() {
                *counts.entry(shard.count).or_default() += 1;
            }
        }
        let can_be_assigned = self.picture.tiling().tile_count() <= MAX_ASSIGNED_TILES;
        let most = counts.into_iter().filter(|_| can_be_assigned).max_by_key(|(_, partial_renders)| *partial_renders);
        let Some((count, _)) = most else { return self.samples() };
        let open = |tile: u64, samples: &Range<u32>| {
            let run = self.missing_runs.get(self.missing_runs.partition_point(|run| run.tiles.end <= tile));
            let ranges = run.filter(|run| run.tiles.contains(&tile)).map(|run| run.samples.as_slice());
            ranges.unwrap_or_default().iter().any(|range| range.start < samples.end && range.end > samples.start)
        };
        let assigned = Work::from_description(self.picture).assign(count).into_iter();
        let shards: BTreeSet<u32> =
            assigned.filter(|(_, unit)| open(unit.tile, &unit.samples)).map(|(shard, _)| shard).collect();
        RemainingWork::Shards { shards: shards.into_iter().collect(), count }
    }

    fn samples(&self) -> RemainingWork {
        let tiling = self.picture.tiling();
        let mut found: BTreeMap<(u32, u32), (u64, [u32; 2])> = BTreeMap::new();
        for (tiles, range) in
            self.missing_runs.iter().flat_map(|run| run.samples.iter().map(|samples| (&run.tiles, samples)))
        {
            let corner = tiling.tile(tiles.start).map_or([0; 2], |pixels| [pixels.x, pixels.y]);
            found.entry((range.start, range.end)).or_insert((0, corner)).0 += tiles.end - tiles.start;
        }
        let missing = |((start, end), (tiles, corner))| (start..end, tiles, corner);
        RemainingWork::Samples(found.into_iter().map(missing).collect())
    }
}

/// Missing sample ranges of one tile, of which `spans` are present.
fn missing(picture: &RenderDescription, partial_renders: &[PartialRender], spans: &[Span]) -> Vec<Range<u32>> {
    let mut missing = Vec::new();
    let mut end = 0;
    for span in spans {
        if span.start > end {
            missing.push(end..span.start);
        }
        end = end.max(span.end);
    }
    let is_finished = |span: &Span| {
        partial_renders
            .get(span.partial_render as usize)
            .is_some_and(|partial_render| partial_render.description().finished)
    };
    // With a noise or time limit the number of samples varies between tiles, so a finished partial
    // render decides how many its tiles need.
    let ended = picture.stop != Stop::Samples && !spans.is_empty() && spans.iter().all(is_finished);
    if end < picture.samples && !ended {
        missing.push(end..picture.samples);
    }
    missing
}
