//! Benchmark of encoding, writing, reading and merging `.jfilm` files, and their size relative to
//! uncompressed sums: `cargo bench -p juggler-film`. The tiles come from built-in scenes.
#![allow(clippy::print_stdout, reason = "that is its purpose")]

use juggler::camera::film::{BLOCK_SAMPLES, Rect, SampleRun, Sum, Tile, Tiling};
use juggler::prelude::*;
use juggler_film::shard::Work;
use juggler_film::{
    AovDescription, Chunk, Merge, MergeGoal, PartialRender, PartialRenderError, RenderDescription, ShardDescription,
    Stop, write,
};
use juggler_raybench::clock::{CpuClock, Stopwatch};
use std::error::Error;
use std::hint::black_box;
use std::path::{Path, PathBuf};

const SIZE: [u32; 2] = [640, 360];
const REGION: Rect = Rect { x: 0, y: 0, width: SIZE[0], height: SIZE[1] };
/// Built-in scenes, each with its number of blocks of samples.
const FILMS: [(&str, u32); 4] = [("juggler", 4), ("marbles", 1), ("marbles", 11), ("blossom", 4)];
const SHARDS: u32 = 5;

/// Renders the tiles of a scene, one seed per block: a tile keeps only the sum of each block.
fn film(name: &str, blocks: u32) -> Result<Vec<Tile>, Box<dyn Error>> {
    let scene = Scene::built_in(name)?;
    let tiling = Tiling::new(REGION);
    let mut tiles: Vec<Tile> =
        (0..tiling.tile_count()).filter_map(|number| tiling.tile(number)).map(Tile::new).collect();
    for block in 0..blocks {
        let seed = Some(block.into());
        let settings = Settings { size: Some(SIZE), samples: Some(BLOCK_SAMPLES), seed, ..Settings::default() };
        let image = Picture::new(&scene, &settings)?.render_image(&Control::default())?;
        for tile in &mut tiles {
            let Rect { x, y, width, .. } = tile.pixels();
            let place = |pixel: u32| (y + pixel / width) * SIZE[0] + x + pixel % width;
            let pixels = (0..tile.pixels().area() as u32).filter_map(|pixel| image.pixels().get(place(pixel) as usize));
            let sum = |mean: &Rgb| (*mean * BLOCK_SAMPLES as f32).to_array().map(f64::from);
            let sums = pixels.map(|mean| Sum { total: sum(mean), ..Sum::default() }).collect();
            tile.add(SampleRun::new(block * BLOCK_SAMPLES..(block + 1) * BLOCK_SAMPLES, sums))?;
        }
    }
    Ok(tiles)
}

fn description(samples: u32, shard: ShardDescription) -> RenderDescription {
    RenderDescription {
        software: "Juggler".into(),
        command: "juggler render".into(),
        scene: "bench".into(),
        frame: 0.0,
        size: SIZE,
        region: REGION,
        samples,
        stop: Stop::Samples,
        clamped: false,
        aovs: AovDescription::default(),
        shard,
        finished: true,
        fingerprint: Default::default(),
        tone: serde_json::Value::Null,
        metadata: Vec::new(),
        viewpoint: None,
    }
}

/// Throughput of `work` in megabytes of uncompressed sums per second of CPU time, the best of 9
/// runs.
fn speed(raw: usize, mut work: impl FnMut() -> Result<(), Box<dyn Error>>) -> Result<f64, Box<dyn Error>> {
    let mut least = f64::INFINITY;
    for _ in 0..9 {
        let watch = Stopwatch::start(CpuClock::Thread);
        work()?;
        least = least.min(watch.elapsed().cpu);
    }
    Ok(raw as f64 * 1e-6 / least)
}

/// Writes one `.jfilm` file per shard and returns their paths.
fn shards(folder: &Path, tiles: &[Tile], samples: u32) -> Result<Vec<PathBuf>, Box<dyn Error>> {
    let mut files = Vec::new();
    for index in 0..SHARDS {
        let description =
            description(samples, ShardDescription { index, count: SHARDS, ..ShardDescription::whole(samples) });
        let units = Work::from_description(&description).shard(index, SHARDS);
        let own = units.iter().filter_map(|unit| Some((unit.tile, tiles.get(unit.tile as usize)?.clone())));
        let file = folder.join(format!("{index}.jfilm"));
        write(&file, &description, own)?;
        files.push(file);
    }
    Ok(files)
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let file = folder.path().join("whole.jfilm");
    println!(
        "scene    blocks     raw MB  part/raw    pack   write    read   merge  (MB of plain floats a second of one processor)"
    );
    for (scene, blocks) in FILMS {
        let tiles = film(scene, blocks)?;
        let samples = blocks * BLOCK_SAMPLES;
        let raw: usize = tiles.iter().flat_map(Tile::runs).map(|run| run.sums.len() * 36).sum();
        let whole = description(samples, ShardDescription::whole(samples));
        let pack = speed(raw, || {
            black_box(tiles.iter().map(|tile| Chunk::encode(tile, false)).collect::<Vec<_>>());
            Ok(())
        })?;
        let numbered = || (0..).zip(tiles.iter().cloned());
        let bytes = write(&file, &whole, numbered())?;
        let write = speed(raw, || Ok(write(&file, &whole, numbered()).map(|_| ())?))?;
        let read = speed(raw, || Ok(PartialRender::open(&file)?.verify()?))?;
        let files = shards(folder.path(), &tiles, samples)?;
        let merge = speed(raw, || {
            let merge = Merge::open(&files, MergeGoal::Whole)?;
            merge.rows(|_| Ok::<(), PartialRenderError>(()))?;
            Ok(())
        })?;
        let ratio = bytes as f64 / raw as f64;
        let megabytes = raw as f64 * 1e-6;
        println!("{scene:8} {blocks:6} {megabytes:10.1} {ratio:9.3} {pack:7.0} {write:7.0} {read:7.0} {merge:7.0}");
    }
    Ok(())
}
