//! Partitioning of items into left and right side, with the bounds of both sides' centers.

use super::bins::SideTest;
use super::item::{Item, SimdBox};
use rayon::prelude::*;
use std::ops::Range;

/// Bounds of the centers of the left and the right side.
pub(super) type Centers = [SimdBox; 2];

const NOTHING: Centers = [SimdBox::EMPTY; 2];

/// Partitions in place, without a branch on the side, which would be unpredictable. Returns the size
/// of the left side and the bounds of the centers.
pub(super) fn in_place(items: &mut [Item], side_test: &SideTest) -> (usize, Centers) {
    let mut left = 0;
    for i in 0..items.len() {
        let item = items[i];
        let is_left = side_test.is_left(&item);
        items[i] = items[left];
        items[left] = item;
        left += usize::from(is_left);
    }
    (left, [centers(&items[..left]), centers(&items[left..])])
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

/// Partitions in place with several threads: chunks of `chunk` items are partitioned one by one, then
/// the items that lie on the wrong side of the whole set are swapped. Returns the size of the left
/// side and the bounds of the centers. The result depends on `chunk`, not on the number of threads.
pub(super) fn in_place_parallel(items: &mut [Item], chunk: usize, side_test: &SideTest) -> (usize, Centers) {
    let sides: Vec<(usize, Centers)> = items.par_chunks_mut(chunk).map(|items| in_place(items, side_test)).collect();
    let lefts: Vec<usize> = sides.iter().map(|(left, _)| *left).collect();
    exchange(items, chunk, &lefts);
    let join = |[a, b]: Centers, (_, [c, d]): &(usize, Centers)| [a.union(*c), b.union(*d)];
    (lefts.iter().sum(), sides.iter().fold(NOTHING, join))
}

/// Exchanges the right items of the chunks in the left part of the list with the left items of the
/// chunks behind it; there are as many of either. The first `lefts[i]` items of chunk `i` are left.
fn exchange(items: &mut [Item], chunk: usize, lefts: &[usize]) {
    let (count, left) = (items.len(), lefts.iter().sum::<usize>());
    let (front, back) = items.split_at_mut(left);
    let starts = (0..count).step_by(chunk);
    let right_ranges =
        starts.clone().zip(lefts).map(|(start, lefts)| start + lefts..count.min(start + chunk).min(left));
    let left_ranges = starts.zip(lefts).map(|(start, lefts)| start.max(left) - left..(start + lefts).max(left) - left);
    let mut left_items = take_ranges(back, left_ranges).into_iter();
    let (mut jobs, mut target): (Vec<_>, &mut [Item]) = (Vec::new(), &mut []);
    for mut source in take_ranges(front, right_ranges) {
        while !source.is_empty() {
            if target.is_empty() {
                let Some(next) = left_items.next() else { break };
                target = next;
            }
            let count = source.len().min(target.len());
            jobs.push((take_first(&mut source, count), take_first(&mut target, count)));
        }
    }
    jobs.into_par_iter().for_each(|(a, b)| a.swap_with_slice(b));
}

/// The slices of the ranges, which increase; empty ranges are left out.
fn take_ranges(mut items: &mut [Item], ranges: impl Iterator<Item = Range<usize>>) -> Vec<&mut [Item]> {
    let (mut slices, mut position) = (Vec::new(), 0);
    for range in ranges.filter(|range| !range.is_empty()) {
        take_first(&mut items, range.start - position);
        slices.push(take_first(&mut items, range.len()));
        position = range.end;
    }
    slices
}

/// Removes the first `count` items from a slice and returns them.
fn take_first<'a>(items: &mut &'a mut [Item], count: usize) -> &'a mut [Item] {
    items.split_off_mut(..count).unwrap_or_default()
}
