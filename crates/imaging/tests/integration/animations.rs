//! Movie files read by other decoders: frames, times, colors.

#[allow(dead_code, reason = "each test file is a crate of its own and uses some of these")]
use crate::common::Shared;
use juggler_imaging::tone::Quantizer;
use juggler_imaging::{AnimationFormat, AnimationHeader, Destination, animation_writer, create_animation};
use juggler_math::Rgb;
use std::io::{self, Cursor};
use std::path::Path;

const SIZE: [u32; 2] = [48, 32];

fn header(frames: u32, frames_per_second: f64, plays: u16) -> AnimationHeader {
    AnimationHeader { plays, quality: 90, ..AnimationHeader::new(SIZE[0], SIZE[1], frames, frames_per_second) }
}

/// A smooth sky with a moving square.
fn frame(number: u32) -> Vec<Rgb> {
    let pixel = |i: u32| {
        let (x, y) = (i % SIZE[0], i / SIZE[0]);
        let inside = (4 + number * 3..12 + number * 3).contains(&x) && (10..18).contains(&y);
        if inside { Rgb::new(0.9, 0.1, 0.05) } else { Rgb::new(0.1, x as f32 / 60.0, 0.2 + y as f32 / 50.0) }
    };
    (0..SIZE[0] * SIZE[1]).map(pixel).collect()
}

fn write(format: AnimationFormat, header: &AnimationHeader) -> Vec<u8> {
    let file = Shared::default();
    let mut writer = animation_writer(format, Destination::seekable("memory", file.clone()), header).unwrap();
    (0..header.frames).for_each(|number| writer.write_frame((&frame(number)).into()).unwrap());
    writer.finish().unwrap();
    file.bytes()
}

/// 8-bit levels of a frame, as in a PNG.
fn levels(number: u32) -> Vec<u8> {
    let mut bytes = Vec::new();
    Quantizer::new(&header(1, 1.0, 0).tone, 255).append_bytes(&frame(number), &mut bytes);
    bytes
}

/// Copies a rectangle of pixels onto the canvas.
fn lay(canvas: &mut [u8], [x, y, width]: [u32; 3], part: &[u8]) {
    for (row, line) in part.chunks_exact(width as usize * 3).enumerate() {
        let start = ((y as usize + row) * SIZE[0] as usize + x as usize) * 3;
        canvas[start..start + line.len()].copy_from_slice(line);
    }
}

#[test]
fn apng_keeps_every_level_and_the_pace() {
    let file = write(AnimationFormat::Apng, &header(5, 24.0, 3));
    let mut reader = png::Decoder::new(Cursor::new(&file)).read_info().unwrap();
    let control = *reader.info().animation_control().unwrap();
    assert_eq!((control.num_frames, control.num_plays), (5, 3));
    let mut canvas = vec![0; levels(0).len()];
    for number in 0..5 {
        let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
        let output = reader.next_frame(&mut bytes).unwrap();
        let frame = *reader.info().frame_control().unwrap();
        assert_eq!((frame.delay_num, frame.delay_den), (1, 24));
        assert!(number == 0 || frame.width < 12, "only what changes: {frame:?}");
        lay(&mut canvas, [frame.x_offset, frame.y_offset, frame.width], &bytes[..output.buffer_size()]);
        assert!(canvas == levels(number), "frame {number}");
    }
}

#[test]
fn webp_keeps_every_level_and_the_pace() {
    let file = write(AnimationFormat::Webp, &header(5, 24.0, 3));
    let mut decoder = image_webp::WebPDecoder::new(Cursor::new(&file)).unwrap();
    let size: [u32; 2] = decoder.dimensions().into();
    assert_eq!((size, decoder.num_frames(), decoder.is_animated()), (SIZE, 5, true));
    let image_webp::LoopCount::Times(plays) = decoder.loop_count() else { panic!("for ever") };
    assert_eq!(plays.get(), 3);
    assert_eq!(decoder.loop_duration(), 208, "five times 1/24 s");
    let mut canvas = vec![0; decoder.output_buffer_size().unwrap()];
    for number in 0..5 {
        let delay = decoder.read_frame(&mut canvas).unwrap();
        assert_eq!(delay, if number % 3 == 1 { 41 } else { 42 }, "frame {number}");
        let pixels = canvas.chunks_exact(canvas.len() / (SIZE[0] * SIZE[1]) as usize);
        assert!(pixels.flat_map(|pixel| &pixel[..3]).eq(&levels(number)), "frame {number}");
    }
    let forever = write(AnimationFormat::Webp, &header(2, 24.0, 0));
    let decoder = image_webp::WebPDecoder::new(Cursor::new(&forever)).unwrap();
    assert!(matches!(decoder.loop_count(), image_webp::LoopCount::Forever));
}

#[test]
fn gif_is_close_in_color_and_exact_in_length() {
    for (rate, plays, repeat) in [(30.0, 0, gif::Repeat::Infinite), (24.0, 3, gif::Repeat::Finite(2))] {
        let file = write(AnimationFormat::Gif, &header(9, rate, plays));
        let mut options = gif::DecodeOptions::new();
        options.set_color_output(gif::ColorOutput::RGBA);
        let mut reader = options.read_info(Cursor::new(&file)).unwrap();
        assert_eq!([u32::from(reader.width()), u32::from(reader.height())], SIZE);
        let (mut canvas, mut number, mut hundredths) = (vec![0; levels(0).len()], 0, 0.0);
        while let Some(frame) = reader.read_next_frame().unwrap() {
            hundredths += f64::from(frame.delay);
            let bytes: Vec<u8> = frame.buffer.as_chunks::<4>().0.iter().flat_map(|[r, g, b, _]| [*r, *g, *b]).collect();
            lay(&mut canvas, [frame.left.into(), frame.top.into(), frame.width.into()], &bytes);
            let off = canvas.iter().zip(levels(number)).map(|(a, b)| f64::from(a.abs_diff(b))).sum::<f64>();
            assert!(off / (canvas.len() as f64) < 5.0, "frame {number}: off by {}", off / canvas.len() as f64);
            number += 1;
        }
        assert_eq!((number, reader.repeat()), (9, repeat));
        assert!((hundredths - 900.0 / rate).abs() <= 0.5, "{hundredths}");
    }
}

/// The color of a large plain area is exact, also in later frames that have less of it.
#[test]
fn plain_areas_of_a_gif_are_exact() {
    let frame = |shift: u32| -> Vec<Rgb> {
        let pixel = |i: u32| {
            let (x, y) = (i % SIZE[0], i / SIZE[0]);
            let is_plain = x < 10 || (x, y) == (30, 20);
            if is_plain { Rgb::WHITE } else { Rgb::new(x as f32 / 48.0, y as f32 / 32.0, shift as f32 * 0.1) }
        };
        (0..SIZE[0] * SIZE[1]).map(pixel).collect()
    };
    let file = Shared::default();
    let destination = Destination::seekable("m", file.clone());
    let mut writer = animation_writer(AnimationFormat::Gif, destination, &header(2, 10.0, 0)).unwrap();
    (0..2).for_each(|shift| writer.write_frame((&frame(shift)).into()).unwrap());
    writer.finish().unwrap();
    let bytes = file.bytes();
    let mut options = gif::DecodeOptions::new();
    options.set_color_output(gif::ColorOutput::RGBA);
    let mut reader = options.read_info(Cursor::new(&bytes)).unwrap();
    let mut whites = Vec::new();
    while let Some(frame) = reader.read_next_frame().unwrap() {
        let pixels = frame.buffer.as_chunks::<4>().0;
        let at = (20 - usize::from(frame.top)) * usize::from(frame.width) + 30 - usize::from(frame.left);
        whites.push((pixels[at], pixels.iter().filter(|pixel| **pixel == [255; 4]).count()));
    }
    assert_eq!(whites, [([255; 4], 10 * 32 + 1), ([255; 4], 1)]);
}

#[test]
fn few_colors_are_kept_as_they_are() {
    let file = Shared::default();
    let header = AnimationHeader { width: 4, height: 2, ..header(1, 10.0, 0) };
    let mut writer = animation_writer(AnimationFormat::Gif, Destination::seekable("m", file.clone()), &header).unwrap();
    let colors = [0.0, 0.25, 0.5, 1.0].map(|v| Rgb::new(v, 1.0 - v, 0.3));
    writer.write_frame((&[colors, colors].concat()).into()).unwrap();
    writer.finish().unwrap();
    let bytes = file.bytes();
    let mut options = gif::DecodeOptions::new();
    options.set_color_output(gif::ColorOutput::RGBA);
    let mut reader = options.read_info(Cursor::new(&bytes)).unwrap();
    let frame = reader.read_next_frame().unwrap().unwrap();
    let mut expected = Vec::new();
    Quantizer::new(&header.tone, 255).append_bytes(&[colors, colors].concat(), &mut expected);
    let pixels: Vec<u8> = frame.buffer.as_chunks::<4>().0.iter().flat_map(|[r, g, b, _]| [*r, *g, *b]).collect();
    assert_eq!(pixels, expected);
}

#[test]
fn frames_that_do_not_change_take_hardly_any_room() {
    for format in AnimationFormat::ALL.iter().copied() {
        let sizes = [2, 102].map(|frames| {
            let file = Shared::default();
            let destination = Destination::seekable("m", file.clone());
            let mut writer = animation_writer(format, destination, &header(frames, 25.0, 0)).unwrap();
            (0..frames).for_each(|_| writer.write_frame((&frame(0)).into()).unwrap());
            writer.finish().unwrap();
            file.bytes().len()
        });
        assert!(sizes[1] - sizes[0] < 100 * 130, "{format}: {sizes:?}");
    }
}

#[test]
fn unsupported_animations_are_rejected_before_writing() {
    let refuse = |format, header: &AnimationHeader| {
        let file = Shared::default();
        let refused = animation_writer(format, Destination::seekable("x.gif", file.clone()), header).err().unwrap();
        assert!(file.bytes().is_empty());
        refused.to_string()
    };
    let gif = AnimationFormat::Gif;
    assert!(refuse(gif, &AnimationHeader { width: 70_000, ..header(1, 10.0, 0) }).contains("1 to 65535"));
    assert!(refuse(gif, &header(0, 10.0, 0)).contains("no frames"));
    for rate in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e4] {
        assert!(refuse(AnimationFormat::Apng, &header(1, rate, 0)).contains("frames per second"), "{rate}");
    }
    assert!(refuse(gif, &header(1, 50.1, 0)).contains("only 0.01 to 50"));
    assert!(
        refuse(AnimationFormat::Webp, &AnimationHeader { width: 16_384, ..header(1, 10.0, 0) }).contains("1 to 16383")
    );
    assert!(refuse(gif, &header(u32::MAX, 10.0, 0)).contains("more than the limit"));
    #[cfg(feature = "av1")]
    {
        let mp4 = AnimationFormat::Mp4;
        assert!(refuse(mp4, &AnimationHeader { width: 15, ..header(1, 10.0, 0) }).contains("16 to 65535"));
        assert!(refuse(mp4, &AnimationHeader { quality: 0, ..header(1, 10.0, 0) }).contains("1 to 100"));
    }
    let mut writer = animation_writer(gif, Destination::stream("x.gif", io::sink()), &header(2, 10.0, 0)).unwrap();
    assert!(writer.write_frame(frame(0)[1..].into()).is_err(), "part of a frame");
    writer.write_frame((&frame(0)).into()).unwrap();
    assert!(writer.finish().unwrap_err().to_string().contains("1 of its frames"));
    let mut writer = animation_writer(gif, Destination::stream("x.gif", io::sink()), &header(1, 10.0, 0)).unwrap();
    writer.write_frame((&frame(0)).into()).unwrap();
    assert!(writer.write_frame((&frame(0)).into()).is_err(), "one too many");
}

#[test]
fn a_file_is_there_when_it_is_finished() {
    let folder = tempfile::tempdir().unwrap();
    for format in AnimationFormat::ALL.iter().copied() {
        let path = folder.path().join(format!("film.{}", format.extension()));
        assert_eq!(AnimationFormat::from_path(&path), Some(format));
        let mut writer = create_animation(&path, format, &header(1, 10.0, 0)).unwrap();
        writer.write_frame((&frame(0)).into()).unwrap();
        assert!(!path.exists());
        writer.finish().unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), write(format, &header(1, 10.0, 0)));
    }
    assert_eq!(AnimationFormat::from_path(Path::new("a.png")), None);
}
