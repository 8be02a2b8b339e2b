//! Traversal rates in millions of rays per second on one thread, best of several runs.
//! `cargo bench -p juggler-bvh`; a word after `--` selects the scenes whose names contain it.
#![allow(clippy::print_stdout, clippy::unwrap_used)]

use juggler_bvh::{Quality, TriangleBvh, TriangleHit};
use juggler_math::{Ray, Vec3, hash, vec3};
use std::hint::black_box;
use std::time::{Duration, Instant};

const PIXELS: usize = 64;
const SAMPLES: usize = 8;
const MEASUREMENTS: usize = 3;
const LEAST: Duration = Duration::from_millis(100);

/// Deterministic random numbers in [0, 1).
struct Random(u32);

impl Random {
    fn unit(&mut self) -> f32 {
        self.0 += 1;
        hash::unit_f32(hash::mix(self.0))
    }

    fn point(&mut self) -> Vec3 {
        vec3(self.unit(), self.unit(), self.unit()) * 2.0 - Vec3::ONE
    }
}

struct Scene {
    name: &'static str,
    positions: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    eye: Vec3,
    look_at: Vec3,
}

/// Small triangles at random positions in a cube.
fn soup(count: u32) -> Scene {
    let random = &mut Random(1);
    let size = 1.5 / (count as f32).sqrt().sqrt();
    let mut positions = Vec::new();
    for _ in 0..count {
        let center = random.point();
        positions.extend((0..3).map(|_| center + random.point() * size * 0.2));
    }
    let triangles = (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    Scene { name: "soup", positions, triangles, eye: vec3(0.0, 0.5, 3.0), look_at: Vec3::ZERO }
}

/// A height field of `side` × `side` quads.
fn terrain(name: &'static str, side: u32) -> Scene {
    let height = |x: f32, z: f32| {
        let (a, _) = juggler_math::portable::sin_cos(x * 9.0 + z * 3.0);
        let (b, _) = juggler_math::portable::sin_cos(z * 23.0 - x * 5.0);
        0.15 * a + 0.05 * b + 0.002 * hash::unit_f32(hash::combine(x.to_bits(), z.to_bits()))
    };
    let at = |i: u32| i as f32 / side as f32 * 2.0 - 1.0;
    let grid = (0..=side).flat_map(|z| (0..=side).map(move |x| (x, z)));
    let positions = grid.map(|(x, z)| vec3(at(x), height(at(x), at(z)), at(z))).collect();
    let mut triangles = Vec::new();
    for z in 0..side {
        for x in 0..side {
            let corner = z * (side + 1) + x;
            let [a, b, c, d] = [corner, corner + 1, corner + side + 1, corner + side + 2];
            triangles.extend([[a, b, c], [b, d, c]]);
        }
    }
    Scene { name, positions, triangles, eye: vec3(0.3, 0.9, 2.2), look_at: Vec3::ZERO }
}

/// Camera rays: eight consecutive samples per pixel.
fn camera(scene: &Scene, look_at: Vec3) -> Vec<Ray> {
    let random = &mut Random(2);
    let forward = (look_at - scene.eye).normalize();
    let right = forward.cross(Vec3::Y).normalize();
    let up = right.cross(forward);
    let mut rays = Vec::new();
    for pixel in 0..PIXELS * PIXELS {
        for _ in 0..SAMPLES {
            let x = ((pixel % PIXELS) as f32 + random.unit()) / PIXELS as f32 - 0.5;
            let y = ((pixel / PIXELS) as f32 + random.unit()) / PIXELS as f32 - 0.5;
            rays.push(Ray::new(scene.eye, (forward + right * (x * 0.8) - up * (y * 0.8)).normalize()));
        }
    }
    rays
}

/// Shadow rays from the hits to random points of a light of this size.
fn shadow(rays: &[Ray], hits: &[Option<TriangleHit>], size: f32) -> Vec<Ray> {
    let random = &mut Random(3);
    let lit = rays.iter().zip(hits).filter_map(|(ray, hit)| hit.map(|hit| ray.at(hit.t * 0.9999)));
    let light = vec3(1.0, 3.0, 1.0);
    lit.map(|origin| Ray::new(origin, light + random.point() * size - origin).with_t_max(1.0)).collect()
}

/// Rays from the hits in random directions.
fn scattered(rays: &[Ray], hits: &[Option<TriangleHit>]) -> Vec<Ray> {
    let random = &mut Random(4);
    let origins = rays.iter().zip(hits).filter_map(|(ray, hit)| hit.map(|hit| ray.at(hit.t * 0.9999)));
    origins.map(|origin| Ray::new(origin, random.point())).collect()
}

/// CPU time of this thread where the system reports it (Linux), which other programs do not
/// disturb; else wall-clock time.
fn clock(start: Instant) -> Duration {
    let scheduler = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = scheduler.and_then(|text| text.split(' ').next()?.parse().ok());
    nanoseconds.map_or_else(|| start.elapsed(), Duration::from_nanos)
}

/// Time of one run, best of several measurements. Each measurement averages many runs, since the
/// clock may be coarse.
fn best(mut run: impl FnMut()) -> Duration {
    let start = Instant::now();
    let time = |_| {
        let (before, mut count) = (clock(start), 0);
        loop {
            run();
            count += 1;
            let time = clock(start) - before;
            if time >= LEAST {
                return time / count;
            }
        }
    };
    (0..MEASUREMENTS).map(time).min().unwrap()
}

fn report(what: &str, rays: usize, time: Duration) {
    println!("    {what:<24} {:8.2} Mrays/s", rays as f64 / time.as_secs_f64() / 1e6);
}

/// Measures closest hits in batches and in packets.
fn closest(what: &str, bvh: &TriangleBvh, rays: &[Ray]) -> Vec<Option<TriangleHit>> {
    let mut hits = vec![None; rays.len()];
    let time = best(|| bvh.closest_batch(&mut rays.to_vec(), black_box(&mut hits)));
    report(what, rays.len(), time);
    let time = best(|| bvh.closest_packet(&mut rays.to_vec(), black_box(&mut hits)));
    report(&format!("{what}, packets"), rays.len(), time);
    hits
}

/// Measures any hits in batches and in packets.
fn any(what: &str, bvh: &TriangleBvh, rays: &[Ray]) {
    let mut occluded = vec![false; rays.len()];
    report(what, rays.len(), best(|| bvh.any_batch(rays, black_box(&mut occluded))));
    report(&format!("{what}, packets"), rays.len(), best(|| bvh.any_packet(rays, black_box(&mut occluded))));
}

fn measure(scene: &Scene, quality: Quality) {
    let build = || TriangleBvh::build(&scene.positions, &scene.triangles, quality).unwrap();
    let start = Instant::now();
    let before = clock(start);
    let bvh = build();
    let seconds = (clock(start) - before).as_secs_f64();
    let (count, stats) = (scene.triangles.len(), bvh.stats());
    println!("{}, {quality:?}: {count} triangles, built in {seconds:.2} s", scene.name);
    let bytes = bvh.bytes() as f64 / count as f64;
    println!("    {} nodes, depth {}, cost {:.1}, {bytes:.0} bytes/triangle", stats.nodes, stats.depth, stats.sah_cost);
    closest("all miss", &bvh, &camera(scene, scene.eye * 2.0));
    let rays = camera(scene, scene.look_at);
    let hits = closest("primary", &bvh, &rays);
    any("shadow, point", &bvh, &shadow(&rays, &hits, 0.0));
    any("shadow, area", &bvh, &shadow(&rays, &hits, 0.3));
    let scattered = scattered(&rays, &hits);
    closest("scattered", &bvh, &scattered);
    any("scattered, any", &bvh, &scattered);
}

fn main() {
    let requested = std::env::args().skip(1).find(|word| !word.starts_with('-')).unwrap_or_default();
    for scene in [soup(100_000), terrain("terrain", 256), terrain("large terrain", 1024)] {
        for quality in Quality::ALL {
            if format!("{}, {quality:?}", scene.name).contains(&requested) {
                measure(&scene, quality);
            }
        }
    }
}
