//! Rectangles of pixels on their way from the workers to the page.

use juggler::camera::film::Rect;
use juggler::math::Rgb;

/// Numbers that say which pixels a rectangle has.
const NUMBERS: usize = 5;

/// Rectangles of pixels, as two arrays of numbers: that is what messages of browsers carry without copying.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Patches {
    /// Of each rectangle: x, y, width, height, and how many samples a pixel has.
    pub places: Vec<u32>,
    /// Linear red, green, blue of the pixels: one rectangle after the other, row by row.
    pub light: Vec<f32>,
}

impl Patches {
    /// One more; `light` row by row.
    pub fn push(&mut self, pixels: Rect, samples: u32, light: &[Rgb]) {
        self.places.extend([pixels.x, pixels.y, pixels.width, pixels.height, samples]);
        self.light.extend(light.iter().flat_map(|pixel| pixel.to_array()));
    }

    /// All of them: the pixels, their samples, three numbers of light a pixel. Ends where the arrays do not fit each
    /// other.
    pub fn iter(&self) -> impl Iterator<Item = (Rect, u32, &[f32])> {
        let mut rest = self.light.as_slice();
        self.places.chunks_exact(NUMBERS).map_while(move |place| {
            let [x, y, width, height, samples] = *place.first_chunk()?;
            let pixels = Rect { x, y, width, height };
            let count = usize::try_from(pixels.area().checked_mul(3)?).ok()?;
            let (light, others) = rest.split_at_checked(count)?;
            rest = others;
            Some((pixels, samples, light))
        })
    }
}
