//! One scene, one hash: for every number of threads, order of tiles, number of shards, SIMD
//! instruction set and build. Debug and release builds, and builds for other processors, run this
//! test against the same file of hashes.
//!
//! `JUGGLER_MATRIX=wide cargo test --release -p juggler-golden --test golden matrix::` renders
//! larger pictures of all scenes. After an intended change of pictures: `JUGGLER_BLESS=1 cargo test
//! -p juggler-golden --test golden matrix::`.

use super::extra::{EXTRA_SCENES, scene};
use juggler::camera::film::Film;
use juggler::film::shard::Work;
use juggler::film::{Merge, MergeGoal, PartialRenderError, ShardDescription, write};
use juggler::imaging::Options;
use juggler::render::{Control, Scheduler};
use juggler::scene::built_in_scenes;
use juggler::world::simd_levels;
use juggler::{Error, Limit, Picture, RenderOrigin, Settings};
use juggler_golden::skipped;
use rayon::ThreadPoolBuilder;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

const THREADS: [usize; 4] = [1, 2, 3, 8];
const ORDERS: [Scheduler; 3] = [Scheduler::WorkStealing, Scheduler::RowQueue, Scheduler::StaticRows];
const SHARDS: [u32; 3] = [1, 2, 5];

/// Scenes with motion blur: name, built-in scene, frame, shutter interval in frames.
const MOVING: [(&str, &str, f64, [f64; 2]); 2] =
    [("juggler-in-motion", "juggler", 7.0, [0.0, 1.0]), ("juggler-from-before", "juggler", 12.5, [-0.25, 0.25])];

/// Size of the test.
struct TestSize {
    width: u32,
    samples: u32,
    /// Whether a scene is rendered. The narrow run omits the slowest scenes, which `hashes.rs`
    /// covers.
    scenes: fn(&str) -> bool,
}

const NARROW: TestSize =
    TestSize { width: 24, samples: 20, scenes: |name| !["marbles", "blossom", "evening-cradle"].contains(&name) };
const WIDE: TestSize = TestSize { width: 96, samples: 52, scenes: |_| true };

fn picture(name: &str, test_size: &TestSize, limit: Limit) -> Picture {
    let moving = MOVING.iter().find(|moving| moving.0 == name);
    let scene = match moving {
        Some((_, name, frame, _)) => scene(name).at_frame(*frame).unwrap(),
        None => scene(name),
    };
    let shutter = moving.map(|moving| moving.3);
    let [width, height] = scene.description.render.size.map(f64::from);
    let height = (f64::from(test_size.width) * height / width).round().max(1.0) as u32;
    let settings = Settings {
        size: Some([test_size.width, height]),
        samples: Some(test_size.samples),
        shutter,
        limit,
        ..Settings::default()
    };
    let picture = Picture::new(&scene, &settings).unwrap();
    assert_eq!(picture.world().moves(), moving.is_some(), "{name}");
    picture
}

/// Renders row by row; returns the hash.
fn streamed(picture: &Picture, order: Scheduler) -> String {
    picture.render(order, &Control::default(), |_| Ok::<(), Error>(())).unwrap().hash
}

/// Renders shards to files and merges them; returns the hash.
fn sharded(picture: &Picture, count: u32, folder: &Path) -> String {
    let header = picture.header(Options::default());
    let files: Vec<_> = (0..count)
        .map(|index| {
            let shard = ShardDescription { index, count, ..ShardDescription::whole(picture.samples()) };
            let mut description = picture.description(&RenderOrigin::default(), &header, shard);
            let units = Work::from_description(&description).shard(index, count);
            let film = Film::from_tiles(picture.tiling(), units.into_iter().map(|unit| (unit.tile, unit.samples)));
            picture.render_film(&film, &Control::default()).unwrap();
            description.finished = picture.is_finished(&film);
            let file = folder.join(format!("{index}.jfilm"));
            write(&file, &description, film.tiles()).unwrap();
            file
        })
        .collect();
    Merge::open(&files, MergeGoal::Whole).unwrap().rows(|_| Ok::<(), PartialRenderError>(())).unwrap().hash
}

/// Rendering method: streamed in some order, or in shards.
#[derive(Clone, Copy, Debug)]
enum Method {
    Streamed(Scheduler),
    Shards(u32),
}

fn methods() -> impl Iterator<Item = Method> {
    ORDERS.into_iter().map(Method::Streamed).chain(SHARDS.into_iter().map(Method::Shards))
}

/// Whether to render the combination of an instruction set, a number of threads and a method, by
/// their indices. Optimized builds render all combinations. Unoptimized builds are far slower: they
/// render each pair of an instruction set and a method once and rotate the number of threads, so
/// that each instruction set is tested with every number of threads.
fn is_rendered(level: usize, threads: usize, method: usize) -> bool {
    !cfg!(debug_assertions) || threads == (level + method) % THREADS.len()
}

/// Renders a scene by all methods; returns their common hash.
fn hash(name: &str, test_size: &TestSize) -> String {
    let folder = tempfile::tempdir().unwrap();
    let mut expected = None;
    for (l, level) in simd_levels().into_iter().enumerate() {
        let picture = picture(name, test_size, Limit::Samples).with_simd_level(level);
        for (t, threads) in THREADS.into_iter().enumerate() {
            let pool = ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            for (_, method) in methods().enumerate().filter(|(m, _)| is_rendered(l, t, *m)) {
                let found = pool.install(|| match method {
                    Method::Streamed(order) => streamed(&picture, order),
                    Method::Shards(count) => sharded(&picture, count, folder.path()),
                });
                let expected = expected.get_or_insert_with(|| found.clone());
                assert_eq!(found, *expected, "{name}: {method:?}, {threads} threads, {level:?}");
            }
        }
    }
    expected.unwrap()
}

/// Reports the instruction sets that have kernels but are missing on this machine.
fn report_missing_simd_levels() {
    let known: &[&str] = if cfg!(target_arch = "x86_64") { &["Sse2", "Sse4_2", "Avx2", "Avx512"] } else { &[] };
    let present = format!("{:?}", simd_levels());
    for unit in known.iter().filter(|unit| !present.contains(**unit)) {
        skipped(&format!("vector units: this machine has no {unit}"));
    }
}

/// Calls a function for each name, on as many threads as the machine has, since most pictures are
/// too small for several threads. The results are in the order of the names.
fn map_parallel<T: Send>(names: &[&str], call: impl Fn(&str) -> T + Sync) -> Vec<T> {
    let next = AtomicUsize::new(0);
    let work = || {
        let numbers = std::iter::from_fn(|| Some(next.fetch_add(1, Ordering::Relaxed)));
        numbers.map_while(|number| Some((number, call(names.get(number)?)))).collect::<Vec<_>>()
    };
    let mut found: Vec<(usize, T)> = thread::scope(|scope| {
        let threads = thread::available_parallelism().map_or(1, usize::from);
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        workers.into_iter().flat_map(|worker| worker.join().unwrap()).collect()
    });
    found.sort_by_key(|(number, _)| *number);
    found.into_iter().map(|(_, result)| result).collect()
}

#[test]
fn scene_hashes_do_not_depend_on_threads_shards_or_vector_units() {
    report_missing_simd_levels();
    let wide = std::env::var_os("JUGGLER_MATRIX").is_some_and(|value| value == "wide");
    let test_size = if wide { &WIDE } else { &NARROW };
    let still = built_in_scenes().iter().map(|scene| scene.name).filter(|name| (test_size.scenes)(name));
    let names: Vec<&str> = still.chain(MOVING.iter().map(|moving| moving.0)).chain(EXTRA_SCENES).collect();
    assert!(names.len() >= 20);
    let found = map_parallel(&names, |name| format!("{name} {}\n", hash(name, test_size))).concat();
    if wide {
        return;
    }
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("matrix.txt");
    if std::env::var_os("JUGGLER_BLESS").is_some() {
        std::fs::write(&path, &found).unwrap();
    }
    assert_eq!(found, std::fs::read_to_string(&path).unwrap_or_default(), "hashes differ from matrix.txt");
}

#[test]
fn noise_limited_hashes_do_not_depend_on_threads_or_shards() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["step-12b", "depth-of-field", "cornell-cube"] {
        let test_size = TestSize { width: 48, samples: 256, ..NARROW };
        let picture = picture(name, &test_size, Limit::Noise(0.01));
        let hashes: Vec<String> = THREADS
            .iter()
            .flat_map(|threads| {
                let pool = ThreadPoolBuilder::new().num_threads(*threads).build().unwrap();
                SHARDS.map(|count| pool.install(|| sharded(&picture, count, folder.path())))
            })
            .collect();
        assert!(hashes.iter().all(|hash| *hash == hashes[0]), "{name}: {hashes:?}");
    }
}
