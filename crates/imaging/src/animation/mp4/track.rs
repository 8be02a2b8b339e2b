//! MP4 file layout: space for the metadata (`moov`) is reserved before the frames and filled at the
//! end, so that playback can start before the download completes. The metadata takes 8 bytes of
//! memory per frame.

use super::boxes::{self, FrameTable};
use crate::ImageError;
use crate::output::{Destination, WriteSeek};
use std::io::{self, Read, Seek, SeekFrom, Write};

/// Bytes reserved for the AV1 sequence header, which comes with the first frame.
const SEQUENCE: usize = 64;
/// Length of the `mdat` header with a 64-bit size.
const HEAD: usize = 16;
/// OBU types of an AV1 stream (AV1 Bitstream & Decoding Process, 6.2.2).
const SEQUENCE_HEADER: u8 = 1;
const TEMPORAL_DELIMITER: u8 = 2;

/// Properties of the video track.
pub(super) struct TrackInfo {
    /// Frame width and height in pixels.
    pub size: [u32; 2],
    /// Duration of a frame in ticks.
    pub ticks: u32,
    /// Ticks per second.
    pub per_second: u32,
    /// AV1 level.
    pub level: u8,
    /// Number of frames.
    pub frames: u32,
    /// Frames from one key frame to the next.
    pub key_frame_interval: u32,
}

/// An MP4 file being written.
pub(super) struct Track {
    bytes: Box<dyn WriteSeek>,
    file: String,
    info: TrackInfo,
    sizes: Vec<u32>,
    keys: Vec<u32>,
    sequence: Vec<u8>,
    /// Bytes reserved for the metadata.
    reserved: usize,
}

impl Track {
    /// Writes everything before the frames.
    pub fn begin(destination: Destination, info: TrackInfo) -> Result<Self, ImageError> {
        let file = destination.name().to_owned();
        let keys = info.frames.div_ceil(info.key_frame_interval.max(1));
        let reserved =
            boxes::movie(&info, &FrameTable { sizes: &[], keys: &[], start: 0, sequence: &[0; SEQUENCE] }).len();
        let reserved = reserved + 4 * (info.frames as usize + keys as usize);
        let bytes = destination.into_seekable();
        let mut track = Self { bytes, file, info, sizes: Vec::new(), keys: Vec::new(), sequence: Vec::new(), reserved };
        track.write_head(0).map_err(|source| track.failed(source))?;
        Ok(track)
    }

    /// Writes file type, free space in place of the metadata, and the header of `mdat`.
    fn write_head(&mut self, length: u64) -> io::Result<()> {
        self.bytes.write_all(&boxes::file_type())?;
        self.write_free(self.reserved)?;
        self.bytes.write_all(&[&[0, 0, 0, 1][..], b"mdat", &length.to_be_bytes()].concat())
    }

    /// Writes a `free` box of at least 8 bytes.
    fn write_free(&mut self, length: usize) -> io::Result<()> {
        self.bytes.write_all(&[&(length as u32).to_be_bytes()[..], b"free"].concat())?;
        io::copy(&mut io::repeat(0).take(length.saturating_sub(8) as u64), &mut self.bytes).map(drop)
    }

    /// File offset of the first frame.
    fn start(&self) -> usize {
        boxes::file_type().len() + self.reserved + HEAD
    }

    /// Appends an encoded frame.
    pub fn append(&mut self, unit: &[u8], is_key: bool) -> Result<(), ImageError> {
        let mut size = 0;
        for (kind, bytes) in split_obus(unit) {
            if kind == SEQUENCE_HEADER && self.sequence.is_empty() {
                self.sequence = bytes.to_vec();
            }
            // MP4 omits temporal delimiters, since the sample table separates the frames.
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

    /// Writes the metadata and the length of the frames.
    pub fn finish(mut self) -> Result<(), ImageError> {
        self.end().map_err(|source| self.failed(source))
    }

    fn end(&mut self) -> io::Result<()> {
        let length = self.sizes.iter().map(|size| u64::from(*size)).sum::<u64>() + HEAD as u64;
        let frames =
            FrameTable { sizes: &self.sizes, keys: &self.keys, start: self.start() as u32, sequence: &self.sequence };
        let table = boxes::movie(&self.info, &frames);
        self.bytes.rewind()?;
        self.write_head(length)?;
        let rest = self.reserved.checked_sub(table.len()).filter(|rest| *rest >= 8);
        if let Some(rest) = rest {
            self.bytes.seek(SeekFrom::Start(boxes::file_type().len() as u64))?;
            self.bytes.write_all(&table)?;
            self.write_free(rest)?;
        } else {
            // The metadata exceeds the reserved space: append them at the end.
            self.bytes.seek(SeekFrom::End(0))?;
            self.bytes.write_all(&table)?;
        }
        self.bytes.flush()
    }

    fn failed(&self, source: io::Error) -> ImageError {
        ImageError::Write { file: self.file.clone(), source }
    }
}

/// Splits a stream into OBUs with their types; malformed data end up in the last one.
fn split_obus(stream: &[u8]) -> Vec<(u8, &[u8])> {
    let (mut units, mut rest) = (Vec::new(), stream);
    while let Some((first, _)) = rest.split_first() {
        let header = if first & 4 != 0 { 2 } else { 1 };
        let has_size = first & 2 != 0;
        let (size, digits) =
            if has_size { read_leb128(rest.get(header..).unwrap_or_default()) } else { (rest.len(), 0) };
        let length = (header + digits).saturating_add(size).min(rest.len());
        let (unit, after) = rest.split_at(length);
        units.push((first >> 3 & 15, unit));
        rest = after;
    }
    units
}

/// Decodes a LEB128 number of at most 4 bytes; returns the value and its length in bytes.
fn read_leb128(bytes: &[u8]) -> (usize, usize) {
    let mut value = 0;
    for (index, byte) in bytes.iter().take(4).enumerate() {
        value |= usize::from(byte & 127) << (7 * index);
        if byte & 128 == 0 {
            return (value, index + 1);
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
        let found: Vec<(u8, usize)> = split_obus(&stream).iter().map(|(kind, bytes)| (*kind, bytes.len())).collect();
        assert_eq!(found, [(2, 2), (1, 5), (6, 132)]);
        assert_eq!(split_obus(&[0x32, 0xff]).len(), 1, "what is cut short is one unit");
        assert!(split_obus(&[]).is_empty());
    }
}
