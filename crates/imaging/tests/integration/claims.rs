//! Small files whose headers claim more pixels than their bytes can hold, and messages for damaged
//! files.

use crate::common::{encode, header, picture};
use juggler_imaging::{ImageError, ImageFormat, Limits, decode, decode_raster, inspect, inspect_raster};
use std::io::Cursor;

/// Offset behind the first occurrence of `pattern`.
fn after(bytes: &[u8], pattern: &[u8]) -> usize {
    bytes.windows(pattern.len()).position(|window| window == pattern).unwrap() + pattern.len()
}

/// CRC-32 of a PNG chunk (ISO 3309).
fn crc(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| (crc >> 1) ^ if crc & 1 == 1 { 0xedb8_8320 } else { 0 })
    })
}

/// A small file whose header claims the given size.
fn claiming(format: ImageFormat, [width, height]: [u32; 2]) -> Vec<u8> {
    // WebP sides have 14 bits and a byte may hold many pixels, so the file must be tiny.
    let image = if format == ImageFormat::Webp { picture(8, 8, 3.0) } else { picture(19, 18, 3.0) };
    let mut bytes = encode(format, &image, &header(&image));
    let mut put = |at: usize, new: &[u8]| bytes[at..at + new.len()].copy_from_slice(new);
    match format {
        ImageFormat::Png => {
            put(16, &width.to_be_bytes());
            put(20, &height.to_be_bytes());
            let checksum = crc(&bytes[12..29]);
            bytes[29..33].copy_from_slice(&checksum.to_be_bytes());
        }
        ImageFormat::Jpeg => {
            let at = after(&bytes, b"\xff\xc0") + 3;
            bytes[at..at + 2].copy_from_slice(&(height as u16).to_be_bytes());
            bytes[at + 2..at + 4].copy_from_slice(&(width as u16).to_be_bytes());
        }
        ImageFormat::Exr => {
            let at = after(&bytes, b"dataWindow\0box2i\0") + 12;
            bytes[at..at + 4].copy_from_slice(&(width - 1).to_le_bytes());
            bytes[at + 4..at + 8].copy_from_slice(&(height - 1).to_le_bytes());
        }
        ImageFormat::Webp => {
            let sides = (width - 1) | (height - 1) << 14;
            put(21, &sides.to_le_bytes());
        }
        ImageFormat::Hdr => {
            let (head, rest) = (format!("-Y {height} +X {width}\n"), bytes.split_off(after(&bytes, b"+X 19\n")));
            bytes.truncate(after(&bytes, b"\n\n"));
            bytes.extend([head.as_bytes(), &rest].concat());
        }
        ImageFormat::Pfm => {
            let rest = bytes.split_off(after(&bytes, b"19 18\n"));
            bytes = [format!("PF\n{width} {height}\n").as_bytes(), &rest].concat();
        }
        _ => panic!("{format} files are not written"),
    }
    bytes
}

fn sides(format: ImageFormat) -> [u32; 2] {
    match format {
        ImageFormat::Jpeg => [65_535, 65_535],
        ImageFormat::Webp => [16_383, 16_383],
        ImageFormat::Exr => [16_777_240, 12],
        _ => [20_000, 20_000],
    }
}

#[test]
fn claimed_sizes_beyond_the_file_length_are_rejected() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("file");
    for format in ImageFormat::ALL {
        let sides @ [width, height] = sides(format);
        let bytes = claiming(format, sides);
        std::fs::write(&path, &bytes).unwrap();
        let limits = Limits::default();
        let refused = [
            decode("a file", Cursor::new(&bytes), &limits).map(drop),
            decode_raster("a file", Cursor::new(&bytes), &limits).map(drop),
            inspect(&path).map(drop),
            inspect_raster(&path).map(drop),
        ];
        for refused in refused {
            let error = refused.unwrap_err();
            assert!(matches!(error, ImageError::ImplausibleSize { .. }), "{format}: {error}");
            let words =
                format!("{width} × {height} pixels are more than a {format} file of {} bytes can hold", bytes.len());
            assert!(error.to_string().ends_with(&words), "{error}");
        }
    }
}

/// The best compressible image, a single color, is still accepted.
#[test]
fn most_compressible_image_is_accepted() {
    let black = juggler_math::Image::from_pixels(600, 500, vec![juggler_math::Rgb::BLACK; 300_000]).unwrap();
    for format in ImageFormat::ALL {
        let bytes = encode(format, &black, &header(&black));
        let read = decode("a file", Cursor::new(&bytes), &Limits::default());
        assert!(read.is_ok_and(|image| image.pixels() == black.pixels()), "{format}: {} bytes", bytes.len());
    }
}

#[test]
fn side_limit_applies_to_the_header() {
    let image = picture(150, 3, 1.0);
    let limits = Limits { longest_side: 149, ..Limits::default() };
    for format in ImageFormat::ALL {
        let bytes = encode(format, &image, &header(&image));
        let error = decode_raster("a.file", Cursor::new(&bytes), &limits).unwrap_err();
        assert!(matches!(error, ImageError::TooLong { .. }), "{format}: {error}");
        assert_eq!(error.to_string(), "cannot read `a.file`: 150 × 3 pixels; the limit is 149 pixels per side");
    }
}

#[test]
fn unexpected_end_of_file_names_the_byte() {
    let image = picture(40, 30, 1.0);
    for format in [ImageFormat::Png, ImageFormat::Jpeg, ImageFormat::Hdr, ImageFormat::Webp, ImageFormat::Exr] {
        let bytes = encode(format, &image, &header(&image));
        let half = &bytes[..bytes.len() / 2];
        let error = decode("x", Cursor::new(half), &Limits::default()).unwrap_err().to_string();
        assert_eq!(error, format!("cannot read `x`: unexpected end of file at byte {}", half.len()), "{format}");
    }
    let pfm = encode(ImageFormat::Pfm, &image, &header(&image));
    let error = decode("x", Cursor::new(&pfm[..pfm.len() / 2]), &Limits::default()).unwrap_err().to_string();
    assert_eq!(error, format!("cannot read `x`: unexpected end of file at byte {}", pfm.len() / 2));
}

#[test]
fn wrong_checksum_is_reported_with_its_byte() {
    let image = picture(40, 30, 1.0);
    let mut bytes = encode(ImageFormat::Png, &image, &header(&image));
    bytes[29] ^= 1;
    let error = decode("x.png", Cursor::new(&bytes), &Limits::default()).unwrap_err().to_string();
    assert!(error.starts_with("cannot read `x.png`: the checksum of a chunk is wrong (PNG, byte "), "{error}");
}
