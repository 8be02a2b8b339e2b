//! GIF89a with a palette of at most 256 colors per frame, chosen by a neural network (Dekker,
//! Kohonen neural networks for optimal colour quantization, 1994). Ordered dithering (Bayer 1973)
//! keeps static parts of the movie free of flicker.

use super::changes::{ChangedRect, Frames};
use super::frame_time::Clock;
use super::{AnimationHeader, FrameWriter, refused};
use crate::ImageError;
use crate::look::bayer_offset;
use crate::output::Destination;
use crate::tone::Quantizer;
use color_quant::NeuQuant;
use gif::{EncodingError, Frame, Repeat};
use juggler_math::Rgb;
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::Write;

/// Maximum number of palette colors of a frame.
const COLORS: usize = 256;
/// Amplitude of the dither pattern in 8-bit levels, about the distance between adjacent palette
/// colors.
const SPAN: i32 = 12;
/// Approximate number of pixels that the network learns from.
const TRAINING_PIXELS: usize = 200_000;

/// Streams frames into a GIF.
pub(super) struct Writer {
    encoder: gif::Encoder<Box<dyn Write + Send>>,
    frames: Frames,
    file: String,
    /// Clock with ticks of 1/100 s.
    clock: Clock,
}

impl Writer {
    pub fn new(destination: Destination, header: &AnimationHeader) -> Result<Self, ImageError> {
        let file = destination.name().to_owned();
        // `AnimationFormat::check` has limited the sides to 16 bits.
        let (width, height) = (header.width as u16, header.height as u16);
        let begun = gif::Encoder::new(destination.into_stream(), width, height, &[]).and_then(|mut encoder| {
            match header.plays {
                0 => encoder.set_repeat(Repeat::Infinite)?,
                // GIF counts the repetitions after the first playback.
                1 => {}
                plays => encoder.set_repeat(Repeat::Finite(plays - 1))?,
            }
            Ok(encoder)
        });
        let encoder = begun.map_err(|error| failed(&file, error))?;
        let frames = Frames::new(header.width, Quantizer::new(&header.tone, 255));
        Ok(Self { encoder, frames, file, clock: Clock::new(100.0, header.frames_per_second) })
    }
}

impl FrameWriter for Writer {
    fn write_frame(&mut self, pixels: &[Rgb]) -> Result<(), ImageError> {
        let (rect, bytes) = self.frames.next(pixels);
        let (palette, indices) = exact_palette(&bytes).unwrap_or_else(|| learned_palette(&rect, &bytes));
        let frame = Frame {
            delay: self.clock.tick().min(u64::from(u16::MAX)) as u16,
            left: rect.x as u16,
            top: rect.y as u16,
            width: rect.width as u16,
            height: rect.height as u16,
            palette: Some(palette),
            buffer: Cow::Owned(indices),
            ..Frame::default()
        };
        self.encoder.write_frame(&frame).map_err(|error| failed(&self.file, error))
    }

    fn finish(self: Box<Self>) -> Result<(), ImageError> {
        let Self { encoder, file, .. } = *self;
        let mut bytes = encoder.into_inner().map_err(|error| failed(&file, error))?;
        bytes.flush().map_err(|source| ImageError::Write { file, source })
    }
}

/// Palette and indices of an image with at most 256 colors; `None` if it has more.
fn exact_palette(bytes: &[u8]) -> Option<(Vec<u8>, Vec<u8>)> {
    let pixels = bytes.as_chunks::<3>().0;
    let mut entries = BTreeMap::new();
    for pixel in pixels {
        let next = entries.len();
        if *entries.entry(*pixel).or_insert(next) >= COLORS {
            return None;
        }
    }
    let mut palette = vec![[0; 3]; entries.len()];
    entries.iter().for_each(|(color, index)| palette[*index] = *color);
    let indices = pixels.iter().filter_map(|pixel| entries.get(pixel)).map(|index| *index as u8).collect();
    Some((palette.concat(), indices))
}

/// Learned palette and indices of the dithered pixels.
fn learned_palette(rect: &ChangedRect, bytes: &[u8]) -> (Vec<u8>, Vec<u8>) {
    let pixels = bytes.as_chunks::<3>().0;
    let opaque: Vec<u8> = pixels.iter().flat_map(|[r, g, b]| [*r, *g, *b, 255]).collect();
    let every = (pixels.len() / TRAINING_PIXELS).clamp(1, 10) as i32;
    let network = NeuQuant::new(every, COLORS, &opaque);
    let (columns, mut indices) = (rect.width as usize, Vec::with_capacity(pixels.len()));
    // Reuse the previous index, since adjacent pixels often have the same color.
    let mut last = ([0; 3], network.index_of(&[0, 0, 0, 255]) as u8);
    for (i, pixel) in pixels.iter().enumerate() {
        let shift = bayer_offset(rect.x as usize + i % columns, rect.y as usize + i / columns, SPAN);
        let color = pixel.map(|level| (i32::from(level) + shift).clamp(0, 255) as u8);
        if color != last.0 {
            last = (color, network.index_of(&[color[0], color[1], color[2], 255]) as u8);
        }
        indices.push(last.1);
    }
    (network.color_map_rgb(), indices)
}

fn failed(file: &str, error: EncodingError) -> ImageError {
    match error {
        EncodingError::Io(source) => ImageError::Write { file: file.to_owned(), source },
        other => refused(file, format!("encoding as GIF failed: {other}")),
    }
}
