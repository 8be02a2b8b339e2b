//! Files with alpha, read by other decoders.

use crate::common::Shared;
use juggler_imaging::tone::{Agx, AnyCurve, Gamma, Quantizer};
use juggler_imaging::{
    AnimationFormat, AnimationHeader, Destination, DisplayLook, Header, ImageFormat, Options, Tone, animation_writer,
    create, create_animation, read, read_with_alpha, to_memory, writer,
};
use juggler_math::{PixelRows, Rgb};
use std::io::Cursor;

const SIZE: [u32; 2] = [20, 12];

/// Premultiplied colors and alpha: a soft disk that moves to the right with `number`.
fn frame(number: u32) -> (Vec<Rgb>, Vec<f32>) {
    let pixel = |i: u32| {
        let (x, y) = ((i % SIZE[0]) as f32 - 5.0 - 4.0 * number as f32, (i / SIZE[0]) as f32 - 6.0);
        let alpha = (5.0 - x.hypot(y)).clamp(0.0, 1.0);
        (Rgb::new(0.9, 0.2, 0.05) * alpha, alpha)
    };
    (0..SIZE[0] * SIZE[1]).map(pixel).unzip()
}

fn header() -> Header {
    let tone = Tone { dither: false, ..Tone::default() };
    Header { tone, transparent: true, ..Header::new(SIZE[0], SIZE[1]) }
}

/// 8-bit RGBA with straight colors.
fn expected(number: u32) -> Vec<u8> {
    let (colors, alpha) = frame(number);
    let mut levels = Vec::new();
    let straight: Vec<Rgb> =
        colors.iter().zip(&alpha).map(|(color, a)| if *a > 0.0 { *color / *a } else { Rgb::BLACK }).collect();
    Quantizer::new(&header().tone, 255).append_bytes(&straight, &mut levels);
    let pixels = levels.chunks_exact(3).zip(&alpha);
    pixels.flat_map(|(rgb, alpha)| [rgb[0], rgb[1], rgb[2], (alpha * 255.0).round() as u8]).collect()
}

#[test]
fn levels_are_straight_and_exr_is_premultiplied() {
    let (colors, alpha) = frame(0);
    let rows = PixelRows { colors: &colors, alpha: Some(&alpha) };
    let png = to_memory(ImageFormat::Png, &header(), rows).unwrap();
    let mut reader = png::Decoder::new(Cursor::new(&png)).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    assert_eq!(reader.next_frame(&mut bytes).unwrap().color_type, png::ColorType::Rgba);
    assert!(bytes == expected(0));
    let webp = to_memory(ImageFormat::Webp, &header(), rows).unwrap();
    let mut decoder = image_webp::WebPDecoder::new(Cursor::new(&webp)).unwrap();
    assert!(decoder.has_alpha());
    let mut bytes = vec![0; decoder.output_buffer_size().unwrap()];
    decoder.read_image(&mut bytes).unwrap();
    assert!(bytes == expected(0));
    let folder = tempfile::tempdir().unwrap();
    for (name, error) in [("a.exr", 0.0), ("a.png", 0.004), ("a.webp", 0.004)] {
        let path = folder.path().join(name);
        let format = ImageFormat::from_path(&path).unwrap();
        let mut file = create(&path, format, &header()).unwrap();
        rows.chunks(SIZE[0] as usize * 5).for_each(|rows| file.write_rows(rows).unwrap());
        file.finish().unwrap();
        let back = read_with_alpha(&path).unwrap();
        let far = |a: f32, b: f32| (a - b).abs() > error;
        let wrong = back.alpha.unwrap().iter().zip(&alpha).any(|(a, b)| far(*a, *b));
        assert!(!wrong, "{name}: alpha");
        for (a, b) in back.colors.pixels().iter().zip(&colors) {
            assert!(!a.to_array().into_iter().zip(b.to_array()).any(|(a, b)| far(a, b)), "{name}: {a:?} {b:?}");
        }
    }
}

#[test]
fn halves_and_words_have_alpha() {
    let (colors, alpha) = frame(0);
    let rows = PixelRows { colors: &colors, alpha: Some(&alpha) };
    let folder = tempfile::tempdir().unwrap();
    let half = Options { exr_depth: juggler_imaging::SampleDepth::Half, png_16_bit: true, ..Options::default() };
    let exr = to_memory(ImageFormat::Exr, &Header { options: half, ..header() }, rows).unwrap();
    std::fs::write(folder.path().join("half.exr"), exr).unwrap();
    let found = exr::prelude::read_first_rgba_layer_from_file(
        folder.path().join("half.exr"),
        |_, _| Vec::new(),
        |all: &mut Vec<f32>, _, (_, _, _, alpha): (f32, f32, f32, f32)| all.push(alpha),
    );
    let found = found.unwrap().layer_data.channel_data.pixels;
    assert!(found.len() == alpha.len() && found.iter().zip(&alpha).all(|(a, b)| (a - b).abs() < 1e-3));
    let words = to_memory(ImageFormat::Png, &Header { options: half, ..header() }, rows).unwrap();
    let reader = png::Decoder::new(Cursor::new(&words)).read_info().unwrap();
    assert_eq!(reader.output_color_type(), (png::ColorType::Rgba, png::BitDepth::Sixteen));
}

/// Blending at edges in linear light gives the color of the disk over any background.
#[test]
fn edges_have_no_fringe() {
    let (colors, alpha) = frame(0);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    let rows = PixelRows { colors: &colors, alpha: Some(&alpha) };
    let options = Options { png_16_bit: true, ..Options::default() };
    std::fs::write(&path, to_memory(ImageFormat::Png, &Header { options, ..header() }, rows).unwrap()).unwrap();
    let straight = read(&path).unwrap();
    for (straight, alpha) in straight.pixels().iter().zip(&alpha).filter(|(_, alpha)| **alpha > 0.0) {
        let color = Rgb::new(0.9, 0.2, 0.05);
        assert!((*straight - color).map(f32::abs).max_channel() < 1e-4, "{straight:?} at alpha {alpha}");
    }
}

/// A backdrop keeps its levels under every curve, opaque pixels keep theirs, and between them the
/// display's light is mixed. Files have no alpha.
#[test]
fn backdrops_are_mixed_in_the_light_of_the_display() {
    let backdrop = Rgb::from_css("#3080f0").unwrap();
    let color = Rgb::new(0.6, 0.3, 0.1);
    let folder = tempfile::tempdir().unwrap();
    let alpha = [0.0, 0.25, 1.0, 2.0, -1.0, 0.5];
    let colors = alpha.map(|alpha| color * f32::clamp(alpha, 0.0, 1.0));
    let rows = PixelRows { colors: &colors, alpha: Some(&alpha) };
    for curve in [AnyCurve::default(), AnyCurve::Agx(Agx::default()), AnyCurve::Gamma(Gamma { gamma: 1.8 })] {
        let tone = Tone { dither: false, backdrop: Some(backdrop), ..Tone::new(curve.clone()) };
        let quantizer = Quantizer::new(&tone, 65_535);
        let levels: Vec<[u16; 3]> = quantizer.all_levels(rows).collect();
        let display = Tone { backdrop: None, ..tone.clone() };
        assert_eq!(levels[2], display.levels(color, 65_535), "{curve:?}");
        assert_eq!((levels[3], levels[4]), (levels[2], levels[0]));
        let decode = |level: u16| curve.channel_curve().decode(f64::from(level) / 65_535.0);
        for (channel, own) in backdrop.to_array().into_iter().enumerate() {
            let [behind, mixed, front] = [0, 1, 2].map(|pixel| decode(levels[pixel][channel]));
            assert!((behind - f64::from(own)).abs() < 1e-4, "{curve:?}: {behind} {own}");
            assert!((mixed - (0.25 * front + 0.75 * behind)).abs() < 1e-4, "{curve:?}: {mixed}");
        }
        let header = Header { tone, transparent: true, ..Header::new(6, 1) };
        for format in [ImageFormat::Png, ImageFormat::Webp, ImageFormat::Jpeg] {
            assert!(to_memory(format, &header, rows).is_ok(), "{format}");
        }
        let png = to_memory(ImageFormat::Png, &header, rows).unwrap();
        let reader = png::Decoder::new(Cursor::new(&png)).read_info().unwrap();
        assert_eq!(reader.output_color_type().0, png::ColorType::Rgb);
        // EXR files store light, so that the backdrop has no place there.
        let path = folder.path().join("a.exr");
        std::fs::write(&path, to_memory(ImageFormat::Exr, &header, rows).unwrap()).unwrap();
        assert!(read_with_alpha(&path).unwrap().alpha.is_some());
        assert!(to_memory(ImageFormat::Hdr, &header, rows).is_err());
    }
}

#[test]
fn formats_without_alpha_are_refused_by_name() {
    for format in [ImageFormat::Jpeg, ImageFormat::Hdr, ImageFormat::Pfm] {
        let error = writer(format, Destination::seekable("memory", Shared::default()), &header()).err().unwrap();
        let message = error.to_string();
        assert!(message.starts_with(&format!("a {format} file cannot be transparent")), "{message}");
        assert!(message.contains(".png, .webp or .exr"), "{message}");
    }
    let options = Options { look: DisplayLook::Ham, ..Options::default() };
    let error = Header { options, ..header() }.check(ImageFormat::Png).unwrap_err().to_string();
    assert!(error.contains("with the display look `ham`"), "{error}");
    #[cfg(feature = "av1")]
    {
        let header = AnimationHeader { transparent: true, ..AnimationHeader::new(32, 32, 1, 10.0) };
        let error = AnimationFormat::Mp4.check("a.mp4", &header).unwrap_err().to_string();
        assert!(error.contains("MP4 cannot be transparent; use .webp, .apng or .gif"), "{error}");
    }
}

fn movie(format: AnimationFormat) -> Vec<u8> {
    let header = AnimationHeader { transparent: true, ..AnimationHeader::new(SIZE[0], SIZE[1], 3, 10.0) };
    let file = Shared::default();
    let mut movie = animation_writer(format, Destination::seekable("memory", file.clone()), &header).unwrap();
    for number in 0..3 {
        let (colors, alpha) = frame(number);
        movie.write_frame(PixelRows { colors: &colors, alpha: Some(&alpha) }).unwrap();
    }
    movie.finish().unwrap();
    file.bytes()
}

/// Frames replace what they cover, so that pixels become transparent again.
#[test]
fn movies_have_the_alpha_of_each_frame() {
    let file = movie(AnimationFormat::Webp);
    let mut decoder = image_webp::WebPDecoder::new(Cursor::new(&file)).unwrap();
    assert!(decoder.has_alpha());
    let mut canvas = vec![0; decoder.output_buffer_size().unwrap()];
    for number in 0..3 {
        decoder.read_frame(&mut canvas).unwrap();
        assert!(canvas == expected(number), "frame {number} of the WebP");
    }
    let file = movie(AnimationFormat::Apng);
    let mut reader = png::Decoder::new(Cursor::new(&file)).read_info().unwrap();
    let mut canvas = vec![0; expected(0).len()];
    for number in 0..3 {
        let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
        let output = reader.next_frame(&mut bytes).unwrap();
        let control = *reader.info().frame_control().unwrap();
        assert_eq!(control.blend_op, png::BlendOp::Source);
        let line = control.width as usize * 4;
        for (row, pixels) in bytes[..output.buffer_size()].chunks_exact(line).enumerate() {
            let start = ((control.y_offset as usize + row) * SIZE[0] as usize + control.x_offset as usize) * 4;
            canvas[start..start + line].copy_from_slice(pixels);
        }
        assert!(canvas == expected(number), "frame {number} of the APNG");
    }
}

#[test]
fn gif_has_one_bit_of_alpha() {
    let file = movie(AnimationFormat::Gif);
    let mut options = gif::DecodeOptions::new();
    options.set_color_output(gif::ColorOutput::RGBA);
    let mut reader = options.read_info(Cursor::new(&file)).unwrap();
    for number in 0..3 {
        let frame_read = reader.read_next_frame().unwrap().unwrap();
        assert_eq!(frame_read.dispose, gif::DisposalMethod::Background);
        assert_eq!([u32::from(frame_read.width), u32::from(frame_read.height)], SIZE);
        let (_, alpha) = frame(number);
        let mut both = [0; 2];
        for ([r, g, b, a], alpha) in frame_read.buffer.as_chunks::<4>().0.iter().zip(&alpha) {
            assert_eq!(*a, if *alpha >= 0.5 { 255 } else { 0 }, "alpha {alpha}");
            both[usize::from(*a > 0)] += 1;
            assert!(*a == 0 || [*r, *g, *b] == [243, 124, 63], "{r} {g} {b}");
        }
        assert!(both[0] > 0 && both[1] > 0);
    }
    // A frame without an opaque pixel.
    let folder = tempfile::tempdir().unwrap();
    let header = AnimationHeader { transparent: true, ..AnimationHeader::new(2, 1, 1, 10.0) };
    let mut empty = create_animation(&folder.path().join("a.gif"), AnimationFormat::Gif, &header).unwrap();
    empty.write_frame(PixelRows { colors: &[Rgb::BLACK; 2], alpha: Some(&[0.0; 2]) }).unwrap();
    empty.finish().unwrap();
}
