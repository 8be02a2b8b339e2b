//! Building the tree from the root: a node's lights are divided in two, where that hides least, until there are as
//! many parts as it has slots.

use super::node::{Child, Node, WIDTH};
use super::summary::{Item, Summary, Tally};
use super::{LightBounds, LightTree};
use arrayvec::ArrayVec;
use juggler_bvh::SimdLevel;
use juggler_math::{Aabb, Vec3};
use std::ops::Range;

/// From this level parts are divided in the middle, so that all lights that there can be fit below it: a trail has 21.
const BALANCED_LEVEL: u32 = 10;
const LEVELS: u32 = 21;
/// Places of a cut along each axis, and one more.
const BUCKETS: usize = 12;
/// The weakest light counts as this share of the strongest one, so that no product vanishes.
const LEAST_POWER: f32 = 1e-10;

/// A node whose slots are to be filled.
struct Task {
    node: usize,
    range: Range<usize>,
    level: u32,
    trail: u64,
}

pub(super) fn build(lights: &[LightBounds]) -> LightTree {
    let (mut items, scale) = items(lights);
    let mut tree =
        LightTree { nodes: Vec::new(), trails: vec![LightTree::DARK; lights.len()], scale, level: SimdLevel::new() };
    if items.is_empty() {
        return tree;
    }
    tree.nodes.push(Node::empty());
    let mut tasks = vec![Task { node: 0, range: 0..items.len(), level: 0, trail: 0 }];
    while let Some(task) = tasks.pop() {
        for (slot, part) in divide(&mut items, &task).into_iter().enumerate() {
            let trail = task.trail | (slot as u64) << (3 * task.level);
            let child = match &items[part.clone()] {
                [single] => {
                    tree.trails[single.index as usize] = trail;
                    Child::Light(single.index)
                }
                _ => Child::Node(tree.nodes.len()),
            };
            tree.nodes[task.node].set(slot, &Summary::of(&items[part.clone()]), child);
            if let Child::Node(node) = child {
                tree.nodes.push(Node::empty());
                tasks.push(Task { node, range: part, level: task.level + 1, trail });
            }
        }
    }
    tree
}

/// The lights that shine, in coordinates below 1 and powers up to 1, and what the coordinates were multiplied by.
fn items(lights: &[LightBounds]) -> (Vec<Item>, f32) {
    let shines = |light: &LightBounds| {
        light.power > 0.0
            && light.power < f32::INFINITY
            && light.bounds.is_finite()
            && !light.bounds.is_empty()
            && (light.axis * 0.0 + light.cos_theta_o * light.cos_theta_e * 0.0).is_finite()
    };
    let shining = || (0u32..).zip(lights).filter(|(_, light)| shines(light));
    let largest = |bounds: &Aabb| bounds.min.abs().max(bounds.max.abs()).max_element();
    let scale = power_of_two_below(shining().fold(0.0, |most, (_, light)| largest(&light.bounds).max(most)));
    let strongest = shining().fold(0.0, |most: f32, (_, light)| most.max(light.power));
    let item = |(index, light): (u32, &LightBounds)| {
        let bounds = Aabb { min: light.bounds.min * scale, max: light.bounds.max * scale };
        let power = (light.power / strongest).max(LEAST_POWER);
        Item { index, center: bounds.center(), light: LightBounds { bounds, power, ..*light } }
    };
    (shining().map(item).collect(), scale)
}

/// A power of two whose product with `largest` is between 1/2 and 1, up to 4 at the end of the numbers; 1 for 0. Products with it are exact.
fn power_of_two_below(largest: f32) -> f32 {
    let exponent = (largest.to_bits() >> 23) as i32;
    // Biased by 127; those of the scale must stay within those of normal numbers.
    if largest == 0.0 { 1.0 } else { f32::from_bits(((253 - exponent).clamp(1, 253) as u32) << 23) }
}

/// Cuts the lights of a node into as many parts as there are slots, or single lights.
fn divide(items: &mut [Item], task: &Task) -> ArrayVec<Range<usize>, WIDTH> {
    let mut parts = ArrayVec::new();
    if task.range.len() <= WIDTH || task.level + 1 >= LEVELS {
        parts.extend(task.range.clone().map(|i| i..i + 1).take(WIDTH));
        return parts;
    }
    let balanced = task.level >= BALANCED_LEVEL;
    let worth = |items: &[Item], range: &Range<usize>| match range.len() {
        1 => -1.0,
        count if balanced => count as f64,
        _ => tally(&items[range.clone()]).cost(),
    };
    let mut worths: ArrayVec<f64, WIDTH> = ArrayVec::new();
    worths.push(worth(items, &task.range));
    parts.push(task.range.clone());
    while parts.len() < WIDTH {
        let most = (0..parts.len()).fold(0, |most, i| if worths[i] > worths[most] { i } else { most });
        let range = parts[most].clone();
        if range.len() < 2 {
            break;
        }
        let middle = range.start + if balanced { range.len() / 2 } else { split(&mut items[range.clone()]) };
        (parts[most], worths[most]) = (range.start..middle, worth(items, &(range.start..middle)));
        parts.push(middle..range.end);
        worths.push(worth(items, &(middle..range.end)));
    }
    parts
}

fn tally(items: &[Item]) -> Tally {
    let side = items.first().map_or(Vec3::Z, |item| item.light.axis);
    items.iter().fold(Tally::NONE, |sum, item| sum.with(&item.light, side))
}

/// Orders two or more lights so that those before the returned number, neither 0 nor all, are one part.
fn split(items: &mut [Item]) -> usize {
    let centers = Aabb::from_points(items.iter().map(|item| item.center));
    let Some((axis, last)) = best_cut(items, &centers) else { return items.len() / 2 };
    let mut count = 0;
    for i in 0..items.len() {
        if bucket(&items[i], &centers, axis) <= last {
            items.swap(i, count);
            count += 1;
        }
    }
    if count == 0 || count == items.len() { items.len() / 2 } else { count }
}

fn bucket(item: &Item, centers: &Aabb, axis: usize) -> usize {
    let (low, high) = (centers.min[axis], centers.max[axis]);
    let share = (item.center[axis] - low) / (high - low);
    ((share * BUCKETS as f32) as usize).min(BUCKETS - 1)
}

/// The axis and the last bucket of the first part where the cost is least; `None` when all lights are in one place.
fn best_cut(items: &[Item], centers: &Aabb) -> Option<(usize, usize)> {
    let side = items.first()?.light.axis;
    let mut buckets = [[Tally::NONE; BUCKETS]; 3];
    let axes: ArrayVec<usize, 3> = (0..3).filter(|axis| centers.extent()[*axis] > 0.0).collect();
    for item in items {
        for &axis in &axes {
            let tally = &mut buckets[axis][bucket(item, centers, axis)];
            *tally = tally.with(&item.light, side);
        }
    }
    let mut best = (f64::INFINITY, None);
    for axis in axes {
        for (last, cost) in cut_costs(&buckets[axis], axis) {
            if cost < best.0 {
                best = (cost, Some((axis, last)));
            }
        }
    }
    best.1
}

/// What each cut between buckets would cost that leaves lights on both sides. Thin parts cost more, so that parts
/// become round (the regularisation of Conty Estevez and Kulla).
fn cut_costs(buckets: &[Tally; BUCKETS], axis: usize) -> ArrayVec<(usize, f64), BUCKETS> {
    let mut after = [Tally::NONE; BUCKETS];
    for i in (0..BUCKETS - 1).rev() {
        after[i] = after[i + 1].joined(&buckets[i + 1]);
    }
    let all = after[0].joined(&buckets[0]).extent();
    let thin = f64::from(all.max_element()) / f64::from(all[axis]);
    let mut before = Tally::NONE;
    let mut costs = ArrayVec::new();
    for last in 0..BUCKETS - 1 {
        before = before.joined(&buckets[last]);
        if before.count > 0 && after[last].count > 0 {
            costs.push((last, thin * (before.cost() + after[last].cost())));
        }
    }
    costs
}
