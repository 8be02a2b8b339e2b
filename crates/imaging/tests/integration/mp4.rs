//! Structure of MP4 files, box by box; `tests/movies/test.sh` decodes them with ffmpeg and a
//! browser.
#![cfg(feature = "av1")]
#[allow(dead_code, reason = "each test file is a crate of its own and uses some of these")]
use crate::common::Shared;
use juggler_imaging::{AnimationFormat, AnimationHeader, Destination, animation_writer};
use juggler_math::Rgb;

fn header(width: u32, height: u32, frames: u32, frames_per_second: f64) -> AnimationHeader {
    AnimationHeader { quality: 50, ..AnimationHeader::new(width, height, frames, frames_per_second) }
}

/// A moving gradient.
fn frame(header: &AnimationHeader, number: u32) -> Vec<Rgb> {
    let pixels = (0..header.height).flat_map(|y| (0..header.width).map(move |x| (x + 2 * number, y)));
    pixels.map(|(x, y)| Rgb::new((x % 29) as f32 / 29.0, 0.3, y as f32 / 40.0)).collect()
}

fn film(header: &AnimationHeader) -> Vec<u8> {
    let file = Shared::default();
    let destination = Destination::seekable("memory", file.clone());
    let mut writer = animation_writer(AnimationFormat::Mp4, destination, header).unwrap();
    (0..header.frames).for_each(|number| writer.write_frame((&frame(header, number)).into()).unwrap());
    writer.finish().unwrap();
    file.bytes()
}

/// Types and contents of consecutive boxes.
fn boxes(mut bytes: &[u8]) -> Vec<(String, &[u8])> {
    let mut found = Vec::new();
    while !bytes.is_empty() {
        let (head, length) = match u32::from_be_bytes(bytes[..4].try_into().unwrap()) {
            1 => (16, u64::from_be_bytes(bytes[8..16].try_into().unwrap()) as usize),
            length => (8, length as usize),
        };
        found.push((String::from_utf8_lossy(&bytes[4..8]).into_owned(), &bytes[head..length]));
        bytes = &bytes[length..];
    }
    found
}

/// Content of a nested box.
fn within<'b>(bytes: &'b [u8], path: &str) -> &'b [u8] {
    path.split('/').fold(bytes, |bytes, kind| boxes(bytes).into_iter().find(|(found, _)| found == kind).unwrap().1)
}

/// 32-bit numbers of a full box.
fn words(bytes: &[u8]) -> Vec<u32> {
    bytes[4..].chunks_exact(4).map(|word| u32::from_be_bytes(word.try_into().unwrap())).collect()
}

const TABLE: &str = "moov/trak/mdia/minf/stbl";

#[test]
fn mp4_header_describes_the_stream() {
    let header = header(48, 32, 7, 3.0);
    let file = film(&header);
    let kinds: Vec<String> = boxes(&file).into_iter().map(|(kind, _)| kind).collect();
    assert_eq!(kinds, ["ftyp", "moov", "free", "mdat"], "what players need first comes first");
    let times = words(within(&file, "moov/trak/mdia/mdhd"));
    let (per_second, total) = (times[2], times[3]);
    assert_eq!(f64::from(total) / f64::from(per_second), 7.0 / 3.0);
    assert_eq!(words(within(&file, "moov/mvhd"))[2..4], [per_second, total]);
    let table = |kind: &str| words(within(&file, &format!("{TABLE}/{kind}")));
    assert_eq!(table("stts"), [1, 7, per_second / 3]);
    // Six frames, two seconds, from one key frame to the next.
    assert_eq!(table("stss"), [2, 1, 7]);
    assert_eq!(table("stsc"), [1, 1, 7, 1]);
    let sizes = table("stsz");
    assert_eq!(sizes[..2], [0, 7]);
    let start = table("stco")[1] as usize;
    assert_eq!(sizes[2..].iter().sum::<u32>() as usize, file.len() - start);
    assert_eq!(start, file.len() - within(&file, "mdat").len());
}

#[test]
fn every_sample_is_one_frame_of_the_stream() {
    let file = film(&header(48, 32, 4, 1.0));
    let entry = &within(&file, &format!("{TABLE}/stsd"))[8..];
    let content = boxes(entry).into_iter().find(|(kind, _)| kind == "av01").unwrap().1;
    assert_eq!((&content[24..26], &content[26..28]), (&[0, 48][..], &[0, 32][..]));
    let [configuration, colors] = ["av1C", "colr"].map(|kind| within(&content[78..], kind));
    assert_eq!(colors, b"nclx\0\x01\0\x0d\0\x01\0");
    // Marker and version, profile and level, 4:2:0 with the left column; then the sequence header.
    assert_eq!(configuration[..4], [0x81, 0, 0b1101, 0]);
    assert_eq!(configuration[4] >> 3, 1, "a sequence header");
    let sizes = words(within(&file, &format!("{TABLE}/stsz")))[2..].to_vec();
    let mut samples = within(&file, "mdat");
    for (number, size) in sizes.into_iter().enumerate() {
        let (sample, rest) = samples.split_at(size as usize);
        let first = sample[0] >> 3 & 15;
        // Frames at 0 and 2 seconds begin with a sequence header; none begins with a temporal
        // delimiter.
        assert_eq!(first == 1, number % 2 == 0, "{number}: unit {first}");
        assert_ne!(first, 2, "no delimiters");
        samples = rest;
    }
}

#[test]
fn mp4_bytes_do_not_depend_on_threads() {
    let header = header(64, 48, 6, 24.0);
    let [one, four] = [1, 4].map(|_| {
        let header = header.clone();
        std::thread::spawn(move || film(&header)).join().unwrap()
    });
    assert!(one == film(&header) && one == four);
    let better = film(&AnimationHeader { quality: 95, ..header });
    assert!(better.len() > one.len(), "{} and {}", better.len(), one.len());
}

#[test]
fn mp4_keeps_odd_sizes_and_fractional_frame_rates() {
    let file = film(&header(17, 19, 3, 30_000.0 / 1001.0));
    let head = within(&file, "moov/trak/tkhd");
    assert_eq!(head[head.len() - 8..], [0, 17, 0, 0, 0, 19, 0, 0]);
    let times = words(within(&file, "moov/trak/mdia/mdhd"));
    assert_eq!(times[2..4], [30_000, 3003]);
}

#[test]
fn one_frame_is_a_movie_too() {
    let file = film(&header(16, 16, 1, 25.0));
    assert_eq!(words(within(&file, &format!("{TABLE}/stss"))), [1, 1]);
}
