//! Sums over blocks of pixels, and tests of them.

use super::student::two_sided;
use super::{Estimate, Worst, freedom};
use juggler_math::fun;

/// Edge of the smallest blocks, in pixels.
const EDGE: u32 = 16;
/// Variance of what a half float rounds off, as a share of the value's square: files may hold halves.
const ROUNDING: f64 = 2e-8;
/// Degrees of freedom where nothing limits them.
const MOST_FREEDOM: f64 = 1e6;

/// What is known of one channel of a block.
#[derive(Clone, Copy, Debug, Default)]
struct Sum {
    /// Of the differences, their squares and fourth powers, and the largest square, each with what rounding adds.
    difference: f64,
    squares: f64,
    fourths: f64,
    largest: f64,
    /// Of the variances, and of their squares over their degrees of freedom and two.
    variance: f64,
    uncertainty: f64,
}

/// One block.
#[derive(Clone, Copy, Debug, Default)]
struct Cell {
    channels: [Sum; 3],
    /// Of the products of the differences of two channels: red and green, red and blue, green and blue.
    products: [f64; 3],
}

/// The blocks of one size.
pub struct Cells {
    columns: usize,
    edge: u32,
    size: [u32; 2],
    cells: Vec<Cell>,
}

/// What tests of some blocks say.
#[derive(Clone, Copy, Debug)]
pub struct Tested {
    /// How many of them can differ at all.
    pub cells: usize,
    /// The smallest chance, of any channel.
    pub p: f64,
    /// Where.
    pub worst: Option<Worst>,
}

impl Default for Tested {
    fn default() -> Self {
        Self { cells: 0, p: 1.0, worst: None }
    }
}

impl Tested {
    /// The one that says more.
    pub fn or(self, other: Self) -> Self {
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
        for (variance, freedom) in variances.into_iter().zip(freedoms) {
            self.uncertainty += variance * variance / (freedom + 2.0);
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

    /// The difference in standard errors, and the chance of one as large.
    fn test(&self) -> (f64, f64) {
        let (told, seen) = (self.variance + self.largest, self.squares);
        let error = fun::sqrt_f64(told.min(seen));
        if self.difference == 0.0 || error == 0.0 {
            return (0.0, 1.0);
        }
        let known = if told < seen && self.uncertainty > 0.0 {
            self.variance * self.variance / self.uncertainty - 2.0
        } else {
            MOST_FREEDOM
        };
        let taking_part = if self.fourths > 0.0 { self.squares * self.squares / self.fourths } else { 1.0 };
        let deviation = self.difference / error;
        (deviation, two_sided(deviation, known.min(taking_part).clamp(1.0, MOST_FREEDOM)))
    }
}

impl Cells {
    /// The smallest blocks.
    pub fn new(a: &Estimate, b: &Estimate) -> Self {
        let size = [a.width, a.height];
        let [columns, rows] = size.map(|length| length.div_ceil(EDGE).max(1) as usize);
        let mut cells = vec![Cell::default(); columns * rows];
        let width = a.width.max(1) as usize;
        let pixels = a.mean.iter().zip(&b.mean).zip(a.variance.iter().zip(&b.variance));
        let blocks = a.blocks.iter().zip(&b.blocks);
        for (place, (((a, b), (va, vb)), (na, nb))) in pixels.zip(blocks).enumerate() {
            let (column, row) = (place % width / EDGE as usize, place / width / EDGE as usize);
            let Some(cell) = cells.get_mut(row * columns + column) else { continue };
            let [a, b, va, vb] = [a, b, va, vb].map(|pixel| pixel.to_array().map(f64::from));
            let freedoms = [freedom(*na), freedom(*nb)];
            for (i, sum) in cell.channels.iter_mut().enumerate() {
                sum.add_pixel([a[i], b[i]], [va[i].max(0.0), vb[i].max(0.0)], freedoms);
            }
            for (product, [i, j]) in cell.products.iter_mut().zip([[0, 1], [0, 2], [1, 2]]) {
                *product += (a[i] - b[i]) * (a[j] - b[j]);
            }
        }
        Self { columns, edge: EDGE, size, cells }
    }

    /// How many.
    pub fn count(&self) -> usize {
        self.cells.len()
    }

    /// As many channels as would err independently (Nyholt 2004): 1 where all err alike, 3 where each errs for itself.
    pub fn independent_channels(&self) -> f64 {
        let (mut alike, mut count) = ([0.0; 3], 0.0);
        for Cell { channels, products } in &self.cells {
            let squares = channels.map(|sum| sum.squares);
            if squares.contains(&0.0) {
                continue;
            }
            count += 1.0;
            for (alike, (product, [i, j])) in alike.iter_mut().zip(products.iter().zip([[0, 1], [0, 2], [1, 2]])) {
                *alike += product / fun::sqrt_f64(squares[i] * squares[j]);
            }
        }
        let squared: f64 =
            alike.iter().map(|alike| if count > 0.0 { (alike / count) * (alike / count) } else { 0.0 }).sum();
        1.0 + 2.0 * (1.0 - squared / 3.0).clamp(0.0, 1.0)
    }

    /// Tests all channels of all blocks.
    pub fn test(&self) -> Tested {
        let mut tested = Tested::default();
        for (place, cell) in self.cells.iter().enumerate() {
            let can_differ = cell.channels.iter().any(|sum| sum.squares > 0.0 || sum.uncertainty > 0.0);
            tested.cells += usize::from(can_differ);
            for (channel, sum) in cell.channels.iter().enumerate() {
                let (deviation, p) = sum.test();
                if p < tested.p {
                    let worst = Worst { area: self.area(place), channel, deviation };
                    tested = Tested { p, worst: Some(worst), ..tested };
                }
            }
        }
        tested
    }

    fn area(&self, place: usize) -> [u32; 4] {
        let [x, y] = [place % self.columns, place / self.columns].map(|at| at as u32 * self.edge);
        [x, y, self.edge.min(self.size[0] - x), self.edge.min(self.size[1] - y)]
    }

    /// Blocks of twice the edge.
    pub fn coarser(&self) -> Self {
        let rows = self.cells.len() / self.columns;
        let [columns, rows] = [self.columns, rows].map(|length| length.div_ceil(2));
        let mut cells = vec![Cell::default(); columns * rows];
        for (place, cell) in self.cells.iter().enumerate() {
            let (column, row) = (place % self.columns / 2, place / self.columns / 2);
            if let Some(sum) = cells.get_mut(row * columns + column) {
                sum.channels.iter_mut().zip(&cell.channels).for_each(|(sum, more)| sum.add(more));
                sum.products.iter_mut().zip(cell.products).for_each(|(sum, more)| *sum += more);
            }
        }
        Self { columns, edge: self.edge.saturating_mul(2), size: self.size, cells }
    }
}
