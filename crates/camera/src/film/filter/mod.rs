//! Reconstruction filters by importance sampling: each sample contributes to one pixel, at an
//! offset distributed like the filter (Shirley 1990; Ernst, Stamminger, Greiner 2006). There is no
//! splatting, so tiles never overlap.

use juggler_math::Vec2;
use std::sync::Arc;

mod box_filter;
mod filter_table;
mod gaussian;
mod juggler;
mod mitchell;
mod tent;

pub use filter_table::FilterTable;

/// Offset and weight of a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilterSample {
    /// Offset from the pixel's center in pixels; y down.
    pub offset: Vec2,
    /// Factor on the sample's radiance, 1 on average; negative in the lobes of Mitchell's filter.
    pub weight: f32,
}

/// Filter ready for sampling.
#[derive(Clone, Debug, PartialEq)]
pub enum FilterSampler {
    /// Uniform over one pixel.
    Box,
    /// Tent with this radius in pixels.
    Tent(f32),
    /// Table of a separable filter, the same along x and y.
    Table(Arc<FilterTable>),
    /// The Juggler's jitter for a grid of this many cells along an edge.
    Juggler(u32),
}

impl FilterSampler {
    /// Samples an offset and its weight with `u` in [0, 1)².
    #[inline]
    pub fn sample(&self, u: Vec2) -> FilterSample {
        match self {
            Self::Box => FilterSample { offset: u - 0.5, weight: 1.0 },
            Self::Tent(radius) => FilterSample { offset: tent::warp(u) * *radius, weight: 1.0 },
            Self::Table(table) => table.sample(u),
            Self::Juggler(side) => FilterSample { offset: juggler::warp(u, *side), weight: 1.0 },
        }
    }
}

/// Filter as the scene describes it.
pub trait ReconstructionFilter: Send + Sync {
    /// Filter for pictures with `samples` samples per pixel.
    fn sampler(&self, samples: u32) -> FilterSampler;
}

juggler_math::closed_set! {
    /// Reconstruction filter of any kind. In JSON: `{"gaussian": {"radius": 1.5}}`, or short
    /// `"box"`.
    pub enum AnyFilter: ReconstructionFilter {
        box_filter::Box, tent::Tent, gaussian::Gaussian, mitchell::Mitchell, juggler::Juggler,
    }
}

impl Default for AnyFilter {
    fn default() -> Self {
        Box {}.into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::hash;

    /// Mean of a function of the offset under the filter, on a fine grid of `u`.
    fn mean(filter: &FilterSampler, f: impl Fn(Vec2) -> f64) -> f64 {
        let n = 512;
        let mut sum = 0.0;
        for i in 0..n * n {
            // Jitter hides the steps in the weights of a signed filter.
            let jitter = [i, i + n * n].map(|i| hash::unit_f32(hash::mix(i as u32)));
            let u = (Vec2::new((i % n) as f32, (i / n) as f32) + Vec2::from(jitter)) / n as f32;
            let sample = filter.sample(u);
            sum += f(sample.offset) * f64::from(sample.weight);
        }
        sum / f64::from(n * n)
    }

    #[test]
    fn filters_are_normalized_centered_and_as_wide_as_they_say() {
        // Second moments: box 1/12, tent r²/6, Mitchell by its integral, Gaussian (truncated) below
        // σ².
        let cases: [(AnyFilter, f64, f64); 4] = [
            (Box {}.into(), 1.0 / 12.0, 1e-5),
            (Tent { radius: 1.0 }.into(), 1.0 / 6.0, 1e-4),
            (Mitchell::default().into(), mitchell_moment(), 2e-3),
            (Gaussian { radius: 4.0, sigma: 0.5 }.into(), 0.25, 1e-3),
        ];
        for (description, variance, tolerance) in cases {
            let filter = description.sampler(64);
            let total = mean(&filter, |_| 1.0);
            assert!((total - 1.0).abs() < 1e-3, "{description:?}: weights must average 1, not {total}");
            assert!(mean(&filter, |o| f64::from(o.x)).abs() < 1e-3, "{description:?}: centered");
            let measured = mean(&filter, |o| f64::from(o.y) * f64::from(o.y));
            assert!((measured - variance).abs() < tolerance, "{description:?}: {measured} for {variance}");
        }
    }

    /// ∫ x² f(x) dx for Mitchell's filter with B = C = 1/3, by a fine sum.
    fn mitchell_moment() -> f64 {
        let n = 100_000;
        let step = 4.0 / f64::from(n);
        (0..n)
            .map(|i| -2.0 + (f64::from(i) + 0.5) * step)
            .map(|x| x * x * f64::from(mitchell::value(x as f32, 1.0 / 3.0, 1.0 / 3.0)) * step)
            .sum()
    }

    #[test]
    fn the_jugglers_scatter_covers_two_pixels_from_the_corner() {
        let filter = Juggler {}.sampler(64);
        let (mut low, mut high) = (Vec2::MAX, Vec2::MIN);
        for i in 0..64 * 64 {
            let offset = filter.sample(Vec2::new((i % 64) as f32, (i / 64) as f32) / 64.0 + 0.5 / 64.0).offset;
            low = low.min(offset);
            high = high.max(offset);
        }
        // Relative to the pixel's corner the range is [0, 2 − 1/n); relative to its center, half a
        // pixel less.
        assert!(low.x >= -0.5 && low.x < -0.4 && high.y < 1.5 - 0.125 && high.y > 1.2, "{low} {high}");
    }
}
