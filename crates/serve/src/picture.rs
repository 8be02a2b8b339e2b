//! Frames as pages get them: a head of [`HEADER_BYTES`] and an image file. Moving pictures are small, refining ones good,
//! the finished one is lossless.

use jpeg_encoder::{ColorType, Encoder};
use juggler_session::Frame;
use std::sync::Arc;
use tokio::sync::Mutex;

/// Bytes before the image file: serial number and kind as 32 bits, number and revision as 64 bits, width, height and
/// samples (a float) as 32 bits; little-endian.
pub const HEADER_BYTES: usize = 36;
/// Encodings that are kept, for other pages that want the same.
const KEPT: usize = 3;

/// How a frame is packed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// JPEG, small.
    Moving = 0,
    /// JPEG, good.
    Refining = 1,
    /// PNG.
    Exact = 2,
}

impl Kind {
    fn jpeg_quality(self) -> Option<u8> {
        match self {
            Self::Moving => Some(82),
            Self::Refining => Some(93),
            Self::Exact => None,
        }
    }
}

/// An encoded frame.
#[derive(Clone)]
pub struct Picture {
    /// The frame that it was.
    pub frame: Arc<Frame>,
    kind: Kind,
    image: Arc<[u8]>,
}

impl Picture {
    /// The message: head and file. `serial` is what the page will acknowledge.
    pub fn message(&self, serial: u32) -> Vec<u8> {
        let [width, height] = self.frame.size;
        let mut bytes = Vec::with_capacity(HEADER_BYTES + self.image.len());
        bytes.extend(serial.to_le_bytes());
        bytes.extend((self.kind as u32).to_le_bytes());
        bytes.extend(self.frame.number.to_le_bytes());
        bytes.extend(self.frame.revision.to_le_bytes());
        bytes.extend(width.to_le_bytes());
        bytes.extend(height.to_le_bytes());
        bytes.extend(self.frame.samples.to_le_bytes());
        bytes.extend(&*self.image);
        bytes
    }
}

/// Encodes each frame once, however many pages there are.
#[derive(Default)]
pub struct Packer {
    kept: Mutex<Vec<Picture>>,
}

impl Packer {
    /// The frame in this kind, packed on another thread; nothing when it cannot be.
    pub async fn pack(&self, frame: &Arc<Frame>, kind: Kind) -> Option<Picture> {
        let mut kept = self.kept.lock().await;
        if let Some(found) = kept.iter().find(|one| one.kind == kind && one.frame.number == frame.number) {
            return Some(found.clone());
        }
        let work = Arc::clone(frame);
        let image = tokio::task::spawn_blocking(move || encode(&work, kind)).await.ok()??;
        let picture = Picture { frame: Arc::clone(frame), kind, image: image.into() };
        if kept.len() >= KEPT {
            kept.remove(0);
        }
        kept.push(picture.clone());
        Some(picture)
    }
}

fn encode(frame: &Frame, kind: Kind) -> Option<Vec<u8>> {
    let edges = u16::try_from(frame.width).ok().zip(u16::try_from(frame.height).ok());
    match kind.jpeg_quality().zip(edges) {
        Some((quality, (width, height))) => jpeg(&frame.rgba, width, height, quality),
        None => lossless(frame),
    }
}

/// A JPEG of red, green, blue, opaque.
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
        let (packer, frame) = (Packer::default(), frame(16, 9));
        let exact = packer.pack(&frame, Kind::Exact).await.unwrap().message(77);
        let word = |at: usize| u32::from_le_bytes(exact[at..at + 4].try_into().unwrap());
        assert_eq!([word(0), word(4), word(8), word(16), word(24), word(28)], [77, 2, 5, 3, 32, 18]);
        assert_eq!(f32::from_bits(word(32)), 1.5);
        let mut reader = png::Decoder::new(std::io::Cursor::new(&exact[HEADER_BYTES..])).read_info().unwrap();
        let mut pixels = vec![0; 16 * 9 * 4];
        reader.next_frame(&mut pixels).unwrap();
        assert_eq!(pixels, frame.rgba);
        let small = packer.pack(&frame, Kind::Moving).await.unwrap().message(78);
        assert_eq!(small[HEADER_BYTES..HEADER_BYTES + 2], [0xff, 0xd8]);
        assert!(packer.pack(&self::frame(70_000, 1), Kind::Moving).await.is_some(), "too wide for a JPEG");
    }

    #[tokio::test]
    async fn few_encodings_are_kept() {
        let packer = Packer::default();
        for number in 0..20 {
            let frame = Frame { number, ..(*frame(4, 4)).clone() };
            packer.pack(&Arc::new(frame), Kind::Refining).await.unwrap();
        }
        assert_eq!(packer.kept.lock().await.len(), KEPT);
    }
}
