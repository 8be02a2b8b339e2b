//! Detection of outlier pixels by more than the known noise explains.
//!
//! The neighborhood is 5 x 5 pixels. Its center is the median, and its spread the median absolute
//! deviation times 1.4826, which is the standard deviation of a normal distribution (Hampel 1974).
//! Both are robust against outliers among the neighbors.

use juggler_camera::film::PixelStatistics;

/// Radius of the neighborhood, in pixels.
const RADIUS: usize = 2;
/// Ratio of the standard deviation to the median absolute deviation of a normal distribution.
const MAD_TO_SIGMA: f64 = 1.4826;
/// Threshold of the score, in robust standard deviations.
const THRESHOLD: f64 = 6.0;
/// Lower bounds of the spread, as fractions of the median and of the image's mean, which exclude
/// invisible outliers.
const LEAST_OF_MEDIAN: f64 = 0.05;
const LEAST_OF_MEAN: f64 = 0.01;
/// One pixel of this many is excluded from the mean as one of the brightest.
const BRIGHTEST: usize = 50;
/// Number of its own standard errors from which the excess of a pixel is certain, so that it is no
/// firefly: light from one sample of many has an error as large as itself.
const CERTAIN_ERRORS: f64 = 5.0;

/// Luminance of an image's pixels.
pub struct LuminanceImage {
    pub width: usize,
    pub height: usize,
    /// Luminance, row by row.
    pub values: Vec<f64>,
    /// Standard error of each pixel, where known.
    pub errors: Vec<Option<f64>>,
}

/// Outlier pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outlier {
    /// Index of the pixel.
    pub place: usize,
    /// Median of the neighborhood.
    pub median: f64,
    /// Excess over the median.
    pub excess: f64,
    /// Excess, in robust standard deviations.
    pub score: f64,
}

/// Outliers of an image.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outliers {
    /// Outliers that noise explains, by decreasing score.
    pub outliers: Vec<Outlier>,
    /// Number of outliers beyond noise.
    pub certain: usize,
}

/// Returns an upper bound of the standard error of a pixel's luminance, reached if the channels are
/// fully correlated.
pub fn error(statistics: &PixelStatistics) -> Option<f64> {
    (statistics.blocks >= 2).then(|| super::luminance(statistics.variance.map(|variance| variance.max(0.0).sqrt())))
}

impl LuminanceImage {
    /// Finds all outliers.
    pub fn outliers(&self) -> Outliers {
        let mean = self.usual_mean();
        let mut found = Outliers::default();
        for place in 0..self.values.len() {
            let Some(outlier) = self.outlier(place, mean) else { continue };
            let is_certain =
                self.errors.get(place).copied().flatten().is_some_and(|error| outlier.excess > CERTAIN_ERRORS * error);
            if is_certain {
                found.certain += 1;
            } else {
                found.outliers.push(outlier);
            }
        }
        found.outliers.sort_by(|a, b| b.score.total_cmp(&a.score).then(a.place.cmp(&b.place)));
        found
    }

    /// Returns the mean without the brightest pixels, which outliers would dominate.
    fn usual_mean(&self) -> f64 {
        let mut finite: Vec<f64> = self.values.iter().copied().filter(|value| value.is_finite()).collect();
        finite.sort_by(f64::total_cmp);
        let usual = finite.get(..finite.len() - finite.len() / BRIGHTEST).unwrap_or_default();
        usual.iter().sum::<f64>() / usual.len().max(1) as f64
    }

    fn outlier(&self, place: usize, mean: f64) -> Option<Outlier> {
        let value = *self.values.get(place)?;
        // Compute median and robust spread of the neighborhood
        let mut neighborhood = self.neighborhood(place);
        let median = median(&mut neighborhood)?;
        let mut distances: Vec<f64> = neighborhood.iter().map(|other| (other - median).abs()).collect();
        let spread = MAD_TO_SIGMA * self::median(&mut distances)?;
        // Bound the spread from below and score the excess
        let floor = LEAST_OF_MEDIAN * median.abs() + LEAST_OF_MEAN * mean.abs();
        let excess = value - median;
        let score = excess / (spread + floor);
        (score > THRESHOLD).then_some(Outlier { place, median, excess, score })
    }

    fn neighborhood(&self, place: usize) -> Vec<f64> {
        let (x, y) = (place % self.width.max(1), place / self.width.max(1));
        let range = |at: usize, end: usize| at.saturating_sub(RADIUS)..(at + RADIUS + 1).min(end);
        let rows = range(y, self.height);
        let places = rows.flat_map(|row| range(x, self.width).map(move |column| row * self.width + column));
        places.filter(|other| *other != place).filter_map(|other| self.values.get(other).copied()).collect()
    }
}

/// Returns the median; for an even count the mean of both middle values.
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

    fn image(value: impl Fn(usize, usize) -> f64) -> LuminanceImage {
        let (width, height) = (40, 30);
        let values = (0..width * height).map(|place| value(place % width, place / width)).collect();
        LuminanceImage { width, height, values, errors: vec![None; width * height] }
    }

    #[test]
    fn fireflies_are_outliers_but_noise_and_edges_are_not() {
        let mut random = Random::new(5);
        let mut noise = || 1.0 + 0.2 * f64::from(random.vec2().element_sum() - 1.0);
        let noise: Vec<f64> = (0..1200).map(|_| noise()).collect();
        let edge = |x: usize| if x < 17 { 4.0 } else { 1.0 };
        let mut image = image(|x, y| edge(x) * noise[y * 40 + x]);
        assert_eq!(image.outliers(), Outliers::default());
        for (place, value) in [(5 * 40 + 30, 9.0), (0, 40.0), (29 * 40 + 39, 1e-9), (12 * 40 + 31, 3e5)] {
            image.values[place] = value;
        }
        let found: Vec<usize> = image.outliers().outliers.iter().map(|outlier| outlier.place).collect();
        assert_eq!(found, [12 * 40 + 31, 0, 5 * 40 + 30]);
        // Pixels with an excess beyond noise are counted apart.
        image.errors[0] = Some(0.5);
        image.errors[12 * 40 + 31] = Some(3e5);
        let found = image.outliers();
        assert_eq!((found.outliers.len(), found.certain), (2, 1));
        assert!((found.outliers[0].excess - 3e5).abs() < 2.0);
    }

    #[test]
    fn the_smallest_pictures_have_no_neighbors() {
        let one = LuminanceImage { width: 1, height: 1, values: vec![3.0], errors: vec![None] };
        assert_eq!(one.outliers(), Outliers::default());
        let line = image(|x, _| if (2..5).contains(&x) { 1e-12 } else { 0.0 });
        assert_eq!(line.outliers().outliers.len(), 0, "a broad line is its own neighbor");
        assert_eq!(image(|_, _| f64::NAN).outliers(), Outliers::default());
        assert_eq!(median(&mut [3.0, 1.0, 2.0, 10.0]), Some(2.5));
    }
}
