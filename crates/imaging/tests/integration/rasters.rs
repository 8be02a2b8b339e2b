//! Samples as stored in files: levels, alpha, transfer functions; damaged files are errors.

use crate::common::{encode, header, picture};
use juggler_imaging::{
    ImageError, ImageFormat, Limits, Options, Raster, RasterLayout, RasterSamples, TransferFunction, decode,
    decode_raster, raster_head,
};
use std::io::Cursor;

const LIMITS: Limits = Limits { max_pixels: 10_000, longest_side: 1_000 };

fn read(bytes: &[u8]) -> Result<Raster, ImageError> {
    decode_raster("a file", Cursor::new(bytes), &LIMITS)
}

/// A PNG of 2 × 1 pixels with the given samples.
fn png(color: png::ColorType, depth: png::BitDepth, gamma: Option<f32>, samples: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 2, 1);
    encoder.set_color(color);
    encoder.set_depth(depth);
    if let Some(gamma) = gamma {
        encoder.set_source_gamma(png::ScaledFloat::new(gamma));
    }
    encoder.write_header().unwrap().write_image_data(samples).unwrap();
    bytes
}

#[test]
fn raster_samples_of_every_format_match_the_image() {
    let image = picture(19, 18, 3.0);
    for format in ImageFormat::ALL {
        let bytes = encode(format, &image, &header(&image));
        let (raster, image) = (read(&bytes).unwrap(), decode("a file", Cursor::new(&bytes), &LIMITS).unwrap());
        assert_eq!((raster.layout.width, raster.layout.height, raster.layout.format), (19, 18, format));
        let linear: Vec<f32> = match &raster.samples {
            RasterSamples::Bytes(levels) => {
                levels.iter().map(|level| raster.transfer_function.decode(f64::from(*level) / 255.0) as f32).collect()
            }
            RasterSamples::Floats(numbers) => numbers.clone(),
            RasterSamples::Words(_) => panic!("the writer requests no words"),
        };
        assert_eq!(linear, image.pixels().iter().flat_map(|p| p.to_array()).collect::<Vec<_>>(), "{format}");
        assert_eq!(raster.transfer_function == TransferFunction::Linear, !format.is_tone_mapped());
    }
}

#[test]
fn heads_have_the_layout_and_the_memory_of_decoders() {
    let image = picture(19, 18, 3.0);
    let head = |bytes: &[u8], limits: &Limits| raster_head("a file", Cursor::new(bytes), limits);
    for format in ImageFormat::ALL {
        let bytes = encode(format, &image, &header(&image));
        let found = head(&bytes, &LIMITS).unwrap();
        assert_eq!(found.layout, read(&bytes).unwrap().layout);
        let samples = 19 * 18 * 3;
        assert_eq!(found.samples_bytes(), samples * u64::from(found.layout.sample_bytes), "{format}");
        assert!((samples..=10 * samples).contains(&found.decoder_bytes), "{format}: {}", found.decoder_bytes);
        assert!(head(&bytes, &Limits { max_pixels: 10, ..LIMITS }).is_err(), "{format}");
    }
    let jpeg = encode(ImageFormat::Jpeg, &image, &header(&image));
    let decoder = |bytes: &[u8]| head(bytes, &LIMITS).unwrap().decoder_bytes;
    // With a second scan, decoders keep the coefficients of the first.
    assert_eq!(decoder(&[jpeg.as_slice(), &[0xff, 0xda]].concat()), 3 * decoder(&jpeg));
}

#[test]
fn png_raster_keeps_alpha_16_bit_samples_and_transfer_function() {
    use png::{BitDepth, ColorType};
    let raster = read(&png(ColorType::Rgba, BitDepth::Eight, None, &[1, 2, 3, 4, 5, 6, 7, 8])).unwrap();
    let layout =
        RasterLayout { format: ImageFormat::Png, width: 2, height: 1, channels: 4, sample_bytes: 1, to_srgb: None };
    let samples = RasterSamples::Bytes(vec![1, 2, 3, 4, 5, 6, 7, 8]);
    let transfer_function = TransferFunction::Srgb;
    assert_eq!(raster, Raster { layout, samples, transfer_function, is_first_of_several: false });
    let raster = read(&png(ColorType::Grayscale, BitDepth::Sixteen, Some(1.0), &[1, 2, 255, 255])).unwrap();
    assert_eq!(
        (raster.samples, raster.transfer_function),
        (RasterSamples::Words(vec![258, 65_535]), TransferFunction::Gamma(1.0))
    );
    assert_eq!((raster.layout.channels, raster.layout.sample_bytes), (1, 2));
    let raster = read(&png(ColorType::GrayscaleAlpha, BitDepth::Eight, None, &[9, 8, 7, 6])).unwrap();
    assert_eq!((raster.layout.channels, raster.samples), (2, RasterSamples::Bytes(vec![9, 8, 7, 6])));
    // One-bit samples are expanded to bytes.
    let raster = read(&png(ColorType::Grayscale, BitDepth::One, None, &[0b0100_0000])).unwrap();
    assert_eq!(raster.samples, RasterSamples::Bytes(vec![0, 255]));
}

#[test]
fn png_states_primaries_and_transfer_functions_by_cicp() {
    let png = |codes: [u8; 4], samples: &[u8]| {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, 2, 1);
        encoder.set_color(png::ColorType::Rgb);
        let mut writer = encoder.write_header().unwrap();
        writer.write_chunk(png::chunk::cICP, &codes).unwrap();
        writer.write_image_data(samples).unwrap();
        drop(writer);
        bytes
    };
    let pixels = [60, 128, 60, 255, 255, 255];
    let raster = read(&png([12, 13, 0, 1], &pixels)).unwrap();
    // The level's linear value times the matrix of CSS Color Module Level 4 from Display P3.
    let [low, high] = [60.0, 128.0].map(|level| raster.transfer_function.decode(level / 255.0) as f32);
    let color = raster.layout.to_srgb.unwrap().color(juggler_math::Rgb::new(low, high, low));
    let expected =
        [1.2249 * low - 0.2249 * high, 1.0421 * high - 0.0421 * low, 1.0983 * low - 0.0786 * high - 0.0197 * low];
    for (found, expected) in color.to_array().into_iter().zip(expected) {
        assert!((found - expected).abs() < 1e-4, "{color:?} {expected}");
    }
    let curve = |code: u8| {
        let bytes = png([1, code, 0, 1], &pixels);
        let (raster, image) = (read(&bytes).unwrap(), decode("a file", Cursor::new(&bytes), &LIMITS).unwrap());
        let linear = raster.transfer_function.decode(128.0 / 255.0) as f32;
        assert_eq!(linear, image.pixels()[0].g, "{code}");
        assert_eq!(raster.layout.to_srgb, None);
        raster.transfer_function
    };
    use TransferFunction::{Gamma, Hlg, Linear, Pq, Srgb};
    let expected = [Srgb, Gamma(2.2), Gamma(2.8), Linear, Srgb, Pq, Gamma(2.6), Hlg];
    assert_eq!([1, 4, 5, 8, 13, 16, 17, 18].map(curve), expected);
    // Video levels: 16 is black, 235 is white, and what is beyond is clipped.
    let bytes = png([1, 8, 0, 0], &[16, 235, 125, 0, 255, 17]);
    assert_eq!(read(&bytes).unwrap().samples, RasterSamples::Bytes(vec![0, 255, 127, 0, 255, 1]));
    let image = decode("a file", Cursor::new(&bytes), &LIMITS).unwrap();
    let [low, high, half] = image.pixels()[0].to_array();
    assert_eq!([low, high, half], [0.0, 1.0, 109.0 / 219.0]);
}

/// Little-endian Exif block with an orientation.
fn exif(code: u8) -> Vec<u8> {
    [b"II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0".as_slice(), &[code, 0, 0, 0, 0, 0, 0, 0]].concat()
}

/// A PNG of 3 × 2 pixels, with or without an Exif block.
fn png_with_exif(exif: Option<&[u8]>, depth: png::BitDepth) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 3, 2);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(depth);
    let mut writer = encoder.write_header().unwrap();
    exif.into_iter().for_each(|exif| writer.write_chunk(png::chunk::eXIf, exif).unwrap());
    let size = if depth == png::BitDepth::Sixteen { 36 } else { 18 };
    writer.write_image_data(&(0..size).map(|level| level * 7).collect::<Vec<u8>>()).unwrap();
    drop(writer);
    bytes
}

/// Pictures of each format, without and with an Exif block.
fn pictures_with_exif(block: &[u8]) -> Vec<(Vec<u8>, Vec<u8>)> {
    use png::BitDepth::{Eight, Sixteen};
    let image = picture(19, 8, 1.0);
    let jpeg = encode(ImageFormat::Jpeg, &image, &header(&image));
    let app1 = [&[0xff, 0xe1, 0, (2 + 6 + block.len()) as u8][..], b"Exif\0\0", block].concat();
    let turned_jpeg = [&jpeg[..2], &app1, &jpeg[2..]].concat();
    let webp = encode(ImageFormat::Webp, &image, &header(&image));
    // An extended file: a flag for Exif, the size, the pixels, and the block.
    let mut chunks = b"WEBPVP8X\x0a\0\0\0\x08\0\0\0\x12\0\0\x07\0\0".to_vec();
    chunks.extend(&webp[12..]);
    chunks.extend(b"EXIF");
    chunks.extend((block.len() as u32).to_le_bytes());
    chunks.extend(block);
    let turned_webp = [b"RIFF".as_slice(), &(chunks.len() as u32).to_le_bytes(), &chunks].concat();
    let pngs = [Eight, Sixteen].map(|depth| (png_with_exif(None, depth), png_with_exif(Some(block), depth)));
    [vec![(jpeg, turned_jpeg), (webp, turned_webp)], pngs.to_vec()].concat()
}

/// Code 6 is that of a phone held upright: the stored rows are turned clockwise.
#[test]
fn pictures_are_turned_by_their_exif_orientation() {
    for (plain, turned) in pictures_with_exif(&exif(6)) {
        let image = |bytes: &[u8]| decode("a file", Cursor::new(bytes), &LIMITS).unwrap();
        let (from, to) = (image(&plain), image(&turned));
        let (width, height) = (from.width(), from.height());
        assert_eq!((to.width(), to.height()), (height, width));
        for (index, pixel) in to.pixels().iter().enumerate() {
            let (x, y) = (index as u32 % height, index as u32 / height);
            assert_eq!(*pixel, from.pixels()[((height - 1 - x) * width + y) as usize], "{x} {y}");
        }
        let raster = read(&turned).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file");
        std::fs::write(&path, &turned).unwrap();
        assert_eq!(juggler_imaging::inspect_raster(&path).unwrap(), raster.layout);
        assert_eq!((raster.layout.width, raster.layout.height), (height, width));
        let info = juggler_imaging::inspect(&path).unwrap();
        assert_eq!((info.width, info.height), (height, width));
        let levels = |bytes: &[u8]| match read(bytes).unwrap().samples {
            RasterSamples::Bytes(levels) => levels.chunks(3).map(|pixel| u32::from(pixel[0])).collect::<Vec<u32>>(),
            RasterSamples::Words(levels) => levels.chunks(3).map(|pixel| u32::from(pixel[0])).collect(),
            RasterSamples::Floats(_) => panic!("levels"),
        };
        assert_eq!(levels(&turned)[1], levels(&plain)[((height - 2) * width) as usize]);
    }
}

/// A Radiance file with these header lines, resolution and pixels.
fn hdr(lines: &str, size: &str, pixels: &[u8]) -> Vec<u8> {
    let head = format!("#?RADIANCE\n{lines}FORMAT=32-bit_rle_rgbe\n\n{size}\n");
    [head.as_bytes(), pixels].concat()
}

#[test]
fn radiance_states_primaries_exposure_and_color_correction() {
    let pixels = [128, 64, 32, 129, 128, 128, 128, 129];
    let lines = "EXPOSURE=2\nEXPOSURE=0.5\nEXPOSURE=4\nCOLORCORR=2 1 0.5\n";
    let image = decode("a file", Cursor::new(hdr(lines, "-Y 1 +X 2", &pixels)), &LIMITS).unwrap();
    assert_eq!(image.pixels()[0].to_array(), [0.125, 0.125, 0.125]);
    let lines = "PRIMARIES=0.680 0.320 0.265 0.690 0.150 0.060 0.3127 0.3290\n";
    let bytes = hdr(lines, "-Y 1 +X 2", &pixels);
    let color = decode("a file", Cursor::new(&bytes), &LIMITS).unwrap().pixels()[0].to_array();
    for (found, expected) in
        color.into_iter().zip([1.2249 - 0.1125, 0.5 * 1.0421 - 0.0421, 0.25 * 1.0983 - 0.0197 - 0.0393])
    {
        assert!((found - expected).abs() < 2e-4, "{color:?}");
    }
    let raster = read(&bytes).unwrap();
    assert_eq!(raster.samples, RasterSamples::Floats(vec![1.0, 0.5, 0.25, 1.0, 1.0, 1.0]));
    assert!(raster.layout.to_srgb.is_some());
    for wrong in ["PRIMARIES=1 2 3\n", "PRIMARIES=a\n", "COLORCORR=0 1 1\n", "COLORCORR=nan 1 1\n", "EXPOSURE=inf\n"] {
        let image = decode("a file", Cursor::new(hdr(wrong, "-Y 1 +X 2", &pixels)), &LIMITS).unwrap();
        assert_eq!(image.pixels()[0].to_array(), [1.0, 0.5, 0.25], "{wrong}");
    }
}

#[test]
fn radiance_has_eight_orientations() {
    // Row by row from the top left, the pixels are 2 3 4 and 5 6 7.
    let orders = [
        ("-Y 2 +X 3", [1, 2, 3, 4, 5, 6]),
        ("-Y 2 -X 3", [3, 2, 1, 6, 5, 4]),
        ("+Y 2 +X 3", [4, 5, 6, 1, 2, 3]),
        ("+Y 2 -X 3", [6, 5, 4, 3, 2, 1]),
        ("+X 3 -Y 2", [1, 4, 2, 5, 3, 6]),
        ("-X 3 -Y 2", [3, 6, 2, 5, 1, 4]),
        ("+X 3 +Y 2", [4, 1, 5, 2, 6, 3]),
        ("-X 3 +Y 2", [6, 3, 5, 2, 4, 1]),
    ];
    for (size, levels) in orders {
        let pixels: Vec<u8> = levels.into_iter().flat_map(|level| [level + 1, level + 1, level + 1, 136]).collect();
        let image = decode("a file", Cursor::new(hdr("", size, &pixels)), &LIMITS).unwrap();
        assert_eq!((image.width(), image.height()), (3, 2), "{size}");
        let found: Vec<f32> = image.pixels().iter().map(|pixel| pixel.r).collect();
        assert_eq!(found, [2.0, 3.0, 4.0, 5.0, 6.0, 7.0], "{size}");
    }
}

#[test]
fn radiance_has_old_runs() {
    let row = |pixels: &[[u8; 4]], width: u32| {
        let bytes = hdr("", &format!("-Y 1 +X {width}"), pixels.as_flattened());
        decode("a file", Cursor::new(bytes), &LIMITS)
            .map(|image| image.pixels().iter().map(|p| p.g).collect::<Vec<_>>())
    };
    let (a, b) = ([9, 8, 7, 136], [1, 2, 3, 136]);
    assert_eq!(row(&[a, [1, 1, 1, 2], b], 4).unwrap(), [8.0, 8.0, 8.0, 2.0]);
    // 1 + 44 + 256 pixels, then another.
    let long = row(&[a, [1, 1, 1, 44], [1, 1, 1, 1], b], 302).unwrap();
    assert!(long[..301].iter().all(|value| *value == 8.0) && long[301] == 2.0);
    let error = row(&[a, [1, 1, 1, 9], b], 4).unwrap_err().to_string();
    assert!(error.contains("a run is longer than its row"), "{error}");
    assert!(row(&[a, [1, 1, 1, 0], [1, 1, 1, 0]], 4).is_err());
}

#[test]
fn damaged_and_huge_files_are_errors() {
    let image = picture(19, 18, 3.0);
    for format in ImageFormat::ALL {
        for options in [Options::default(), Options { png_16_bit: true, ..Options::default() }] {
            let bytes = encode(format, &image, &juggler_imaging::Header { options, ..header(&image) });
            let pixels_end = bytes.len().saturating_sub(40);
            for length in (0..bytes.len()).step_by(7) {
                let result = read(&bytes[..length]);
                assert!(length > pixels_end || result.is_err(), "{format} cut at {length} of {}", bytes.len());
            }
            let small =
                decode_raster("a file", Cursor::new(&bytes), &Limits { max_pixels: 100, ..LIMITS }).unwrap_err();
            assert!(small.to_string().contains("the limit of 100 pixels"), "{small}");
        }
    }
    let text = read(b"no picture at all").unwrap_err().to_string();
    assert!(text.contains("match no supported format"), "{text}");
}
