//! Dithering of 8-bit levels, so that gradients show no banding. The threshold pattern is computed,
//! not tabulated: the additive recurrence R2 (Martin Roberts, The unreasonable effectiveness of
//! quasirandom sequences, 2018), whose neighbors differ as in blue noise, folded into a triangle
//! wave to avoid jumps. All channels of a pixel share a threshold, so gray stays gray.
//!
//! Values are first rounded to 1/256 of a level, then up or down by thresholds 0 to 255. The result
//! differs by less than one level, and values within 1/512 of a level always yield that level.

use super::{Quantizer, Tone};
use juggler_math::PixelRows;

/// Steps per level.
const STEPS: u16 = 256;
/// 1/p and 1/p² in units of 2^-32, where p is the plastic number, p³ = p + 1.
const ALPHA: [u32; 2] = [3_242_174_889, 2_447_445_414];

/// Quantizes the pixels of a still image in row order.
pub(crate) struct LevelEncoder {
    quantizer: Quantizer,
    depth: Depth,
    width: u64,
    /// Number of pixels processed.
    pixels_done: u64,
    /// Whether a level of alpha follows those of each color.
    has_alpha: bool,
}

enum Depth {
    Words,
    Bytes,
    Dithered,
}

impl LevelEncoder {
    /// 8-bit levels for images of this width.
    pub fn bytes(tone: &Tone, width: u32) -> Self {
        let (top, depth) = if tone.dither { (255 * STEPS, Depth::Dithered) } else { (255, Depth::Bytes) };
        let (quantizer, width) = (Quantizer::new(tone, top), u64::from(width.max(1)));
        Self { quantizer, depth, width, pixels_done: 0, has_alpha: false }
    }

    /// 16-bit levels, big-endian, without dithering.
    pub fn words(tone: &Tone) -> Self {
        let quantizer = Quantizer::new(tone, u16::MAX);
        Self { quantizer, depth: Depth::Words, width: 1, pixels_done: 0, has_alpha: false }
    }

    /// Adds a level of alpha to each pixel, whose color becomes straight.
    pub fn with_alpha(self, has_alpha: bool) -> Self {
        Self { has_alpha, ..self }
    }

    /// Number of levels of a pixel.
    pub fn channels(&self) -> usize {
        if self.has_alpha { 4 } else { 3 }
    }

    /// Quantizes the next pixels to three levels each, and one of alpha if there is any. Without it,
    /// colors are over the backdrop of the tone, or over black.
    pub fn append(&mut self, rows: PixelRows, bytes: &mut Vec<u8>) {
        if !self.has_alpha {
            return self.append_colors(rows, bytes);
        }
        let mut colors = Vec::new();
        self.append_colors((&*rows.straight()).into(), &mut colors);
        let mut alpha = rows.alpha.unwrap_or_default().iter();
        let mut alpha = || alpha.next().map_or(1.0, |alpha| alpha.clamp(0.0, 1.0));
        if matches!(self.depth, Depth::Words) {
            for color in colors.chunks_exact(6) {
                bytes.extend_from_slice(color);
                bytes.extend(((alpha() * f32::from(u16::MAX)).round() as u16).to_be_bytes());
            }
        } else {
            for color in colors.chunks_exact(3) {
                bytes.extend_from_slice(color);
                bytes.push((alpha() * f32::from(u8::MAX)).round() as u8);
            }
        }
    }

    /// Quantizes the colors of the next pixels.
    fn append_colors(&mut self, rows: PixelRows, bytes: &mut Vec<u8>) {
        match self.depth {
            Depth::Words => self.quantizer.append_words(rows, bytes),
            Depth::Bytes => self.quantizer.append_bytes(rows, bytes),
            Depth::Dithered => {
                bytes.reserve(rows.len() * 3);
                for (number, levels) in (self.pixels_done..).zip(self.quantizer.all_levels(rows)) {
                    let up = threshold((number % self.width) as u32, (number / self.width) as u32);
                    bytes.extend(levels.map(|fine| ((fine + up) / STEPS) as u8));
                }
            }
        }
        self.pixels_done += rows.len() as u64;
    }
}

/// Threshold of a pixel, 0 to 255 steps, added before rounding down.
fn threshold(x: u32, y: u32) -> u16 {
    let at = x.wrapping_mul(ALPHA[0]).wrapping_add(y.wrapping_mul(ALPHA[1]));
    let folded = if at >> 31 == 0 { at } else { !at };
    (folded >> 23) as u16
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tone::{AnyCurve, Linear};
    use juggler_math::Rgb;

    fn bytes(tone: &Tone, width: u32, pixels: &[Rgb], piece: usize) -> Vec<u8> {
        let (mut levels, mut bytes) = (LevelEncoder::bytes(tone, width), Vec::new());
        pixels.chunks(piece).for_each(|piece| levels.append(piece.into(), &mut bytes));
        bytes
    }

    fn linear() -> Tone {
        Tone::new(AnyCurve::Linear(Linear {}))
    }

    #[test]
    fn dither_thresholds_are_uniform() {
        let mut counts = [0_u32; 256];
        (0..512).for_each(|y| (0..512).for_each(|x| counts[usize::from(threshold(x, y))] += 1));
        let (least, most) = (counts.iter().min().unwrap(), counts.iter().max().unwrap());
        assert!(*least > 1000 && *most < 1050, "{least} {most}");
    }

    #[test]
    fn dithering_preserves_the_mean() {
        // The mean over 64 × 64 pixels equals the value far more closely than with white noise,
        // whose standard deviation is 0.5 / 64.
        for i in 0..=64 {
            let value = 100.0 + f64::from(i) / 64.0;
            let flat = vec![Rgb::splat((value / 255.0) as f32); 64 * 64];
            let bytes = bytes(&linear(), 64, &flat, 4096);
            let mean = bytes.iter().map(|b| f64::from(*b)).sum::<f64>() / bytes.len() as f64;
            assert!((mean - value).abs() < 0.004, "{value} became {mean}");
        }
    }

    #[test]
    fn dithering_preserves_local_means() {
        // Means over 8 × 8 pixels of a gradient, as the eye averages them; rounding errs by up to
        // half a level.
        let (width, height) = (256_u32, 64_u32);
        let value = |x: u32| 20.0 + 3.0 * f64::from(x) / f64::from(width);
        let pixels: Vec<Rgb> = (0..width * height).map(|i| Rgb::splat((value(i % width) / 255.0) as f32)).collect();
        let bytes = bytes(&linear(), width, &pixels, 1000);
        for corner in (0..height / 8).flat_map(|y| (0..width / 8).map(move |x| [x * 8, y * 8])) {
            let within = (0..64).map(|i| [corner[0] + i % 8, corner[1] + i / 8]);
            let error = within.map(|[x, y]| f64::from(bytes[((y * width + x) * 3) as usize]) - value(x)).sum::<f64>();
            assert!((error / 64.0).abs() < 0.08, "{corner:?}: {}", error / 64.0);
        }
    }

    #[test]
    fn dithering_keeps_exact_levels() {
        for tone in [Tone::default(), linear()] {
            let decode = |k: u32| tone.curve.channel_curve().decode(f64::from(k) / 255.0) as f32;
            // Also slightly off the level, as sums of equal samples may be.
            for nudge in [0.999_997_f32, 1.0, 1.000_003] {
                let pixels: Vec<Rgb> = (0..256 * 64).map(|i| Rgb::splat(decode(i % 256) * nudge)).collect();
                for (i, byte) in bytes(&tone, 256, &pixels, 256).iter().enumerate() {
                    assert_eq!(usize::from(*byte), i / 3 % 256, "{nudge}");
                }
            }
        }
        let odd = [f32::NAN, f32::NEG_INFINITY, -3.0, f32::INFINITY, 7.0, 0.0].map(Rgb::splat);
        assert_eq!(bytes(&linear(), 6, &odd, 6), [0, 0, 0, 0, 0, 0, 0, 0, 0, 255, 255, 255, 255, 255, 255, 0, 0, 0]);
    }

    #[test]
    fn alpha_has_levels_of_its_own_and_colors_become_straight() {
        let colors = [0.5, 0.25, 0.7, 0.3].map(Rgb::splat);
        let alpha = [1.0, 0.5, 0.0, f32::NAN];
        let rows = PixelRows { colors: &colors, alpha: Some(&alpha) };
        let encoded = |mut levels: LevelEncoder| {
            let mut bytes = Vec::new();
            rows.chunks(3).for_each(|rows| levels.append(rows, &mut bytes));
            bytes
        };
        let flat = Tone { dither: false, ..linear() };
        let bytes = encoded(LevelEncoder::bytes(&flat, 4).with_alpha(true));
        assert_eq!(bytes, [128, 128, 128, 255, 128, 128, 128, 128, 0, 0, 0, 0, 0, 0, 0, 0]);
        let words = encoded(LevelEncoder::words(&flat).with_alpha(true));
        assert_eq!((words.len(), &words[6..8], &words[14..16]), (32, &[255, 255][..], &[128, 0][..]));
        assert_eq!(encoded(LevelEncoder::bytes(&flat, 4))[3..6], [64; 3], "without alpha, colors are over black");
    }

    #[test]
    fn dithering_does_not_depend_on_row_batches() {
        let pixels: Vec<Rgb> = (0..50 * 40).map(|i| Rgb::splat(i as f32 / 2000.0)).collect();
        let whole = bytes(&Tone::default(), 50, &pixels, 2000);
        for piece in [50, 150, 7] {
            assert_eq!(bytes(&Tone::default(), 50, &pixels, piece), whole);
        }
        let plain = bytes(&Tone { dither: false, ..Tone::default() }, 50, &pixels, 2000);
        assert_ne!(plain, whole);
        // Dithering changes a level by one at most.
        assert!(plain.iter().zip(&whole).all(|(a, b)| a.abs_diff(*b) <= 1));
    }
}
