//! Piecewise constant densities over [0, 1) and [0, 1)², to importance-sample environment maps and
//! tables (Pharr, Jakob, Humphreys, PBR 4th ed., section 14.3.6 and appendix A.4). The CDF is
//! searched by the cutpoint method (Chen and Asau, On Generating Random Variates from an Empirical
//! Distribution, 1974).

use crate::Vec2;

/// Piecewise constant density over [0, 1) with cells of equal width.
#[derive(Clone, Debug, PartialEq)]
pub struct Distribution1D {
    /// Cells, followed by a sentinel with `cdf = 1`.
    cells: Vec<Cell>,
    /// Cutpoint table of length 2^n + 1: `cutpoints[k]` counts the cells with `cdf <= k / 2^n`. A
    /// search starts there and mostly ends in the same cache line.
    cutpoints: Vec<u32>,
    /// Mean of the weights.
    mean: f32,
}

/// A cell of the density.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cell {
    /// CDF at the lower edge: 0 in the first cell, exactly 1 in the sentinel.
    cdf: f32,
    /// Density within the cell; the mean over all cells is 1.
    density: f32,
}

/// Approximate number of cells per entry of the cutpoint table.
const CELLS_PER_CUT: usize = 4;

/// Builds the cutpoint table. Its number of intervals is a power of two, so that products with it
/// are exact.
fn build_cutpoints(cells: &[Cell]) -> Vec<u32> {
    let cuts = (cells.len() / CELLS_PER_CUT).next_power_of_two().min(1 << 24);
    let mut count = 0;
    let at_most = |cut: f32| {
        while cells.get(count).is_some_and(|cell| cell.cdf <= cut) {
            count += 1;
        }
        count as u32
    };
    (0..=cuts).map(|k| k as f32 / cuts as f32).map(at_most).collect()
}

impl Distribution1D {
    /// Constructs a density from one weight per cell. Negative, NaN and infinite weights count as
    /// zero. All-zero weights give a uniform density; no weights give `None`.
    pub fn new(weights: &[f32]) -> Option<Self> {
        if weights.is_empty() {
            return None;
        }
        let usable = |w: f32| if w > 0.0 && w.is_finite() { f64::from(w) } else { 0.0 };
        let total: f64 = weights.iter().map(|&w| usable(w)).sum();
        let weight = |w: f32| if total > 0.0 { usable(w) } else { 1.0 };
        let sum = if total > 0.0 { total } else { weights.len() as f64 };
        // Rounding must leave no gap below 1 and no probability for the empty cells at the end.
        let last = weights.iter().rposition(|&w| weight(w) > 0.0).unwrap_or(0);
        let mut running = 0.0;
        let cell = |(i, &w): (usize, &f32)| {
            let cdf = if i > last { 1.0 } else { (running / sum).min(1.0) as f32 };
            running += weight(w);
            Cell { cdf, density: (weight(w) * weights.len() as f64 / sum) as f32 }
        };
        let mut cells: Vec<Cell> = weights.iter().enumerate().map(cell).collect();
        cells.push(Cell { cdf: 1.0, density: 0.0 });
        Some(Self { cutpoints: build_cutpoints(&cells), cells, mean: (total / weights.len() as f64) as f32 })
    }

    /// Mean of the weights.
    pub fn mean(&self) -> f32 {
        self.mean
    }

    /// Number of cells.
    pub fn len(&self) -> usize {
        self.cells.len() - 1
    }

    /// Always `false`: there is at least one cell.
    pub fn is_empty(&self) -> bool {
        false
    }

    /// Samples a position in [0, 1). Returns the position, its density and the index of its cell.
    pub fn sample(&self, u: f32) -> (f32, f32, usize) {
        let cell = self.at_most(u).clamp(1, self.len()) - 1;
        let (Cell { cdf: low, density }, high) = (self.cells[cell], self.cells[cell + 1].cdf);
        let inside = if high > low { ((u - low) / (high - low)).min(1f32.next_down()) } else { 0.5 };
        let mut x = ((cell as f32 + inside) / self.len() as f32).min(1f32.next_down());
        // Rounding at a cell boundary must not move the sample into the next cell, which may be
        // empty.
        while self.cell(x) < cell {
            x = x.next_up();
        }
        while self.cell(x) > cell {
            x = x.next_down();
        }
        (x, density, cell)
    }

    /// Number of cells whose `cdf` is at most `u`, which lies in [0, 1).
    fn at_most(&self, u: f32) -> usize {
        let cuts = self.cutpoints.len() - 1;
        let cut = ((u * cuts as f32) as usize).min(cuts - 1);
        let (from, to) = (self.cutpoints[cut] as usize, self.cutpoints[cut + 1] as usize);
        from + self.cells[from..to].partition_point(|cell| cell.cdf <= u)
    }

    /// Density at `x` in [0, 1).
    pub fn pdf(&self, x: f32) -> f32 {
        self.cells[self.cell(x)].density
    }

    /// Probability of a cell, for discrete sampling; 0 for an index out of range.
    pub fn probability(&self, cell: usize) -> f32 {
        self.cells.get(cell).map_or(0.0, |cell| cell.density / self.len() as f32)
    }

    fn cell(&self, x: f32) -> usize {
        ((x * self.len() as f32) as usize).min(self.len() - 1)
    }
}

/// Piecewise constant density over the unit square on a regular grid.
#[derive(Clone, Debug, PartialEq)]
pub struct Distribution2D {
    /// Conditional density of x for each row.
    rows: Vec<Distribution1D>,
    /// Marginal density of the rows.
    marginal: Distribution1D,
}

impl Distribution2D {
    /// Constructs a density from row-major weights; `None` unless their number is a positive
    /// multiple of `width`.
    pub fn new(width: usize, weights: &[f32]) -> Option<Self> {
        if width == 0 || !weights.len().is_multiple_of(width) {
            return None;
        }
        let rows = weights.chunks_exact(width).map(Distribution1D::new).collect::<Option<Vec<_>>>()?;
        let means: Vec<f32> = rows.iter().map(Distribution1D::mean).collect();
        Some(Self { marginal: Distribution1D::new(&means)?, rows })
    }

    /// Mean of the weights.
    pub fn mean(&self) -> f32 {
        self.marginal.mean()
    }

    /// Samples a point of the unit square. Returns the point and its density per unit area.
    pub fn sample(&self, u: Vec2) -> (Vec2, f32) {
        let (y, marginal, row) = self.marginal.sample(u.y);
        let (x, conditional, _) = self.rows[row].sample(u.x);
        (Vec2::new(x, y), marginal * conditional)
    }

    /// Density per unit area at `p` in the unit square.
    pub fn pdf(&self, p: Vec2) -> f32 {
        self.marginal.pdf(p.y) * self.rows[self.marginal.cell(p.y)].pdf(p.x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{Random, chi_squared};

    /// Significance level of each test: one in a thousand for all tests of this file together.
    const SIGNIFICANCE: f64 = 1e-3 / 3.0;

    #[test]
    fn samples_follow_the_weights_and_never_hit_empty_cells() {
        let weights = [0.0, 3.0, 0.0, f32::NAN, 1.0, 0.5, -2.0, 5.5, 0.0, 0.0];
        let distribution = Distribution1D::new(&weights).unwrap();
        let mut random = Random::new(31);
        let mut observed = [0.0; 10];
        for i in 0..1_000_000 {
            // Rounding errors would show at the ends of the range.
            let u = [0.0, 1f32.next_down()].get(i).copied().unwrap_or_else(|| random.f32());
            let (x, pdf, cell) = distribution.sample(u);
            assert_eq!((pdf, cell), (distribution.pdf(x), (x * 10.0) as usize), "{u}");
            observed[cell] += 1.0;
        }
        let expected = [0.0, 3e5, 0.0, 0.0, 1e5, 5e4, 0.0, 5.5e5, 0.0, 0.0];
        chi_squared(&observed, &expected, SIGNIFICANCE).unwrap();
        assert_eq!((distribution.probability(1), distribution.probability(99)), (0.3, 0.0));
    }

    #[test]
    fn cutpoint_search_equals_linear_search() {
        let mut random = Random::new(35);
        for cells in [1, 2, 3, 7, 64, 1000, 4099] {
            let weights: Vec<f32> =
                (0..cells).map(|_| if random.f32() < 0.3 { 0.0 } else { random.f32().powi(9) }).collect();
            let distribution = Distribution1D::new(&weights).unwrap();
            let cuts = (distribution.cutpoints.len() - 1) as f32;
            let sums: Vec<f32> = distribution.cells.iter().map(|cell| cell.cdf).collect();
            let borders = sums
                .clone()
                .into_iter()
                .chain((0..=cells).map(|k| k as f32 / cuts))
                .chain((0..500).map(|_| random.f32()));
            for u in borders.flat_map(|u| [u.next_down(), u, u.next_up()]).filter(|u| (0.0..1.0).contains(u)) {
                let all = sums.partition_point(|&sum| sum <= u);
                assert_eq!(distribution.at_most(u), all, "{cells} cells, {u}");
            }
        }
    }

    #[test]
    fn within_a_cell_samples_are_uniform() {
        let distribution = Distribution1D::new(&[1.0, 3.0]).unwrap();
        let mut random = Random::new(32);
        let mut observed = [0.0; 20];
        for _ in 0..1_000_000 {
            observed[(distribution.sample(random.f32()).0 * 20.0) as usize] += 1.0;
        }
        let expected: Vec<f64> = (0..20).map(|i| if i < 10 { 25e3 } else { 75e3 }).collect();
        chi_squared(&observed, &expected, SIGNIFICANCE).unwrap();
    }

    #[test]
    fn two_dimensions_follow_the_weights() {
        let mut random = Random::new(33);
        let weights: Vec<f32> = (0..12 * 7).map(|i| if i % 5 == 0 { 0.0 } else { random.f32() }).collect();
        let distribution = Distribution2D::new(12, &weights).unwrap();
        let mut observed = vec![0.0; weights.len()];
        for _ in 0..1_000_000 {
            let (p, pdf) = distribution.sample(random.vec2());
            let cell = (p.y * 7.0) as usize * 12 + (p.x * 12.0) as usize;
            let density = weights[cell] / distribution.mean();
            assert!((pdf - density).abs() < 1e-4 * density && pdf == distribution.pdf(p));
            observed[cell] += 1.0;
        }
        let total: f64 = weights.iter().map(|&w| f64::from(w)).sum();
        let expected: Vec<f64> = weights.iter().map(|&w| f64::from(w) / total * 1e6).collect();
        chi_squared(&observed, &expected, SIGNIFICANCE).unwrap();
    }

    #[test]
    fn zero_weights_sample_uniformly_and_wrong_sizes_are_rejected() {
        let flat = Distribution2D::new(2, &[0.0; 8]).unwrap();
        assert_eq!(flat.sample(Vec2::new(0.3, 0.9)), (Vec2::new(0.3, 0.9), 1.0));
        assert_eq!(flat.mean(), 0.0);
        assert!(Distribution1D::new(&[]).is_none() && Distribution2D::new(3, &[1.0; 8]).is_none());
        assert!(Distribution2D::new(3, &[]).is_none() && Distribution2D::new(0, &[]).is_none());
    }

    #[test]
    fn huge_weight_among_many_small_weights_is_sampled_correctly() {
        let mut weights = vec![1e-6; 100_000];
        weights[77_777] = 1e6;
        let distribution = Distribution1D::new(&weights).unwrap();
        let (x, _, cell) = distribution.sample(0.5);
        assert_eq!(cell, 77_777);
        assert!((0.777_77..0.777_79).contains(&x));
    }
}
