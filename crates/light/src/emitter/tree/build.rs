//! Top-down construction of the light tree: splits the lights of a node in two where the cost is
//! lowest, until the node has as many parts as slots.

use super::child_bounds::{BuildLight, ChildBounds, CostEstimate};
use super::node::{Child, Node, WIDTH};
use super::{LightBounds, LightTree};
use arrayvec::ArrayVec;
use juggler_math::{Aabb, BuildControl, Cancelled, Vec3};
use std::ops::Range;

/// Level from which parts are split in the middle, so that any number of lights fits into the 21
/// levels of a bit trail.
const BALANCED_LEVEL: u32 = 10;
const LEVELS: u32 = 21;
/// Number of buckets along each axis; splits lie between them.
const BUCKETS: usize = 12;
/// Minimum power relative to the strongest light, so that no product underflows.
const MIN_POWER: f32 = 1e-10;

/// Node whose slots are not filled yet.
struct Task {
    node: usize,
    range: Range<usize>,
    level: u32,
    bit_trail: u64,
}

pub(super) fn build(lights: &[LightBounds], control: &BuildControl) -> Result<LightTree, Cancelled> {
    let (mut items, scale) = build_lights(lights);
    let mut tree = LightTree { scale, ..LightTree::empty(lights.len()) };
    if items.is_empty() {
        return Ok(tree);
    }
    tree.nodes.push(Node::empty());
    let mut tasks = vec![Task { node: 0, range: 0..items.len(), level: 0, bit_trail: 0 }];
    while let Some(task) = tasks.pop() {
        control.check()?;
        for (slot, part) in split_into_children(&mut items, &task).into_iter().enumerate() {
            let bit_trail = task.bit_trail | (slot as u64) << (3 * task.level);
            let child = match &items[part.clone()] {
                [single] => {
                    tree.bit_trails[single.index as usize] = bit_trail;
                    Child::Light(single.index)
                }
                _ => Child::Node(tree.nodes.len()),
            };
            tree.nodes[task.node].set(slot, &ChildBounds::from_lights(&items[part.clone()]), child);
            if let Child::Node(node) = child {
                tree.nodes.push(Node::empty());
                tasks.push(Task { node, range: part, level: task.level + 1, bit_trail });
            }
        }
    }
    Ok(tree)
}

/// Emitting lights in coordinates below 1 and with powers up to 1, and the scale factor of the
/// coordinates.
fn build_lights(lights: &[LightBounds]) -> (Vec<BuildLight>, f32) {
    let emits = |light: &LightBounds| {
        light.power > 0.0
            && light.power < f32::INFINITY
            && light.bounds.is_finite()
            && !light.bounds.is_empty()
            && (light.axis * 0.0 + light.cos_theta_o * light.cos_theta_e * 0.0).is_finite()
    };
    let emitting = || (0u32..).zip(lights).filter(|(_, light)| emits(light));
    let largest = |bounds: &Aabb| bounds.min.abs().max(bounds.max.abs()).max_element();
    let scale = power_of_two_below(emitting().fold(0.0, |most, (_, light)| largest(&light.bounds).max(most)));
    let strongest = emitting().fold(0.0, |most: f32, (_, light)| most.max(light.power));
    let item = |(index, light): (u32, &LightBounds)| {
        let bounds = Aabb { min: light.bounds.min * scale, max: light.bounds.max * scale };
        let power = (light.power / strongest).max(MIN_POWER);
        BuildLight { index, center: bounds.center(), light: LightBounds { bounds, power, ..*light } }
    };
    (emitting().map(item).collect(), scale)
}

/// Power of two whose product with `largest` lies between 1/2 and 1, or up to 4 for the largest
/// finite numbers; 1 if `largest` is 0. Products with it are exact.
fn power_of_two_below(largest: f32) -> f32 {
    let exponent = (largest.to_bits() >> 23) as i32;
    // The exponent is biased by 127; the scale must stay a normal number.
    if largest == 0.0 { 1.0 } else { f32::from_bits(((253 - exponent).clamp(1, 253) as u32) << 23) }
}

/// Splits the lights of a node into as many parts as there are slots, or into single lights.
fn split_into_children(items: &mut [BuildLight], task: &Task) -> ArrayVec<Range<usize>, WIDTH> {
    let mut parts = ArrayVec::new();
    if task.range.len() <= WIDTH || task.level + 1 >= LEVELS {
        parts.extend(task.range.clone().map(|i| i..i + 1).take(WIDTH));
        return parts;
    }
    let balanced = task.level >= BALANCED_LEVEL;
    let priority = |items: &[BuildLight], range: &Range<usize>| match range.len() {
        1 => -1.0,
        count if balanced => count as f64,
        _ => estimate(&items[range.clone()]).cost(),
    };
    let mut priorities: ArrayVec<f64, WIDTH> = ArrayVec::new();
    priorities.push(priority(items, &task.range));
    parts.push(task.range.clone());
    while parts.len() < WIDTH {
        let largest =
            (0..parts.len()).fold(0, |largest, i| if priorities[i] > priorities[largest] { i } else { largest });
        let range = parts[largest].clone();
        if range.len() < 2 {
            break;
        }
        let middle = range.start + if balanced { range.len() / 2 } else { partition(&mut items[range.clone()]) };
        (parts[largest], priorities[largest]) = (range.start..middle, priority(items, &(range.start..middle)));
        parts.push(middle..range.end);
        priorities.push(priority(items, &(middle..range.end)));
    }
    parts
}

fn estimate(items: &[BuildLight]) -> CostEstimate {
    let side = items.first().map_or(Vec3::Z, |item| item.light.axis);
    items.iter().fold(CostEstimate::NONE, |sum, item| sum.with_light(&item.light, side))
}

/// Partitions two or more lights and returns the size of the first part, which is neither 0 nor
/// all.
fn partition(items: &mut [BuildLight]) -> usize {
    let centers = Aabb::from_points(items.iter().map(|item| item.center));
    let Some((axis, last)) = best_split(items, &centers) else { return items.len() / 2 };
    let mut count = 0;
    for i in 0..items.len() {
        if bucket(&items[i], &centers, axis) <= last {
            items.swap(i, count);
            count += 1;
        }
    }
    if count == 0 || count == items.len() { items.len() / 2 } else { count }
}

fn bucket(item: &BuildLight, centers: &Aabb, axis: usize) -> usize {
    let (low, high) = (centers.min[axis], centers.max[axis]);
    let fraction = (item.center[axis] - low) / (high - low);
    ((fraction * BUCKETS as f32) as usize).min(BUCKETS - 1)
}

/// Split of lowest cost: the axis and the last bucket of the first part; `None` if all lights have
/// the same center.
fn best_split(items: &[BuildLight], centers: &Aabb) -> Option<(usize, usize)> {
    let side = items.first()?.light.axis;
    let mut buckets = [[CostEstimate::NONE; BUCKETS]; 3];
    let axes: ArrayVec<usize, 3> = (0..3).filter(|axis| centers.extent()[*axis] > 0.0).collect();
    for item in items {
        for &axis in &axes {
            let estimate = &mut buckets[axis][bucket(item, centers, axis)];
            *estimate = estimate.with_light(&item.light, side);
        }
    }
    let mut best = (f64::INFINITY, None);
    for axis in axes {
        for (last, cost) in split_costs(&buckets[axis], axis) {
            if cost < best.0 {
                best = (cost, Some((axis, last)));
            }
        }
    }
    best.1
}

/// Costs of all splits between buckets that leave lights on both sides. Splits across a short axis
/// cost more, which favors cubical parts (the regularization of Conty Estevez and Kulla).
fn split_costs(buckets: &[CostEstimate; BUCKETS], axis: usize) -> ArrayVec<(usize, f64), BUCKETS> {
    let mut after = [CostEstimate::NONE; BUCKETS];
    for i in (0..BUCKETS - 1).rev() {
        after[i] = after[i + 1].union(&buckets[i + 1]);
    }
    let all = after[0].union(&buckets[0]).extent();
    let thin = f64::from(all.max_element()) / f64::from(all[axis]);
    let mut before = CostEstimate::NONE;
    let mut costs = ArrayVec::new();
    for last in 0..BUCKETS - 1 {
        before = before.union(&buckets[last]);
        if before.count > 0 && after[last].count > 0 {
            costs.push((last, thin * (before.cost() + after[last].cost())));
        }
    }
    costs
}
