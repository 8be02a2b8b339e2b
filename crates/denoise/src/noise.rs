//! Known colors of the pixels of the input, and the noise around each pixel.

use crate::prepare::{brightness, is_known};
use crate::{Noisy, blur};
use juggler_math::Rgb;
use rayon::prelude::*;

/// Radius of the typical difference, in pixels.
const RADIUS: usize = 3;

impl Noisy<'_> {
    /// Color of a pixel in each half; `None` where it is unknown.
    pub(crate) fn known(&self, i: usize) -> [Option<Rgb>; 2] {
        self.halves.map(|half| half.get(i).copied().filter(is_known))
    }

    /// Mean of the known halves of a pixel.
    pub(crate) fn mean(&self, i: usize) -> Option<Rgb> {
        match self.known(i) {
            [Some(a), Some(b)] => Some((a + b) * 0.5),
            [a, b] => a.or(b),
        }
    }

    /// Brightness of a pixel in both halves; `None` unless both are known.
    pub(crate) fn brightness(&self, i: usize) -> Option<[f32; 2]> {
        let [a, b] = self.known(i).map(|color| color.map(brightness));
        Some([a?, b?])
    }
}

/// Typical difference in brightness of the halves around each pixel: the mean of square roots, on
/// which a few large differences have little influence.
pub(crate) fn typical_differences(noisy: &Noisy) -> Vec<f32> {
    let root = |i| noisy.brightness(i).map_or(0.0, |[a, b]| (a - b).abs().sqrt());
    let roots: Vec<f32> = (0..noisy.width * noisy.height).into_par_iter().map(root).collect();
    blur::mean(noisy.width, &roots, RADIUS).into_par_iter().map(|root| root * root).collect()
}
