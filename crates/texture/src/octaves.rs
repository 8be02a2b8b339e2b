//! Octaves of noise, each smaller and finer than the one before (Perlin, An Image Synthesizer,
//! 1985; Musgrave in Ebert et al., Texturing and Modeling, 2003).

use super::lattice::{filter_amplitude, noise, unit_cube_point};
use super::mapping::PatternPoint;
use super::{InvalidTexture, check};
use juggler_math::hash::combine;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Octaves of noise that are added up.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Octaves {
    /// Number of octaves. Each one adds finer detail.
    #[schemars(range(min = 1, max = 16))]
    pub octaves: u32,
    /// Frequency of each octave over that of the one before.
    #[schemars(range(min = 1, max = 16))]
    pub lacunarity: f32,
    /// Amplitude of each octave over that of the one before. Larger values make the pattern
    /// rougher.
    #[schemars(range(min = 0, max = 1))]
    pub gain: f32,
    /// Seed of the noise. Another seed gives another pattern of the same kind.
    pub seed: u32,
}

impl Default for Octaves {
    fn default() -> Self {
        Self { octaves: 6, lacunarity: 2.0, gain: 0.5, seed: 0 }
    }
}

impl Octaves {
    /// Checks all values.
    pub(super) fn check(&self) -> Result<(), InvalidTexture> {
        check::in_range("octaves", self.octaves as f32, 1.0, 16.0)?;
        check::in_range("lacunarity", self.lacunarity, 1.0, 16.0)?;
        check::in_range("gain", self.gain, 0.0, 1.0)
    }

    /// Sum of signed noise (fractional Brownian motion), from -1 to 1 with mean 0.
    pub(super) fn fbm(&self, pattern: PatternPoint) -> f32 {
        self.sum(pattern, |value| value, 0.0)
    }

    /// Sum of absolute noise (turbulence), from 0 to 1, with creases at the zeros of each octave.
    pub(super) fn turbulence(&self, pattern: PatternPoint) -> f32 {
        self.sum(pattern, f32::abs, MEAN_OF_ABSOLUTE_NOISE)
    }

    /// Sum of octaves over the sum of amplitudes. Octaves finer than the footprint fade to `mean`.
    fn sum(&self, pattern: PatternPoint, fold: fn(f32) -> f32, mean: f32) -> f32 {
        let (mut sum, mut all) = (0.0, 0.0);
        let (mut amplitude, mut frequency) = (1.0, 1.0f32);
        for octave in 0..self.octaves.min(16) {
            let filter = filter_amplitude(pattern.width * frequency);
            let value = if filter > 0.0 {
                let seed = combine(self.seed, octave);
                // Offset each octave, so that the zeros of their lattices do not coincide.
                let point = pattern.point * frequency + unit_cube_point(seed);
                fold(if point.is_finite() { noise(point, seed) } else { 0.0 })
            } else {
                mean
            };
            sum += amplitude * (mean + (value - mean) * filter);
            all += amplitude;
            amplitude *= self.gain;
            frequency *= self.lacunarity;
        }
        sum / all
    }
}

/// Mean of absolute noise, measured.
const MEAN_OF_ABSOLUTE_NOISE: f32 = 0.22;

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::Vec3;
    use juggler_math::testing::Random;

    #[test]
    fn fbm_and_turbulence_have_the_stated_means() {
        let mut random = Random::new(710);
        let (count, octaves) = (20_000, Octaves { octaves: 1, ..Octaves::default() });
        let places: Vec<PatternPoint> = (0..count).map(|_| PatternPoint::unfiltered(random.point(1e3))).collect();
        let mean =
            |f: &dyn Fn(PatternPoint) -> f32| places.iter().map(|p| f64::from(f(*p))).sum::<f64>() / f64::from(count);
        let signed = mean(&|pattern| octaves.fbm(pattern));
        let unsigned = mean(&|pattern| octaves.turbulence(pattern));
        assert!(
            signed.abs() < 0.01 && (unsigned - f64::from(MEAN_OF_ABSOLUTE_NOISE)).abs() < 0.005,
            "{signed} {unsigned}"
        );
        let far = |p: &PatternPoint| PatternPoint { width: 1e3, ..*p };
        assert!(
            places.iter().all(|p| octaves.fbm(far(p)) == 0.0 && octaves.turbulence(far(p)) == MEAN_OF_ABSOLUTE_NOISE)
        );
    }

    /// The mean square of differences over a distance grows with the distance as the spectrum
    /// implies.
    #[test]
    fn finer_octaves_are_smaller() {
        let mut random = Random::new(711);
        let octaves = Octaves { octaves: 10, ..Octaves::default() };
        let mut mean_square = |distance: f32| {
            let square = |_| {
                let p = random.point(500.0);
                let step = random.unit_vector() * distance;
                let d = octaves.fbm(PatternPoint::unfiltered(p + step)) - octaves.fbm(PatternPoint::unfiltered(p));
                f64::from(d * d)
            };
            (0..4000).map(square).sum::<f64>() / 4000.0
        };
        // Amplitudes fall as 1 / frequency, so that squared differences grow about as the squared
        // distance, up to a logarithm.
        let [far, middle, near] = [0.2, 0.05, 0.0125].map(&mut mean_square);
        for ratio in [far / middle, middle / near] {
            assert!((5.0..16.5).contains(&ratio), "{far} {middle} {near}");
        }
    }

    #[test]
    fn octaves_leave_as_the_footprint_grows() {
        let octaves = Octaves { octaves: 5, ..Octaves::default() };
        let one = Octaves { octaves: 1, ..octaves };
        let mut random = Random::new(712);
        for _ in 0..100 {
            let point = random.point(50.0);
            // The second octave has frequency 2: at a width of 0.376 it is gone, the first one is
            // not.
            let blurred = octaves.fbm(PatternPoint { point, width: 0.376 }) * (1.0 + 0.5 + 0.25 + 0.125 + 0.0625);
            let first = one.fbm(PatternPoint::unfiltered(point)) * filter_amplitude(0.376);
            assert!((blurred - first).abs() < 1e-5);
            assert_eq!(octaves.fbm(PatternPoint { point, width: 1e-9 }), octaves.fbm(PatternPoint::unfiltered(point)));
        }
        assert!(octaves.fbm(PatternPoint::unfiltered(Vec3::splat(f32::MAX))).is_finite());
    }
}
