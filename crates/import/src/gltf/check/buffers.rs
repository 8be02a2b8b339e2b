//! Checks of buffers, buffer views and their compression.

use super::checker::Checker;
use crate::gltf::document::{BufferView, CompressedView, Index};
use crate::gltf::location::Location;
use crate::gltf::meshopt;

/// A range of bytes in a container of bytes.
pub(super) struct ByteRange {
    pub offset: u64,
    pub length: u64,
    /// Length of the container.
    pub available: u64,
}

impl Checker<'_> {
    /// Checks the lengths of buffers, and that each has content.
    pub(super) fn buffers(&mut self) {
        let list = Location::root("buffers");
        for (position, buffer) in self.document.buffers.iter().enumerate() {
            let at = list.index(position);
            let length = buffer.byte_length.get();
            if length == 0 {
                self.fault(&at.key("byteLength"), format_args!("0 is not a length of at least 1"));
            }
            self.count(&at.key("byteLength"), length, self.limits.buffer_bytes, "bytes");
            if buffer.uri.is_some() || buffer.is_fallback() {
                continue;
            }
            match self.binary {
                Some(binary) if position == 0 && length > binary => {
                    self.fault(&at, format_args!("needs {length} bytes, the BIN chunk has {binary}"));
                }
                Some(_) if position == 0 => {}
                _ if !self.document.uses_buffer(position) => {
                    self.warn(&at, "has no `uri` and no use; it is not read");
                }
                None if position == 0 => self.fault(&at, format_args!("has no `uri`, and the file has no BIN chunk")),
                _ => self.fault(&at, format_args!("has no `uri`; only the first buffer may be the BIN chunk")),
            }
        }
    }

    /// Checks that buffer views are inside their buffers.
    pub(super) fn buffer_views(&mut self) {
        let list = Location::root("bufferViews");
        for (position, view) in self.document.buffer_views.iter().enumerate() {
            let at = list.index(position);
            if view.byte_length.get() == 0 {
                self.fault(&at.key("byteLength"), format_args!("0 is not a length of at least 1"));
            }
            self.in_buffer(&at, view.buffer, view.byte_offset.get(), view.byte_length.get());
            if let Some(stride) = view.byte_stride.map(Index::get)
                && !((4..=252).contains(&stride) && stride.is_multiple_of(4))
            {
                let stride_at = at.key("byteStride");
                // Strides of indices in compressed files are the sizes of the indices.
                match view.compressed() {
                    Some(_) if stride > 0 && stride <= 256 => {}
                    _ => self.fault(&stride_at, format_args!("{stride} is not a multiple of 4 from 4 to 252")),
                }
            }
            if let Some((name, compressed)) = view.compressed() {
                let extensions = at.key("extensions");
                self.compressed(&extensions.key(name), view, compressed);
            }
        }
    }

    /// Checks the compressed data of a buffer view.
    fn compressed(&mut self, at: &Location<'_>, view: &BufferView, compressed: &CompressedView) {
        let length = compressed.byte_length.get();
        self.in_buffer(at, compressed.buffer, compressed.byte_offset.get(), length);
        let (count, stride) = (compressed.count.get(), compressed.byte_stride.get() as u64);
        let Some(decoded) = count.checked_mul(stride).filter(|decoded| *decoded > 0) else {
            self.fault(at, format_args!("{count} elements of {stride} bytes are no data"));
            return;
        };
        if decoded != view.byte_length.get() {
            let expected = view.byte_length;
            self.fault(at, format_args!("decodes to {decoded} bytes, the buffer view has {expected}"));
        }
        let limit = length.saturating_mul(meshopt::MAX_EXPANSION).saturating_add(meshopt::FREE_BYTES);
        self.count(at, decoded, limit, "decoded bytes");
    }

    /// Checks that a range is inside its buffer.
    fn in_buffer(&mut self, at: &Location<'_>, buffer: Index, offset: u64, length: u64) {
        let buffers = &self.document.buffers;
        self.index(&at.key("buffer"), buffer, buffers.len(), "buffer");
        if let Some(found) = buffers.get(buffer.get()) {
            let range = ByteRange { offset, length, available: found.byte_length.get() };
            self.range(at, &range, "buffer", buffer);
        }
    }

    /// Checks that a range is inside its container.
    pub(super) fn range(&mut self, at: &Location<'_>, range: &ByteRange, what: &str, index: Index) {
        let ByteRange { offset, length, available } = *range;
        if offset.checked_add(length).is_none_or(|end| end > available) {
            let text = format_args!("needs {length} bytes from byte {offset}, {what} {index} has {available}");
            self.fault(at, text);
        }
    }
}
