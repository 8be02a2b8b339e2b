//! Trees are valid, and the same for any number of threads.

use super::*;
use crate::node::{Child, Node};
use crate::{TriangleBvh, node};
use juggler_math::{Vec3, hash};

/// Clustered boxes of many sizes, enough for several parallel tasks.
fn boxes(count: u32) -> Vec<Aabb> {
    let unit = |i: u32, k: u32| hash::unit_f32(hash::mix(hash::combine(i, k)));
    let point = |i: u32, k: u32| Vec3::new(unit(i, k), unit(i, k + 1), unit(i, k + 2)) * 2.0 - Vec3::ONE;
    let bounds = |i: u32| {
        let size = 0.1 * unit(i, 6) * unit(i, 7);
        let center = point(i % 97, 8) + point(i, 0) * 0.3;
        Aabb::from_points([center + point(i, 3) * size, center - point(i, 3) * size])
    };
    (0..count).map(bounds).collect()
}

fn hash_of(bytes: &[u8]) -> u32 {
    let words = bytes.chunks_exact(4).map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]]));
    words.fold(0, hash::combine)
}

#[test]
fn both_partitions_separate_the_sides() {
    let boxes = boxes(2_000);
    for (count, chunk) in [(2_000, 64), (2_000, 1_999), (1_000, 7), (65, 64), (64, 64), (2, 1)] {
        let Ok(mut items) = Items::new(count, |i| Ok::<_, Infallible>(SimdBox::raw(&boxes[i])));
        let mapping = bins::Mapping::new(items.extents.centers, count).unwrap();
        let mut bins = bins::Bins::EMPTY;
        bins.fill(&mapping, items.list());
        let split = bins.best(&mapping, items.extents.bounds, BlockShift(0)).unwrap();
        let side_test = bins::SideTest::new(&mapping, &split);
        let expected: Vec<usize> = items.list().iter().map(|item| usize::from(side_test.is_left(item))).collect();
        let mut copy = items.list().to_vec();
        let (left, centers) = partition::in_place(&mut copy, &side_test);
        let (parallel, parallel_centers) = partition::in_place_parallel(items.list(), chunk, &side_test);
        assert_eq!((left, parallel), (expected.iter().sum(), left), "{count} items in chunks of {chunk}");
        assert_eq!(centers.map(SimdBox::aabb), parallel_centers.map(SimdBox::aabb));
        for list in [&copy[..], items.list()] {
            let mut numbers: Vec<u32> = list.iter().map(item::Item::number).collect();
            let sides = numbers.iter().enumerate().all(|(i, &item)| expected[item as usize] == usize::from(i < left));
            numbers.sort_unstable();
            assert!(sides && numbers.iter().copied().eq(0..count as u32), "{count} items in chunks of {chunk}");
        }
    }
}

fn in_pool<T: Send>(threads: usize, run: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(run)
}

#[test]
fn any_number_of_threads_builds_the_same_tree() {
    let boxes = boxes(60_000);
    for quality in Quality::ALL {
        let build = |threads| in_pool(threads, || Bvh::build(&boxes, quality));
        let one = build(1);
        for threads in [2, 3] {
            let many = build(threads);
            assert!(*one.nodes == *many.nodes, "{quality:?}, {threads} threads");
            assert_eq!((&one.order, &one.stats), (&many.order, &many.stats), "{quality:?}, {threads} threads");
        }
    }
}

/// Debug and release builds must agree on these hashes.
#[test]
fn every_machine_builds_the_same_tree() {
    let boxes = boxes(40_000);
    let hash = |quality| hash_of(bytemuck::cast_slice(&Bvh::build(&boxes, quality).nodes));
    assert_eq!(Quality::ALL.map(hash), [4_193_529_845, 680_230_009, 4_144_913_404]);
}

#[test]
fn any_number_of_threads_packs_the_same_triangles() {
    let boxes = boxes(30_000);
    let positions: Vec<Vec3> = boxes.iter().flat_map(|b| [b.min, b.max, b.center().with_x(b.max.x)]).collect();
    let triangles: Vec<[u32; 3]> = (0..boxes.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    for quality in Quality::ALL {
        let build = |threads| in_pool(threads, || TriangleBvh::build(&positions, &triangles, quality).unwrap());
        let one = build(1);
        for threads in [2, 3] {
            let many = build(threads);
            assert!(one.same_bits(&many), "{quality:?}, {threads} threads");
        }
    }
}

/// Checks that every item has one leaf, every box contains the boxes below, every node and position
/// is used once, and the stack bound holds.
fn check(name: &str, bvh: &Bvh, boxes: &[Aabb]) {
    let mut visits = vec![0; bvh.order.len()];
    let mut nodes = vec![0; bvh.nodes.len()];
    let stack = check_node(bvh, boxes, Child::ROOT, &mut visits, &mut nodes, 1);
    assert!(stack <= bvh.stats.stack, "{name}");
    assert!(bvh.stats.stack <= crate::stack::SIZE && bvh.stats.depth <= 72, "{name}: {:?}", bvh.stats);
    assert!(visits.iter().all(|&times| times == 1) && nodes.iter().all(|&times| times == 1), "{name}");
    let mut order = bvh.order.clone();
    order.sort_unstable();
    order.dedup();
    assert_eq!(order.len(), bvh.stats.items, "{name}");
    assert_eq!(order.len() + bvh.stats.left_out, boxes.len(), "{name}");
    let sizes: usize = bvh.stats.leaf_sizes.iter().enumerate().map(|(size, count)| size * count).sum();
    assert_eq!((sizes, bvh.stats.nodes), (bvh.order.len(), bvh.nodes.len()), "{name}");
}

fn slot_box(node: &Node, slot: usize) -> Aabb {
    let corner = |side: usize| Vec3::from(std::array::from_fn(|axis| node.bounds[axis][side][slot]));
    Aabb { min: corner(0), max: corner(1) }
}

/// Checks a subtree; returns the stack size that it needs.
fn check_node(bvh: &Bvh, boxes: &[Aabb], number: Child, visits: &mut [u32], nodes: &mut [u32], depth: usize) -> usize {
    nodes[number.0 as usize] += 1;
    assert!(depth <= bvh.stats.depth);
    let node = &bvh.nodes[number.0 as usize];
    let count = node.count as usize;
    let mut stack = count;
    for slot in 0..count {
        let (child, union) = (node.children[slot], slot_box(node, slot));
        let inside = |b: &Aabb| b.min.cmpge(union.min).all() && b.max.cmple(union.max).all();
        if child.is_leaf() {
            for position in child.items() {
                visits[position as usize] += 1;
                let limit = Vec3::splat(f32::MAX);
                let bounds = boxes[bvh.order[position as usize] as usize];
                assert!(inside(&Aabb { min: bounds.min.max(-limit), max: bounds.max.min(limit) }));
            }
        } else {
            let below = &bvh.nodes[child.0 as usize];
            assert!((0..below.count as usize).all(|slot| inside(&slot_box(below, slot))));
            stack = stack.max(count - 1 + check_node(bvh, boxes, child, visits, nodes, depth + 1));
        }
    }
    assert!((count..node::WIDTH).all(|slot| slot_box(node, slot).is_empty()));
    stack
}

#[test]
fn trees_hold_every_item_once() {
    for count in [0, 1, 2, 7, 8, 9, 64, 65, 1000, 20_000, 70_000] {
        let boxes = boxes(count);
        for quality in Quality::ALL {
            check(&format!("{count}, {quality:?}"), &Bvh::build(&boxes, quality), &boxes);
        }
    }
}

/// Degenerate boxes in large numbers: construction must stay fast and not recurse deeply.
#[test]
fn degenerate_boxes_give_valid_trees() {
    let many = if cfg!(debug_assertions) { 1 << 17 } else { 1 << 20 };
    let random = boxes(1 << 16);
    let cube = Aabb { min: -Vec3::ONE, max: Vec3::ONE };
    let one_bad = |bad: Aabb| random.iter().enumerate().map(|(i, b)| if i == 70 { bad } else { *b }).collect();
    let scaled = |s: f32| random.iter().map(|b| Aabb { min: b.min * s, max: b.max * s }).collect();
    let cases: [(&str, Vec<Aabb>); 9] = [
        ("identical", vec![cube; many]),
        ("one center", random.iter().map(|b| Aabb { min: -b.max.abs(), max: b.max.abs() }).collect()),
        ("infinite", random.iter().map(|b| Aabb { min: b.min, max: Vec3::splat(f32::INFINITY) }).collect()),
        ("one without end", one_bad(Aabb::INFINITE)),
        ("one NaN", one_bad(Aabb { min: Vec3::NAN, max: Vec3::ONE })),
        (
            "every second empty",
            random.iter().enumerate().map(|(i, b)| if i % 2 == 0 { Aabb::EMPTY } else { *b }).collect(),
        ),
        ("huge", scaled(1e38)),
        ("tiny", scaled(1e-44)),
        ("points on a line", random.iter().map(|b| Aabb::from_points([Vec3::X * b.min.x])).collect()),
    ];
    for (name, boxes) in &cases {
        for quality in Quality::ALL {
            check(&format!("{name}, {quality:?}"), &Bvh::build(boxes, quality), boxes);
        }
    }
}
