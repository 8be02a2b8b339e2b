//! Effects of tone settings on files: dithering, primaries.
use crate::common::{encode, encode_by, header, picture, read};
use juggler_imaging::tone::{Agx, Linear};
use juggler_imaging::{AnyCurve, DisplayLook, Header, ImageError, ImageFormat, Options, Primaries, Tone, compare};
use juggler_math::color::srgb_decode;
use juggler_math::{Image, Rgb};

const WIDE: Tone = Tone { primaries: Primaries::Rec2020, ..Tone::new(AnyCurve::Srgb(juggler_imaging::tone::Srgb {})) };

fn with(image: &Image, tone: Tone) -> Header {
    Header { tone, ..header(image) }
}

/// Green levels of a PNG.
fn greens(bytes: &[u8]) -> Vec<u8> {
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
    let mut levels = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut levels).unwrap();
    levels.chunks_exact(3).map(|pixel| pixel[1]).collect()
}

#[test]
fn a_gradient_has_the_means_of_its_values_and_no_steps() {
    let value = |x: u32| 60.0 + f64::from(x) / 64.0;
    let pixels = (0..256 * 64).map(|i| Rgb::splat((value(i % 256) / 255.0) as f32)).collect();
    let image = Image::from_pixels(256, 64, pixels).unwrap();
    let tone = Tone::new(AnyCurve::Linear(Linear {}));
    let error = |dither| {
        let levels = greens(&encode(ImageFormat::Png, &image, &with(&image, Tone { dither, ..tone.clone() })));
        let column =
            |x: u32| levels.iter().skip(x as usize).step_by(256).map(|level| f64::from(*level)).sum::<f64>() / 64.0;
        (0..256).map(|x| (column(x) - value(x)).abs()).fold(0.0, f64::max)
    };
    assert!(error(true) < 0.05 && error(false) > 0.45, "{} {}", error(true), error(false));
}

#[test]
fn flat_colors_stay_flat_in_every_format_of_levels() {
    let color = Rgb::from_hex("#336699").unwrap();
    let image = Image::filled(40, 30, color);
    for format in [ImageFormat::Png, ImageFormat::Webp] {
        let bytes = encode(format, &image, &header(&image));
        let level = |v: f32| (juggler_math::color::srgb_encode(v) * 255.0).round();
        assert!(read(&bytes).pixels().iter().all(|p| p.map(level).to_array() == [51.0, 102.0, 153.0]), "{format}");
    }
}

#[test]
fn dithered_rows_in_any_number_give_the_same_bytes() {
    let image = picture(70, 50, 1.0);
    for format in [ImageFormat::Png, ImageFormat::Webp, ImageFormat::Jpeg] {
        let whole = encode(format, &image, &header(&image));
        for rows in [1, 7, 49] {
            assert!(encode_by(format, &image, &header(&image), rows, true) == whole, "{format} {rows}");
        }
        let plain = encode(format, &image, &with(&image, Tone { dither: false, ..Tone::default() }));
        assert!(plain != whole, "{format}");
    }
}

#[test]
fn looks_and_16_bits_are_not_dithered() {
    let image = picture(70, 50, 1.0);
    for options in [
        Options { png_16_bit: true, ..Options::default() },
        Options { look: DisplayLook::Ham, ..Options::default() },
        Options { look: DisplayLook::HamDithered, ..Options::default() },
    ] {
        let [a, b] = [true, false].map(|dither| {
            let tone = Tone { dither, ..Tone::default() };
            encode(ImageFormat::Png, &image, &Header { options, ..with(&image, tone) })
        });
        assert!(a == b, "{options:?}");
    }
}

#[test]
fn wide_gamut_png_declares_its_primaries_and_reads_back() {
    let pixels = (0..40 * 30).map(|i| Rgb::new(srgb_decode((i % 40) as f32 / 40.0), 0.2, (i / 40) as f32 / 30.0));
    let image = Image::from_pixels(40, 30, pixels.collect()).unwrap();
    let options = Options { png_16_bit: true, ..Options::default() };
    for (primaries, code) in [(Primaries::DisplayP3, 12), (Primaries::Rec2020, 9)] {
        let bytes = encode(ImageFormat::Png, &image, &Header { options, ..with(&image, Tone { primaries, ..WIDE }) });
        let info = png::Decoder::new(std::io::Cursor::new(&bytes)).read_info().unwrap().info().clone();
        let codes = info.coding_independent_code_points.unwrap();
        assert_eq!((codes.color_primaries, codes.transfer_function, codes.matrix_coefficients), (code, 13, 0));
        assert!(codes.is_video_full_range_image && info.srgb.is_none());
        let red = info.chrm_chunk.unwrap().red.0.into_value();
        assert!((f64::from(red) - primaries.chromaticities().red[0]).abs() < 2e-5);
        let found = compare(&read(&bytes), &image).unwrap();
        assert!(found.largest < 1e-4 && found.largest > 0.0, "{primaries:?} {found:?}");
    }
}

#[test]
fn png_with_only_chromaticities_is_converted_by_them() {
    let p3 = Primaries::DisplayP3.chromaticities();
    let pair = |[x, y]: [f64; 2]| (x as f32, y as f32);
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 1, 1);
    encoder.set_color(png::ColorType::Rgb);
    let chunk = png::SourceChromaticities::new(pair(p3.white), pair(p3.red), pair(p3.green), pair(p3.blue));
    encoder.set_source_chromaticities(chunk);
    encoder.write_header().unwrap().write_image_data(&[255, 0, 0]).unwrap();
    // The red of Display P3 in the primaries of sRGB (CSS Color 4: color(display-p3 1 0 0)).
    let pixel = read(&bytes).pixels()[0];
    assert!(
        (pixel.r - 1.2249).abs() < 1e-3 && (pixel.g + 0.0420).abs() < 1e-3 && (pixel.b + 0.0197).abs() < 1e-3,
        "{pixel:?}"
    );
}

#[test]
fn wide_gamut_exr_reads_back_as_the_same_radiance() {
    let image = picture(33, 17, 100.0);
    let plain = encode(ImageFormat::Exr, &image, &header(&image));
    for primaries in [Primaries::DisplayP3, Primaries::Rec2020, Primaries::Acescg] {
        let bytes = encode(ImageFormat::Exr, &image, &with(&image, Tone { primaries, ..WIDE }));
        assert!(
            bytes.windows(14).any(|name| name == b"chromaticities")
                && !plain.windows(14).any(|n| n == b"chromaticities")
        );
        let found = compare(&read(&bytes), &image).unwrap();
        assert!(found.largest < 1e-4 && found.largest > 0.0, "{primaries:?} {found:?}");
        // White is the same in all primaries, so gray values are unchanged.
        let gray = Image::filled(3, 2, Rgb::splat(0.25));
        let tone = Tone { primaries, ..WIDE };
        assert!(compare(&read(&encode(ImageFormat::Exr, &gray, &with(&gray, tone))), &gray).unwrap().largest < 1e-6);
    }
}

#[test]
fn formats_without_primaries_reject_wide_gamuts() {
    let image = picture(8, 8, 1.0);
    let refused = |format, primaries, options| {
        let header = Header { options, ..with(&image, Tone { primaries, ..WIDE }) };
        match header.check(format) {
            Err(error @ ImageError::Primaries { .. }) => error.to_string().contains(primaries.name()),
            Err(other) => panic!("{other}"),
            Ok(()) => false,
        }
    };
    for format in [ImageFormat::Jpeg, ImageFormat::Webp, ImageFormat::Hdr, ImageFormat::Pfm] {
        assert!(refused(format, Primaries::DisplayP3, Options::default()), "{format}");
        assert!(!refused(format, Primaries::Srgb, Options::default()), "{format}");
    }
    assert!(refused(ImageFormat::Png, Primaries::Acescg, Options::default()));
    assert!(refused(ImageFormat::Png, Primaries::Rec2020, Options { look: DisplayLook::Ham, ..Options::default() }));
    assert!(!refused(ImageFormat::Exr, Primaries::Acescg, Options::default()));
}

#[test]
fn tone_curves_across_channels_apply_to_files() {
    let image = Image::filled(4, 4, Rgb::new(20.0, 0.1, 0.1));
    let tone = Tone::new(AnyCurve::Agx(Agx::default()));
    let bytes = encode(ImageFormat::Png, &image, &with(&image, Tone { dither: false, ..tone.clone() }));
    assert_eq!(greens(&bytes), [tone.levels(image.pixels()[0], 255)[1] as u8; 16]);
    // The curve desaturates bright red.
    assert!(tone.levels(image.pixels()[0], 255)[1] > 60);
}
