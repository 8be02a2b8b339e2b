//! Boxes of the ISO base media file format (ISO/IEC 14496-12) for a movie with one video track.

use super::track::TrackInfo;

/// Sizes and positions of the encoded frames.
pub(super) struct FrameTable<'f> {
    /// Length of each frame in bytes.
    pub sizes: &'f [u32],
    /// Numbers of the key frames, counted from 1.
    pub keys: &'f [u32],
    /// File offset of the first frame; frames are contiguous.
    pub start: u32,
    /// AV1 sequence header.
    pub sequence: &'f [u8],
}

/// Identity transformation matrix.
const UNITY: [u32; 9] = [0x1_0000, 0, 0, 0, 0x1_0000, 0, 0, 0, 0x4000_0000];
/// Language code "und" (undetermined).
const NO_LANGUAGE: u16 = 0x55c4;
/// 72 pixels per inch, as a 16.16 fixed-point number.
const PIXELS_PER_INCH: u32 = 72 << 16;

/// Encodes a box with its size and type.
fn encode_box(kind: &[u8; 4], parts: &[&[u8]]) -> Vec<u8> {
    let length = parts.iter().map(|part| part.len()).sum::<usize>() + 8;
    let mut bytes = (length as u32).to_be_bytes().to_vec();
    bytes.extend(kind);
    parts.iter().for_each(|part| bytes.extend(*part));
    bytes
}

/// Encodes a full box, which has a version and flags.
fn encode_full_box(kind: &[u8; 4], version: u8, flags: u32, parts: &[&[u8]]) -> Vec<u8> {
    let [_, a, b, c] = flags.to_be_bytes();
    let content = parts.concat();
    encode_box(kind, &[&[version, a, b, c], &content])
}

fn words(words: &[u32]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_be_bytes()).collect()
}

/// Total duration in ticks, and the box version that stores it: 0 for 32 bits, 1 for 64 bits.
fn duration(info: &TrackInfo) -> (u8, Vec<u8>) {
    let duration = u64::from(info.frames) * u64::from(info.ticks);
    match u32::try_from(duration) {
        Ok(short) => (0, short.to_be_bytes().to_vec()),
        Err(_) => (1, duration.to_be_bytes().to_vec()),
    }
}

/// Creation and modification times: zero, so that equal movies are equal files.
fn zero_times(version: u8) -> Vec<u8> {
    vec![0; if version == 0 { 8 } else { 16 }]
}

/// `ftyp`: file type and compatible brands.
pub(super) fn file_type() -> Vec<u8> {
    encode_box(b"ftyp", &[b"isom", &512_u32.to_be_bytes(), b"isomav01iso2mp41"])
}

/// `moov`: all metadata of the movie.
pub(super) fn movie(info: &TrackInfo, frames: &FrameTable) -> Vec<u8> {
    let (version, duration) = duration(info);
    // Rate 1, volume 1, reserved bytes, matrix, next track number 2.
    let rest = [words(&[0x1_0000, 0x0100_0000, 0, 0]), words(&UNITY), vec![0; 24], words(&[2])].concat();
    let scale = info.per_second.to_be_bytes();
    let header = encode_full_box(b"mvhd", version, 0, &[&zero_times(version), &scale, &duration, &rest]);
    encode_box(b"moov", &[&header, &track(info, frames)])
}

fn track(info: &TrackInfo, frames: &FrameTable) -> Vec<u8> {
    let (version, duration) = duration(info);
    let size = info.size.map(|side| side << 16);
    let after = [vec![0; 16], words(&UNITY), words(&size)].concat();
    // Flags: track enabled, used in the movie.
    let header = encode_full_box(b"tkhd", version, 3, &[&zero_times(version), &words(&[1, 0]), &duration, &after]);
    let language = [NO_LANGUAGE.to_be_bytes(), [0; 2]].concat();
    let times = [zero_times(version), info.per_second.to_be_bytes().to_vec(), duration, language].concat();
    let media = encode_full_box(b"mdhd", version, 0, &[&times]);
    let handler = encode_full_box(b"hdlr", 0, 0, &[&[0; 4], b"vide", &[0; 12], b"pictures\0"]);
    let video = encode_full_box(b"vmhd", 0, 1, &[&[0; 8]]);
    let here = encode_full_box(b"url ", 0, 1, &[]);
    let data = encode_box(b"dinf", &[&encode_full_box(b"dref", 0, 0, &[&words(&[1]), &here])]);
    let information = encode_box(b"minf", &[&video, &data, &sample_table(info, frames)]);
    encode_box(b"trak", &[&header, &encode_box(b"mdia", &[&media, &handler, &information])])
}

/// `stbl`: sample descriptions, durations, key frames and positions. All frames form one chunk.
fn sample_table(info: &TrackInfo, frames: &FrameTable) -> Vec<u8> {
    let count = frames.sizes.len() as u32;
    let list = |numbers: &[u32]| [words(&[numbers.len() as u32]), words(numbers)].concat();
    encode_box(
        b"stbl",
        &[
            &encode_full_box(b"stsd", 0, 0, &[&words(&[1]), &sample_entry(info, frames.sequence)]),
            &encode_full_box(b"stts", 0, 0, &[&words(&[1, count, info.ticks])]),
            &encode_full_box(b"stss", 0, 0, &[&list(frames.keys)]),
            &encode_full_box(b"stsc", 0, 0, &[&words(&[1, 1, count, 1])]),
            &encode_full_box(b"stsz", 0, 0, &[&words(&[0]), &list(frames.sizes)]),
            &encode_full_box(b"stco", 0, 0, &[&words(&[1, frames.start])]),
        ],
    )
}

/// `av01`: frame size, codec configuration, color information.
fn sample_entry(info: &TrackInfo, sequence: &[u8]) -> Vec<u8> {
    let [width, height] = info.size.map(|side| (side as u16).to_be_bytes());
    // Main profile, 8 bits, 4:2:0 with chroma samples co-sited with the left luma column.
    let header = [0x81, info.level, 0b0000_1101, 0];
    let configuration = encode_box(b"av1C", &[&header, sequence]);
    // BT.709 primaries, sRGB transfer function, BT.709 matrix, limited range.
    let colors = encode_box(b"colr", &[b"nclx", &[0, 1, 0, 13, 0, 1, 0]]);
    let resolution = words(&[PIXELS_PER_INCH, PIXELS_PER_INCH, 0]);
    // One frame per sample, no compressor name, depth 24, no color table.
    let rest = [&[0, 1][..], &[0; 32], &[0, 24, 0xff, 0xff]].concat();
    let reference = [0, 0, 0, 0, 0, 0, 0, 1];
    encode_box(b"av01", &[&reference, &[0; 16], &width, &height, &resolution, &rest, &configuration, &colors])
}
