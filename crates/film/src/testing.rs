//! Synthetic images for tests: hashed samples, accumulated as the renderer does.

#![allow(clippy::unwrap_used, reason = "only tests use it")]

use crate::{AovDescription, RenderDescription, ShardDescription, Stop};
use juggler_camera::film::{Accumulator, PixelSamples, Rect, SampleRun, Sum, Tile, Tiling, runs};
use juggler_math::{Rgb, hash};
use std::ops::Range;
use std::path::PathBuf;

/// Description of a finished image of `region`.
pub fn description(region: Rect, samples: u32) -> RenderDescription {
    RenderDescription {
        software: "Juggler 0.0.0".into(),
        command: "juggler render ball --size 64x48".into(),
        scene: "ball".into(),
        frame: 2.4000000000000004,
        size: [region.x + region.width, region.y + region.height],
        region,
        samples,
        stop: Stop::Samples,
        clamped: false,
        aovs: AovDescription::default(),
        shard: ShardDescription::whole(samples),
        finished: true,
        fingerprint: [("scene", "5ce4e"), ("seed", "7")].map(|(k, v)| (k.to_owned(), v.to_owned())).into(),
        tone: serde_json::json!({"curve": {"srgb": {}}, "exposure_stops": 0.1}),
        metadata: vec![("Software".into(), "Juggler 0.0.0".into())],
        viewpoint: None,
    }
}

/// A sample of widely varying magnitude, so that the order of additions affects rounding.
fn sample(x: u32, y: u32, index: u32) -> Rgb {
    let unit = |salt: u32| hash::unit_f32(hash::combine(hash::combine(x, y), hash::combine(index, salt)));
    Rgb::new(unit(1), unit(2), unit(3)) * 10f32.powi((unit(9) * 8.0) as i32 - 4)
}

/// The given samples of a tile, accumulated as the renderer does.
pub fn tile(pixels: Rect, samples: Range<u32>) -> Tile {
    accumulate(pixels, samples, |_| None)
}

/// Like [`tile`], as if clamping had removed the green channel's value from each sample.
pub fn clamped_tile(pixels: Rect, samples: Range<u32>) -> Tile {
    accumulate(pixels, samples, |sample| Some(sample.g))
}

fn accumulate(pixels: Rect, samples: Range<u32>, lost: impl Fn(&Rgb) -> Option<f32>) -> Tile {
    let mut tile = Tile::new(pixels);
    let mut parts: Vec<SampleRun> =
        runs(samples.clone()).into_iter().map(|samples| SampleRun::new(samples, vec![])).collect();
    for pixel in 0..pixels.area() as u32 {
        let (x, y) = (pixels.x + pixel % pixels.width, pixels.y + pixel / pixels.width);
        let mut accumulator = Accumulator::default();
        accumulator.begin(samples.start, None);
        let radiance: Vec<Rgb> = samples.clone().map(|index| sample(x, y, index)).collect();
        let clamped: Vec<f32> = radiance.iter().filter_map(&lost).collect();
        accumulator.add_samples(PixelSamples { radiance: &radiance, clamped: &clamped, ..PixelSamples::default() });
        let sums: Vec<Sum> = accumulator.sums().collect();
        parts.iter_mut().zip(sums).for_each(|(run, sum)| run.sums.push(sum));
    }
    parts.into_iter().for_each(|run| tile.add(run).unwrap());
    tile
}

/// All tiles of a region with these samples.
pub fn tiles(region: Rect, samples: Range<u32>) -> Vec<(u64, Tile)> {
    let tiling = Tiling::new(region);
    (0..tiling.tile_count()).map(|number| (number, tile(tiling.tile(number).unwrap(), samples.clone()))).collect()
}

/// All tiles of a region with these samples and clamped radiance.
pub fn clamped_tiles(region: Rect, samples: Range<u32>) -> Vec<(u64, Tile)> {
    let tiling = Tiling::new(region);
    (0..tiling.tile_count())
        .map(|number| (number, clamped_tile(tiling.tile(number).unwrap(), samples.clone())))
        .collect()
}

/// A path in a new temporary folder.
pub fn place(name: &str) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    (folder, path)
}
