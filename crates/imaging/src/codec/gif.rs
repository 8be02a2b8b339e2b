//! GIF (Graphics Interchange Format, version 89a), read only: the first frame on its canvas. Levels
//! are taken as sRGB. What the frame leaves free is transparent, as in browsers.

use super::{ReadSeek, Source, UNEXPECTED_END};
use crate::ImageError;
use crate::input::{self, Limits};
use crate::raster::{Raster, RasterLayout, RasterSamples, TransferFunction};
use gif::{ColorOutput, DecodeOptions, Decoder, DecodingError};
use std::path::Path;

/// Maximum number of pixels per byte: a code of 12 bits stands for at most 3,838 pixels.
pub(super) const MAX_PIXELS_PER_BYTE: u64 = 2560;

/// First frame after its header was read.
struct FirstFrame<'b> {
    decoder: Decoder<&'b mut dyn ReadSeek>,
    layout: RasterLayout,
    left: usize,
    top: usize,
    width: usize,
    /// Index of the transparent color.
    transparent: Option<u8>,
}

impl<'b> FirstFrame<'b> {
    fn new(source: Source, bytes: &'b mut dyn ReadSeek) -> Result<Self, ImageError> {
        let mut options = DecodeOptions::new();
        options.set_color_output(ColorOutput::Indexed);
        let mut decoder = options.read_info(bytes).map_err(|e| unreadable(source, e))?;
        let (width, height) = (decoder.width(), decoder.height());
        let frame = decoder.next_frame_info().map_err(|e| unreadable(source, e))?;
        let frame = frame.ok_or_else(|| source.malformed("it holds no frame"))?;
        let size = |width: u16, height: u16| source.size(width.into(), height.into(), MAX_PIXELS_PER_BYTE);
        size(frame.width, frame.height)?;
        // Browsers show the frame if the canvas has no size.
        let is_empty = width == 0 || height == 0;
        let (width, height) = if is_empty { (frame.width, frame.height) } else { (width, height) };
        let (left, top) = if is_empty { (0, 0) } else { (frame.left, frame.top) };
        let is_covered =
            (left, top) == (0, 0) && frame.width >= width && frame.height >= height && frame.transparent.is_none();
        let layout = source.layout(size(width, height)?, if is_covered { 3 } else { 4 }, 1);
        let (left, top) = (usize::from(left), usize::from(top));
        let (width, transparent) = (usize::from(frame.width), frame.transparent);
        Ok(Self { layout, left, top, width, transparent, decoder })
    }

    /// Decodes the frame and draws it on its canvas.
    fn samples(&mut self, source: Source) -> Result<Vec<u8>, ImageError> {
        let mut indices = vec![0; self.decoder.buffer_size()];
        self.decoder.read_into_buffer(&mut indices).map_err(|e| unreadable(source, e))?;
        let palette = self.decoder.palette().map_err(|e| unreadable(source, e))?;
        let RasterLayout { width, height, channels, .. } = self.layout;
        let (columns, channels) = (width as usize, usize::from(channels));
        let mut canvas = vec![0; columns * height as usize * channels];
        let rows = canvas.chunks_exact_mut(columns * channels).skip(self.top);
        for (row, indices) in rows.zip(indices.chunks_exact(self.width)) {
            for (pixel, index) in row.chunks_exact_mut(channels).skip(self.left).zip(indices) {
                let color = palette.chunks_exact(3).nth(usize::from(*index)).unwrap_or(&[0; 3]);
                let opacity = if self.transparent == Some(*index) { 0 } else { 255 };
                pixel.iter_mut().zip(color.iter().chain(&[opacity])).for_each(|(sample, level)| *sample = *level);
            }
        }
        Ok(canvas)
    }
}

/// Reads the samples of the first frame.
pub(super) fn raster(source: Source, bytes: &mut dyn ReadSeek) -> Result<Raster, ImageError> {
    let mut frame = FirstFrame::new(source, bytes)?;
    let samples = RasterSamples::Bytes(frame.samples(source)?);
    // Data behind the first frame may be damaged.
    let is_first_of_several = frame.decoder.next_frame_info().is_ok_and(|next| next.is_some());
    Ok(Raster { layout: frame.layout, samples, transfer_function: TransferFunction::Srgb, is_first_of_several })
}

/// Reads the layout of [`raster`] from the headers.
pub(super) fn layout(source: Source, bytes: &mut dyn ReadSeek) -> Result<RasterLayout, ImageError> {
    FirstFrame::new(source, bytes).map(|frame| frame.layout)
}

/// Number of frames and duration of a GIF.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GifLength {
    /// Number of frames.
    pub frames: u32,
    /// Duration of one playback in seconds.
    pub seconds: f64,
}

/// Reads the number of frames and the duration of a GIF without decoding pixels.
///
/// # Errors
///
/// The file cannot be read, or is no GIF.
pub fn gif_length(path: &Path) -> Result<GifLength, ImageError> {
    let (file, mut bytes) = (path.display().to_string(), input::open(path)?);
    let source = input::source(&file, &mut bytes, &Limits::NONE)?;
    let mut options = DecodeOptions::new();
    options.skip_frame_decoding(true);
    let mut decoder = options.read_info(&mut bytes).map_err(|e| unreadable(source, e))?;
    let (mut frames, mut hundredths) = (0, 0);
    while let Some(frame) = decoder.next_frame_info().map_err(|e| unreadable(source, e))? {
        frames += 1;
        hundredths += u64::from(frame.delay);
    }
    Ok(GifLength { frames, seconds: hundredths as f64 / 100.0 })
}

/// Translates a decoder error into a message that names the file.
fn unreadable(source: Source, error: DecodingError) -> ImageError {
    match error {
        DecodingError::Io(error) => source.failed(error),
        DecodingError::UnexpectedEof => source.malformed(UNEXPECTED_END),
        DecodingError::OutOfMemory | DecodingError::MemoryLimit => source.malformed("it is too large"),
        DecodingError::LzwError(_) | DecodingError::EndCodeNotFound => {
            source.malformed("its compressed pixels are damaged")
        }
        other => source.malformed(describe(&other.to_string())),
    }
}

/// Describes a decoder error in plain words, by the beginning of its text.
fn describe(text: &str) -> &'static str {
    let known = [
        ("no color table", "it has no palette"),
        ("image truncated", "its compressed pixels end too early"),
        ("file does not contain", "it holds no frame"),
        ("invalid minimal code size", "its compressed pixels are damaged"),
    ];
    let found = known.into_iter().find(|(start, _)| text.starts_with(start));
    found.map_or("its structure is damaged", |(_, words)| words)
}
