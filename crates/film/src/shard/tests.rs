//! Shards are disjoint, cover all work and cost about the same.

use super::*;

fn work(width: u32, height: u32, samples: Range<u32>) -> Work {
    let region = Rect { x: 0, y: 0, width, height };
    Work { tiling: Tiling::new(region), crop: None, samples, stop: Stop::Samples }
}

/// Weighted cost of each shard, after checking that all samples are covered exactly once.
fn costs(work: &Work, count: u32, weight: impl Fn(&Rect) -> f64) -> Vec<f64> {
    let mut seen: Vec<(u64, u32, u32)> = Vec::new();
    let shards = (0..count).map(|index| {
        let units = work.shard(index, count);
        seen.extend(units.iter().map(|unit| (unit.tile, unit.samples.start, unit.samples.end)));
        let cost = |unit: &WorkUnit| {
            let pixels = work.tiling.tile(unit.tile).unwrap();
            pixels.area() as f64 * unit.samples.len() as f64 * weight(&pixels)
        };
        units.iter().map(cost).sum()
    });
    let costs = shards.collect();
    check_all_once(work, seen);
    costs
}

fn check_all_once(work: &Work, mut seen: Vec<(u64, u32, u32)>) {
    seen.sort_unstable();
    let mut seen = seen.into_iter().peekable();
    for tile in 0..work.tiling.tile_count() {
        let pixels = work.tiling.tile(tile).unwrap();
        if work.crop.is_some_and(|crop| crop.intersection(&pixels).area() == 0) {
            continue;
        }
        let mut end = work.samples.start;
        while let Some((_, first, last)) = seen.next_if(|unit| unit.0 == tile) {
            assert_eq!(first, end, "tile {tile}: a gap or twice");
            assert!(
                first % BLOCK_SAMPLES == 0 && (last % BLOCK_SAMPLES == 0 || last == work.samples.end) && last > first
            );
            end = last;
        }
        assert_eq!(end, work.samples.end, "tile {tile}: the end is missing");
    }
    assert_eq!(seen.next(), None);
}

fn unbalance(costs: &[f64]) -> f64 {
    let mean = costs.iter().sum::<f64>() / costs.len() as f64;
    costs.iter().fold(0.0, |most: f64, cost| most.max(*cost)) / mean
}

#[test]
fn every_sample_of_every_pixel_is_in_one_shard() {
    let stops = [Stop::Samples, Stop::Noise { level: 0.01 }];
    for (width, height) in [(1, 1), (16, 16), (17, 33), (200, 100), (333, 7)] {
        for samples in [0..1, 0..16, 0..100, 32..100, 48..1040, 0..5000] {
            for stop in stops {
                for count in [1, 2, 3, 5, 8, 40, 1000] {
                    costs(&Work { stop, ..work(width, height, samples.clone()) }, count, |_| 1.0);
                }
            }
        }
    }
    let region = Rect { x: 5, y: 20, width: 100, height: 90 };
    let crop = Some(whole_tiles(&region, &Rect { x: 30, y: 40, width: 20, height: 1 }));
    assert_eq!(crop, Some(Rect { x: 16, y: 32, width: 48, height: 16 }));
    let cropped = Work { tiling: Tiling::new(region), crop, ..work(1, 1, 0..64) };
    assert_eq!(costs(&cropped, 3, |_| 1.0).iter().sum::<f64>(), 48.0 * 16.0 * 64.0);
}

#[test]
fn shards_cost_about_the_same() {
    for (width, height, count) in [(1920, 1080, 7), (1920, 1080, 40), (1000, 1000, 64), (640, 360, 5), (3001, 17, 3)] {
        let most = unbalance(&costs(&work(width, height, 0..64), count, |_| 1.0));
        assert!(most < 1.03, "{width}x{height} in {count}: {most}");
    }
    // With few tiles, samples are split too.
    for (width, height, samples, count) in [(32, 32, 1024, 7), (16, 16, 4096, 16), (100, 100, 1000, 40)] {
        let most = unbalance(&costs(&work(width, height, 0..samples), count, |_| 1.0));
        assert!(most < 1.1, "{width}x{height} in {count}: {most}");
    }
}

#[test]
fn costly_regions_are_balanced_between_shards() {
    // A corner of a hundred times the cost, and stripes one tile wide.
    let corner = |pixels: &Rect| if pixels.x < 400 && pixels.y < 300 { 100.0 } else { 1.0 };
    let columns = |pixels: &Rect| if (pixels.x / TILE_EDGE).is_multiple_of(2) { 100.0 } else { 1.0 };
    let rows = |pixels: &Rect| if (pixels.y / TILE_EDGE).is_multiple_of(4) { 100.0 } else { 1.0 };
    for count in [2, 4, 5, 8, 16] {
        let work = work(1920, 1080, 0..64);
        for (name, most, weight) in
            [("corner", 1.15, &corner as &dyn Fn(&Rect) -> f64), ("columns", 1.15, &columns), ("rows", 1.15, &rows)]
        {
            let found = unbalance(&costs(&work, count, weight));
            assert!(found < most, "{name}, {count} shares: {found}");
        }
    }
}

#[test]
fn neighbors_are_assigned_to_different_shards() {
    let work = work(512, 512, 0..16);
    let assigned = work.assign(4);
    for round in assigned.chunks(4) {
        let mut shards: Vec<u32> = round.iter().map(|(shard, _)| *shard).collect();
        shards.sort_unstable();
        assert_eq!(shards, [0, 1, 2, 3]);
    }
    let first: Vec<u64> = assigned[..4].iter().map(|(_, unit)| unit.tile).collect();
    assert_eq!(first, [0, 1, 32, 33], "two by two");
}

#[test]
fn shards_do_not_split_samples_with_noise_or_time_limits() {
    let small = work(20, 20, 0..4096);
    assert!(small.shard(0, 8).iter().all(|unit| unit.samples.len() < 4096));
    for stop in [Stop::Noise { level: 0.1 }, Stop::Time { seconds: 5.0 }] {
        let work = Work { stop, ..small.clone() };
        assert!(work.assign(8).iter().all(|(_, unit)| unit.samples == (0..4096)));
    }
}

#[test]
fn absurd_numbers_of_shards_need_no_memory() {
    assert_eq!(work(16, 16, 0..16).shard(u32::MAX - 1, u32::MAX), []);
    assert_eq!(work(160, 160, 0..1 << 24).assign(u32::MAX).len(), 100 << 20 >> 6);
}

#[test]
fn the_plan_never_changes() {
    let shards: String = work(64, 64, 0..64).assign(3).iter().map(|(shard, _)| shard.to_string()).collect();
    assert_eq!(shards, "10210221020120101201221012010212");
}

#[test]
fn shards_get_whole_frames_and_split_only_the_remainder() {
    let of = |index, count| frames(10..17, index, count);
    let whole = |frame| FrameShard { frame, index: 0, count: 1 };
    let cut = |index| FrameShard { frame: 16, index, count: 3 };
    assert_eq!(of(0, 3), [whole(10), whole(13), cut(0)]);
    assert_eq!(of(2, 3), [whole(12), whole(15), cut(2)]);
    assert_eq!(of(0, 1), (10..17).map(whole).collect::<Vec<_>>());
    assert_eq!(frames(4..6, 7, 8).len(), 2, "fewer frames than shares: each is cut");
    assert_eq!(frames(4..4, 0, 8), []);
    assert_eq!(frames(0..5, 0, 0).len(), 5);
}

#[test]
fn crops_are_widened_to_whole_tiles() {
    let region = Rect { x: 5, y: 20, width: 100, height: 90 };
    assert_eq!(whole_tiles(&region, &region), region);
    assert_eq!(
        whole_tiles(&region, &Rect { x: 5, y: 20, width: 1, height: 1 }),
        Rect { x: 5, y: 20, width: 11, height: 12 }
    );
    let far = whole_tiles(&region, &Rect { x: u32::MAX, y: 0, width: u32::MAX, height: 1 });
    assert_eq!(far.area(), 0);
}
