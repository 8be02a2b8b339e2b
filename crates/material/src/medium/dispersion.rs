//! Dispersion: index of refraction and color of light by its wavelength.

use juggler_math::Rgb;

/// Largest dispersion of a material.
pub const MAX_DISPERSION: f32 = 20.0;

/// Shortest wavelength, in nanometers.
const SHORTEST: f32 = 400.0;
/// Distance between the wavelengths of [`COLORS`], in nanometers.
const STEP: f32 = 10.0;

/// Colors of the wavelengths from 400 nm to 700 nm in steps of 10 nm, in linear sRGB: the CIE 1931
/// 2° observer, with negative channels set to 0 and each channel scaled so that its mean is 1 and
/// all wavelengths together are white.
const COLORS: [Rgb; 31] = [
    Rgb::new(0.02029, 0.0, 0.20012),
    Rgb::new(0.06103, 0.0, 0.61125),
    Rgb::new(0.1837, 0.0, 1.90241),
    Rgb::new(0.36114, 0.0, 4.08059),
    Rgb::new(0.37983, 0.0, 5.13901),
    Rgb::new(0.25215, 0.0, 5.20166),
    Rgb::new(0.03066, 0.0, 4.88201),
    Rgb::new(0.0, 0.09071, 3.7363),
    Rgb::new(0.0, 0.5258, 2.30894),
    Rgb::new(0.0, 0.98584, 1.24534),
    Rgb::new(0.0, 1.59521, 0.61261),
    Rgb::new(0.0, 2.45125, 0.17982),
    Rgb::new(0.0, 3.31766, 0.0),
    Rgb::new(0.0, 3.79843, 0.0),
    Rgb::new(0.0, 3.93027, 0.0),
    Rgb::new(0.0, 3.76835, 0.0),
    Rgb::new(0.67497, 3.36116, 0.0),
    Rgb::new(1.71736, 2.72778, 0.0),
    Rgb::new(2.78679, 1.93784, 0.0),
    Rgb::new(3.69309, 1.10799, 0.0),
    Rgb::new(4.22302, 0.40171, 0.0),
    Rgb::new(4.22963, 0.0, 0.0),
    Rgb::new(3.72961, 0.0, 0.0),
    Rgb::new(2.86069, 0.0, 0.0),
    Rgb::new(2.0202, 0.0, 0.0),
    Rgb::new(1.28859, 0.0, 0.0),
    Rgb::new(0.75277, 0.0, 0.0),
    Rgb::new(0.39985, 0.0, 0.0),
    Rgb::new(0.21446, 0.0, 0.0),
    Rgb::new(0.10414, 0.0, 0.0),
    Rgb::new(0.05235, 0.0, 0.0),
];

/// Number of intervals between the wavelengths of [`COLORS`].
const INTERVALS: f32 = 30.0;

/// A wavelength of light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wavelength {
    /// Wavelength in nanometers, 400 to 700.
    pub nanometers: f32,
}

impl Wavelength {
    /// Samples a wavelength by `u` in [0, 1), in proportion to the sum of the channels of its
    /// color. Returns its color over its density relative to uniform sampling: the weight of a path
    /// of this wavelength, whose mean is white.
    pub fn sample(u: f32) -> (Self, Rgb) {
        let mut rest = u;
        let mut sampled = (Self { nanometers: SHORTEST }, Rgb::BLACK);
        for (index, pair) in COLORS.windows(2).enumerate() {
            let [low, high] = pair else { break };
            // The channels of the mean of all colors sum to 3.
            let mean = (*low + *high) * 0.5;
            let probability = (mean.r + mean.g + mean.b) / (3.0 * INTERVALS);
            let fraction = (rest / probability).clamp(0.0, 1.0);
            let color = *low + (*high - *low) * fraction;
            let nanometers = SHORTEST + (index as f32 + fraction) * STEP;
            sampled = (Self { nanometers }, color * (1.0 / (probability * INTERVALS)));
            if rest < probability {
                break;
            }
            rest -= probability;
        }
        sampled
    }

    /// Index of refraction at this wavelength of a material with the index `ior` at 587.56 nm.
    /// `dispersion` is 20 over the Abbe number (`KHR_materials_dispersion`, Cauchy's equation of two
    /// terms). An index below 1, of a bubble, is the inverse of its surroundings' index.
    pub fn ior(self, ior: f32, dispersion: f32) -> f32 {
        if ior < 1.0 {
            return 1.0 / self.ior(1.0 / ior, dispersion);
        }
        let deviation = 523_655.0 / (self.nanometers * self.nanometers) - 1.5168;
        (ior + (ior - 1.0) * (dispersion / 20.0) * deviation).max(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_weight_of_all_wavelengths_is_white() {
        let count = 1_000_000;
        let mut sum = [0.0f64; 3];
        for index in 0..count {
            let (wavelength, weight) = Wavelength::sample((index as f32 + 0.5) / count as f32);
            assert!((400.0..=700.0).contains(&wavelength.nanometers));
            assert!(weight.to_array().iter().all(|channel| (0.0..5.0).contains(channel)), "{weight:?}");
            for (sum, channel) in sum.iter_mut().zip(weight.to_array()) {
                *sum += f64::from(channel) / f64::from(count);
            }
        }
        assert!(sum.iter().all(|mean| (mean - 1.0).abs() < 1e-3), "{sum:?}");
    }

    #[test]
    fn the_colors_of_wavelengths_are_those_of_the_rainbow() {
        let color = |nanometers: f32| {
            let color = COLORS.get(((nanometers - SHORTEST) / STEP) as usize).copied().unwrap_or_default();
            color.to_array()
        };
        let [red, green, blue] = [color(620.0), color(530.0), color(450.0)];
        assert!(red[0] > 3.0 && red[1] == 0.0 && red[2] == 0.0);
        assert!(green[1] > 3.0 && green[0] == 0.0 && green[2] == 0.0);
        assert!(blue[2] > 3.0 && blue[1] == 0.0 && blue[0] < 0.5);
    }

    #[test]
    fn the_index_of_refraction_has_the_stated_abbe_number() {
        let at = |nanometers: f32, dispersion| Wavelength { nanometers }.ior(1.7, dispersion);
        assert_eq!(at(450.0, 0.0), 1.7);
        assert!((at(587.56, 1.0) - 1.7).abs() < 1e-4);
        for abbe_number in [20.0, 33.0, 60.0] {
            let dispersion = 20.0 / abbe_number;
            let found = (1.7 - 1.0) / (at(486.13, dispersion) - at(656.27, dispersion));
            assert!((found / abbe_number - 1.0).abs() < 2e-3, "{found} for {abbe_number}");
        }
    }

    #[test]
    fn extreme_dispersion_leaves_indices_positive() {
        for nanometers in [400.0, 550.0, 700.0] {
            let wavelength = Wavelength { nanometers };
            assert!(wavelength.ior(10.0, 20.0) >= 1.0);
            assert!((0.0..=1.0).contains(&wavelength.ior(0.1, 20.0)));
            let (bubble, glass) = (wavelength.ior(1.0 / 1.5, 0.5), wavelength.ior(1.5, 0.5));
            assert!((bubble * glass - 1.0).abs() < 1e-6);
        }
    }
}
