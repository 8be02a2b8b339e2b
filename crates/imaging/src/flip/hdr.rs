//! HDR-FLIP (2021, sections 3 and 4): the tone curve, and the exposures from the one that suits the
//! brightest pixel of the reference to the one that suits the median.

use juggler_math::{Rgb, portable};

/// Tone curve fitted to ACES (Narkowicz 2015, pre-exposed by 0.6): coefficients of a x² + b x + c
/// in numerator and denominator.
const CURVE: [[f32; 3]; 2] = [[0.6 * 0.6 * 2.51, 0.6 * 0.03, 0.0], [0.6 * 0.6 * 2.43, 0.6 * 0.59, 0.14]];
/// Tone-mapped value of the brightest pixel at the first exposure and of the median at the last.
const TARGET_VALUE: f32 = 0.85;

/// Applies the tone curve; the result is clamped to 0 to 1.
pub(super) fn tone_mapped(light: f32) -> f32 {
    let [top, bottom] = CURVE.map(|[a, b, c]| (a * light + b) * light + c);
    (top / bottom).clamp(0.0, 1.0)
}

/// Exposures in photographic stops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Exposures {
    pub first: f32,
    pub last: f32,
    pub count: u32,
}

impl Exposures {
    /// Exposures for a reference, from its maximum and median luminance.
    pub fn from_reference(reference: impl Iterator<Item = Rgb>) -> Self {
        let mut luminances: Vec<f32> = reference.map(Rgb::luminance).collect();
        let middle = luminances.len() / 2;
        let most = luminances.iter().fold(f32::EPSILON, |most, v| most.max(*v));
        let median = match luminances.is_empty() {
            true => most,
            false => luminances.select_nth_unstable_by(middle, f32::total_cmp).1.max(f32::EPSILON),
        };
        let stops = |luminance: f32| portable::log2(inverse_tone_curve() / luminance);
        let (first, last) = (stops(most), stops(median));
        Self { first, last, count: ((last - first).ceil() as u32).max(2) }
    }

    /// Evenly spaced exposures in stops.
    pub fn steps(self) -> impl Iterator<Item = f32> {
        let step = (self.last - self.first) / (self.count - 1) as f32;
        (0..self.count).map(move |i| self.first + step * i as f32)
    }
}

/// Inverse of the tone curve at [`TARGET_VALUE`]: the larger root of the quadratic equation.
fn inverse_tone_curve() -> f32 {
    let [top, bottom] = CURVE;
    let [a, b, c] = std::array::from_fn(|i| top[i] - TARGET_VALUE * bottom[i]);
    let half = -b / (2.0 * a);
    half + (half * half - c / a).max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exposures_range_from_the_brightest_pixel_to_the_median() {
        assert!((tone_mapped(inverse_tone_curve()) - 0.85).abs() < 1e-5);
        let pixels = [0.01_f32, 0.02, 0.5, 3.0, 40.0].map(Rgb::splat);
        let exposures = Exposures::from_reference(pixels.into_iter());
        let steps: Vec<f32> = exposures.steps().collect();
        assert!((tone_mapped(40.0 * portable::exp2(steps[0])) - 0.85).abs() < 1e-4);
        assert!((tone_mapped(0.5 * portable::exp2(steps[steps.len() - 1])) - 0.85).abs() < 1e-4);
        assert_eq!(exposures.count, 7, "log2 of 80 is 6.3");
    }

    #[test]
    fn dark_pictures_have_exposures_too() {
        for pixels in [vec![Rgb::BLACK; 4], Vec::new(), vec![Rgb::WHITE]] {
            let exposures = Exposures::from_reference(pixels.into_iter());
            assert!(exposures.count == 2 && exposures.steps().all(f32::is_finite), "{exposures:?}");
        }
    }
}
