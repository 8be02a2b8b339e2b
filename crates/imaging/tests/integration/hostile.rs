//! Damaged files: an error that names the file, no panic, memory within the limit.

use crate::common::{encode, header, picture};
use juggler_imaging::{Header, ImageError, ImageFormat, Limits, Options, decode, inspect, read};
use juggler_math::testing::Random;
use std::io::Cursor;
use std::path::Path;

const LIMITS: Limits = Limits { max_pixels: 10_000, longest_side: 1_000 };

fn files() -> Vec<(ImageFormat, Vec<u8>)> {
    let image = picture(19, 18, 3.0);
    let mut header = Header { metadata: vec![("Software".into(), "Juggler".into())], ..header(&image) };
    let mut files: Vec<_> = ImageFormat::ALL.map(|f| (f, encode(f, &image, &header))).into();
    header.options = Options { png_16_bit: true, ..Options::default() };
    files.push((ImageFormat::Png, encode(ImageFormat::Png, &image, &header)));
    files
}

/// Decodes the file; it must return, with any result.
fn try_all(bytes: &[u8]) -> Result<juggler_math::Image, ImageError> {
    decode("a file", Cursor::new(bytes), &LIMITS)
}

#[test]
fn files_cut_at_every_byte_are_errors() {
    for (format, bytes) in files() {
        // Data after the pixels (checksums, end markers) are not required.
        let pixels_end = bytes.len().saturating_sub(40);
        for length in 0..bytes.len() {
            let result = try_all(&bytes[..length]);
            assert!(length > pixels_end || result.is_err(), "{format} cut at {length} of {}", bytes.len());
            if let Err(error) = result {
                assert!(error.to_string().starts_with("cannot read `a file`: "), "{error}");
            }
        }
    }
}

/// Messages are plain sentences without internals of the decoders.
fn assert_plain(message: &str) {
    for foreign in ["{", "::", "\"", "Some(", "0x", "ChunkType", "UTF-8", "DecodeError", "os error"] {
        assert!(!message.contains(foreign), "{message}");
    }
}

#[test]
fn mutated_files_never_panic() {
    let mut random = Random::new(7);
    for (format, original) in files() {
        for _ in 0..1500 {
            let mut bytes = original.clone();
            for _ in 0..=random.below(4) {
                // Damage headers more often, since they matter most.
                let reach = if random.below(2) == 0 { bytes.len().min(400) } else { bytes.len() };
                let at = random.below(reach);
                bytes[at] = [0, 255, 127, 128, random.bits() as u8][random.below(5)];
            }
            match try_all(&bytes) {
                Ok(image) => assert!(image.pixels().len() <= 10_000, "{format}"),
                Err(error) => assert_plain(&error.to_string()),
            }
        }
    }
}

#[test]
fn metadata_of_mutated_and_cut_files_never_panics() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("file");
    let mut random = Random::new(8);
    for (_, original) in files() {
        for _ in 0..100 {
            let mut bytes = original[..random.below(original.len())].to_vec();
            if !bytes.is_empty() {
                let at = random.below(bytes.len().min(200));
                bytes[at] = random.bits() as u8;
            }
            std::fs::write(&path, &bytes).unwrap();
            let _ = inspect(&path);
        }
    }
}

#[test]
fn sizes_beyond_the_limit_are_named() {
    let image = picture(150, 100, 1.0);
    for format in ImageFormat::ALL {
        let error = try_all(&encode(format, &image, &header(&image))).unwrap_err();
        assert!(matches!(error, ImageError::TooLarge { width: 150, height: 100, max_pixels: 10_000, .. }), "{error}");
    }
}

#[test]
fn a_small_file_that_claims_a_huge_size_costs_little() {
    let limits = Limits::default();
    let claims: [&[u8]; 3] = [
        b"PF\n20000 20000\n-1.0\nabc",
        b"PF\n4000000000 4000000000\n-1.0\n",
        b"#?RADIANCE\n\n-Y 20000 +X 20000\n\x02\x02\x4e\x20",
    ];
    for bytes in claims {
        decode("a file", Cursor::new(bytes), &limits).unwrap_err();
    }
}

#[test]
fn files_that_are_not_images_are_reported() {
    for bytes in [&b""[..], b"P", b"hello world, hello", b"\x89PNG", b"RIFF1234WAVE"] {
        let error = try_all(bytes).unwrap_err();
        assert!(matches!(error, ImageError::UnknownContent { .. }), "{error}");
    }
    for wrong in ["/nonexistent/a.png", "/"] {
        let error = read(Path::new(wrong)).unwrap_err();
        assert!(matches!(error, ImageError::Read { .. }), "{error}");
        assert!(error.to_string().starts_with(&format!("cannot read `{wrong}`: ")), "{error}");
    }
}
