//! Prefilter of the features: non-local means over single pixels, with weights of each half for the
//! other. Noise in the features, at edges and out of focus, would otherwise pass into the picture.

#![expect(
    clippy::needless_range_loop,
    reason = "indices as in the formulas; iterators and closures lose the vector unit"
)]

use crate::grid::{Grid, LANES, MARGIN};
use crate::weights::load;
use crate::{Features, Noisy, SimdLevel, blur};
use fearless_simd::prelude::*;
use fearless_simd::{dispatch, f32x16};
use juggler_math::portable;
use rayon::prelude::*;

/// Number of features of a pixel: albedo (3), normal (3), logarithm of depth.
pub(crate) const FEATURES: usize = 7;
/// Radius of the filter window, in pixels.
const FILTER_RADIUS: isize = 5;
/// Squared difference that counts as none.
const TOLERANCE: f32 = 1e-4;

/// Features of a pixel.
pub(crate) type Feature = [f32; FEATURES];

/// Prefilters the features of all pixels; `None` if the input has none.
pub(crate) fn filtered(level: SimdLevel, noisy: &Noisy) -> Option<Vec<Feature>> {
    let Features { albedo, normal, depth } = noisy.features;
    if albedo.is_none() && normal.is_none() && depth.is_none() {
        return None;
    }
    let far = portable::ln(depth.map_or(1.0, farthest) * 2.0);
    let halves = [0, 1].map(|half| {
        let pixel = |i: usize| pixel_features(&noisy.features, half, i, far);
        (0..noisy.width * noisy.height).into_par_iter().map(pixel).collect::<Vec<_>>()
    });
    let grid = Grid::new(noisy.width, noisy.height);
    let noise = |(a, b): (&Feature, &Feature)| (0..FEATURES).map(|k| (a[k] - b[k]) * (a[k] - b[k])).sum::<f32>() * 0.5;
    let variance: Vec<f32> = halves[0].iter().zip(&halves[1]).map(noise).collect();
    let variance = blur::mean(noisy.width, &variance, 1);
    let planes: Vec<Vec<f32>> = (0..2 * FEATURES)
        .into_par_iter()
        .map(|plane| grid.pad(|i| halves[plane / FEATURES][i][plane % FEATURES]))
        .collect();
    let field = Field { stride: grid.stride, planes, variance: grid.pad(|i| variance[i]) };
    let mut means = vec![[0.0; FEATURES]; noisy.width * noisy.height];
    means.par_chunks_mut(noisy.width).enumerate().for_each(|(y, row)| {
        let start = (y + MARGIN) * grid.stride + MARGIN;
        dispatch!(level, simd => field.filter_row(simd, start, row));
    });
    Some(means)
}

/// Largest finite depth; 1 if there is none.
fn farthest(halves: [&[f32]; 2]) -> f32 {
    let known = halves.into_iter().flatten().copied().filter(|depth| depth.is_finite() && *depth > 0.0);
    let farthest = known.fold(0.0, f32::max).min(1e30);
    if farthest > 0.0 { farthest } else { 1.0 }
}

/// Features of pixel `i` in one half.
pub(crate) fn pixel_features(features: &Features, half: usize, i: usize, far: f32) -> Feature {
    let albedo = features.albedo.map_or([0.0; 3], |halves| halves[half][i].to_array());
    let normal = features.normal.map_or([0.0; 3], |halves| halves[half][i].to_array());
    let depth = features.depth.map_or(0.0, |halves| {
        let depth = halves[half][i];
        if depth.is_finite() && depth > 0.0 { portable::ln(depth.max(1e-30)) } else { far }
    });
    let features = [albedo[0], albedo[1], albedo[2], normal[0], normal[1], normal[2], depth];
    features.map(|number| if number.is_finite() { number.clamp(-100.0, 100.0) } else { 0.0 })
}

/// Padded feature planes of both halves, and the variance of one half, summed over the features.
struct Field {
    stride: usize,
    planes: Vec<Vec<f32>>,
    variance: Vec<f32>,
}

impl Field {
    #[inline(always)]
    fn filter_row<S: Simd>(&self, simd: S, start: usize, row: &mut [Feature]) {
        for (block, pixels) in row.chunks_mut(LANES).enumerate() {
            let at = start + block * LANES;
            let means = self.filter_block(simd, at);
            for k in 0..FEATURES {
                let mut mean = [0.0; LANES];
                means[k].store_slice(&mut mean);
                for (pixel, number) in pixels.iter_mut().zip(mean) {
                    pixel[k] = number;
                }
            }
        }
    }

    #[inline(always)]
    fn filter_block<S: Simd>(&self, simd: S, at: usize) -> [f32x16<S>; FEATURES] {
        let zero = f32x16::splat(simd, 0.0);
        let own = self.features(simd, at);
        let variance = load(simd, &self.variance, at);
        let (mut sums, mut weights) = (own, [zero + 1.0; 2]);
        if variance.simd_gt(zero).any_true() {
            (sums, weights) = ([zero; 2 * FEATURES], [zero; 2]);
            for y in -FILTER_RADIUS..=FILTER_RADIUS {
                for x in -FILTER_RADIUS..=FILTER_RADIUS {
                    let other = at.wrapping_add_signed(y * self.stride as isize + x);
                    let features = self.features(simd, other);
                    let there = load(simd, &self.variance, other);
                    let (noise, scale) = (variance + variance.min(there), variance + there + TOLERANCE);
                    for half in 0..2 {
                        let guide = (1 - half) * FEATURES;
                        let weight = exp_approximation(simd, (distance(simd, &own, &features, guide) - noise) / scale);
                        weights[half] += weight;
                        for k in half * FEATURES..(half + 1) * FEATURES {
                            sums[k] += weight * features[k];
                        }
                    }
                }
            }
        }
        let mut means = [zero; FEATURES];
        for k in 0..FEATURES {
            means[k] = (sums[k] / weights[0] + sums[k + FEATURES] / weights[1]) * 0.5;
        }
        means
    }

    /// Features of both halves, from pixel `at` on.
    #[inline(always)]
    fn features<S: Simd>(&self, simd: S, at: usize) -> [f32x16<S>; 2 * FEATURES] {
        let mut features = [f32x16::splat(simd, 0.0); 2 * FEATURES];
        for k in 0..2 * FEATURES {
            features[k] = load(simd, &self.planes[k], at);
        }
        features
    }
}

/// Squared distance of the features of one half, which start at index `guide`.
#[inline(always)]
fn distance<S: Simd>(simd: S, a: &[f32x16<S>; 2 * FEATURES], b: &[f32x16<S>; 2 * FEATURES], guide: usize) -> f32x16<S> {
    let mut sum = f32x16::splat(simd, 0.0);
    for k in guide..guide + FEATURES {
        let difference = a[k] - b[k];
        sum += difference * difference;
    }
    sum
}

/// Approximates e^-x for x ≥ 0 by (1 - x / 8)^8, which is 0 from 8 on; 1 for negative x.
#[inline(always)]
pub(crate) fn exp_approximation<S: Simd>(simd: S, x: f32x16<S>) -> f32x16<S> {
    let (zero, one) = (f32x16::splat(simd, 0.0), f32x16::splat(simd, 1.0));
    let base = (one - x * 0.125).max(zero).min(one);
    let square = base * base;
    let fourth = square * square;
    fourth * fourth
}
