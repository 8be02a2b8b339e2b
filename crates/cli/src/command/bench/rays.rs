//! `juggler bench rays`: rate of ray casting alone, to compare machines and versions of Juggler.

mod report;

use crate::console;
use crate::failure::Failure;
use crate::source;
use crate::value::one_of;
use clap::Args;
use juggler::math::Aabb;
use juggler::mesh::{self, MeshError, MeshErrorKind, MeshLimits};
use juggler_bvh::{Quality, TriangleBvh};
use juggler_raybench::clock::{CpuClock, Stopwatch};
use juggler_raybench::kernel::{self, Kernel, NamedTest, Scratch};
use juggler_raybench::measure::{self, Trace, median};
use juggler_raybench::meshes::{BUILT_IN, MeshSpec, MeshSpecError};
use juggler_raybench::rays::{self, RaySet};
use juggler_raybench::{Kind, Mesh, View};
use rayon::{ThreadPool, ThreadPoolBuilder};
use report::{Build, Rate, Report};
use std::path::Path;

/// Default meshes: three small ones of different character, which take half a minute at most.
const MESHES: [&str; 3] = ["blob", "classroom", "hall"];
/// Total time in seconds up to which builds are repeated.
const QUICK_BUILDS: f64 = 0.3;

/// Flags of `juggler bench rays`.
#[derive(Debug, Args)]
#[command(after_help = built_in_meshes())]
pub struct Rays {
    /// OBJ, PLY or STL files, or built-in meshes [default: blob, classroom and hall]
    #[arg(value_name = "MESH")]
    meshes: Vec<String>,
    /// Kinds of rays, separated by commas [default: all]
    #[arg(long = "kind", value_name = "KIND", value_delimiter = ',', value_parser = one_of(Kind::ALL, Kind::name))]
    kinds: Vec<Kind>,
    /// Kernels: single rays, batches of unrelated rays, packets of eight [default: all]
    #[arg(long = "kernel", value_name = "KERNEL", value_delimiter = ',', value_parser = one_of(Kernel::ALL, Kernel::name))]
    kernels: Vec<Kernel>,
    /// Quality of the hierarchy that is traced; all three are built
    #[arg(long, value_name = "QUALITY", default_value = "balanced", value_parser = one_of(Quality::ALL, report::quality))]
    quality: Quality,
    /// Number of camera rays
    #[arg(long, value_name = "N", default_value_t = 50_000, value_parser = clap::value_parser!(u32).range(64..=2_073_600))]
    rays: u32,
    /// Number of measurements; the median is reported
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..=1000))]
    repeats: u32,
    /// Number of threads to compare with one thread [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

fn built_in_meshes() -> String {
    let line = |kind: &juggler_raybench::meshes::MeshKind| format!("  {:10} {} [{}]", kind.name, kind.about, kind.size);
    let lines: Vec<String> = BUILT_IN.iter().map(line).collect();
    format!("Built-in meshes, NAME or NAME:SIZE, generated, and identical on every machine:\n{}", lines.join("\n"))
}

impl Rays {
    /// Measures and reports mesh by mesh.
    pub fn run(self) -> Result<(), Failure> {
        let names: Vec<&str> = self.meshes.iter().map(String::as_str).collect();
        let names = if names.is_empty() { MESHES.to_vec() } else { names };
        // Resolve all names before the first measurement.
        let subjects: Vec<MeshSource> = names.into_iter().map(MeshSource::named).collect::<Result<_, _>>()?;
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let threads = self.threads.map_or(cores, usize::from);
        let pool = ThreadPoolBuilder::new().num_threads(threads).build();
        let pool = pool.map_err(|error| Failure::System(format!("cannot start threads: {error}")))?;
        let mut reports = Vec::new();
        for mesh_source in &subjects {
            let report = self.measure(mesh_source, &pool)?;
            if !self.json {
                let gap = if reports.is_empty() { "" } else { "\n" };
                console::print_result(&format!("{gap}{}", report.to_words()))?;
            }
            reports.push(report);
        }
        if self.json { console::print_result(&report::to_json(&reports)) } else { Ok(()) }
    }

    fn measure(&self, mesh_source: &MeshSource, pool: &ThreadPool) -> Result<Report, Failure> {
        let mesh = mesh_source.mesh()?;
        let mut report = Report::new(mesh_source.name(), mesh.triangles.len(), pool.current_num_threads());
        let mut traced = None;
        for quality in Quality::ALL {
            let (bvh, build) = pool.install(|| self.build(&mesh, quality))?;
            report.builds.push(build);
            if quality == self.quality {
                traced = Some(bvh);
            }
        }
        let Some(bvh) = traced else { return Ok(report) };
        let sets = rays::make(&mesh, &bvh, self.rays as usize);
        let bvhs = kernel::with_tests(bvh);
        for set in sets {
            if self.kinds.is_empty() || self.kinds.contains(&set.kind) {
                self.trace(&set, &bvhs, &mut report)?;
            }
        }
        Ok(report)
    }

    /// Builds a hierarchy, and repeats quick builds for a median time.
    fn build(&self, mesh: &Mesh, quality: Quality) -> Result<(TriangleBvh, Build), Failure> {
        let (all, mut seconds) = (Stopwatch::start(CpuClock::Process), Vec::new());
        loop {
            let watch = Stopwatch::start(CpuClock::Process);
            let bvh = kernel::build(mesh, quality).map_err(|error| Failure::Invalid(error.to_string()))?;
            seconds.push(watch.elapsed().wall);
            if seconds.len() >= self.repeats as usize || all.elapsed().wall > QUICK_BUILDS {
                let build =
                    Build { quality, seconds: median(seconds), bytes: bvh.bytes(), sah_cost: bvh.stats().sah_cost };
                return Ok((bvh, build));
            }
        }
    }

    fn trace(&self, set: &RaySet, bvhs: &[(NamedTest, TriangleBvh)], report: &mut Report) -> Result<(), Failure> {
        let query = set.kind.query();
        let kernels = Kernel::ALL.into_iter().filter(|k| self.kernels.is_empty() || self.kernels.contains(k));
        let pairs: Vec<_> =
            kernels.flat_map(|kernel| bvhs.iter().map(move |(test, bvh)| (test, kernel, bvh))).collect();
        let tracers: Vec<_> = pairs
            .iter()
            .map(|(_, kernel, bvh)| move |rays: &[_], scratch: &mut Scratch| kernel.trace(bvh, query, rays, scratch))
            .collect();
        let traces: Vec<Trace> = tracers.iter().map(|tracer| tracer as Trace).collect();
        let mut counts = vec![1, report.threads];
        counts.dedup();
        for threads in counts {
            let timings = measure::measure_alternately(&set.rays, &traces, threads, self.repeats as usize);
            for ((test, kernel, _), timing) in pairs.iter().zip(timings) {
                report.add(Rate { test: test.name, kernel: *kernel, kind: set.kind, threads, timing })?;
            }
        }
        Ok(())
    }
}

/// A mesh to measure, before it is loaded or generated.
enum MeshSource<'n> {
    File(&'n str),
    BuiltIn(&'n str, MeshSpec),
}

impl<'n> MeshSource<'n> {
    fn named(name: &'n str) -> Result<Self, Failure> {
        let path = Path::new(name);
        match MeshSpec::parse(name) {
            _ if path.is_dir() => Err(Failure::Invalid(format!("`{name}` is a folder, not a mesh file"))),
            _ if path.exists() => Ok(Self::File(name)),
            Ok(spec) => Ok(Self::BuiltIn(name, spec)),
            Err(MeshSpecError::Unknown) => Err(source::unknown(name, "mesh", BUILT_IN.map(|kind| kind.name))),
            Err(error) => Err(Failure::Invalid(error.to_string())),
        }
    }

    fn name(&self) -> &'n str {
        match self {
            Self::File(name) | Self::BuiltIn(name, _) => name,
        }
    }

    fn mesh(&self) -> Result<Mesh, Failure> {
        match self {
            Self::BuiltIn(_, spec) => Ok(spec.make()),
            Self::File(name) => {
                let found = mesh::load(Path::new(name), &MeshLimits::default()).map_err(|error| refused(&error))?;
                for warning in found.warnings {
                    console::print_message(&format!("warning: `{name}`: {warning}"));
                }
                let view = View::around(&Aabb::from_points(found.mesh.positions.iter().copied()));
                Ok(Mesh { positions: found.mesh.positions, triangles: found.mesh.triangles, view })
            }
        }
    }
}

fn refused(error: &MeshError) -> Failure {
    let shown = error.path.display();
    match &error.kind {
        MeshErrorKind::Read(error) => Failure::file("read", shown, error),
        fault => Failure::Invalid(format!("cannot read `{shown}`: {fault}")),
    }
}
