//! Hash and mean of the film's linear pixels, updated row by row.

use super::ClampedRadiance;
use juggler_math::Rgb;

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
    /// BLAKE3 hash of size and pixels, in hexadecimal. Pictures with the same bits have the same
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
    pub fn update(&mut self, pixels: &[Rgb]) {
        let mut bytes = Vec::with_capacity(CHUNK_PIXELS.min(pixels.len()) * size_of::<Rgb>());
        for chunk in pixels.chunks(CHUNK_PIXELS) {
            bytes.clear();
            for pixel in chunk {
                for (sum, channel) in self.sum.iter_mut().zip(pixel.to_array()) {
                    *sum += f64::from(channel);
                }
                let [[a, b, c, d], [e, f, g, h], [i, j, k, l]] = pixel.to_array().map(f32::to_le_bytes);
                bytes.extend_from_slice(&[a, b, c, d, e, f, g, h, i, j, k, l]);
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

    #[test]
    fn film_hash_covers_every_bit_and_ignores_chunking() {
        let pixels: Vec<Rgb> = (0..12).map(|i| Rgb::new(i as f32, 1.0, -0.0)).collect();
        let hash = |width: u32, height: u32, parts: &[&[Rgb]]| {
            let mut digest = FilmDigest::new(width, height);
            parts.iter().for_each(|part| digest.update(part));
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
}
