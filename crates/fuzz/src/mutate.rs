//! Mutations of a file, seeded by the case number: identical on every machine.

use crate::models;
use juggler_math::testing::Random;

/// Edge cases of numbers in text.
const NUMBERS: [&str; 14] = [
    "-1",
    "0",
    "1",
    "255",
    "65536",
    "2147483648",
    "4294967295",
    "4294967296",
    "18446744073709551616",
    "1e39",
    "1e-46",
    "1e308",
    "nan",
    "-inf",
];

/// Edge cases of 32-bit words.
const WORDS: [u32; 8] = [u32::MAX, 0, 1, 0x7fff_ffff, 0x8000_0000, 0x7f80_0000, 0x00ff_ffff, 0x0001_0000];

/// Applies one to four mutations to a random seed file.
pub fn mutate(seeds: &[Vec<u8>], case: u64) -> Vec<u8> {
    let mut random = Random::new(case);
    let mut bytes = pick(seeds, &mut random);
    for _ in 0..=random.below(4) {
        change(&mut bytes, seeds, &mut random);
    }
    // Repair the checksums and lengths of half of the files, to reach the code behind them.
    if random.below(2) == 0 {
        repair_png(&mut bytes);
        repair_film(&mut bytes);
        models::repair(&mut bytes);
    }
    bytes
}

fn pick(seeds: &[Vec<u8>], random: &mut Random) -> Vec<u8> {
    seeds.get(random.below(seeds.len())).cloned().unwrap_or_default()
}

fn change(bytes: &mut Vec<u8>, seeds: &[Vec<u8>], random: &mut Random) {
    // Prefer the header, where mutations have most effect.
    let reach = if random.below(2) == 0 { bytes.len().min(400) } else { bytes.len() };
    let at = random.below(reach);
    match random.below(9) {
        0 => set(bytes, at, |byte| byte ^ 1 << random.below(8)),
        1 => set(bytes, at, |_| random.bits() as u8),
        2 => {
            let word = WORDS[random.below(WORDS.len())];
            let four = if random.below(2) == 0 { word.to_le_bytes() } else { word.to_be_bytes() };
            bytes.iter_mut().skip(at).zip(four).for_each(|(byte, new)| *byte = new);
        }
        3 => replace_number(bytes, at, NUMBERS[random.below(NUMBERS.len())].as_bytes()),
        4 => bytes.truncate(random.below(bytes.len())),
        5 => drop(bytes.splice(at..at, vec![random.bits() as u8; 1 + random.below(40)])),
        6 => drop(bytes.drain(at..(at + 1 + random.below(40)).min(bytes.len()))),
        7 => {
            let other = pick(seeds, random);
            let from = random.below(other.len());
            let piece = other.get(from..(from + random.below(200)).min(other.len())).unwrap_or_default();
            bytes.splice(at..at, piece.iter().copied());
        }
        _ => {
            let end = (at + 1 + random.below(60)).min(bytes.len());
            let piece = bytes.get(at..end).unwrap_or_default().to_vec();
            bytes.splice(at..at, piece.repeat(1 + random.below(20)));
        }
    }
}

fn set(bytes: &mut [u8], at: usize, new: impl FnOnce(u8) -> u8) {
    if let Some(byte) = bytes.get_mut(at) {
        *byte = new(*byte);
    }
}

/// Replaces the next number in a text.
fn replace_number(bytes: &mut Vec<u8>, from: usize, new: &[u8]) {
    let is_digit = |byte: &u8| byte.is_ascii_digit() || b"+-.eE".contains(byte);
    let Some(start) = bytes.iter().skip(from).position(u8::is_ascii_digit).map(|at| from + at) else { return };
    let length = bytes.iter().skip(start).take_while(|byte| is_digit(byte)).count();
    bytes.splice(start..start + length, new.iter().copied());
}

/// Recomputes the checksums of a PNG's chunks (CRC-32, ISO 3309).
pub fn repair_png(bytes: &mut [u8]) {
    if !bytes.starts_with(b"\x89PNG") {
        return;
    }
    let mut at = 8;
    while let Some(length) = bytes.get(at..at + 4).and_then(|four| four.try_into().ok()).map(u32::from_be_bytes) {
        let end = at.saturating_add(8).saturating_add(length as usize);
        let Some(chunk) = bytes.get(at + 4..end) else { return };
        let crc = !chunk.iter().fold(u32::MAX, |crc, byte| {
            (0..8).fold(crc ^ u32::from(*byte), |crc, _| (crc >> 1) ^ if crc & 1 == 1 { 0xedb8_8320 } else { 0 })
        });
        bytes.iter_mut().skip(end).zip(crc.to_be_bytes()).for_each(|(byte, new)| *byte = new);
        at = end.saturating_add(4);
    }
}

/// Recomputes the lengths and the hashes of a partial render (see `README.md` of the crate
/// `juggler-film`).
pub fn repair_film(bytes: &mut [u8]) {
    const PRELUDE: usize = 32;
    const ENTRY: usize = 44;
    let total = bytes.len();
    if !bytes.starts_with(b"\x89JFILM") || total < 2 * PRELUDE {
        return;
    }
    bytes.iter_mut().skip(16).zip((total as u64).to_le_bytes()).for_each(|(byte, new)| *byte = new);
    let number = |bytes: &[u8], at: usize| {
        let four = bytes.get(at..at + 4).and_then(|four| four.try_into().ok());
        four.map_or(0, u32::from_le_bytes) as usize
    };
    let count = number(bytes, 24);
    let Some(index) = (total - 32).checked_sub(count.saturating_mul(ENTRY)) else { return };
    // The header fills the bytes before the chunks.
    let entries = (0..count).map(|entry| index + entry * ENTRY);
    let chunks = entries.clone().fold(0_usize, |sum, entry| sum.saturating_add(number(bytes, entry + 8)));
    let Some(head) = index.checked_sub(PRELUDE).and_then(|room| room.checked_sub(chunks)) else { return };
    bytes.iter_mut().skip(12).zip((head as u32).to_le_bytes()).for_each(|(byte, new)| *byte = new);
    let mut offset = PRELUDE + head;
    for entry in entries {
        let length = number(bytes, entry + 8);
        let Some(chunk) = bytes.get(offset..offset.saturating_add(length)) else { break };
        let hash = *blake3::hash(chunk).as_bytes();
        bytes.iter_mut().skip(entry + 12).zip(hash).for_each(|(byte, new)| *byte = new);
        offset += length;
    }
    let mut hasher = blake3::Hasher::new();
    for range in [0..(PRELUDE + head).min(total), index..total - 32] {
        hasher.update(bytes.get(range).unwrap_or_default());
    }
    let seal = *hasher.finalize().as_bytes();
    bytes.iter_mut().skip(total - 32).zip(seal).for_each(|(byte, new)| *byte = new);
}
