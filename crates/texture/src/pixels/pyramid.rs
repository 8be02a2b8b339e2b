//! A picture and its smaller copies, each half as wide and high as the one before (Williams, Pyramidal Parametrics, 1983).
//!
//! Texels of a smaller copy are the means of what they cover, in linear light, also where sides are odd: there they weigh the
//! three texels that they cover by how much of each. Copies are stored as the picture is.

use super::half;
use super::texels::{Levels, Texels, share};
use rayon::prelude::*;

/// A picture and its smaller copies, in linear light as it is read.
#[derive(Clone, Debug, PartialEq)]
pub struct Pyramid {
    /// Samples a texel: 1 is grey, 2 grey and alpha, 3 colour, 4 colour and alpha.
    channels: usize,
    /// What bytes stand for.
    levels: Levels,
    /// From the picture to one texel.
    maps: Vec<Map>,
}

/// One of the pictures.
#[derive(Clone, Debug, PartialEq)]
struct Map {
    width: u32,
    height: u32,
    texels: Texels,
}

/// The channels of a texel; alpha is 1 where there is none.
pub type Texel = [f32; 4];

impl Pyramid {
    /// Of levels of 8 bits, rows from the top, `channels` (1 to 4) a texel; `decode` makes light of levels from 0 to 1, and must
    /// rise. `None` when there are not as many as width, height and channels say, or none at all.
    pub fn of_bytes(size: [u32; 2], channels: u8, bytes: Vec<u8>, decode: impl Fn(f64) -> f64) -> Option<Self> {
        Self::build(size, channels, Texels::Bytes(bytes), Levels::new(decode))
    }

    /// Of numbers, linear light. What is no number counts as 0.
    pub fn of_numbers(size: [u32; 2], channels: u8, numbers: Vec<f32>) -> Option<Self> {
        Self::build(size, channels, Texels::of_numbers(numbers), Levels::new(|level| level))
    }

    fn build([width, height]: [u32; 2], channels: u8, texels: Texels, levels: Levels) -> Option<Self> {
        let channels = usize::from(channels);
        let fits = (width as usize).checked_mul(height as usize)?.checked_mul(channels)? == texels.len();
        if !fits || texels.len() == 0 || !(1..=4).contains(&channels) {
            return None;
        }
        let mut pyramid = Self { channels, levels, maps: vec![Map { width, height, texels }] };
        while let Some(smaller) =
            pyramid.maps.last().filter(|map| map.width.max(map.height) > 1).map(|map| pyramid.half(map))
        {
            pyramid.maps.push(smaller);
        }
        Some(pyramid)
    }

    /// Texels in a row of a level; 0 is the picture itself.
    pub fn size(&self, level: usize) -> [u32; 2] {
        self.maps.get(level).map_or([1, 1], |map| [map.width, map.height])
    }

    /// How many levels there are, at least 1; the last has one texel.
    pub fn levels(&self) -> usize {
        self.maps.len()
    }

    /// Bytes on the heap.
    pub fn bytes(&self) -> usize {
        self.maps.iter().map(|map| map.texels.bytes()).sum()
    }

    /// Whether texels have an alpha of their own.
    pub fn has_alpha(&self) -> bool {
        self.channels.is_multiple_of(2)
    }

    /// A texel of a level, from the top left; black where there is none.
    #[inline]
    pub fn texel(&self, level: usize, x: u32, y: u32) -> Texel {
        match self.maps.get(level) {
            Some(map) if x < map.width && y < map.height => {
                self.read(map, x as usize + y as usize * map.width as usize)
            }
            _ => [0.0; 4],
        }
    }

    #[inline]
    fn read(&self, map: &Map, index: usize) -> Texel {
        let start = index * self.channels;
        let mut samples = [0.0; 4];
        match &map.texels {
            Texels::Bytes(bytes) => {
                let texel = bytes.get(start..start + self.channels).unwrap_or_default();
                for (channel, (sample, level)) in samples.iter_mut().zip(texel).enumerate() {
                    *sample = if self.is_alpha(channel) { share(*level) } else { self.levels.light(*level) };
                }
            }
            Texels::Halves(halves) => {
                let texel = halves.get(start..start + self.channels).unwrap_or_default();
                samples.iter_mut().zip(texel).for_each(|(sample, bits)| *sample = half::to_f32(*bits));
            }
            Texels::Floats(floats) => {
                let texel = floats.get(start..start + self.channels).unwrap_or_default();
                samples.iter_mut().zip(texel).for_each(|(sample, number)| *sample = *number);
            }
        }
        let [a, b, c, d] = samples;
        match self.channels {
            1 => [a, a, a, 1.0],
            2 => [a, a, a, b],
            3 => [a, b, c, 1.0],
            _ => [a, b, c, d],
        }
    }

    /// Whether a sample of a texel is its alpha.
    #[inline]
    fn is_alpha(&self, channel: usize) -> bool {
        self.channels.is_multiple_of(2) && channel + 1 == self.channels
    }

    /// The next smaller copy.
    fn half(&self, map: &Map) -> Map {
        let (width, height) = ((map.width / 2).max(1), (map.height / 2).max(1));
        let row = width as usize * self.channels;
        let mut texels = map.texels.zeros(row * height as usize);
        let mean = |x: usize, y: usize| self.mean(map, [x, y], [width, height]);
        let channels = self.channels;
        match &mut texels {
            Texels::Bytes(bytes) => bytes.par_chunks_mut(row).enumerate().for_each(|(y, row)| {
                for (x, texel) in row.chunks_mut(channels).enumerate() {
                    for (channel, (sample, mean)) in texel.iter_mut().zip(mean(x, y)).enumerate() {
                        let level = (mean * 255.0 + 0.5) as u8;
                        *sample = if self.is_alpha(channel) { level } else { self.levels.nearest(mean as f32) };
                    }
                }
            }),
            Texels::Halves(halves) => halves.par_chunks_mut(row).enumerate().for_each(|(y, row)| {
                for (x, texel) in row.chunks_mut(channels).enumerate() {
                    texel.iter_mut().zip(mean(x, y)).for_each(|(sample, mean)| *sample = half::from_f32(mean as f32));
                }
            }),
            Texels::Floats(floats) => floats.par_chunks_mut(row).enumerate().for_each(|(y, row)| {
                for (x, texel) in row.chunks_mut(channels).enumerate() {
                    texel.iter_mut().zip(mean(x, y)).for_each(|(sample, mean)| *sample = mean as f32);
                }
            }),
        }
        Map { width, height, texels }
    }

    /// The mean of what a texel of a smaller picture covers: as many samples as a texel has.
    fn mean(&self, map: &Map, [x, y]: [usize; 2], [width, height]: [u32; 2]) -> [f64; 4] {
        let (columns, rows) = (covered(x, width, map.width), covered(y, height, map.height));
        let (mut sum, mut all) = ([0.0; 4], 0.0);
        for (row, tall) in rows {
            for (column, wide) in columns.clone() {
                let texel = self.read(map, row * map.width as usize + column);
                // Back to samples: what is grey has its alpha second.
                let samples = if self.channels == 2 { [texel[0], texel[3], 0.0, 0.0] } else { texel };
                sum.iter_mut().zip(samples).for_each(|(sum, sample)| *sum += f64::from(sample) * tall * wide);
                all += tall * wide;
            }
        }
        sum.map(|sum| sum / all)
    }
}

/// The texels of a line of `from` that texel `i` of a line of `to` covers, and how much of each, in texels of `to`.
fn covered(i: usize, to: u32, from: u32) -> impl Iterator<Item = (usize, f64)> + Clone {
    let (i, to, from) = (i as u64, u64::from(to), u64::from(from));
    let (start, end) = (i * from, (i + 1) * from);
    (start / to..end.div_ceil(to)).map(move |texel| {
        let share = ((texel + 1) * to).min(end) - (texel * to).max(start);
        (texel as usize, share as f64 / from as f64)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::color::srgb_decode_f64;
    use juggler_math::testing::Random;

    fn mean(pyramid: &Pyramid, level: usize) -> [f64; 4] {
        let [width, height] = pyramid.size(level);
        let mut sum = [0.0; 4];
        for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
            let texel = pyramid.texel(level, x, y);
            (0..4).for_each(|i| sum[i] += f64::from(texel[i]));
        }
        sum.map(|sum| sum / f64::from(width * height))
    }

    #[test]
    fn all_levels_have_the_pictures_mean() {
        let mut random = Random::new(731);
        for (width, height) in [(64, 64), (37, 21), (5, 1), (1, 100), (63, 2)] {
            for channels in 1..=4u8 {
                let count = width as usize * height as usize * usize::from(channels);
                let numbers: Vec<f32> = (0..count).map(|_| random.range(-1.0, 5.0)).collect();
                let bytes: Vec<u8> = (0..count).map(|_| random.bits() as u8).collect();
                let floats = Pyramid::of_numbers([width, height], channels, numbers).unwrap();
                let levels = Pyramid::of_bytes([width, height], channels, bytes, srgb_decode_f64).unwrap();
                for (pyramid, tolerance) in [(floats, 1e-5), (levels, 0.02)] {
                    let first = mean(&pyramid, 0);
                    for level in 1..pyramid.levels() {
                        let other = mean(&pyramid, level);
                        assert!(
                            (0..4).all(|i| (first[i] - other[i]).abs() < tolerance),
                            "{width} {height}: {first:?} {other:?}"
                        );
                    }
                    assert_eq!(pyramid.size(pyramid.levels() - 1), [1, 1]);
                }
            }
        }
    }

    #[test]
    fn bytes_keep_their_mean_in_light_not_in_levels() {
        // Black and white in turn are half of the light, level 188.
        let bytes: Vec<u8> = (0..64 * 64).map(|i| if (i + i / 64) % 2 == 0 { 0 } else { 255 }).collect();
        let pyramid = Pyramid::of_bytes([64, 64], 1, bytes, srgb_decode_f64).unwrap();
        for level in 1..pyramid.levels() {
            assert!((pyramid.texel(level, 0, 0)[0] - 0.5).abs() < 0.005);
        }
        let grey = Pyramid::of_bytes([9, 7], 3, vec![100; 9 * 7 * 3], srgb_decode_f64).unwrap();
        assert!((0..grey.levels()).all(|level| grey.texel(level, 0, 0) == grey.texel(0, 8, 6)), "what is even stays");
    }

    #[test]
    fn copies_take_a_third_more_in_the_kind_of_the_picture() {
        let bytes = Pyramid::of_bytes([256, 256], 4, vec![7; 1 << 18], srgb_decode_f64).unwrap();
        assert_eq!((bytes.bytes(), bytes.levels(), bytes.has_alpha()), (349_524, 9, true));
        let halves = Pyramid::of_numbers([256, 256], 1, vec![0.5; 1 << 16]).unwrap();
        assert_eq!((halves.bytes(), halves.has_alpha()), (2 * 87_381, false));
        assert_eq!(halves.texel(8, 0, 0), [0.5, 0.5, 0.5, 1.0]);
        assert_eq!((halves.texel(0, 256, 0), halves.texel(99, 0, 0)), ([0.0; 4], [0.0; 4]));
    }

    #[test]
    fn channels_are_read_as_they_lie() {
        let of = |channels, bytes: &[u8]| {
            Pyramid::of_bytes([1, 1], channels, bytes.to_vec(), |level| level)
                .unwrap()
                .texel(0, 0, 0)
                .map(|v| (v * 255.0).round())
        };
        assert_eq!(of(1, &[51]), [51.0, 51.0, 51.0, 255.0]);
        assert_eq!(of(2, &[51, 7]), [51.0, 51.0, 51.0, 7.0]);
        assert_eq!(of(3, &[1, 2, 3]), [1.0, 2.0, 3.0, 255.0]);
        assert_eq!(of(4, &[1, 2, 3, 4]), [1.0, 2.0, 3.0, 4.0]);
    }

    #[test]
    fn what_does_not_fit_is_none() {
        for (size, channels, count) in [([2, 2], 3, 11), ([0, 5], 1, 0), ([1, 1], 5, 5), ([1, 1], 0, 0)] {
            assert!(Pyramid::of_bytes(size, channels, vec![0; count], |level| level).is_none());
        }
        assert!(Pyramid::of_numbers([u32::MAX, u32::MAX], 4, vec![0.0; 4]).is_none());
    }
}
