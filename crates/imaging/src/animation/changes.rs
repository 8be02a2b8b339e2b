//! From linear light to bytes, and which part of a frame differs from the one before: only that is written.

use crate::tone::Quantizer;
use juggler_math::Rgb;

/// Pixels that differ lie within; at least one pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Part {
    /// First column.
    pub x: u32,
    /// First row.
    pub y: u32,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

/// The frame before, and room for the next.
pub struct Frames {
    width: u32,
    quantizer: Quantizer,
    now: Vec<u8>,
    before: Vec<u8>,
    /// What the corner's place is a multiple of.
    step: u32,
}

impl Frames {
    /// None yet.
    pub fn new(width: u32, quantizer: Quantizer) -> Self {
        Self { width, quantizer, now: Vec::new(), before: Vec::new(), step: 1 }
    }

    /// With parts that begin at even columns and rows only.
    pub fn with_even_corners(self) -> Self {
        Self { step: 2, ..self }
    }

    /// Takes the next frame; which part of it is new, and that part's bytes, three a pixel.
    pub fn next(&mut self, pixels: &[Rgb]) -> (Part, Vec<u8>) {
        std::mem::swap(&mut self.now, &mut self.before);
        self.now.clear();
        self.quantizer.append_bytes(pixels, &mut self.now);
        let part = self.changed();
        let row = self.width as usize * 3;
        let columns = part.x as usize * 3..(part.x + part.width) as usize * 3;
        let rows = self.now.chunks_exact(row).skip(part.y as usize).take(part.height as usize);
        (part, rows.flat_map(|row| &row[columns.clone()]).copied().collect())
    }

    fn changed(&self) -> Part {
        let row = self.width as usize * 3;
        let height = (self.now.len() / row.max(1)) as u32;
        if self.before.len() != self.now.len() {
            return Part { x: 0, y: 0, width: self.width, height };
        }
        let (mut left, mut right, mut top, mut bottom) = (self.width, 0, height, 0);
        for (y, (now, before)) in (0..).zip(self.now.chunks_exact(row).zip(self.before.chunks_exact(row))) {
            let mut differing = (0..).zip(now.as_chunks::<3>().0.iter().zip(before.as_chunks::<3>().0));
            let Some((first, _)) = differing.find(|(_, (now, before))| now != before) else { continue };
            let last = differing.filter(|(_, (now, before))| now != before).last().map_or(first, |(last, _)| last);
            (left, right, top, bottom) = (left.min(first), right.max(last + 1), top.min(y), y + 1);
        }
        if left < right {
            let (left, top) = (left - left % self.step, top - top % self.step);
            return Part { x: left, y: top, width: right - left, height: bottom - top };
        }
        Part { x: 0, y: 0, width: 1, height: 1 }
    }
}
