//! Limit of single bright pixels, relative to their surroundings.
//!
//! After the scaling of neighborhoods, a pixel may be several times as bright as each of the 48
//! pixels around it, as a whole or in one channel. A viewer takes such a pixel for a firefly; a
//! colored one stands out more than a gray one. Agreement of both halves of the input is no proof of
//! a highlight: where few of the samples hit a small light, both halves often have the same number
//! of hits. A true highlight seldom ends at the edges of a pixel. So the pixels next to it first get
//! their input back, which the filter has taken for noise, and then the pixel is limited. The coarse
//! grids of [`energy`](crate::energy) restore the energy.

use crate::prepare::brightness;
use crate::speckles::WINDOW_RADIUS;
use crate::window::neighbors;
use crate::{Noisy, speckles};
use juggler_math::Rgb;
use rayon::prelude::*;

/// Maximum brightness of a pixel, relative to the brightest pixel in its window, and maximum of each
/// channel, relative to the greatest value of the channel in the window. The factor is less
/// than 3, because the coarse grids scale neighboring pixels by slightly different factors.
const FACTOR: f32 = 2.75;
/// Maximum typical difference of the halves around a highlight that stays, relative to the
/// brightest pixel in its window. In pictures with so little noise, both halves prove a highlight,
/// such as a star.
const MAX_NOISE: f32 = 0.0025;

/// Brightest values of a window.
#[derive(Clone, Copy)]
struct Brightest {
    /// Brightness of the brightest pixel.
    brightness: f32,
    /// Greatest value of each channel.
    channels: Rgb,
}

impl Brightest {
    /// Brightest values of the other pixels in the window around pixel `i`, at least 0.
    fn around(width: usize, pixels: &[Rgb], i: usize, radius: usize) -> Self {
        neighbors(width, pixels.len(), i, radius).fold(Self { brightness: 0.0, channels: Rgb::BLACK }, |found, at| {
            Self { brightness: brightness(pixels[at]).max(found.brightness), channels: max(pixels[at], found.channels) }
        })
    }

    /// Whether a pixel is too bright beside these values, as a whole or in a channel.
    fn is_exceeded_by(self, pixel: Rgb) -> bool {
        let limit = self.channels * FACTOR;
        brightness(pixel) > FACTOR * self.brightness || pixel.r > limit.r || pixel.g > limit.g || pixel.b > limit.b
    }
}

/// Limits single bright pixels. Pixels with black surroundings stay as they are. `differences` are
/// the [typical differences](crate::noise::typical_differences) of the halves.
pub(crate) fn limit(noisy: &Noisy, differences: &[f32], pixels: &mut [Rgb]) {
    let single = |i: usize| {
        // Skip the search of the window in the common case: the direct neighbors are bright enough.
        if !Brightest::around(noisy.width, pixels, i, 1).is_exceeded_by(pixels[i]) {
            return None;
        }
        let around = Brightest::around(noisy.width, pixels, i, WINDOW_RADIUS);
        (around.brightness > 0.0 && around.is_exceeded_by(pixels[i])).then_some((i, around))
    };
    let limited = |(i, around): (usize, Brightest)| {
        let is_certain = differences[i] <= MAX_NOISE * around.brightness;
        changes(noisy, pixels[i], i, around, is_certain)
    };
    // Pixels that are single by brightness are more than 3 pixels apart. Two pixels that are single
    // in different channels may change one pixel between them: the later pixel in row-major order
    // wins.
    let changes: Vec<_> = (0..pixels.len()).into_par_iter().filter_map(single).flat_map_iter(limited).collect();
    for (i, color) in changes {
        pixels[i] = color;
    }
}

/// New colors of single bright pixel `i` and of pixels next to it, given the brightest values of its
/// window. If `is_certain`, a highlight that both halves confirm stays, and so does its hue.
fn changes(noisy: &Noisy, pixel: Rgb, i: usize, around: Brightest, is_certain: bool) -> Vec<(usize, Rgb)> {
    let own = brightness(pixel);
    let confirmed = speckles::confirmed_brightness(noisy, i).min(own);
    let (mut changes, mut limit) = (Vec::new(), FACTOR * around.brightness);
    let mut channels = around.channels;
    if confirmed > limit {
        for at in neighbors(noisy.width, noisy.width * noisy.height, i, 1) {
            let input = noisy.mean(at).unwrap_or(Rgb::BLACK);
            let restored = brightness(input).min(confirmed / FACTOR);
            if restored > around.brightness {
                let color = input * (restored / brightness(input));
                changes.push((at, color));
                limit = limit.max(FACTOR * restored);
                channels = max(channels, color);
            }
        }
        if is_certain {
            limit = limit.max(confirmed);
        }
    }
    let dimmed = if own > limit { pixel * (limit / own) } else { pixel };
    let limited = if is_certain { dimmed } else { min(dimmed, channels * FACTOR) };
    if limited != pixel {
        changes.push((i, limited));
    }
    changes
}

/// Greater value of each channel.
fn max(a: Rgb, b: Rgb) -> Rgb {
    Rgb::new(a.r.max(b.r), a.g.max(b.g), a.b.max(b.b))
}

/// Smaller value of each channel.
fn min(a: Rgb, b: Rgb) -> Rgb {
    Rgb::new(a.r.min(b.r), a.g.min(b.g), a.b.min(b.b))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Features;
    use crate::noise::typical_differences;

    const WIDTH: usize = 20;

    /// Limits the filtered pixels, given the halves.
    fn limited(halves: &[Vec<Rgb>; 2], mut filtered: Vec<Rgb>) -> Vec<Rgb> {
        let noisy = Noisy::new(WIDTH, WIDTH, [&halves[0], &halves[1]], Features::default()).unwrap();
        limit(&noisy, &typical_differences(&noisy), &mut filtered);
        filtered
    }

    /// Wall of this brightness and noise, a different one in each half, and with these pixels.
    fn wall(brightness: f32, noise: f32, half: usize, pixels: &[(usize, f32)]) -> Vec<Rgb> {
        let noise = |i: usize| noise * if (i + i / WIDTH + half).is_multiple_of(2) { 0.5 } else { -0.5 };
        let mut wall: Vec<Rgb> = (0..WIDTH * WIDTH).map(|i| Rgb::splat(brightness + noise(i))).collect();
        pixels.iter().for_each(|&(at, brightness)| wall[at] = Rgb::splat(brightness));
        wall
    }

    /// Limits pixel `at` of a wall of this brightness and noise, with the given halves and filtered
    /// brightness; returns its brightness.
    fn limited_pixel(at: usize, [brightness, noise]: [f32; 2], halves: [f32; 2], filtered: f32) -> f32 {
        let halves = [0, 1].map(|half| wall(brightness, noise, half, &[(at, halves[half])]));
        let filtered = limited(&halves, wall(brightness, 0.0, 0, &[(at, filtered)]));
        assert!((0..filtered.len()).all(|i| i == at || filtered[i] == Rgb::splat(brightness)));
        filtered[at].r
    }

    /// The middle, an edge and two corners of the picture.
    const PLACES: [usize; 4] = [10 * WIDTH + 10, 7 * WIDTH, 0, WIDTH * WIDTH - 1];

    #[test]
    fn firefly_of_one_half_is_limited() {
        for (at, noise) in PLACES.into_iter().flat_map(|at| [(at, 0.0), (at, 0.1)]) {
            let found = limited_pixel(at, [0.5, noise], [20.0, 0.5], 8.0);
            assert!((found - 0.5 * FACTOR).abs() < 1e-5, "{found}");
            assert!((limited_pixel(at, [0.5, noise], [f32::NAN, 20.0], 8.0) - 0.5 * FACTOR).abs() < 1e-5);
        }
    }

    #[test]
    fn firefly_of_both_halves_of_a_noisy_picture_is_limited() {
        for at in PLACES {
            let found = limited_pixel(at, [0.5, 0.1], [20.0, 20.0], 19.0);
            assert!((found - 0.5 * FACTOR).abs() < 1e-5, "{found}");
        }
    }

    /// Limits a pixel of this color on a red wall of this noise, with the color in both halves;
    /// returns the pixel.
    fn limited_on_red(color: Rgb, noise: f32) -> Rgb {
        let at = PLACES[0];
        let red = |half: usize, noise: f32| -> Vec<Rgb> {
            let mut red: Vec<Rgb> = wall(0.5, noise, half, &[]).iter().map(|gray| Rgb::new(gray.r, 0.1, 0.2)).collect();
            red[at] = color;
            red
        };
        let halves = [0, 1].map(|half| red(half, noise));
        limited(&halves, red(0, 0.0))[at]
    }

    #[test]
    fn each_channel_of_a_firefly_is_limited() {
        assert_eq!(limited_on_red(Rgb::new(0.5, 0.2, 1.5), 0.1), Rgb::new(0.5, 0.2, 0.2 * FACTOR));
        assert_eq!(limited_on_red(Rgb::new(0.1, 0.9, 0.1), 0.1), Rgb::new(0.1, 0.1 * FACTOR, 0.1));
        assert_eq!(limited_on_red(Rgb::new(0.5, 0.2, 0.4), 0.1), Rgb::new(0.5, 0.2, 0.4));
    }

    #[test]
    fn a_colored_light_stays_where_there_is_no_noise() {
        assert_eq!(limited_on_red(Rgb::new(0.5, 0.2, 1.5), 0.0), Rgb::new(0.5, 0.2, 1.5));
    }

    #[test]
    fn light_smaller_than_a_pixel_stays_where_there_is_no_noise() {
        for at in PLACES {
            assert_eq!(limited_pixel(at, [0.5, 0.0], [20.0, 20.0], 19.0), 19.0);
            assert_eq!(limited_pixel(at, [0.5, 0.0], [20.0, 20.2], 12.0), 12.0);
        }
    }

    #[test]
    fn pixels_next_to_a_highlight_get_their_input_back() {
        let at = PLACES[0];
        for (input, restored) in [(3.0, 3.0), (12.0, 15.0 / FACTOR)] {
            let pixels = |half: usize| [(at, 16.0), (at + 1, 2.0 * input * half as f32), (at - WIDTH, 1.0)];
            let halves = [0, 1].map(|half| wall(0.5, 0.1, half, &pixels(half)));
            let found = limited(&halves, wall(0.5, 0.0, 0, &[(at, 15.0)]));
            assert!((found[at + 1].r - restored).abs() < 1e-5, "{:?}", found[at + 1]);
            assert!((found[at].r - (FACTOR * restored).min(15.0)).abs() < 1e-5, "{:?}", found[at]);
            assert_eq!(found[at - WIDTH].r, 1.0);
            assert_eq!(found[at - 1].r, 0.5);
        }
    }

    #[test]
    fn stars_on_black_and_pixels_within_the_limit_stay() {
        for at in PLACES {
            assert_eq!(limited_pixel(at, [0.0, 0.0], [3.0, 0.0], 1.0), 1.0);
            assert_eq!(limited_pixel(at, [0.5, 0.1], [3.0, 0.0], 1.3), 1.3);
        }
    }

    #[test]
    fn two_bright_neighbors_stay() {
        let filtered = wall(0.5, 0.0, 0, &[(205, 9.0), (207, 8.0)]);
        let halves = [0, 1].map(|half| wall(0.5, 0.1, half, &[]));
        assert_eq!(limited(&halves, filtered.clone()), filtered);
    }
}
