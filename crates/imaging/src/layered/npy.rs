//! NPY, NumPy's array format: version 1.0, little-endian `f32`, shape height × width × channels.

use super::{LayerRows, LayeredHeader};
use crate::ImageError;
use crate::output::WriteSeek;
use std::io;

/// Alignment of the array data in bytes.
const ALIGNMENT: usize = 64;

/// Streams rows into an NPY file.
pub struct Writer {
    bytes: Box<dyn WriteSeek>,
    file: String,
}

impl Writer {
    pub fn new(mut bytes: Box<dyn WriteSeek>, file: String, header: &LayeredHeader) -> Result<Self, ImageError> {
        let channels: usize = header.layers.iter().map(|layer| layer.channels.len()).sum();
        let (rows, columns) = (header.height, header.width);
        let mut head =
            format!("{{'descr': '<f4', 'fortran_order': False, 'shape': ({rows}, {columns}, {channels}), }}");
        let before = b"\x93NUMPY\x01\x00".len() + 2;
        let length = (before + head.len() + 1).next_multiple_of(ALIGNMENT) - before;
        head.extend(std::iter::repeat_n(' ', length - head.len() - 1));
        head.push('\n');
        let written = bytes
            .write_all(b"\x93NUMPY\x01\x00")
            .and_then(|()| bytes.write_all(&(head.len() as u16).to_le_bytes()))
            .and_then(|()| bytes.write_all(head.as_bytes()));
        match written {
            Ok(()) => Ok(Self { bytes, file }),
            Err(source) => Err(ImageError::Write { file, source }),
        }
    }

    fn failed(&self, source: io::Error) -> ImageError {
        ImageError::Write { file: self.file.clone(), source }
    }
}

impl LayerRows for Writer {
    fn write_rows(&mut self, channels: &[&[f32]]) -> Result<(), ImageError> {
        let count = channels.first().map_or(0, |channel| channel.len());
        let mut rows = Vec::with_capacity(count * channels.len() * 4);
        for pixel in 0..count {
            let values = channels.iter().map(|channel| channel.get(pixel).copied().unwrap_or(0.0));
            rows.extend(values.flat_map(f32::to_le_bytes));
        }
        self.bytes.write_all(&rows).map_err(|error| self.failed(error))
    }

    fn finish(&mut self) -> Result<(), ImageError> {
        self.bytes.flush().map_err(|error| self.failed(error))
    }
}
