//! Looks: what is done with the levels of a whole picture before they go to its file. They need the whole picture, so it is
//! held: three bytes a pixel, and two more while it is changed.

mod ham;
mod palette;

pub use ham::Screen;

use crate::codec::{Header, RowWriter};
use crate::tone::{Curve, Quantizer, Srgb, Tone};
use crate::{Format, ImageError};
use juggler_math::Rgb;

/// What is done with a picture's levels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Look {
    /// Nothing.
    #[default]
    Plain,
    /// The Amiga's 4,096 colours, see [`Screen`].
    Ham,
    /// The same, what lies between them dithered in a pattern that stands still in films.
    HamDithered,
}

impl Look {
    /// Those that can be chosen.
    pub const ALL: [Self; 2] = [Self::Ham, Self::HamDithered];

    /// As people call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Plain => "plain",
            Self::Ham => "ham",
            Self::HamDithered => "ham-dithered",
        }
    }

    /// Bytes of memory a pixel.
    pub(crate) fn bytes_a_pixel(self) -> u64 {
        if self == Self::Plain { 0 } else { 6 }
    }
}

/// Gathers rows, and hands them on in their look at the end.
pub(crate) struct Writer {
    inner: Box<dyn RowWriter>,
    quantizer: Quantizer,
    look: Look,
    width: usize,
    bytes: Vec<u8>,
}

impl Writer {
    /// In front of the writer that `begin` makes; the tone is applied here already.
    pub fn before(
        header: &Header,
        begin: impl FnOnce(&Header) -> Result<Box<dyn RowWriter>, ImageError>,
    ) -> Result<Box<dyn RowWriter>, ImageError> {
        let look = header.options.look;
        if look == Look::Plain {
            return begin(header);
        }
        // Levels already: nothing lies between them.
        let tone = Tone { dither: false, ..Tone::default() };
        let inner = begin(&Header { tone, ..header.clone() })?;
        let quantizer = Quantizer::new(&header.tone, 255);
        Ok(Box::new(Self { inner, quantizer, look, width: header.width as usize, bytes: Vec::new() }))
    }
}

impl RowWriter for Writer {
    fn write_rows(&mut self, rows: &[Rgb]) -> Result<(), ImageError> {
        self.quantizer.append_bytes(rows, &mut self.bytes);
        Ok(())
    }

    fn finish(mut self: Box<Self>) -> Result<(), ImageError> {
        let screen = Screen::new(&self.bytes, self.width, self.look == Look::HamDithered);
        self.bytes = Vec::new();
        let linear: [f32; 16] = std::array::from_fn(|level| Srgb {}.decode(level as f64 / 15.0) as f32);
        let light = |level: u8| linear[usize::from(level & 15)];
        for row in screen.rows() {
            let row: Vec<Rgb> = row.map(|[r, g, b]| Rgb::new(light(r), light(g), light(b))).collect();
            self.inner.write_rows(&row)?;
        }
        self.inner.finish()
    }
}

impl Format {
    /// Whether a look shows in such a file: it is one of levels.
    pub fn has_looks(self) -> bool {
        self.is_tone_mapped()
    }
}

/// What an ordered pattern (Bayer 1973) adds to the levels of a pixel, so that they lie `span` apart at most.
pub(crate) fn threshold(x: usize, y: usize, span: i32) -> i32 {
    // The bits of x ^ y and y, interleaved and reversed: Bayer's matrix of 8 × 8.
    let (a, b) = (x ^ y, y);
    let rank = (0..3).fold(0, |rank, bit| rank << 2 | (a >> bit & 1) << 1 | (b >> bit & 1));
    (rank as i32 * 2 - 63) * span / 126
}
