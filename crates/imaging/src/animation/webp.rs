//! Animated WebP (RFC 9649, 2.7): lossless frames that each replace a rectangle of the canvas.

use super::changes::{ChangedRect, Frames};
use super::frame_time::Clock;
use super::{AnimationHeader, FrameWriter, refused};
use crate::ImageError;
use crate::output::{Destination, WriteSeek};
use image_webp::{ColorType, WebPEncoder};
use juggler_math::PixelRows;
use std::io::{self, SeekFrom, Write};

/// VP8X flag of animated files.
const ANIMATION: u8 = 2;
/// VP8X flag of files with alpha.
const ALPHA: u8 = 16;
/// ANMF flag: the frame replaces the canvas instead of being blended.
const NO_BLENDING: u8 = 2;
/// Length of the RIFF header: `RIFF`, size, `WEBP`.
const RIFF: usize = 12;

/// Streams frames into a WebP.
pub(super) struct Writer {
    bytes: Box<dyn WriteSeek>,
    frames: Frames,
    color_type: ColorType,
    file: String,
    /// Clock with ticks of 1/1000 s.
    clock: Clock,
}

impl Writer {
    pub fn new(destination: Destination, header: &AnimationHeader) -> Result<Self, ImageError> {
        let file = destination.name().to_owned();
        let mut bytes = destination.into_seekable();
        begin(&mut bytes, header).map_err(|source| failed(&file, source))?;
        let frames = Frames::new(header).with_even_corners();
        let color_type = if header.transparent { ColorType::Rgba8 } else { ColorType::Rgb8 };
        Ok(Self { bytes, frames, color_type, file, clock: Clock::new(1000.0, header.frames_per_second) })
    }
}

/// Writes everything before the frames.
fn begin(bytes: &mut dyn WriteSeek, header: &AnimationHeader) -> io::Result<()> {
    let flags = ANIMATION | if header.transparent { ALPHA } else { 0 };
    // The size follows at the end.
    bytes.write_all(b"RIFF\0\0\0\0WEBP")?;
    let (right, bottom) = (u24(header.width - 1), u24(header.height - 1));
    bytes.write_all(&chunk(b"VP8X", &[&[flags, 0, 0, 0], &right, &bottom]))?;
    // Background color, which is never visible, and number of plays.
    bytes.write_all(&chunk(b"ANIM", &[&[255; 4], &header.plays.to_le_bytes()]))
}

/// Encodes a 24-bit integer.
fn u24(number: u32) -> [u8; 3] {
    let [a, b, c, _] = number.to_le_bytes();
    [a, b, c]
}

/// Encodes a chunk, padded to even length.
fn chunk(kind: &[u8; 4], parts: &[&[u8]]) -> Vec<u8> {
    let content = parts.concat();
    let mut bytes = [&kind[..], &(content.len() as u32).to_le_bytes(), &content].concat();
    bytes.resize(bytes.len().next_multiple_of(2), 0);
    bytes
}

fn frame(rect: &ChangedRect, delay: u32, picture: &[u8]) -> Vec<u8> {
    let head = [rect.x / 2, rect.y / 2, rect.width - 1, rect.height - 1, delay].map(u24).concat();
    chunk(b"ANMF", &[&head, &[NO_BLENDING], picture])
}

/// Compresses an image; returns the chunk with its pixels.
fn encoded(rect: &ChangedRect, pixels: &[u8], color_type: ColorType) -> Result<Vec<u8>, image_webp::EncodingError> {
    let mut file = Vec::new();
    WebPEncoder::new(&mut file).encode(pixels, rect.width, rect.height, color_type)?;
    Ok(file.split_off(RIFF))
}

/// Writes the file size into the header; `false` if it exceeds 32 bits.
fn end(bytes: &mut dyn WriteSeek) -> io::Result<bool> {
    let length = bytes.seek(SeekFrom::End(0))?;
    let Ok(size) = u32::try_from(length.saturating_sub(8)) else { return Ok(false) };
    bytes.seek(SeekFrom::Start(4))?;
    bytes.write_all(&size.to_le_bytes())?;
    bytes.flush()?;
    Ok(true)
}

impl FrameWriter for Writer {
    fn write_frame(&mut self, pixels: PixelRows) -> Result<(), ImageError> {
        let (rect, bytes) = self.frames.next(pixels);
        let picture = encoded(&rect, &bytes, self.color_type)
            .map_err(|error| refused(&self.file, format!("encoding as WebP failed: {error}")))?;
        let delay = self.clock.tick().min((1 << 24) - 1) as u32;
        let frame = frame(&rect, delay, &picture);
        self.bytes.write_all(&frame).map_err(|source| failed(&self.file, source))
    }

    fn finish(self: Box<Self>) -> Result<(), ImageError> {
        let Self { mut bytes, file, .. } = *self;
        match end(&mut bytes) {
            Ok(true) => Ok(()),
            Ok(false) => Err(refused(&file, "it is larger than 4 GiB, the limit of WebP; write APNG or MP4")),
            Err(source) => Err(failed(&file, source)),
        }
    }
}

fn failed(file: &str, source: io::Error) -> ImageError {
    ImageError::Write { file: file.to_owned(), source }
}
