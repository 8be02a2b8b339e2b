//! Rectangles of pixels in transfer from the workers to the page.

use juggler::camera::film::Rect;
use juggler::math::PixelRows;

/// Number of values of a pixel: red, green, blue and alpha.
pub const PIXEL_VALUES: usize = 4;
/// Number of values that describe a rectangle.
const RECT_VALUES: usize = 5;

/// Rectangles of pixels in two arrays, which browser messages transfer without copying.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PixelRects {
    /// X, y, width, height and number of samples of each rectangle.
    pub bounds: Vec<u32>,
    /// Linear RGB radiance of the pixels and their alpha, rectangle by rectangle, row by row.
    pub radiance: Vec<f32>,
}

impl PixelRects {
    /// Appends a rectangle; `rows` has its pixels row by row.
    pub fn push<'a>(&mut self, pixels: Rect, samples: u32, rows: impl Into<PixelRows<'a>>) {
        let rows: PixelRows = rows.into();
        self.bounds.extend([pixels.x, pixels.y, pixels.width, pixels.height, samples]);
        let mut alpha = rows.alpha.unwrap_or_default().iter();
        for color in rows.colors {
            self.radiance.extend(color.to_array());
            self.radiance.push(alpha.next().copied().unwrap_or(1.0));
        }
    }

    /// Returns pixels, number of samples and the values of the pixels of each rectangle. The iterator ends where
    /// the arrays are inconsistent.
    pub fn iter(&self) -> impl Iterator<Item = (Rect, u32, &[f32])> {
        let mut rest = self.radiance.as_slice();
        self.bounds.chunks_exact(RECT_VALUES).map_while(move |rect| {
            let [x, y, width, height, samples] = *rect.first_chunk()?;
            let pixels = Rect { x, y, width, height };
            let count = usize::try_from(pixels.area().checked_mul(PIXEL_VALUES as u64)?).ok()?;
            let (radiance, others) = rest.split_at_checked(count)?;
            rest = others;
            Some((pixels, samples, radiance))
        })
    }
}
