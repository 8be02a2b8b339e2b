//! Blending of input and filtered picture, with the weight that minimizes the estimated error.
//!
//! With F₁, F₂ the filtered halves and I₁, I₂ those of the input, the expectation of (F₁ - I₂)(F₂ -
//! I₁) is the square of the filter's bias, since all noise in it is independent, and that of (I₁ -
//! I₂)² / 4 is the variance of the input's mean. Both estimates are noisy and therefore averaged
//! over a neighborhood, in which the influence of a single pixel is limited.

use crate::blur;
use crate::prepare::Prepared;
use crate::regression::SUMS;
use crate::tile::Sums;
use juggler_math::Rgb;
use rayon::prelude::*;

/// Weight of the pixel's own color relative to the windows' estimates.
const OWN_WEIGHT: f32 = 0.1;
/// Radius of the error average, in pixels.
const ERROR_RADIUS: usize = 4;
/// Bias, in variances of the input, that is attributed to noise of the estimate. The standard
/// deviation of the estimate is 0.22 for Gaussian noise and larger for fireflies; with 0.25,
/// patches of noise remained on plain walls.
const BIAS_THRESHOLD: f32 = 0.5;
/// Maximum bias of a single pixel in the average, in variances of the input.
const MAX_BIAS: f32 = 4.0;
/// Bias of a single pixel, in variances of the input, from which the pixel is blended by its own
/// estimate.
const SINGLE_PIXEL_BIAS: f32 = 100.0;

/// Blends both halves to the denoised picture.
pub(crate) fn blend(prepared: &Prepared, filtered: &[Sums; 2]) -> Vec<Rgb> {
    let halves = [0, 1].map(|half: usize| {
        let pixel = |(i, sums): (usize, &[f32; SUMS])| mix_own(prepared, half, i, sums);
        filtered[half].par_iter().enumerate().map(pixel).collect::<Vec<Rgb>>()
    });
    let pairs: Vec<[f32; 2]> =
        (0..halves[0].len()).into_par_iter().map(|i| errors(prepared, [halves[0][i], halves[1][i]], i)).collect();
    let width = prepared.grid.width;
    let noise: Vec<f32> = pairs.iter().map(|pair| pair[1]).collect();
    let noise = blur::mean(width, &noise, ERROR_RADIUS);
    let bias: Vec<f32> = pairs.iter().zip(&noise).map(|(pair, v)| pair[0].clamp(-MAX_BIAS * v, MAX_BIAS * v)).collect();
    let bias = blur::mean(width, &bias, ERROR_RADIUS);
    let pixel = |i: usize| {
        let filter = (halves[0][i] + halves[1][i]) * 0.5;
        let input = (prepared.halves[0][i] + prepared.halves[1][i]) * 0.5;
        let known = prepared.known[0][i] || prepared.known[1][i];
        let excess = (bias[i] - BIAS_THRESHOLD * noise[i]).max(pairs[i][0] - SINGLE_PIXEL_BIAS * noise[i]);
        let input_weight = if known && excess > 0.0 { excess / (excess + noise[i]) } else { 0.0 };
        let mixed = filter.lerp(input, input_weight);
        let mixed = Rgb::new(
            clamp_negative(mixed.r, input.r),
            clamp_negative(mixed.g, input.g),
            clamp_negative(mixed.b, input.b),
        );
        mixed * prepared.divisor[i]
    };
    (0..halves[0].len()).into_par_iter().map(pixel).collect()
}

/// Clamps a channel to at least 0, since slopes may lead below, unless the input was negative.
fn clamp_negative(mixed: f32, input: f32) -> f32 {
    mixed.max(input.min(0.0))
}

/// Filtered value of a half, with the own color mixed in. A pixel that no window covers keeps its
/// color.
fn mix_own(prepared: &Prepared, half: usize, i: usize, sums: &[f32; SUMS]) -> Rgb {
    let [r, g, b, weight] = *sums;
    let own = if prepared.known[half][i] || weight <= 0.0 { OWN_WEIGHT } else { 0.0 };
    (Rgb::new(r, g, b) + prepared.halves[half][i] * own) / (weight + own)
}

/// Squared bias of the filter and variance of the input, both relative to the squared energy of the
/// pixel.
fn errors(prepared: &Prepared, filtered: [Rgb; 2], i: usize) -> [f32; 2] {
    let input = [prepared.halves[0][i], prepared.halves[1][i]];
    let (product, difference) = ((filtered[0] - input[1]) * (filtered[1] - input[0]), input[0] - input[1]);
    let square = difference * difference * 0.25;
    let brightness = filtered[0] + filtered[1];
    let brightness = (brightness.r + brightness.g + brightness.b) * 0.5 + prepared.scale * 0.1 + 1e-20;
    let sum = |c: Rgb| (c.r + c.g + c.b) / (brightness * brightness);
    [sum(product), sum(square)]
}
