//! Cursor over the content of a stream, between its header byte and its tail.

use super::MeshoptError;

/// Number of bytes from the cursor that [`Reader::window`] returns. The tail of an attribute stream
/// has at least this size, so a window at any position of the content lies inside the stream.
pub(super) const WINDOW: usize = 24;

/// Reads the bytes of a stream in order. The cursor never passes the end of the content.
pub(super) struct Reader<'a> {
    stream: &'a [u8],
    position: usize,
    end: usize,
}

impl<'a> Reader<'a> {
    /// Checks the header byte of a stream whose last `tail` bytes are not content, and starts after
    /// the header.
    ///
    /// # Errors
    ///
    /// The stream is shorter than header and tail, or its header is none of `headers`.
    pub(super) fn new(stream: &'a [u8], headers: &[u8], tail: usize) -> Result<Self, MeshoptError> {
        let found = stream.first().copied();
        if found.is_none_or(|byte| !headers.contains(&byte)) {
            return Err(MeshoptError::Header { found, supported: headers.to_vec() });
        }
        let end = stream.len().checked_sub(tail).filter(|end| *end >= 1);
        let end = end.ok_or(MeshoptError::Truncated { byte: stream.len() })?;
        Ok(Self { stream, position: 1, end })
    }

    /// The error of a stream that ends too early, at the cursor.
    fn truncated(&self) -> MeshoptError {
        MeshoptError::Truncated { byte: self.position }
    }

    /// The tail, from its first byte to the end of the stream.
    pub(super) fn tail(&self) -> &'a [u8] {
        self.stream.get(self.end..).unwrap_or_default()
    }

    /// The next byte.
    pub(super) fn byte(&mut self) -> Result<u8, MeshoptError> {
        self.bytes(1)?.first().copied().ok_or_else(|| self.truncated())
    }

    /// The next `count` bytes.
    pub(super) fn bytes(&mut self, count: usize) -> Result<&'a [u8], MeshoptError> {
        let start = self.position;
        self.skip(count)?;
        self.stream.get(start..self.position).ok_or_else(|| self.truncated())
    }

    /// The [`WINDOW`] bytes from the cursor, which may reach into the tail. The cursor stays.
    pub(super) fn window(&self) -> Result<&'a [u8; WINDOW], MeshoptError> {
        let rest = self.stream.get(self.position..).unwrap_or_default();
        rest.first_chunk().ok_or_else(|| self.truncated())
    }

    /// Advances the cursor by `count` bytes of content.
    pub(super) fn skip(&mut self, count: usize) -> Result<(), MeshoptError> {
        let next = self.position.checked_add(count).filter(|next| *next <= self.end);
        self.position = next.ok_or_else(|| self.truncated())?;
        Ok(())
    }

    /// The next integer in the encoding *unsigned LEB128*: 1 to 5 bytes of 7 bits, the lowest bits
    /// first; the highest bit of each byte says whether another byte follows. Bits above 32 are
    /// ignored.
    pub(super) fn varint(&mut self) -> Result<u32, MeshoptError> {
        let start = self.position;
        let mut value = 0;
        for shift in [0, 7, 14, 21, 28] {
            let byte = self.byte()?;
            value |= u32::from(byte & 0x7f) << shift;
            if byte < 0x80 {
                return Ok(value);
            }
        }
        Err(MeshoptError::LongInteger { byte: start })
    }

    /// Checks that all content was read.
    ///
    /// # Errors
    ///
    /// Bytes remain between the cursor and the tail.
    pub(super) fn finish(&self) -> Result<(), MeshoptError> {
        match self.end.saturating_sub(self.position) {
            0 => Ok(()),
            count => Err(MeshoptError::Unread { count, byte: self.position }),
        }
    }
}

/// Signed integer of its zigzag encoding 0, -1, 1, -2, 2, …, in two's complement.
pub(super) fn unzigzag(code: u32) -> u32 {
    (code >> 1) ^ (code & 1).wrapping_neg()
}
