//! Hash and mean of the film's linear pixels, updated row by row.

use super::ClampedRadiance;
use juggler_math::PixelRows;

/// Pixels per call of the hash function: enough for it to hash several chunks in parallel.
const CHUNK_PIXELS: usize = 1 << 14;

/// Incremental hash and mean of the pixels of a film, row by row from the top.
#[derive(Clone)]
pub struct FilmDigest {
    hasher: blake3::Hasher,
    sum: [f64; 3],
    pixels: u64,
    clamped: ClampedRadiance,
}

/// Result of a [`FilmDigest`].
#[derive(Clone, Debug, PartialEq)]
pub struct FilmSummary {
    /// BLAKE3 hash of size and pixels, with their alpha if they have any, in hexadecimal. Pictures with the same bits have the same
    /// hash.
    pub hash: String,
    /// Mean of the pixels, linear RGB.
    pub mean: [f64; 3],
    /// Mean radiance that clamping removed, over all pixels and channels.
    pub clamped: f64,
}

impl FilmSummary {
    /// Fraction of the light that clamping removed, from 0 to 1.
    pub fn clamped_fraction(&self) -> f64 {
        let [r, g, b] = self.mean;
        let all = (r + g + b) / 3.0 + self.clamped;
        if all > 0.0 { (self.clamped / all).clamp(0.0, 1.0) } else { 0.0 }
    }
}

impl FilmDigest {
    /// Creates a digest for a picture of this size in pixels.
    pub fn new(width: u32, height: u32) -> Self {
        let mut hasher = blake3::Hasher::new();
        hasher.update(&width.to_le_bytes());
        hasher.update(&height.to_le_bytes());
        Self { hasher, sum: [0.0; 3], pixels: 0, clamped: ClampedRadiance::default() }
    }

    /// Adds the next pixels.
    pub fn update<'a>(&mut self, pixels: impl Into<PixelRows<'a>>) {
        let pixels: PixelRows = pixels.into();
        let mut bytes = Vec::with_capacity(CHUNK_PIXELS.min(pixels.len()) * 4 * size_of::<f32>());
        for chunk in pixels.chunks(CHUNK_PIXELS) {
            bytes.clear();
            let mut alpha = chunk.alpha.into_iter().flatten();
            for pixel in chunk.colors {
                for (sum, channel) in self.sum.iter_mut().zip(pixel.to_array()) {
                    *sum += f64::from(channel);
                }
                let [[a, b, c, d], [e, f, g, h], [i, j, k, l]] = pixel.to_array().map(f32::to_le_bytes);
                bytes.extend_from_slice(&[a, b, c, d, e, f, g, h, i, j, k, l]);
                if let Some(alpha) = alpha.next() {
                    bytes.extend_from_slice(&alpha.to_le_bytes());
                }
            }
            self.hasher.update(&bytes);
        }
        self.pixels += pixels.len() as u64;
    }

    /// Adds the radiance that clamping removed from pixels, in any order.
    pub fn add_clamped(&mut self, clamped: ClampedRadiance) {
        self.clamped.add_all(clamped);
    }

    /// Result of the pixels so far.
    pub fn finish(&self) -> FilmSummary {
        let hash = self.hasher.finalize().to_hex().to_string();
        let pixels = self.pixels.max(1) as f64;
        FilmSummary { hash, mean: self.sum.map(|sum| sum / pixels), clamped: self.clamped.total() / pixels }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::Rgb;

    #[test]
    fn film_hash_covers_every_bit_and_ignores_chunking() {
        let pixels: Vec<Rgb> = (0..12).map(|i| Rgb::new(i as f32, 1.0, -0.0)).collect();
        let hash = |width: u32, height: u32, parts: &[&[Rgb]]| {
            let mut digest = FilmDigest::new(width, height);
            parts.iter().for_each(|part| digest.update(*part));
            digest.finish()
        };
        let whole = hash(4, 3, &[&pixels]);
        assert_eq!(whole, hash(4, 3, &[&pixels[..4], &pixels[4..]]));
        assert_ne!(whole.hash, hash(3, 4, &[&pixels]).hash);
        let mut other = pixels.clone();
        other[11].b = 0.0;
        assert_ne!(whole.hash, hash(4, 3, &[&other]).hash, "-0 and 0 are different bits");
        assert_eq!(whole.mean, [5.5, 1.0, 0.0]);
    }

    #[test]
    fn film_hash_covers_alpha() {
        let colors = [Rgb::WHITE; 4];
        let hash = |alpha: &[f32], piece: usize| {
            let mut digest = FilmDigest::new(2, 2);
            let rows = PixelRows { colors: &colors, alpha: Some(alpha) };
            rows.chunks(piece).for_each(|rows| digest.update(rows));
            digest.finish().hash
        };
        let alpha = [1.0, 1.0, 0.5, 1.0];
        assert_eq!(hash(&alpha, 4), hash(&alpha, 1));
        assert_ne!(hash(&alpha, 4), hash(&[1.0, 0.5, 1.0, 1.0], 4));
        let mut opaque = FilmDigest::new(2, 2);
        opaque.update(&colors);
        assert_ne!(hash(&[1.0; 4], 4), opaque.finish().hash, "a picture with alpha is another picture");
    }
}
