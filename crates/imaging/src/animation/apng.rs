//! APNG: a PNG whose further frames are in chunks of their own (W3C, Portable Network Graphics, third edition, 11.3.4),
//! so that what shows only PNG shows the first frame. Nothing is lost.

use super::changes::{Frames, Part};
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
    let (numerator, denominator) = delay(header.frames_per_second);
    encoder.set_frame_delay(numerator, denominator)?;
    encoder.write_header()
}

/// How long a frame is shown, as a fraction of a second: exact for whole numbers a second.
fn delay(frames_per_second: f64) -> (u16, u16) {
    if frames_per_second.fract() == 0.0 {
        return (1, frames_per_second as u16);
    }
    // The largest scale at which both numbers have room; 24000/1001 becomes 1001/24000.
    let scales = [1001.0, 1000.0, 500.0, 100.0, 10.0, 1.0];
    let fits = |scale: &f64| (frames_per_second * scale).round() <= f64::from(u16::MAX);
    let error = |scale: f64| ((frames_per_second * scale).round() / scale - frames_per_second).abs();
    let best = scales.into_iter().filter(fits).min_by(|a, b| error(*a).total_cmp(&error(*b))).unwrap_or(1.0);
    (best as u16, ((frames_per_second * best).round() as u16).max(1))
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_as_exact_as_sixteen_bits_allow() {
        assert_eq!([1.0, 24.0, 30.0, 1000.0].map(delay), [(1, 1), (1, 24), (1, 30), (1, 1000)]);
        assert_eq!(delay(24_000.0 / 1001.0), (1001, 24_000));
        assert_eq!(delay(12.5), (1000, 12_500));
        assert_eq!(delay(0.01), (1000, 10));
        for rate in [0.03, 0.7, 23.976, 29.97, 59.94, 119.88, 999.5] {
            let (numerator, denominator) = delay(rate);
            assert!((f64::from(denominator) / f64::from(numerator) / rate - 1.0).abs() < 5e-3, "{rate}");
        }
    }
}
