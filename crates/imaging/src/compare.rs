//! Error metrics between two images of the same size.

use crate::ImageError;
use juggler_math::Image;

/// Differences over all pixels and channels of an image and a reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// Root mean square error.
    pub rmse: f64,
    /// Relative mean square error: mean of (x - r)² / (r² + 0.01) (Rousselle, Knaus and Zwicker
    /// 2011), which weights errors in dark and bright regions alike.
    pub relative_mse: f64,
    /// Largest absolute difference of a channel.
    pub largest: f64,
    /// Column and row of the first pixel with that difference, from the top left; `None` without
    /// differences.
    pub largest_at: Option<[u32; 2]>,
    /// Whether all bits are equal, including those of NaNs and signed zeros.
    pub same_bits: bool,
}

impl Difference {
    /// The larger errors of both.
    #[must_use]
    pub fn larger(&self, other: &Self) -> Self {
        let most = if other.largest > self.largest { other } else { self };
        Self {
            rmse: self.rmse.max(other.rmse),
            relative_mse: self.relative_mse.max(other.relative_mse),
            largest: most.largest,
            largest_at: most.largest_at,
            same_bits: self.same_bits && other.same_bits,
        }
    }
}

/// Compares an image with a reference. A channel that is not finite in either image counts as an
/// infinite difference, unless the bits are equal.
///
/// # Errors
///
/// [`ImageError::SizesDiffer`] if the sizes differ.
pub fn compare(picture: &Image, reference: &Image) -> Result<Difference, ImageError> {
    same_size(picture, reference)?;
    let (mut squares, mut relative, mut largest, mut same_bits) = (0.0, 0.0, Largest::default(), true);
    for (index, (a, b)) in picture.pixels().iter().zip(reference.pixels()).enumerate() {
        for (x, r) in a.to_array().into_iter().zip(b.to_array()) {
            if x.to_bits() == r.to_bits() {
                continue;
            }
            same_bits = false;
            let difference = (f64::from(x) - f64::from(r)).abs();
            let difference = if difference.is_finite() { difference } else { f64::INFINITY };
            squares += difference * difference;
            relative +=
                if r.is_finite() { difference * difference / (f64::from(r) * f64::from(r) + 0.01) } else { difference };
            largest.include(difference, index);
        }
    }
    let count = (picture.pixels().len() * 3).max(1) as f64;
    let largest_at = largest.pixel(picture.width());
    let (rmse, relative_mse, largest) = ((squares / count).sqrt(), relative / count, largest.value);
    Ok(Difference { rmse, relative_mse, largest, largest_at, same_bits })
}

/// Largest value of the pixels of an image, above 0, and its first pixel.
#[derive(Default)]
pub(crate) struct Largest {
    /// The value; 0 before a larger one is included.
    pub value: f64,
    index: Option<usize>,
}

impl Largest {
    /// Includes the value of a pixel by its index.
    pub fn include(&mut self, value: f64, index: usize) {
        if value > self.value {
            *self = Self { value, index: Some(index) };
        }
    }

    /// Column and row of the pixel in an image of a width.
    pub fn pixel(&self, width: u32) -> Option<[u32; 2]> {
        let index = u32::try_from(self.index?).ok()?;
        Some([index.checked_rem(width)?, index.checked_div(width)?])
    }
}

/// Checks that both images have the same size.
pub(crate) fn same_size(a: &Image, b: &Image) -> Result<(), ImageError> {
    let [a, b] = [a, b].map(|image| (image.width(), image.height()));
    if a == b { Ok(()) } else { Err(ImageError::SizesDiffer { a, b }) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::Rgb;

    fn image(values: &[f32]) -> Image {
        let pixels: Vec<Rgb> = values.chunks_exact(3).map(|c| Rgb::new(c[0], c[1], c[2])).collect();
        Image::from_pixels(pixels.len() as u32, 1, pixels).unwrap()
    }

    #[test]
    fn comparison_of_known_images_gives_known_errors() {
        let found = compare(&image(&[1.0, 2.0, 3.0]), &image(&[1.0, 0.0, 4.0])).unwrap();
        assert!((found.rmse - (5.0f64 / 3.0).sqrt()).abs() < 1e-12);
        assert!((found.relative_mse - (400.0 + 1.0 / 16.01) / 3.0).abs() < 1e-9);
        assert_eq!((found.largest, found.largest_at, found.same_bits), (2.0, Some([0, 0]), false));
        // The largest difference of 2 is in the second row, first column; an equal one follows it.
        let (mut picture, reference) = (Image::filled(2, 2, Rgb::BLACK), Image::filled(2, 2, Rgb::BLACK));
        for (pixel, value) in picture.pixels_mut().iter_mut().zip([0.0, 1.0, -2.0, 2.0]) {
            *pixel = Rgb::new(0.0, value, 0.0);
        }
        assert_eq!(compare(&picture, &reference).unwrap().largest_at, Some([0, 1]));
    }

    #[test]
    fn equal_bits_are_equal_even_if_nan() {
        let odd = image(&[f32::NAN, f32::INFINITY, -0.0]);
        assert_eq!(
            compare(&odd, &odd).unwrap(),
            Difference { rmse: 0.0, relative_mse: 0.0, largest: 0.0, largest_at: None, same_bits: true }
        );
        let zeros = compare(&image(&[0.0, 0.0, 0.0]), &image(&[0.0, -0.0, 0.0])).unwrap();
        assert!(zeros.largest == 0.0 && !zeros.same_bits);
        let broken = compare(&image(&[f32::NAN, 0.0, 0.0]), &image(&[0.5, 0.0, 0.0])).unwrap();
        assert!(broken.rmse == f64::INFINITY && broken.relative_mse == f64::INFINITY);
        let infinite = compare(&image(&[1.0, 0.0, 0.0]), &image(&[f32::INFINITY, 0.0, 0.0])).unwrap();
        assert!(infinite.rmse == f64::INFINITY && infinite.relative_mse == f64::INFINITY);
    }

    #[test]
    fn sizes_must_agree() {
        let message = compare(&image(&[0.0; 3]), &image(&[0.0; 6])).unwrap_err().to_string();
        assert!(message.contains("1×1") && message.contains("2×1"), "{message}");
    }
}
