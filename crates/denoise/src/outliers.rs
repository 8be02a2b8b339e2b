//! Clamping of outliers: pixels far brighter in one half than their neighbors and the other half
//! confirm.
//!
//! A sample of an improbable path (a firefly) carries the energy of the many pixels that missed it.
//! Where it is isolated, no filter can distribute it, and it would become a blotch as wide as the
//! windows. It is clamped to the brightest of its surroundings before filtering; afterwards its
//! energy goes to its neighborhood (`energy`).

use crate::prepare::brightness;
use juggler_math::Rgb;
use rayon::prelude::*;

/// Factor over its surroundings from which a pixel is an outlier.
const FACTOR: f32 = 2.0;

/// Clamps the outliers of both halves.
pub(crate) fn clamp(width: usize, halves: &[Vec<Rgb>; 2]) -> [Vec<Rgb>; 2] {
    let bright = [0, 1].map(|half: usize| halves[half].par_iter().map(|color| brightness(*color)).collect::<Vec<_>>());
    [0, 1].map(|half: usize| {
        let (own, other) = (&bright[half], &bright[1 - half]);
        let pixel = |(i, color): (usize, &Rgb)| {
            // Skip the search in the common case: the pixel is no brighter than the other half
            // allows.
            let limit = other[i].max(0.0);
            if own[i] <= FACTOR * limit {
                return *color;
            }
            let limit = surrounding_brightness(width, own, other, i).max(limit);
            if own[i] > FACTOR * limit { *color * (limit / own[i]) } else { *color }
        };
        halves[half].par_iter().enumerate().map(pixel).collect()
    })
}

/// Maximum of the other half's 3 × 3 window and of the second brightest pixel of the own 5 × 5
/// window, without the pixel itself.
fn surrounding_brightness(width: usize, own: &[f32], other: &[f32], i: usize) -> f32 {
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
