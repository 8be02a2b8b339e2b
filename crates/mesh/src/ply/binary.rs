//! The values of a binary PLY, tightly packed, in either byte order.

use super::header::{ByteOrder, Element, Scalar};
use super::values::{Values, skip};
use crate::error::{FilePosition, MeshErrorKind};
use crate::text::whole;

/// The bytes after a header.
#[derive(Clone)]
pub(super) struct BinaryValues<'a> {
    rest: &'a [u8],
    size: usize,
    order: ByteOrder,
}

impl<'a> BinaryValues<'a> {
    /// Creates a reader that starts at byte `start` of the file.
    pub fn new(file: &'a [u8], start: usize, order: ByteOrder) -> Self {
        Self { rest: file.get(start..).unwrap_or_default(), size: file.len(), order }
    }

    #[inline(always)]
    fn bytes<const N: usize>(&mut self) -> Result<[u8; N], MeshErrorKind> {
        let Some((bytes, rest)) = self.rest.split_first_chunk::<N>() else { return Err(self.too_short(N as u64)) };
        self.rest = rest;
        let mut bytes = *bytes;
        if self.order == ByteOrder::Big {
            bytes.reverse();
        }
        Ok(bytes)
    }

    /// Passes the next `count` values of `N` bytes to `take`. The type is dispatched once a list,
    /// not once a value.
    #[inline]
    fn each<const N: usize>(
        &mut self,
        count: u64,
        decode: impl Fn([u8; N], FilePosition) -> Result<i64, MeshErrorKind>,
        mut take: impl FnMut(FilePosition, i64) -> Result<(), MeshErrorKind>,
    ) -> Result<(), MeshErrorKind> {
        for _ in 0..count {
            let place = self.place();
            let value = decode(self.bytes()?, place)?;
            take(place, value)?;
        }
        Ok(())
    }

    #[cold]
    fn too_short(&self, needed: u64) -> MeshErrorKind {
        let found = self.rest.len();
        self.place().error(format!("expected {needed} more bytes, found the end of the file after {found}"))
    }
}

impl Values for BinaryValues<'_> {
    fn place(&self) -> FilePosition {
        FilePosition::Byte((self.size - self.rest.len()) as u64)
    }

    fn begin_row(&mut self) -> Result<(), MeshErrorKind> {
        Ok(())
    }

    fn end_row(&mut self) -> Result<(), MeshErrorKind> {
        Ok(())
    }

    #[inline]
    fn real(&mut self, kind: Scalar, what: &str) -> Result<f32, MeshErrorKind> {
        match kind {
            Scalar::F32 => self.bytes().map(f32::from_le_bytes),
            Scalar::F64 => self.bytes().map(|bytes| f64::from_le_bytes(bytes) as f32),
            _ => {
                let mut value = 0.0;
                self.integers(kind, 1, what, |_, found| {
                    value = found as f32;
                    Ok(())
                })?;
                Ok(value)
            }
        }
    }

    #[inline]
    fn integers(
        &mut self,
        kind: Scalar,
        count: u64,
        what: &str,
        take: impl FnMut(FilePosition, i64) -> Result<(), MeshErrorKind>,
    ) -> Result<(), MeshErrorKind> {
        match kind {
            Scalar::I8 => self.each(count, |bytes, _| Ok(i8::from_le_bytes(bytes).into()), take),
            Scalar::U8 => self.each(count, |bytes, _| Ok(u8::from_le_bytes(bytes).into()), take),
            Scalar::I16 => self.each(count, |bytes, _| Ok(i16::from_le_bytes(bytes).into()), take),
            Scalar::U16 => self.each(count, |bytes, _| Ok(u16::from_le_bytes(bytes).into()), take),
            Scalar::I32 => self.each(count, |bytes, _| Ok(i32::from_le_bytes(bytes).into()), take),
            Scalar::U32 => self.each(count, |bytes, _| Ok(u32::from_le_bytes(bytes).into()), take),
            Scalar::F32 => self.each(count, |bytes, place| whole(f32::from_le_bytes(bytes).into(), place, what), take),
            Scalar::F64 => self.each(count, |bytes, place| whole(f64::from_le_bytes(bytes), place, what), take),
        }
    }

    fn skip(&mut self, kind: Scalar, count: u64) -> Result<(), MeshErrorKind> {
        let length = count.saturating_mul(kind.size());
        let rest = usize::try_from(length).ok().and_then(|length| self.rest.get(length..));
        self.rest = rest.ok_or_else(|| self.too_short(length))?;
        Ok(())
    }

    fn skip_rows(&mut self, element: &Element, count: u64) -> Result<(), MeshErrorKind> {
        if element.properties.iter().all(|property| property.length.is_none()) {
            let row = element.properties.iter().map(|property| property.item.size()).sum::<u64>();
            return self.skip(Scalar::U8, row.saturating_mul(count));
        }
        for _ in 0..count {
            element.properties.iter().try_for_each(|property| skip(property, self))?;
        }
        Ok(())
    }

    fn min_size(&self, kind: Scalar) -> u64 {
        kind.size()
    }

    fn remaining(&self) -> u64 {
        self.rest.len() as u64
    }
}
