//! What a format cannot take, said before anything is rendered.

use super::{AnimationFormat, AnimationHeader, refused};
use crate::ImageError;
use std::ops::RangeInclusive;

/// Frames a second that can be written, but for what single formats cannot: [`AnimationFormat::paces`].
pub const PACES: RangeInclusive<f64> = 0.01..=1000.0;

/// Frames of a film: a month at a hundred a second.
const MOST_FRAMES: u32 = 1 << 28;

impl AnimationFormat {
    /// The sides that a frame can have.
    pub fn sides(self) -> RangeInclusive<u32> {
        match self {
            Self::Apng => 1..=i32::MAX as u32,
            Self::Gif => 1..=u32::from(u16::MAX),
            // What the encoder takes.
            #[cfg(feature = "av1")]
            Self::Mp4 => 16..=u32::from(u16::MAX),
            Self::Webp => 1..=16_383,
        }
    }

    /// Frames a second that it can say. A GIF's times are hundredths of a second.
    pub fn paces(self) -> RangeInclusive<f64> {
        let most = if self == Self::Gif { 100.0 } else { *PACES.end() };
        *PACES.start()..=most
    }

    /// Whether the file says how often it is shown; else that is up to who shows it.
    pub fn says_how_often(self) -> bool {
        match self {
            Self::Apng | Self::Gif | Self::Webp => true,
            #[cfg(feature = "av1")]
            Self::Mp4 => false,
        }
    }

    /// Whether there is a choice between small and good.
    pub fn has_quality(self) -> bool {
        match self {
            Self::Apng | Self::Gif | Self::Webp => false,
            #[cfg(feature = "av1")]
            Self::Mp4 => true,
        }
    }

    /// Bytes of memory that a writer takes at most, and a frame on its way to it.
    pub fn memory_needed(self, width: u32, height: u32) -> u64 {
        // Measured: at most 23 and, with 16 MiB, 170.
        let (bytes_a_pixel, fixed) = match self {
            // Light, levels now and before, and what of them is packed.
            Self::Apng | Self::Gif | Self::Webp => (36, 1 << 20),
            // Frames that the encoder looks ahead, each also at smaller sizes, and those that it looks back to.
            #[cfg(feature = "av1")]
            Self::Mp4 => (200, 16 << 20),
        };
        (u64::from(width) * u64::from(height)).saturating_mul(bytes_a_pixel).saturating_add(fixed)
    }

    /// Whether such a film can be written; `place` is how messages call it.
    pub fn check(self, place: &str, header: &AnimationHeader) -> Result<(), ImageError> {
        let AnimationHeader { width, height, frames, frames_per_second, quality, .. } = *header;
        let sides = self.sides();
        if !sides.contains(&width) || !sides.contains(&height) {
            let (least, most) = sides.into_inner();
            let message =
                format!("its frames cannot be {width} × {height} pixels: each side of {self} is {least} to {most}");
            return Err(refused(place, message));
        }
        if frames == 0 {
            return Err(refused(place, "there are no frames to write"));
        }
        if frames > MOST_FRAMES {
            return Err(refused(place, format!("{frames} frames are more than the limit of {MOST_FRAMES}")));
        }
        let paces = self.paces();
        if !paces.contains(&frames_per_second) {
            let (least, most) = paces.into_inner();
            let message =
                format!("{frames_per_second} frames a second cannot be written as {self}: {least} to {most} can");
            return Err(refused(place, message));
        }
        if !(1..=100).contains(&quality) {
            return Err(refused(place, format!("its quality is {quality}, not 1 to 100")));
        }
        Ok(())
    }
}
