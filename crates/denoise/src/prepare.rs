//! From what the caller has to what the filter reads: numbers that are numbers, light without the surface's colour, planes.

use crate::features::{self, FEATURES, Feature};
use crate::grid::Grid;
use crate::{Noisy, Settings, SimdLevel, blur, outliers};
use juggler_math::Rgb;
use rayon::prelude::*;
use std::ops::Range;

/// The smallest number that colours are divided by.
const DARKEST: f32 = 0.05;
/// Channels from here on count as unknown like infinite ones: their squares would be.
const BRIGHTEST: f32 = 1e15;
/// Pixels to each side that variances are the mean of.
const VARIANCE_REACH: usize = 2;
/// Pixels to each side that say what variance is usual.
const USUAL_REACH: usize = 3;

/// How many times as much as usual around it, in squares, a pixel's halves may differ until it counts less in windows:
/// rare bright samples would outweigh all others.
const TRUST: f32 = 50.0;

/// Everything that the windows read. Planes have margins; those in phases are sorted by [`Grid::phases`].
pub(crate) struct Prepared {
    pub grid: Grid,
    /// What the light was divided by, each pixel.
    pub modulation: Vec<Rgb>,
    /// Both halves' light, divided, without outliers, each pixel.
    pub halves: [Vec<Rgb>; 2],
    /// Whether the caller's pixel was a colour.
    pub known: [Vec<bool>; 2],
    /// The light's channels.
    pub guides: [[Vec<f32>; 3]; 2],
    /// Variance of one half's light, summed over the channels, smoothed.
    pub variance: Vec<f32>,
    /// Variance of one half's light by the pixel's own difference alone, in phases.
    pub single: Vec<f32>,
    /// From which such variance on a pixel counts less in windows around this one, in phases.
    pub usual: Vec<f32>,
    /// The light's channels, in phases.
    pub colours: [[Vec<f32>; 3]; 2],
    /// 1 where a pixel is known, 0 elsewhere and in the margin, in phases.
    pub masks: [Vec<f32>; 2],
    /// The features in phases, or none.
    pub features: Vec<Vec<f32>>,
    /// Mean light of a pixel, divided; the sum of its channels.
    pub scale: f32,
    /// The caller's pixels' light before and after outliers were cut, the sum of all channels.
    pub light: [f64; 2],
}

impl Prepared {
    /// `own`: the pixels whose light is counted.
    pub fn new(level: SimdLevel, noisy: &Noisy, settings: &Settings, own: Range<usize>) -> Self {
        let grid = Grid::new(noisy.width, noisy.height);
        let features = features::filtered(level, noisy);
        let modulation = modulation(noisy, features.as_deref());
        let known = noisy.halves.map(|half| half.iter().map(is_known).collect::<Vec<bool>>());
        let divided = filled(noisy, &known).map(|half| {
            half.into_par_iter().zip(&modulation).map(|(c, m)| Rgb::new(c.r / m.r, c.g / m.g, c.b / m.b)).collect()
        });
        let before = light(&divided, &modulation, own.clone());
        let halves = if settings.cut_outliers { outliers::cut(noisy.width, &divided) } else { divided };
        let light = [before, light(&halves, &modulation, own)];
        let scale = scale(&halves);
        let single = variance(&halves);
        let usual = usual(noisy.width, &single);
        let variance = blur::mean(noisy.width, &single, VARIANCE_REACH);
        // Where there is no noise, no pixel is less sure than others.
        let least = (scale * scale * 1e-7).max(1e-30);
        let guides = [0, 1].map(|half: usize| channels(&grid, &halves[half]));
        let planes = features.map_or(Vec::new(), |features| {
            let plane = |k: usize| grid.phases(&grid.pad(|i| features[i][k]));
            (0..FEATURES).into_par_iter().map(plane).collect()
        });
        Self {
            colours: [0, 1].map(|half: usize| [0, 1, 2].map(|k: usize| grid.phases(&guides[half][k]))),
            masks: [0, 1].map(|half: usize| grid.phases(&grid.pad_zero(|i| f32::from(u8::from(known[half][i]))))),
            variance: grid.pad(|i| variance[i]),
            single: grid.phases(&grid.pad(|i| single[i] + least)),
            usual: grid.phases(&grid.pad(|i| usual[i] * TRUST + least)),
            features: planes,
            scale,
            grid,
            modulation,
            halves,
            known,
            guides,
            light,
        }
    }
}

/// Whether a colour can be reckoned with.
pub(crate) fn is_known(colour: &Rgb) -> bool {
    colour.is_finite() && colour.map(f32::abs).max_channel() < BRIGHTEST
}

/// The colours as planes with margins.
fn channels(grid: &Grid, colours: &[Rgb]) -> [Vec<f32>; 3] {
    [grid.pad(|i| colours[i].r), grid.pad(|i| colours[i].g), grid.pad(|i| colours[i].b)]
}

/// What a pixel's light is divided by: the albedo, and 1 for the part of the pixel where there is no surface. So what
/// is left, the light that arrives, goes on smoothly from the surface to the sky behind it.
fn modulation(noisy: &Noisy, features: Option<&[Feature]>) -> Vec<Rgb> {
    let Some(features) = features.filter(|_| noisy.features.albedo.is_some()) else {
        return vec![Rgb::WHITE; noisy.width * noisy.height];
    };
    let has_normals = noisy.features.normal.is_some();
    let pixel = |feature: &Feature| {
        let [r, g, b, x, y, z, _] = *feature;
        let bare = if has_normals {
            (1.0 - (x * x + y * y + z * z).sqrt()).max(0.0)
        } else {
            f32::from(u8::from(r.max(g).max(b) <= 0.0))
        };
        Rgb::new(r, g, b).map(|albedo| (albedo + bare).max(DARKEST))
    };
    features.par_iter().map(pixel).collect()
}

/// The halves, unknown pixels taken from the other half, or else from the mean of known neighbours.
fn filled(noisy: &Noisy, known: &[Vec<bool>; 2]) -> [Vec<Rgb>; 2] {
    [0, 1].map(|half: usize| {
        let pixel = |i: usize| match (known[half][i], known[1 - half][i]) {
            (true, _) => noisy.halves[half][i],
            (_, true) => noisy.halves[1 - half][i],
            _ => neighbours(noisy, known, i),
        };
        (0..known[half].len()).into_par_iter().map(pixel).collect()
    })
}

/// The mean of what is known of both halves around pixel `i`, or black.
fn neighbours(noisy: &Noisy, known: &[Vec<bool>; 2], i: usize) -> Rgb {
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

/// The sum of all channels of pixels, multiplied as they will be.
fn light(halves: &[Vec<Rgb>; 2], modulation: &[Rgb], own: Range<usize>) -> f64 {
    let pixel = |(c, m): (&Rgb, &Rgb)| sum(*c * *m);
    halves.iter().map(|half| half[own.clone()].iter().zip(&modulation[own.clone()]).map(pixel).sum::<f64>()).sum()
}

/// The mean of the sum of the channels.
fn scale(halves: &[Vec<Rgb>; 2]) -> f32 {
    let total: f64 = halves.iter().flatten().map(|colour| sum(*colour)).sum();
    (total / (2 * halves[0].len()) as f64) as f32
}

fn sum(colour: Rgb) -> f64 {
    f64::from(colour.r) + f64::from(colour.g) + f64::from(colour.b)
}

/// Variance of one half's pixels from the difference of both, summed over the channels.
fn variance(halves: &[Vec<Rgb>; 2]) -> Vec<f32> {
    let pixel = |(a, b): (&Rgb, &Rgb)| {
        let difference = *a - *b;
        let square = difference * difference;
        (square.r + square.g + square.b) * 0.5
    };
    halves[0].par_iter().zip(&halves[1]).map(pixel).collect()
}

/// What is usual of numbers around each pixel: the mean of fourth roots, which a few large ones hardly change.
fn usual(width: usize, numbers: &[f32]) -> Vec<f32> {
    let roots: Vec<f32> = numbers.par_iter().map(|number| number.sqrt().sqrt()).collect();
    let means = blur::mean(width, &roots, USUAL_REACH);
    means.into_par_iter().map(|mean| (mean * mean) * (mean * mean)).collect()
}
