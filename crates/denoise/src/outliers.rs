//! Pixels that are far too bright in one half, of which neither their neighbours nor the other half know anything.
//!
//! A sample of a rare way of light (a firefly) carries the energy of the many pixels that got none; where it is alone,
//! no filter can put it back, and it would become a blotch as wide as the windows. It is cut to the brightest
//! of what is around it before filtering; afterwards its light goes to its neighborhood (`energy`).

use juggler_math::Rgb;
use rayon::prelude::*;

/// How many times as bright as everything around it a pixel must be.
const FACTOR: f32 = 2.0;

/// Both halves without their outliers.
pub(crate) fn cut(width: usize, halves: &[Vec<Rgb>; 2]) -> [Vec<Rgb>; 2] {
    let brightness = [0, 1].map(|half: usize| halves[half].par_iter().map(|c| c.r + c.g + c.b).collect::<Vec<_>>());
    [0, 1].map(|half: usize| {
        let (own, other) = (&brightness[half], &brightness[1 - half]);
        let pixel = |(i, colour): (usize, &Rgb)| {
            // Most pixels are no brighter than the other half or a neighbour says.
            let limit = other[i].max(0.0);
            if own[i] <= FACTOR * limit {
                return *colour;
            }
            let limit = around(width, own, other, i).max(limit);
            if own[i] > FACTOR * limit { *colour * (limit / own[i]) } else { *colour }
        };
        halves[half].par_iter().enumerate().map(pixel).collect()
    })
}

/// The brightest of the other half's 3 × 3 pixels and the second brightest of the own 5 × 5 without the pixel itself.
fn around(width: usize, own: &[f32], other: &[f32], i: usize) -> f32 {
    let height = own.len() / width;
    let (x, y) = (i % width, i / width);
    let (mut best, mut first, mut second) = (0.0_f32, 0.0_f32, 0.0_f32);
    for row in y.saturating_sub(2)..height.min(y + 3) {
        for column in x.saturating_sub(2)..width.min(x + 3) {
            let at = row * width + column;
            if row.abs_diff(y) <= 1 && column.abs_diff(x) <= 1 {
                best = best.max(other[at]);
            }
            if at != i {
                second = second.max(own[at].min(first));
                first = first.max(own[at]);
            }
        }
    }
    best.max(second)
}
