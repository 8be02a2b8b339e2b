//! Time and quality of builds: microseconds per triangle on one and two threads, SAH cost, bytes
//! per triangle. `cargo bench -p juggler-bvh --bench build`; a word after `--` selects the scenes
//! whose names contain it.
#![allow(clippy::print_stdout, clippy::unwrap_used)]

use juggler_bvh::{Quality, TriangleBvh};
use juggler_math::{Vec3, hash, vec3};
use std::hint::black_box;
use std::time::Instant;

const RUNS: usize = 5;

struct Scene {
    name: &'static str,
    positions: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
}

fn unit(i: u32, k: u32) -> f32 {
    hash::unit_f32(hash::mix(hash::combine(i, k)))
}

fn point(i: u32, k: u32) -> Vec3 {
    vec3(unit(i, k), unit(i, k + 1), unit(i, k + 2)) * 2.0 - Vec3::ONE
}

/// Unconnected triangles with the vertices `corners(i)`.
fn loose(name: &'static str, count: u32, corners: impl Fn(u32) -> [Vec3; 3]) -> Scene {
    let positions = (0..count).flat_map(corners).collect();
    Scene { name, positions, triangles: (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect() }
}

/// Small triangles at random positions in a cube.
fn soup() -> Scene {
    loose("soup", 500_000, |i| [0, 3, 6].map(|k| point(i, 9) + point(i, k) * 0.01))
}

/// Long thin triangles in random directions.
fn needles() -> Scene {
    loose("needles", 500_000, |i| [0.0, 0.001, 1.0].map(|t| point(i, 9) + point(i, 0) * 0.2 * t + point(i, 3) * 0.001))
}

/// A height field of a million quads in row order, as scanners and modelers write them.
fn terrain() -> Scene {
    let side = 1000;
    let at = |i: u32| i as f32 / side as f32 * 2.0 - 1.0;
    let position = |i: u32| vec3(at(i % (side + 1)), 0.01 * unit(i, 0), at(i / (side + 1)));
    let quad = |i: u32| {
        let corner = i / side * (side + 1) + i % side;
        let [a, b, c, d] = [corner, corner + 1, corner + side + 1, corner + side + 2];
        [[a, b, c], [b, d, c]]
    };
    let positions = (0..(side + 1) * (side + 1)).map(position).collect();
    Scene { name: "terrain", positions, triangles: (0..side * side).flat_map(quad).collect() }
}

/// Fastest of several builds, in seconds, and its tree.
fn build(scene: &Scene, quality: Quality, threads: usize) -> (f64, TriangleBvh) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let run = || {
        let start = Instant::now();
        let bvh = pool.install(|| TriangleBvh::build(&scene.positions, &scene.triangles, quality).unwrap());
        (start.elapsed().as_secs_f64(), black_box(bvh))
    };
    (0..RUNS).map(|_| run()).min_by(|a, b| a.0.total_cmp(&b.0)).unwrap()
}

fn main() {
    let requested = std::env::args().skip(1).find(|word| !word.starts_with('-')).unwrap_or_default();
    for scene in [soup(), needles(), terrain()].iter().filter(|scene| scene.name.contains(&requested)) {
        let count = scene.triangles.len() as f64;
        println!("{}: {count} triangles", scene.name);
        for quality in Quality::ALL {
            let [(one, bvh), (two, _)] = [1, 2].map(|threads| build(scene, quality, threads));
            let (one, two, bytes) = (one * 1e6 / count, two * 1e6 / count, bvh.bytes() as f64 / count);
            let cost = bvh.stats().sah_cost;
            println!(
                "    {:<9} {one:.3} us/triangle, on two threads {two:.3}; cost {cost:.2}, {bytes:.1} bytes/triangle",
                format!("{quality:?}")
            );
        }
    }
}
