//! Generated meshes with six kinds of rays and random rays: every kernel gives the same bits at
//! every quality and SIMD level, and brute force agrees on samples. If `JUGGLER_RAYS` (rays of each
//! kind) is above 10,000, the meshes have their benchmark sizes:
//! `JUGGLER_RAYS=1_000_000 cargo test --release -p juggler-bvh --test integration scenes::`.

use crate::common::mesh::{Kernels, Mesh, rays_to_try};
use juggler_bvh::{Quality, TriangleBvh, TriangleHit, simd_levels};
use juggler_math::{Aabb, Ray, Vec3, vec3};
use juggler_raybench::meshes::MeshSpec;
use juggler_raybench::rays;

const SMALL: usize = 512;
/// Number of brute-force triangle tests for each kind of rays.
const TESTS: usize = 500_000;
/// Rays per call: two groups of packets and a remainder.
const CALL: usize = 69;

fn check(small: &str, large: &str) {
    let count = rays_to_try(SMALL);
    let name = if count > 10_000 { large } else { small };
    let made = MeshSpec::parse(name).unwrap().make();
    let tree = TriangleBvh::build(&made.positions, &made.triangles, Quality::Balanced).unwrap();
    let sets = rays::make(&made, &tree, count);
    let mesh = Mesh { positions: made.positions, triangles: made.triangles };
    let kernels = Kernels::all(name, &mesh);
    let kinds = sets.each_ref().map(|set| (set.kind.name(), &set.rays[..]));
    let made: usize = kinds.iter().map(|(_, rays)| rays.len()).sum();
    let across = across(&mesh, (kinds.len() * count).saturating_sub(made));
    for (kind, rays) in kinds.into_iter().chain([("across", &across[..])]) {
        for rays in rays.chunks(CALL) {
            let expected: Vec<_> = rays.iter().map(|ray| tree.closest(ray)).collect();
            kernels.iter().for_each(|kernels| kernels.check(rays, &expected));
        }
        let sample = (TESTS / mesh.triangles.len()).max(2);
        for ray in rays.iter().step_by((rays.len() / sample).max(1)) {
            assert_eq!(tree.closest(ray), mesh.closest(ray), "{name}, {kind}: {ray:?}");
        }
        println!("{name}, {} triangles, {kind}: {} rays", mesh.triangles.len(), rays.len());
    }
}

/// Random rays, each through two points of the mesh's bounds. They make up for the follow-up rays
/// that are missing where rays of the other kinds miss.
fn across(mesh: &Mesh, count: usize) -> Vec<Ray> {
    let bounds = Aabb::from_points(mesh.positions.iter().copied());
    let random = &mut crate::common::Random::new(1);
    let mut point = || (bounds.min + bounds.max) * 0.5 + random.point() * bounds.extent() * 0.5;
    (0..count).map(|_| (point(), point())).map(|(from, to)| Ray::new(from, (to - from).normalize_or(Vec3::Y))).collect()
}

#[test]
fn blob() {
    check("blob:12", "blob");
}

#[test]
fn classroom() {
    check("classroom:2", "classroom");
}

#[test]
fn hall() {
    check("hall:4", "hall");
}

#[test]
fn stadium() {
    check("stadium:6", "stadium");
}

#[test]
fn hairball() {
    check("hairball:300", "hairball:8000");
}

#[test]
fn terrain() {
    check("terrain:64", "terrain:700");
}

/// Triangles at known positions and heights; with a million rays to try, more than 2^24 of them,
/// whose indices single precision cannot represent (6 GB of memory, minutes).
#[test]
fn more_than_sixteen_million_triangles_are_indexed_exactly() {
    let edge: u32 = if rays_to_try(0) >= 1_000_000 { 2900 } else { 90 };
    let height = |x: u32, z: u32| ((x * 7 + z * 13) % 5) as f32 * 0.25;
    let corner = |i: u32| vec3((i % (edge + 1)) as f32, 0.0, (i / (edge + 1)) as f32);
    let positions = (0..(edge + 1) * (edge + 1)).map(|i| corner(i).with_y(height(i % (edge + 1), i / (edge + 1))));
    let cells = (0..edge * edge).map(|i| i / edge * (edge + 1) + i % edge);
    let triangles = cells.flat_map(|a| [[a, a + 1, a + edge + 1], [a + 1, a + edge + 2, a + edge + 1]]);
    let mesh = Mesh { positions: positions.collect(), triangles: triangles.collect() };
    // One tree at a time, since each takes more than a gigabyte.
    for quality in Quality::ALL {
        let tree = TriangleBvh::build(&mesh.positions, &mesh.triangles, quality).unwrap();
        for level in simd_levels() {
            find_what_is_known(&Kernels::new(&format!("{quality:?}"), &tree, level), &mesh);
        }
    }
}

/// Checks rays from above at known points of triangles.
fn find_what_is_known(kernels: &Kernels, mesh: &Mesh) {
    let random = &mut crate::common::Random::new(24);
    for _ in 0..rays_to_try(7000) / CALL {
        // Adjacent triangles: incoherent rays as one packet would visit most of the tree.
        let start = random.below(mesh.triangles.len() - CALL);
        let aims: Vec<(usize, Vec3)> = (start..start + CALL)
            .map(|triangle| {
                let [a, b, c] = mesh.corners(triangle);
                (triangle, a * 0.5 + b * 0.25 + c * 0.25)
            })
            .collect();
        let rays: Vec<Ray> = aims.iter().map(|(_, point)| Ray::new(point.with_y(8.0), -Vec3::Y)).collect();
        let known = aims
            .iter()
            .map(|&(triangle, point)| Some(TriangleHit { t: 8.0 - point.y, u: 0.25, v: 0.25, index: triangle as u32 }));
        kernels.check(&rays, &known.collect::<Vec<_>>());
    }
}
