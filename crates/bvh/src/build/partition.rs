//! Partitioning of items into left and right side, with the bounds of both sides' centers.

use super::bins::SideTest;
use super::item::{Item, SimdBox};
use rayon::prelude::*;
use std::mem::take;

/// Bounds of the centers of the left and the right side.
pub(super) type Centers = [SimdBox; 2];

const NOTHING: Centers = [SimdBox::EMPTY; 2];

/// Partitions in place, without a branch on the side, which would be unpredictable.
pub(super) fn in_place(items: &mut [Item], side_test: &SideTest) -> Centers {
    let mut left = 0;
    for i in 0..items.len() {
        let item = items[i];
        let is_left = side_test.is_left(&item);
        items[i] = items[left];
        items[left] = item;
        left += usize::from(is_left);
    }
    [centers(&items[..left]), centers(&items[left..])]
}

/// Bounds of the centers. Two accumulators shorten the dependency chain.
fn centers(items: &[Item]) -> SimdBox {
    let (pairs, rest) = items.as_chunks();
    let mut all = [SimdBox::EMPTY; 2];
    for [a, b] in pairs {
        all = [all[0].with(a.center()), all[1].with(b.center())];
    }
    rest.iter().fold(all[0].union(all[1]), |all, item| all.with(item.center()))
}

/// Partitions into `target` of the same length, in parallel chunks of `chunk` items. `lefts` gives
/// the number of left items of each chunk. Stable.
pub(super) fn into(
    items: &[Item],
    target: &mut [Item],
    chunk: usize,
    lefts: &[usize],
    side_test: &SideTest,
) -> Centers {
    let (mut left, mut right) = target.split_at_mut(lefts.iter().sum());
    let mut jobs = Vec::with_capacity(lefts.len());
    for (items, &count) in items.chunks(chunk).zip(lefts) {
        let (to_left, rest) = take(&mut left).split_at_mut(count);
        left = rest;
        let (to_right, rest) = take(&mut right).split_at_mut(items.len() - count);
        right = rest;
        jobs.push((items, [to_left, to_right]));
    }
    let join = |[a, b]: Centers, [c, d]: Centers| [a.union(c), b.union(d)];
    jobs.into_par_iter().map(|(items, mut targets)| scatter(items, &mut targets, side_test)).reduce(|| NOTHING, join)
}

fn scatter(items: &[Item], targets: &mut [&mut [Item]; 2], side_test: &SideTest) -> Centers {
    let mut counts = [0; 2];
    for item in items {
        let side = usize::from(!side_test.is_left(item));
        if let Some(place) = targets[side].get_mut(counts[side]) {
            *place = *item;
        }
        counts[side] += 1;
    }
    // Reread the centers while the items are in the cache.
    [centers(targets[0]), centers(targets[1])]
}
