//! Image file formats: file extensions, magic numbers, size limits and memory use.

use crate::{Header, ImageError, SampleDepth};
use std::fmt;
use std::path::Path;

/// Still image file format. Juggler reads all formats and writes the formats of
/// [`ImageFormat::ALL`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ImageFormat {
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
    /// TIFF, 8 or 16 bits or floats; read only.
    Tiff,
    /// Truevision TGA, 8 bits; read only.
    Tga,
    /// Windows bitmap, 8 bits; read only.
    Bmp,
    /// GIF, 256 colors; read only, except as a movie.
    Gif,
}

impl ImageFormat {
    /// All image formats that are written.
    pub const ALL: [Self; 6] = [Self::Png, Self::Jpeg, Self::Exr, Self::Hdr, Self::Webp, Self::Pfm];

    /// All image formats that are read but not written.
    pub const READ_ONLY: [Self; 4] = [Self::Tiff, Self::Tga, Self::Bmp, Self::Gif];

    /// Format of an image to write, for the path's file extension, ignoring case.
    ///
    /// # Errors
    ///
    /// [`ImageError::ReadOnly`] if the extension is that of a format that is only read,
    /// [`ImageError::UnknownFormat`] if no format has this extension.
    pub fn from_path(path: &Path) -> Result<Self, ImageError> {
        let file = || path.display().to_string();
        let format = Self::from_extension(path).ok_or_else(|| ImageError::UnknownFormat { file: file() })?;
        if format.is_written() { Ok(format) } else { Err(ImageError::ReadOnly { file: file(), format }) }
    }

    /// Format of an image to read or write, for the path's file extension, ignoring case.
    pub fn from_extension(path: &Path) -> Option<Self> {
        let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
        match extension.as_str() {
            "jpeg" => Some(Self::Jpeg),
            "tiff" => Some(Self::Tiff),
            other => Self::ALL.into_iter().chain(Self::READ_ONLY).find(|f| f.extension() == other),
        }
    }

    /// Whether images of the format are written, not only read.
    pub fn is_written(self) -> bool {
        Self::ALL.contains(&self)
    }

    /// Format of an image to read, by the file's first bytes (12 suffice). TGA files begin with no
    /// magic number, so their file extension counts.
    pub fn detect(bytes: &[u8], path: &Path) -> Option<Self> {
        let tga = || Self::from_extension(path).filter(|format| *format == Self::Tga);
        Self::from_first_bytes(bytes).or_else(tga)
    }

    /// Format by the file's first bytes (12 suffice); TGA files cannot be detected.
    pub fn from_first_bytes(bytes: &[u8]) -> Option<Self> {
        let starts = |magic: &[u8]| bytes.starts_with(magic);
        match bytes {
            _ if starts(b"\x89PNG\r\n\x1a\n") => Some(Self::Png),
            _ if starts(b"\xff\xd8\xff") => Some(Self::Jpeg),
            _ if starts(b"\x76\x2f\x31\x01") => Some(Self::Exr),
            _ if starts(b"#?RADIANCE") || starts(b"#?RGBE") => Some(Self::Hdr),
            _ if starts(b"RIFF") && bytes.get(8..12) == Some(b"WEBP") => Some(Self::Webp),
            _ if starts(b"PF\n") || starts(b"Pf\n") => Some(Self::Pfm),
            // Classic TIFF and BigTIFF in both byte orders.
            _ if starts(b"II*\0") || starts(b"MM\0*") || starts(b"II+\0") || starts(b"MM\0+") => Some(Self::Tiff),
            _ if starts(b"GIF87a") || starts(b"GIF89a") => Some(Self::Gif),
            _ if starts(b"BM") => Some(Self::Bmp),
            _ => None,
        }
    }

    /// File extension without the dot.
    pub fn extension(self) -> &'static str {
        match self {
            Self::Png => "png",
            Self::Jpeg => "jpg",
            Self::Exr => "exr",
            Self::Hdr => "hdr",
            Self::Webp => "webp",
            Self::Pfm => "pfm",
            Self::Tiff => "tif",
            Self::Tga => "tga",
            Self::Bmp => "bmp",
            Self::Gif => "gif",
        }
    }

    /// File extensions of all formats that are written, for messages.
    pub fn extensions() -> String {
        Self::ALL.map(|f| format!(".{}", f.extension())).join(" ")
    }

    /// File extensions of all formats that are read, for messages.
    pub fn readable_extensions() -> String {
        format!("{} {}", Self::extensions(), Self::READ_ONLY.map(|f| format!(".{}", f.extension())).join(" "))
    }

    /// Whether written files store tone-mapped levels; the other formats that are written store
    /// linear, scene-referred values. [`crate::ImageInfo`] tells it of files that are read.
    pub fn is_tone_mapped(self) -> bool {
        matches!(self, Self::Png | Self::Jpeg | Self::Webp)
    }

    /// Whether files store metadata such as program and seed.
    pub fn stores_metadata(self) -> bool {
        matches!(self, Self::Png | Self::Exr | Self::Hdr)
    }

    /// Whether written files can store alpha.
    pub fn stores_alpha(self) -> bool {
        matches!(self, Self::Png | Self::Webp | Self::Exr)
    }

    /// Longest side of an image in pixels.
    pub fn longest_side(self) -> u32 {
        match self {
            Self::Png | Self::Hdr | Self::Pfm => i32::MAX as u32,
            // OpenEXR limits box coordinates to half of the 32-bit range, so that differences do
            // not overflow.
            Self::Exr => i32::MAX as u32 / 2,
            Self::Tiff => u32::MAX,
            Self::Jpeg | Self::Tga | Self::Bmp | Self::Gif => 65_535,
            Self::Webp => 16_383,
        }
    }

    /// Checks that the format supports an image size; called before rendering.
    pub fn check_dimensions(self, width: u32, height: u32) -> Result<(), ImageError> {
        let max_side = self.longest_side();
        let fits = |side: u32| (1..=max_side).contains(&side);
        if fits(width) && fits(height) {
            return Ok(());
        }
        Err(ImageError::Dimensions { format: self, width, height, max_side })
    }

    /// Upper bound of a writer's memory in bytes, excluding the rows passed to it. `seekable` is
    /// false for pipes such as standard output.
    pub fn memory_needed(self, header: &Header, seekable: bool) -> u64 {
        const FIXED: u64 = 1 << 20;
        let (width, height) = (u64::from(header.width), u64::from(header.height));
        let pixels = width.saturating_mul(height);
        let whole = |bytes_per_pixel: u64| pixels.saturating_mul(bytes_per_pixel);
        let bytes = match self {
            // Encoded row, previous row and candidate filters: five rows, rounded up.
            Self::Png => width * 6 * 8,
            // 8-bit pixels of the image and some rows of blocks.
            Self::Jpeg => whole(3).saturating_add(width * 64),
            // A block of 16 rows as floats, planes and compressed; the offset table; for pipes the
            // whole file.
            Self::Exr => {
                let sample = if header.options.exr_depth == SampleDepth::Half { 2 } else { 4 };
                let pixel = sample * if header.transparent { 4 } else { 3 };
                let pipe = if seekable { 0 } else { whole(pixel).saturating_mul(2) };
                (width * 16 * (16 + pixel * 6)).saturating_add(height * 24).saturating_add(pipe)
            }
            Self::Hdr => width * 16,
            // 8-bit pixels, a copy of them with alpha, and the growing output.
            Self::Webp => whole(4 + 4 + 8).saturating_add(width * 64),
            Self::Pfm => (width * 24).saturating_add(if seekable { 0 } else { whole(24) }),
            // These are not written.
            Self::Tiff | Self::Tga | Self::Bmp | Self::Gif => 0,
        };
        let look = if self.supports_display_looks() { header.options.look.bytes_per_pixel() } else { 0 };
        bytes.saturating_add(whole(look)).saturating_add(FIXED)
    }
}

impl fmt::Display for ImageFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Png => "PNG",
            Self::Jpeg => "JPEG",
            Self::Exr => "OpenEXR",
            Self::Hdr => "Radiance HDR",
            Self::Webp => "WebP",
            Self::Pfm => "PFM",
            Self::Tiff => "TIFF",
            Self::Tga => "TGA",
            Self::Bmp => "BMP",
            Self::Gif => "GIF",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn file_extensions_select_formats() {
        for (name, format) in [
            ("a.png", ImageFormat::Png),
            ("b/c.d.JPG", ImageFormat::Jpeg),
            ("x.jpeg", ImageFormat::Jpeg),
            ("x.Exr", ImageFormat::Exr),
            ("x.hdr", ImageFormat::Hdr),
            ("x.webp", ImageFormat::Webp),
            ("x.pfm", ImageFormat::Pfm),
        ] {
            assert_eq!(ImageFormat::from_path(Path::new(name)).unwrap(), format);
        }
        for wrong in ["png", "a.psd", "", ".png", "a.png/"] {
            let result = ImageFormat::from_path(Path::new(wrong));
            assert!(result.is_err() || wrong == "a.png/", "{wrong}");
        }
        let message = ImageFormat::from_path(Path::new("a.psd")).unwrap_err().to_string();
        assert_eq!(message, "`a.psd` has an unknown extension; supported: .png .jpg .exr .hdr .webp .pfm");
    }

    #[test]
    fn formats_that_are_only_read_are_refused_as_outputs() {
        for (name, format) in [
            ("a.tif", ImageFormat::Tiff),
            ("a.TIFF", ImageFormat::Tiff),
            ("a.tga", ImageFormat::Tga),
            ("a.bmp", ImageFormat::Bmp),
            ("a.gif", ImageFormat::Gif),
        ] {
            let path = Path::new(name);
            assert_eq!(ImageFormat::from_extension(path), Some(format));
            let message = ImageFormat::from_path(path).unwrap_err().to_string();
            let expected = format!(
                "`{name}`: Juggler reads {format} pictures but does not write them; use .png .jpg .exr .hdr .webp .pfm"
            );
            assert_eq!(message, expected);
        }
    }

    #[test]
    fn tga_files_are_known_by_their_name_alone() {
        let (bytes, png) = (b"\0\0\x02\0\0\0\0\0\0\0\0\0", b"\x89PNG\r\n\x1a\n");
        assert_eq!(ImageFormat::detect(bytes, Path::new("a/b.TGA")), Some(ImageFormat::Tga));
        assert_eq!(ImageFormat::detect(bytes, Path::new("a/b.png")), None);
        assert_eq!(ImageFormat::detect(png, Path::new("a/b.tga")), Some(ImageFormat::Png));
    }

    #[test]
    fn sizes_are_checked_before_rendering() {
        ImageFormat::Png.check_dimensions(20_000, 20_000).unwrap();
        ImageFormat::Jpeg.check_dimensions(65_535, 1).unwrap();
        ImageFormat::Webp.check_dimensions(16_383, 16_383).unwrap();
        for (format, width, height) in
            [(ImageFormat::Jpeg, 65_536, 1), (ImageFormat::Webp, 1, 16_384), (ImageFormat::Png, 0, 5)]
        {
            let message = format.check_dimensions(width, height).unwrap_err().to_string();
            assert!(message.contains(&width.to_string()) && message.contains("1 to"), "{message}");
        }
    }

    #[test]
    fn a_huge_picture_streams_through_little_memory() {
        let header = Header::new(20_000, 20_000);
        for format in [ImageFormat::Png, ImageFormat::Exr, ImageFormat::Hdr, ImageFormat::Pfm] {
            assert!(format.memory_needed(&header, true) < 64 << 20, "{format}");
        }
        let huge = Header::new(u32::MAX, u32::MAX);
        assert!(ImageFormat::ALL.iter().all(|f| f.memory_needed(&huge, false) > 1 << 30));
    }
}
