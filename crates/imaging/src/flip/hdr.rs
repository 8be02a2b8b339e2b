//! What HDR-FLIP (2021, sections 3 and 4) adds: exposures that go from where the brightest pixel of the reference is shown well
//! to where the median is, and the tone curve through which they are looked at.

use juggler_math::{Rgb, fun};

/// Numerator and denominator of the curve fitted to ACES (Narkowicz 2015, exposed by 0.6): a x² + b x + c each.
const CURVE: [[f32; 3]; 2] = [[0.6 * 0.6 * 2.51, 0.6 * 0.03, 0.0], [0.6 * 0.6 * 2.43, 0.6 * 0.59, 0.14]];
/// What the brightest pixel becomes at the first exposure, and the median at the last.
const SHOWN_WELL: f32 = 0.85;

/// Light after the curve, 0 to 1.
pub(super) fn tone_mapped(light: f32) -> f32 {
    let [top, bottom] = CURVE.map(|[a, b, c]| (a * light + b) * light + c);
    (top / bottom).clamp(0.0, 1.0)
}

/// Exposures in stops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Exposures {
    pub first: f32,
    pub last: f32,
    pub count: u32,
}

impl Exposures {
    /// Those that a reference asks for, by its brightest luminance and their median.
    pub fn of(reference: impl Iterator<Item = Rgb>) -> Self {
        let mut luminances: Vec<f32> = reference.map(Rgb::luminance).collect();
        let middle = luminances.len() / 2;
        let most = luminances.iter().fold(f32::EPSILON, |most, v| most.max(*v));
        let median = match luminances.is_empty() {
            true => most,
            false => luminances.select_nth_unstable_by(middle, f32::total_cmp).1.max(f32::EPSILON),
        };
        let stops = |luminance: f32| fun::log2(well_exposed() / luminance);
        let (first, last) = (stops(most), stops(median));
        Self { first, last, count: ((last - first).ceil() as u32).max(2) }
    }

    /// One after the other, at even steps.
    pub fn steps(self) -> impl Iterator<Item = f32> {
        let step = (self.last - self.first) / (self.count - 1) as f32;
        (0..self.count).map(move |i| self.first + step * i as f32)
    }
}

/// The light that the curve shows well: the larger solution of the quadratic equation.
fn well_exposed() -> f32 {
    let [top, bottom] = CURVE;
    let [a, b, c] = std::array::from_fn(|i| top[i] - SHOWN_WELL * bottom[i]);
    let half = -b / (2.0 * a);
    half + (half * half - c / a).max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_brightest_and_the_median_are_shown_well() {
        assert!((tone_mapped(well_exposed()) - 0.85).abs() < 1e-5);
        let pixels = [0.01_f32, 0.02, 0.5, 3.0, 40.0].map(Rgb::splat);
        let exposures = Exposures::of(pixels.into_iter());
        let steps: Vec<f32> = exposures.steps().collect();
        assert!((tone_mapped(40.0 * fun::exp2(steps[0])) - 0.85).abs() < 1e-4);
        assert!((tone_mapped(0.5 * fun::exp2(steps[steps.len() - 1])) - 0.85).abs() < 1e-4);
        assert_eq!(exposures.count, 7, "log2 of 80 is 6.3");
    }

    #[test]
    fn dark_pictures_have_exposures_too() {
        for pixels in [vec![Rgb::BLACK; 4], Vec::new(), vec![Rgb::WHITE]] {
            let exposures = Exposures::of(pixels.into_iter());
            assert!(exposures.count == 2 && exposures.steps().all(f32::is_finite), "{exposures:?}");
        }
    }
}
