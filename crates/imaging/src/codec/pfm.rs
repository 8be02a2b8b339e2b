//! Portable Float Map (Debevec): a text header, then 32-bit floats, rows from bottom to top. A
//! negative scale marks little-endian data.

use super::{Header, ReadSeek, RowWriter, Source, quoted};
use crate::ImageError;
use crate::output::{Destination, WriteSeek};
use juggler_math::{Image, PixelRows, Rgb};
use std::io::{self, BufRead, SeekFrom};

/// Seeks to the place of each row, since the file stores rows from bottom to top.
pub(super) struct Writer {
    bytes: Box<dyn WriteSeek>,
    file: String,
    /// Length of the header in bytes.
    start: u64,
    width: usize,
    /// Rows still missing.
    left: u64,
    row: Vec<u8>,
}

impl Writer {
    pub fn new(destination: Destination, header: &Header) -> Result<Self, ImageError> {
        let file = destination.name().to_owned();
        let mut bytes = destination.into_seekable();
        let text = format!("PF\n{} {}\n-1.0\n", header.width, header.height);
        if let Err(source) = bytes.write_all(text.as_bytes()) {
            return Err(ImageError::Write { file, source });
        }
        let (start, left) = (text.len() as u64, u64::from(header.height));
        Ok(Self { bytes, file, start, width: header.width as usize, left, row: Vec::new() })
    }

    fn write(&mut self, rows: &[Rgb]) -> io::Result<()> {
        let count = (rows.len() / self.width) as u64;
        self.left -= count;
        self.bytes.seek(SeekFrom::Start(self.start + self.left * self.width as u64 * 12))?;
        for row in rows.chunks_exact(self.width).rev() {
            self.row.clear();
            self.row.extend(row.iter().flat_map(|p| p.to_array()).flat_map(f32::to_le_bytes));
            self.bytes.write_all(&self.row)?;
        }
        Ok(())
    }
}

impl RowWriter for Writer {
    fn write_rows(&mut self, rows: PixelRows) -> Result<(), ImageError> {
        self.write(rows.colors).map_err(|source| ImageError::Write { file: self.file.clone(), source })
    }

    fn finish(mut self: Box<Self>) -> Result<(), ImageError> {
        self.bytes.flush().map_err(|source| ImageError::Write { file: self.file, source })
    }
}

/// Reads a color or gray PFM. The magnitude of the scale is ignored, as most readers do.
pub(super) fn read(source: Source, bytes: &mut dyn ReadSeek) -> Result<Image, ImageError> {
    let header = read_header(source, bytes)?;
    let (width, height) = header.size(source)?;
    let channels = if header.is_gray { 1 } else { 3 };
    let mut row = vec![0; width as usize * channels * 4];
    let mut rows: Vec<Vec<Rgb>> = Vec::new();
    for _ in 0..height {
        bytes.read_exact(&mut row).map_err(|e| source.failed(e))?;
        let sample = |b: &[u8]| {
            let four = [b[0], b[1], b[2], b[3]];
            if header.is_little_endian { f32::from_le_bytes(four) } else { f32::from_be_bytes(four) }
        };
        let pixel = |p: &[u8]| {
            if header.is_gray { Rgb::splat(sample(p)) } else { Rgb::new(sample(p), sample(&p[4..]), sample(&p[8..])) }
        };
        rows.push(row.chunks_exact(channels * 4).map(pixel).collect());
    }
    rows.reverse();
    source.image(width, height, rows.concat())
}

/// Image size.
pub(super) fn size(source: Source, bytes: &mut dyn ReadSeek) -> Result<(u32, u32), ImageError> {
    read_header(source, bytes)?.size(source)
}

struct PfmHeader {
    is_gray: bool,
    width: u64,
    height: u64,
    is_little_endian: bool,
}

impl PfmHeader {
    fn size(&self, source: Source) -> Result<(u32, u32), ImageError> {
        source.size(self.width, self.height, 1)
    }
}

/// Reads the header: magic number, width, height and scale, separated by whitespace, then a single
/// whitespace byte.
fn read_header(source: Source, bytes: &mut dyn ReadSeek) -> Result<PfmHeader, ImageError> {
    let mut words = Vec::new();
    for _ in 0..4 {
        words.push(word(bytes).map_err(|e| source.failed(e))?);
    }
    let (width, height, scale) = (words[1].parse(), words[2].parse(), words[3].parse::<f32>());
    match (width, height, scale) {
        (Ok(width), Ok(height), Ok(scale)) if scale.is_finite() && scale != 0.0 => {
            Ok(PfmHeader { is_gray: words[0] == "Pf", width, height, is_little_endian: scale < 0.0 })
        }
        _ => Err(source.malformed(format!("its header says {}", quoted(&words.join(" "))))),
    }
}

/// Reads a word of at most 24 bytes and the whitespace byte after it.
fn word(bytes: &mut dyn BufRead) -> io::Result<String> {
    let mut word = String::new();
    loop {
        let mut byte = [0];
        bytes.read_exact(&mut byte)?;
        match byte[0] {
            b' ' | b'\n' | b'\r' | b'\t' if word.is_empty() => {}
            b' ' | b'\n' | b'\r' | b'\t' => return Ok(word),
            b if b.is_ascii_graphic() && word.len() < 24 => word.push(char::from(b)),
            _ => return Err(io::Error::new(io::ErrorKind::InvalidData, "its header is not text")),
        }
    }
}
