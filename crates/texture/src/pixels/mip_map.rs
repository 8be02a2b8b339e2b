//! MIP map: an image and its copies of half the width and height each (Williams, Pyramidal
//! Parametrics, 1983).
//!
//! Texels of a copy are the means of the texels that they cover, in linear light. Where sides are
//! odd, a texel covers parts of three and weights them by area. Copies use the sample type of the
//! image.

use super::half;
use super::texels::{DecodingTable, Texels, alpha_from_level};
use rayon::prelude::*;

/// MIP map of an image, which reads texels in linear light.
#[derive(Clone, Debug, PartialEq)]
pub struct MipMap {
    /// Samples per texel: 1 is gray, 2 gray and alpha, 3 color, 4 color and alpha.
    channels: usize,
    /// Decoding table of 8-bit samples.
    decoding: DecodingTable,
    /// Levels from the image down to one texel.
    levels: Vec<MipLevel>,
}

/// One level of the MIP map.
#[derive(Clone, Debug, PartialEq)]
struct MipLevel {
    width: u32,
    height: u32,
    texels: Texels,
}

/// Red, green, blue and alpha of a texel; alpha is 1 in images without alpha.
pub type Texel = [f32; 4];

impl MipMap {
    /// MIP map of 8-bit samples, rows from the top, with `channels` (1 to 4) samples per texel.
    /// `decode` maps encoded values from 0 to 1 to linear light and must be monotonic. Returns
    /// `None` if the number of samples is 0 or differs from what width, height and channels
    /// require.
    pub fn from_bytes(size: [u32; 2], channels: u8, bytes: Vec<u8>, decode: impl Fn(f64) -> f64) -> Option<Self> {
        Self::build(size, channels, Texels::Bytes(bytes), DecodingTable::new(decode))
    }

    /// MIP map of samples in linear light, otherwise like [`MipMap::from_bytes`]. NaN counts as 0.
    pub fn from_floats(size: [u32; 2], channels: u8, numbers: Vec<f32>) -> Option<Self> {
        Self::build(size, channels, Texels::from_floats(numbers), DecodingTable::new(|level| level))
    }

    fn build([width, height]: [u32; 2], channels: u8, texels: Texels, decoding: DecodingTable) -> Option<Self> {
        let channels = usize::from(channels);
        let fits = (width as usize).checked_mul(height as usize)?.checked_mul(channels)? == texels.len();
        if !fits || texels.len() == 0 || !(1..=4).contains(&channels) {
            return None;
        }
        let mut mip_map = Self { channels, decoding, levels: vec![MipLevel { width, height, texels }] };
        while let Some(smaller) =
            mip_map.levels.last().filter(|mip| mip.width.max(mip.height) > 1).map(|mip| mip_map.next_level(mip))
        {
            mip_map.levels.push(smaller);
        }
        Some(mip_map)
    }

    /// Width and height of a level in texels. Level 0 is the image itself.
    pub fn size(&self, level: usize) -> [u32; 2] {
        self.levels.get(level).map_or([1, 1], |mip| [mip.width, mip.height])
    }

    /// Number of levels, at least 1. The last level has one texel.
    pub fn levels(&self) -> usize {
        self.levels.len()
    }

    /// Size on the heap in bytes.
    pub fn bytes(&self) -> usize {
        self.levels.iter().map(|mip| mip.texels.bytes()).sum()
    }

    /// Whether the image has an alpha channel.
    pub fn has_alpha(&self) -> bool {
        self.channels.is_multiple_of(2)
    }

    /// Texel of a level, counted from the top left; zeros outside of the level.
    #[inline]
    pub fn texel(&self, level: usize, x: u32, y: u32) -> Texel {
        match self.levels.get(level) {
            Some(mip) if x < mip.width && y < mip.height => self.read(mip, [mip.index(x, y)])[0],
            _ => [0.0; 4],
        }
    }

    /// Texels of a level in two columns of an upper and of a lower row, all inside of the level.
    #[inline]
    pub fn quad(&self, level: usize, [left, right]: [u32; 2], [top, bottom]: [u32; 2]) -> [Texel; 4] {
        let Some(mip) = self.levels.get(level) else { return [[0.0; 4]; 4] };
        self.read(mip, [mip.index(left, top), mip.index(right, top), mip.index(left, bottom), mip.index(right, bottom)])
    }

    /// Texels at the indices, which are decoded together.
    #[inline]
    fn read<const N: usize>(&self, mip: &MipLevel, indices: [usize; N]) -> [Texel; N] {
        match self.channels {
            1 => self.read_channels::<1, N>(&mip.texels, indices),
            2 => self.read_channels::<2, N>(&mip.texels, indices),
            3 => self.read_channels::<3, N>(&mip.texels, indices),
            _ => self.read_channels::<4, N>(&mip.texels, indices),
        }
    }

    /// [`MipMap::read`] of texels of `C` samples.
    #[inline]
    fn read_channels<const C: usize, const N: usize>(&self, texels: &Texels, indices: [usize; N]) -> [Texel; N] {
        match texels {
            Texels::Bytes(bytes) => decoded::<u8, C, N>(bytes, indices, |levels| {
                std::array::from_fn(|channel| match (self.is_alpha(channel), levels[channel]) {
                    (true, level) => alpha_from_level(level),
                    (false, level) => self.decoding.light(level),
                })
            }),
            Texels::Halves(halves) => decoded::<u16, C, N>(halves, indices, |bits| bits.map(half::to_f32)),
            Texels::Floats(floats) => decoded::<f32, C, N>(floats, indices, |numbers| numbers),
        }
    }

    /// Whether a sample of a texel is its alpha.
    #[inline]
    fn is_alpha(&self, channel: usize) -> bool {
        self.channels.is_multiple_of(2) && channel + 1 == self.channels
    }

    /// Next smaller level.
    fn next_level(&self, mip: &MipLevel) -> MipLevel {
        let (width, height) = ((mip.width / 2).max(1), (mip.height / 2).max(1));
        let row = width as usize * self.channels;
        let mut texels = mip.texels.zeros(row * height as usize);
        let mean = |x: usize, y: usize| self.mean(mip, [x, y], [width, height]);
        let channels = self.channels;
        match &mut texels {
            Texels::Bytes(bytes) => bytes.par_chunks_mut(row).enumerate().for_each(|(y, row)| {
                for (x, texel) in row.chunks_mut(channels).enumerate() {
                    for (channel, (sample, mean)) in texel.iter_mut().zip(mean(x, y)).enumerate() {
                        let level = (mean * 255.0 + 0.5) as u8;
                        *sample = if self.is_alpha(channel) { level } else { self.decoding.nearest(mean as f32) };
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
        MipLevel { width, height, texels }
    }

    /// Mean of the texels that texel (x, y) of a smaller level covers, with as many samples as a
    /// texel has.
    fn mean(&self, mip: &MipLevel, [x, y]: [usize; 2], [width, height]: [u32; 2]) -> [f64; 4] {
        let (columns, rows) = (covered_texels(x, width, mip.width), covered_texels(y, height, mip.height));
        let (mut sum, mut all) = ([0.0; 4], 0.0);
        for (row, tall) in rows {
            for (column, wide) in columns.clone() {
                let [texel] = self.read(mip, [row * mip.width as usize + column]);
                // Convert back to samples: the alpha of gray images is the second one.
                let samples = if self.channels == 2 { [texel[0], texel[3], 0.0, 0.0] } else { texel };
                sum.iter_mut().zip(samples).for_each(|(sum, sample)| *sum += f64::from(sample) * tall * wide);
                all += tall * wide;
            }
        }
        sum.map(|sum| sum / all)
    }
}

impl MipLevel {
    /// Index of a texel.
    #[inline]
    fn index(&self, x: u32, y: u32) -> usize {
        x as usize + y as usize * self.width as usize
    }
}

/// Texels of `C` samples at the indices, by the function that decodes one of them.
#[inline]
fn decoded<T: Copy, const C: usize, const N: usize>(
    samples: &[T],
    indices: [usize; N],
    decode: impl Fn([T; C]) -> [f32; C],
) -> [Texel; N] {
    let (texels, _) = samples.as_chunks::<C>();
    indices.map(|index| match texels.get(index).map_or([0.0; C], |texel| decode(*texel)).as_slice() {
        [gray] => [*gray, *gray, *gray, 1.0],
        [gray, alpha] => [*gray, *gray, *gray, *alpha],
        [red, green, blue] => [*red, *green, *blue, 1.0],
        [red, green, blue, alpha, ..] => [*red, *green, *blue, *alpha],
        [] => [0.0; 4],
    })
}

/// Texels of a row of `from` that texel `i` of a row of `to` covers, with the covered share of
/// texel `i`.
fn covered_texels(i: usize, to: u32, from: u32) -> impl Iterator<Item = (usize, f64)> + Clone {
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

    fn mean(mip_map: &MipMap, level: usize) -> [f64; 4] {
        let [width, height] = mip_map.size(level);
        let mut sum = [0.0; 4];
        for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
            let texel = mip_map.texel(level, x, y);
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
                let floats = MipMap::from_floats([width, height], channels, numbers).unwrap();
                let levels = MipMap::from_bytes([width, height], channels, bytes, srgb_decode_f64).unwrap();
                for (mip_map, tolerance) in [(floats, 1e-5), (levels, 0.02)] {
                    let first = mean(&mip_map, 0);
                    for level in 1..mip_map.levels() {
                        let other = mean(&mip_map, level);
                        assert!(
                            (0..4).all(|i| (first[i] - other[i]).abs() < tolerance),
                            "{width} {height}: {first:?} {other:?}"
                        );
                    }
                    assert_eq!(mip_map.size(mip_map.levels() - 1), [1, 1]);
                }
            }
        }
    }

    #[test]
    fn mip_levels_of_bytes_average_in_linear_space() {
        // Alternating black and white has half of the light, level 188.
        let bytes: Vec<u8> = (0..64 * 64).map(|i| if (i + i / 64) % 2 == 0 { 0 } else { 255 }).collect();
        let mip_map = MipMap::from_bytes([64, 64], 1, bytes, srgb_decode_f64).unwrap();
        for level in 1..mip_map.levels() {
            assert!((mip_map.texel(level, 0, 0)[0] - 0.5).abs() < 0.005);
        }
        let gray = MipMap::from_bytes([9, 7], 3, vec![100; 9 * 7 * 3], srgb_decode_f64).unwrap();
        assert!((0..gray.levels()).all(|level| gray.texel(level, 0, 0) == gray.texel(0, 8, 6)), "what is even stays");
    }

    #[test]
    fn mip_levels_add_a_third_and_keep_the_sample_type() {
        let bytes = MipMap::from_bytes([256, 256], 4, vec![7; 1 << 18], srgb_decode_f64).unwrap();
        assert_eq!((bytes.bytes(), bytes.levels(), bytes.has_alpha()), (349_524, 9, true));
        let halves = MipMap::from_floats([256, 256], 1, vec![0.5; 1 << 16]).unwrap();
        assert_eq!((halves.bytes(), halves.has_alpha()), (2 * 87_381, false));
        assert_eq!(halves.texel(8, 0, 0), [0.5, 0.5, 0.5, 1.0]);
        assert_eq!((halves.texel(0, 256, 0), halves.texel(99, 0, 0)), ([0.0; 4], [0.0; 4]));
    }

    #[test]
    fn texels_map_channels_to_rgba() {
        let of = |channels, bytes: &[u8]| {
            MipMap::from_bytes([1, 1], channels, bytes.to_vec(), |level| level)
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
    fn mismatched_sizes_are_rejected() {
        for (size, channels, count) in [([2, 2], 3, 11), ([0, 5], 1, 0), ([1, 1], 5, 5), ([1, 1], 0, 0)] {
            assert!(MipMap::from_bytes(size, channels, vec![0; count], |level| level).is_none());
        }
        assert!(MipMap::from_floats([u32::MAX, u32::MAX], 4, vec![0.0; 4]).is_none());
    }
}
