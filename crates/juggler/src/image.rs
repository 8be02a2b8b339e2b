//! Images in memory: saving and conversion to bytes.

use crate::Error;
use juggler_imaging::tone::Quantizer;
use juggler_imaging::{Header, ImageFormat, Tone};
use juggler_math::{Image, Rgb};
use std::path::Path;

/// Extension methods of a finished [`Image`].
///
/// ```
/// use juggler::prelude::*;
///
/// let scene = Scene::new().size(8, 4).samples(1).add(Object::new(Sphere::default()));
/// let image = juggler::render(&scene, &Settings::default())?;
/// let path = std::env::temp_dir().join("juggler-image-in-memory.png");
/// image.save(&path)?;
/// assert_eq!(image.to_rgb8(&Tone::default()).len(), 8 * 4 * 3);
/// assert_eq!(image.to_floats().len(), 8 * 4 * 3);
/// # std::fs::remove_file(path).unwrap();
/// # Ok::<(), juggler::Error>(())
/// ```
pub trait ImageExt {
    /// Writes the image to a file, whose extension (`png`, `jpg`, `exr`, `hdr`, `webp`, `pfm`)
    /// selects the format. Integer formats are encoded as sRGB without a scene's tone, which a
    /// [`RenderedImage`](crate::RenderedImage) knows. The file replaces an existing one
    /// once it is complete. Fails for an extension that is unknown or belongs to a format that is
    /// only read, a size that the format cannot hold, and a file that cannot be written.
    fn save(&self, path: impl AsRef<Path>) -> Result<(), Error>;

    /// Writes the image as [`ImageExt::save`] does, with a tone. Formats of linear radiance (EXR,
    /// HDR, PFM) ignore all of it but the primaries of an EXR.
    fn save_with_tone(&self, path: impl AsRef<Path>, tone: &Tone) -> Result<(), Error>;

    /// Returns 8-bit red, green and blue levels of all pixels, row by row from the top, without
    /// dithering: an array of shape (height, width, 3).
    fn to_rgb8(&self, tone: &Tone) -> Vec<u8>;
}

impl ImageExt for Image {
    fn save(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        self.save_with_tone(path, &Tone::default())
    }

    fn save_with_tone(&self, path: impl AsRef<Path>, tone: &Tone) -> Result<(), Error> {
        let path = path.as_ref();
        let format = ImageFormat::from_path(path)?;
        let header = Header { tone: tone.clone(), ..Header::new(self.width(), self.height()) };
        let writer = juggler_imaging::create(path, format, &header)?;
        Ok(juggler_imaging::write_image(writer, self)?)
    }

    fn to_rgb8(&self, tone: &Tone) -> Vec<u8> {
        let mut bytes = Vec::new();
        Quantizer::new(tone, 255).append_bytes(self.pixels(), &mut bytes);
        bytes
    }
}

/// Image of these pixels, row by row from the top; black if their number is wrong.
pub(crate) fn of_pixels([width, height]: [u32; 2], pixels: Vec<Rgb>) -> Image {
    Image::from_pixels(width, height, pixels).unwrap_or_else(|| Image::filled(width, height, Rgb::BLACK))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_follow_the_srgb_curve() {
        let pixels = [0.0, 0.215_861, 1.0, 4.0].map(Rgb::splat).to_vec();
        let image = Image::from_pixels(2, 2, pixels).unwrap();
        let levels = [0, 128, 255, 255].map(|level| [level; 3]);
        assert_eq!(image.to_rgb8(&Tone::default()), levels.as_flattened());
        let darker = Tone { exposure_stops: -2.0, ..Tone::default() };
        assert_eq!(image.to_rgb8(&darker)[9..], [255; 3]);
    }

    #[test]
    fn a_file_of_linear_light_holds_the_same_image() {
        let folder = tempfile::tempdir().unwrap();
        let pixels = [0.25, 1.5, 1e-3].map(|v| Rgb::new(v, 0.0, 1.0)).to_vec();
        let image = Image::from_pixels(3, 1, pixels).unwrap();
        let path = folder.path().join("image.pfm");
        image.save(&path).unwrap();
        assert_eq!(juggler_imaging::read(&path).unwrap(), image);
        let unknown = image.save(folder.path().join("image.docx")).unwrap_err().to_string();
        assert!(unknown.contains("image.docx"), "{unknown}");
    }
}
