//! Round trips of every format, within its precision.

use crate::common::{encode, encode_by, header, picture, read};
use juggler_imaging::tone::Gamma;
use juggler_imaging::{
    AnyCurve, Destination, ExrCompression, ExrWindows, Header, ImageError, ImageFormat, ImageInfo, Options,
    SampleDepth, Tone, compare, create, inspect, write_image, writer,
};
use juggler_math::{Image, Rgb};
use std::path::Path;

const SIZES: [(u32, u32); 6] = [(1, 1), (7, 3), (8, 2), (33, 35), (1, 40), (300, 5)];

/// Compares all channels after a round trip with the error `bound` of the format.
fn check(format: ImageFormat, header: impl Fn(&Image) -> Header, brightest: f32, bound: impl Fn(Rgb, f32) -> f32) {
    for (width, height) in SIZES {
        let image = picture(width, height, brightest);
        let back = read(&encode(format, &image, &header(&image)));
        assert_eq!((back.width(), back.height()), (width, height), "{format}");
        for (i, (a, b)) in image.pixels().iter().zip(back.pixels()).enumerate() {
            for (x, y) in a.to_array().into_iter().zip(b.to_array()) {
                assert!((x - y).abs() <= bound(*a, x), "{format} {width}×{height}, pixel {i}: {x} became {y}");
            }
        }
    }
}

/// Half a quantization step in linear RGB around `x` (the slope of sRGB is at most 2.28, at white).
fn half_step(x: f32, top: f32) -> f32 {
    (0.51 / top) * (2.28 * x.max(1e-4).powf(0.583)).max(1.0 / 12.92)
}

#[test]
fn pfm_keeps_every_bit() {
    check(ImageFormat::Pfm, header, 1e9, |_, _| 0.0);
}

#[test]
fn exr_floats_keep_every_bit_and_halves_eleven() {
    for exr_compression in [ExrCompression::None, ExrCompression::Rle, ExrCompression::Zip] {
        let options = Options { exr_compression, ..Options::default() };
        check(ImageFormat::Exr, |i| Header { options, ..header(i) }, 1e9, |_, _| 0.0);
        let options = Options { exr_depth: SampleDepth::Half, ..options };
        check(ImageFormat::Exr, |i| Header { options, ..header(i) }, 6e4, |_, x| x.abs() / 2048.0 + 3e-8);
    }
}

#[test]
fn nonfinite_values_survive_in_float_formats() {
    let odd = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -0.0, -3.5, 1e-40];
    let image =
        Image::from_pixels(2, 1, vec![Rgb::new(odd[0], odd[1], odd[2]), Rgb::new(odd[3], odd[4], odd[5])]).unwrap();
    for format in [ImageFormat::Pfm, ImageFormat::Exr] {
        assert!(compare(&image, &read(&encode(format, &image, &header(&image)))).unwrap().same_bits, "{format}");
    }
    for format in [ImageFormat::Png, ImageFormat::Jpeg, ImageFormat::Webp, ImageFormat::Hdr] {
        assert!(read(&encode(format, &image, &header(&image))).pixels().iter().all(|p| p.is_finite()), "{format}");
    }
}

#[test]
fn hdr_keeps_an_eighth_bit_of_the_brightest_channel() {
    check(ImageFormat::Hdr, header, 1e9, |c, _| c.max_channel() / 256.0);
    // Both ends of the range.
    let image = Image::from_pixels(2, 1, vec![Rgb::splat(1e38), Rgb::splat(1e-30)]).unwrap();
    let back = read(&encode(ImageFormat::Hdr, &image, &header(&image)));
    assert!((back.pixels()[0].r / 1e38 - 1.0).abs() < 0.01 && (back.pixels()[1].g / 1e-30 - 1.0).abs() < 0.01);
}

#[test]
fn png_and_webp_keep_the_nearest_level() {
    let plain = |image: &Image| Header { tone: Tone { dither: false, ..Tone::default() }, ..header(image) };
    check(ImageFormat::Png, plain, 1.0, |_, x| half_step(x, 255.0));
    check(ImageFormat::Webp, plain, 1.0, |_, x| half_step(x, 255.0));
    // Dithering picks one of the two nearest levels.
    check(ImageFormat::Png, header, 1.0, |_, x| 2.05 * half_step(x + 0.02, 255.0));
    let options = Options { png_16_bit: true, ..Options::default() };
    check(ImageFormat::Png, |i| Header { options, ..header(i) }, 1.0, |_, x| half_step(x, 65_535.0));
}

#[test]
fn equal_levels_are_equal_light_in_every_format() {
    let image = picture(33, 35, 1.0);
    let light = |format| read(&encode(format, &image, &header(&image)));
    assert!(compare(&light(ImageFormat::Webp), &light(ImageFormat::Png)).unwrap().same_bits);
}

#[test]
fn all_levels_of_a_16_bit_png_are_exact() {
    let levels: Vec<f32> = (0..=65_535u32).map(|k| juggler_math::color::srgb_decode(k as f32 / 65_535.0)).collect();
    let image = Image::from_pixels(256, 256, levels.iter().map(|&v| Rgb::splat(v)).collect()).unwrap();
    let options = Options { png_16_bit: true, ..Options::default() };
    let bytes = encode(ImageFormat::Png, &image, &Header { options, ..header(&image) });
    let back = read(&bytes);
    // Adjacent levels differ by 1.5e-5, so compare levels, not values.
    for (k, p) in back.pixels().iter().enumerate() {
        let level = (juggler_math::color::srgb_encode(p.g) * 65_535.0).round() as usize;
        assert!(level == k && p.r == p.g && p.g == p.b, "{k}");
    }
}

#[test]
fn every_png_declares_srgb_for_any_tone_curve() {
    let image = Image::filled(3, 2, Rgb::splat(0.25));
    for curve in [AnyCurve::Gamma(Gamma { gamma: 2.2 }), AnyCurve::Linear(juggler_imaging::tone::Linear {})] {
        let tone = Tone { dither: false, ..Tone::new(curve) };
        let level = (tone.curve.channel_curve().encode(0.25) * 255.0).round() / 255.0;
        let bytes = encode(ImageFormat::Png, &image, &Header { tone, ..header(&image) });
        let info = png::Decoder::new(std::io::Cursor::new(&bytes)).read_info().unwrap().info().clone();
        assert!(info.srgb.is_some() && info.gama_chunk.is_none_or(|gamma| gamma.into_scaled() == 45_455));
        let back = f64::from(read(&bytes).pixels()[0].g);
        assert!((f64::from(juggler_math::color::srgb_encode(back as f32)) - level).abs() < 1e-4, "{back} {level}");
    }
}

#[test]
fn gamma_chunk_of_a_foreign_png_is_decoded() {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 1, 1);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_source_gamma(png::ScaledFloat::new(1.0));
    encoder.write_header().unwrap().write_image_data(&[51, 102, 255]).unwrap();
    let pixel = read(&bytes).pixels()[0];
    assert!((pixel.r - 0.2).abs() < 1e-6 && (pixel.g - 0.4).abs() < 1e-6 && pixel.b == 1.0, "{pixel:?}");
}

/// Pixels of a Radiance file are already multiplied by all its exposures.
#[test]
fn exposures_of_a_radiance_file_are_divided_out() {
    let file = |lines: &str| {
        let header = format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n{lines}\n-Y 1 +X 1\n");
        read(&[header.as_bytes(), &[128, 64, 32, 129]].concat()).pixels()[0]
    };
    // An exponent of 129 makes a mantissa of 128 equal to 1.
    for (lines, exposure) in [("", 1.0), ("EXPOSURE=2\n", 2.0), ("EXPOSURE= 0.5\nEXPOSURE=16\n", 8.0)] {
        assert_eq!(file(lines), Rgb::new(1.0, 0.5, 0.25) / exposure, "{lines}");
    }
}

#[test]
fn exposure_applies_to_levels_and_not_to_scene_referred_formats() {
    let image = Image::filled(4, 4, Rgb::splat(0.1));
    let tone = Tone { exposure_stops: 1.0, ..Tone::default() };
    for format in ImageFormat::ALL {
        let back = read(&encode(format, &image, &Header { tone: tone.clone(), ..header(&image) }));
        let expected = if format.is_tone_mapped() { 0.2 } else { 0.1 };
        assert!((back.pixels()[5].g - expected).abs() < 0.002, "{format} {:?}", back.pixels()[5]);
    }
}

#[test]
fn jpeg_is_close_and_better_at_higher_quality() {
    let pixels = (0..64 * 64).map(|i| Rgb::new((i % 64) as f32 / 64.0, (i / 64) as f32 / 64.0, 0.3)).collect();
    let image = Image::from_pixels(64, 64, pixels).unwrap();
    let error = |jpeg_quality| {
        let options = Options { jpeg_quality, ..Options::default() };
        compare(&read(&encode(ImageFormat::Jpeg, &image, &Header { options, ..header(&image) })), &image).unwrap().rmse
    };
    assert!(error(95) < 0.01 && error(95) < error(30), "{} {}", error(95), error(30));
}

#[test]
fn rows_in_any_number_and_a_pipe_give_the_same_bytes() {
    for format in ImageFormat::ALL {
        for (width, height) in [(9, 37), (200, 40)] {
            let image = picture(width, height, 2.0);
            let mut header = header(&image);
            header.metadata = (0..5).map(|i| (format!("key {i}"), "value".to_owned())).collect();
            let whole = encode(format, &image, &header);
            for rows in [1, 3, 16, 17] {
                assert!(encode_by(format, &image, &header, rows, true) == whole, "{format} {rows}");
                assert!(encode_by(format, &image, &header, rows, false) == whole, "{format} {rows} to a pipe");
            }
        }
    }
}

#[test]
fn metadata_is_read_back_in_order() {
    let folder = tempfile::tempdir().unwrap();
    let pairs =
        [("Software", "Juggler 0.1"), ("juggler:fingerprint", "00ff"), ("seed", "7"), ("command", "render a=b")];
    let metadata: Vec<(String, String)> = pairs.iter().map(|(k, v)| (k.to_string(), v.to_string())).collect();
    for format in [ImageFormat::Png, ImageFormat::Exr, ImageFormat::Hdr] {
        let path = folder.path().join(format!("a.{}", format.extension()));
        let image = picture(9, 9, 1.0);
        let header = Header { metadata: metadata.clone(), ..header(&image) };
        write_image(create(&path, format, &header).unwrap(), &image).unwrap();
        let windows = (format == ImageFormat::Exr).then(|| ExrWindows::new([9, 9], None));
        let (metadata, is_tone_mapped) = (metadata.clone(), format == ImageFormat::Png);
        let info = ImageInfo { format, width: 9, height: 9, is_tone_mapped, metadata, windows };
        assert_eq!(inspect(&path).unwrap(), info);
    }
    let path = folder.path().join("unicode.png");
    let image = picture(9, 9, 1.0);
    let text = vec![("command".to_owned(), "szene_größe 画.json".to_owned())];
    for format in [ImageFormat::Png, ImageFormat::Exr] {
        let header = Header { metadata: text.clone(), ..header(&image) };
        write_image(create(&path, format, &header).unwrap(), &image).unwrap();
        assert_eq!(inspect(&path).unwrap().metadata, text);
        assert_eq!(juggler_imaging::read(&path).unwrap().width(), 9);
    }
    let long = Header { metadata: vec![("k".repeat(60), "v".into())], ..header(&image) };
    assert_eq!(read(&encode(ImageFormat::Exr, &image, &long)), image);
}

#[test]
fn sizes_are_read_without_the_pixels() {
    let folder = tempfile::tempdir().unwrap();
    for format in ImageFormat::ALL {
        let path = folder.path().join("file");
        let image = picture(33, 7, 1.0);
        std::fs::write(&path, encode(format, &image, &header(&image))).unwrap();
        let windows = (format == ImageFormat::Exr).then(|| ExrWindows::new([33, 7], None));
        let (metadata, is_tone_mapped) = (Vec::new(), format.is_tone_mapped());
        let info = ImageInfo { format, width: 33, height: 7, is_tone_mapped, metadata, windows };
        assert_eq!(inspect(&path).unwrap(), info);
    }
}

#[test]
fn files_appear_only_when_finished() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    let image = picture(20, 20, 1.0);
    write_image(create(&path, ImageFormat::Png, &header(&image)).unwrap(), &image).unwrap();
    let old = std::fs::read(&path).unwrap();
    let mut rows = create(&path, ImageFormat::Png, &header(&image)).unwrap();
    rows.write_rows(image.pixels()[..200].into()).unwrap();
    assert!(matches!(rows.finish(), Err(ImageError::Rows { expected: 200, given: 0 })));
    drop(create(&path, ImageFormat::Exr, &header(&image)).unwrap());
    assert_eq!(std::fs::read(&path).unwrap(), old);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[cfg(unix)]
#[test]
fn devices_are_written_and_not_replaced() {
    use std::os::unix::fs::FileTypeExt;
    let image = picture(20, 20, 1.0);
    for format in ImageFormat::ALL {
        write_image(create(Path::new("/dev/null"), format, &header(&image)).unwrap(), &image).unwrap();
    }
    assert!(std::fs::metadata("/dev/null").unwrap().file_type().is_char_device());
}

#[test]
fn full_disks_are_reported_with_their_place() {
    if !Path::new("/dev/full").exists() {
        return;
    }
    // The small image fits into every buffer, so that only the final flush can fail.
    for (format, edge) in ImageFormat::ALL.into_iter().flat_map(|format| [(format, 3), (format, 300)]) {
        let image = picture(edge, edge, 1.0);
        let result = create(Path::new("/dev/full"), format, &header(&image)).and_then(|rows| write_image(rows, &image));
        let message = result.unwrap_err().to_string();
        assert!(message.contains("/dev/full") && message.contains("cannot write"), "{format}: {message}");
    }
}

#[test]
fn half_rows_and_rows_too_many_are_refused() {
    let image = picture(10, 4, 1.0);
    for format in ImageFormat::ALL {
        let mut rows =
            writer(format, Destination::seekable("m", std::io::Cursor::new(vec![])), &header(&image)).unwrap();
        assert!(matches!(rows.write_rows(image.pixels()[..15].into()), Err(ImageError::Rows { given: 15, .. })));
        rows.write_rows(image.pixels().into()).unwrap();
        assert!(matches!(
            rows.write_rows(image.pixels()[..10].into()),
            Err(ImageError::Rows { expected: 0, given: 10 })
        ));
        rows.finish().unwrap();
        let wrong = Header::new(0, 4);
        assert!(writer(format, Destination::stream("m", std::io::sink()), &wrong).is_err());
    }
}
