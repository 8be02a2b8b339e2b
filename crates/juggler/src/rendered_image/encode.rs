//! Encoding of rendered images in memory.

use super::RenderedImage;
use crate::Error;
use juggler_imaging::tone::Quantizer;
use juggler_imaging::{Header, ImageFormat, Tone, to_memory};
use juggler_math::PixelRows;
use std::ops::{Add, Div};

impl RenderedImage {
    /// Returns the bytes of an image file without AOVs. An image that is wider than `most` pixels
    /// is reduced by a whole factor first. Fails for a size or primaries that the format cannot hold.
    pub fn encode(&self, format: ImageFormat, most: u32) -> Result<Vec<u8>, Error> {
        let factor = self.header.width.div_ceil(most.max(1)).max(1);
        if factor == 1 {
            return Ok(to_memory(format, &self.header, self.pixel_rows())?);
        }
        let [width, height] = self.size().map(|edge| edge.div_ceil(factor));
        let header = Header { width, height, viewpoint: None, crop: None, ..self.header.clone() };
        let colors = self.reduced(&self.pixels, factor);
        let alpha = self.alpha.as_deref().map(|alpha| self.reduced(alpha, factor));
        Ok(to_memory(format, &header, PixelRows { colors: &colors, alpha: alpha.as_deref() })?)
    }

    /// Returns 8-bit red, green and blue levels of all pixels over the backdrop of `tone` or over
    /// black, row by row from the top, without dithering: an array of shape (height, width, 3).
    pub fn to_rgb8(&self, tone: &Tone) -> Vec<u8> {
        let mut bytes = Vec::new();
        Quantizer::new(tone, 255).append_bytes(self.pixel_rows(), &mut bytes);
        bytes
    }

    /// Means of blocks of `factor` × `factor` values of pixels, which may be smaller at the right and
    /// at the bottom.
    fn reduced<T>(&self, values: &[T], factor: u32) -> Vec<T>
    where
        T: Copy + Default + Add<Output = T> + Div<f32, Output = T>,
    {
        let (width, factor) = (self.header.width.max(1) as usize, factor as usize);
        let bands = values.chunks(width * factor);
        let means = bands.flat_map(|band| {
            let rows: Vec<&[T]> = band.chunks(width).collect();
            (0..width).step_by(factor).map(move |left| {
                let block = rows.iter().flat_map(|row| row.get(left..(left + factor).min(width)).unwrap_or_default());
                let (sum, count) = block.fold((T::default(), 0.0), |(sum, count), pixel| (sum + *pixel, count + 1.0));
                sum / count
            })
        });
        means.collect()
    }
}

#[cfg(test)]
mod tests {
    use crate::{Picture, Settings};
    use juggler_imaging::{ImageFormat, Limits, decode};
    use juggler_render::Control;
    use juggler_scene::{Object, Scene};
    use juggler_shape::Sphere;
    use std::io::Cursor;

    #[test]
    fn images_in_memory_have_the_bytes_of_their_files_and_become_smaller() {
        let scene = Scene::new().size(10, 6).add(Object::new(Sphere::default()));
        let settings = Settings { samples: Some(1), ..Settings::default() };
        let image = Picture::new(&scene, &settings).unwrap().render_in_memory(None, &Control::default()).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a.png");
        image.save(&file).unwrap();
        assert!(std::fs::read(file).unwrap() == image.encode(ImageFormat::Png, 10).unwrap());
        let small = image.encode(ImageFormat::Pfm, 4).unwrap();
        let small = decode("a.pfm", Cursor::new(small), &Limits::default()).unwrap();
        assert_eq!((small.width(), small.height()), (4, 2));
        let pixel = |x: usize, y: usize| image.pixels()[y * 10 + x];
        let corner = [pixel(9, 3), pixel(9, 4), pixel(9, 5)].into_iter().fold(juggler_math::Rgb::BLACK, |a, b| a + b);
        assert_eq!(small.pixels()[7], corner / 3.0);
    }
}
