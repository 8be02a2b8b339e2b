//! Per-block sums of differences and variances, and their tests.

use super::student::two_sided;
use super::{LargestDifference, NoisyImage, degrees_of_freedom};
use juggler_math::portable;

/// Edge of the smallest blocks in pixels.
const EDGE: u32 = 16;
/// Relative variance of rounding to half floats, since files may store halves.
const ROUNDING: f64 = 2e-8;
/// Degrees of freedom without a limit.
const MAX_FREEDOM: f64 = 1e6;

/// Sums of one channel over a block, with d the difference and v the variance of a pixel.
#[derive(Clone, Copy, Debug, Default)]
struct Sum {
    /// Σ d, Σ d², Σ d⁴ and max d²; d² includes the variance of rounding.
    difference: f64,
    squares: f64,
    fourths: f64,
    largest: f64,
    /// Σ v including rounding, and Σ v² / (ν + 2).
    variance: f64,
    uncertainty: f64,
}

/// Sums of one block.
#[derive(Clone, Copy, Debug, Default)]
struct PixelBlock {
    channels: [Sum; 3],
    /// Sums of products of differences: red-green, red-blue, green-blue.
    products: [f64; 3],
}

/// Blocks of one size.
pub struct PixelBlocks {
    columns: usize,
    edge: u32,
    size: [u32; 2],
    blocks: Vec<PixelBlock>,
}

/// Result of testing blocks of one size.
#[derive(Clone, Copy, Debug)]
pub struct Tested {
    /// Number of blocks that can differ.
    pub blocks: usize,
    /// Smallest p-value over blocks and channels.
    pub p: f64,
    /// Block of the smallest p-value.
    pub worst: Option<LargestDifference>,
}

impl Default for Tested {
    fn default() -> Self {
        Self { blocks: 0, p: 1.0, worst: None }
    }
}

impl Tested {
    /// The result with the smaller p-value.
    pub fn min_p(self, other: Self) -> Self {
        if other.p < self.p { other } else { self }
    }
}

impl Sum {
    fn add_pixel(&mut self, [a, b]: [f64; 2], variances: [f64; 2], freedoms: [f64; 2]) {
        let difference = a - b;
        let rounding = ROUNDING * (a * a + b * b);
        let square = difference * difference + rounding;
        self.difference += difference;
        self.squares += square;
        self.fourths += square * square;
        self.largest = self.largest.max(square);
        self.variance += variances[0] + variances[1] + rounding;
        for (variance, degrees_of_freedom) in variances.into_iter().zip(freedoms) {
            self.uncertainty += variance * variance / (degrees_of_freedom + 2.0);
        }
    }

    fn add(&mut self, other: &Self) {
        self.difference += other.difference;
        self.squares += other.squares;
        self.fourths += other.fourths;
        self.largest = self.largest.max(other.largest);
        self.variance += other.variance;
        self.uncertainty += other.uncertainty;
    }

    /// Difference in standard errors, and its two-sided p-value.
    fn test(&self) -> (f64, f64) {
        let (variance_bound, square_sum) = (self.variance + self.largest, self.squares);
        let error = portable::sqrt_f64(variance_bound.min(square_sum));
        if self.difference == 0.0 || error == 0.0 {
            return (0.0, 1.0);
        }
        let welch = if variance_bound < square_sum && self.uncertainty > 0.0 {
            self.variance * self.variance / self.uncertainty - 2.0
        } else {
            MAX_FREEDOM
        };
        let effective_pixels = if self.fourths > 0.0 { self.squares * self.squares / self.fourths } else { 1.0 };
        let deviation = self.difference / error;
        (deviation, two_sided(deviation, welch.min(effective_pixels).clamp(1.0, MAX_FREEDOM)))
    }
}

impl PixelBlocks {
    /// Sums over the smallest blocks.
    pub fn new(a: &NoisyImage, b: &NoisyImage) -> Self {
        let size = [a.width, a.height];
        let [columns, rows] = size.map(|length| length.div_ceil(EDGE).max(1) as usize);
        let mut blocks = vec![PixelBlock::default(); columns * rows];
        let width = a.width.max(1) as usize;
        let pixels = a.mean.iter().zip(&b.mean).zip(a.variance.iter().zip(&b.variance));
        let sample_blocks = a.blocks.iter().zip(&b.blocks);
        for (index, (((a, b), (va, vb)), (na, nb))) in pixels.zip(sample_blocks).enumerate() {
            let (column, row) = (index % width / EDGE as usize, index / width / EDGE as usize);
            let Some(block) = blocks.get_mut(row * columns + column) else { continue };
            let [a, b, va, vb] = [a, b, va, vb].map(|pixel| pixel.to_array().map(f64::from));
            let freedoms = [degrees_of_freedom(*na), degrees_of_freedom(*nb)];
            for (i, sum) in block.channels.iter_mut().enumerate() {
                sum.add_pixel([a[i], b[i]], [va[i].max(0.0), vb[i].max(0.0)], freedoms);
            }
            for (product, [i, j]) in block.products.iter_mut().zip([[0, 1], [0, 2], [1, 2]]) {
                *product += (a[i] - b[i]) * (a[j] - b[j]);
            }
        }
        Self { columns, edge: EDGE, size, blocks }
    }

    /// Number of blocks.
    pub fn count(&self) -> usize {
        self.blocks.len()
    }

    /// Effective number of independent channels (Nyholt 2004): 1 if their errors are fully
    /// correlated, 3 if independent.
    pub fn independent_channels(&self) -> f64 {
        let (mut alike, mut count) = ([0.0; 3], 0.0);
        for PixelBlock { channels, products } in &self.blocks {
            let squares = channels.map(|sum| sum.squares);
            if squares.contains(&0.0) {
                continue;
            }
            count += 1.0;
            for (alike, (product, [i, j])) in alike.iter_mut().zip(products.iter().zip([[0, 1], [0, 2], [1, 2]])) {
                *alike += product / portable::sqrt_f64(squares[i] * squares[j]);
            }
        }
        let squared: f64 =
            alike.iter().map(|alike| if count > 0.0 { (alike / count) * (alike / count) } else { 0.0 }).sum();
        1.0 + 2.0 * (1.0 - squared / 3.0).clamp(0.0, 1.0)
    }

    /// Tests all channels of all blocks.
    pub fn test(&self) -> Tested {
        let mut tested = Tested::default();
        for (index, block) in self.blocks.iter().enumerate() {
            let can_differ = block.channels.iter().any(|sum| sum.squares > 0.0 || sum.uncertainty > 0.0);
            tested.blocks += usize::from(can_differ);
            for (channel, sum) in block.channels.iter().enumerate() {
                let (deviation, p) = sum.test();
                if p < tested.p {
                    let worst = LargestDifference { area: self.area(index), channel, deviation };
                    tested = Tested { p, worst: Some(worst), ..tested };
                }
            }
        }
        tested
    }

    fn area(&self, index: usize) -> [u32; 4] {
        let [x, y] = [index % self.columns, index / self.columns].map(|at| at as u32 * self.edge);
        [x, y, self.edge.min(self.size[0] - x), self.edge.min(self.size[1] - y)]
    }

    /// Merges 2 × 2 blocks into one.
    pub fn coarser(&self) -> Self {
        let rows = self.blocks.len() / self.columns;
        let [columns, rows] = [self.columns, rows].map(|length| length.div_ceil(2));
        let mut blocks = vec![PixelBlock::default(); columns * rows];
        for (index, block) in self.blocks.iter().enumerate() {
            let (column, row) = (index % self.columns / 2, index / self.columns / 2);
            if let Some(sum) = blocks.get_mut(row * columns + column) {
                sum.channels.iter_mut().zip(&block.channels).for_each(|(sum, more)| sum.add(more));
                sum.products.iter_mut().zip(block.products).for_each(|(sum, more)| *sum += more);
            }
        }
        Self { columns, edge: self.edge.saturating_mul(2), size: self.size, blocks }
    }
}
