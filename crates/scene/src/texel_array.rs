//! Texels in memory, as a program has them, in place of an image file.

use crate::array_hasher::ArrayHasher;
use juggler_imaging::raster::RasterLayout;
use juggler_imaging::{ImageFormat, Raster, RasterSamples, TransferFunction};
use juggler_texture::{ColorSpace, half};

/// Maximum width and height of an image, in pixels.
pub const MAX_SIDE: u32 = 65_536;

/// Maximum number of pixels of an image: 16,384 × 16,384.
pub const MAX_TEXELS: u64 = 1 << 28;

/// Samples of texels: rows from the top, channels interleaved.
#[derive(Clone, Debug, PartialEq)]
pub enum TexelSamples {
    /// Levels from 0 to 255.
    U8(Vec<u8>),
    /// Levels from 0 to 65535.
    U16(Vec<u16>),
    /// Bits of half-precision floats (IEEE 754 binary16).
    F16(Vec<u16>),
    /// Floats.
    F32(Vec<f32>),
}

impl TexelSamples {
    fn len(&self) -> usize {
        match self {
            Self::U8(levels) => levels.len(),
            Self::U16(levels) | Self::F16(levels) => levels.len(),
            Self::F32(numbers) => numbers.len(),
        }
    }

    fn sample_bytes(&self) -> u64 {
        match self {
            Self::U8(_) => 1,
            Self::U16(_) | Self::F16(_) => 2,
            Self::F32(_) => 4,
        }
    }
}

/// Texels with 1 to 4 channels: gray; gray and alpha; red, green and blue; red, green, blue and
/// alpha. Alpha is linear and not multiplied into the colors.
#[derive(Clone, Debug, PartialEq)]
pub struct TexelArray {
    size: [u32; 2],
    channels: u8,
    samples: TexelSamples,
    is_linear: bool,
}

/// Reason why samples are no texels.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct InvalidTexels(String);

impl TexelArray {
    /// Creates texels of this width and height. `color_space` is that of color samples, if the texture
    /// that uses them states none: levels are sRGB by default, as in a PNG file, and floats are always
    /// linear, as in an EXR file.
    pub fn new(
        [width, height]: [u32; 2],
        channels: u8,
        samples: TexelSamples,
        color_space: ColorSpace,
    ) -> Result<Self, InvalidTexels> {
        let refused = |message: String| Err(InvalidTexels(message));
        let texels = u64::from(width) * u64::from(height);
        if texels == 0 || width.max(height) > MAX_SIDE || texels > MAX_TEXELS {
            return refused(format!(
                "{width} × {height} texels: each side must be 1 to {MAX_SIDE}, and both at most {MAX_TEXELS} texels"
            ));
        }
        if !(1..=4).contains(&channels) {
            return refused(format!("texels must have 1 to 4 channels, not {channels}"));
        }
        let (needed, found) = (texels * u64::from(channels), samples.len());
        if needed != found as u64 {
            return refused(format!(
                "{width} × {height} texels of {channels} channels need {needed} samples, there are {found}"
            ));
        }
        let is_float = matches!(samples, TexelSamples::F16(_) | TexelSamples::F32(_));
        if is_float && color_space == ColorSpace::Srgb {
            return refused("floats are linear: state the color space sRGB in the texture".to_owned());
        }
        let is_linear = is_float || color_space == ColorSpace::Linear;
        Ok(Self { size: [width, height], channels, samples, is_linear })
    }

    /// Width and height.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Number of channels, 1 to 4.
    pub fn channels(&self) -> u8 {
        self.channels
    }

    /// Samples, rows from the top, channels interleaved.
    pub fn samples(&self) -> &TexelSamples {
        &self.samples
    }

    /// BLAKE3 hash of the samples and of all that says what they mean.
    pub(crate) fn digest(&self) -> [u8; 32] {
        // No file begins like this, so a file and texels never have the same hash.
        let mut hasher = ArrayHasher::new(b"texels in memory\0");
        let [width, height] = self.size.map(u32::to_le_bytes);
        hasher.numbers(&width).numbers(&height).numbers(&[self.channels, u8::from(self.is_linear)]);
        match &self.samples {
            TexelSamples::U8(levels) => hasher.numbers(&[1]).bytes(levels),
            TexelSamples::U16(levels) => hasher.numbers(&[2]).array(levels, |level| [level.to_le_bytes()]),
            TexelSamples::F16(halves) => hasher.numbers(&[3]).array(halves, |half| [half.to_le_bytes()]),
            TexelSamples::F32(numbers) => hasher.numbers(&[4]).array(numbers, |number| [number.to_le_bytes()]),
        }
        hasher.finish()
    }

    /// The texels as a file of their type holds them.
    pub(crate) fn raster(&self) -> Raster {
        let (format, sample_bytes, samples) = match &self.samples {
            TexelSamples::U8(levels) => (ImageFormat::Png, 1, RasterSamples::Bytes(levels.clone())),
            TexelSamples::U16(levels) => (ImageFormat::Png, 2, RasterSamples::Words(levels.clone())),
            TexelSamples::F16(halves) => {
                let numbers = halves.iter().map(|bits| half::to_f32(*bits)).collect();
                (ImageFormat::Exr, 4, RasterSamples::Floats(numbers))
            }
            TexelSamples::F32(numbers) => (ImageFormat::Exr, 4, RasterSamples::Floats(numbers.clone())),
        };
        let [width, height] = self.size;
        let layout = RasterLayout { format, width, height, channels: self.channels, sample_bytes, to_srgb: None };
        let transfer_function = if self.is_linear { TransferFunction::Linear } else { TransferFunction::Srgb };
        Raster { layout, samples, transfer_function, is_first_of_several: false }
    }

    /// Number of texels.
    pub(crate) fn count(&self) -> u64 {
        self.size.map(u64::from).iter().product()
    }

    /// Bytes of the samples.
    pub(crate) fn bytes(&self) -> u64 {
        self.samples.len() as u64 * self.samples.sample_bytes()
    }

    /// Upper bound of the memory of a texture of these texels, while it is prepared: the samples, a
    /// pyramid of bytes or floats, and copies.
    pub(crate) fn texture_bytes(&self) -> u64 {
        let samples = self.samples.len() as u64;
        let (stored, beside) = if self.samples.sample_bytes() == 1 { (1, 4) } else { (4, 8) };
        self.bytes() + samples * stored * 4 / 3 + samples * beside + 64
    }
}
