//! Every kernel agrees with brute force bit for bit, at every quality and SIMD level, for
//! adversarial triangle soups and rays.
//! `JUGGLER_RAYS=1_000_000 cargo test --release -p juggler-bvh --test integration soups::` sets the
//! number of rays.

use crate::common::Random;
use crate::common::mesh::{Kernels, Mesh, crossed, is_divided, rays_to_try};
use crate::common::rays::{Aim, cut};
use juggler_bvh::{Quality, TriangleBvh, TriangleHit, TriangleTest, intersect_triangle, simd_levels};
use juggler_math::{Ray, Vec3, vec3};

/// Default number of rays, small enough for brute force.
const SMALL: usize = 2500;

fn whole(random: &mut Random, below: usize) -> Vec3 {
    Vec3::from(std::array::from_fn(|_| random.below(below) as f32))
}

/// A triangle near a random point.
fn near(random: &mut Random, size: f32) -> [Vec3; 3] {
    let center = random.point();
    [(); 3].map(|()| center + random.point() * size)
}

fn soup(seed: u32, count: usize, mut triangle: impl FnMut(&mut Random) -> [Vec3; 3]) -> Mesh {
    let random = &mut Random::new(seed);
    Mesh::from_triangles((0..count).map(|_| triangle(random)))
}

/// Checks random calls, then the same rays cut off at their hits.
fn check(name: &str, mesh: &Mesh, seed: u32) {
    let (aim, kernels, random) = (Aim::at(mesh), Kernels::all(name, mesh), &mut Random::new(seed));
    let (mut tried, mut hit) = (0, 0);
    while tried < rays_to_try(SMALL) {
        let rays = aim.call(random);
        let expected: Vec<_> = rays.iter().map(|ray| mesh.closest(ray)).collect();
        let ends: Vec<Ray> =
            rays.iter().zip(&expected).map(|(ray, hit)| cut(random, ray, hit.map(|hit| hit.t))).collect();
        let expected_ends: Vec<_> = ends.iter().map(|ray| mesh.closest(ray)).collect();
        for kernels in &kernels {
            kernels.check(&rays, &expected);
            kernels.check(&ends, &expected_ends);
        }
        tried += rays.len() * 2;
        hit += expected.iter().flatten().count();
    }
    println!("{name}: {tried} rays, {hit} of the uncut hit");
    assert!(mesh.triangles.len() < 5 || hit * 20 > tried, "{name}: only {hit} of {tried} hit");
}

#[test]
fn small_and_large_meshes_match_brute_force() {
    for (count, size) in [(1, 1.0), (2, 1.0), (7, 0.5), (8, 0.5), (9, 1.0), (65, 0.3), (500, 0.2)] {
        check(&format!("{count} triangles"), &soup(count as u32, count, |random| near(random, size)), 100);
    }
}

/// The fast test gives slightly different results, but the same in every kernel.
#[test]
fn the_fast_test_is_the_same_in_every_kernel() {
    let mesh = soup(77, 300, |random| near(random, 0.3));
    fast_is_the_same_in_every_kernel(&mesh, Quality::Balanced);
    let mesh = crossed(&mut Random::new(79), 1500, 150);
    assert!(is_divided(&mesh));
    fast_is_the_same_in_every_kernel(&mesh, Quality::Best);
}

fn fast_is_the_same_in_every_kernel(mesh: &Mesh, quality: Quality) {
    let (aim, random) = (Aim::at(mesh), &mut Random::new(78));
    let tree = TriangleBvh::build(&mesh.positions, &mesh.triangles, quality).unwrap();
    let tree = tree.with_test(TriangleTest::Fast);
    let (mut tried, mut off) = (0, 0);
    while tried < rays_to_try(SMALL) {
        let rays = aim.call(random);
        let expected: Vec<_> = rays.iter().map(|ray| tree.closest(ray)).collect();
        for level in simd_levels() {
            Kernels::new("fast", &tree, level).check(&rays, &expected);
        }
        let exact = rays.iter().map(|ray| mesh.closest(ray));
        off +=
            expected.iter().zip(exact).filter(|(fast, exact)| fast.map(|h| h.index) != exact.map(|h| h.index)).count();
        tried += rays.len();
    }
    assert!(off * 50 < tried, "{off} of {tried} rays hit something else than by the exact test");
}

/// Hits that a filter rejects do not count in any kernel, as if each ray had its own triangles.
#[test]
fn refused_hits_do_not_count() {
    refuse(&soup(87, 120, |random| near(random, 0.5)), Quality::Balanced);
    let mesh = crossed(&mut Random::new(89), 1500, 150);
    assert!(is_divided(&mesh));
    refuse(&mesh, Quality::Best);
}

fn refuse(mesh: &Mesh, quality: Quality) {
    let (aim, random) = (Aim::at(mesh), &mut Random::new(88));
    let counts = |ray: usize, hit: &TriangleHit| !(ray + hit.index as usize).is_multiple_of(3);
    let nearest = |number: usize, ray: &Ray| {
        let hits = (0..mesh.triangles.len()).filter_map(|index| {
            let [a, b, c] = mesh.corners(index);
            let (t, u, v) = intersect_triangle(ray, a, b, c)?;
            Some(TriangleHit { t, u, v, index: index as u32 })
        });
        let hits = hits.filter(|hit| counts(number, hit));
        hits.min_by(|a, b| a.t.total_cmp(&b.t).then(a.index.cmp(&b.index)))
    };
    let tree = TriangleBvh::build(&mesh.positions, &mesh.triangles, quality).unwrap();
    let mut differ = 0;
    for round in 0..rays_to_try(SMALL) / 35 {
        let rays = aim.call(random);
        let expected: Vec<_> = rays.iter().enumerate().map(|(number, ray)| nearest(number, ray)).collect();
        let is_hit: Vec<bool> = expected.iter().map(Option::is_some).collect();
        differ += rays.iter().zip(&expected).filter(|(ray, expected)| tree.closest(ray) != **expected).count();
        for level in simd_levels() {
            for in_flight in [false, true] {
                let tree = tree.clone().with_simd_level(level).with_rays_in_flight(in_flight);
                let some = tree.filtered(counts);
                let (mut hits, mut occluded) = (vec![None; rays.len()], vec![false; rays.len()]);
                some.closest_batch(&mut rays.clone(), &mut hits);
                assert_eq!(hits, expected, "batch, round {round}, {level:?}");
                some.closest_packet(&mut rays.clone(), &mut hits);
                assert_eq!(hits, expected, "packet, round {round}, {level:?}");
                some.any_batch(&rays, &mut occluded);
                assert_eq!(occluded, is_hit, "any, batch, round {round}, {level:?}");
                some.any_packet(&rays, &mut occluded);
                assert_eq!(occluded, is_hit, "any, packet, round {round}, {level:?}");
                if let (Some(ray), Some(expected)) = (rays.first(), expected.first()) {
                    assert_eq!((some.closest(ray), some.any(ray)), (*expected, expected.is_some()));
                }
            }
        }
    }
    assert!(differ > 100, "only {differ} rays lost their hit");
}

#[test]
fn empty_mesh_has_no_hits() {
    let empty = Mesh { positions: Vec::new(), triangles: Vec::new() };
    let ray = Ray::new(Vec3::ZERO, Vec3::X);
    for kernels in Kernels::all("empty", &empty) {
        for count in [0, 1, 7, 8, 33, 70] {
            kernels.check(&vec![ray; count], &vec![None; count]);
        }
    }
}

#[test]
fn large_intersecting_triangles_match_brute_force() {
    check("large", &soup(11, 60, |random| near(random, 3.0)), 111);
}

/// Degenerate triangles (points, lines, duplicate vertices) among regular ones.
#[test]
fn triangles_without_area_match_brute_force() {
    let mesh = soup(12, 200, |random| {
        let [a, b, c] = near(random, 0.5);
        match random.below(6) {
            0 => [a, a, a],
            1 => [a, b, b],
            2 => [a, a * 0.5 + b * 0.5, b],
            3 => [a, a + (b - a) * 0.25, b],
            _ => [a, b, c],
        }
    });
    check("without area", &mesh, 112);
}

/// Needles as long as the scene and as thin as rounding errors.
#[test]
fn slivers_match_brute_force() {
    let mesh = soup(13, 100, |random| {
        let (a, b) = (random.point(), random.point());
        let thin = [1e-3, 1e-6, 1e-7, 3e-8][random.below(4)];
        [a, b, a + (b - a) * random.unit() + random.point() * thin]
    });
    check("slivers", &mesh, 113);
}

/// Integer coordinates: coplanar, coincident and duplicate triangles, many ties.
#[test]
fn coincident_triangles_match_brute_force() {
    check("coincident", &soup(14, 200, |random| [(); 3].map(|()| whole(random, 4))), 114);
    check("the same again and again", &soup(15, 100, |_| [Vec3::ZERO, Vec3::X, Vec3::Y]), 115);
}

/// Triangles in axis-aligned planes, whose boxes are flat.
#[test]
fn axis_aligned_triangles_match_brute_force() {
    let mesh = soup(16, 150, |random| {
        let (axis, at) = (random.below(3), random.below(4) as f32);
        [(); 3].map(|()| {
            let mut corner = whole(random, 5) + if random.below(2) == 0 { random.point() } else { Vec3::ZERO };
            corner[axis] = at;
            corner
        })
    });
    check("sheets", &mesh, 116);
}

/// Triangles of sizes from 1e-9 to 1e6 around one point.
#[test]
fn mixed_triangle_sizes_match_brute_force() {
    let mesh = soup(17, 150, |random| {
        let size = [1e-9, 1e-6, 1e-3, 1.0, 1e3, 1e6][random.below(6)];
        let center = random.point() * size;
        [(); 3].map(|()| center + random.point() * size)
    });
    check("huge beside tiny", &mesh, 117);
}

#[test]
fn meshes_of_all_scales_match_brute_force() {
    for (scale, seed) in [(1e-41, 0), (1e-37, 1), (1e-18, 2), (1e-4, 3), (1e6, 4), (1e18, 5)] {
        let mesh = soup(20 + seed, 60, |random| near(random, 0.4)).moved(Vec3::splat(scale), Vec3::ZERO);
        check(&format!("scale {scale:e}"), &mesh, 120 + seed);
    }
    let flat = soup(26, 60, |random| near(random, 0.4)).moved(vec3(1e4, 1e-4, 1.0), Vec3::ZERO);
    check("flat", &flat, 126);
}

/// Subnormal distances are rounded to multiples of 2^-149, where relative margins of box tests
/// vanish. The first ray was missed once.
#[test]
fn subnormal_distances() {
    let mesh = soup(21, 60, |random| near(random, 0.4)).moved(Vec3::splat(1e-37), Vec3::ZERO);
    let origin = vec3(1.559_843_8e-37, -4.480_511e-38, 2.593_070_7e-37);
    let known = Ray { t_min: 3.32e-43, t_max: 3.32e-43, ..Ray::new(origin, vec3(-859_804.3, 55_712.582, -552_114.9)) };
    let random = &mut Random::new(121);
    let toward = |random: &mut Random| {
        let (origin, target) = (random.point() * 3e-37, random.point() * 1e-37);
        let ray = Ray::new(origin, (target - origin) * 1e37 * (4e6 * random.unit()));
        cut(random, &ray, mesh.closest(&ray).map(|hit| hit.t))
    };
    let rays: Vec<Ray> = std::iter::once(known).chain((0..rays_to_try(SMALL)).map(|_| toward(random))).collect();
    let kernels = Kernels::all("subnormal distances", &mesh);
    for rays in rays.chunks(32) {
        let expected: Vec<_> = rays.iter().map(|ray| mesh.closest(ray)).collect();
        kernels.iter().for_each(|kernels| kernels.check(rays, &expected));
    }
}

/// Far from the origin a triangle is a few ulps wide.
#[test]
fn triangles_far_from_the_origin_match_brute_force() {
    for (distance, seed) in [(1e3, 0), (1e5, 1), (3e6, 2)] {
        let offset = vec3(1.0, -0.7, 0.3) * distance;
        let mesh = soup(30 + seed, 100, |random| near(random, 0.4)).moved(Vec3::ONE, offset);
        check(&format!("{distance} away"), &mesh, 130 + seed);
    }
}

/// Rays that start on a flat triangle and leave it at an angle below rounding: their hit distance
/// is all rounding error. Also from that distance on.
#[test]
fn nearly_coplanar_rays_match_brute_force() {
    let mesh = soup(18, 60, |random| [(); 3].map(|()| whole(random, 4).with_x(0.0)));
    let (kernels, random) = (Kernels::all("a hair off the plane", &mesh), &mut Random::new(118));
    for _ in 0..rays_to_try(SMALL) / 8 {
        let origin = vec3(0.0, random.unit() * 3.0, random.unit() * 3.0);
        let ray = Ray::new(origin, vec3([-1e-30, 1e-20][random.below(2)], random.unit() - 0.5, random.unit() - 0.5));
        let from_there_on = |ray: &Ray| Ray { t_min: mesh.closest(ray).map_or(0.0, |hit| hit.t), ..*ray };
        let rays = [ray, from_there_on(&ray)];
        let expected = rays.map(|ray| mesh.closest(&ray));
        kernels.iter().for_each(|kernels| kernels.check(&rays[1..], &expected[1..]));
        kernels.iter().for_each(|kernels| kernels.check(&rays, &expected));
    }
}

/// Long triangles among small ones; with the best quality several leaves refer to them.
#[test]
fn spatially_split_triangles_match_brute_force() {
    for (scale, offset, seed) in [(1.0, 0.0, 0), (1e-6, 0.0, 1), (1e6, 0.0, 2), (1.0, 3e3, 3), (1.0, -1e4, 4)] {
        let mesh = crossed(&mut Random::new(40 + seed), 1500, 150).moved(Vec3::splat(scale), Vec3::splat(offset));
        assert!(is_divided(&mesh), "scale {scale:e}, offset {offset}");
        check(&format!("divided, scale {scale:e}, offset {offset}"), &mesh, 140 + seed);
    }
}

/// Triangles that share one vertex.
#[test]
fn triangle_fan_matches_brute_force() {
    let mesh = soup(33, 120, |random| [vec3(0.25, 0.5, -0.125), random.point(), random.point()]);
    check("fan", &mesh, 133);
}

/// A result slice shorter than the rays: the remaining rays are not traced.
#[test]
fn rays_beyond_the_result_slice_are_not_traced() {
    let mesh = soup(34, 50, |random| near(random, 1.0));
    let tree = TriangleBvh::build(&mesh.positions, &mesh.triangles, Default::default()).unwrap();
    let rays: Vec<Ray> = (0..60).map(|i| Ray::new(Vec3::Z * 5.0, mesh.positions[i] - Vec3::Z * 5.0)).collect();
    for in_flight in [false, true] {
        let tree = tree.clone().with_rays_in_flight(in_flight);
        for closest in [TriangleBvh::closest_batch, TriangleBvh::closest_packet] {
            let (mut ends, mut hits) = (rays.clone(), [None; 37]);
            closest(&tree, &mut ends, &mut hits);
            assert_eq!(hits.to_vec(), rays[..37].iter().map(|ray| tree.closest(ray)).collect::<Vec<_>>());
            assert_eq!(ends[37..], rays[37..]);
        }
    }
}
