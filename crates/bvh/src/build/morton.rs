//! Fast construction: items are sorted along a Morton curve (Lauterbach et al. 2009, "Fast BVH
//! Construction on GPUs") and clustered into leaves where the highest differing bit changes. The
//! tree above the clusters is built by binning, as in HLBVH (Pantaleoni and Luebke 2010), but down
//! to the leaves.

use super::binary::BinaryNode;
use super::binned::{self, Settings};
use super::item::{Item, Items, SimdBox};
use crate::pages::Pages;
use juggler_math::{BuildControl, Cancelled};
use rayon::prelude::*;
use std::convert::Infallible;
use wide::f32x4;

/// Number of keys from which several threads build clusters.
const TASK: usize = 1 << 13;

/// Builds the binary tree, empty without items, and the item indices in leaf order.
pub(super) fn build(
    mut items: Items,
    leaf_size: usize,
    control: &BuildControl,
) -> Result<(Pages<BinaryNode>, Vec<u32>), Cancelled> {
    let curve = Curve::new(items.extents.centers, items.list().len());
    let items = items.list();
    let mut keys = Pages::zeroed(items.len());
    keys.par_iter_mut().zip(&*items).enumerate().for_each(|(i, (key, item))| *key = curve.key(item, i));
    control.check()?;
    keys.par_sort_unstable();
    control.check()?;
    let item = |key: &u64| &items[curve.position(*key)];
    let clusters = clusters(&keys, 0, leaf_size);
    let bounds = |cluster: usize| {
        let (first, count) = clusters[cluster];
        let keys = &keys[first as usize..][..count as usize];
        Ok::<_, Infallible>(keys.iter().fold(SimdBox::EMPTY, |all, key| all.union(item(key).bounds())))
    };
    let Ok(boxes) = Items::new(clusters.len(), bounds);
    let (mut nodes, order) = binned::build(boxes, &Settings::of_clusters(control))?;
    // List the items of the clusters in the tree's leaf order.
    let mut starts = vec![0; order.len()];
    let mut numbers = Vec::with_capacity(items.len());
    for (start, &cluster) in starts.iter_mut().zip(&order) {
        let (first, count) = clusters[cluster as usize];
        *start = numbers.len() as u32;
        numbers.extend(keys[first as usize..][..count as usize].iter().map(|key| item(key).number()));
    }
    nodes.par_iter_mut().filter(|node| node.is_leaf()).for_each(|leaf| {
        let place = leaf.first as usize;
        (leaf.first, leaf.count) = (starts[place], clusters[order[place] as usize].1);
    });
    Ok((nodes, numbers))
}

/// Mapping from centers to sort keys: the Morton code in the upper bits, the item's position in the
/// lower bits.
struct Curve {
    low: f32x4,
    scale: f32x4,
    position_bits: u32,
}

impl Curve {
    /// Constructs the mapping with as many bits as the positions leave: 11 to 21 bits per axis.
    fn new(centers: SimdBox, items: usize) -> Self {
        let position_bits = usize::BITS - items.leading_zeros();
        let cells = 1u32 << ((64 - position_bits) / 3).min(21);
        let scale = (centers.high - centers.low).to_array().map(|side| (cells - 1) as f32 / side);
        let scale = scale.map(|s| if s.is_finite() { s } else { 0.0 });
        Self { low: centers.low, scale: f32x4::new(scale), position_bits }
    }

    fn key(&self, item: &Item, position: usize) -> u64 {
        let [x, y, z, _] = ((item.center() - self.low) * self.scale).fast_trunc_int().to_array();
        let code = spread(x) << 2 | spread(y) << 1 | spread(z);
        code << self.position_bits | position as u64
    }

    fn position(&self, key: u64) -> usize {
        (key & ((1 << self.position_bits) - 1)) as usize
    }
}

/// Inserts two zero bits above each of the lower 21 bits.
fn spread(value: i32) -> u64 {
    let value = u64::from(value as u32) & 0x1f_ffff;
    let value = (value | value << 32) & 0x001f_0000_0000_ffff;
    let value = (value | value << 16) & 0x001f_0000_ff00_00ff;
    let value = (value | value << 8) & 0x100f_00f0_0f00_f00f;
    let value = (value | value << 4) & 0x10c3_0c30_c30c_30c3;
    (value | value << 2) & 0x1249_2492_4924_9249
}

/// Clusters of at most `size` keys, as (first position, count). Longer ranges are split where the
/// highest differing bit changes; keys always differ, since they contain positions.
fn clusters(keys: &[u64], first: usize, size: usize) -> Vec<(u32, u32)> {
    if keys.len() <= TASK {
        let mut list = Vec::with_capacity(keys.len() / 4);
        add_clusters(keys, first, size, &mut list);
        return list;
    }
    let middle = jump(keys);
    let (left, right) = keys.split_at(middle);
    let (mut list, right) = rayon::join(|| clusters(left, first, size), || clusters(right, first + middle, size));
    list.extend(right);
    list
}

fn add_clusters(keys: &[u64], first: usize, size: usize, list: &mut Vec<(u32, u32)>) {
    if keys.len() > size {
        let middle = jump(keys);
        add_clusters(&keys[..middle], first, size, list);
        add_clusters(&keys[middle..], first + middle, size, list);
    } else if !keys.is_empty() {
        list.push((first as u32, keys.len() as u32));
    }
}

/// Position at which the highest bit that is not equal in all keys changes.
fn jump(keys: &[u64]) -> usize {
    let differing = keys[0] ^ keys[keys.len() - 1];
    let bit = 1u64 << (u64::BITS - 1 - differing.leading_zeros().min(u64::BITS - 1));
    keys.partition_point(|key| key & bit == 0)
}
