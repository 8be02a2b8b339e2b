//! Energy conservation: the filtered picture gets the mean of the input, in every neighborhood and
//! over the whole picture.
//!
//! The weights of the filter depend on the noise: bright samples are rare, differ most from their
//! surroundings and count least, so a filtered picture is darker than the mean of its samples. This
//! pass compares the input `x` with the filtered picture `y` on a grid of nodes, from fine to
//! coarse. With the hat functions `B_c` of bilinear interpolation between the nodes, a level
//! computes
//!
//! ```text
//! t_c = g_c Σ_q B_c(q) (x_q - y_q) / Σ_p B_c(p) y_p        y_p ← y_p (1 + Σ_c B_c(p) t_c)
//! ```
//!
//! so that with a gain `g_c` of 1 the sum of `y` becomes the sum of `x`, for each channel. All
//! pixels of a neighborhood change by the same factor, which varies slowly, so edges and textures
//! are preserved. On coarse levels the gain is 1. On fine levels the difference is mostly the noise
//! that the filter has removed; the gain is that of a Wiener filter, `1 - σ² / d²`, where `d²` is
//! the square of the difference and `σ²` its variance by the halves, both averaged over neighboring
//! nodes. The influence of a single pixel on its neighborhood is limited; the energy of brighter
//! outliers goes to the larger neighborhoods of the next levels, the rest to the whole picture.
//! Between the fine and the coarse levels, pixels are limited by their halves (`upper_bound`) and by
//! their surroundings (`highlights`).

use crate::{Noisy, Settings, blur, highlights, noise, upper_bound};
use juggler_math::Rgb;
use rayon::prelude::*;

/// A grid of nodes.
struct Level {
    /// Distance between nodes, in pixels.
    spacing: usize,
    /// Maximum fraction of its neighborhood's energy that a single pixel may add or remove.
    max_fraction: f64,
    /// Whether the gain is that of a Wiener filter; otherwise it is 1.
    is_wiener: bool,
}

/// The grids, from fine to coarse.
const LEVELS: [Level; 6] = [
    Level { spacing: 2, max_fraction: 0.2, is_wiener: true },
    Level { spacing: 4, max_fraction: 0.2, is_wiener: true },
    Level { spacing: 8, max_fraction: 0.2, is_wiener: true },
    Level { spacing: 16, max_fraction: 0.2, is_wiener: true },
    Level { spacing: 64, max_fraction: 0.02, is_wiener: false },
    Level { spacing: 256, max_fraction: 0.02, is_wiener: false },
];
/// Range of the change `t_c` of a node at one level.
const CHANGE: [f64; 2] = [-0.5, 1.0];
/// Radius of the average of differences and variances, in nodes.
const AVERAGE_RADIUS: usize = 2;
/// Maximum squared difference of a single node in that average, in variances.
const MAX_SQUARE: f32 = 9.0;
/// Minimum of that limit, relative to the squared energy, so that differences count even without
/// noise.
const MIN_SQUARE: f32 = 1e-9;
/// Range of the factor for the whole picture, which protects pictures that are black but for
/// rounding errors.
const GLOBAL_FACTOR: [f64; 2] = [0.1, 10.0];

/// Energy in red, green and blue.
type Energy = [f64; 3];

/// Restores the local and global means of the input.
pub(crate) fn conserve(noisy: &Noisy, settings: &Settings, pixels: &mut [Rgb]) {
    let input: Vec<Rgb> = (0..pixels.len()).into_par_iter().map(|i| noisy.mean(i).unwrap_or(pixels[i])).collect();
    let variances: Vec<f32> = (0..pixels.len()).into_par_iter().map(|i| variance(noisy, i)).collect();
    let (fine, coarse): (Vec<Level>, Vec<Level>) = LEVELS.into_iter().partition(|level| level.is_wiener);
    scale_by(&fine, noisy, &input, &variances, pixels);
    let differences = noise::typical_differences(noisy);
    upper_bound::dim(noisy, &differences, pixels);
    if settings.cut_outliers {
        highlights::limit(noisy, &differences, pixels);
    }
    scale_by(&coarse, noisy, &input, &variances, pixels);
    let (expected, filtered) = (total(&input), total(pixels));
    let factor = each(|k| {
        let factor = expected[k] / filtered[k];
        if factor.is_finite() { factor.clamp(GLOBAL_FACTOR[0], GLOBAL_FACTOR[1]) } else { 1.0 }
    });
    pixels.par_iter_mut().for_each(|pixel| *pixel = scaled(*pixel, factor));
}

/// Scales neighborhoods, level by level.
fn scale_by(levels: &[Level], noisy: &Noisy, input: &[Rgb], noise: &[f32], pixels: &mut [Rgb]) {
    for level in levels {
        if level.spacing < noisy.width.max(noisy.height) {
            let nodes = Nodes::new(noisy.width, noisy.height, level.spacing);
            let changes = level.changes(&nodes, input, noise, pixels);
            nodes.scale(&changes, pixels);
        }
    }
}

/// Variance of the input, summed over the channels; zero where a half is unknown.
fn variance(noisy: &Noisy, i: usize) -> f32 {
    match noisy.known(i) {
        [Some(a), Some(b)] => {
            let square = (a - b) * (a - b) * 0.25;
            square.r + square.g + square.b
        }
        _ => 0.0,
    }
}

impl Level {
    /// The change `t_c` of each node.
    fn changes(&self, nodes: &Nodes, input: &[Rgb], noise: &[f32], pixels: &[Rgb]) -> Vec<Energy> {
        let filtered = nodes.gather(|i, _| energy(pixels[i]));
        let difference = nodes.gather(|i, place| {
            let (input, pixel, around) = (energy(input[i]), energy(pixels[i]), nodes.interpolate(&filtered, place));
            each(|k| {
                let limit = self.max_fraction * around[k].max(0.0);
                (input[k] - pixel[k]).clamp(-limit, limit)
            })
        });
        let gains =
            if self.is_wiener { gains(nodes, noise, &difference, &filtered) } else { vec![1.0; filtered.len()] };
        let change = |((difference, filtered), gain): ((&Energy, &Energy), f64)| {
            let change = |k: usize| (difference[k] / filtered[k]).clamp(CHANGE[0], CHANGE[1]) * gain;
            each(|k| if filtered[k] > 0.0 { change(k) } else { 0.0 })
        };
        difference.par_iter().zip(&filtered).zip(gains).map(change).collect()
    }
}

/// Wiener gain of each node: the fraction of the difference that is not noise.
fn gains(nodes: &Nodes, noise: &[f32], difference: &[Energy], filtered: &[Energy]) -> Vec<f64> {
    let variances = nodes.gather_squared(|i| f64::from(noise[i]));
    let square = |energy: &Energy| energy.iter().map(|v| v * v).sum::<f64>();
    // Squares are relative to the squared energy of the node.
    let relative = |square: f64, filtered: &Energy| {
        let energy = filtered.iter().sum::<f64>();
        (square / (energy * energy + 1e-30)) as f32
    };
    let variances: Vec<f32> = variances.par_iter().zip(filtered).map(|(v, filtered)| relative(*v, filtered)).collect();
    let variances = blur::mean(nodes.node_columns, &variances, AVERAGE_RADIUS);
    let limited = |((difference, filtered), v): ((&Energy, &Energy), &f32)| {
        relative(square(difference), filtered).min((MAX_SQUARE * v).max(MIN_SQUARE))
    };
    let squares: Vec<f32> = difference.par_iter().zip(filtered).zip(&variances).map(limited).collect();
    let squares = blur::mean(nodes.node_columns, &squares, AVERAGE_RADIUS);
    let gain =
        |(square, variance): (&f32, &f32)| if square > variance { 1.0 - f64::from(variance / square) } else { 0.0 };
    squares.iter().zip(&variances).map(gain).collect()
}

fn total(pixels: &[Rgb]) -> Energy {
    pixels.iter().fold([0.0; 3], |sum, pixel| each(|k| sum[k] + energy(*pixel)[k]))
}

fn energy(color: Rgb) -> Energy {
    color.to_array().map(f64::from)
}

fn scaled(color: Rgb, factor: Energy) -> Rgb {
    let [r, g, b] = color.to_array();
    let scaled = |v: f32, factor: f64| (f64::from(v) * factor) as f32;
    Rgb::new(scaled(r, factor[0]), scaled(g, factor[1]), scaled(b, factor[2]))
}

fn each(channel: impl Fn(usize) -> f64) -> Energy {
    [channel(0), channel(1), channel(2)]
}

/// Position of a row or column between two nodes: index of the first node, and weight of the
/// second.
type NodePosition = (usize, f64);

/// Nodes of bilinear interpolation. The first and the last of a row are at the picture's edges.
struct Nodes {
    node_columns: usize,
    columns: Vec<NodePosition>,
    rows: Vec<NodePosition>,
}

impl Nodes {
    fn new(width: usize, height: usize, spacing: usize) -> Self {
        let cells = |length: usize| ((length + spacing / 2) / spacing).max(1);
        let places = |length: usize| -> Vec<NodePosition> {
            let place = |i: usize| {
                let place = (i as f64 + 0.5) * cells(length) as f64 / length as f64;
                (place as usize, place - place.floor())
            };
            (0..length).map(place).collect()
        };
        Self { node_columns: cells(width) + 1, columns: places(width), rows: places(height) }
    }

    /// Sum over pixels for each node, weighted by its hat function. `pixel` receives index and
    /// position.
    fn gather(&self, pixel: impl Fn(usize, [NodePosition; 2]) -> Energy + Sync) -> Vec<Energy> {
        let width = self.columns.len();
        let add = |sums: &mut [Energy], (y, row): (usize, &NodePosition)| {
            for (x, column) in self.columns.iter().enumerate() {
                let energy = pixel(y * width + x, [*column, *row]);
                let right = each(|k| energy[k] * column.1);
                sums[column.0] = each(|k| sums[column.0][k] + (energy[k] - right[k]));
                sums[column.0 + 1] = each(|k| sums[column.0 + 1][k] + right[k]);
            }
        };
        self.by_rows(add, |weight| weight)
    }

    /// Sum over pixels for each node, weighted by the square of its hat function.
    fn gather_squared(&self, pixel: impl Fn(usize) -> f64 + Sync) -> Vec<f64> {
        let width = self.columns.len();
        let add = |sums: &mut [Energy], (y, _): (usize, &NodePosition)| {
            for (x, (left, right)) in self.columns.iter().enumerate() {
                let value = pixel(y * width + x);
                sums[*left][0] += value * (1.0 - right) * (1.0 - right);
                sums[*left + 1][0] += value * right * right;
            }
        };
        self.by_rows(add, |weight| weight * weight).into_iter().map(|[sum, ..]| sum).collect()
    }

    /// Sums for all nodes, row by row. `add` adds a row of pixels to the nodes of a row; `weight`
    /// converts the hat function of that row to its weight.
    fn by_rows(
        &self,
        add: impl Fn(&mut [Energy], (usize, &NodePosition)) + Sync,
        weight: impl Fn(f64) -> f64 + Sync,
    ) -> Vec<Energy> {
        let mut lines = vec![[0.0; 3]; self.node_columns * self.rows.len()];
        lines
            .par_chunks_mut(self.node_columns)
            .zip(&self.rows)
            .enumerate()
            .for_each(|(y, (line, row))| add(line, (y, row)));
        let down = self.rows.last().map_or(0, |(last, _)| last + 2);
        let mut nodes = vec![[0.0; 3]; self.node_columns * down];
        nodes.par_chunks_mut(self.node_columns).enumerate().for_each(|(node, sums)| {
            let range = self.rows.partition_point(|(first, _)| first + 1 < node)
                ..self.rows.partition_point(|(first, _)| *first <= node);
            let lines = lines.chunks_exact(self.node_columns).zip(&self.rows);
            for (line, (first, second)) in lines.skip(range.start).take(range.len()) {
                let weight = weight(if *first == node { 1.0 - second } else { *second });
                sums.iter_mut().zip(line).for_each(|(sum, energy)| *sum = each(|k| sum[k] + energy[k] * weight));
            }
        });
        nodes
    }

    /// Scales each pixel by 1 plus the interpolated change.
    fn scale(&self, changes: &[Energy], pixels: &mut [Rgb]) {
        pixels.par_chunks_mut(self.columns.len()).zip(&self.rows).for_each(|(pixels, row)| {
            for (pixel, column) in pixels.iter_mut().zip(&self.columns) {
                let change = self.interpolate(changes, [*column, *row]);
                *pixel = scaled(*pixel, each(|k| 1.0 + change[k]));
            }
        });
    }

    /// Bilinear interpolation of the four nearest nodes.
    fn interpolate(&self, nodes: &[Energy], [(x, right), (y, below)]: [NodePosition; 2]) -> Energy {
        let at = y * self.node_columns + x;
        let across = |at: usize| each(|k| nodes[at][k] + (nodes[at + 1][k] - nodes[at][k]) * right);
        let (above, under) = (across(at), across(at + self.node_columns));
        each(|k| above[k] + (under[k] - above[k]) * below)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Features;
    use juggler_math::testing::Random;

    const WIDTH: usize = 160;
    const HEIGHT: usize = 120;

    fn conserved(input: &[Rgb], filtered: &[Rgb]) -> Vec<Rgb> {
        let noisy = Noisy::new(WIDTH, HEIGHT, [input, input], Features::default()).unwrap();
        let mut pixels = filtered.to_vec();
        conserve(&noisy, &Settings::default(), &mut pixels);
        pixels
    }

    #[test]
    fn each_channel_gets_the_sum_of_the_input() {
        let mut random = Random::new(5);
        let spike = |v: f32| if v > 0.999 { 500.0 } else { v * v };
        let input: Vec<Rgb> = (0..WIDTH * HEIGHT).map(|_| random.rgb().map(spike)).collect();
        let filtered: Vec<Rgb> = (0..WIDTH * HEIGHT).map(|_| Rgb::new(0.3, 0.5, 0.1) + random.rgb() * 0.1).collect();
        let (found, expected) = (total(&conserved(&input, &filtered)), total(&input));
        for (found, expected) in found.into_iter().zip(expected) {
            assert!((found / expected - 1.0).abs() < 1e-6, "{found} {expected}");
        }
    }

    #[test]
    fn lost_energy_is_restored_locally() {
        let block = |i: usize| (i % WIDTH).abs_diff(80) < 40 && (i / WIDTH).abs_diff(60) < 40;
        let input = vec![Rgb::new(0.5, 1.0, 2.0); WIDTH * HEIGHT];
        let filtered: Vec<Rgb> = (0..input.len()).map(|i| input[i] * if block(i) { 0.7 } else { 1.0 }).collect();
        let pixels = conserved(&input, &filtered);
        for (x, y, bound) in [(80, 60, 0.02), (70, 50, 0.05), (4, 4, 0.02), (155, 60, 0.02)] {
            let ratio = pixels[y * WIDTH + x].g / input[0].g;
            assert!((ratio - 1.0).abs() < bound, "{x} {y}: {ratio}");
        }
    }

    #[test]
    fn an_outlier_leaves_no_blotch() {
        let wall = vec![Rgb::WHITE; WIDTH * HEIGHT];
        let mut half = wall.clone();
        half[60 * WIDTH + 40] = Rgb::splat(6000.0);
        let noisy = Noisy::new(WIDTH, HEIGHT, [&half, &wall], Features::default()).unwrap();
        let mut pixels = wall.clone();
        conserve(&noisy, &Settings::default(), &mut pixels);
        let (least, most) = pixels.iter().fold((f32::MAX, 0.0_f32), |(a, b), c| (a.min(c.r), b.max(c.r)));
        assert!(most / least < 1.05, "{least} {most}");
        let expected = (total(&half)[0] + total(&wall)[0]) / 2.0;
        assert!((total(&pixels)[0] / expected - 1.0).abs() < 1e-6);
    }

    #[test]
    fn pixels_without_light_or_without_a_color_change_nothing() {
        let black = vec![Rgb::BLACK; WIDTH * HEIGHT];
        assert_eq!(conserved(&black, &black), black);
        let mut input = vec![Rgb::WHITE; WIDTH * HEIGHT];
        input[7000] = Rgb::splat(f32::NAN);
        let found = conserved(&input, &vec![Rgb::WHITE; WIDTH * HEIGHT]);
        assert!(found.iter().all(|c| (c.r - 1.0).abs() < 1e-6));
    }
}
