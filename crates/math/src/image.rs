//! A picture in memory.

use crate::Rgb;

/// `width × height` pixels of linear RGB, row by row from the top left.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    width: u32,
    height: u32,
    pixels: Vec<Rgb>,
}

impl Image {
    /// A picture of one colour.
    pub fn filled(width: u32, height: u32, color: Rgb) -> Self {
        Self { width, height, pixels: vec![color; width as usize * height as usize] }
    }

    /// From pixels, row by row from the top left; `None` when there are not `width × height` of them.
    pub fn from_pixels(width: u32, height: u32, pixels: Vec<Rgb>) -> Option<Self> {
        (pixels.len() == width as usize * height as usize).then_some(Self { width, height, pixels })
    }

    /// Pixels in a row.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// All pixels, row by row.
    pub fn pixels(&self) -> &[Rgb] {
        &self.pixels
    }

    /// All pixels, to change them.
    pub fn pixels_mut(&mut self) -> &mut [Rgb] {
        &mut self.pixels
    }
}
