//! Benchmark of light trees: nanoseconds per sample, per probability, and per light for the build.
//! `cargo bench -p juggler-light --bench light_tree`.
#![allow(clippy::print_stdout)]

use juggler_light::emitter::{LightBounds, LightTree};
use juggler_math::{Aabb, Vec3, hash, vec3};
use std::hint::black_box;
use std::time::Instant;

const QUERIES: u32 = 200_000;
const RUNS: usize = 5;

fn unit(i: u32, k: u32) -> f32 {
    hash::unit_f32(hash::mix(hash::combine(i, k)))
}

fn point(i: u32, k: u32) -> Vec3 {
    vec3(unit(i, k), unit(i, k + 1), unit(i, k + 2)) * 2.0 - Vec3::ONE
}

/// Small surfaces with random orientations, and some point lights.
fn light(i: u32) -> LightBounds {
    let (center, bulb) = (point(i, 0), i.is_multiple_of(4));
    let cos_theta_o = if bulb { -1.0 } else { 1.0 };
    let bounds = Aabb { min: center, max: center }.grown(0.001);
    let axis = point(i, 3).normalize();
    LightBounds { bounds, axis, cos_theta_o, cos_theta_e: 0.0, power: unit(i, 6) + 0.1, two_sided: false }
}

/// Minimum time of [`RUNS`] runs, in nanoseconds per query.
fn nanoseconds(mut query: impl FnMut(u32) -> f32) -> f64 {
    let run = |_| {
        let start = Instant::now();
        let sum: f32 = (0..QUERIES).map(&mut query).sum();
        black_box(sum);
        start.elapsed().as_secs_f64() * 1e9 / f64::from(QUERIES)
    };
    (0..RUNS).map(run).fold(f64::INFINITY, f64::min)
}

fn main() {
    println!("{:>9} {:>9} {:>9} {:>9} {:>9}", "lights", "ns/pick", "ns/chance", "ns built", "bytes");
    for count in [1, 8, 10, 100, 1000, 10_000, 100_000, 1_000_000] {
        let lights: Vec<LightBounds> = (0..count).map(light).collect();
        let start = Instant::now();
        let tree = LightTree::build(&lights);
        let build = start.elapsed().as_secs_f64() * 1e9 / f64::from(count);
        let place = |i: u32| (point(i, 10), point(i, 13).normalize());
        let empty = nanoseconds(|i| place(i).0.x + place(i).1.x + unit(i, 16));
        let pick = nanoseconds(|i| {
            let (at, normal) = place(i);
            tree.sample(at, normal, unit(i, 16)).map_or(0.0, |pick| pick.probability)
        });
        let probability = nanoseconds(|i| {
            let (at, normal) = place(i);
            tree.probability(at, normal, (unit(i, 16) * count as f32) as u32)
        });
        let bytes = tree.heap_bytes() as f64 / f64::from(count);
        println!("{count:>9} {:>9.1} {:>9.1} {build:>9.1} {bytes:>9.1}", pick - empty, probability - empty);
    }
}
