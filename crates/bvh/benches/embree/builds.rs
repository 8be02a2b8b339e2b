//! Build times of Juggler and Embree, measured alternately.

use crate::ffi::EmbreeMesh;
use crate::targets::Targets;
use juggler_bvh::Quality;
use juggler_raybench::Mesh;
use juggler_raybench::clock::{CpuClock, Elapsed, Stopwatch};
use juggler_raybench::kernel;
use juggler_raybench::measure::median;

/// Times of one build per repeat, and the size of the tree in bytes.
#[derive(Default)]
struct Times {
    elapsed: Vec<Elapsed>,
    bytes: usize,
}

/// Measures and prints a table for `threads` threads, which must be those of Embree's device.
pub fn measure(
    embree_mesh: &EmbreeMesh,
    mesh: &Mesh,
    threads: usize,
    repeats: usize,
    targets: &mut Targets,
) -> Result<(), String> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().map_err(|error| error.to_string())?;
    println!("\n  build, {threads} threads {:>21}{:>10}{:>10}{:>10}", "wall s", "CPU s", "bytes/tri", "speed");
    Quality::ALL.into_iter().try_for_each(|quality| compare(embree_mesh, mesh, quality, repeats, &pool, targets))
}

fn compare(
    embree_mesh: &EmbreeMesh,
    mesh: &Mesh,
    quality: Quality,
    repeats: usize,
    pool: &rayon::ThreadPool,
    targets: &mut Targets,
) -> Result<(), String> {
    let threads = pool.current_num_threads();
    let (mut theirs, mut ours) = (Times::default(), Times::default());
    for _ in 0..repeats {
        let (scene, elapsed) = embree_mesh.build(quality, false)?;
        (theirs.bytes, _) = (scene.bytes, theirs.elapsed.push(elapsed));
        let (bvh, elapsed) = pool.install(|| {
            let watch = Stopwatch::start(CpuClock::Process);
            (kernel::build(mesh, quality), watch.elapsed())
        });
        ours.bytes = bvh.map_err(|error| error.to_string())?.bytes();
        ours.elapsed.push(elapsed);
    }
    let per_triangle = |bytes: usize| bytes as f64 / mesh.triangles.len() as f64;
    print(&format!("Embree {quality:?}"), &theirs, per_triangle(theirs.bytes), None);
    let pairs = theirs.elapsed.iter().zip(&ours.elapsed);
    // CPU time is steadier with one thread; with more threads wall-clock time is what matters.
    let speed = median(pairs.map(|(a, b)| if threads == 1 { a.cpu / b.cpu } else { a.wall / b.wall }));
    print(&format!("Juggler {quality:?}"), &ours, per_triangle(ours.bytes), Some(speed));
    targets.add(&format!("build speed, {quality:?}, {threads} threads"), speed);
    if threads == 1 {
        let smaller = theirs.bytes as f64 / ours.bytes as f64;
        targets.add(&format!("bytes a triangle, Embree's to ours, {quality:?}"), smaller);
    }
    Ok(())
}

fn print(label: &str, times: &Times, bytes: f64, speed: Option<f64>) {
    let wall = median(times.elapsed.iter().map(|time| time.wall));
    let cpu = median(times.elapsed.iter().map(|time| time.cpu));
    let speed = speed.map_or_else(String::new, |speed| format!("{speed:.2}x"));
    println!("  {label:30}{wall:>10.3}{cpu:>10.3}{bytes:>10.1}{speed:>10}");
}
