//! What is wrong with parts that are to be merged.

use super::Wanted;
use super::complaint::{Complaint, MergeError, ToDo};
use crate::part::{Description, Part, PartError, Share, Stop};
use crate::share::Work;
use juggler_camera::film::Tile;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::path::Path;

/// Most tiles of a picture whose missing shares are found out: dealing takes a hundred bytes a tile.
const MOST_DEALT: u64 = 1 << 20;

/// Samples without a gap that a part has of a tile.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Span {
    tile: u64,
    start: u32,
    end: u32,
    part: u32,
}

/// The parts that fit together, and what they become; or all that is wrong.
pub(super) fn check<P: AsRef<Path>>(files: &[P], wanted: Wanted) -> Result<(Vec<Part>, Description), MergeError> {
    let mut complaints = Vec::new();
    let refused = |complaints| {
        let files = files.iter().map(|file| file.as_ref().display().to_string()).collect();
        Err(MergeError { files, complaints })
    };
    if files.is_empty() {
        complaints.push(Complaint::None);
    }
    let mut parts = Vec::new();
    for file in files {
        match Part::open(file.as_ref()) {
            Ok(part) => parts.push(part),
            Err(error) => complaints.push(Complaint::Unreadable(error)),
        }
    }
    let parts = without_foreign(parts, &mut complaints);
    let (parts, mut spans) = verified(parts, &mut complaints);
    spans.sort_unstable();
    complaints.extend(doubled(&parts, &spans));
    let Some(first) = parts.iter().min_by_key(|part| (part.description().share.index, part.path())) else {
        return refused(complaints);
    };
    let samples = first.description().samples;
    let coverage = Coverage::new(first.description(), &parts, &spans);
    let finished = coverage.is_whole();
    let description = Description { share: Share::whole(samples), finished, ..first.description().clone() };
    if wanted == Wanted::Whole && !finished {
        let unfinished = parts.iter().filter(|part| !part.description().finished).map(name);
        complaints.extend(unfinished.map(|file| Complaint::Unfinished { file }));
        complaints.push(Complaint::Missing(coverage.to_do(&parts)));
    }
    if complaints.is_empty() { Ok((parts, description)) } else { refused(complaints) }
}

fn name(part: &Part) -> String {
    part.path().display().to_string()
}

/// Most parts are right; what differs from them is foreign.
fn without_foreign(parts: Vec<Part>, complaints: &mut Vec<Complaint>) -> Vec<Part> {
    let mut groups: Vec<Vec<Part>> = Vec::new();
    for part in parts {
        let same = |group: &&mut Vec<Part>| {
            group.first().is_some_and(|first| first.description().mismatches(part.description()).is_empty())
        };
        match groups.iter_mut().find(same) {
            Some(group) => group.push(part),
            None => groups.push(vec![part]),
        }
    }
    // Of groups of one size the one that comes first.
    let largest = groups.iter().enumerate().rev().max_by_key(|(_, group)| group.len()).map_or(0, |(at, _)| at);
    if groups.is_empty() {
        return Vec::new();
    }
    let chosen = groups.swap_remove(largest);
    let Some(first) = chosen.first() else { return chosen };
    for part in groups.iter().flatten() {
        let mismatches = first.description().mismatches(part.description());
        complaints.push(Complaint::Foreign { file: name(part), other: name(first), mismatches });
    }
    chosen
}

/// The parts of which every byte is right, and their samples.
fn verified(parts: Vec<Part>, complaints: &mut Vec<Complaint>) -> (Vec<Part>, Vec<Span>) {
    let mut whole = Vec::new();
    let mut spans = Vec::new();
    for part in parts {
        match own_spans(&part, whole.len() as u32) {
            Ok(own) => {
                spans.extend(own);
                whole.push(part);
            }
            Err(error) => complaints.push(Complaint::Unreadable(error)),
        }
    }
    (whole, spans)
}

fn own_spans(part: &Part, number: u32) -> Result<Vec<Span>, PartError> {
    let mut reader = part.reader()?;
    let mut spans = Vec::new();
    for tile in part.tiles() {
        let samples = reader.tile(tile)?;
        spans.extend(ranges(&samples).map(|Range { start, end }| Span { tile, start, end, part: number }));
    }
    Ok(spans)
}

/// The samples that are there, neighbouring runs as one.
fn ranges(tile: &Tile) -> impl Iterator<Item = Range<u32>> {
    let alone = tile.runs().chunk_by(|a, b| a.samples.end == b.samples.start);
    alone.filter_map(|runs| Some(runs.first()?.samples.start..runs.last()?.samples.end))
}

/// Pairs of parts that hold the same samples.
fn doubled(parts: &[Part], spans: &[Span]) -> Vec<Complaint> {
    let mut tiles: BTreeMap<[u32; 2], u64> = BTreeMap::new();
    for tile in spans.chunk_by(|a, b| a.tile == b.tile) {
        let mut pairs = BTreeSet::new();
        let mut farthest: Option<&Span> = None;
        for span in tile {
            if let Some(other) = farthest.filter(|other| other.end > span.start) {
                pairs.insert([other.part.min(span.part), other.part.max(span.part)]);
            }
            if farthest.is_none_or(|other| other.end < span.end) {
                farthest = Some(span);
            }
        }
        pairs.into_iter().for_each(|pair| *tiles.entry(pair).or_default() += 1);
    }
    let file = |number: u32| parts.get(number as usize).map(name).unwrap_or_default();
    tiles.into_iter().map(|(pair, tiles)| Complaint::Doubled { files: pair.map(file), tiles }).collect()
}

/// What of a picture is not there.
struct Coverage<'a> {
    picture: &'a Description,
    /// Tiles of which samples are missing, rising.
    gaps: Vec<Gap>,
}

/// Neighboring tiles of which the same samples are missing.
struct Gap {
    tiles: Range<u64>,
    samples: Vec<Range<u32>>,
}

impl<'a> Coverage<'a> {
    fn new(picture: &'a Description, parts: &[Part], spans: &[Span]) -> Self {
        let mut gaps: Vec<Gap> = Vec::new();
        let mut add = |tiles: Range<u64>, spans: &[Span]| {
            let samples = missing(picture, parts, spans);
            if !tiles.is_empty() && !samples.is_empty() {
                gaps.push(Gap { tiles, samples });
            }
        };
        let mut next = 0;
        for own in spans.chunk_by(|a, b| a.tile == b.tile) {
            let Some(tile) = own.first().map(|span| span.tile) else { continue };
            add(next..tile, &[]);
            add(tile..tile + 1, own);
            next = tile + 1;
        }
        add(next..picture.layout().tiles(), &[]);
        Self { picture, gaps }
    }

    fn is_whole(&self) -> bool {
        self.gaps.is_empty()
    }

    /// The shares that would fill the gaps; or the gaps themselves, when the parts are no shares.
    fn to_do(&self, parts: &[Part]) -> ToDo {
        let whole = Share::whole(self.picture.samples);
        let mut counts: BTreeMap<u32, usize> = BTreeMap::new();
        for share in parts.iter().map(|part| &part.description().share) {
            if share.count > 1 && share.samples == whole.samples && share.crop.is_none() {
                *counts.entry(share.count).or_default() += 1;
            }
        }
        let can_be_dealt = self.picture.layout().tiles() <= MOST_DEALT;
        let most = counts.into_iter().filter(|_| can_be_dealt).max_by_key(|(_, parts)| *parts);
        let Some((count, _)) = most else { return self.samples() };
        let open = |tile: u64, samples: &Range<u32>| {
            let gap = self.gaps.get(self.gaps.partition_point(|gap| gap.tiles.end <= tile));
            let gaps = gap.filter(|gap| gap.tiles.contains(&tile)).map(|gap| gap.samples.as_slice());
            gaps.unwrap_or_default().iter().any(|gap| gap.start < samples.end && gap.end > samples.start)
        };
        let dealt = Work::of(self.picture).deal(count).into_iter();
        let shards: BTreeSet<u32> =
            dealt.filter(|(_, unit)| open(unit.tile, &unit.samples)).map(|(share, _)| share).collect();
        ToDo::Shards { shards: shards.into_iter().collect(), count }
    }

    fn samples(&self) -> ToDo {
        let layout = self.picture.layout();
        let mut found: BTreeMap<(u32, u32), (u64, [u32; 2])> = BTreeMap::new();
        for (tiles, gap) in self.gaps.iter().flat_map(|gap| gap.samples.iter().map(|samples| (&gap.tiles, samples))) {
            let corner = layout.tile(tiles.start).map_or([0; 2], |pixels| [pixels.x, pixels.y]);
            found.entry((gap.start, gap.end)).or_insert((0, corner)).0 += tiles.end - tiles.start;
        }
        let gap = |((start, end), (tiles, corner))| (start..end, tiles, corner);
        ToDo::Samples(found.into_iter().map(gap).collect())
    }
}

/// The samples that are missing of a tile, of which these are there.
fn missing(picture: &Description, parts: &[Part], spans: &[Span]) -> Vec<Range<u32>> {
    let mut gaps = Vec::new();
    let mut end = 0;
    for span in spans {
        if span.start > end {
            gaps.push(end..span.start);
        }
        end = end.max(span.end);
    }
    let is_finished = |span: &Span| parts.get(span.part as usize).is_some_and(|part| part.description().finished);
    // Where noise or time ends a picture, each tile has as many samples as it needed: whoever rendered it knows.
    let ended = picture.stop != Stop::Samples && !spans.is_empty() && spans.iter().all(is_finished);
    if end < picture.samples && !ended {
        gaps.push(end..picture.samples);
    }
    gaps
}
