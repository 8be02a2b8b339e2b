//! Trees with spatial splits: SAH cost, contents, and coverage of every triangle by its leaves.

use super::*;
use juggler_math::hash;

/// Small triangles everywhere, crossed by `long` long thin ones in random directions.
fn crossed(count: u32, long: u32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let unit = |i: u32, k: u32| hash::unit_f32(hash::mix(hash::combine(i, k)));
    let point = |i: u32, k: u32| Vec3::new(unit(i, k), unit(i, k + 1), unit(i, k + 2)) * 2.0 - Vec3::ONE;
    let corners = |i: u32| {
        let size = if i < long { 1.0 } else { 0.02 };
        let (center, along) = (point(i, 0), point(i, 3) * size);
        [center - along, center + along, center + along + point(i, 6) * 0.02]
    };
    let positions = (0..count).flat_map(corners).collect();
    (positions, (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect())
}

/// Tree without spatial splits.
fn whole(mesh: &TriangleList) -> Bvh {
    let options = BuildOptions { block: LANES, ..Quality::Best.into() };
    Bvh::from_items(mesh.items(&BuildControl::default()).unwrap(), &options, &BuildControl::default()).unwrap()
}

/// Tree with spatial splits.
fn with_spatial_splits(mesh: &TriangleList, options: &BuildOptions) -> Bvh {
    Bvh::with_spatial_splits(mesh.items(&BuildControl::default()).unwrap(), options, mesh, &BuildControl::default())
        .unwrap()
}

#[test]
fn spatial_splits_never_increase_the_sah_cost() {
    for (count, long) in [(3, 3), (100, 20), (3000, 0), (3000, 300), (40_000, 300)] {
        let (positions, triangles) = crossed(count, long);
        let tree = TriangleBvh::build(&positions, &triangles, Quality::Best).unwrap();
        let (stats, whole) = (tree.stats(), whole(&TriangleList { positions: &positions, triangles: &triangles }));
        assert!(stats.sah_cost <= whole.stats.sah_cost, "{count}, {long}: {stats:?}");
        assert_eq!((stats.items, stats.left_out), (count as usize, 0));
        let places: usize = stats.leaf_sizes.iter().enumerate().map(|(size, leaves)| size * leaves).sum();
        assert_eq!(places, stats.references);
        assert!((count as usize..=count as usize * 5 / 4).contains(&stats.references), "{stats:?}");
        if count >= 3000 && long > 0 {
            assert!(stats.references > stats.items && stats.sah_cost < whole.stats.sah_cost * 0.97, "{stats:?}");
        }
    }
}

/// Boxes of the leaves that refer to each triangle.
fn boxes_of(bvh: &Bvh, triangles: usize) -> Vec<Vec<Aabb>> {
    let mut boxes = vec![Vec::new(); triangles];
    for node in bvh.nodes.iter() {
        for slot in (0..node.count as usize).filter(|&slot| node.children[slot].is_leaf()) {
            let side = |side: usize| Vec3::from(node.bounds.map(|sides| sides[side][slot]));
            for position in node.children[slot].items() {
                boxes[bvh.order[position as usize] as usize].push(Aabb { min: side(0), max: side(1) });
            }
        }
    }
    boxes
}

/// Every point of a triangle lies in the box of one of its leaves, with a margin on all sides.
#[test]
fn no_part_of_a_triangle_is_missing() {
    for (scale, offset) in [(1.0, 0.0), (1e-20, 0.0), (1e25, 0.0), (1.0, 3000.0), (1.0, -1e4)] {
        let (positions, triangles) = crossed(3000, 300);
        let positions: Vec<Vec3> = positions.iter().map(|p| *p * scale + offset * scale).collect();
        let mesh = TriangleList { positions: &positions, triangles: &triangles };
        let options = BuildOptions { block: LANES, ..Quality::Best.into() };
        let bvh = with_spatial_splits(&mesh, &options);
        let mut divided = 0;
        for (triangle, boxes) in boxes_of(&bvh, triangles.len()).iter().enumerate() {
            let corners = mesh.corners(triangle).unwrap();
            if has_area(corners) {
                divided += usize::from(boxes.len() > 1);
                check_points(corners, boxes);
            }
        }
        assert!(divided > 20, "scale {scale:e}, offset {offset}: only {divided} triangles are divided");
    }
}

fn check_points(corners: [Vec3; 3], boxes: &[Aabb]) {
    let margin = f64::from(margin_of(corners)) * 0.99;
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    for step in 0..40 * 40 {
        let (u, v) = (f64::from(step % 40) / 39.0, f64::from(step / 40) / 39.0);
        let point = a * (1.0 - u) + (b * (1.0 - v) + c * v) * u;
        let holds = |bounds: &Aabb| {
            let (low, high) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
            (point - margin).cmpge(low).all() && (point + margin).cmple(high).all()
        };
        assert!(boxes.iter().any(holds), "{point} of {corners:?} is in none of {boxes:?}");
    }
}

#[test]
fn spatial_splits_do_not_depend_on_threads() {
    let (positions, triangles) = crossed(60_000, 500);
    let build = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| TriangleBvh::build(&positions, &triangles, Quality::Best).unwrap())
    };
    let ray_visitor = build(1);
    assert!(ray_visitor.stats().references > ray_visitor.stats().items + 500, "{:?}", ray_visitor.stats());
    assert!([2, 3].into_iter().all(|threads| ray_visitor.same_bits(&build(threads))));
}

/// Degenerate triangles, indivisible triangles and extreme coordinates.
#[test]
fn bad_triangles_are_left_out_or_divided_soundly() {
    let (mut positions, triangles) = crossed(3000, 300);
    positions[0] = Vec3::NAN;
    positions[5] = Vec3::INFINITY;
    positions[7] = positions[6];
    positions[100] = Vec3::splat(f32::MAX);
    positions[103] = Vec3::splat(-f32::MAX);
    let tree = TriangleBvh::build(&positions, &triangles, Quality::Best).unwrap();
    assert_eq!((tree.stats().items, tree.stats().left_out), (2997, 3));
    let mesh = TriangleList { positions: &positions, triangles: &triangles };
    let options = BuildOptions { block: LANES, ..Quality::Best.into() };
    for count in [0, 1, 2, 9] {
        let mesh = TriangleList { triangles: &triangles[10..10 + count], ..mesh };
        let bvh = with_spatial_splits(&mesh, &options);
        assert_eq!((bvh.stats.items, bvh.stats.references >= count), (count, true));
    }
    let equal = vec![triangles[20]; 500];
    let mesh = TriangleList { triangles: &equal, ..mesh };
    let bvh = with_spatial_splits(&mesh, &options);
    assert!(bvh.stats.items == 500 && bvh.stats.references <= 625 && bvh.stats.depth <= 72, "{:?}", bvh.stats);
}
