//! Properties of an image file besides its pixels.

use super::Options;
use crate::look::DisplayLook;
use crate::tone::Tone;
use crate::{ClampCount, CropFrame, ImageError, ImageFormat, Viewpoint};

/// Properties of an image file besides its pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct Header {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Tone mapping from linear RGB to levels, for formats with integer samples.
    pub tone: Tone,
    /// Options of particular formats.
    pub options: Options,
    /// Whether the file stores alpha: PNG and WebP with straight colors, EXR with premultiplied ones.
    pub transparent: bool,
    /// Metadata as pairs of key and text, in order, such as program, fingerprint and seed. PNG, EXR
    /// and HDR store them.
    pub metadata: Vec<(String, String)>,
    /// Camera matrices, if known; EXR stores them.
    pub viewpoint: Option<Viewpoint>,
    /// Frame that the image is a crop of, if it is one; EXR stores it as its display window.
    pub crop: Option<CropFrame>,
    /// Receives the number of values that a writer clamps to the range of half floats.
    pub clamped: ClampCount,
}

impl Header {
    /// A header for this image size with default settings.
    pub fn new(width: u32, height: u32) -> Self {
        let (tone, options) = (Tone::default(), Options::default());
        let (crop, clamped) = (None, ClampCount::default());
        Self { width, height, tone, options, transparent: false, metadata: Vec::new(), viewpoint: None, crop, clamped }
    }

    /// Checks that the format can store the tone's primaries, and alpha if the image is transparent;
    /// called before rendering.
    pub fn check(&self, format: ImageFormat) -> Result<(), ImageError> {
        let stores_alpha = format.stores_alpha() && self.options.look == DisplayLook::Plain;
        if self.has_alpha(format) && !stores_alpha {
            return Err(ImageError::Transparency { format, look: self.options.look });
        }
        let primaries = self.tone.primaries;
        let takes = match format {
            ImageFormat::Exr => true,
            ImageFormat::Png => primaries.code_point().is_some(),
            _ => primaries.is_srgb(),
        };
        // Display looks quantize for the sRGB displays of their time.
        let takes = takes && (primaries.is_srgb() || self.options.look == DisplayLook::Plain);
        if takes { Ok(()) } else { Err(ImageError::Primaries { format, primaries }) }
    }

    /// Whether a file of a format has alpha: colors that the tone encodes lie over its backdrop.
    pub(super) fn has_alpha(&self, format: ImageFormat) -> bool {
        self.transparent && !(format.is_tone_mapped() && self.tone.backdrop.is_some())
    }

    pub(super) fn pixels(&self) -> u64 {
        u64::from(self.width) * u64::from(self.height)
    }
}
