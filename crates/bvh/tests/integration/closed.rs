//! Watertightness: no ray leaves closed meshes, in every kernel at every SIMD level.
//! `JUGGLER_RAYS=1_000_000 cargo test --release -p juggler-bvh --test integration closed::` sets
//! the number of rays per mesh.

use crate::common::Random;
use crate::common::mesh::{Kernels, Mesh, crossed, globe, is_divided, rays_to_try};
use juggler_math::{Ray, Vec3, vec3};

/// Number of rays per mesh.
const SMALL: usize = 25_000;
/// Maximum number of rays per call: two groups of packets and a remainder.
const CALL: usize = 70;

/// A ray at a vertex, an edge, its midpoint or slightly beside it, at an inner point, or in a
/// random direction.
fn ray_from(random: &mut Random, mesh: &Mesh, origin: Vec3) -> Ray {
    let corners = mesh.corners(random.below(mesh.triangles.len()));
    let (from, to) = (corners[random.below(3)], corners[random.below(3)]);
    let target = match random.below(6) {
        0 => from,
        1 => from * 0.5 + to * 0.5,
        2 => from.lerp(to, random.unit()),
        3 => from.lerp(to, random.unit()).map(f32::next_up),
        4 => corners[0] * 0.25 + corners[1] * 0.5 + corners[2] * 0.25,
        _ => return Ray::new(origin, random.direction()),
    };
    Ray::new(origin, target - origin)
}

/// Rays of one call: nearly parallel, from one origin, or from random origins.
fn call(random: &mut Random, mesh: &Mesh, inside: &impl Fn(&mut Random) -> Vec3) -> Vec<Ray> {
    let count = 1 + random.below(CALL);
    let eye = inside(random);
    let first = ray_from(random, mesh, eye);
    let kind = random.below(3);
    (0..count)
        .map(|_| match kind {
            0 => Ray { direction: first.direction + random.point() * first.direction.abs() * 1e-3, ..first },
            1 => ray_from(random, mesh, eye),
            _ => {
                let origin = inside(random);
                ray_from(random, mesh, origin)
            }
        })
        .collect()
}

/// Traces each call with all kernels of one of the trees, in turn.
fn try_to_leave(name: &str, mesh: &Mesh, seed: u32, inside: impl Fn(&mut Random) -> Vec3) {
    let (kernels, random) = (Kernels::all(name, mesh), &mut Random::new(seed));
    let (mut tried, mut calls) = (0, 0);
    while tried < rays_to_try(SMALL) {
        let rays = call(random, mesh, &inside);
        let kernels = &kernels[calls % kernels.len()];
        let hits: Vec<_> = rays.iter().map(|ray| kernels.closest(ray)).collect();
        for (ray, hit) in rays.iter().zip(&hits) {
            assert!(hit.is_some(), "{name}: a ray gets out: {ray:?}");
        }
        kernels.check(&rays, &hits);
        (tried, calls) = (tried + rays.len(), calls + 1);
    }
    println!("{name}: {tried} rays, none gets out");
}

fn leave_globe(name: &str, globe: &Mesh, scale: Vec3, offset: Vec3, seed: u32) {
    let moved = globe.moved(scale, offset);
    try_to_leave(name, &moved, seed, |random| offset + random.point() * 0.4 * scale);
}

#[test]
fn tessellated_spheres_are_watertight() {
    for (rows, columns, rough, seed) in [(3, 3, 0.0, 1), (6, 7, 0.3, 2), (24, 36, 0.1, 3), (90, 110, 0.02, 4)] {
        let globe = globe(&mut Random::new(seed), rows, columns, rough);
        // With three rows and columns the globe is slender around its axis.
        let slender = if rows == 3 { 0.2 } else { 1.0 };
        try_to_leave(&format!("{rows} rows"), &globe, seed, |random| random.point() * 0.4 * slender);
    }
}

#[test]
fn tessellated_spheres_of_all_sizes_are_watertight() {
    let globe = globe(&mut Random::new(10), 24, 36, 0.1);
    for (scale, seed) in [(1e-25, 11), (1e-15, 12), (1e-4, 13), (1e6, 14), (1e15, 15)] {
        leave_globe(&format!("scale {scale:e}"), &globe, Vec3::splat(scale), Vec3::ZERO, seed);
    }
    leave_globe("long globe", &globe, vec3(100.0, 0.01, 1.0), Vec3::ZERO, 16);
}

/// Far from the origin, vertices lie on a coarse grid: triangles become slivers, some degenerate.
#[test]
fn tessellated_spheres_far_from_the_origin_are_watertight() {
    let globe = globe(&mut Random::new(20), 24, 36, 0.1);
    for (distance, seed) in [(1e3, 21), (1e4, 22), (1e5, 23)] {
        leave_globe(&format!("{distance} away"), &globe, Vec3::ONE, vec3(1.0, -0.5, 0.3) * distance, seed);
    }
    leave_globe("small and far away", &globe, Vec3::splat(1e-2), vec3(-100.0, 20.0, 50.0), 24);
}

/// A box with two triangles per face: axis-aligned edges, flat faces, huge triangles close by.
#[test]
fn boxes_are_watertight() {
    let positions = (0..8u8).map(|i| Vec3::from([0, 1, 2].map(|axis| f32::from(i >> axis & 1) * 2.0 - 1.0)));
    let quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
    let triangles = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    let mesh = Mesh { positions: positions.collect(), triangles };
    leave_globe("box", &mesh, Vec3::ONE, Vec3::ZERO, 31);
    leave_globe("flat box", &mesh, vec3(1000.0, 0.001, 1000.0), vec3(1.0, 2.0, 3.0), 32);
    leave_globe("tiny box", &mesh, Vec3::splat(1e-15), Vec3::ZERO, 33);
}

/// A globe of long thin oblique triangles, crossed by small and long ones: no ray passes through
/// its edges where spatial splits divide triangles.
#[test]
fn spatially_split_triangles_are_watertight() {
    let random = &mut Random::new(50);
    let mut mesh = globe(random, 3, 300, 0.0);
    let (own, added) = (mesh.positions.len() as u32, crossed(random, 4000, 400));
    // Rotate about an oblique axis, so that no triangle is axis-aligned.
    let turn =
        |p: Vec3| vec3(0.8 * p.x - 0.6 * p.y, 0.48 * p.x + 0.64 * p.y - 0.6 * p.z, 0.36 * p.x + 0.48 * p.y + 0.8 * p.z);
    mesh.positions.iter_mut().for_each(|p| *p = turn(*p));
    mesh.positions.extend(&added.positions);
    mesh.triangles.extend(added.triangles.iter().map(|triangle| triangle.map(|vertex| vertex + own)));
    assert!(is_divided(&mesh));
    for (scale, offset, seed) in [(1.0, 0.0, 51), (1e-15, 0.0, 52), (1e15, 0.0, 53), (1.0, 1e3, 54)] {
        leave_globe(
            &format!("divided, scale {scale:e}, offset {offset}"),
            &mesh,
            Vec3::splat(scale),
            Vec3::splat(offset),
            seed,
        );
    }
}

/// Axis-parallel rays at the vertices and edges of a globe.
#[test]
fn axis_parallel_rays_hit_a_watertight_sphere() {
    let globe = globe(&mut Random::new(40), 12, 16, 0.0);
    let kernels = Kernels::all("along the axes", &globe);
    let mut rays = Vec::new();
    for corner in globe.positions.iter().filter(|corner| corner.length_squared() > 0.9) {
        for axis in 0..3 {
            let mut direction = Vec3::from([0, 1, 2].map(|i: u8| if i.is_multiple_of(2) { 0.0 } else { -0.0 }));
            direction[axis] = corner[axis].signum();
            let origin = *corner - direction * corner[axis].abs();
            rays.push(Ray::new(origin, direction));
        }
    }
    // Keep the rays whose origin lies inside the globe, within the cross section.
    rays.retain(|ray| ray.origin.length_squared() < 0.9);
    assert!(rays.len() > 200, "{}", rays.len());
    for kernels in &kernels {
        for rays in rays.chunks(CALL) {
            let hits: Vec<_> = rays.iter().map(|ray| kernels.closest(ray)).collect();
            assert!(hits.iter().all(Option::is_some), "{rays:?}");
            kernels.check(rays, &hits);
        }
    }
}
