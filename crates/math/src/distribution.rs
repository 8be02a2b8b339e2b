//! Piecewise constant densities over [0, 1) and [0, 1)², to sample environment maps and tables
//! (Pharr, Jakob, Humphreys, PBR 4th ed., section 14.3.6 and appendix A.4), searched from where a table of cut points
//! says (Chen and Asau, On Generating Random Variates from an Empirical Distribution, 1974).

use crate::Vec2;

/// A density over [0, 1), constant in cells of equal width.
#[derive(Clone, Debug, PartialEq)]
pub struct Distribution1D {
    /// One more than there are, so that each has a next one.
    cells: Vec<Cell>,
    /// `guide[k]`: how many cells have at most the chance k / 2^n before them; 2^n + 1 of them. A search starts there,
    /// and mostly ends in the same cache line.
    guide: Vec<u32>,
    /// Mean of the weights it was made from.
    mean: f32,
}

/// A cell of a density.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cell {
    /// Chance of the cells before it: 0 of the first, exactly 1 of the one behind the last.
    before: f32,
    /// Density within; the mean is 1.
    density: f32,
}

/// Cells that share a cut point, about.
const CELLS_PER_CUT: usize = 4;

/// Where the searches for numbers between two cut points begin and end. There are a power of two and one of them, so that no
/// product rounds.
fn guide(cells: &[Cell]) -> Vec<u32> {
    let cuts = (cells.len() / CELLS_PER_CUT).next_power_of_two().min(1 << 24);
    let mut count = 0;
    let at_most = |cut: f32| {
        while cells.get(count).is_some_and(|cell| cell.before <= cut) {
            count += 1;
        }
        count as u32
    };
    (0..=cuts).map(|k| k as f32 / cuts as f32).map(at_most).collect()
}

impl Distribution1D {
    /// From weights, one a cell; what is negative, NaN or infinite counts as zero. Uniform when all are zero;
    /// `None` when there is none.
    pub fn new(weights: &[f32]) -> Option<Self> {
        if weights.is_empty() {
            return None;
        }
        let usable = |w: f32| if w > 0.0 && w.is_finite() { f64::from(w) } else { 0.0 };
        let total: f64 = weights.iter().map(|&w| usable(w)).sum();
        let weight = |w: f32| if total > 0.0 { usable(w) } else { 1.0 };
        let sum = if total > 0.0 { total } else { weights.len() as f64 };
        // Rounding must leave no gap below 1, and no sample for the empty cells at the end.
        let last = weights.iter().rposition(|&w| weight(w) > 0.0).unwrap_or(0);
        let mut running = 0.0;
        let cell = |(i, &w): (usize, &f32)| {
            let before = if i > last { 1.0 } else { (running / sum).min(1.0) as f32 };
            running += weight(w);
            Cell { before, density: (weight(w) * weights.len() as f64 / sum) as f32 }
        };
        let mut cells: Vec<Cell> = weights.iter().enumerate().map(cell).collect();
        cells.push(Cell { before: 1.0, density: 0.0 });
        Some(Self { guide: guide(&cells), cells, mean: (total / weights.len() as f64) as f32 })
    }

    /// Mean of the weights.
    pub fn mean(&self) -> f32 {
        self.mean
    }

    /// Cells.
    pub fn len(&self) -> usize {
        self.cells.len() - 1
    }

    /// Never: there is at least one cell.
    pub fn is_empty(&self) -> bool {
        false
    }

    /// A place in [0, 1), its density and its cell.
    pub fn sample(&self, u: f32) -> (f32, f32, usize) {
        let cell = self.at_most(u).clamp(1, self.len()) - 1;
        let (Cell { before: low, density }, high) = (self.cells[cell], self.cells[cell + 1].before);
        let inside = if high > low { ((u - low) / (high - low)).min(1f32.next_down()) } else { 0.5 };
        let mut x = ((cell as f32 + inside) / self.len() as f32).min(1f32.next_down());
        // Rounding at a border must not carry the place into the next cell, which may be empty.
        while self.cell(x) < cell {
            x = x.next_up();
        }
        while self.cell(x) > cell {
            x = x.next_down();
        }
        (x, density, cell)
    }

    /// How many cells have at most `u` in [0, 1) before them.
    fn at_most(&self, u: f32) -> usize {
        let cuts = self.guide.len() - 1;
        let cut = ((u * cuts as f32) as usize).min(cuts - 1);
        let (from, to) = (self.guide[cut] as usize, self.guide[cut + 1] as usize);
        from + self.cells[from..to].partition_point(|cell| cell.before <= u)
    }

    /// Density at `x` in [0, 1).
    pub fn pdf(&self, x: f32) -> f32 {
        self.cells[self.cell(x)].density
    }

    /// The chance of a cell, to pick one of a list; 0 for a cell that there is not.
    pub fn probability(&self, cell: usize) -> f32 {
        self.cells.get(cell).map_or(0.0, |cell| cell.density / self.len() as f32)
    }

    fn cell(&self, x: f32) -> usize {
        ((x * self.len() as f32) as usize).min(self.len() - 1)
    }
}

/// A density over the unit square, constant in the cells of a grid.
#[derive(Clone, Debug, PartialEq)]
pub struct Distribution2D {
    /// Density along x, given the row.
    rows: Vec<Distribution1D>,
    /// Density of the rows.
    marginal: Distribution1D,
}

impl Distribution2D {
    /// From weights, row by row; `None` when they are not `width` times a whole number above zero.
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

    /// A place in the unit square and its density per unit area.
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

    /// One in a thousand for all tests of this file together.
    const SIGNIFICANCE: f64 = 1e-3 / 3.0;

    #[test]
    fn samples_follow_the_weights_and_never_hit_empty_cells() {
        let weights = [0.0, 3.0, 0.0, f32::NAN, 1.0, 0.5, -2.0, 5.5, 0.0, 0.0];
        let distribution = Distribution1D::new(&weights).unwrap();
        let mut random = Random::new(31);
        let mut observed = [0.0; 10];
        for i in 0..1_000_000 {
            // The ends of the range are where rounding would leak.
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
    fn cut_points_find_what_a_search_of_all_finds() {
        let mut random = Random::new(35);
        for cells in [1, 2, 3, 7, 64, 1000, 4099] {
            let weights: Vec<f32> =
                (0..cells).map(|_| if random.f32() < 0.3 { 0.0 } else { random.f32().powi(9) }).collect();
            let distribution = Distribution1D::new(&weights).unwrap();
            let cuts = (distribution.guide.len() - 1) as f32;
            let sums: Vec<f32> = distribution.cells.iter().map(|cell| cell.before).collect();
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
    fn no_weight_at_all_is_uniform_and_wrong_sizes_are_refused() {
        let flat = Distribution2D::new(2, &[0.0; 8]).unwrap();
        assert_eq!(flat.sample(Vec2::new(0.3, 0.9)), (Vec2::new(0.3, 0.9), 1.0));
        assert_eq!(flat.mean(), 0.0);
        assert!(Distribution1D::new(&[]).is_none() && Distribution2D::new(3, &[1.0; 8]).is_none());
        assert!(Distribution2D::new(3, &[]).is_none() && Distribution2D::new(0, &[]).is_none());
    }

    #[test]
    fn a_single_huge_weight_among_many_small_ones() {
        let mut weights = vec![1e-6; 100_000];
        weights[77_777] = 1e6;
        let distribution = Distribution1D::new(&weights).unwrap();
        let (x, _, cell) = distribution.sample(0.5);
        assert_eq!(cell, 77_777);
        assert!((0.777_77..0.777_79).contains(&x));
    }
}
