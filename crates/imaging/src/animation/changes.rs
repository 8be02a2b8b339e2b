//! Quantizes frames and finds the rectangle that differs from the previous frame, so that only its
//! pixels are encoded.

use super::AnimationHeader;
use crate::tone::{LevelEncoder, Tone};
use juggler_math::PixelRows;

/// Bounding rectangle of the changed pixels; at least one pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ChangedRect {
    /// Left column.
    pub x: u32,
    /// Top row.
    pub y: u32,
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
}

/// Quantized pixels of the current and the previous frame.
pub struct Frames {
    width: u32,
    levels: LevelEncoder,
    current: Vec<u8>,
    previous: Vec<u8>,
    /// Alignment of the rectangle's top left corner, in pixels.
    step: u32,
}

impl Frames {
    /// Starts without a previous frame. Frames are not dithered, since still areas would flicker.
    pub fn new(header: &AnimationHeader) -> Self {
        let tone = Tone { dither: false, ..header.tone.clone() };
        let levels = LevelEncoder::bytes(&tone, header.width).with_alpha(header.transparent);
        Self { width: header.width, levels, current: Vec::new(), previous: Vec::new(), step: 1 }
    }

    /// The whole next frame, quantized.
    pub fn whole(&mut self, pixels: PixelRows) -> (ChangedRect, Vec<u8>) {
        self.current.clear();
        self.next(pixels)
    }

    /// Aligns the rectangles to even columns and rows.
    pub fn with_even_corners(self) -> Self {
        Self { step: 2, ..self }
    }

    /// Quantizes the next frame. Returns the changed rectangle and its pixels, 8-bit RGB or RGBA row
    /// by row.
    pub fn next(&mut self, pixels: PixelRows) -> (ChangedRect, Vec<u8>) {
        std::mem::swap(&mut self.current, &mut self.previous);
        self.current.clear();
        self.levels.append(pixels, &mut self.current);
        let (rect, channels) = (self.changed(), self.levels.channels());
        let row = self.width as usize * channels;
        let columns = rect.x as usize * channels..(rect.x + rect.width) as usize * channels;
        let rows = self.current.chunks_exact(row).skip(rect.y as usize).take(rect.height as usize);
        (rect, rows.flat_map(|row| &row[columns.clone()]).copied().collect())
    }

    fn changed(&self) -> ChangedRect {
        let channels = self.levels.channels();
        let row = self.width as usize * channels;
        let height = (self.current.len() / row.max(1)) as u32;
        if self.previous.len() != self.current.len() {
            return ChangedRect { x: 0, y: 0, width: self.width, height };
        }
        let (mut left, mut right, mut top, mut bottom) = (self.width, 0, height, 0);
        for (y, (current, previous)) in (0..).zip(self.current.chunks_exact(row).zip(self.previous.chunks_exact(row))) {
            let mut differing = (0..).zip(current.chunks_exact(channels).zip(previous.chunks_exact(channels)));
            let Some((first, _)) = differing.find(|(_, (current, previous))| current != previous) else { continue };
            let last =
                differing.filter(|(_, (current, previous))| current != previous).last().map_or(first, |(last, _)| last);
            (left, right, top, bottom) = (left.min(first), right.max(last + 1), top.min(y), y + 1);
        }
        if left < right {
            let (left, top) = (left - left % self.step, top - top % self.step);
            return ChangedRect { x: left, y: top, width: right - left, height: bottom - top };
        }
        ChangedRect { x: 0, y: 0, width: 1, height: 1 }
    }
}
