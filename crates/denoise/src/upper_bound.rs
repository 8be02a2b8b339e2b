//! Upper bound on filtered pixels from the halves of the input.
//!
//! Windows across the edge of an emitter spread its light into dark pixels beside it, and scaling a
//! neighborhood to the mean of the input brightens these pixels further. A filtered pixel is
//! therefore at most as bright as its brighter half, with a margin for the noise around it. The
//! coarse grids of [`energy`](crate::energy) restore the energy.

use crate::Noisy;
use crate::prepare::brightness;
use juggler_math::Rgb;
use rayon::prelude::*;

/// Maximum brightness of a pixel, relative to its brighter half.
const FACTOR: f32 = 1.2;
/// Margin for noise, in typical differences of the halves around the pixel.
const MARGIN: f32 = 4.0;

/// Dims pixels that exceed the bound. `differences` are the
/// [typical differences](crate::noise::typical_differences) of the halves.
pub(crate) fn dim(noisy: &Noisy, differences: &[f32], pixels: &mut [Rgb]) {
    pixels.par_iter_mut().zip(differences).enumerate().for_each(|(i, (pixel, difference))| {
        let Some([a, b]) = noisy.brightness(i) else { return };
        let own = brightness(*pixel);
        let limit = FACTOR * a.max(b).max(0.0) + MARGIN * difference;
        if own > limit {
            *pixel = *pixel * (limit / own);
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Features;
    use crate::noise::typical_differences;

    const WIDTH: usize = 20;
    const AT: usize = 10 * WIDTH + 10;

    /// Dims pixel (10, 10) of a dark wall, with the given halves and filtered brightness; returns
    /// its brightness.
    fn dimmed(halves: [f32; 2], filtered: f32) -> f32 {
        let halves = halves.map(|v| {
            let mut wall = vec![Rgb::splat(0.1); WIDTH * WIDTH];
            wall[AT] = Rgb::splat(v);
            wall
        });
        let noisy = Noisy::new(WIDTH, WIDTH, [&halves[0], &halves[1]], Features::default()).unwrap();
        let mut pixels = vec![Rgb::splat(0.1); WIDTH * WIDTH];
        pixels[AT] = Rgb::splat(filtered);
        dim(&noisy, &typical_differences(&noisy), &mut pixels);
        assert!((0..pixels.len()).all(|i| i == AT || pixels[i] == Rgb::splat(0.1)));
        pixels[AT].r
    }

    #[test]
    fn emission_does_not_stay_in_a_dark_pixel_beside_it() {
        assert!(dimmed([0.1, 0.1], 4.0) <= 0.13);
        assert!(dimmed([0.2, 0.1], 4.0) <= 0.26);
    }

    #[test]
    fn pixels_within_their_halves_and_nan_pixels_are_unchanged() {
        assert_eq!(dimmed([5.0, 5.0], 5.0), 5.0);
        assert_eq!(dimmed([9.0, 0.1], 4.0), 4.0);
        assert_eq!(dimmed([f32::NAN, 0.1], 4.0), 4.0);
    }

    #[test]
    fn dark_pixels_of_a_noisy_wall_keep_the_mean() {
        let half = |odd: usize| -> Vec<Rgb> {
            (0..WIDTH * WIDTH).map(|i| Rgb::splat(if (i + i / WIDTH) % 4 == odd { 0.0 } else { 1.0 })).collect()
        };
        let halves = [half(0), half(2)];
        let noisy = Noisy::new(WIDTH, WIDTH, [&halves[0], &halves[1]], Features::default()).unwrap();
        let mut pixels = vec![Rgb::splat(0.75); WIDTH * WIDTH];
        dim(&noisy, &typical_differences(&noisy), &mut pixels);
        assert!(pixels.iter().all(|pixel| *pixel == Rgb::splat(0.75)));
    }
}
