//! Single bright pixels that the filter left.
//!
//! A pixel that outshines all 48 pixels around it is a highlight or a firefly. A highlight is about equally bright in both
//! halves of the input; a firefly is cut. Its light goes to its surroundings (`energy`).

use crate::Noisy;
use crate::features::{FEATURES, Feature, of_pixel};
use crate::prepare::is_known;
use juggler_math::Rgb;
use rayon::prelude::*;

/// Largest brightness of a pixel, in parts of the second brightest of the pixels around it.
const FACTOR: f32 = 1.2;
/// Pixels to each side that a pixel is compared with.
const REACH: usize = 3;
/// Differences of its halves that the mean of a highlight exceeds its surroundings by. Clamped fireflies are equally bright,
/// so that both halves may have one: a small factor would take a pair of them for a highlight.
const SURE: f32 = 8.0;
/// Squared difference of features from which on a pixel shows another surface than its surroundings.
const DIFFERENT: f32 = 0.05;

/// The picture without single bright pixels.
pub(crate) fn cut(noisy: &Noisy, pixels: &[Rgb]) -> Vec<Rgb> {
    let brightness: Vec<f32> = pixels.par_iter().map(|c| c.r + c.g + c.b).collect();
    let pixel = |i: usize| {
        let own = brightness[i];
        let limit = FACTOR * around(noisy.width, &brightness, i);
        if own <= limit || shows_something_else(noisy, i) {
            return pixels[i];
        }
        let limit = limit.max(sure(noisy, i));
        if own > limit { pixels[i] * (limit / own) } else { pixels[i] }
    };
    (0..pixels.len()).into_par_iter().map(pixel).collect()
}

/// Whether the features of pixel `i` differ from the mean of the pixels around it: a lamp far away is no firefly.
fn shows_something_else(noisy: &Noisy, i: usize) -> bool {
    let (x, y) = (i % noisy.width, i / noisy.width);
    let (mut mean, mut count) = ([0.0; FEATURES], 0.0);
    for row in y.saturating_sub(1)..noisy.height.min(y + 2) {
        for column in x.saturating_sub(1)..noisy.width.min(x + 2) {
            let at = row * noisy.width + column;
            if at != i {
                let features = features(noisy, at);
                (0..FEATURES).for_each(|k| mean[k] += features[k]);
                count += 1.0;
            }
        }
    }
    let own = features(noisy, i);
    let square = |k: usize| (own[k] - mean[k] / count) * (own[k] - mean[k] / count);
    count > 0.0 && (0..FEATURES).map(square).sum::<f32>() > DIFFERENT
}

/// Features of a pixel, the mean of both halves.
fn features(noisy: &Noisy, i: usize) -> Feature {
    let [a, b] = [0, 1].map(|half: usize| of_pixel(&noisy.features, half, i, 0.0));
    std::array::from_fn(|k| (a[k] + b[k]) * 0.5)
}

/// Brightness that both halves of the input vouch for.
fn sure(noisy: &Noisy, i: usize) -> f32 {
    match noisy.halves.map(|half| half.get(i).copied().filter(is_known)) {
        [Some(a), Some(b)] => {
            let [a, b] = [a, b].map(|c| c.r + c.g + c.b);
            (a + b) * 0.5 - (a - b).abs() * SURE
        }
        _ => 0.0,
    }
}

/// The second brightest pixel around pixel `i`.
fn around(width: usize, brightness: &[f32], i: usize) -> f32 {
    let height = brightness.len() / width;
    let (x, y) = (i % width, i / width);
    let (mut first, mut second) = (0.0_f32, 0.0_f32);
    for row in y.saturating_sub(REACH)..height.min(y + REACH + 1) {
        for column in x.saturating_sub(REACH)..width.min(x + REACH + 1) {
            let at = row * width + column;
            if at != i {
                second = second.max(brightness[at].min(first));
                first = first.max(brightness[at]);
            }
        }
    }
    second
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Features;

    const WIDTH: usize = 20;

    /// A wall of brightness 1 whose pixel (10, 10) is as bright as given in both halves and in the filtered picture.
    fn cut_at(halves: [f32; 2], filtered: f32) -> f32 {
        let at = 10 * WIDTH + 10;
        let wall = |v: f32| {
            let mut pixels = vec![Rgb::WHITE; WIDTH * WIDTH];
            pixels[at] = Rgb::splat(v);
            pixels
        };
        let halves = halves.map(wall);
        let noisy = Noisy::new(WIDTH, WIDTH, [&halves[0], &halves[1]], Features::default()).unwrap();
        let pixels = cut(&noisy, &wall(filtered));
        assert!((0..pixels.len()).all(|i| i == at || pixels[i] == Rgb::WHITE));
        pixels[at].r
    }

    #[test]
    fn a_pixel_that_the_halves_disagree_on_is_cut() {
        assert!(cut_at([9.0, 1.0], 5.0) <= FACTOR);
        assert!(cut_at([90.0, 30.0], 60.0) <= FACTOR);
    }

    #[test]
    fn a_highlight_that_both_halves_have_stays() {
        assert_eq!(cut_at([10.0, 10.0], 10.0), 10.0);
        assert!(cut_at([10.2, 9.8], 10.0) > 6.0);
    }

    #[test]
    fn a_lamp_far_away_stays() {
        let at = 10 * WIDTH + 10;
        let (mut wall, mut depth) = (vec![Rgb::WHITE; WIDTH * WIDTH], vec![5.0; WIDTH * WIDTH]);
        let half = wall.clone();
        (wall[at], depth[at]) = (Rgb::splat(50.0), 40.0);
        let features = Features { depth: Some([&depth, &depth]), ..Features::default() };
        let noisy = Noisy::new(WIDTH, WIDTH, [&wall, &half], features).unwrap();
        assert_eq!(cut(&noisy, &wall), wall);
    }

    #[test]
    fn two_bright_neighbors_are_cut_too() {
        let mut wall = vec![Rgb::WHITE; WIDTH * WIDTH];
        let noisy_half = wall.clone();
        (wall[210], wall[211]) = (Rgb::splat(50.0), Rgb::splat(40.0));
        let noisy = Noisy::new(WIDTH, WIDTH, [&wall, &noisy_half], Features::default()).unwrap();
        let pixels = cut(&noisy, &wall);
        assert!(pixels[210].r <= FACTOR * 40.0 && pixels[211].r <= 50.0);
    }
}
