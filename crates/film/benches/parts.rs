//! How fast parts are packed, written, read and merged, and how large they are, against their sums as plain floats:
//! `cargo bench -p juggler-film`. The films are those of built-in scenes.
#![allow(clippy::print_stdout, reason = "that is its purpose")]

use juggler::camera::film::{BLOCK, Layout, Rect, Run, Sum, Tile};
use juggler::prelude::*;
use juggler_film::share::Work;
use juggler_film::{Chunk, Description, Layered, Merge, Part, PartError, Share, Stop, Wanted, write};
use juggler_raybench::clock::{Of, Stopwatch};
use std::error::Error;
use std::hint::black_box;
use std::path::{Path, PathBuf};

const SIZE: [u32; 2] = [640, 360];
const REGION: Rect = Rect { x: 0, y: 0, width: SIZE[0], height: SIZE[1] };
/// Scenes, and of how many blocks of samples.
const FILMS: [(&str, u32); 4] = [("juggler", 4), ("marbles", 1), ("marbles", 11), ("blossom", 4)];
const SHARES: u32 = 5;

/// A film with a seed for each block: a block's sum is all that is kept of it.
fn film(name: &str, blocks: u32) -> Result<Vec<Tile>, Box<dyn Error>> {
    let scene = Scene::built_in(name)?;
    let layout = Layout::new(REGION);
    let mut tiles: Vec<Tile> = (0..layout.tiles()).filter_map(|number| layout.tile(number)).map(Tile::new).collect();
    for block in 0..blocks {
        let seed = Some(block.into());
        let settings = Settings { size: Some(SIZE), samples: Some(BLOCK), seed, ..Settings::default() };
        let image = Picture::new(&scene, &settings)?.image(&Control::default())?;
        for tile in &mut tiles {
            let Rect { x, y, width, .. } = tile.pixels();
            let place = |pixel: u32| (y + pixel / width) * SIZE[0] + x + pixel % width;
            let pixels = (0..tile.pixels().area() as u32).filter_map(|pixel| image.pixels().get(place(pixel) as usize));
            let sum = |mean: &Rgb| (*mean * BLOCK as f32).to_array().map(f64::from);
            let sums = pixels.map(|mean| Sum { total: sum(mean), ..Sum::default() }).collect();
            tile.add(Run::new(block * BLOCK..(block + 1) * BLOCK, sums))?;
        }
    }
    Ok(tiles)
}

fn description(samples: u32, share: Share) -> Description {
    Description {
        software: "Juggler".into(),
        command: "juggler render".into(),
        scene: "bench".into(),
        frame: 0.0,
        size: SIZE,
        region: REGION,
        samples,
        stop: Stop::Samples,
        clamped: false,
        layers: Layered::default(),
        share,
        finished: true,
        fingerprint: Default::default(),
        tone: serde_json::Value::Null,
        metadata: Vec::new(),
        viewpoint: None,
    }
}

/// Megabytes of plain floats in a second of one processor, the best of some runs.
fn speed(raw: usize, mut work: impl FnMut() -> Result<(), Box<dyn Error>>) -> Result<f64, Box<dyn Error>> {
    let mut least = f64::INFINITY;
    for _ in 0..9 {
        let watch = Stopwatch::start(Of::Thread);
        work()?;
        least = least.min(watch.elapsed().cpu);
    }
    Ok(raw as f64 * 1e-6 / least)
}

/// The film in shares.
fn shares(folder: &Path, tiles: &[Tile], samples: u32) -> Result<Vec<PathBuf>, Box<dyn Error>> {
    let mut files = Vec::new();
    for index in 0..SHARES {
        let description = description(samples, Share { index, count: SHARES, ..Share::whole(samples) });
        let units = Work::of(&description).share(index, SHARES);
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
        let samples = blocks * BLOCK;
        let raw: usize = tiles.iter().flat_map(Tile::runs).map(|run| run.sums.len() * 36).sum();
        let whole = description(samples, Share::whole(samples));
        let pack = speed(raw, || {
            black_box(tiles.iter().map(|tile| Chunk::encode(tile, false)).collect::<Vec<_>>());
            Ok(())
        })?;
        let numbered = || (0..).zip(tiles.iter().cloned());
        let bytes = write(&file, &whole, numbered())?;
        let write = speed(raw, || Ok(write(&file, &whole, numbered()).map(|_| ())?))?;
        let read = speed(raw, || Ok(Part::open(&file)?.verify()?))?;
        let files = shares(folder.path(), &tiles, samples)?;
        let merge = speed(raw, || {
            let merge = Merge::open(&files, Wanted::Whole)?;
            merge.rows(|_| Ok::<(), PartError>(()))?;
            Ok(())
        })?;
        let share = bytes as f64 / raw as f64;
        let megabytes = raw as f64 * 1e-6;
        println!("{scene:8} {blocks:6} {megabytes:10.1} {share:9.3} {pack:7.0} {write:7.0} {read:7.0} {merge:7.0}");
    }
    Ok(())
}
