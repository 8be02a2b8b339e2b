//! The boxes of ISO base media (ISO/IEC 14496-12) that a film with one track of pictures has.

use super::track::Facts;

/// What is known of the frames once they are written.
pub(super) struct Frames<'f> {
    /// Bytes of each.
    pub sizes: &'f [u32],
    /// Numbers, from 1, of those that need no other.
    pub keys: &'f [u32],
    /// Where the first begins; the others follow.
    pub start: u32,
    /// The head of the AV1 stream.
    pub sequence: &'f [u8],
}

/// The transformation that changes nothing.
const UNITY: [u32; 9] = [0x1_0000, 0, 0, 0, 0x1_0000, 0, 0, 0, 0x4000_0000];
/// Three letters, "und", for no language.
const NO_LANGUAGE: u16 = 0x55c4;
/// 72 dots an inch, in 16.16 bits.
const DOTS: u32 = 72 << 16;

/// A box of its parts.
fn boxed(kind: &[u8; 4], parts: &[&[u8]]) -> Vec<u8> {
    let length = parts.iter().map(|part| part.len()).sum::<usize>() + 8;
    let mut bytes = (length as u32).to_be_bytes().to_vec();
    bytes.extend(kind);
    parts.iter().for_each(|part| bytes.extend(*part));
    bytes
}

/// A box with a version and flags before its parts.
fn full(kind: &[u8; 4], version: u8, flags: u32, parts: &[&[u8]]) -> Vec<u8> {
    let [_, a, b, c] = flags.to_be_bytes();
    let content = parts.concat();
    boxed(kind, &[&[version, a, b, c], &content])
}

fn words(words: &[u32]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_be_bytes()).collect()
}

/// How long it all takes, in ticks; the version of boxes in which that has room, and it as they have it.
fn total(facts: &Facts) -> (u8, Vec<u8>) {
    let total = u64::from(facts.frames) * u64::from(facts.ticks);
    match u32::try_from(total) {
        Ok(short) => (0, short.to_be_bytes().to_vec()),
        Err(_) => (1, total.to_be_bytes().to_vec()),
    }
}

/// The times of making and changing a file: none, so that equal films are equal files.
fn no_times(version: u8) -> Vec<u8> {
    vec![0; if version == 0 { 8 } else { 16 }]
}

/// `ftyp`: which readers know it.
pub(super) fn file_type() -> Vec<u8> {
    boxed(b"ftyp", &[b"isom", &512_u32.to_be_bytes(), b"isomav01iso2mp41"])
}

/// `moov`: all but the pictures.
pub(super) fn movie(facts: &Facts, frames: &Frames) -> Vec<u8> {
    let (version, total) = total(facts);
    // Played at its pace, as loud as it is.
    let rest = [words(&[0x1_0000, 0x0100_0000, 0, 0]), words(&UNITY), vec![0; 24], words(&[2])].concat();
    let scale = facts.per_second.to_be_bytes();
    let head = full(b"mvhd", version, 0, &[&no_times(version), &scale, &total, &rest]);
    boxed(b"moov", &[&head, &track(facts, frames)])
}

fn track(facts: &Facts, frames: &Frames) -> Vec<u8> {
    let (version, total) = total(facts);
    let size = facts.size.map(|side| side << 16);
    let after = [vec![0; 16], words(&UNITY), words(&size)].concat();
    // Enabled, and part of the film.
    let head = full(b"tkhd", version, 3, &[&no_times(version), &words(&[1, 0]), &total, &after]);
    let language = [NO_LANGUAGE.to_be_bytes(), [0; 2]].concat();
    let times = [no_times(version), facts.per_second.to_be_bytes().to_vec(), total, language].concat();
    let media = full(b"mdhd", version, 0, &[&times]);
    let handler = full(b"hdlr", 0, 0, &[&[0; 4], b"vide", &[0; 12], b"pictures\0"]);
    let video = full(b"vmhd", 0, 1, &[&[0; 8]]);
    let here = full(b"url ", 0, 1, &[]);
    let data = boxed(b"dinf", &[&full(b"dref", 0, 0, &[&words(&[1]), &here])]);
    let information = boxed(b"minf", &[&video, &data, &table(facts, frames)]);
    boxed(b"trak", &[&head, &boxed(b"mdia", &[&media, &handler, &information])])
}

/// `stbl`: how the pictures are coded, how long each is shown, where its bytes are. All are in one chunk.
fn table(facts: &Facts, frames: &Frames) -> Vec<u8> {
    let count = frames.sizes.len() as u32;
    let list = |numbers: &[u32]| [words(&[numbers.len() as u32]), words(numbers)].concat();
    boxed(
        b"stbl",
        &[
            &full(b"stsd", 0, 0, &[&words(&[1]), &pictures(facts, frames.sequence)]),
            &full(b"stts", 0, 0, &[&words(&[1, count, facts.ticks])]),
            &full(b"stss", 0, 0, &[&list(frames.keys)]),
            &full(b"stsc", 0, 0, &[&words(&[1, 1, count, 1])]),
            &full(b"stsz", 0, 0, &[&words(&[0]), &list(frames.sizes)]),
            &full(b"stco", 0, 0, &[&words(&[1, frames.start])]),
        ],
    )
}

/// `av01`: size, AV1's own head, colours.
fn pictures(facts: &Facts, sequence: &[u8]) -> Vec<u8> {
    let [width, height] = facts.size.map(|side| (side as u16).to_be_bytes());
    // Main profile, 8 bits, colours of half the size level with the left column.
    let head = [0x81, facts.level, 0b0000_1101, 0];
    let configuration = boxed(b"av1C", &[&head, sequence]);
    // Primaries of BT.709, levels of sRGB, differences of BT.709, limited range.
    let colors = boxed(b"colr", &[b"nclx", &[0, 1, 0, 13, 0, 1, 0]]);
    let dots = words(&[DOTS, DOTS, 0]);
    // One frame a sample, no name, 24 bits, no table of colours.
    let rest = [&[0, 1][..], &[0; 32], &[0, 24, 0xff, 0xff]].concat();
    let reference = [0, 0, 0, 0, 0, 0, 0, 1];
    boxed(b"av01", &[&reference, &[0; 16], &width, &height, &dots, &rest, &configuration, &colors])
}
