//! Juggler's rays against Embree 4's, in turns, on the same meshes and the same rays, in one process.
//!
//! Embree is not needed to build this; the library is opened when `EMBREE_LIB` says where it is. The wheel `embreex` from
//! the Python package index holds one:
//!
//! ```sh
//! pip download --no-deps embreex==4.4.0.post1 && unzip embreex-*.whl 'embreex.libs/*'
//! EMBREE_LIB=$(ls $PWD/embreex.libs/libembree4-*) cargo bench -p juggler-bvh --bench embree -- blob hall repeats=9
//! ```
//!
//! Without further words: the small scenes, all kinds of rays, all calls. `rates.rs` says what is compared with what.
//! Rates of one thread are by its own time on the processor, which other programs disturb least; ratios are medians of
//! the ratios of each repeat.
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
use ffi::{Api, Device, Scene};
use juggler_bvh::TriangleBvh;
use juggler_raybench::kernel;
use juggler_raybench::meshes::Recipe;
use juggler_raybench::{RaySet, rays};
use options::{Call, Options};
use std::process::ExitCode;
use targets::Targets;
use tracers::{Tracer, Tree};

fn main() -> ExitCode {
    let Some(path) = std::env::var_os("EMBREE_LIB") else {
        println!("skipped: EMBREE_LIB does not say where Embree 4 is; docs/benchmarks.md says where to get it");
        return ExitCode::SUCCESS;
    };
    let run = || {
        let options = Options::read(std::env::args().skip(1))?;
        let api = Api::open(&path)?;
        let mut targets = Targets::default();
        for (name, recipe) in &options.scenes {
            scene(&api, name, recipe, &options, &mut targets)?;
        }
        targets.print();
        Ok::<(), String>(())
    };
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn scene(api: &Api, name: &str, recipe: &Recipe, options: &Options, targets: &mut Targets) -> Result<(), String> {
    let mesh = recipe.make();
    println!("\n{name}: {} triangles, {:?} trees", mesh.triangles.len(), options.quality);
    builds::measure(api, &mesh, options, targets)?;
    let device = Device::new(api, 1, &mesh)?;
    let (fast, _) = device.build(options.quality, false)?;
    let (robust, _) = device.build(options.quality, true)?;
    println!("\n  answers of Juggler and of Embree {}", device.version());
    let bvh = kernel::build(&mesh, options.quality).map_err(|error| error.to_string())?;
    let mut sets = rays::make(&mesh, &bvh, options.rays).to_vec();
    let bvhs = kernel::with_tests(bvh);
    sets.retain(|set| options.kinds.contains(&set.kind));
    for (test, bvh) in &bvhs {
        differences(&sets, if test.watertight { &robust } else { &fast }, bvh, test.name);
    }
    let mut tracers = Vec::new();
    for (test, watertight, scene) in [("fast", false, &fast), ("robust", true, &robust)] {
        let compared = |call: &Call| options.calls.iter().any(|ours| ours.rivals(*call));
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
