//! Bringing the items of the left side before those of the right, with the boxes of both sides' centers.

use super::bins::Rule;
use super::item::{Extent, Item};
use rayon::prelude::*;
use std::mem::take;

/// Boxes of the centers left and right.
pub(super) type Centers = [Extent; 2];

const NOTHING: Centers = [Extent::EMPTY; 2];

/// In place. Without a branch on the side, which could not be foreseen.
pub(super) fn in_place(items: &mut [Item], rule: &Rule) -> Centers {
    let mut left = 0;
    for i in 0..items.len() {
        let item = items[i];
        let is_left = rule.is_left(&item);
        items[i] = items[left];
        items[left] = item;
        left += usize::from(is_left);
    }
    [centers(&items[..left]), centers(&items[left..])]
}

/// The box of the centers. Even and odd items in turns, whose minima need not wait for each other.
fn centers(items: &[Item]) -> Extent {
    let (pairs, rest) = items.as_chunks();
    let mut all = [Extent::EMPTY; 2];
    for [a, b] in pairs {
        all = [all[0].with(a.center()), all[1].with(b.center())];
    }
    rest.iter().fold(all[0].union(all[1]), |all, item| all.with(item.center()))
}

/// Into another place of the same length, chunk by chunk in parallel; `lefts` says how many items of each
/// chunk of `chunk` items go left. The items keep their order.
pub(super) fn into(items: &[Item], target: &mut [Item], chunk: usize, lefts: &[usize], rule: &Rule) -> Centers {
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
    jobs.into_par_iter().map(|(items, mut targets)| scatter(items, &mut targets, rule)).reduce(|| NOTHING, join)
}

fn scatter(items: &[Item], targets: &mut [&mut [Item]; 2], rule: &Rule) -> Centers {
    let mut counts = [0; 2];
    for item in items {
        let side = usize::from(!rule.is_left(item));
        if let Some(place) = targets[side].get_mut(counts[side]) {
            *place = *item;
        }
        counts[side] += 1;
    }
    // The centers are read again: the items lie in the cache now.
    [centers(targets[0]), centers(targets[1])]
}
