//! The file: frames one after the other as they come, and before them a table that is written last, into room left for
//! it, so that players can begin before all is there. The table takes eight bytes of memory a frame.

use super::boxes::{self, Frames};
use crate::ImageError;
use crate::output::{Destination, WriteSeek};
use std::io::{self, Read, Seek, SeekFrom, Write};

/// Room for the head of the AV1 stream, which the first frame brings.
const SEQUENCE: usize = 64;
/// Bytes before the frames: a box whose length has 64 bits.
const HEAD: usize = 16;
/// Kinds of units in an AV1 stream (AV1 Bitstream & Decoding Process, 6.2.2).
const SEQUENCE_HEADER: u8 = 1;
const TEMPORAL_DELIMITER: u8 = 2;

/// What the file says of the film.
pub(super) struct Facts {
    /// Width and height.
    pub size: [u32; 2],
    /// How long a frame is shown.
    pub ticks: u32,
    /// Ticks a second.
    pub per_second: u32,
    /// What a decoder must be able to do.
    pub level: u8,
    /// How many there will be.
    pub frames: u32,
    /// Frames from one that needs no other to the next.
    pub between_keys: u32,
}

/// A file on its way.
pub(super) struct Track {
    bytes: Box<dyn WriteSeek>,
    place: String,
    facts: Facts,
    sizes: Vec<u32>,
    keys: Vec<u32>,
    sequence: Vec<u8>,
    /// Bytes left for the table.
    room: usize,
}

impl Track {
    /// Writes what comes before the frames.
    pub fn begin(destination: Destination, facts: Facts) -> Result<Self, ImageError> {
        let place = destination.name().to_owned();
        let keys = facts.frames.div_ceil(facts.between_keys.max(1));
        let room = boxes::movie(&facts, &Frames { sizes: &[], keys: &[], start: 0, sequence: &[0; SEQUENCE] }).len();
        let room = room + 4 * (facts.frames as usize + keys as usize);
        let bytes = destination.into_seekable();
        let mut track = Self { bytes, place, facts, sizes: Vec::new(), keys: Vec::new(), sequence: Vec::new(), room };
        track.head(0).map_err(|source| track.failed(source))?;
        Ok(track)
    }

    /// Everything before the frames, with nothing in the room for the table.
    fn head(&mut self, length: u64) -> io::Result<()> {
        self.bytes.write_all(&boxes::file_type())?;
        self.room(self.room)?;
        self.bytes.write_all(&[&[0, 0, 0, 1][..], b"mdat", &length.to_be_bytes()].concat())
    }

    /// A box with nothing in it, of 8 bytes and more.
    fn room(&mut self, length: usize) -> io::Result<()> {
        self.bytes.write_all(&[&(length as u32).to_be_bytes()[..], b"free"].concat())?;
        io::copy(&mut io::repeat(0).take(length.saturating_sub(8) as u64), &mut self.bytes).map(drop)
    }

    /// Where the first frame begins.
    fn start(&self) -> usize {
        boxes::file_type().len() + self.room + HEAD
    }

    /// The next frame, as the encoder gives it.
    pub fn append(&mut self, unit: &[u8], is_key: bool) -> Result<(), ImageError> {
        let mut size = 0;
        for (kind, bytes) in units(unit) {
            if kind == SEQUENCE_HEADER && self.sequence.is_empty() {
                self.sequence = bytes.to_vec();
            }
            // What divides frames in a stream; here the table does.
            if kind != TEMPORAL_DELIMITER {
                self.bytes.write_all(bytes).map_err(|source| self.failed(source))?;
                size += bytes.len();
            }
        }
        self.sizes.push(size as u32);
        if is_key {
            self.keys.push(self.sizes.len() as u32);
        }
        Ok(())
    }

    /// Writes the table, and how long it all is.
    pub fn finish(mut self) -> Result<(), ImageError> {
        self.end().map_err(|source| self.failed(source))
    }

    fn end(&mut self) -> io::Result<()> {
        let length = self.sizes.iter().map(|size| u64::from(*size)).sum::<u64>() + HEAD as u64;
        let frames =
            Frames { sizes: &self.sizes, keys: &self.keys, start: self.start() as u32, sequence: &self.sequence };
        let table = boxes::movie(&self.facts, &frames);
        self.bytes.rewind()?;
        self.head(length)?;
        let rest = self.room.checked_sub(table.len()).filter(|rest| *rest >= 8);
        if let Some(rest) = rest {
            self.bytes.seek(SeekFrom::Start(boxes::file_type().len() as u64))?;
            self.bytes.write_all(&table)?;
            self.room(rest)?;
        } else {
            // More than was expected: at the end there is room for anything.
            self.bytes.seek(SeekFrom::End(0))?;
            self.bytes.write_all(&table)?;
        }
        self.bytes.flush()
    }

    fn failed(&self, source: io::Error) -> ImageError {
        ImageError::Write { place: self.place.clone(), source }
    }
}

/// The units of a stream with their kinds, as far as they can be told apart.
fn units(stream: &[u8]) -> Vec<(u8, &[u8])> {
    let (mut units, mut rest) = (Vec::new(), stream);
    while let Some((first, _)) = rest.split_first() {
        let head = if first & 4 != 0 { 2 } else { 1 };
        let has_size = first & 2 != 0;
        let (size, digits) = if has_size { number(rest.get(head..).unwrap_or_default()) } else { (rest.len(), 0) };
        let length = (head + digits).saturating_add(size).min(rest.len());
        let (unit, after) = rest.split_at(length);
        units.push((first >> 3 & 15, unit));
        rest = after;
    }
    units
}

/// A number in pieces of seven bits, low ones first, and how many bytes it has.
fn number(bytes: &[u8]) -> (usize, usize) {
    let mut value = 0;
    for (place, byte) in bytes.iter().take(4).enumerate() {
        value |= usize::from(byte & 127) << (7 * place);
        if byte & 128 == 0 {
            return (value, place + 1);
        }
    }
    (value, bytes.len().min(4))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn streams_are_cut_into_their_units() {
        let stream = [&[0x12, 0][..], &[0x0a, 3, 7, 7, 7], &[0x32, 0x81, 1], &[9; 129]].concat();
        let found: Vec<(u8, usize)> = units(&stream).iter().map(|(kind, bytes)| (*kind, bytes.len())).collect();
        assert_eq!(found, [(2, 2), (1, 5), (6, 132)]);
        assert_eq!(units(&[0x32, 0xff]).len(), 1, "what is cut short is one unit");
        assert!(units(&[]).is_empty());
    }
}
