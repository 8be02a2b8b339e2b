//! Display looks: emulation of old display modes on the levels of a whole image before it is
//! encoded. The image is buffered with three bytes per pixel, plus two while it is converted.

mod ham;
mod palette;

pub use ham::HamImage;

use crate::codec::{Header, RowWriter};
use crate::tone::{Curve, Quantizer, Srgb, Tone};
use crate::{ImageError, ImageFormat};
use juggler_math::{PixelRows, Rgb};

/// Display look.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum DisplayLook {
    /// No look.
    #[default]
    Plain,
    /// The Amiga's 4,096-color mode, see [`HamImage`].
    Ham,
    /// The same with ordered dithering, whose pattern is static in movies.
    HamDithered,
}

impl DisplayLook {
    /// All selectable looks.
    pub const ALL: [Self; 2] = [Self::Ham, Self::HamDithered];

    /// Name on command lines.
    pub fn name(self) -> &'static str {
        match self {
            Self::Plain => "plain",
            Self::Ham => "ham",
            Self::HamDithered => "ham-dithered",
        }
    }

    /// Memory in bytes per pixel.
    pub(crate) fn bytes_per_pixel(self) -> u64 {
        if self == Self::Plain { 0 } else { 6 }
    }
}

/// Buffers rows and passes the converted image on at the end.
pub(crate) struct Writer {
    inner: Box<dyn RowWriter>,
    quantizer: Quantizer,
    look: DisplayLook,
    width: usize,
    bytes: Vec<u8>,
}

impl Writer {
    /// Wraps the encoder that `begin` creates; tone mapping takes place here instead.
    pub fn wrap(
        header: &Header,
        begin: impl FnOnce(&Header) -> Result<Box<dyn RowWriter>, ImageError>,
    ) -> Result<Box<dyn RowWriter>, ImageError> {
        let look = header.options.look;
        if look == DisplayLook::Plain {
            return begin(header);
        }
        // The look produces exact levels, so dithering is pointless.
        let tone = Tone { dither: false, ..Tone::default() };
        let inner = begin(&Header { tone, ..header.clone() })?;
        let quantizer = Quantizer::new(&header.tone, 255);
        Ok(Box::new(Self { inner, quantizer, look, width: header.width as usize, bytes: Vec::new() }))
    }
}

impl RowWriter for Writer {
    fn write_rows(&mut self, rows: PixelRows) -> Result<(), ImageError> {
        self.quantizer.append_bytes(rows, &mut self.bytes);
        Ok(())
    }

    fn finish(mut self: Box<Self>) -> Result<(), ImageError> {
        let image = HamImage::new(&self.bytes, self.width, self.look == DisplayLook::HamDithered);
        self.bytes = Vec::new();
        let linear: [f32; 16] = std::array::from_fn(|level| Srgb {}.decode(level as f64 / 15.0) as f32);
        let light = |level: u8| linear[usize::from(level & 15)];
        for row in image.rows() {
            let row: Vec<Rgb> = row.map(|[r, g, b]| Rgb::new(light(r), light(g), light(b))).collect();
            self.inner.write_rows((&row).into())?;
        }
        self.inner.finish()
    }
}

impl ImageFormat {
    /// Whether display looks apply to the format: it stores levels.
    pub fn supports_display_looks(self) -> bool {
        self.is_tone_mapped()
    }
}

/// Offset of the ordered dither pattern (Bayer 1973) at a pixel, between ±`span` / 2 levels.
pub(crate) fn bayer_offset(x: usize, y: usize, span: i32) -> i32 {
    // Bayer's 8 × 8 matrix: interleave and reverse the bits of x ^ y and y.
    let (a, b) = (x ^ y, y);
    let rank = (0..3).fold(0, |rank, bit| rank << 2 | (a >> bit & 1) << 1 | (b >> bit & 1));
    (rank as i32 * 2 - 63) * span / 126
}
