//! Binary frames: a header of [`HEADER_BYTES`] and an image file. Frames in motion are small,
//! refined ones of high quality, and the finished one is lossless.

use jpeg_encoder::{ColorType, Encoder};
use juggler_session::Frame;
use std::sync::Arc;
use tokio::sync::Mutex;

/// Size of the header: serial number and kind as 32 bits, frame number and revision as 64 bits,
/// width, height and samples (a float) as 32 bits; little-endian.
pub const HEADER_BYTES: usize = 36;
/// Number of cached encodings for other pages.
const CACHE_SIZE: usize = 3;

/// Encoding of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    /// JPEG of low quality, for frames in motion.
    Moving = 0,
    /// JPEG of high quality, for refined frames.
    Refining = 1,
    /// PNG, lossless.
    Exact = 2,
}

impl Encoding {
    fn jpeg_quality(self) -> Option<u8> {
        match self {
            Self::Moving => Some(82),
            Self::Refining => Some(93),
            Self::Exact => None,
        }
    }
}

/// Encoded frame.
#[derive(Clone)]
pub struct EncodedFrame {
    /// Source frame.
    pub frame: Arc<Frame>,
    encoding: Encoding,
    image: Arc<[u8]>,
}

impl EncodedFrame {
    /// Returns the binary message. The page acknowledges `serial`.
    pub fn message(&self, serial: u32) -> Vec<u8> {
        let [width, height] = self.frame.size;
        let mut bytes = Vec::with_capacity(HEADER_BYTES + self.image.len());
        bytes.extend(serial.to_le_bytes());
        bytes.extend((self.encoding as u32).to_le_bytes());
        bytes.extend(self.frame.number.to_le_bytes());
        bytes.extend(self.frame.revision.to_le_bytes());
        bytes.extend(width.to_le_bytes());
        bytes.extend(height.to_le_bytes());
        bytes.extend(self.frame.samples.to_le_bytes());
        bytes.extend(&*self.image);
        bytes
    }
}

/// Encoder with a cache: each frame is encoded once for all pages.
#[derive(Default)]
pub struct FrameEncoder {
    cache: Mutex<Vec<EncodedFrame>>,
}

impl FrameEncoder {
    /// Encodes a frame on another thread; `None` if encoding fails.
    pub async fn encode(&self, frame: &Arc<Frame>, encoding: Encoding) -> Option<EncodedFrame> {
        let mut cache = self.cache.lock().await;
        if let Some(found) = cache.iter().find(|one| one.encoding == encoding && one.frame.number == frame.number) {
            return Some(found.clone());
        }
        let work = Arc::clone(frame);
        let image = tokio::task::spawn_blocking(move || encode_image(&work, encoding)).await.ok()??;
        let encoded = EncodedFrame { frame: Arc::clone(frame), encoding, image: image.into() };
        if cache.len() >= CACHE_SIZE {
            cache.remove(0);
        }
        cache.push(encoded.clone());
        Some(encoded)
    }
}

fn encode_image(frame: &Frame, encoding: Encoding) -> Option<Vec<u8>> {
    let edges = u16::try_from(frame.width).ok().zip(u16::try_from(frame.height).ok());
    match encoding.jpeg_quality().zip(edges) {
        Some((quality, (width, height))) => jpeg(&frame.rgba, width, height, quality),
        None => lossless(frame),
    }
}

/// Encodes RGBA pixels as a JPEG file.
pub fn jpeg(rgba: &[u8], width: u16, height: u16, quality: u8) -> Option<Vec<u8>> {
    let mut bytes = Vec::new();
    Encoder::new(&mut bytes, quality).encode(rgba, width, height, ColorType::Rgba).ok()?;
    Some(bytes)
}

fn lossless(frame: &Frame) -> Option<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, frame.width, frame.height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_compression(png::Compression::Fast);
    encoder.write_header().ok()?.write_image_data(&frame.rgba).ok()?;
    Some(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(width: u32, height: u32) -> Arc<Frame> {
        let pixel = |i: u32| [(i % 251) as u8, (i % 13 * 19) as u8, 7, 255];
        let rgba = (0..width * height).flat_map(pixel).collect();
        Arc::new(Frame { number: 5, revision: 3, width, height, rgba, size: [width * 2, height * 2], samples: 1.5 })
    }

    #[tokio::test]
    async fn the_head_says_what_follows_and_the_exact_kind_loses_nothing() {
        let (encoder, frame) = (FrameEncoder::default(), frame(16, 9));
        let exact = encoder.encode(&frame, Encoding::Exact).await.unwrap().message(77);
        let word = |at: usize| u32::from_le_bytes(exact[at..at + 4].try_into().unwrap());
        assert_eq!([word(0), word(4), word(8), word(16), word(24), word(28)], [77, 2, 5, 3, 32, 18]);
        assert_eq!(f32::from_bits(word(32)), 1.5);
        let mut reader = png::Decoder::new(std::io::Cursor::new(&exact[HEADER_BYTES..])).read_info().unwrap();
        let mut pixels = vec![0; 16 * 9 * 4];
        reader.next_frame(&mut pixels).unwrap();
        assert_eq!(pixels, frame.rgba);
        let small = encoder.encode(&frame, Encoding::Moving).await.unwrap().message(78);
        assert_eq!(small[HEADER_BYTES..HEADER_BYTES + 2], [0xff, 0xd8]);
        assert!(encoder.encode(&self::frame(70_000, 1), Encoding::Moving).await.is_some(), "too wide for a JPEG");
    }

    #[tokio::test]
    async fn few_encodings_are_kept() {
        let encoder = FrameEncoder::default();
        for number in 0..20 {
            let frame = Frame { number, ..(*frame(4, 4)).clone() };
            encoder.encode(&Arc::new(frame), Encoding::Refining).await.unwrap();
        }
        assert_eq!(encoder.cache.lock().await.len(), CACHE_SIZE);
    }
}
