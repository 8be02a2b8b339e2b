//! The film: sums of samples, in an order that nothing but the sample indices decides.
//!
//! A pixel's samples are summed in blocks of [`BLOCK`] consecutive indices, each block in order, and the
//! block sums are added in order. Whoever renders which block, on which thread or machine, the additions are
//! the same ones, so the bits are too.

use juggler_math::Rgb;

mod digest;
mod filter;

pub use digest::{Digest, Summary};
pub use filter::{AnyFilter, Box, Filter, FilterSample, Gaussian, Juggler, Mitchell, Reconstruction, Table, Tent};

/// Samples in a block.
pub const BLOCK: u32 = 16;

/// The running sum of one pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PixelSum {
    total: [f64; 3],
    block: Rgb,
}

impl PixelSum {
    /// Adds the samples from `index` on; indices must come in order, starting at a block's first. A sample that is
    /// no finite number counts as black. Returns how many were not.
    #[inline]
    pub fn add(&mut self, mut index: u32, mut samples: &[Rgb]) -> u64 {
        let mut lost = 0;
        while !samples.is_empty() {
            let room = (BLOCK - index % BLOCK) as usize;
            let (now, rest) = samples.split_at(room.min(samples.len()));
            lost += self.add_to_block(now);
            if now.len() == room {
                self.close();
            }
            index = index.wrapping_add(now.len() as u32);
            samples = rest;
        }
        lost
    }

    #[inline]
    fn add_to_block(&mut self, samples: &[Rgb]) -> u64 {
        let sum = samples.iter().fold(self.block, |sum, sample| sum + *sample);
        if sum.is_finite() {
            self.block = sum;
            return 0;
        }
        // Rarely: one of them spoils the sum.
        let (finite, lost): (Vec<Rgb>, Vec<Rgb>) = samples.iter().partition(|sample| sample.is_finite());
        self.block = finite.iter().fold(self.block, |sum, sample| sum + *sample);
        lost.len() as u64
    }

    fn close(&mut self) {
        let block = self.block.to_array();
        for (total, block) in self.total.iter_mut().zip(block) {
            *total += f64::from(block);
        }
        self.block = Rgb::BLACK;
    }

    /// The mean of all `count` samples.
    pub fn mean(mut self, count: u32) -> Rgb {
        self.close();
        let [r, g, b] = self.total.map(|total| (total / f64::from(count.max(1))) as f32);
        Rgb::new(r, g, b)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_is_the_mean_of_blocks_in_order() {
        let samples: Vec<Rgb> = (0..40).map(|i| Rgb::new(i as f32, 0.1, 1e-3 * i as f32)).collect();
        let mut sum = PixelSum::default();
        let mut by_pieces = PixelSum::default();
        assert_eq!(sum.add(0, &samples), 0);
        for (index, sample) in samples.iter().enumerate() {
            by_pieces.add(index as u32, std::slice::from_ref(sample));
        }
        assert_eq!(sum, by_pieces);
        let mut expected = [0f64; 3];
        for block in samples.chunks(BLOCK as usize) {
            let block = block.iter().fold(Rgb::BLACK, |a, b| a + *b);
            for (e, b) in expected.iter_mut().zip(block.to_array()) {
                *e += f64::from(b);
            }
        }
        let expected = expected.map(|e| (e / 40.0) as f32);
        assert_eq!(sum.mean(40).to_array(), expected);
        assert_eq!(PixelSum::default().mean(0), Rgb::BLACK);
    }
    #[test]
    fn samples_that_are_no_numbers_count_as_black_and_are_counted() {
        let (nan, infinite) = (Rgb::new(0.0, f32::NAN, 0.0), Rgb::new(f32::INFINITY, 0.0, 0.0));
        let mut sum = PixelSum::default();
        assert_eq!(sum.add(0, &[Rgb::WHITE, nan, Rgb::WHITE, infinite]), 2);
        assert_eq!(sum.mean(4), Rgb::splat(0.5));
    }
}
