//! APNG: a PNG whose further frames are in chunks of their own (W3C, Portable Network Graphics, third edition, 11.3.4),
//! so that what shows only PNG shows the first frame. Nothing is lost.

use super::changes::{Frames, Part};
use super::pace::duration;
use super::{AnimationHeader, FrameWriter, refused};
use crate::ImageError;
use crate::output::Destination;
use crate::tone::Quantizer;
use juggler_math::Rgb;
use png::{BitDepth, ColorType, EncodingError};
use std::io::Write;

/// Streams frames into an APNG.
pub(super) struct Writer {
    encoder: png::Writer<Box<dyn Write + Send>>,
    frames: Frames,
    place: String,
}

impl Writer {
    pub fn new(destination: Destination, header: &AnimationHeader) -> Result<Self, ImageError> {
        let place = destination.name().to_owned();
        let encoder = encoder(destination, header).map_err(|error| failed(&place, error))?;
        let frames = Frames::new(header.width, Quantizer::new(&header.tone, 255));
        Ok(Self { encoder, frames, place })
    }

    fn frame(&mut self, part: Part, bytes: &[u8]) -> Result<(), EncodingError> {
        // The corner first: the part must fit wherever it is meanwhile.
        self.encoder.set_frame_position(0, 0)?;
        self.encoder.set_frame_dimension(part.width, part.height)?;
        self.encoder.set_frame_position(part.x, part.y)?;
        self.encoder.write_image_data(bytes)
    }
}

fn encoder(
    destination: Destination,
    header: &AnimationHeader,
) -> Result<png::Writer<Box<dyn Write + Send>>, EncodingError> {
    let mut encoder = png::Encoder::new(destination.into_stream(), header.width, header.height);
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(png::Compression::Balanced);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    encoder.set_animated(header.frames, u32::from(header.plays))?;
    // Both have sixteen bits.
    let (numerator, denominator) = duration(header.frames_per_second, u32::from(u16::MAX));
    encoder.set_frame_delay(numerator as u16, denominator as u16)?;
    encoder.write_header()
}

impl FrameWriter for Writer {
    fn write_frame(&mut self, pixels: &[Rgb]) -> Result<(), ImageError> {
        let (part, bytes) = self.frames.next(pixels);
        self.frame(part, &bytes).map_err(|error| failed(&self.place, error))
    }

    fn finish(self: Box<Self>) -> Result<(), ImageError> {
        let Self { encoder, place, .. } = *self;
        encoder.finish().map_err(|error| failed(&place, error))
    }
}

fn failed(place: &str, error: EncodingError) -> ImageError {
    match error {
        EncodingError::IoError(source) => ImageError::Write { place: place.to_owned(), source },
        other => refused(place, format!("cannot be encoded as APNG: {other}")),
    }
}
