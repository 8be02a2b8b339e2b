//! A hash and a mean of the film's linear pixels, taken row by row.

use super::Clamped;
use juggler_math::Rgb;

/// Pixels that are hashed at once: enough for the hash to work on several parts of them side by side.
const PIECE: usize = 1 << 14;

/// Takes in the pixels of a film, row by row from the top.
#[derive(Clone)]
pub struct Digest {
    hasher: blake3::Hasher,
    sum: [f64; 3],
    pixels: u64,
    clamped: Clamped,
}

/// What a [`Digest`] comes to.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// Hash of size and pixels: BLAKE3, hexadecimal. Equal pictures have equal hashes, to the bit.
    pub hash: String,
    /// Mean of the pixels.
    pub mean: [f64; 3],
    /// Mean of what clamping took off the pixels, over all channels.
    pub clamped: f64,
}

impl Summary {
    /// Which share of the light clamping took away, from 0 to 1.
    pub fn clamped_share(&self) -> f64 {
        let [r, g, b] = self.mean;
        let all = (r + g + b) / 3.0 + self.clamped;
        if all > 0.0 { (self.clamped / all).clamp(0.0, 1.0) } else { 0.0 }
    }
}

impl Digest {
    /// For a picture of this size.
    pub fn new(width: u32, height: u32) -> Self {
        let mut hasher = blake3::Hasher::new();
        hasher.update(&width.to_le_bytes());
        hasher.update(&height.to_le_bytes());
        Self { hasher, sum: [0.0; 3], pixels: 0, clamped: Clamped::default() }
    }

    /// The next pixels.
    pub fn update(&mut self, pixels: &[Rgb]) {
        let mut bytes = Vec::with_capacity(PIECE.min(pixels.len()) * size_of::<Rgb>());
        for piece in pixels.chunks(PIECE) {
            bytes.clear();
            for pixel in piece {
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

    /// What clamping took off pixels, in any order.
    pub fn clamp(&mut self, clamped: Clamped) {
        self.clamped.add_all(clamped);
    }

    /// The result so far.
    pub fn finish(&self) -> Summary {
        let hash = self.hasher.finalize().to_hex().to_string();
        let pixels = self.pixels.max(1) as f64;
        Summary { hash, mean: self.sum.map(|sum| sum / pixels), clamped: self.clamped.total() / pixels }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hash_sees_every_bit_and_no_cut() {
        let pixels: Vec<Rgb> = (0..12).map(|i| Rgb::new(i as f32, 1.0, -0.0)).collect();
        let hash = |width: u32, height: u32, parts: &[&[Rgb]]| {
            let mut digest = Digest::new(width, height);
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
