//! Triangles: brute force = tree, and closed meshes that no ray leaves.

#![allow(clippy::unwrap_used)] // helpers of tests, which the lint does not see as such

mod common;

use common::Random;
use juggler_bvh::{Quality, TriangleBvh, TriangleHit, intersect_triangle};
use juggler_math::{Ray, Vec3, vec3};

struct Mesh {
    positions: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
}

impl Mesh {
    fn corners(&self, triangle: usize) -> [Vec3; 3] {
        self.triangles[triangle].map(|vertex| self.positions[vertex as usize])
    }

    fn closest(&self, ray: &Ray) -> Option<TriangleHit> {
        let hits = (0..self.triangles.len()).filter_map(|index| {
            let [a, b, c] = self.corners(index);
            let (t, u, v) = intersect_triangle(ray, a, b, c)?;
            Some(TriangleHit { t, u, v, index: index as u32 })
        });
        hits.min_by(|a, b| a.t.total_cmp(&b.t).then(a.index.cmp(&b.index)))
    }
}

fn soup(random: &mut Random, count: u32, size: f32) -> Mesh {
    let mut positions = Vec::new();
    for _ in 0..count {
        let center = random.point();
        positions.extend((0..3).map(|_| center + random.point() * size));
    }
    Mesh { positions, triangles: (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect() }
}

/// A globe of `rows` times `columns` quads in two triangles each, the poles fans; every vertex moved in or
/// out by up to `rough`. Closed: neighbours share their vertices.
fn globe(random: &mut Random, rows: u32, columns: u32, rough: f32) -> Mesh {
    let mut positions = vec![Vec3::Y, -Vec3::Y];
    for row in 1..rows {
        for column in 0..columns {
            let (sin, cos) = juggler_math::fun::sin_cos(std::f32::consts::PI * row as f32 / rows as f32);
            let (sin_around, cos_around) =
                juggler_math::fun::sin_cos(std::f32::consts::TAU * column as f32 / columns as f32);
            positions.push(vec3(sin * cos_around, cos, sin * sin_around) * (1.0 + rough * (random.unit() - 0.5)));
        }
    }
    let at = |row: u32, column: u32| match row {
        0 => 0,
        row if row == rows => 1,
        row => 2 + (row - 1) * columns + column % columns,
    };
    let mut triangles = Vec::new();
    for row in 0..rows {
        for column in 0..columns {
            let [a, b, c, d] = [at(row, column), at(row, column + 1), at(row + 1, column), at(row + 1, column + 1)];
            triangles.extend([[a, b, c], [b, d, c]].into_iter().filter(|[a, b, c]| a != b && b != c && a != c));
        }
    }
    Mesh { positions, triangles }
}

/// In release many, in development enough to run quickly.
fn rays_to_try() -> usize {
    if cfg!(debug_assertions) { 60_000 } else { 1_000_000 }
}

fn bits(hit: Option<TriangleHit>) -> Option<(u32, u32, u32, u32)> {
    hit.map(|hit| (hit.t.to_bits(), hit.u.to_bits(), hit.v.to_bits(), hit.index))
}

fn check(name: &str, mesh: &Mesh, rays: &[Ray]) {
    for quality in Quality::ALL {
        let bvh = TriangleBvh::build(&mesh.positions, &mesh.triangles, quality).unwrap();
        for rays in rays.chunks(8) {
            let expected: Vec<_> = rays.iter().map(|ray| mesh.closest(ray)).collect();
            let mut batch = vec![None; rays.len()];
            let mut packet = batch.clone();
            bvh.closest_batch(&mut rays.to_vec(), &mut batch);
            bvh.closest_packet(&mut rays.to_vec(), &mut packet);
            let (mut batch_any, mut packet_any) = (vec![true; rays.len()], vec![true; rays.len()]);
            bvh.any_batch(rays, &mut batch_any);
            bvh.any_packet(rays, &mut packet_any);
            for (lane, (ray, &expected)) in rays.iter().zip(&expected).enumerate() {
                assert_eq!(bits(bvh.closest(ray)), bits(expected), "{name}, {quality:?}: {ray:?}");
                assert_eq!(bits(batch[lane]), bits(expected), "{name}, {quality:?}, batch: {ray:?}");
                assert_eq!(bits(packet[lane]), bits(expected), "{name}, {quality:?}, packet: {ray:?}");
                let hit = expected.is_some();
                assert_eq!([bvh.any(ray), batch_any[lane], packet_any[lane]], [hit; 3], "{name}: {ray:?}");
            }
        }
    }
}

#[test]
fn brute_force_finds_the_same_in_a_soup() {
    let random = &mut Random::new(1);
    for (count, size) in [(1, 1.0), (9, 1.0), (300, 0.2), (300, 3.0), (1000, 0.03)] {
        let mesh = soup(random, count, size);
        let mut rays: Vec<Ray> = (0..400).map(|_| Ray::new(random.point() * 2.0, random.direction())).collect();
        for _ in 0..50 {
            let (eye, target) = (random.direction() * 3.0, random.point());
            rays.extend((0..8).map(|_| Ray::new(eye, (target + random.point() * 0.02 - eye) * 0.7)));
        }
        check(&format!("{count} triangles of size {size}"), &mesh, &rays);
    }
}

/// Rays in the planes of a grid of coplanar and of coincident triangles: ties everywhere.
#[test]
fn brute_force_finds_the_same_where_triangles_coincide() {
    let random = &mut Random::new(2);
    let whole = |random: &mut Random| Vec3::from(std::array::from_fn(|_| random.below(5) as f32));
    let positions: Vec<Vec3> = (0..600).map(|_| whole(random)).collect();
    let triangles = (0..200u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let mesh = Mesh { positions, triangles };
    let axes = [Vec3::X, Vec3::Y, Vec3::Z, -Vec3::X, -Vec3::Y, -Vec3::Z];
    let rays: Vec<Ray> = (0..800)
        .map(|i| {
            let direction = if i % 3 == 0 { whole(random) - whole(random) } else { axes[random.below(6)] };
            let direction = if direction == Vec3::ZERO { Vec3::ONE } else { direction };
            Ray::new(whole(random) - direction * 8.0, direction)
        })
        .collect();
    check("coincident", &mesh, &rays);
}

/// From inside, at shared edges and vertices and a hair beside them.
fn try_to_leave(name: &str, mesh: &Mesh, scale: Vec3, offset: Vec3, seed: u32) {
    let positions: Vec<Vec3> = mesh.positions.iter().map(|p| *p * scale + offset).collect();
    let moved = Mesh { positions, triangles: mesh.triangles.clone() };
    let bvh = TriangleBvh::build(&moved.positions, &moved.triangles, Quality::Balanced).unwrap();
    let random = &mut Random::new(seed);
    let mut packet = Vec::new();
    for number in 0..rays_to_try() / 4 {
        let corners = moved.corners(random.below(moved.triangles.len()));
        let weight = [0.0, 0.5, 1.0, random.unit()][random.below(4)];
        let target = corners[0].lerp(corners[1 + number % 2], weight);
        let origin = offset + random.point() * 0.4 * scale;
        let ray = Ray::new(origin, target - origin);
        assert!(bvh.closest(&ray).is_some(), "{name}: a ray gets out: {ray:?} at {corners:?}");
        assert!(bvh.any(&ray), "{name}: a ray gets out: {ray:?}");
        packet.push(ray);
        if packet.len() == 8 {
            let mut occluded = [false; 8];
            bvh.any_packet(&packet, &mut occluded);
            assert_eq!(occluded, [true; 8], "{name}: a ray gets out: {packet:?}");
            packet.clear();
        }
    }
}

#[test]
fn no_ray_leaves_a_closed_mesh() {
    let random = &mut Random::new(3);
    let globe = globe(random, 24, 36, 0.1);
    try_to_leave("globe", &globe, Vec3::ONE, Vec3::ZERO, 4);
    try_to_leave("far globe", &globe, Vec3::ONE, vec3(1000.0, -2000.0, 500.0), 5);
    try_to_leave("long globe", &globe, vec3(100.0, 0.01, 1.0), Vec3::ZERO, 6);
    try_to_leave("huge globe", &globe, Vec3::splat(1e15), Vec3::ZERO, 7);
}

/// A box of two triangles a side: edges along the axes, faces without thickness, huge triangles close by.
#[test]
fn no_ray_leaves_a_box() {
    let positions = (0..8u8).map(|i| Vec3::from([0, 1, 2].map(|axis| f32::from(i >> axis & 1) * 2.0 - 1.0)));
    let quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
    let triangles = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    let mesh = Mesh { positions: positions.collect(), triangles };
    try_to_leave("box", &mesh, Vec3::ONE, Vec3::ZERO, 8);
    try_to_leave("flat box", &mesh, vec3(1000.0, 0.001, 1000.0), vec3(1.0, 2.0, 3.0), 9);
    try_to_leave("tiny box", &mesh, Vec3::splat(1e-15), Vec3::ZERO, 10);
}
