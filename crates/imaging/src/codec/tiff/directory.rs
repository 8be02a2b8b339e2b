//! Directories of tags in TIFF files and Exif blocks (TIFF 6.0, section 2).

use std::io::{self, Read, Seek, SeekFrom};

const BYTE: u16 = 1;
const SHORT: u16 = 3;
const LONG: u16 = 4;
const RATIONAL: u16 = 5;

/// Directory of tags.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Directory {
    is_little_endian: bool,
    /// Offset of the first entry in the file.
    start: u64,
    /// Entries of 12 bytes: tag, type, number of values, and the values or their offset.
    entries: Vec<[u8; 12]>,
    /// Offset of the next directory; 0 if there is none.
    next: u32,
}

impl Directory {
    /// Reads the first directory; `None` if the bytes do not begin as TIFF files do. BigTIFF files,
    /// whose offsets have 64 bits, are none.
    pub fn first(bytes: &mut (impl Read + Seek + ?Sized)) -> io::Result<Option<Self>> {
        let mut head = [0; 8];
        bytes.rewind()?;
        bytes.read_exact(&mut head)?;
        let [order @ .., a, b, c, d] = head;
        let (is_little_endian, offset) = match &order {
            b"II*\0" => (true, u32::from_le_bytes([a, b, c, d])),
            b"MM\0*" => (false, u32::from_be_bytes([a, b, c, d])),
            _ => return Ok(None),
        };
        Self::at(bytes, is_little_endian, offset).map(Some)
    }

    /// Reads the directory that follows this one in the file; `None` if this one is the last.
    pub fn following(&self, bytes: &mut (impl Read + Seek + ?Sized)) -> io::Result<Option<Self>> {
        if self.next == 0 { Ok(None) } else { Self::at(bytes, self.is_little_endian, self.next).map(Some) }
    }

    /// Reads as many entries as the bytes hold.
    fn at(bytes: &mut (impl Read + Seek + ?Sized), is_little_endian: bool, offset: u32) -> io::Result<Self> {
        let mut directory = Self { is_little_endian, start: u64::from(offset) + 2, entries: Vec::new(), next: 0 };
        let mut count = [0; 2];
        bytes.seek(SeekFrom::Start(u64::from(offset)))?;
        bytes.read_exact(&mut count)?;
        let length = usize::from(directory.short_of(count)) * 12;
        let mut table = Vec::new();
        bytes.take(length as u64 + 4).read_to_end(&mut table)?;
        let entries = table.get(..length).unwrap_or(&table);
        directory.entries = entries.chunks_exact(12).filter_map(|entry| entry.try_into().ok()).collect();
        let next = table.get(length..).and_then(|next| next.try_into().ok());
        directory.next = next.map_or(0, |next| directory.long_of(next));
        Ok(directory)
    }

    fn short_of(&self, bytes: [u8; 2]) -> u16 {
        if self.is_little_endian { u16::from_le_bytes(bytes) } else { u16::from_be_bytes(bytes) }
    }

    fn long_of(&self, bytes: [u8; 4]) -> u32 {
        if self.is_little_endian { u32::from_le_bytes(bytes) } else { u32::from_be_bytes(bytes) }
    }

    /// Last entry of a tag whose type is known, as decoders choose it: its index, type, number of
    /// values, and the bytes of the values or their offset.
    fn entry(&self, tag: u16) -> Option<(usize, u16, u32, [u8; 4])> {
        let parts = |(index, [a, b, c, d, e, f, g, h, value @ ..]): (usize, &[u8; 12])| {
            (index, self.short_of([*a, *b]), self.short_of([*c, *d]), self.long_of([*e, *f, *g, *h]), *value)
        };
        let mut entries = self.entries.iter().enumerate().rev().map(parts);
        let found = entries.find(|(_, found, kind, ..)| *found == tag && matches!(kind, 1..=13 | 16..=18));
        found.map(|(index, _, kind, count, value)| (index, kind, count, value))
    }

    /// Whether there is an entry of this tag.
    pub fn has(&self, tag: u16) -> bool {
        self.entry(tag).is_some()
    }

    /// Number of values of a tag; 0 if it is absent.
    pub fn count(&self, tag: u16) -> u32 {
        self.entry(tag).map_or(0, |(_, _, count, _)| count)
    }

    /// Single natural number of a tag; `None` if the tag is absent or has other values.
    pub fn number(&self, tag: u16) -> Option<u32> {
        let (_, kind, 1, value) = self.entry(tag)? else { return None };
        let [a, b, ..] = value;
        match kind {
            BYTE => Some(u32::from(a)),
            SHORT => Some(u32::from(self.short_of([a, b]))),
            LONG => Some(self.long_of(value)),
            _ => None,
        }
    }

    /// The first `most` 16-bit numbers of a tag; empty if the tag is absent or has values of another
    /// type.
    pub fn shorts(&self, bytes: &mut (impl Read + Seek + ?Sized), tag: u16, most: u32) -> io::Result<Vec<u16>> {
        let Some((_, SHORT, count, value)) = self.entry(tag) else { return Ok(Vec::new()) };
        let values = self.values(bytes, u64::from(count), 2, (value, u64::from(count.min(most))))?;
        Ok(values.chunks_exact(2).filter_map(|two| two.try_into().ok()).map(|two| self.short_of(two)).collect())
    }

    /// The `COUNT` fractions of a tag; `None` if the tag is absent or has other values.
    pub fn fractions<const COUNT: usize>(
        &self,
        bytes: &mut (impl Read + Seek + ?Sized),
        tag: u16,
    ) -> io::Result<Option<[f64; COUNT]>> {
        let Some((_, RATIONAL, count, value)) = self.entry(tag) else { return Ok(None) };
        if count as usize != COUNT {
            return Ok(None);
        }
        let values = self.values(bytes, u64::from(count), 8, (value, u64::from(count)))?;
        let numbers = values.chunks_exact(4).filter_map(|four| four.try_into().ok()).map(|four| self.long_of(four));
        let numbers: Vec<u32> = numbers.collect();
        let fraction = |pair: &[u32]| match *pair {
            [above, below] if below > 0 => f64::from(above) / f64::from(below),
            _ => f64::NAN,
        };
        let fractions: Vec<f64> = numbers.chunks_exact(2).map(fraction).collect();
        Ok(fractions.try_into().ok().filter(|all: &[f64; COUNT]| all.iter().all(|number| number.is_finite())))
    }

    /// The first `wanted` of `count` values of `size` bytes, which stand in the entry if they fit.
    fn values(
        &self,
        bytes: &mut (impl Read + Seek + ?Sized),
        count: u64,
        size: u64,
        (value, wanted): ([u8; 4], u64),
    ) -> io::Result<Vec<u8>> {
        let mut values = Vec::new();
        if count * size <= 4 {
            values.extend(value);
        } else {
            bytes.seek(SeekFrom::Start(u64::from(self.long_of(value))))?;
            bytes.take(wanted * size).read_to_end(&mut values)?;
        }
        values.truncate((wanted * size) as usize);
        Ok(values)
    }

    /// Replaces the first 16-bit number of a tag in `file`, if it stands in the entry.
    pub fn replace(&self, file: &mut [u8], tag: u16, number: u16) {
        let Some((index, SHORT, 1 | 2, _)) = self.entry(tag) else { return };
        let Ok(start) = usize::try_from(self.start + index as u64 * 12 + 8) else { return };
        let new = if self.is_little_endian { number.to_le_bytes() } else { number.to_be_bytes() };
        file.iter_mut().skip(start).zip(new).for_each(|(byte, new)| *byte = new);
    }
}
