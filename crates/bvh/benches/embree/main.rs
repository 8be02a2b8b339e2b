//! Benchmark of Juggler against Embree 4: same meshes, same rays, measured alternately in one
//! process (one process for each number of build threads).
//!
//! Embree is not needed to build this; the library is loaded if `EMBREE_LIB` gives its path. The
//! wheel `embreex` from the Python package index contains one:
//!
//! ```sh
//! pip download --no-deps embreex==4.4.0.post1 && unzip embreex-*.whl 'embreex.libs/*'
//! EMBREE_LIB=$(ls $PWD/embreex.libs/libembree4-*) \
//!     cargo bench -p juggler-bvh --bench embree -- blob hall repeats=9
//! ```
//!
//! Without further words, the small scenes, all kinds of rays and all calls are measured.
//! `rates.rs` defines the comparisons. Rates of one thread use its CPU time, which other programs
//! disturb least. Ratios are medians of the ratios of each repeat.
#![allow(clippy::print_stdout, clippy::print_stderr)]

mod builds;
mod check;
mod ffi;
mod layout;
mod options;
mod rates;
mod targets;
mod tracers;

use check::Differences;
use ffi::{Api, Device, EmbreeMesh, Scene};
use juggler_bvh::TriangleBvh;
use juggler_raybench::kernel;
use juggler_raybench::meshes::MeshSpec;
use juggler_raybench::{Mesh, RaySet, rays};
use options::{Call, Options};
use std::ffi::OsStr;
use std::process::{Command, ExitCode};
use targets::Targets;
use tracers::{Tracer, Tree};

fn main() -> ExitCode {
    let Some(path) = std::env::var_os("EMBREE_LIB") else {
        println!("skipped: EMBREE_LIB does not say where Embree 4 is; docs/benchmarks.md says where to get it");
        return ExitCode::SUCCESS;
    };
    match run(&path) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(path: &OsStr) -> Result<(), String> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let options = Options::read(words.iter().cloned())?;
    // Embree's tracing threads are ours; its own threads only build.
    let threads = if options.rays > 0 { 1 } else { options.build_threads.first().copied().unwrap_or(1) };
    let api = Api::open(path)?;
    let device = Device::new(&api, threads)?;
    let mut targets = Targets::default();
    for (name, spec) in &options.scenes {
        scene(&device, threads, (name, spec), &options, &mut targets)?;
    }
    targets.print();
    options
        .build_threads
        .iter()
        .filter(|other| **other != threads)
        .try_for_each(|other| measure_in_child(&words, *other))
}

/// Measures the builds with another number of threads, in a process with an Embree device of its
/// own.
fn measure_in_child(words: &[String], threads: usize) -> Result<(), String> {
    let program = std::env::current_exe().map_err(|error| error.to_string())?;
    let mut command = Command::new(program);
    let status = command.args(words).arg(format!("build={threads}")).arg("rays=0").status();
    let done = status.map_err(|error| error.to_string())?.success();
    if done { Ok(()) } else { Err(format!("the builds with {threads} threads failed")) }
}

fn scene(
    device: &Device,
    threads: usize,
    (name, spec): (&str, &MeshSpec),
    options: &Options,
    targets: &mut Targets,
) -> Result<(), String> {
    let mesh = spec.make();
    println!("\n{name}: {} triangles, {:?} trees", mesh.triangles.len(), options.quality);
    let embree_mesh = device.load(&mesh)?;
    if options.build_threads.contains(&threads) {
        builds::measure(&embree_mesh, &mesh, threads, options.repeats, targets)?;
    }
    if options.rays == 0 {
        return Ok(());
    }
    println!("\n  answers of Juggler and of Embree {}", device.version());
    trace(&embree_mesh, &mesh, options, targets)
}

fn trace(embree_mesh: &EmbreeMesh, mesh: &Mesh, options: &Options, targets: &mut Targets) -> Result<(), String> {
    let (fast, _) = embree_mesh.build(options.quality, false)?;
    let (robust, _) = embree_mesh.build(options.quality, true)?;
    let bvh = kernel::build(mesh, options.quality).map_err(|error| error.to_string())?;
    let mut sets = rays::make(mesh, &bvh, options.rays).to_vec();
    let bvhs = kernel::with_tests(bvh);
    sets.retain(|set| options.kinds.contains(&set.kind));
    for (test, bvh) in &bvhs {
        differences(&sets, if test.watertight { &robust } else { &fast }, bvh, test.name);
    }
    let mut tracers = Vec::new();
    for (test, watertight, scene) in [("fast", false, &fast), ("robust", true, &robust)] {
        let compared = |call: &Call| options.calls.iter().any(|ours| ours.is_comparable_to(*call));
        let calls = Call::EMBREES.into_iter().filter(compared);
        tracers.extend(calls.map(|call| Tracer { test, watertight, call, tree: Tree::Embree(scene) }));
    }
    for (test, bvh) in &bvhs {
        let calls = options.calls.iter().copied();
        let tracer = |call| Tracer { test: test.name, watertight: test.watertight, call, tree: Tree::Juggler(bvh) };
        tracers.extend(calls.map(tracer));
    }
    rates::measure(&tracers, &sets, options, targets);
    Ok(())
}

fn differences(sets: &[RaySet], embree: &Scene, juggler: &TriangleBvh, test: &str) {
    for set in sets {
        println!("  {test}, {}: {}", set.kind.name(), Differences::of(set, embree, juggler));
    }
}
