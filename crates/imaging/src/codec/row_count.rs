//! Check of the number of rows that a writer gets.

use super::{Header, RowWriter};
use crate::ImageError;
use juggler_math::PixelRows;

/// Checks that the encoder gets whole rows, as many as the header announces.
pub(super) struct RowCountCheck {
    inner: Box<dyn RowWriter>,
    width: u64,
    /// Pixels still missing.
    left: u64,
}

impl RowCountCheck {
    /// Check of an encoder of an image with this header.
    pub fn new(inner: Box<dyn RowWriter>, header: &Header) -> Self {
        Self { inner, width: u64::from(header.width), left: header.pixels() }
    }
}

impl RowWriter for RowCountCheck {
    fn write_rows(&mut self, rows: PixelRows) -> Result<(), ImageError> {
        let given = rows.len() as u64;
        if given > self.left || !given.is_multiple_of(self.width) {
            return Err(ImageError::Rows { expected: self.left.min(self.width), given });
        }
        self.left -= given;
        if rows.is_empty() { Ok(()) } else { self.inner.write_rows(rows) }
    }

    fn finish(self: Box<Self>) -> Result<(), ImageError> {
        if self.left > 0 {
            return Err(ImageError::Rows { expected: self.left, given: 0 });
        }
        self.inner.finish()
    }
}
