//! The formats: endings, first bytes, limits, and the memory that writing takes.

use crate::{Header, ImageError, SampleDepth};
use std::fmt;
use std::path::Path;

/// A file format for still pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Portable Network Graphics, 8 or 16 bits, lossless.
    Png,
    /// JPEG, 8 bits, lossy.
    Jpeg,
    /// OpenEXR, linear floats or halves.
    Exr,
    /// Radiance RGBE, linear, 8 bits with a shared exponent.
    Hdr,
    /// WebP, 8 bits, lossless.
    Webp,
    /// Portable Float Map, linear floats.
    Pfm,
}

impl Format {
    /// All of them.
    pub const ALL: [Self; 6] = [Self::Png, Self::Jpeg, Self::Exr, Self::Hdr, Self::Webp, Self::Pfm];

    /// By the file's ending, whatever its case.
    pub fn from_path(path: &Path) -> Result<Self, ImageError> {
        let ending = path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
        let found = match ending.as_str() {
            "jpeg" => Some(Self::Jpeg),
            other => Self::ALL.into_iter().find(|f| f.ending() == other),
        };
        found.ok_or_else(|| ImageError::UnknownFormat { place: path.display().to_string() })
    }

    /// By the file's first bytes (12 are enough).
    pub fn from_first_bytes(bytes: &[u8]) -> Option<Self> {
        let starts = |magic: &[u8]| bytes.starts_with(magic);
        match bytes {
            _ if starts(b"\x89PNG\r\n\x1a\n") => Some(Self::Png),
            _ if starts(b"\xff\xd8\xff") => Some(Self::Jpeg),
            _ if starts(b"\x76\x2f\x31\x01") => Some(Self::Exr),
            _ if starts(b"#?RADIANCE") || starts(b"#?RGBE") => Some(Self::Hdr),
            _ if starts(b"RIFF") && bytes.get(8..12) == Some(b"WEBP") => Some(Self::Webp),
            _ if starts(b"PF\n") || starts(b"Pf\n") => Some(Self::Pfm),
            _ => None,
        }
    }

    /// The usual ending, without a dot.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Png => "png",
            Self::Jpeg => "jpg",
            Self::Exr => "exr",
            Self::Hdr => "hdr",
            Self::Webp => "webp",
            Self::Pfm => "pfm",
        }
    }

    /// All endings, for messages.
    pub fn endings() -> String {
        Self::ALL.map(|f| format!(".{}", f.ending())).join(" ")
    }

    /// Whether the tone curve applies; the other formats keep linear, scene-referred values.
    pub fn is_tone_mapped(self) -> bool {
        matches!(self, Self::Png | Self::Jpeg | Self::Webp)
    }

    /// Whether a file says in texts how it was made.
    pub fn keeps_texts(self) -> bool {
        matches!(self, Self::Png | Self::Exr | Self::Hdr)
    }

    /// The longest side that a file can have.
    pub fn longest_side(self) -> u32 {
        match self {
            Self::Png | Self::Hdr | Self::Pfm => i32::MAX as u32,
            // Coordinates up to half the range, so that sums of a box do not overflow.
            Self::Exr => i32::MAX as u32 / 2,
            Self::Jpeg => 65_535,
            Self::Webp => 16_383,
        }
    }

    /// Whether a picture of this size can be written: asked before anything is rendered.
    pub fn check_dimensions(self, width: u32, height: u32) -> Result<(), ImageError> {
        let most = self.longest_side();
        let fits = |side: u32| (1..=most).contains(&side);
        if fits(width) && fits(height) {
            return Ok(());
        }
        Err(ImageError::Dimensions { format: self, width, height, most })
    }

    /// Bytes of memory that a writer takes at most, beside the rows that it is given. `seekable` is false for
    /// standard output.
    pub fn memory_needed(self, header: &Header, seekable: bool) -> u64 {
        const FIXED: u64 = 1 << 20;
        let (width, height) = (u64::from(header.width), u64::from(header.height));
        let pixels = width.saturating_mul(height);
        let whole = |bytes_per_pixel: u64| pixels.saturating_mul(bytes_per_pixel);
        let bytes = match self {
            // Five rows: encoded, the previous one, the filtered candidates.
            Self::Png => width * 6 * 8,
            // The picture in 8 bits and some rows of blocks.
            Self::Jpeg => whole(3).saturating_add(width * 64),
            // A block of 16 rows as rows, planes and packed; the offset table; all packed blocks for a pipe.
            Self::Exr => {
                let pixel = if header.options.exr_depth == SampleDepth::Half { 6 } else { 12 };
                let pipe = if seekable { 0 } else { whole(pixel).saturating_mul(2) };
                (width * 16 * (12 + pixel * 6)).saturating_add(height * 24).saturating_add(pipe)
            }
            Self::Hdr => width * 16,
            // The picture in 8 bits with alpha and without, and the packed picture as it grows.
            Self::Webp => whole(3 + 4 + 8).saturating_add(width * 64),
            Self::Pfm => (width * 24).saturating_add(if seekable { 0 } else { whole(24) }),
        };
        let look = if self.has_looks() { header.options.look.bytes_a_pixel() } else { 0 };
        bytes.saturating_add(whole(look)).saturating_add(FIXED)
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Png => "PNG",
            Self::Jpeg => "JPEG",
            Self::Exr => "OpenEXR",
            Self::Hdr => "Radiance HDR",
            Self::Webp => "WebP",
            Self::Pfm => "PFM",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn endings_pick_formats() {
        for (name, format) in [
            ("a.png", Format::Png),
            ("b/c.d.JPG", Format::Jpeg),
            ("x.jpeg", Format::Jpeg),
            ("x.Exr", Format::Exr),
            ("x.hdr", Format::Hdr),
            ("x.webp", Format::Webp),
            ("x.pfm", Format::Pfm),
        ] {
            assert_eq!(Format::from_path(Path::new(name)).unwrap(), format);
        }
        for wrong in ["png", "a.tga", "", ".png", "a.png/"] {
            let result = Format::from_path(Path::new(wrong));
            assert!(result.is_err() || wrong == "a.png/", "{wrong}");
        }
        let message = Format::from_path(Path::new("a.tga")).unwrap_err().to_string();
        assert!(message.contains("a.tga") && message.contains(".png .jpg .exr .hdr .webp .pfm"), "{message}");
    }

    #[test]
    fn sizes_are_checked_before_rendering() {
        Format::Png.check_dimensions(20_000, 20_000).unwrap();
        Format::Jpeg.check_dimensions(65_535, 1).unwrap();
        Format::Webp.check_dimensions(16_383, 16_383).unwrap();
        for (format, width, height) in [(Format::Jpeg, 65_536, 1), (Format::Webp, 1, 16_384), (Format::Png, 0, 5)] {
            let message = format.check_dimensions(width, height).unwrap_err().to_string();
            assert!(message.contains(&width.to_string()) && message.contains("1 to"), "{message}");
        }
    }

    #[test]
    fn a_huge_picture_streams_through_little_memory() {
        let header = Header::new(20_000, 20_000);
        for format in [Format::Png, Format::Exr, Format::Hdr, Format::Pfm] {
            assert!(format.memory_needed(&header, true) < 64 << 20, "{format}");
        }
        let huge = Header::new(u32::MAX, u32::MAX);
        assert!(Format::ALL.iter().all(|f| f.memory_needed(&huge, false) > 1 << 30));
    }
}
