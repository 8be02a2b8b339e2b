//! Time and memory of a million spheres as instances, each with a number that colors it, until the
//! picture is ready to render: `cargo bench -p juggler --bench instances -- CASE`, with the case
//! `asset` (arrays of an asset), `radii` (the same with a radius each), `object` (arrays of the object
//! itself) or `file` (a PLY file, which the first run writes). The peak memory is that of the whole
//! process, so a run has one case.
#![allow(clippy::print_stdout, reason = "that is its purpose")]

use juggler::prelude::*;
use serde_json::json;
use std::path::Path;
use std::time::Instant;

/// Number of spheres.
const SPHERES: usize = 1_000_000;
/// Seed of the random numbers.
const SEED: u64 = 1;

/// Numbers from 0 to 1 of a linear congruential generator.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f32 / (1 << 24) as f32
    }
}

fn main() -> Result<(), Error> {
    let case = std::env::args().skip(1).find(|word| !word.starts_with('-')).unwrap_or_default();
    let file = std::env::temp_dir().join("juggler-instances/points.ply");
    let scene = match case.as_str() {
        "asset" | "radii" => with_file("points").asset("points", Asset::from_instances(spheres(case == "radii"))),
        "object" => around(spheres(false)),
        "file" if file.exists() => with_file(&file.to_string_lossy()),
        "file" => return write(&file),
        _ => {
            println!("cases: asset, radii, object, file");
            return Ok(());
        }
    };
    println!("{SPHERES} spheres, before: {}", memory("VmRSS:"));
    let (start, before) = (Instant::now(), cpu_seconds());
    let picture = Picture::new(&scene, &Settings::default())?;
    let (seconds, cpu) = (start.elapsed().as_secs_f64(), cpu_seconds() - before);
    println!("ready to render after {seconds:.2} s, {cpu:.2} s of CPU; peak {}", memory("VmHWM:"));
    let stats = picture.world().geometry_stats();
    let each = |bytes: usize| bytes as f64 / SPHERES as f64;
    println!("a sphere: {:.0} bytes, {:.0} of the hierarchy", each(stats.geometry_bytes), each(stats.bvh_bytes));
    Ok(())
}

/// A million spheres in a cube, with an attribute, and perhaps a radius each.
fn spheres(with_radii: bool) -> Instances {
    let mut numbers = Numbers(SEED);
    let positions = (0..SPHERES).map(|_| vec3(numbers.next(), numbers.next(), numbers.next()) * 100.0).collect();
    let values = (0..SPHERES).map(|_| numbers.next()).collect();
    let radii = (0..if with_radii { SPHERES } else { 0 }).map(|_| ScaleFactors::All(0.5 + numbers.next()));
    let value = InstanceAttribute::new(1, AttributeData::F32(values));
    let attributes = [("value".to_owned(), value)].into_iter().collect();
    Instances { positions, scales: radii.collect(), attributes, ..Instances::default() }
}

fn with_file(name: &str) -> Scene {
    around(Instances::from_file(name))
}

/// A scene of spheres with these instances, which their attribute colors.
fn around(instances: Instances) -> Scene {
    let stops = json!([{"position": 0, "color": 0}, {"position": 1, "color": [1, 0.5, 0]}]);
    let text = json!({"version": 1,
        "textures": {"value": {"attribute": {"name": "value"}}, "map": {"ramp": {"input": "value", "stops": stops}}},
        "materials": {"dots": {"diffuse": {"reflectance": "map"}}}});
    let scene = Scene::from_json(text.to_string(), "instances").unwrap_or_default();
    scene.add(Object::new(Sphere { radius: 0.3 }).material_named("dots").instances(instances))
}

/// Writes the file of points.
fn write(file: &Path) -> Result<(), Error> {
    let scene = Scene::new().asset("points.ply", Asset::from_instances(spheres(false)));
    let folder = file.parent().unwrap_or(Path::new(""));
    std::fs::create_dir_all(folder).unwrap_or_default();
    scene.save(folder.join("scene.json"))?;
    println!("wrote {}; run it again", file.display());
    Ok(())
}

/// Memory of the process in MB; 0 if the system does not report it.
fn memory(key: &str) -> String {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let found = status.lines().find_map(|line| line.strip_prefix(key)?.split_whitespace().next()?.parse::<f64>().ok());
    format!("{:.0} MB", found.unwrap_or_default() / 1024.0)
}

/// CPU time of the process in seconds; 0 if the system does not report it.
fn cpu_seconds() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields = stat.rsplit(") ").next().unwrap_or_default().split(' ').skip(11).take(2);
    fields.filter_map(|ticks| ticks.parse::<f64>().ok()).sum::<f64>() / 100.0
}
