//! Animated WebP (RFC 9649, 2.7): a canvas, and frames that replace parts of it, each a lossless picture of its own.

use super::changes::{Frames, Part};
use super::pace::Clock;
use super::{AnimationHeader, FrameWriter, refused};
use crate::ImageError;
use crate::output::{Destination, WriteSeek};
use crate::tone::Quantizer;
use image_webp::{ColorType, WebPEncoder};
use juggler_math::Rgb;
use std::io::{self, SeekFrom, Write};

/// The flag of files with several frames.
const ANIMATION: u8 = 2;
/// The flag of frames that are put over what is there as they are.
const NO_BLENDING: u8 = 2;
/// `RIFF`, the size, `WEBP`: what stands before the first chunk.
const RIFF: usize = 12;

/// Streams frames into a WebP.
pub(super) struct Writer {
    bytes: Box<dyn WriteSeek>,
    frames: Frames,
    place: String,
    /// Thousandths of a second.
    clock: Clock,
}

impl Writer {
    pub fn new(destination: Destination, header: &AnimationHeader) -> Result<Self, ImageError> {
        let place = destination.name().to_owned();
        let mut bytes = destination.into_seekable();
        begin(&mut bytes, header).map_err(|source| failed(&place, source))?;
        let frames = Frames::new(header.width, Quantizer::new(&header.tone, 255)).with_even_corners();
        Ok(Self { bytes, frames, place, clock: Clock::new(1000.0, header.frames_per_second) })
    }
}

/// Everything before the frames.
fn begin(bytes: &mut dyn WriteSeek, header: &AnimationHeader) -> io::Result<()> {
    // The size comes last.
    bytes.write_all(b"RIFF\0\0\0\0WEBP")?;
    let (right, bottom) = (three(header.width - 1), three(header.height - 1));
    bytes.write_all(&chunk(b"VP8X", &[&[ANIMATION, 0, 0, 0], &right, &bottom]))?;
    // The background, which nothing ever shows, and how often it is played.
    bytes.write_all(&chunk(b"ANIM", &[&[255; 4], &header.plays.to_le_bytes()]))
}

/// The low 24 bits, as the format has most numbers.
fn three(number: u32) -> [u8; 3] {
    let [a, b, c, _] = number.to_le_bytes();
    [a, b, c]
}

/// A chunk of even length.
fn chunk(kind: &[u8; 4], parts: &[&[u8]]) -> Vec<u8> {
    let content = parts.concat();
    let mut bytes = [&kind[..], &(content.len() as u32).to_le_bytes(), &content].concat();
    bytes.resize(bytes.len().next_multiple_of(2), 0);
    bytes
}

fn frame(part: &Part, delay: u32, picture: &[u8]) -> Vec<u8> {
    let head = [part.x / 2, part.y / 2, part.width - 1, part.height - 1, delay].map(three).concat();
    chunk(b"ANMF", &[&head, &[NO_BLENDING], picture])
}

/// The chunk that holds the pixels of a WebP file.
fn encoded(part: &Part, pixels: &[u8]) -> Result<Vec<u8>, image_webp::EncodingError> {
    let mut file = Vec::new();
    WebPEncoder::new(&mut file).encode(pixels, part.width, part.height, ColorType::Rgb8)?;
    Ok(file.split_off(RIFF))
}

/// Says how long the file is.
fn end(bytes: &mut dyn WriteSeek) -> io::Result<bool> {
    let length = bytes.seek(SeekFrom::End(0))?;
    let Ok(size) = u32::try_from(length.saturating_sub(8)) else { return Ok(false) };
    bytes.seek(SeekFrom::Start(4))?;
    bytes.write_all(&size.to_le_bytes())?;
    bytes.flush()?;
    Ok(true)
}

impl FrameWriter for Writer {
    fn write_frame(&mut self, pixels: &[Rgb]) -> Result<(), ImageError> {
        let (part, bytes) = self.frames.next(pixels);
        let picture = encoded(&part, &bytes)
            .map_err(|error| refused(&self.place, format!("cannot be encoded as WebP: {error}")))?;
        let delay = self.clock.tick().min((1 << 24) - 1) as u32;
        let frame = frame(&part, delay, &picture);
        self.bytes.write_all(&frame).map_err(|source| failed(&self.place, source))
    }

    fn finish(self: Box<Self>) -> Result<(), ImageError> {
        let Self { mut bytes, place, .. } = *self;
        match end(&mut bytes) {
            Ok(true) => Ok(()),
            Ok(false) => Err(refused(&place, "has more than 4 GiB, which no WebP can: APNG or MP4 can")),
            Err(source) => Err(failed(&place, source)),
        }
    }
}

fn failed(place: &str, source: io::Error) -> ImageError {
    ImageError::Write { place: place.to_owned(), source }
}
