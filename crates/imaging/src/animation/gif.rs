//! GIF89a with a palette of at most 256 colors per frame, chosen by a neural network (Dekker,
//! Kohonen neural networks for optimal colour quantization, 1994). Ordered dithering (Bayer 1973)
//! keeps static parts of the movie free of flicker. Colors of large plain areas, such as a
//! backdrop, have entries of their own in the palette and are not dithered.

use super::changes::{ChangedRect, Frames};
use super::frame_time::Clock;
use super::{AnimationHeader, FrameWriter, refused};
use crate::ImageError;
use crate::look::bayer_offset;
use crate::output::Destination;
use color_quant::NeuQuant;
use gif::{DisposalMethod, EncodingError, Frame, Repeat};
use juggler_math::PixelRows;
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::io::Write;

/// Maximum number of palette colors of a frame.
const COLORS: usize = 256;
/// Amplitude of the dither pattern in 8-bit levels, about the distance between adjacent palette
/// colors.
const SPAN: i32 = 12;
/// Approximate number of pixels that the network learns from.
const TRAINING_PIXELS: usize = 200_000;
/// A color is plain if at least one of this number of a frame's pixels has it exactly.
const PLAIN_PIXELS: usize = 20;
/// Maximum number of plain colors, which the network has fewer colors for.
const PLAIN_COLORS: usize = 16;

/// Level from which a pixel of a transparent movie is opaque: an alpha of ½.
const OPAQUE: u8 = 128;

/// Streams frames into a GIF.
pub(super) struct Writer {
    encoder: gif::Encoder<Box<dyn Write + Send>>,
    frames: Frames,
    transparent: bool,
    /// Plain colors of this frame and the frames before it, which a smaller frame has to match.
    plain: BTreeSet<[u8; 3]>,
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
        let clock = Clock::new(100.0, header.frames_per_second);
        let (frames, plain) = (Frames::new(header), BTreeSet::new());
        Ok(Self { encoder, frames, transparent: header.transparent, plain, file, clock })
    }
}

impl FrameWriter for Writer {
    fn write_frame(&mut self, pixels: PixelRows) -> Result<(), ImageError> {
        // Pixels of a transparent movie may vanish, so each of its frames replaces the canvas.
        let (rect, bytes) = if self.transparent { self.frames.whole(pixels) } else { self.frames.next(pixels) };
        let Indexed { palette, indices, transparent } = if self.transparent {
            with_transparency(&rect, &bytes, &mut self.plain)
        } else {
            opaque(&rect, bytes.as_chunks().0, COLORS, &mut self.plain)
        };
        let frame = Frame {
            transparent,
            dispose: if self.transparent { DisposalMethod::Background } else { DisposalMethod::Keep },
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

/// Pixels as indices into a palette.
struct Indexed {
    /// Red, green and blue of each color.
    palette: Vec<u8>,
    indices: Vec<u8>,
    /// Index of transparent pixels.
    transparent: Option<u8>,
}

/// Indexes the opaque pixels of a rectangle, with at most `most` colors. Adds its plain colors to
/// `plain`.
fn opaque(rect: &ChangedRect, pixels: &[[u8; 3]], most: usize, plain: &mut BTreeSet<[u8; 3]>) -> Indexed {
    add_plain_colors(pixels, plain);
    let (palette, indices) = exact_palette(pixels, most).unwrap_or_else(|| learned_palette(rect, pixels, most, plain));
    Indexed { palette, indices, transparent: None }
}

/// Indexes pixels with alpha: the last color of the palette stands for transparent pixels, which
/// have the color of an opaque pixel otherwise, so that they add none.
fn with_transparency(rect: &ChangedRect, bytes: &[u8], plain: &mut BTreeSet<[u8; 3]>) -> Indexed {
    let pixels = bytes.as_chunks::<4>().0;
    let is_opaque = |[.., alpha]: &[u8; 4]| *alpha >= OPAQUE;
    let [r, g, b, _] = *pixels.iter().find(|pixel| is_opaque(pixel)).unwrap_or(&[0; 4]);
    let color = |pixel: &[u8; 4]| if is_opaque(pixel) { [pixel[0], pixel[1], pixel[2]] } else { [r, g, b] };
    let colors: Vec<[u8; 3]> = pixels.iter().map(color).collect();
    let Indexed { mut palette, mut indices, .. } = opaque(rect, &colors, COLORS - 1, plain);
    let transparent = (palette.len() / 3) as u8;
    palette.extend([0; 3]);
    let hidden = indices.iter_mut().zip(pixels).filter(|(_, pixel)| !is_opaque(pixel));
    hidden.for_each(|(index, _)| *index = transparent);
    Indexed { palette, indices, transparent: Some(transparent) }
}

/// Palette and indices of an image with at most `most` colors; `None` if it has more.
fn exact_palette(pixels: &[[u8; 3]], most: usize) -> Option<(Vec<u8>, Vec<u8>)> {
    let mut entries = BTreeMap::new();
    for pixel in pixels {
        let next = entries.len();
        if *entries.entry(*pixel).or_insert(next) >= most {
            return None;
        }
    }
    let mut palette = vec![[0; 3]; entries.len()];
    entries.iter().for_each(|(color, index)| palette[*index] = *color);
    let indices = pixels.iter().filter_map(|pixel| entries.get(pixel)).map(|index| *index as u8).collect();
    Some((palette.concat(), indices))
}

/// Adds the colors that large parts of the pixels have exactly.
fn add_plain_colors(pixels: &[[u8; 3]], plain: &mut BTreeSet<[u8; 3]>) {
    let mut sorted = pixels.to_vec();
    sorted.sort_unstable();
    let areas = sorted.chunk_by(|a, b| a == b).filter(|area| area.len() * PLAIN_PIXELS >= pixels.len());
    for color in areas.filter_map(<[_]>::first) {
        if plain.len() < PLAIN_COLORS {
            plain.insert(*color);
        }
    }
}

/// Learned palette of `most` colors, and indices of the pixels: plain colors exactly, the others
/// dithered.
fn learned_palette(
    rect: &ChangedRect,
    pixels: &[[u8; 3]],
    most: usize,
    plain: &BTreeSet<[u8; 3]>,
) -> (Vec<u8>, Vec<u8>) {
    let learned = most - plain.len();
    let entries: BTreeMap<[u8; 3], u8> = plain.iter().copied().zip((learned..most).map(|index| index as u8)).collect();
    // Train the network on the colors that the palette does not hold exactly
    let others = pixels.iter().filter(|pixel| !entries.contains_key(*pixel));
    let training: Vec<u8> = others.flat_map(|[r, g, b]| [*r, *g, *b, 255]).collect();
    let every = (training.len() / 4 / TRAINING_PIXELS).clamp(1, 10) as i32;
    let network = NeuQuant::new(every, learned, &training);
    let (columns, mut indices) = (rect.width as usize, Vec::with_capacity(pixels.len()));
    // Reuse the previous index, since adjacent pixels often have the same color.
    let mut last = ([0; 3], network.index_of(&[0, 0, 0, 255]) as u8);
    for (i, pixel) in pixels.iter().enumerate() {
        if let Some(entry) = entries.get(pixel) {
            indices.push(*entry);
            continue;
        }
        let shift = bayer_offset(rect.x as usize + i % columns, rect.y as usize + i / columns, SPAN);
        let color = pixel.map(|level| (i32::from(level) + shift).clamp(0, 255) as u8);
        if color != last.0 {
            last = (color, network.index_of(&[color[0], color[1], color[2], 255]) as u8);
        }
        indices.push(last.1);
    }
    let mut palette = network.color_map_rgb();
    palette.extend(plain.iter().flatten());
    (palette, indices)
}

fn failed(file: &str, error: EncodingError) -> ImageError {
    match error {
        EncodingError::Io(source) => ImageError::Write { file: file.to_owned(), source },
        other => refused(file, format!("encoding as GIF failed: {other}")),
    }
}
