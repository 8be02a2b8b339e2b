//! Refitted trees agree with brute force, and reject items that they do not contain.

use crate::common::mesh::{Kernels, crossed, is_divided};
use crate::common::{Keep, Random, brute_force};
use juggler_bvh::{Bvh, Quality, RefitError, TriangleBvh, TriangleError, intersect_triangle, simd_levels};
use juggler_math::{Aabb, Ray, Vec3};

fn boxes(random: &mut Random, count: usize) -> Vec<Aabb> {
    let one = |_| {
        let center = random.point();
        Aabb::from_points([center + random.point() * 0.05, center + random.point() * 0.05])
    };
    (0..count).map(one).collect()
}

fn rays(random: &mut Random, count: usize) -> Vec<Ray> {
    (0..count).map(|_| Ray::new(random.point() * 2.0, random.direction())).collect()
}

#[test]
fn moved_boxes_are_found_where_they_are() {
    let random = &mut Random::new(21);
    for quality in Quality::ALL {
        let before = boxes(random, 3000);
        let mut bvh = Bvh::build(&before, quality);
        let mut after: Vec<Aabb> =
            before.iter().map(|b| Aabb { min: b.min * 1.5 + 0.2, max: b.max * 1.5 + 0.3 }).collect();
        after[7] = Aabb::EMPTY;
        after[100] = Aabb::INFINITE;
        bvh.refit(&after).unwrap();
        for ray in rays(random, 300) {
            let mut leaf = Keep::new(&after, bvh.order(), 1);
            bvh.closest(&mut { ray }, &mut leaf);
            assert_eq!(leaf.nearest(), [brute_force(&after, &ray)], "{quality:?}: {ray:?}");
        }
    }
}

#[test]
fn refit_with_equal_boxes_changes_nothing() {
    let random = &mut Random::new(22);
    for quality in Quality::ALL {
        let mut boxes = boxes(random, 5000);
        boxes[3] = Aabb::EMPTY;
        boxes[4] = Aabb { min: Vec3::splat(-0.0), max: Vec3::splat(0.0) };
        boxes[5].max.x = f32::INFINITY;
        let mut bvh = Bvh::build(&boxes, quality);
        let before = format!("{bvh:?}");
        bvh.refit(&boxes).unwrap();
        assert!(before == format!("{bvh:?}"), "{quality:?}");
    }
}

#[test]
fn refit_rejects_other_items() {
    let random = &mut Random::new(23);
    let mut boxes = boxes(random, 100);
    boxes[40] = Aabb::EMPTY;
    let mut bvh = Bvh::build(&boxes, Quality::Balanced);
    assert_eq!(bvh.refit(&boxes[1..]), Err(RefitError::Count { expected: 100, found: 99 }));
    boxes[40] = boxes[41];
    assert_eq!(bvh.refit(&boxes), Err(RefitError::LeftOut { item: 40 }));
    assert_eq!(bvh.refit(&boxes).unwrap_err().to_string(), "item 40 was left out of the tree, but now has a size");
    boxes[40] = Aabb::EMPTY;
    boxes[41] = Aabb::EMPTY;
    assert_eq!(bvh.refit(&boxes), Ok(()));
}

fn closest(positions: &[Vec3], triangles: &[[u32; 3]], ray: &Ray) -> Option<(f32, u32)> {
    let hit = |(index, triangle): (usize, &[u32; 3])| {
        let [a, b, c] = triangle.map(|vertex| positions[vertex as usize]);
        intersect_triangle(ray, a, b, c).map(|(t, ..)| (t, index as u32))
    };
    triangles.iter().enumerate().filter_map(hit).min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))
}

#[test]
fn moved_triangles_are_found_where_they_are() {
    let random = &mut Random::new(24);
    let count = 2000u32;
    let corner = |i: u32, random: &mut Random| random.point() * if i.is_multiple_of(100) { 1.0 } else { 0.05 };
    let mut positions = Vec::new();
    for i in 0..count {
        let center = random.point();
        positions.extend((0..3).map(|_| center + corner(i, random)));
    }
    let triangles: Vec<[u32; 3]> = (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    for quality in Quality::ALL {
        let mut bvh = TriangleBvh::build(&positions, &triangles, quality).unwrap();
        let mut moved: Vec<Vec3> = positions.iter().map(|p| Vec3::new(p.x, p.y + p.x * p.z, p.z)).collect();
        moved[5] = moved[4];
        moved[9] = Vec3::NAN;
        bvh.refit(&moved, &triangles).unwrap();
        for ray in rays(random, 300) {
            let found = bvh.closest(&ray).map(|hit| (hit.t, hit.index));
            assert_eq!(found, closest(&moved, &triangles, &ray), "{quality:?}: {ray:?}");
        }
        // Refit back to the original positions after degenerate ones.
        bvh.refit(&positions, &triangles).unwrap();
        for ray in rays(random, 300) {
            let found = bvh.closest(&ray).map(|hit| (hit.t, hit.index));
            assert_eq!(found, closest(&positions, &triangles, &ray), "{quality:?}: {ray:?}");
        }
        let error = bvh.refit(&moved[1..], &triangles).unwrap_err();
        assert!(matches!(error, TriangleError::NoSuchVertex { triangle: 1999, .. }), "{error}");
        let error = bvh.refit(&moved, &triangles[1..]).unwrap_err();
        assert_eq!(error, TriangleError::Refit(RefitError::Count { expected: 2000, found: 1999 }));
    }
}

#[test]
fn refit_with_equal_triangles_changes_nothing() {
    let random = &mut Random::new(25);
    let positions: Vec<Vec3> = (0..900).map(|_| random.point()).collect();
    let triangles: Vec<[u32; 3]> = (0..300u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    for quality in [Quality::Fast, Quality::Balanced] {
        let mut bvh = TriangleBvh::build(&positions, &triangles, quality).unwrap();
        let before = format!("{bvh:?}");
        bvh.refit(&positions, &triangles).unwrap();
        assert!(before == format!("{bvh:?}"), "{quality:?}");
    }
}

#[test]
fn divided_triangles_are_found_where_they_are() {
    let random = &mut Random::new(26);
    let before = crossed(random, 1500, 150);
    assert!(is_divided(&before));
    let mut after = before.moved(Vec3::new(0.7, -1.2, 1.0), Vec3::splat(0.1));
    after.positions[3] = Vec3::NAN;
    let mut bvh = TriangleBvh::build(&before.positions, &before.triangles, Quality::Best).unwrap();
    for mesh in [&after, &before] {
        bvh.refit(&mesh.positions, &mesh.triangles).unwrap();
        assert_eq!(bvh.stats().items, 1500);
        let rays = rays(random, 300);
        let expected: Vec<_> = rays.iter().map(|ray| mesh.closest(ray)).collect();
        for level in simd_levels() {
            Kernels::new("divided", &bvh, level).check(&rays, &expected);
        }
    }
}
