//! GIF89a: at most 256 colours a frame, chosen for each frame by a network that learns them (Dekker, Kohonen neural
//! networks for optimal colour quantization, 1994); what lies between is dithered in an ordered pattern (Bayer 1973), which
//! stands still where the picture does.

use super::changes::{Frames, Part};
use super::pace::Clock;
use super::{AnimationHeader, FrameWriter, refused};
use crate::ImageError;
use crate::look::threshold;
use crate::output::Destination;
use crate::tone::Quantizer;
use color_quant::NeuQuant;
use gif::{EncodingError, Frame, Repeat};
use juggler_math::Rgb;
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::Write;

/// Colours of a frame.
const COLORS: usize = 256;
/// Levels that the dither pattern spans: about what colours of a rich picture are apart.
const SPAN: i32 = 12;
/// Pixels that the colours of a frame are learned from.
const LEARNED: usize = 200_000;

/// Streams frames into a GIF.
pub(super) struct Writer {
    encoder: gif::Encoder<Box<dyn Write + Send>>,
    frames: Frames,
    place: String,
    /// Hundredths of a second.
    clock: Clock,
}

impl Writer {
    pub fn new(destination: Destination, header: &AnimationHeader) -> Result<Self, ImageError> {
        let place = destination.name().to_owned();
        // Sides were checked.
        let (width, height) = (header.width as u16, header.height as u16);
        let begun = gif::Encoder::new(destination.into_stream(), width, height, &[]).and_then(|mut encoder| {
            match header.plays {
                0 => encoder.set_repeat(Repeat::Infinite)?,
                // The number is that of repetitions after the first time.
                1 => {}
                plays => encoder.set_repeat(Repeat::Finite(plays - 1))?,
            }
            Ok(encoder)
        });
        let encoder = begun.map_err(|error| failed(&place, error))?;
        let frames = Frames::new(header.width, Quantizer::new(&header.tone, 255));
        Ok(Self { encoder, frames, place, clock: Clock::new(100.0, header.frames_per_second) })
    }
}

impl FrameWriter for Writer {
    fn write_frame(&mut self, pixels: &[Rgb]) -> Result<(), ImageError> {
        let (part, bytes) = self.frames.next(pixels);
        let (palette, indices) = few(&bytes).unwrap_or_else(|| learned(&part, &bytes));
        let frame = Frame {
            delay: self.clock.tick().min(u64::from(u16::MAX)) as u16,
            left: part.x as u16,
            top: part.y as u16,
            width: part.width as u16,
            height: part.height as u16,
            palette: Some(palette),
            buffer: Cow::Owned(indices),
            ..Frame::default()
        };
        self.encoder.write_frame(&frame).map_err(|error| failed(&self.place, error))
    }

    fn finish(self: Box<Self>) -> Result<(), ImageError> {
        let Self { encoder, place, .. } = *self;
        let mut bytes = encoder.into_inner().map_err(|error| failed(&place, error))?;
        bytes.flush().map_err(|source| ImageError::Write { place, source })
    }
}

/// Palette and indices of a picture that has no more colours than fit.
fn few(bytes: &[u8]) -> Option<(Vec<u8>, Vec<u8>)> {
    let pixels = bytes.as_chunks::<3>().0;
    let mut places = BTreeMap::new();
    for pixel in pixels {
        let next = places.len();
        if *places.entry(*pixel).or_insert(next) >= COLORS {
            return None;
        }
    }
    let mut palette = vec![[0; 3]; places.len()];
    places.iter().for_each(|(color, place)| palette[*place] = *color);
    let indices = pixels.iter().filter_map(|pixel| places.get(pixel)).map(|place| *place as u8).collect();
    Some((palette.concat(), indices))
}

/// The palette that a picture's colours teach, and the indices of its dithered pixels.
fn learned(part: &Part, bytes: &[u8]) -> (Vec<u8>, Vec<u8>) {
    let pixels = bytes.as_chunks::<3>().0;
    let opaque: Vec<u8> = pixels.iter().flat_map(|[r, g, b]| [*r, *g, *b, 255]).collect();
    let every = (pixels.len() / LEARNED).clamp(1, 10) as i32;
    let network = NeuQuant::new(every, COLORS, &opaque);
    let (columns, mut indices) = (part.width as usize, Vec::with_capacity(pixels.len()));
    // Neighbours mostly have one colour.
    let mut last = ([0; 3], network.index_of(&[0, 0, 0, 255]) as u8);
    for (i, pixel) in pixels.iter().enumerate() {
        let shift = threshold(part.x as usize + i % columns, part.y as usize + i / columns, SPAN);
        let color = pixel.map(|level| (i32::from(level) + shift).clamp(0, 255) as u8);
        if color != last.0 {
            last = (color, network.index_of(&[color[0], color[1], color[2], 255]) as u8);
        }
        indices.push(last.1);
    }
    (network.color_map_rgb(), indices)
}

fn failed(place: &str, error: EncodingError) -> ImageError {
    match error {
        EncodingError::Io(source) => ImageError::Write { place: place.to_owned(), source },
        other => refused(place, format!("cannot be encoded as GIF: {other}")),
    }
}
