//! Pixel filters by importance sampling: a sample belongs to one pixel and lands where the filter is large
//! (Shirley 1990; Ernst, Stamminger, Greiner 2006). Nothing is splatted, so tiles never overlap.

use juggler_math::Vec2;
use std::sync::Arc;

mod box_filter;
mod gaussian;
mod juggler;
mod mitchell;
mod table;
mod tent;

pub use table::Table;

/// Where a sample goes, and what it counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilterSample {
    /// From the pixel's centre, in pixels; y down.
    pub offset: Vec2,
    /// Factor on what it brings; 1 on average. Negative in the lobes of Mitchell's filter.
    pub weight: f32,
}

/// A filter ready to sample.
#[derive(Clone, Debug, PartialEq)]
pub enum Filter {
    /// Even over one pixel.
    Box,
    /// A tent of this radius in pixels.
    Tent(f32),
    /// Tabulated, the same along x and y.
    Table(Arc<Table>),
    /// The Juggler's own scatter for a grid of this many cells along an edge.
    Juggler(u32),
}

impl Filter {
    /// The place and weight of a sample for `u` in [0, 1)².
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

/// A filter as the scene describes it.
pub trait Reconstruction: Send + Sync {
    /// The filter for pictures of `samples` samples a pixel.
    fn filter(&self, samples: u32) -> Filter;
}

juggler_math::closed_set! {
    /// Every filter. In JSON: `{"gaussian": {"radius": 1.5}}`, or short `"box"`.
    pub enum AnyFilter: Reconstruction {
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

    /// Mean of a function of the offset under the filter, by a fine grid of `u`.
    fn mean(filter: &Filter, f: impl Fn(Vec2) -> f64) -> f64 {
        let n = 512;
        let mut sum = 0.0;
        for i in 0..n * n {
            // Jittered, or the steps of a signed filter's weights would show.
            let jitter = [i, i + n * n].map(|i| hash::unit_f32(hash::mix(i as u32)));
            let u = (Vec2::new((i % n) as f32, (i / n) as f32) + Vec2::from(jitter)) / n as f32;
            let sample = filter.sample(u);
            sum += f(sample.offset) * f64::from(sample.weight);
        }
        sum / f64::from(n * n)
    }

    #[test]
    fn filters_are_normalised_centred_and_as_wide_as_they_say() {
        // Second moments: box 1/12, tent r²/6, Mitchell by its integral, Gaussian (truncated) below σ².
        let cases: [(AnyFilter, f64, f64); 4] = [
            (Box {}.into(), 1.0 / 12.0, 1e-5),
            (Tent { radius: 1.0 }.into(), 1.0 / 6.0, 1e-4),
            (Mitchell::default().into(), mitchell_moment(), 2e-3),
            (Gaussian { radius: 4.0, sigma: 0.5 }.into(), 0.25, 1e-3),
        ];
        for (description, variance, tolerance) in cases {
            let filter = description.filter(64);
            let total = mean(&filter, |_| 1.0);
            assert!((total - 1.0).abs() < 1e-3, "{description:?}: weights must average 1, not {total}");
            assert!(mean(&filter, |o| f64::from(o.x)).abs() < 1e-3, "{description:?}: centred");
            let measured = mean(&filter, |o| f64::from(o.y) * f64::from(o.y));
            assert!((measured - variance).abs() < tolerance, "{description:?}: {measured} for {variance}");
        }
    }

    /// ∫ x² f(x) dx of Mitchell's filter with B = C = 1/3, by a fine sum.
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
        let filter = Juggler {}.filter(64);
        let (mut low, mut high) = (Vec2::MAX, Vec2::MIN);
        for i in 0..64 * 64 {
            let offset = filter.sample(Vec2::new((i % 64) as f32, (i / 64) as f32) / 64.0 + 0.5 / 64.0).offset;
            low = low.min(offset);
            high = high.max(offset);
        }
        // From the pixel's corner it is [0, 2 − 1/n); from its centre half a pixel less.
        assert!(low.x >= -0.5 && low.x < -0.4 && high.y < 1.5 - 0.125 && high.y > 1.2, "{low} {high}");
    }
}
