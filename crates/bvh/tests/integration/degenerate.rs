//! Degenerate inputs: no items, one item, flat, coincident, empty, NaN, huge and tiny boxes, and
//! deep trees.

use crate::common::{Keep, Random, check};
use juggler_bvh::{Bvh, Quality, TriangleBvh, TriangleError, simd_levels};
use juggler_math::{Aabb, Ray, Vec3, vec3};

#[test]
fn empty_tree_has_no_hits() {
    for quality in Quality::ALL {
        let bvh = Bvh::build([], quality);
        assert!(bvh.order().is_empty() && bvh.bounds().is_empty());
        let mut leaf = Keep::<Aabb>::new(&[], bvh.order(), 8);
        let mut rays = [Ray::new(Vec3::ZERO, Vec3::X); 8];
        bvh.closest(&mut rays[0], &mut leaf);
        bvh.closest_packet(&mut rays, &mut leaf);
        assert!(!bvh.any(&rays[0], &mut leaf));
        bvh.closest_packet(&mut [], &mut leaf);
        bvh.any_packet(&[], &mut [], &mut leaf);
        assert_eq!((leaf.visits, rays), (0, [Ray::new(Vec3::ZERO, Vec3::X); 8]));
    }
}

#[test]
fn empty_and_nan_boxes_are_skipped() {
    let good = Aabb { min: Vec3::ZERO, max: Vec3::ONE };
    let boxes = [
        Aabb::EMPTY,
        good,
        Aabb { min: vec3(f32::NAN, 0.0, 0.0), max: Vec3::ONE },
        Aabb { min: Vec3::ZERO, max: vec3(1.0, f32::NAN, 1.0) },
        Aabb { min: Vec3::ONE, max: vec3(2.0, 0.0, 2.0) },
        good,
    ];
    for quality in Quality::ALL {
        let bvh = Bvh::build(boxes, quality);
        let mut order = bvh.order().to_vec();
        order.sort_unstable();
        assert_eq!(order, [1, 5]);
        assert_eq!((bvh.stats().items, bvh.stats().left_out, bvh.bounds()), (2, 4, good));
    }
}

#[test]
fn degenerate_huge_and_tiny_boxes_match_brute_force() {
    let random = &mut Random::new(7);
    let rays: Vec<Ray> = (0..200).map(|_| Ray::new(random.point() * 3.0, random.direction())).collect();
    let point = |p: Vec3| Aabb { min: p, max: p };
    let equal = vec![point(Vec3::ZERO).grown(1.0); 100];
    check("equal", &equal, &rays, 8);
    check("points", &vec![point(Vec3::ONE); 50], &rays, 8);
    let sheets: Vec<Aabb> = (0..90u8)
        .map(|i| Aabb { min: vec3(-1.0, f32::from(i) * 0.01, -1.0), max: vec3(1.0, f32::from(i) * 0.01, 1.0) })
        .collect();
    check("sheets", &sheets, &rays, 8);
    for scale in [1e-42, 1e-30, 1e-10, 1e10, 1e30, 1e35] {
        let boxes: Vec<Aabb> = (0..100).map(|_| point(random.point() * scale).grown(scale * 0.2)).collect();
        let rays: Vec<Ray> = rays.iter().map(|ray| Ray { origin: ray.origin * scale, ..*ray }).collect();
        check(&format!("scale {scale}"), &boxes, &rays, 8);
    }
    let mut mixed: Vec<Aabb> = (0..100).map(|_| point(random.point()).grown(0.05)).collect();
    mixed.extend([point(Vec3::ZERO).grown(1e30), point(Vec3::ONE).grown(1e-30), point(Vec3::splat(1e20)).grown(1.0)]);
    check("mixed", &mixed, &rays, 8);
}

#[test]
fn infinite_boxes_are_hit() {
    let half_space = Aabb { min: Vec3::NEG_INFINITY, max: vec3(f32::INFINITY, -1.0, f32::INFINITY) };
    let boxes = [Aabb::INFINITE, half_space, Aabb { min: Vec3::ZERO, max: Vec3::ONE }];
    for quality in Quality::ALL {
        let bvh = Bvh::build(boxes, quality);
        assert_eq!(bvh.stats().items, 3);
        for direction in [Vec3::X, -Vec3::Y, vec3(0.3, -0.0, -0.5)] {
            let mut leaf = Keep::new(&boxes, bvh.order(), 1);
            bvh.closest(&mut Ray::new(vec3(0.0, 5.0, 0.0), direction), &mut leaf);
            assert_eq!(leaf.nearest(), [Some((0, 0))]);
        }
    }
}

/// Sizes that double: each best split separates one box, as deep as the exponent goes, repeatedly.
#[test]
fn tree_depth_is_limited() {
    let mut boxes = Vec::new();
    for i in 0..4000u16 {
        let size = (f32::from(i % 250) - 125.0).exp2();
        boxes.push(Aabb { min: Vec3::ZERO, max: vec3(size, size * 0.5, size) });
    }
    for quality in Quality::ALL {
        let bvh = Bvh::build(&boxes, quality);
        assert!(bvh.stats().depth <= 72, "{:?}", bvh.stats());
        let mut leaf = Keep::new(&boxes, bvh.order(), 8);
        let mut rays = [Ray::new(Vec3::splat(-1.0), Vec3::ONE); 8];
        bvh.closest_packet(&mut rays, &mut leaf);
        assert_eq!(rays[7].t_max, 1.0);
    }
}

#[test]
fn degenerate_triangles_and_missing_vertices_are_skipped() {
    let corners = [Vec3::ZERO, Vec3::X, Vec3::Y, vec3(f32::NAN, 0.0, 0.0), Vec3::INFINITY, Vec3::X * 0.5];
    let down = Ray::new(vec3(0.2, 0.2, 1.0), -Vec3::Z);
    for quality in Quality::ALL {
        assert_eq!(TriangleBvh::build(&[], &[], quality).unwrap().closest(&down), None);
        let bvh =
            TriangleBvh::build(&corners, &[[0, 1, 3], [0, 0, 0], [0, 1, 5], [0, 1, 4], [0, 1, 2], [2, 1, 0]], quality)
                .unwrap();
        assert_eq!(bvh.stats().items, 2);
        let hit = bvh.closest(&down).unwrap();
        assert_eq!((hit.index, hit.t), (4, 1.0));
        assert!(bvh.any(&down) && !bvh.any(&down.with_t_max(0.5)));
        let error = TriangleBvh::build(&corners, &[[0, 1, 2], [0, 6, 1]], quality).unwrap_err();
        assert_eq!(error, TriangleError::NoSuchVertex { triangle: 1, vertex: 6, vertices: 6 });
        assert_eq!(error.to_string(), "triangle 1 names vertex 6, but there are 6 vertices");
    }
}

/// Infinite and undefined rays: free slots of nodes hold boxes at infinity, which such rays must
/// not enter.
#[test]
fn rays_that_are_not_finite_hit_nothing() {
    const VALUES: [f32; 4] = [f32::INFINITY, f32::NEG_INFINITY, f32::NAN, 0.5];
    let corners = [Vec3::ZERO, Vec3::X, Vec3::Y];
    let tree = TriangleBvh::build(&corners, &[[0, 1, 2]; 30], Quality::Balanced).unwrap();
    let good = Ray::new(vec3(0.2, 0.2, 1.0), vec3(0.0, 0.0, -1.0));
    let numbers = (0..1 << 12).map(|n| std::array::from_fn(|i| VALUES[n >> (2 * i) & 3]));
    let rays: Vec<Ray> = numbers
        .map(|[ox, oy, oz, dx, dy, dz]: [f32; 6]| Ray::new(vec3(ox, oy, oz), vec3(dx, dy, dz)))
        .filter(|ray| !(ray.origin.is_finite() && ray.direction.is_finite()))
        .flat_map(|ray| [good, ray, good])
        .collect();
    for level in simd_levels() {
        let tree = tree.clone().with_simd_level(level);
        let (mut hits, mut occluded) = (vec![None; rays.len()], vec![false; rays.len()]);
        let alone: Vec<bool> = rays.iter().map(|ray| tree.closest(ray).is_some() && tree.any(ray)).collect();
        assert!(alone.chunks(3).all(|hits| hits == [true, false, true]), "{level:?}");
        for in_flight in [false, true] {
            let tree = tree.clone().with_rays_in_flight(in_flight);
            tree.closest_batch(&mut rays.clone(), &mut hits);
            tree.any_batch(&rays, &mut occluded);
            assert!(hits.iter().map(Option::is_some).eq(alone.iter().copied()) && occluded == alone, "{level:?}");
        }
        tree.closest_packet(&mut rays.clone(), &mut hits);
        tree.any_packet(&rays, &mut occluded);
        assert!(hits.iter().map(Option::is_some).eq(alone.iter().copied()) && occluded == alone, "{level:?}");
    }
}
