//! Separable filter as a table: cells are sampled by absolute value, and weights carry sign and
//! normalization.

use super::FilterSample;
use juggler_math::Vec2;

const CELLS: usize = 256;

/// Table of one axis of a separable filter.
#[derive(Clone, Debug, PartialEq)]
pub struct FilterTable {
    radius: f32,
    /// CDF at the upper edge of each cell.
    cumulative: [f32; CELLS],
    /// Filter value divided by density in each cell.
    weight: [f32; CELLS],
}

impl FilterTable {
    /// Creates a table of a filter along one axis, on [−radius, radius] in pixels.
    pub fn new(radius: f32, value: impl Fn(f32) -> f32) -> Self {
        let width = 2.0 * radius / CELLS as f32;
        let values: [f32; CELLS] = std::array::from_fn(|i| value(-radius + (i as f32 + 0.5) * width));
        let absolute: f64 = values.iter().map(|v| f64::from(v.abs())).sum();
        let signed: f64 = values.iter().map(|v| f64::from(*v)).sum();
        let (mut cumulative, mut weight) = ([1.0; CELLS], [0.0; CELLS]);
        let mut sum = 0.0;
        for i in 0..CELLS {
            sum += f64::from(values[i].abs());
            cumulative[i] = (sum / absolute) as f32;
            weight[i] = (absolute / signed) as f32 * if values[i] < 0.0 { -1.0 } else { 1.0 };
        }
        Self { radius, cumulative, weight }
    }

    /// Samples an offset on both axes.
    pub fn sample(&self, u: Vec2) -> FilterSample {
        let (x, wx) = self.sample_axis(u.x);
        let (y, wy) = self.sample_axis(u.y);
        FilterSample { offset: Vec2::new(x, y), weight: wx * wy }
    }

    fn sample_axis(&self, u: f32) -> (f32, f32) {
        let cell = self.cumulative.partition_point(|c| *c <= u).min(CELLS - 1);
        let below = if cell == 0 { 0.0 } else { self.cumulative[cell - 1] };
        let probability = self.cumulative[cell] - below;
        let inside = if probability > 0.0 { ((u - below) / probability).clamp(0.0, 1.0) } else { 0.5 };
        let width = 2.0 * self.radius / CELLS as f32;
        (-self.radius + (cell as f32 + inside) * width, self.weight[cell])
    }
}
