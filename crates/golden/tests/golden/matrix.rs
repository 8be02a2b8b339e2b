//! One scene, one hash: whatever threads, order of tiles, shards, vector unit, or build. Debug and release builds, and
//! builds for other processors, run this against the same file of hashes.
//!
//! `JUGGLER_MATRIX=wide cargo test --release -p juggler-golden --test golden matrix::` takes larger pictures and all scenes.
//! After a change that is meant to change pictures: `JUGGLER_BLESS=1 cargo test -p juggler-golden --test golden matrix::`.

use juggler::camera::film::Film;
use juggler::film::share::Work;
use juggler::film::{Merge, PartError, Share, Wanted, write};
use juggler::imaging::Options;
use juggler::render::{Control, Scheduler};
use juggler::scene::{Scene, built_in_scenes};
use juggler::world::simd_levels;
use juggler::{Error, Limit, Origin, Picture, Settings};
use juggler_math::testing::skipped;
use rayon::ThreadPoolBuilder;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

const THREADS: [usize; 4] = [1, 2, 3, 8];
const ORDERS: [Scheduler; 3] = [Scheduler::WorkStealing, Scheduler::RowQueue, Scheduler::StaticRows];
const SHARDS: [u32; 3] = [1, 2, 5];

/// Frames of scenes with the shutter open.
const MOVING: [(&str, &str, f64, [f64; 2]); 2] =
    [("juggler-in-motion", "juggler", 7.0, [0.0, 1.0]), ("juggler-from-before", "juggler", 12.5, [-0.25, 0.25])];

/// How much is rendered.
struct Extent {
    width: u32,
    samples: u32,
    /// The slowest scenes of the narrow run are left out: `hashes.rs` has them.
    scenes: fn(&str) -> bool,
}

const NARROW: Extent =
    Extent { width: 24, samples: 20, scenes: |name| !["marbles", "blossom", "evening-cradle"].contains(&name) };
const WIDE: Extent = Extent { width: 96, samples: 52, scenes: |_| true };

fn picture(name: &str, extent: &Extent, limit: Limit) -> Picture {
    let moving = MOVING.iter().find(|moving| moving.0 == name);
    let scene = match moving {
        Some((_, name, frame, _)) => Scene::built_in(name).unwrap().at_frame(*frame).unwrap(),
        None => Scene::built_in(name).unwrap(),
    };
    let shutter = moving.map(|moving| moving.3);
    let [width, height] = scene.description.render.size.map(f64::from);
    let height = (f64::from(extent.width) * height / width).round().max(1.0) as u32;
    let settings = Settings {
        size: Some([extent.width, height]),
        samples: Some(extent.samples),
        shutter,
        limit,
        ..Settings::default()
    };
    let picture = Picture::new(&scene, &settings).unwrap();
    assert_eq!(picture.world().moves(), moving.is_some(), "{name}");
    picture
}

/// Row by row.
fn streamed(picture: &Picture, order: Scheduler) -> String {
    picture.render(order, &Control::default(), |_| Ok::<(), Error>(())).unwrap().hash
}

/// Shards in files, merged.
fn sharded(picture: &Picture, count: u32, folder: &Path) -> String {
    let header = picture.header(Options::default());
    let files: Vec<_> = (0..count)
        .map(|index| {
            let share = Share { index, count, ..Share::whole(picture.samples()) };
            let mut description = picture.description(&Origin::default(), &header, share);
            let units = Work::of(&description).share(index, count);
            let film = Film::of(picture.layout(), units.into_iter().map(|unit| (unit.tile, unit.samples)));
            picture.expose(&film, &Control::default()).unwrap();
            description.finished = picture.is_finished(&film);
            let file = folder.join(format!("{index}.jfilm"));
            write(&file, &description, film.tiles()).unwrap();
            file
        })
        .collect();
    Merge::open(&files, Wanted::Whole).unwrap().rows(|_| Ok::<(), PartError>(())).unwrap().hash
}

/// How a picture is rendered: streamed in some order, or in shards.
#[derive(Clone, Copy, Debug)]
enum Method {
    Streamed(Scheduler),
    Shards(u32),
}

fn methods() -> impl Iterator<Item = Method> {
    ORDERS.into_iter().map(Method::Streamed).chain(SHARDS.into_iter().map(Method::Shards))
}

/// Whether a combination of the n-th vector unit, number of threads and method is rendered.
/// Optimized builds render all combinations. Unoptimized builds are far slower: they render each
/// pair of a vector unit and a method once and rotate the number of threads, so that each vector
/// unit also meets every number of threads.
fn is_rendered(level: usize, threads: usize, method: usize) -> bool {
    !cfg!(debug_assertions) || threads == (level + method) % THREADS.len()
}

/// The scene's one hash, by all methods.
fn hash(name: &str, extent: &Extent) -> String {
    let folder = tempfile::tempdir().unwrap();
    let mut expected = None;
    for (l, level) in simd_levels().into_iter().enumerate() {
        let picture = picture(name, extent, Limit::Samples).with_simd_level(level);
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

/// Names the vector units that the kernels know and this machine lacks.
fn report_missing_vector_units() {
    let known: &[&str] = if cfg!(target_arch = "x86_64") { &["Sse2", "Sse4_2", "Avx2", "Avx512"] } else { &[] };
    let present = format!("{:?}", simd_levels());
    for unit in known.iter().filter(|unit| !present.contains(**unit)) {
        skipped(&format!("vector units: this machine has no {unit}"));
    }
}

/// Calls a function for each name, on as many threads as the machine has: most pictures are too small for several threads of
/// their own. The results are in the order of the names.
fn beside_each_other<T: Send>(names: &[&str], call: impl Fn(&str) -> T + Sync) -> Vec<T> {
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
fn one_scene_one_hash() {
    report_missing_vector_units();
    let wide = std::env::var_os("JUGGLER_MATRIX").is_some_and(|value| value == "wide");
    let extent = if wide { &WIDE } else { &NARROW };
    let still = built_in_scenes().iter().map(|scene| scene.name).filter(|name| (extent.scenes)(name));
    let names: Vec<&str> = still.chain(MOVING.iter().map(|moving| moving.0)).collect();
    assert!(names.len() >= 20);
    let found = beside_each_other(&names, |name| format!("{name} {}\n", hash(name, extent))).concat();
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
fn noise_gives_one_hash_too() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["step-12b", "depth-of-field", "cornell-cube"] {
        let extent = Extent { width: 48, samples: 256, ..NARROW };
        let picture = picture(name, &extent, Limit::Noise(0.01));
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
