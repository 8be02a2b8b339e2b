//! Limit of single bright pixels, relative to their surroundings.
//!
//! After the scaling of neighborhoods, a pixel may be several times as bright as each of the 48
//! pixels around it. A viewer takes such a pixel for a firefly, unless both halves of the input
//! agree on it, as on a light smaller than a pixel. The coarse grids of [`energy`](crate::energy)
//! restore the energy.

use crate::prepare::brightness;
use crate::speckles::WINDOW_RADIUS;
use crate::window::neighbors;
use crate::{Noisy, speckles};
use juggler_math::Rgb;
use rayon::prelude::*;

/// Maximum brightness of a pixel, relative to the brightest pixel in its window. The factor is less
/// than 3, because the coarse grids scale neighboring pixels by slightly different factors.
const FACTOR: f32 = 2.75;

/// Limits single bright pixels. Pixels with black surroundings stay as they are.
pub(crate) fn limit(noisy: &Noisy, pixels: &mut [Rgb]) {
    let brightness: Vec<f32> = pixels.par_iter().map(|color| brightness(*color)).collect();
    pixels.par_iter_mut().enumerate().for_each(|(i, pixel)| {
        let own = brightness[i];
        // Skip the search of the window in the common case: a direct neighbor is bright enough.
        if own <= FACTOR * brightest(noisy.width, &brightness, i, 1) {
            return;
        }
        let around = brightest(noisy.width, &brightness, i, WINDOW_RADIUS);
        if around > 0.0 {
            let limit = (FACTOR * around).max(speckles::confirmed_brightness(noisy, i));
            if own > limit {
                *pixel = *pixel * (limit / own);
            }
        }
    });
}

/// Brightness of the brightest other pixel of a window, at least 0.
fn brightest(width: usize, brightness: &[f32], i: usize, radius: usize) -> f32 {
    neighbors(width, brightness.len(), i, radius).fold(0.0, |brightest, at| brightness[at].max(brightest))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Features;

    const WIDTH: usize = 20;

    /// Limits pixel `at` of a wall of this brightness, with the given halves and filtered
    /// brightness; returns its brightness.
    fn limited(at: usize, wall: f32, halves: [f32; 2], filtered: f32) -> f32 {
        let pixels = |bright: f32| {
            let mut pixels = vec![Rgb::splat(wall); WIDTH * WIDTH];
            pixels[at] = Rgb::splat(bright);
            pixels
        };
        let (halves, mut filtered) = (halves.map(pixels), pixels(filtered));
        let noisy = Noisy::new(WIDTH, WIDTH, [&halves[0], &halves[1]], Features::default()).unwrap();
        limit(&noisy, &mut filtered);
        assert!((0..filtered.len()).all(|i| i == at || filtered[i] == Rgb::splat(wall)));
        filtered[at].r
    }

    /// The middle, an edge and two corners of the picture.
    const PLACES: [usize; 4] = [10 * WIDTH + 10, 7 * WIDTH, 0, WIDTH * WIDTH - 1];

    #[test]
    fn firefly_of_one_half_is_limited() {
        for at in PLACES {
            let found = limited(at, 0.5, [20.0, 0.5], 8.0);
            assert!((found - 0.5 * FACTOR).abs() < 1e-5, "{found}");
            assert!((limited(at, 0.5, [f32::NAN, 20.0], 8.0) - 0.5 * FACTOR).abs() < 1e-5);
        }
    }

    #[test]
    fn light_smaller_than_a_pixel_stays() {
        for at in PLACES {
            assert_eq!(limited(at, 0.5, [20.0, 20.0], 19.0), 19.0);
            assert_eq!(limited(at, 0.5, [20.0, 21.0], 12.0), 12.0);
        }
    }

    #[test]
    fn stars_on_black_and_pixels_within_the_limit_stay() {
        for at in PLACES {
            assert_eq!(limited(at, 0.0, [3.0, 0.0], 1.0), 1.0);
            assert_eq!(limited(at, 0.5, [3.0, 0.0], 1.3), 1.3);
        }
    }

    #[test]
    fn two_bright_neighbors_stay() {
        let mut pixels = vec![Rgb::splat(0.5); WIDTH * WIDTH];
        (pixels[205], pixels[207]) = (Rgb::splat(9.0), Rgb::splat(8.0));
        let (before, black) = (pixels.clone(), vec![Rgb::BLACK; WIDTH * WIDTH]);
        let noisy = Noisy::new(WIDTH, WIDTH, [&black, &black], Features::default()).unwrap();
        limit(&noisy, &mut pixels);
        assert_eq!(pixels, before);
    }
}
