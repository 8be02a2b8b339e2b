//! Tests of film sums against direct sums, and of runs in every order.

use super::*;
use juggler_math::{Rgb, hash};
use std::ops::Range;

const PIXELS: Rect = Rect { x: 0, y: 0, width: 2, height: 1 };

/// Samples of very different magnitudes, so that the order of additions matters.
fn sample(pixel: u32, index: u32) -> Rgb {
    let unit = |salt: u32| hash::unit_f32(hash::combine(hash::combine(pixel, index), salt));
    let size = 10f32.powi((unit(9) * 16.0) as i32 - 8);
    Rgb::new(unit(1), unit(2), unit(3)) * size
}

/// Tile of these samples, built as in the engine.
fn tile(samples: Range<u32>, open: Option<&SampleRun>) -> Tile {
    let mut tile = Tile::new(PIXELS);
    let mut runs: Vec<SampleRun> =
        runs(samples.clone()).into_iter().map(|samples| SampleRun::new(samples, vec![])).collect();
    for pixel in 0..PIXELS.area() as u32 {
        let mut accumulator = Accumulator::default();
        accumulator.begin(samples.start, open.map(|run| (&run.sums[pixel as usize], AovSums::default())));
        let radiance: Vec<Rgb> = samples.clone().map(|index| sample(pixel, index)).collect();
        assert_eq!(accumulator.add(&radiance), 0);
        let sums: Vec<Sum> = accumulator.sums().collect();
        assert_eq!(sums.len(), runs.len(), "{samples:?}");
        runs.iter_mut().zip(sums).for_each(|(run, sum)| run.sums.push(sum));
    }
    runs.into_iter().for_each(|run| tile.add(run).unwrap());
    tile
}

fn block(pixel: u32, number: u32, end: u32) -> [f64; 3] {
    let samples = (number * BLOCK_SAMPLES)..end.min((number + 1) * BLOCK_SAMPLES);
    samples.fold(Rgb::BLACK, |sum, index| sum + sample(pixel, index)).to_array().map(f64::from)
}

/// Sum of the blocks in a range whose length is a power of two, by recursive halving.
fn tree(pixel: u32, blocks: Range<u32>) -> [f64; 3] {
    if blocks.len() == 1 {
        return block(pixel, blocks.start, u32::MAX);
    }
    let half = blocks.start + blocks.len() as u32 / 2;
    let (a, b) = (tree(pixel, blocks.start..half), tree(pixel, half..blocks.end));
    std::array::from_fn(|i| a[i] + b[i])
}

#[test]
fn tile_means_sum_blocks_along_the_tree() {
    // 11 blocks and 5 samples: runs of 8, 2 and 1 blocks, and an open one.
    let end = 11 * BLOCK_SAMPLES + 5;
    let tile = tile(0..end, None);
    assert_eq!(tile.runs().iter().map(|run| run.samples.len() as u32).collect::<Vec<_>>(), [128, 32, 16, 5]);
    for pixel in 0..2 {
        let parts = [tree(pixel, 0..8), tree(pixel, 8..10), tree(pixel, 10..11), block(pixel, 11, end)];
        let total = parts.iter().fold([0.0; 3], |sum: [f64; 3], part| std::array::from_fn(|i| sum[i] + part[i]));
        let mean = total.map(|total| (total / f64::from(end)) as f32);
        assert_eq!(tile.means()[pixel as usize].to_array(), mean);
    }
}

#[test]
fn partial_films_may_be_added_in_any_order_and_any_split() {
    let whole = tile(0..40 * BLOCK_SAMPLES, None);
    for seed in 0..40u32 {
        let mut cuts: Vec<u32> = (0..6).map(|i| hash::combine(seed, i) % 41).chain([0, 40]).collect();
        cuts.sort_unstable();
        let mut parts: Vec<Tile> = cuts
            .windows(2)
            .filter(|cut| cut[0] < cut[1])
            .map(|cut| tile(cut[0] * BLOCK_SAMPLES..cut[1] * BLOCK_SAMPLES, None))
            .collect();
        parts.sort_by_key(|part| hash::combine(seed, part.runs()[0].samples.start));
        let merged = parts.iter().fold(Tile::new(PIXELS), |mut sum, part| {
            sum.merge(part.clone()).unwrap();
            sum
        });
        assert_eq!(merged, whole, "cuts {cuts:?}");
        // Samples that the tile already has are rejected.
        let mut doubled = merged.clone();
        assert!(matches!(doubled.merge(parts[0].clone()), Err(TileError::Duplicate(_))));
        assert_eq!(doubled, whole, "and changes nothing");
    }
}

#[test]
fn incomplete_block_is_resumed_with_the_same_bits() {
    for first in 1..70 {
        let mut begun = tile(0..first, None);
        let open = begun.take_open_block(first);
        assert_eq!(open.is_some(), first % BLOCK_SAMPLES != 0);
        begun.merge(tile(first..100, open.as_ref())).unwrap();
        assert_eq!(begun, tile(0..100, None), "from {first} on");
        assert!(begun.is_gapless() && begun.gapless_samples() == 100);
    }
}

#[test]
fn missing_samples_are_found() {
    let mut some = tile(0..16, None);
    some.merge(tile(48..64, None)).unwrap();
    assert!(!some.is_gapless() && some.gapless_samples() == 16);
}

#[test]
fn misaligned_sample_runs_are_rejected() {
    let run = |samples: Range<u32>| SampleRun::new(samples, vec![Sum::default(); 2]);
    let mut tile = Tile::new(PIXELS);
    for uneven in [3..5, 8..24, 16..64, 32..96, 0..48, 5..5, 16..16] {
        assert_eq!(tile.add(run(uneven.clone())), Err(TileError::Misaligned(uneven)));
    }
    assert_eq!(tile.add(SampleRun::new(0..16, vec![Sum::default()])), Err(TileError::OtherPixels));
    tile.add(run(32..37)).unwrap();
    assert_eq!(tile.add(run(32..48)), Err(TileError::Duplicate(32..48)), "a block that was begun");
    assert_eq!(tile.add(run(0..64)), Err(TileError::Duplicate(0..64)));
}

#[test]
fn variance_estimates_follow_from_the_blocks() {
    // Independent samples, uniform in [0, 1): the variance of the mean of n is 1 / 12 n.
    for blocks in [2, 3, 4, 7, 16, 23] {
        let (mut mean, mut variance) = (0.0, 0.0);
        for seed in 0..4000 {
            let unit = |i: u32| hash::unit_f32(hash::combine(hash::combine(seed, i), 7));
            let samples: Vec<Rgb> = (0..blocks * BLOCK_SAMPLES + 3).map(|i| Rgb::splat(unit(i))).collect();
            let mut accumulator = Accumulator::default();
            accumulator.add(&samples);
            let mut tile = Tile::new(Rect { width: 1, ..PIXELS });
            for (samples, sum) in runs(0..samples.len() as u32).into_iter().zip(accumulator.sums()) {
                tile.add(SampleRun::new(samples, vec![sum])).unwrap();
            }
            let found = tile.statistics(0);
            assert_eq!(found.blocks, blocks);
            mean += found.mean[1] / 4000.0;
            variance += found.variance[1] / 4000.0;
        }
        let expected = 1.0 / (12.0 * f64::from(blocks * BLOCK_SAMPLES));
        assert!((mean - 0.5).abs() < 2e-3, "{blocks} blocks: {mean}");
        assert!((variance / expected - 1.0).abs() < 0.08, "{blocks} blocks: {variance} for {expected}");
    }
    assert_eq!(Tile::new(PIXELS).statistics(0), PixelStatistics::default());
}

#[test]
fn nonfinite_samples_are_black_and_counted() {
    let (nan, infinite) = (Rgb::new(0.0, f32::NAN, 0.0), Rgb::new(f32::INFINITY, 0.0, 0.0));
    let mut accumulator = Accumulator::default();
    assert_eq!(accumulator.add(&[Rgb::WHITE, nan, Rgb::WHITE, infinite]), 2);
    assert_eq!(accumulator.sums().next().unwrap().total, [2.0; 3]);
}

#[test]
fn tiles_cover_a_region_once() {
    for (x, y, width, height) in [(0, 0, 64, 64), (0, 0, 1, 1), (5, 17, 30, 16), (15, 15, 2, 2), (3, 3, 0, 9)] {
        let region = Rect { x, y, width, height };
        let tiling = Tiling::new(region);
        let tiles: Vec<Rect> = (0..tiling.tile_count()).map(|number| tiling.tile(number).unwrap()).collect();
        assert_eq!(tiles.iter().map(Rect::area).sum::<u64>(), region.area());
        assert!(tiles.iter().all(|tile| tile.intersection(&region) == *tile && tile.area() > 0));
        assert!(tiles.iter().all(|tile| (tile.x % TILE_EDGE == 0 || tile.x == x) && tile.width <= TILE_EDGE));
        assert_eq!(tiling.tile(tiling.tile_count()), None);
    }
    let huge = Tiling::new(Rect { x: u32::MAX - 5, y: 0, width: u32::MAX, height: u32::MAX });
    assert!(huge.tile(huge.tile_count() - 1).is_some() || huge.tile_count() > 0, "no overflow");
}

#[test]
fn a_film_is_finite_whatever_its_samples_are() {
    let sizes = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 3.4e38, -3e38, 1e36, -1e36, 9e35, 1.0];
    let samples: Vec<Rgb> =
        (0..64 * BLOCK_SAMPLES as usize).map(|i| Rgb::new(0.5, sizes[i * 7 % 9], -sizes[i % 9])).collect();
    let expected = samples.iter().filter(|sample| !sample.to_array().iter().all(|v| v.abs() <= 1e36)).count() as u64;
    for chunk in [1, 5, 16, 1024] {
        let mut accumulator = Accumulator::default();
        accumulator.begin(0, None);
        let add = |planes: &[Rgb], accumulator: &mut Accumulator| {
            let clamped: Vec<f32> = planes.iter().map(|_| 3e38).collect();
            accumulator.add_samples(PixelSamples { radiance: planes, clamped: &clamped, planes, hit_ids: &[] })
        };
        let rejected: u64 = samples.chunks(chunk).map(|samples| add(samples, &mut accumulator)).sum();
        assert_eq!(rejected, expected, "in pieces of {chunk}");
        for sum in accumulator.sums() {
            assert!(sum.total.iter().all(|total| total.is_finite()), "{sum:?}");
            assert!(sum.squared_deviations.iter().all(|sum| sum.is_finite() && *sum > 0.0), "{sum:?}");
            assert_eq!(sum.clamped, f32::MAX);
        }
        let finite = |aov_sums: &AovSums| aov_sums.planes.iter().all(|plane| plane.is_finite());
        assert!(accumulator.aov_sums().all(|aov_sums| finite(&aov_sums)));
    }
}
