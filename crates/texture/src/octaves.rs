//! Sums of noise, each half as large and twice as fine as the one before (Perlin, An Image Synthesizer, 1985; Musgrave in
//! Ebert et al., Texturing and Modeling, 2003).

use super::lattice::{kept, noise, numbers};
use super::mapping::Place;
use super::{InvalidTexture, check};
use juggler_math::hash::combine;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How noises of several sizes are added up.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Octaves {
    /// How many noises are added up.
    #[schemars(range(min = 1, max = 16))]
    pub octaves: u32,
    /// How much finer each is than the one before.
    #[schemars(range(min = 1, max = 16))]
    pub lacunarity: f32,
    /// How large each is against the one before.
    #[schemars(range(min = 0, max = 1))]
    pub gain: f32,
    /// Another number, another noise.
    pub seed: u32,
}

impl Default for Octaves {
    fn default() -> Self {
        Self { octaves: 6, lacunarity: 2.0, gain: 0.5, seed: 0 }
    }
}

impl Octaves {
    /// Checks numbers.
    pub(super) fn check(&self) -> Result<(), InvalidTexture> {
        check::in_range("octaves", self.octaves as f32, 1.0, 16.0)?;
        check::in_range("lacunarity", self.lacunarity, 1.0, 16.0)?;
        check::in_range("gain", self.gain, 0.0, 1.0)
    }

    /// The sum, from −1 to 1; its mean is 0.
    pub(super) fn signed(&self, place: Place) -> f32 {
        self.sum(place, |value| value, 0.0)
    }

    /// The sum of what is left without signs, from 0 to 1: folds at the zeros of each noise.
    pub(super) fn unsigned(&self, place: Place) -> f32 {
        self.sum(place, f32::abs, MEAN_OF_FOLDED)
    }

    /// Octaves that the footprint covers are replaced by their mean.
    fn sum(&self, place: Place, fold: fn(f32) -> f32, mean: f32) -> f32 {
        let (mut sum, mut all) = (0.0, 0.0);
        let (mut amplitude, mut frequency) = (1.0, 1.0f32);
        for octave in 0..self.octaves.min(16) {
            let kept = kept(place.width * frequency);
            let value = if kept > 0.0 {
                let seed = combine(self.seed, octave);
                // Moved, so that zeros of the lattices do not fall together.
                let point = place.point * frequency + numbers(seed);
                fold(if point.is_finite() { noise(point, seed) } else { 0.0 })
            } else {
                mean
            };
            sum += amplitude * (mean + (value - mean) * kept);
            all += amplitude;
            amplitude *= self.gain;
            frequency *= self.lacunarity;
        }
        sum / all
    }
}

/// The mean of noise without its sign, measured.
const MEAN_OF_FOLDED: f32 = 0.22;

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::Vec3;
    use juggler_math::testing::Random;

    #[test]
    fn means_are_as_stated() {
        let mut random = Random::new(710);
        let (count, octaves) = (20_000, Octaves { octaves: 1, ..Octaves::default() });
        let places: Vec<Place> = (0..count).map(|_| Place::sharp(random.point(1e3))).collect();
        let mean = |f: &dyn Fn(Place) -> f32| places.iter().map(|p| f64::from(f(*p))).sum::<f64>() / f64::from(count);
        let signed = mean(&|place| octaves.signed(place));
        let unsigned = mean(&|place| octaves.unsigned(place));
        assert!(signed.abs() < 0.01 && (unsigned - f64::from(MEAN_OF_FOLDED)).abs() < 0.005, "{signed} {unsigned}");
        let far = |p: &Place| Place { width: 1e3, ..*p };
        assert!(places.iter().all(|p| octaves.signed(far(p)) == 0.0 && octaves.unsigned(far(p)) == MEAN_OF_FOLDED));
    }

    /// The mean square of differences over a distance falls with the distance: by how much says the spectrum.
    #[test]
    fn finer_octaves_are_smaller() {
        let mut random = Random::new(711);
        let octaves = Octaves { octaves: 10, ..Octaves::default() };
        let mut mean_square = |distance: f32| {
            let square = |_| {
                let p = random.point(500.0);
                let step = random.unit_vector() * distance;
                let d = octaves.signed(Place::sharp(p + step)) - octaves.signed(Place::sharp(p));
                f64::from(d * d)
            };
            (0..4000).map(square).sum::<f64>() / 4000.0
        };
        // Amplitudes as 1 / frequency: differences grow about as the distance, squares with its square (and a logarithm).
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
            // The second octave has frequency 2: at a width of 0.375 it is gone, the first is still whole.
            let blurred = octaves.signed(Place { point, width: 0.376 }) * (1.0 + 0.5 + 0.25 + 0.125 + 0.0625);
            let first = one.signed(Place::sharp(point)) * kept(0.376);
            assert!((blurred - first).abs() < 1e-5);
            assert_eq!(octaves.signed(Place { point, width: 1e-9 }), octaves.signed(Place::sharp(point)));
        }
        assert!(octaves.signed(Place::sharp(Vec3::splat(f32::MAX))).is_finite());
    }
}
