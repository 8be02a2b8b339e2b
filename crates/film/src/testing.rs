//! Pictures for tests: samples made by a hash, summed as the engine sums them.

#![allow(clippy::unwrap_used, reason = "only tests use it")]

use crate::{Description, Layered, Share, Stop};
use juggler_camera::film::{Accumulator, Layout, Rect, Run, Samples, Sum, Tile, runs};
use juggler_math::{Rgb, hash};
use std::ops::Range;
use std::path::PathBuf;

/// Of a picture of this region.
pub fn description(region: Rect, samples: u32) -> Description {
    Description {
        software: "Juggler 0.0.0".into(),
        command: "juggler render ball --size 64x48".into(),
        scene: "ball".into(),
        frame: 2.4000000000000004,
        size: [region.x + region.width, region.y + region.height],
        region,
        samples,
        stop: Stop::Samples,
        clamped: false,
        layers: Layered::default(),
        share: Share::whole(samples),
        finished: true,
        fingerprint: [("scene", "5ce4e"), ("seed", "7")].map(|(k, v)| (k.to_owned(), v.to_owned())).into(),
        tone: serde_json::json!({"curve": {"srgb": {}}, "exposure_stops": 0.1}),
        metadata: vec![("Software".into(), "Juggler 0.0.0".into())],
        viewpoint: None,
    }
}

/// A sample of a pixel: all sizes, so that the order of additions shows.
fn sample(x: u32, y: u32, index: u32) -> Rgb {
    let unit = |salt: u32| hash::unit_f32(hash::combine(hash::combine(x, y), hash::combine(index, salt)));
    Rgb::new(unit(1), unit(2), unit(3)) * 10f32.powi((unit(9) * 8.0) as i32 - 4)
}

/// The samples of a tile in this range, as the engine makes them.
pub fn tile(pixels: Rect, samples: Range<u32>) -> Tile {
    exposed(pixels, samples, |_| None)
}

/// The same of a picture whose samples lost as much as they have of green.
pub fn clamped_tile(pixels: Rect, samples: Range<u32>) -> Tile {
    exposed(pixels, samples, |sample| Some(sample.g))
}

fn exposed(pixels: Rect, samples: Range<u32>, lost: impl Fn(&Rgb) -> Option<f32>) -> Tile {
    let mut tile = Tile::new(pixels);
    let mut parts: Vec<Run> = runs(samples.clone()).into_iter().map(|samples| Run::new(samples, vec![])).collect();
    for pixel in 0..pixels.area() as u32 {
        let (x, y) = (pixels.x + pixel % pixels.width, pixels.y + pixel / pixels.width);
        let mut accumulator = Accumulator::default();
        accumulator.begin(samples.start, None);
        let radiance: Vec<Rgb> = samples.clone().map(|index| sample(x, y, index)).collect();
        let clamped: Vec<f32> = radiance.iter().filter_map(&lost).collect();
        accumulator.add_samples(Samples { radiance: &radiance, clamped: &clamped, ..Samples::default() });
        let sums: Vec<Sum> = accumulator.sums().collect();
        parts.iter_mut().zip(sums).for_each(|(run, sum)| run.sums.push(sum));
    }
    parts.into_iter().for_each(|run| tile.add(run).unwrap());
    tile
}

/// All tiles of a region with these samples.
pub fn tiles(region: Rect, samples: Range<u32>) -> Vec<(u64, Tile)> {
    let layout = Layout::new(region);
    (0..layout.tiles()).map(|number| (number, tile(layout.tile(number).unwrap(), samples.clone()))).collect()
}

/// All tiles of a region with these samples, that lost some light.
pub fn clamped_tiles(region: Rect, samples: Range<u32>) -> Vec<(u64, Tile)> {
    let layout = Layout::new(region);
    (0..layout.tiles()).map(|number| (number, clamped_tile(layout.tile(number).unwrap(), samples.clone()))).collect()
}

/// A place in a fresh folder.
pub fn place(name: &str) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    (folder, path)
}
