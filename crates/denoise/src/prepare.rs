//! Preparation of the input: replacement of unknown pixels, division by the albedo, padded planes.

use crate::features::{self, FEATURES, Feature};
use crate::grid::Grid;
use crate::{Noisy, Settings, SimdLevel, blur, outliers};
use juggler_math::Rgb;
use rayon::prelude::*;
use std::ops::Range;

/// Lower bound of the divisor.
const MIN_DIVISOR: f32 = 0.05;
/// Channels from this value on count as unknown, because their squares would overflow.
const MAX_KNOWN: f32 = 1e15;
/// Radius of the variance average, in pixels.
const VARIANCE_RADIUS: usize = 2;
/// Radius of the typical variance, in pixels.
const TYPICAL_RADIUS: usize = 3;

/// Factor over the typical variance of its surroundings beyond which a pixel counts less in
/// windows: rare bright samples would outweigh all others.
const TRUST_FACTOR: f32 = 50.0;

/// Input of the windows. Planes are padded; those in phases are sorted by [`Grid::phases`].
pub(crate) struct Prepared {
    pub grid: Grid,
    /// Divisor of each pixel: the albedo, see `divisors`.
    pub divisor: Vec<Rgb>,
    /// Colors of both halves, divided and without outliers.
    pub halves: [Vec<Rgb>; 2],
    /// Whether each pixel of the input is finite.
    pub known: [Vec<bool>; 2],
    /// Channels of `halves`, padded.
    pub guides: [[Vec<f32>; 3]; 2],
    /// Variance of one half, summed over the channels and averaged over neighbors; padded.
    pub variance: Vec<f32>,
    /// Variance of one half by the pixel's own difference alone; padded, in phases.
    pub pixel_variance: Vec<f32>,
    /// Value of `pixel_variance` beyond which a pixel counts less in the window around this one;
    /// padded, in phases.
    pub typical_variance: Vec<f32>,
    /// Channels of `halves`, padded, in phases.
    pub colors: [[Vec<f32>; 3]; 2],
    /// 1 where a pixel is known, 0 elsewhere and in the margin; in phases.
    pub masks: [Vec<f32>; 2],
    /// Feature planes, padded, in phases; empty without features.
    pub features: Vec<Vec<f32>>,
    /// Mean over pixels of the sum of channels of `halves`.
    pub scale: f32,
    /// Energy of the input before and after outliers were clamped, summed over channels and pixels.
    pub energy: [f64; 2],
}

impl Prepared {
    /// Prepares a picture. `own` is the range of pixels whose energy is counted.
    pub fn new(level: SimdLevel, noisy: &Noisy, settings: &Settings, own: Range<usize>) -> Self {
        let grid = Grid::new(noisy.width, noisy.height);
        let features = features::filtered(level, noisy);
        let divisor = divisors(noisy, features.as_deref());
        let known = noisy.halves.map(|half| half.iter().map(is_known).collect::<Vec<bool>>());
        let divided = filled(noisy, &known).map(|half| {
            half.into_par_iter().zip(&divisor).map(|(c, m)| Rgb::new(c.r / m.r, c.g / m.g, c.b / m.b)).collect()
        });
        let before = energy(&divided, &divisor, own.clone());
        let halves = if settings.cut_outliers { outliers::clamp(noisy.width, &divided) } else { divided };
        let energy = [before, energy(&halves, &divisor, own)];
        let scale = scale(&halves);
        let pixel_variance = variance(&halves);
        let typical_variance = typical_variance(noisy.width, &pixel_variance);
        let variance = blur::mean(noisy.width, &pixel_variance, VARIANCE_RADIUS);
        // Lower bound, so that all pixels count alike where there is no noise.
        let least = (scale * scale * 1e-7).max(1e-30);
        let guides = [0, 1].map(|half: usize| channels(&grid, &halves[half]));
        let planes = features.map_or(Vec::new(), |features| {
            let plane = |k: usize| grid.phases(&grid.pad(|i| features[i][k]));
            (0..FEATURES).into_par_iter().map(plane).collect()
        });
        Self {
            colors: [0, 1].map(|half: usize| [0, 1, 2].map(|k: usize| grid.phases(&guides[half][k]))),
            masks: [0, 1].map(|half: usize| grid.phases(&grid.pad_zero(|i| f32::from(u8::from(known[half][i]))))),
            variance: grid.pad(|i| variance[i]),
            pixel_variance: grid.phases(&grid.pad(|i| pixel_variance[i] + least)),
            typical_variance: grid.phases(&grid.pad(|i| typical_variance[i] * TRUST_FACTOR + least)),
            features: planes,
            scale,
            grid,
            divisor,
            halves,
            known,
            guides,
            energy,
        }
    }
}

/// Whether a color is finite and its square does not overflow.
pub(crate) fn is_known(color: &Rgb) -> bool {
    color.is_finite() && color.map(f32::abs).max_channel() < MAX_KNOWN
}

/// Brightness of a color: the sum of its channels.
pub(crate) fn brightness(color: Rgb) -> f32 {
    color.r + color.g + color.b
}

/// Padded planes of the color channels.
fn channels(grid: &Grid, colors: &[Rgb]) -> [Vec<f32>; 3] {
    [grid.pad(|i| colors[i].r), grid.pad(|i| colors[i].g), grid.pad(|i| colors[i].b)]
}

/// Divisor of each pixel: the albedo, plus the fraction of the pixel without a surface. The
/// quotient, irradiance, is continuous from the surface to the sky behind it.
fn divisors(noisy: &Noisy, features: Option<&[Feature]>) -> Vec<Rgb> {
    let Some(features) = features.filter(|_| noisy.features.albedo.is_some()) else {
        return vec![Rgb::WHITE; noisy.width * noisy.height];
    };
    let has_normals = noisy.features.normal.is_some();
    let pixel = |feature: &Feature| {
        let [r, g, b, x, y, z, _] = *feature;
        let uncovered = if has_normals {
            (1.0 - (x * x + y * y + z * z).sqrt()).max(0.0)
        } else {
            f32::from(u8::from(r.max(g).max(b) <= 0.0))
        };
        Rgb::new(r, g, b).map(|albedo| (albedo + uncovered).max(MIN_DIVISOR))
    };
    features.par_iter().map(pixel).collect()
}

/// Halves in which unknown pixels are replaced by those of the other half, or by the mean of known
/// neighbors.
fn filled(noisy: &Noisy, known: &[Vec<bool>; 2]) -> [Vec<Rgb>; 2] {
    [0, 1].map(|half: usize| {
        let pixel = |i: usize| match (known[half][i], known[1 - half][i]) {
            (true, _) => noisy.halves[half][i],
            (_, true) => noisy.halves[1 - half][i],
            _ => mean_of_neighbors(noisy, known, i),
        };
        (0..known[half].len()).into_par_iter().map(pixel).collect()
    })
}

/// Mean of the known pixels of both halves in the 7 × 7 window around pixel `i`; black if there are
/// none.
fn mean_of_neighbors(noisy: &Noisy, known: &[Vec<bool>; 2], i: usize) -> Rgb {
    let (x, y) = (i % noisy.width, i / noisy.width);
    let (mut sum, mut count) = (Rgb::BLACK, 0.0);
    for row in y.saturating_sub(3)..noisy.height.min(y + 4) {
        for column in x.saturating_sub(3)..noisy.width.min(x + 4) {
            let at = row * noisy.width + column;
            for (half, known) in noisy.halves.iter().zip(known) {
                if known[at] {
                    sum += half[at];
                    count += 1.0;
                }
            }
        }
    }
    if count > 0.0 { sum / count } else { Rgb::BLACK }
}

/// Energy of a range of pixels, summed over channels, after multiplication by the albedo.
fn energy(halves: &[Vec<Rgb>; 2], divisor: &[Rgb], own: Range<usize>) -> f64 {
    let pixel = |(c, m): (&Rgb, &Rgb)| sum(*c * *m);
    halves.iter().map(|half| half[own.clone()].iter().zip(&divisor[own.clone()]).map(pixel).sum::<f64>()).sum()
}

/// Mean over pixels of the sum of channels.
fn scale(halves: &[Vec<Rgb>; 2]) -> f32 {
    let total: f64 = halves.iter().flatten().map(|color| sum(*color)).sum();
    (total / (2 * halves[0].len()) as f64) as f32
}

fn sum(color: Rgb) -> f64 {
    f64::from(color.r) + f64::from(color.g) + f64::from(color.b)
}

/// Variance of one half's pixels, estimated from the difference of both and summed over the
/// channels.
fn variance(halves: &[Vec<Rgb>; 2]) -> Vec<f32> {
    let pixel = |(a, b): (&Rgb, &Rgb)| {
        let difference = *a - *b;
        let square = difference * difference;
        (square.r + square.g + square.b) * 0.5
    };
    halves[0].par_iter().zip(&halves[1]).map(pixel).collect()
}

/// Typical value around each pixel: the mean of fourth roots, on which a few large values have
/// little influence.
fn typical_variance(width: usize, numbers: &[f32]) -> Vec<f32> {
    let roots: Vec<f32> = numbers.par_iter().map(|number| number.sqrt().sqrt()).collect();
    let means = blur::mean(width, &roots, TYPICAL_RADIUS);
    means.into_par_iter().map(|mean| (mean * mean) * (mean * mean)).collect()
}
