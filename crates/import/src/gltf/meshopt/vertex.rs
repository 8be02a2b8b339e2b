//! Codec of attributes (mode `ATTRIBUTES`), versions 0 and 1: differences of consecutive elements,
//! stored as one plane per byte of an element.
//!
//! A stream has a header byte (0xa0 or 0xa1), blocks of up to 256 elements, and a tail: the element
//! before the first one and, in version 1, one mode per channel of four bytes. Each plane of a
//! block stores its bytes in groups of 16 with 0, 1, 2, 4 or 8 bits per byte. A byte whose bits are
//! all ones is a sentinel for a whole byte that follows its group.

use super::MeshoptError;
use super::reader::{Reader, WINDOW};

/// Number of bytes of an element that share one mode of differences.
const CHANNEL: usize = 4;
/// Number of bytes in a group.
const GROUP: usize = 16;
/// Maximum number of elements of a block.
const MAX_BLOCK: usize = 256;

/// The bytes of one channel of a block, one plane per byte.
type Planes = [[u8; MAX_BLOCK]; CHANNEL];

/// Differences that a channel stores.
#[derive(Clone, Copy)]
enum Differences {
    /// Four differences of bytes, in zigzag encoding.
    Bytes,
    /// Two differences of 16-bit integers, in zigzag encoding.
    Words,
    /// The exclusive or of 32-bit integers, rotated left by this number of bits.
    Xor(u32),
}

/// How a plane of a block is stored.
#[derive(Clone, Copy)]
enum Storage {
    /// Groups of 16 bytes; a group's header of two bits selects one of these numbers of bits.
    Groups([u32; 4]),
    /// Nothing is stored: all bytes are zero.
    Zero,
    /// The bytes themselves.
    Bytes,
}

/// A channel between two blocks.
struct Channel {
    differences: Differences,
    /// The channel's bytes in the last element.
    last: u32,
}

/// Decodes a stream to elements of `stride` bytes, a multiple of 4, into `output`, whose length is
/// a multiple of `stride`.
///
/// # Errors
///
/// The header or a channel mode is unknown, or the content has another length than the elements
/// need.
pub(super) fn decode(output: &mut [u8], stride: usize, stream: &[u8]) -> Result<(), MeshoptError> {
    let is_version_1 = stream.first() == Some(&0xa1);
    let modes = if is_version_1 { stride / CHANNEL } else { 0 };
    let tail = (stride + modes).max(if is_version_1 { 24 } else { 32 });
    let mut reader = Reader::new(stream, &[0xa0, 0xa1], tail)?;
    let mut channels = channels(reader.tail(), stride, modes)?;
    // A block has a multiple of 16 elements, and at most 8 KiB.
    let elements = ((8192 / stride.max(1)) & !(GROUP - 1)).clamp(GROUP, MAX_BLOCK);
    for block in output.chunks_mut(elements * stride) {
        decode_block(block, stride, &mut channels, is_version_1, &mut reader)?;
    }
    reader.finish()
}

/// Channels before the first block, from a tail whose last bytes are the element before the first
/// one and `modes` bytes of modes.
fn channels(tail: &[u8], stride: usize, modes: usize) -> Result<Vec<Channel>, MeshoptError> {
    let (tail, modes) = tail.split_at(tail.len().saturating_sub(modes));
    let baseline = tail.get(tail.len().saturating_sub(stride)..).unwrap_or_default();
    let channels = baseline.as_chunks::<CHANNEL>().0.iter().enumerate().map(|(index, bytes)| {
        let mode = modes.get(index).copied().unwrap_or(0);
        let differences = match (mode & 15, mode >> 4) {
            (0, 0) => Differences::Bytes,
            (1, 0) => Differences::Words,
            (2, rotation) => Differences::Xor(u32::from(rotation)),
            _ => return Err(MeshoptError::ChannelMode { channel: index, mode }),
        };
        Ok(Channel { differences, last: u32::from_le_bytes(*bytes) })
    });
    channels.collect()
}

/// Decodes one block of elements.
fn decode_block(
    block: &mut [u8],
    stride: usize,
    channels: &mut [Channel],
    is_version_1: bool,
    reader: &mut Reader<'_>,
) -> Result<(), MeshoptError> {
    let elements = block.len() / stride.max(1);
    let controls = if is_version_1 { reader.bytes(channels.len())? } else { &[] };
    let mut planes = [[0; MAX_BLOCK]; CHANNEL];
    for (index, channel) in channels.iter_mut().enumerate() {
        let control = controls.get(index).copied();
        for (plane, shift) in planes.iter_mut().zip([0, 2, 4, 6]) {
            let storage = match control.map(|control| (control >> shift) & 3) {
                None => Storage::Groups([0, 2, 4, 8]),
                Some(0) => Storage::Groups([0, 1, 2, 4]),
                Some(1) => Storage::Groups([1, 2, 4, 8]),
                Some(2) => Storage::Zero,
                Some(_) => Storage::Bytes,
            };
            read_plane(plane, elements, storage, reader)?;
        }
        let targets = block.chunks_exact_mut(stride).filter_map(|element| {
            let bytes = element.get_mut(CHANNEL * index..)?;
            bytes.first_chunk_mut()
        });
        channel.accumulate(&planes, targets);
    }
    Ok(())
}

impl Channel {
    /// Adds the differences in `planes` one after another and writes each sum to the next target.
    fn accumulate<'a>(&mut self, planes: &Planes, targets: impl Iterator<Item = &'a mut [u8; CHANNEL]>) {
        let last = &mut self.last;
        match self.differences {
            Differences::Bytes => write_sums(planes, targets, last, add_bytes),
            Differences::Words => write_sums(planes, targets, last, add_words),
            Differences::Xor(rotation) => {
                write_sums(planes, targets, last, |last, difference| last ^ difference.rotate_right(rotation));
            }
        }
    }
}

fn write_sums<'a>(
    planes: &Planes,
    targets: impl Iterator<Item = &'a mut [u8; CHANNEL]>,
    last: &mut u32,
    add: impl Fn(u32, u32) -> u32,
) {
    let [first, second, third, fourth] = planes;
    let differences = first.iter().zip(second).zip(third).zip(fourth);
    for (target, (((a, b), c), d)) in targets.zip(differences) {
        *last = add(*last, u32::from_le_bytes([*a, *b, *c, *d]));
        *target = last.to_le_bytes();
    }
}

/// Adds four differences in zigzag encoding to four bytes, without carries between them.
fn add_bytes(values: u32, codes: u32) -> u32 {
    let differences = ((codes >> 1) & 0x7f7f_7f7f) ^ (codes & 0x0101_0101).wrapping_mul(0xff);
    let low = (values & 0x7f7f_7f7f).wrapping_add(differences & 0x7f7f_7f7f);
    low ^ ((values ^ differences) & 0x8080_8080)
}

/// Adds two differences in zigzag encoding to two 16-bit integers, without a carry between them.
fn add_words(values: u32, codes: u32) -> u32 {
    let differences = ((codes >> 1) & 0x7fff_7fff) ^ (codes & 0x0001_0001).wrapping_mul(0xffff);
    let low = (values & 0x7fff_7fff).wrapping_add(differences & 0x7fff_7fff);
    low ^ ((values ^ differences) & 0x8000_8000)
}

/// Reads the first `elements` bytes of a plane; the bytes after them are undefined.
fn read_plane(
    plane: &mut [u8; MAX_BLOCK],
    elements: usize,
    storage: Storage,
    reader: &mut Reader<'_>,
) -> Result<(), MeshoptError> {
    match storage {
        Storage::Zero => plane.fill(0),
        Storage::Bytes => plane.iter_mut().zip(reader.bytes(elements)?).for_each(|(byte, new)| *byte = *new),
        Storage::Groups(lengths) => {
            let groups = elements.div_ceil(GROUP);
            let headers = reader.bytes(groups.div_ceil(4))?.iter().flat_map(|byte| [0, 2, 4, 6].map(|at| byte >> at));
            for (group, header) in plane.as_chunks_mut().0.iter_mut().take(groups).zip(headers) {
                let [first, second, third, fourth] = lengths;
                let bits = match header & 3 {
                    0 => first,
                    1 => second,
                    2 => third,
                    _ => fourth,
                };
                read_group(group, bits, reader)?;
            }
        }
    }
    Ok(())
}

/// Reads a group that stores each byte in this number of bits.
fn read_group(group: &mut [u8; GROUP], bits: u32, reader: &mut Reader<'_>) -> Result<(), MeshoptError> {
    let size = match bits {
        0 => {
            *group = [0; GROUP];
            0
        }
        1 => one_bit(group, reader.window()?),
        2 => two_bits(group, reader.window()?),
        4 => four_bits(group, reader.window()?),
        _ => {
            group.copy_from_slice(reader.bytes(GROUP)?);
            0
        }
    };
    reader.skip(size)
}

/// Unpacks bytes of one bit, the lowest bit first. Returns the size of the group in bytes.
fn one_bit(group: &mut [u8; GROUP], window: &[u8; WINDOW]) -> usize {
    let [first, second, literals @ ..] = window;
    let bits = u16::from_le_bytes([*first, *second]);
    for (index, byte) in group.iter_mut().enumerate() {
        *byte = ((bits >> index) & 1) as u8;
    }
    2 + place_literals(group, u64::from(bits.reverse_bits()) << 48, 1, literals)
}

/// Unpacks bytes of two bits, the highest bits first. Returns the size of the group in bytes.
fn two_bits(group: &mut [u8; GROUP], window: &[u8; WINDOW]) -> usize {
    let [first, second, third, fourth, literals @ ..] = window;
    let bits = u32::from_be_bytes([*first, *second, *third, *fourth]);
    for (index, byte) in group.iter_mut().enumerate() {
        *byte = ((bits >> (30 - 2 * index)) & 3) as u8;
    }
    let sentinels = bits & (bits >> 1) & 0x5555_5555;
    4 + place_literals(group, u64::from(sentinels) << 32, 2, literals)
}

/// Unpacks bytes of four bits, the highest bits first. Returns the size of the group in bytes.
fn four_bits(group: &mut [u8; GROUP], window: &[u8; WINDOW]) -> usize {
    let (packed, literals) = window.split_at(8);
    let bits = packed.iter().fold(0, |bits, byte| (bits << 8) | u64::from(*byte));
    for (index, byte) in group.iter_mut().enumerate() {
        *byte = ((bits >> (60 - 4 * index)) & 15) as u8;
    }
    let pairs = bits & (bits >> 1);
    8 + place_literals(group, pairs & (pairs >> 2) & 0x1111_1111_1111_1111, 4, literals)
}

/// Replaces sentinels by the literals that follow the packed bits, and returns their number.
/// `sentinels` has `length` bits per byte of the group, the first byte in the highest bits; the
/// lowest of them marks a sentinel.
fn place_literals(group: &mut [u8; GROUP], sentinels: u64, length: u32, literals: &[u8]) -> usize {
    let mut rest = sentinels;
    for literal in literals {
        if rest == 0 {
            break;
        }
        let zeros = rest.leading_zeros();
        if let Some(byte) = group.get_mut((zeros / length) as usize) {
            *byte = *literal;
        }
        rest &= !((1 << 63) >> zeros);
    }
    sentinels.count_ones() as usize
}
