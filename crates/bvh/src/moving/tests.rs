use super::*;
use juggler_math::hash;

const TIMES: [f32; 7] = [0.0, 1e-7, 0.25, 1.0 / 3.0, 0.5, 0.999_999_9, 1.0];

fn boxes(count: u32) -> Vec<[Aabb; 2]> {
    let unit = |i: u32, k: u32| hash::unit_f32(hash::mix(hash::combine(i, k))) * 2.0 - 1.0;
    let point = |i: u32, k: u32| Vec3::new(unit(i, k), unit(i, k + 1), unit(i, k + 2));
    let end = |i: u32, k: u32| {
        let center = point(i, k) * 10.0;
        Aabb::from_points([center + point(i, k + 3) * 0.3, center + point(i, k + 6) * 0.3])
    };
    (0..count).map(|i| if i == 3 { [Aabb::EMPTY, end(i, 0)] } else { [end(i, 0), end(i, 9)] }).collect()
}

fn contains(bounds: &Bounds, slot: usize, low: [f64; 3], high: [f64; 3]) -> bool {
    let sides = bounds.map(|sides| sides.map(|values| f64::from(values[slot])));
    (0..3).all(|axis| sides[axis][0] <= low[axis] && high[axis] <= sides[axis][1])
}

/// Box of a slot as (minimum, maximum).
fn slot_of(bounds: &Bounds, slot: usize) -> ([f64; 3], [f64; 3]) {
    let side = |side: usize| bounds.map(|sides| f64::from(sides[side][slot]));
    (side(0), side(1))
}

/// Checks that the boxes of a node's slots contain the boxes below them.
fn check(tree: &MovingBvh, boxes: &[[Aabb; 2]], number: usize, time: f32) {
    let bvh = &tree.bvh;
    let node = &bvh.nodes[number];
    let bounds = tree.motion[number].at(time);
    for slot in 0..WIDTH {
        let (low, high) = slot_of(&bounds, slot);
        if slot >= node.count as usize {
            assert!((0..3).all(|axis| low[axis] > high[axis]), "a free slot is hit");
            continue;
        }
        let child = node.children[slot];
        if child.is_leaf() {
            for position in child.items() {
                let [open, close] = boxes[bvh.order[position as usize] as usize];
                let lerp = |a: Vec3, b: Vec3| a.as_dvec3().lerp(b.as_dvec3(), f64::from(time)).to_array();
                let (low, high) = (lerp(open.min, close.min), lerp(open.max, close.max));
                assert!(contains(&bounds, slot, low, high) && contains(&node.bounds, slot, low, high));
            }
        } else {
            let below = tree.motion[child.0 as usize].at(time);
            for part in 0..bvh.nodes[child.0 as usize].count as usize {
                let (low, high) = slot_of(&below, part);
                assert!(contains(&bounds, slot, low, high));
            }
        }
    }
}

#[test]
fn interpolated_boxes_contain_interpolated_items() {
    for count in [0, 1, 9, 3000] {
        let boxes = boxes(count);
        for quality in Quality::ALL {
            let tree = MovingBvh::build(&boxes, 1.0, quality);
            assert_eq!((tree.motion.len(), tree.stats().left_out), (tree.stats().nodes, usize::from(count > 3)));
            for time in TIMES {
                (0..tree.motion.len()).for_each(|number| check(&tree, &boxes, number, time));
            }
        }
    }
}

#[test]
fn ray_times_become_clamped_fractions_of_the_shutter() {
    let fraction = |shutter: f32, time: f32| {
        let tree = MovingBvh::build(&[], shutter, Quality::Fast);
        tree.shutter_fraction(&Ray { time, ..Ray::new(Vec3::ZERO, Vec3::X) })
    };
    assert_eq!([fraction(0.5, 0.0), fraction(0.5, 0.125), fraction(0.5, 0.5)], [0.0, 0.25, 1.0]);
    assert_eq!([fraction(0.5, -1.0), fraction(0.5, 9.0), fraction(0.5, f32::NAN)], [0.0, 1.0, 0.0]);
    assert_eq!([fraction(0.0, 0.0), fraction(0.0, 1.0), fraction(f32::NAN, 1.0)], [0.0, 1.0, 0.0]);
}
