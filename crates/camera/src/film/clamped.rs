//! What clamping took off a picture: an exact sum, whoever adds what first.

use std::iter::Sum;

/// Steps of 1: fine beside all that shows, and coarse enough for 2^32 pixels of [`MOST`].
const STEPS: f64 = (1u64 << 48) as f64;
/// The most that a pixel counts.
const MOST: f64 = (1u64 << 40) as f64;

/// What clamping took off some pixels, each by the mean of its channels: a sum in whole steps of 2^-48, which comes out the
/// same in any order. A pixel that lost more than 2^40 counts as that.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Clamped {
    steps: i128,
}

impl Clamped {
    /// Takes in what one pixel lost. Filters that sharpen may make that less than nothing.
    pub fn add(&mut self, lost: f64) {
        if lost != 0.0 {
            self.steps += (lost.clamp(-MOST, MOST) * STEPS).round() as i128;
        }
    }

    /// Takes in what other pixels lost.
    pub fn add_all(&mut self, other: Self) {
        self.steps += other.steps;
    }

    /// The sum.
    pub fn total(&self) -> f64 {
        self.steps as f64 / STEPS
    }
}

impl Sum for Clamped {
    fn sum<I: Iterator<Item = Self>>(parts: I) -> Self {
        Self { steps: parts.map(|part| part.steps).sum() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sum_is_the_same_in_any_order() {
        let lost: Vec<f64> = (0..1000).map(|i: i32| f64::from(i * i % 97) * 0.1f64.powi(i % 7 - 3)).collect();
        let sum = |lost: &mut dyn Iterator<Item = &f64>| {
            let mut clamped = Clamped::default();
            lost.for_each(|lost| clamped.add(*lost));
            clamped
        };
        let whole = sum(&mut lost.iter());
        assert_eq!(whole, sum(&mut lost.iter().rev()));
        assert_eq!(whole, [sum(&mut lost[..300].iter()), sum(&mut lost[300..].iter())].into_iter().sum());
        assert!((whole.total() / lost.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        let mut extreme = Clamped::default();
        [f64::INFINITY, f64::NAN, -1.0].iter().for_each(|lost| extreme.add(*lost));
        assert_eq!(extreme.total(), MOST - 1.0);
    }
}
