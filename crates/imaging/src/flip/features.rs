//! Feature pipeline of FLIP (2020, section 4.2): edges and points of the luminance, detected by
//! first and second derivatives of a Gaussian whose width matches human edge detection.

use super::filter::{Kernel, Plane, gaussian};
use juggler_math::portable;

/// Width of the detectors in degrees.
const WIDTH: f64 = 0.082;

/// Kernels of the edge and point detectors.
pub(super) struct FeatureFilters {
    smooth: Kernel,
    edge: Kernel,
    point: Kernel,
}

impl FeatureFilters {
    pub fn new(pixels_per_degree: f64) -> Self {
        let deviation = 0.5 * WIDTH * pixels_per_degree;
        let radius = portable::floor_f64(3.0 * deviation) as i32 + 1;
        let kernel = |weight: &dyn Fn(f64) -> f64| Kernel::new(radius, |t| weight(t) * gaussian(t, deviation));
        let squared = deviation * deviation;
        Self { smooth: kernel(&|_| 1.0), edge: kernel(&|t| -t), point: kernel(&|t| t * t / squared - 1.0) }
    }

    /// Feature differences of all pixels, 0 to 1 (equation 16): the larger of edge and point
    /// difference.
    pub fn differences(&self, picture: &Plane, reference: &Plane) -> Vec<f32> {
        let [picture, reference] = [picture, reference].map(|plane| self.strengths(plane));
        let difference = |(a, b): ([f32; 2], [f32; 2])| {
            let most = (a[0] - b[0]).abs().max((a[1] - b[1]).abs());
            (most * std::f32::consts::FRAC_1_SQRT_2).clamp(0.0, 1.0).sqrt()
        };
        picture.into_iter().zip(reference).map(difference).collect()
    }

    /// Edge and point strength of each pixel.
    fn strengths(&self, plane: &Plane) -> Vec<[f32; 2]> {
        let smooth = plane.rows(&self.smooth);
        let pair = |kernel: &Kernel| [plane.rows(kernel).columns(&self.smooth), smooth.columns(kernel)];
        let length = |[x, y]: &[Plane; 2]| -> Vec<f32> {
            x.values.iter().zip(&y.values).map(|(x, y)| (x * x + y * y).sqrt()).collect()
        };
        let [edges, points] = [&self.edge, &self.point].map(|kernel| length(&pair(kernel)));
        edges.into_iter().zip(points).map(|(edge, point)| [edge, point]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn feature_detector_finds_edges_and_ignores_flat_regions() {
        let filters = FeatureFilters::new(67.0);
        let step = Plane { width: 40, values: (0..1600).map(|i| if i % 40 < 20 { 0.0 } else { 1.0 }).collect() };
        let flat = Plane { width: 40, values: vec![0.7; 1600] };
        let found = filters.strengths(&step);
        // Half of the kernel's weight lies on either side of the edge.
        let row = &found[20 * 40..21 * 40];
        let strongest = row.iter().map(|v| v[0]).fold(0.0, f32::max);
        assert!(strongest > 0.9 && strongest <= 1.0 && row[0][0] < 1e-5 && row[39][0] < 1e-5, "{strongest}");
        assert!(filters.strengths(&flat).iter().flatten().all(|v| *v < 1e-6));
        assert!(filters.differences(&step, &step).iter().all(|v| *v == 0.0));
    }
}
