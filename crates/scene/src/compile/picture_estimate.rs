//! Estimates of the memory of pictures, from their heads.

use juggler_imaging::{ImageFormat, RasterHead};
use juggler_texture::ColorSpace;

/// Maximum memory in bytes that pictures which are decoded at once need until they are decoded. A
/// picture that needs more is decoded alone.
pub const DECODED_AT_ONCE: u64 = 256 << 20;

/// Memory of an image file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Estimate {
    /// Bytes that remain in memory.
    pub resident_bytes: u64,
    /// Peak in bytes while the file is read.
    pub peak_bytes: u64,
}

/// A picture of textures that is not decoded yet.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PictureNeeds {
    /// Name of the file or asset.
    pub name: String,
    /// Memory of the picture.
    pub estimate: Estimate,
}

impl Estimate {
    /// Bytes that are needed only while the file is read.
    pub fn temporary_bytes(&self) -> u64 {
        self.peak_bytes.saturating_sub(self.resident_bytes)
    }

    /// Memory of a picture of `length` bytes, which are read if `is_file` or are in memory already.
    pub(super) fn of_head(head: &RasterHead, space: ColorSpace, length: u64, is_file: bool) -> Self {
        let layout = &head.layout;
        let samples = u64::from(layout.width) * u64::from(layout.height) * u64::from(layout.channels);
        let stored = u64::from(layout.sample_bytes);
        // Other samples than levels of 8 bits become floats, perhaps smaller ones, one array after
        // the other.
        let is_converted = space == ColorSpace::Auto && layout.channels > 2 && layout.to_srgb.is_some();
        let (kept, converted) = if stored == 1 && !is_converted { (1, 1) } else { (4, stored.max(2) + 4) };
        let resident_bytes = pyramid_samples(layout.width, layout.height) * u64::from(layout.channels) * kept + 64;
        // Decoders copy some files.
        let copies = if is_file { 2 } else { u64::from(layout.format != ImageFormat::Png) };
        let decoding = (samples * stored).saturating_add(head.decoder_bytes).saturating_add(length * copies);
        Self { resident_bytes, peak_bytes: resident_bytes.max(decoding).max(samples * converted) }
    }
}

/// Number of texels of an image and of its copies of half the width and height each.
fn pyramid_samples(width: u32, height: u32) -> u64 {
    let sizes = std::iter::successors(Some([width, height]), |size| {
        (size.iter().any(|side| *side > 1)).then(|| size.map(|side| (side / 2).max(1)))
    });
    sizes.map(|[width, height]| u64::from(width) * u64::from(height)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_imaging::RasterLayout;

    #[test]
    fn memory_of_pictures_follows_from_their_heads() {
        let layout = RasterLayout {
            format: ImageFormat::Jpeg,
            width: 4000,
            height: 2000,
            channels: 3,
            sample_bytes: 1,
            to_srgb: None,
        };
        let samples = 4000 * 2000 * 3;
        let of = |layout: RasterLayout, is_file| {
            Estimate::of_head(&RasterHead { layout, decoder_bytes: samples }, ColorSpace::Srgb, 1000, is_file)
        };
        let levels = of(layout, true);
        assert!((samples..=samples * 4 / 3 + 64).contains(&levels.resident_bytes), "{levels:?}");
        assert_eq!(levels.peak_bytes, 2 * samples + 2000);
        assert_eq!(of(layout, false).peak_bytes, 2 * samples + 1000);
        let words = of(RasterLayout { format: ImageFormat::Png, sample_bytes: 2, ..layout }, false);
        assert_eq!((words.resident_bytes - 64, words.peak_bytes), (4 * (levels.resident_bytes - 64), 6 * samples));
        assert_eq!((pyramid_samples(16, 16), pyramid_samples(5, 1)), (341, 5 + 2 + 1));
    }
}
