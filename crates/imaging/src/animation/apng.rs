//! APNG: PNG with further frames in separate chunks (W3C, Portable Network Graphics, third edition,
//! 11.3.4), lossless. Viewers without APNG support show the first frame.

use super::changes::{ChangedRect, Frames};
use super::frame_time::duration;
use super::{AnimationHeader, FrameWriter, refused};
use crate::ImageError;
use crate::output::Destination;
use juggler_math::PixelRows;
use png::{BitDepth, ColorType, EncodingError};
use std::io::Write;

/// Streams frames into an APNG.
pub(super) struct Writer {
    encoder: png::Writer<Box<dyn Write + Send>>,
    frames: Frames,
    file: String,
}

impl Writer {
    pub fn new(destination: Destination, header: &AnimationHeader) -> Result<Self, ImageError> {
        let file = destination.name().to_owned();
        let encoder = encoder(destination, header).map_err(|error| failed(&file, error))?;
        let frames = Frames::new(header);
        Ok(Self { encoder, frames, file })
    }

    fn frame(&mut self, rect: ChangedRect, bytes: &[u8]) -> Result<(), EncodingError> {
        // Reset the position first, since the encoder checks that the rectangle fits after each
        // call.
        self.encoder.set_frame_position(0, 0)?;
        self.encoder.set_frame_dimension(rect.width, rect.height)?;
        self.encoder.set_frame_position(rect.x, rect.y)?;
        self.encoder.write_image_data(bytes)
    }
}

fn encoder(
    destination: Destination,
    header: &AnimationHeader,
) -> Result<png::Writer<Box<dyn Write + Send>>, EncodingError> {
    let mut encoder = png::Encoder::new(destination.into_stream(), header.width, header.height);
    encoder.set_color(if header.transparent { ColorType::Rgba } else { ColorType::Rgb });
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(png::Compression::Balanced);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    encoder.set_animated(header.frames, u32::from(header.plays))?;
    // APNG stores numerator and denominator in 16 bits each.
    let (numerator, denominator) = duration(header.frames_per_second, u32::from(u16::MAX));
    encoder.set_frame_delay(numerator as u16, denominator as u16)?;
    encoder.write_header()
}

impl FrameWriter for Writer {
    fn write_frame(&mut self, pixels: PixelRows) -> Result<(), ImageError> {
        let (rect, bytes) = self.frames.next(pixels);
        self.frame(rect, &bytes).map_err(|error| failed(&self.file, error))
    }

    fn finish(self: Box<Self>) -> Result<(), ImageError> {
        let Self { encoder, file, .. } = *self;
        encoder.finish().map_err(|error| failed(&file, error))
    }
}

fn failed(file: &str, error: EncodingError) -> ImageError {
    match error {
        EncodingError::IoError(source) => ImageError::Write { file: file.to_owned(), source },
        other => refused(file, format!("encoding as APNG failed: {other}")),
    }
}
