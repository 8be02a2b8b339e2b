//! Common-origin packets, as from a pinhole camera, give the same bits as brute force: rays at
//! vertices and edges, at all scales, from near and far.

use crate::common::Random;
use crate::common::mesh::{Kernels, Mesh, rays_to_try};
use juggler_math::{Ray, Vec3};

const SMALL: usize = 1500;
/// Rays per call: two groups of packets and a remainder.
const CALL: usize = 69;

/// Long triangles around the origin, many of which share vertices and edges, so that leaves are
/// full and boxes overlap.
fn long_triangles(random: &mut Random, slenderness: f32) -> Mesh {
    let hub = random.point() * 0.1;
    let strip = |random: &mut Random| {
        let (a, b) = (random.point(), random.point());
        let c = a + (b - a) * random.unit() + random.point() * slenderness;
        [[hub, a, c], [a, b, c]]
    };
    Mesh::from_triangles((0..60).flat_map(|_| strip(random)).collect::<Vec<_>>())
}

/// Rays from `eye` around a vertex: at vertices, edges and inner points of random triangles, or
/// near the target.
fn call(random: &mut Random, mesh: &Mesh, eye: Vec3, spread: f32) -> Vec<Ray> {
    let target = mesh.corners(random.below(mesh.triangles.len()))[0];
    let size = (target - eye).length() * spread;
    (0..CALL)
        .map(|_| {
            let near = target + random.point() * size;
            let [a, b, c] = mesh.corners(random.below(mesh.triangles.len()));
            let (u, v) = (random.unit(), random.unit());
            let aim = match random.below(6) {
                0 => target,
                1 => [a, b, c][random.below(3)],
                2 => a + (b - a) * u,
                3 => a + (b - a) * u * v + (c - a) * u * (1.0 - v),
                _ => near,
            };
            // Keep the packet narrow: replace aims that are far from the target.
            let aim = if (aim - target).length() <= size { aim } else { near };
            Ray::new(eye, aim - eye)
        })
        .collect()
}

fn check(seed: u32, scale: f32, slenderness: f32, distance: f32, spread: f32) {
    let random = &mut Random::new(seed);
    let mesh = long_triangles(random, slenderness);
    let mesh = mesh.moved(Vec3::splat(scale), Vec3::ZERO);
    let name = format!("scale {scale:e}, slenderness {slenderness}, from {distance}, spread {spread}");
    let kernels = Kernels::all(&name, &mesh);
    let mut hits = 0;
    for _ in 0..(rays_to_try(SMALL) / CALL / 20).max(1) {
        let eye = random.point() * distance * scale;
        let rays = call(random, &mesh, eye, spread);
        let expected: Vec<_> = rays.iter().map(|ray| mesh.closest(ray)).collect();
        kernels.iter().for_each(|kernels| kernels.check(&rays, &expected));
        hits += expected.iter().flatten().count();
    }
    assert!(hits > 0, "{name}: no ray hits");
}

#[test]
fn vertices_and_edges_of_long_triangles_are_hit() {
    for (seed, spread) in [0.0, 1e-6, 1e-3, 0.02, 0.1].into_iter().enumerate() {
        for slenderness in [0.5, 1e-2, 1e-6] {
            for distance in [0.3, 3.0, 1000.0] {
                check(seed as u32, 1.0, slenderness, distance, spread);
            }
        }
    }
}

#[test]
fn vertices_and_edges_are_hit_at_all_scales() {
    for (seed, exponent) in [-36, -30, -20, -10, 10, 17, 18].into_iter().enumerate() {
        let scale = 10f32.powi(exponent);
        for spread in [1e-6, 0.05] {
            check(100 + seed as u32, scale, 0.1, 2.0, spread);
        }
    }
}
