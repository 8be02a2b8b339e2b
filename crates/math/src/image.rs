//! An RGB image in memory.

use crate::Rgb;

/// `width × height` pixels of linear RGB, row-major from the top left.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    width: u32,
    height: u32,
    pixels: Vec<Rgb>,
}

impl Image {
    /// Constructs an image with all pixels of one color.
    pub fn filled(width: u32, height: u32, color: Rgb) -> Self {
        Self { width, height, pixels: vec![color; width as usize * height as usize] }
    }

    /// Constructs an image from row-major pixels, top left first; `None` unless `pixels.len()` is
    /// `width × height`.
    pub fn from_pixels(width: u32, height: u32, pixels: Vec<Rgb>) -> Option<Self> {
        (pixels.len() == width as usize * height as usize).then_some(Self { width, height, pixels })
    }

    /// Width in pixels.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Height in pixels.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// All pixels, row-major.
    pub fn pixels(&self) -> &[Rgb] {
        &self.pixels
    }

    /// All pixels, row-major, mutable.
    pub fn pixels_mut(&mut self) -> &mut [Rgb] {
        &mut self.pixels
    }

    /// Pixel in column `x` from the left and row `y` from the top; `None` outside the image.
    pub fn pixel(&self, x: u32, y: u32) -> Option<Rgb> {
        if x < self.width { self.row(y)?.get(x as usize).copied() } else { None }
    }

    /// Pixels of row `y` from the top; `None` below the last row.
    pub fn row(&self, y: u32) -> Option<&[Rgb]> {
        if y >= self.height {
            return None;
        }
        let width = self.width as usize;
        let start = y as usize * width;
        self.pixels.get(start..start + width)
    }

    /// Linear red, green and blue of all pixels, row-major: an array of shape (height, width, 3).
    pub fn to_floats(&self) -> Vec<f32> {
        self.pixels.iter().flat_map(|pixel| pixel.to_array()).collect()
    }

    /// Converts the image into its pixels, row-major.
    pub fn into_pixels(self) -> Vec<Rgb> {
        self.pixels
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_are_counted_from_the_top_left() {
        let pixels: Vec<Rgb> = (0..6).map(|i| Rgb::splat(i as f32)).collect();
        let image = Image::from_pixels(3, 2, pixels.clone()).unwrap();
        assert_eq!(image.pixel(2, 1), Some(Rgb::splat(5.0)));
        assert_eq!(image.pixel(0, 1), Some(Rgb::splat(3.0)));
        assert_eq!((image.pixel(3, 0), image.pixel(0, 2)), (None, None));
        assert_eq!((image.row(1), image.row(2)), (Some(&pixels[3..]), None));
        assert_eq!(image.to_floats()[3..7], [1.0, 1.0, 1.0, 2.0]);
        assert_eq!(image.into_pixels(), pixels);
    }
}
