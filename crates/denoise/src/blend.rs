//! How much of the input stays: as much as makes the error least, by what both filtered and both unfiltered halves say of it.
//!
//! With F₁, F₂ the filtered halves and I₁, I₂ the input's, (F₁ - I₂)(F₂ - I₁) is the square of the filter's bias in the mean, since all
//! noise in it is independent, and (I₁ - I₂)² / 4 the variance of the input's mean. Both are noisy and therefore
//! averaged over a neighbourhood, where no single pixel counts for more than some others together.

use crate::blur;
use crate::prepare::Prepared;
use crate::regression::SUMS;
use crate::tile::Sums;
use juggler_math::Rgb;
use rayon::prelude::*;

/// The weight of a pixel's own colour beside what the windows say of it.
const OWN: f32 = 0.1;
/// Pixels to each side that errors are the mean of.
const ERROR_REACH: usize = 4;
/// Bias, in parts of the input's variance, that passes for noise of the estimate. The standard deviation of the estimate is 0.22
/// for Gaussian noise and larger for fireflies; with 0.25 patches of noise stood on plain walls.
const DOUBT: f32 = 0.5;
/// Bias, in parts of the input's variance, that a single pixel counts for at most among its neighbours.
const MOST: f32 = 4.0;
/// Bias likewise from which on a pixel is mixed by its own.
const ALONE: f32 = 100.0;

/// The picture.
pub(crate) fn blend(prepared: &Prepared, filtered: &[Sums; 2]) -> Vec<Rgb> {
    let halves = [0, 1].map(|half: usize| {
        let pixel = |(i, sums): (usize, &[f32; SUMS])| own_mixed_in(prepared, half, i, sums);
        filtered[half].par_iter().enumerate().map(pixel).collect::<Vec<Rgb>>()
    });
    let pairs: Vec<[f32; 2]> =
        (0..halves[0].len()).into_par_iter().map(|i| errors(prepared, [halves[0][i], halves[1][i]], i)).collect();
    let width = prepared.grid.width;
    let noise: Vec<f32> = pairs.iter().map(|pair| pair[1]).collect();
    let noise = blur::mean(width, &noise, ERROR_REACH);
    let usual: Vec<f32> = pairs.iter().zip(&noise).map(|(pair, v)| pair[0].clamp(-MOST * v, MOST * v)).collect();
    let usual = blur::mean(width, &usual, ERROR_REACH);
    let pixel = |i: usize| {
        let filter = (halves[0][i] + halves[1][i]) * 0.5;
        let input = (prepared.halves[0][i] + prepared.halves[1][i]) * 0.5;
        let known = prepared.known[0][i] || prepared.known[1][i];
        let excess = (usual[i] - DOUBT * noise[i]).max(pairs[i][0] - ALONE * noise[i]);
        let share = if known && excess > 0.0 { excess / (excess + noise[i]) } else { 0.0 };
        let mixed = filter.lerp(input, share);
        let mixed = Rgb::new(above(mixed.r, input.r), above(mixed.g, input.g), above(mixed.b, input.b));
        mixed * prepared.modulation[i]
    };
    (0..halves[0].len()).into_par_iter().map(pixel).collect()
}

/// Slopes may lead below zero; light is not less than nothing, unless the input was.
fn above(mixed: f32, input: f32) -> f32 {
    mixed.max(input.min(0.0))
}

/// A half's filtered pixel; where no window knows anything alike, it keeps its colour.
fn own_mixed_in(prepared: &Prepared, half: usize, i: usize, sums: &[f32; SUMS]) -> Rgb {
    let [r, g, b, weight] = *sums;
    let own = if prepared.known[half][i] || weight <= 0.0 { OWN } else { 0.0 };
    (Rgb::new(r, g, b) + prepared.halves[half][i] * own) / (weight + own)
}

/// The square of the filter's bias and the input's variance, both relative to the pixel's light.
fn errors(prepared: &Prepared, filtered: [Rgb; 2], i: usize) -> [f32; 2] {
    let input = [prepared.halves[0][i], prepared.halves[1][i]];
    let (product, difference) = ((filtered[0] - input[1]) * (filtered[1] - input[0]), input[0] - input[1]);
    let square = difference * difference * 0.25;
    let light = filtered[0] + filtered[1];
    let light = (light.r + light.g + light.b) * 0.5 + prepared.scale * 0.1 + 1e-20;
    let sum = |c: Rgb| (c.r + c.g + c.b) / (light * light);
    [sum(product), sum(square)]
}
