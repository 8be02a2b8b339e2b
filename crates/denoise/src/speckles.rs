//! Removal of single bright pixels after filtering.
//!
//! A pixel brighter than all 48 pixels around it is a highlight or a firefly. A highlight is about
//! equally bright in both halves of the input; a firefly is clamped. Its energy goes to its
//! neighborhood (`energy`).

use crate::Noisy;
use crate::features::{FEATURES, Feature, pixel_features};
use crate::prepare::brightness;
use crate::window::neighbors;
use juggler_math::Rgb;
use rayon::prelude::*;

/// Maximum brightness of a pixel, relative to the second brightest pixel in its window.
const FACTOR: f32 = 1.2;
/// Radius of the window of a single bright pixel, in pixels.
pub(crate) const WINDOW_RADIUS: usize = 3;
/// Number of half-differences by which the mean of a highlight must exceed its surroundings.
/// Clamped fireflies are equally bright, so that both halves may have one: a small factor would
/// take such a pair for a highlight.
const CONFIDENCE: f32 = 8.0;
/// Squared feature difference from which a pixel shows another surface than its surroundings.
const FEATURE_DIFFERENCE: f32 = 0.05;

/// Clamps single bright pixels.
pub(crate) fn clamp(noisy: &Noisy, pixels: &[Rgb]) -> Vec<Rgb> {
    let brightness: Vec<f32> = pixels.par_iter().map(|color| brightness(*color)).collect();
    let pixel = |i: usize| {
        let own = brightness[i];
        let limit = FACTOR * second_brightest(noisy.width, &brightness, i);
        if own <= limit || is_other_surface(noisy, i) {
            return pixels[i];
        }
        let limit = limit.max(confirmed_brightness(noisy, i));
        if own > limit { pixels[i] * (limit / own) } else { pixels[i] }
    };
    (0..pixels.len()).into_par_iter().map(pixel).collect()
}

/// Whether the features of pixel `i` differ from the mean of its neighbors: a distant light is no
/// firefly.
fn is_other_surface(noisy: &Noisy, i: usize) -> bool {
    let (mut mean, mut count) = ([0.0; FEATURES], 0.0);
    for at in neighbors(noisy.width, noisy.width * noisy.height, i, 1) {
        let features = features(noisy, at);
        (0..FEATURES).for_each(|k| mean[k] += features[k]);
        count += 1.0;
    }
    let own = features(noisy, i);
    let square = |k: usize| (own[k] - mean[k] / count) * (own[k] - mean[k] / count);
    count > 0.0 && (0..FEATURES).map(square).sum::<f32>() > FEATURE_DIFFERENCE
}

/// Features of a pixel, averaged over both halves.
fn features(noisy: &Noisy, i: usize) -> Feature {
    let [a, b] = [0, 1].map(|half: usize| pixel_features(&noisy.features, half, i, 0.0));
    std::array::from_fn(|k| (a[k] + b[k]) * 0.5)
}

/// Brightness that both halves of the input confirm, 0 if one is unknown.
pub(crate) fn confirmed_brightness(noisy: &Noisy, i: usize) -> f32 {
    noisy.brightness(i).map_or(0.0, |[a, b]| (a + b) * 0.5 - (a - b).abs() * CONFIDENCE)
}

/// Brightness of the second brightest pixel in the window around pixel `i`.
fn second_brightest(width: usize, brightness: &[f32], i: usize) -> f32 {
    let (mut first, mut second) = (0.0_f32, 0.0_f32);
    for at in neighbors(width, brightness.len(), i, WINDOW_RADIUS) {
        second = second.max(brightness[at].min(first));
        first = first.max(brightness[at]);
    }
    second
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Features;

    const WIDTH: usize = 20;

    /// Filters a wall of brightness 1 whose pixel (10, 10) has the given brightness in both halves
    /// and in the filtered picture; returns the brightness of that pixel.
    fn clamped_at(halves: [f32; 2], filtered: f32) -> f32 {
        let at = 10 * WIDTH + 10;
        let wall = |v: f32| {
            let mut pixels = vec![Rgb::WHITE; WIDTH * WIDTH];
            pixels[at] = Rgb::splat(v);
            pixels
        };
        let halves = halves.map(wall);
        let noisy = Noisy::new(WIDTH, WIDTH, [&halves[0], &halves[1]], Features::default()).unwrap();
        let pixels = clamp(&noisy, &wall(filtered));
        assert!((0..pixels.len()).all(|i| i == at || pixels[i] == Rgb::WHITE));
        pixels[at].r
    }

    #[test]
    fn a_pixel_that_the_halves_disagree_on_is_cut() {
        assert!(clamped_at([9.0, 1.0], 5.0) <= FACTOR);
        assert!(clamped_at([90.0, 30.0], 60.0) <= FACTOR);
    }

    #[test]
    fn a_highlight_that_both_halves_have_stays() {
        assert_eq!(clamped_at([10.0, 10.0], 10.0), 10.0);
        assert!(clamped_at([10.2, 9.8], 10.0) > 6.0);
    }

    #[test]
    fn a_distant_light_stays() {
        let at = 10 * WIDTH + 10;
        let (mut wall, mut depth) = (vec![Rgb::WHITE; WIDTH * WIDTH], vec![5.0; WIDTH * WIDTH]);
        let half = wall.clone();
        (wall[at], depth[at]) = (Rgb::splat(50.0), 40.0);
        let features = Features { depth: Some([&depth, &depth]), ..Features::default() };
        let noisy = Noisy::new(WIDTH, WIDTH, [&wall, &half], features).unwrap();
        assert_eq!(clamp(&noisy, &wall), wall);
    }

    #[test]
    fn two_bright_neighbors_are_cut_too() {
        let mut wall = vec![Rgb::WHITE; WIDTH * WIDTH];
        let noisy_half = wall.clone();
        (wall[210], wall[211]) = (Rgb::splat(50.0), Rgb::splat(40.0));
        let noisy = Noisy::new(WIDTH, WIDTH, [&wall, &noisy_half], Features::default()).unwrap();
        let pixels = clamp(&noisy, &wall);
        assert!(pixels[210].r <= FACTOR * 40.0 && pixels[211].r <= 50.0);
    }
}
