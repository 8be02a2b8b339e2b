//! Pixels that stand out from what is around them, by more than noise that is known of explains.
//!
//! Around a pixel are those of 5 × 5 that are its neighbours: their median, and as their spread the median of the distances to it,
//! times 1.4826, which is the standard deviation where they are normally distributed (Hampel 1974). Both do not mind what stands out
//! among the neighbours themselves.

use juggler_camera::film::Statistics;

/// Pixels to each side that count as neighbours.
const REACH: usize = 2;
/// From the median distance to a standard deviation.
const NORMAL: f64 = 1.4826;
/// By how many spreads a pixel stands out.
const SPREADS: f64 = 6.0;
/// Shares of the median, and of the picture's mean, that count as spread at least: what nobody sees does not stand out.
const LEAST_OF_MEDIAN: f64 = 0.05;
const LEAST_OF_MEAN: f64 = 0.01;
/// One of so many is among the brightest.
const BRIGHTEST: usize = 50;
/// A pixel that is brighter than its neighbours by more than so many of its own standard errors is bright by what it shows: light that
/// hangs on one sample of many has an error as large as itself.
const SURE: f64 = 5.0;

/// Light of the pixels of a picture.
pub struct Field {
    pub width: usize,
    pub height: usize,
    /// Luminance, row by row.
    pub values: Vec<f64>,
    /// Standard error of each, where it is known.
    pub errors: Vec<Option<f64>>,
}

/// A pixel that stands out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outlier {
    /// Its place in the field.
    pub place: usize,
    /// Median of what is around it.
    pub median: f64,
    /// What it has beyond that.
    pub excess: f64,
    /// By how many spreads it stands out.
    pub score: f64,
}

/// What stands out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Found {
    /// By chance: those that stand out most first.
    pub outliers: Vec<Outlier>,
    /// How many are bright by what they show.
    pub sure: usize,
}

/// Standard error of a pixel's luminance where its channels err together, the most that it can be.
pub fn error(statistics: &Statistics) -> Option<f64> {
    (statistics.blocks >= 2).then(|| super::luminance(statistics.variance.map(|variance| variance.max(0.0).sqrt())))
}

impl Field {
    /// All pixels that stand out.
    pub fn outliers(&self) -> Found {
        let mean = self.usual_mean();
        let mut found = Found::default();
        for place in 0..self.values.len() {
            let Some(outlier) = self.outlier(place, mean) else { continue };
            let is_sure = self.errors.get(place).copied().flatten().is_some_and(|error| outlier.excess > SURE * error);
            if is_sure {
                found.sure += 1;
            } else {
                found.outliers.push(outlier);
            }
        }
        found.outliers.sort_by(|a, b| b.score.total_cmp(&a.score).then(a.place.cmp(&b.place)));
        found
    }

    /// Mean of all but the brightest, which outliers would decide.
    fn usual_mean(&self) -> f64 {
        let mut finite: Vec<f64> = self.values.iter().copied().filter(|value| value.is_finite()).collect();
        finite.sort_by(f64::total_cmp);
        let usual = finite.get(..finite.len() - finite.len() / BRIGHTEST).unwrap_or_default();
        usual.iter().sum::<f64>() / usual.len().max(1) as f64
    }

    fn outlier(&self, place: usize, mean: f64) -> Option<Outlier> {
        let value = *self.values.get(place)?;
        let mut around = self.around(place);
        let median = median(&mut around)?;
        let mut distances: Vec<f64> = around.iter().map(|other| (other - median).abs()).collect();
        let spread = NORMAL * self::median(&mut distances)?;
        let least = LEAST_OF_MEDIAN * median.abs() + LEAST_OF_MEAN * mean.abs();
        let excess = value - median;
        let score = excess / (spread + least);
        (score > SPREADS).then_some(Outlier { place, median, excess, score })
    }

    fn around(&self, place: usize) -> Vec<f64> {
        let (x, y) = (place % self.width.max(1), place / self.width.max(1));
        let range = |at: usize, end: usize| at.saturating_sub(REACH)..(at + REACH + 1).min(end);
        let rows = range(y, self.height);
        let places = rows.flat_map(|row| range(x, self.width).map(move |column| row * self.width + column));
        places.filter(|other| *other != place).filter_map(|other| self.values.get(other).copied()).collect()
    }
}

/// The middle one; of an even number the mean of both.
fn median(values: &mut [f64]) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    let upper = *values.get(middle)?;
    Some(if values.len() % 2 == 1 { upper } else { (upper + *values.get(middle.checked_sub(1)?)?) / 2.0 })
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::testing::Random;

    fn field(value: impl Fn(usize, usize) -> f64) -> Field {
        let (width, height) = (40, 30);
        let values = (0..width * height).map(|place| value(place % width, place / width)).collect();
        Field { width, height, values, errors: vec![None; width * height] }
    }

    #[test]
    fn noise_and_edges_do_not_stand_out_and_specks_do() {
        let mut random = Random::new(5);
        let mut noise = || 1.0 + 0.2 * f64::from(random.vec2().element_sum() - 1.0);
        let noise: Vec<f64> = (0..1200).map(|_| noise()).collect();
        let edge = |x: usize| if x < 17 { 4.0 } else { 1.0 };
        let mut field = field(|x, y| edge(x) * noise[y * 40 + x]);
        assert_eq!(field.outliers(), Found::default());
        for (place, value) in [(5 * 40 + 30, 9.0), (0, 40.0), (29 * 40 + 39, 1e-9), (12 * 40 + 31, 3e5)] {
            field.values[place] = value;
        }
        let found: Vec<usize> = field.outliers().outliers.iter().map(|outlier| outlier.place).collect();
        assert_eq!(found, [12 * 40 + 31, 0, 5 * 40 + 30]);
        // What is known for sure is left out.
        field.errors[0] = Some(0.5);
        field.errors[12 * 40 + 31] = Some(3e5);
        let found = field.outliers();
        assert_eq!((found.outliers.len(), found.sure), (2, 1));
        assert!((found.outliers[0].excess - 3e5).abs() < 2.0);
    }

    #[test]
    fn the_smallest_pictures_have_no_neighbours() {
        let one = Field { width: 1, height: 1, values: vec![3.0], errors: vec![None] };
        assert_eq!(one.outliers(), Found::default());
        let line = field(|x, _| if (2..5).contains(&x) { 1e-12 } else { 0.0 });
        assert_eq!(line.outliers().outliers.len(), 0, "a broad line is its own neighbour");
        assert_eq!(field(|_, _| f64::NAN).outliers(), Found::default());
        assert_eq!(median(&mut [3.0, 1.0, 2.0, 10.0]), Some(2.5));
    }
}
