//! Separable convolution; pixels beyond the border repeat the border's.

use juggler_math::portable;

/// One channel of an image, row by row.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Plane {
    /// Width in pixels.
    pub width: usize,
    /// Values of all pixels.
    pub values: Vec<f32>,
}

/// Odd number of convolution weights, centered on the pixel.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Kernel(Vec<f32>);

impl Kernel {
    /// Samples `weight` at distances from -`radius` to `radius` pixels. Positive weights are
    /// normalized to sum to 1, negative weights to -1.
    pub fn new(radius: i32, weight: impl Fn(f64) -> f64) -> Self {
        let weights: Vec<f64> = (-radius..=radius).map(|at| weight(f64::from(at))).collect();
        let sum = |sign: f64| weights.iter().map(|w| (w * sign).max(0.0)).sum::<f64>();
        let (above, below) = (sum(1.0), sum(-1.0));
        let scaled = |w: f64| {
            if w < 0.0 {
                w / below
            } else if w > 0.0 {
                w / above
            } else {
                0.0
            }
        };
        Self(weights.into_iter().map(|w| scaled(w) as f32).collect())
    }

    /// Removes outer weights too small to matter in single precision.
    pub fn trimmed(mut self) -> Self {
        while self.0.len() > 1 && self.0[0].abs().max(self.0[self.0.len() - 1].abs()) < 1e-8 {
            self.0.pop();
            self.0.remove(0);
        }
        self
    }
}

impl Plane {
    /// Convolves along rows, then along columns.
    pub fn filtered(&self, along_rows: &Kernel, along_columns: &Kernel) -> Self {
        self.rows(along_rows).columns(along_columns)
    }

    /// Convolves along rows.
    pub fn rows(&self, Kernel(weights): &Kernel) -> Self {
        let radius = weights.len() / 2;
        let mut values = vec![0.0; self.values.len()];
        let mut padded = Vec::with_capacity(self.width + 2 * radius);
        let rows = self.values.chunks_exact(self.width.max(1));
        for (row, out) in rows.zip(values.chunks_exact_mut(self.width.max(1))) {
            let (Some(first), Some(last)) = (row.first(), row.last()) else { continue };
            padded.clear();
            padded.resize(radius, *first);
            padded.extend_from_slice(row);
            padded.resize(self.width + 2 * radius, *last);
            for (window, weight) in padded.windows(self.width).zip(weights) {
                out.iter_mut().zip(window).for_each(|(sum, v)| *sum += weight * v);
            }
        }
        Self { width: self.width, values }
    }

    /// Convolves along columns.
    pub fn columns(&self, Kernel(weights): &Kernel) -> Self {
        let (radius, width) = (weights.len() / 2, self.width.max(1));
        let rows: Vec<&[f32]> = self.values.chunks_exact(width).collect();
        let mut values = vec![0.0; self.values.len()];
        for (y, out) in values.chunks_exact_mut(width).enumerate() {
            for (k, weight) in weights.iter().enumerate() {
                let place = (y + k).saturating_sub(radius).min(rows.len() - 1);
                out.iter_mut().zip(rows[place]).for_each(|(sum, v)| *sum += weight * v);
            }
        }
        Self { width: self.width, values }
    }
}

/// Gaussian exp(-t² / (2 s²)), where s is the standard deviation.
pub(super) fn gaussian(t: f64, deviation: f64) -> f64 {
    portable::exp_f64(-t * t / (2.0 * deviation * deviation))
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::testing::Random;

    #[test]
    fn filtering_equals_the_sum_over_all_neighbors() {
        let (width, height) = (7, 5);
        let mut random = Random::new(4);
        let plane = Plane { width, values: (0..width * height).map(|_| random.range(-1.0, 1.0)).collect() };
        let (a, b) = (Kernel::new(3, |t| gaussian(t, 1.5)), Kernel::new(2, |t| -t * gaussian(t, 1.0)));
        let found = plane.filtered(&a, &b);
        for (y, x) in (0..5_i32).flat_map(|y| (0..7_i32).map(move |x| (y, x))) {
            let mut sum = 0.0;
            for (j, v) in b.0.iter().enumerate() {
                for (i, h) in a.0.iter().enumerate() {
                    let (row, column) = ((y + j as i32 - 2).clamp(0, 4), (x + i as i32 - 3).clamp(0, 6));
                    sum += h * v * plane.values[(row * 7 + column) as usize];
                }
            }
            assert!((found.values[(y * 7 + x) as usize] - sum).abs() < 1e-5);
        }
    }

    #[test]
    fn kernels_are_normalized_by_sign() {
        let Kernel(edge) = Kernel::new(4, |t| -t * gaussian(t, 2.0));
        let positive: f32 = edge.iter().filter(|w| **w > 0.0).sum();
        assert!((positive - 1.0).abs() < 1e-6 && edge.iter().sum::<f32>().abs() < 1e-6 && edge[4] == 0.0);
        let Kernel(trimmed) = Kernel::new(30, |t| gaussian(t, 1.0)).trimmed();
        assert!(trimmed.len() < 15 && (trimmed.iter().sum::<f32>() - 1.0).abs() < 1e-6);
    }
}
