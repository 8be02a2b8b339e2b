//! Sum of the radiance that clamping removes from a picture, exact and independent of order.

use std::iter::Sum;

/// Steps per unit of radiance: fine enough for all visible values, and coarse enough for 2^32
/// pixels of [`MAX_PER_PIXEL`].
const STEPS: f64 = (1u64 << 48) as f64;
/// Maximum contribution of a pixel.
const MAX_PER_PIXEL: f64 = (1u64 << 40) as f64;

/// Radiance that clamping removed from some pixels, as the mean of the channels: a sum in steps of
/// 2^-48, the same in any order. The contribution of a pixel is limited to 2^40.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ClampedRadiance {
    steps: i128,
}

impl ClampedRadiance {
    /// Adds the loss of one pixel, which negative lobes of a filter may make negative.
    pub fn add(&mut self, lost: f64) {
        if lost != 0.0 {
            self.steps += (lost.clamp(-MAX_PER_PIXEL, MAX_PER_PIXEL) * STEPS).round() as i128;
        }
    }

    /// Adds the loss of other pixels.
    pub fn add_all(&mut self, other: Self) {
        self.steps += other.steps;
    }

    /// Sum over all pixels.
    pub fn total(&self) -> f64 {
        self.steps as f64 / STEPS
    }
}

impl Sum for ClampedRadiance {
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
            let mut clamped = ClampedRadiance::default();
            lost.for_each(|lost| clamped.add(*lost));
            clamped
        };
        let whole = sum(&mut lost.iter());
        assert_eq!(whole, sum(&mut lost.iter().rev()));
        assert_eq!(whole, [sum(&mut lost[..300].iter()), sum(&mut lost[300..].iter())].into_iter().sum());
        assert!((whole.total() / lost.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        let mut extreme = ClampedRadiance::default();
        [f64::INFINITY, f64::NAN, -1.0].iter().for_each(|lost| extreme.add(*lost));
        assert_eq!(extreme.total(), MAX_PER_PIXEL - 1.0);
    }
}
