//! Halves of a picture whose samples are not known as halves: renders of other programs, and
//! pictures without the halves' buffers.
//!
//! The noise of a pixel is the smallest second difference to its neighbors in four directions, after
//! division by the albedo: edges and gradients have a direction without such a difference, noise has
//! none (Immerkær 1996 estimates noise from second differences, which cancel gradients). The halves
//! are the pixel plus and minus its noise, so that their mean is the picture itself.

use crate::prepare::{brightness, is_known};
use juggler_math::Rgb;
use rayon::prelude::*;

/// Lower bound of the divisor.
const MIN_ALBEDO: f32 = 0.05;

/// Noise of a pixel over the root mean square of the smallest of four second differences, for
/// independent normally distributed noise of equal variance.
const NOISE_FACTOR: f32 = 1.55;

/// Opposite neighbors in four directions, as columns and rows.
const DIRECTIONS: [[isize; 2]; 4] = [[1, 0], [0, 1], [1, 1], [1, -1]];

/// Splits a picture of this width into two halves, whose difference is its noise and whose mean is the
/// picture. Pixels that are not finite stay so.
pub fn split(width: usize, pixels: &[Rgb], albedo: Option<&[Rgb]>) -> [Vec<Rgb>; 2] {
    let divisor = |i: usize| {
        let albedo = albedo.and_then(|albedo| albedo.get(i)).copied().filter(|albedo| albedo.max_channel() > 0.0);
        albedo.map_or(Rgb::WHITE, |albedo| albedo.map(|channel| channel.max(MIN_ALBEDO)))
    };
    let divided: Vec<Rgb> = pixels.par_iter().enumerate().map(|(i, pixel)| quotient(*pixel, divisor(i))).collect();
    let half = |sign: f32| {
        let pixel = |(i, pixel): (usize, &Rgb)| {
            let noise = smallest_difference(width, &divided, i) * divisor(i) * NOISE_FACTOR;
            // A checkerboard of signs makes neither half brighter than the other.
            let sign = if (i % width + i / width).is_multiple_of(2) { sign } else { -sign };
            *pixel + at_most(noise.map(f32::abs), *pixel) * sign
        };
        pixels.par_iter().enumerate().map(pixel).collect()
    };
    [half(1.0), half(-1.0)]
}

/// Second difference of a pixel and its neighbors, in the direction in which it is smallest; black
/// without known neighbors.
fn smallest_difference(width: usize, pixels: &[Rgb], i: usize) -> Rgb {
    let known = |at: usize| pixels.get(at).copied().filter(is_known);
    let Some(center) = known(i) else { return Rgb::BLACK };
    let difference = |[column, row]: [isize; 2]| {
        let neighbor = |sign: isize| {
            let x = (i % width).checked_add_signed(sign * column).filter(|x| *x < width)?;
            let y = (i / width).checked_add_signed(sign * row)?;
            known(y * width + x)
        };
        let neighbors = match [neighbor(1), neighbor(-1)] {
            [Some(a), Some(b)] => (a + b) * 0.5,
            // At the border, the difference is the first one.
            [a, b] => a.or(b)?,
        };
        Some(center - neighbors)
    };
    let size = |difference: &Rgb| brightness(difference.map(f32::abs));
    DIRECTIONS.into_iter().filter_map(difference).min_by(|a, b| size(a).total_cmp(&size(b))).unwrap_or(Rgb::BLACK)
}

/// The noise, so small that no half is darker than black.
fn at_most(noise: Rgb, pixel: Rgb) -> Rgb {
    let channel = |noise: f32, pixel: f32| noise.min(pixel.max(0.0));
    Rgb::new(channel(noise.r, pixel.r), channel(noise.g, pixel.g), channel(noise.b, pixel.b))
}

fn quotient(color: Rgb, divisor: Rgb) -> Rgb {
    Rgb::new(color.r / divisor.r, color.g / divisor.g, color.b / divisor.b)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Picture of 8 × 8 pixels.
    fn picture(color: impl Fn(usize, usize) -> f32) -> Vec<Rgb> {
        (0..64).map(|i| Rgb::splat(color(i % 8, i / 8))).collect()
    }

    fn assert_equal(a: &[Rgb], b: &[Rgb]) {
        for (i, (a, b)) in a.iter().zip(b).enumerate() {
            assert!((*a - *b).map(f32::abs).max_channel() < 1e-5, "pixel {i}: {a:?} {b:?}");
        }
    }

    #[test]
    fn edges_gradients_and_textures_are_no_noise() {
        let albedo: Vec<Rgb> = picture(|x, y| [0.1, 0.9, 0.4][(x * 7 + y * 5) % 3]);
        let textured: Vec<Rgb> = albedo.iter().map(|albedo| *albedo * 2.0).collect();
        let lit = [picture(|x, _| if x < 4 { 0.1 } else { 90.0 }), picture(|_, y| 2.0 * y as f32)];
        for (pixels, albedo) in [(&lit[0], None), (&lit[1], None), (&textured, Some(albedo.as_slice()))] {
            for half in split(8, pixels, albedo) {
                assert_equal(&half, pixels);
            }
        }
    }

    #[test]
    fn noise_is_the_difference_of_halves() {
        let bright = picture(|x, y| if (x, y) == (3, 3) { 2.0 } else { 1.0 });
        let [a, b] = split(8, &bright, None);
        assert!((a[27] - b[27]).r > 2.0, "{:?} {:?}", a[27], b[27]);
        let mean: Vec<Rgb> = a.iter().zip(&b).map(|(a, b)| (*a + *b) * 0.5).collect();
        assert_equal(&mean, &bright);
        assert!(a.iter().chain(&b).all(|pixel| pixel.r >= 0.0));
    }

    #[test]
    fn unknown_and_single_pixels_stay() {
        let nan = Rgb::splat(f32::NAN);
        for half in split(3, &[Rgb::WHITE, nan, Rgb::WHITE], None) {
            assert!(half[0] == Rgb::WHITE && half[1].r.is_nan() && half[2] == Rgb::WHITE);
        }
        assert_eq!(split(1, &[Rgb::WHITE], None), [vec![Rgb::WHITE], vec![Rgb::WHITE]]);
        assert!(split(1, &[], None).iter().all(Vec::is_empty));
    }
}
