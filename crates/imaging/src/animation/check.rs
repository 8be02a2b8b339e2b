//! Limits of the movie formats, checked before rendering starts.

use super::{AnimationFormat, AnimationHeader, refused};
use crate::ImageError;
use std::ops::RangeInclusive;

/// Frames per second that movies can have; [`AnimationFormat::frame_rates`] gives the limits of
/// each format.
pub const FRAME_RATES: RangeInclusive<f64> = 0.01..=1000.0;

/// Maximum number of frames: a month at 100 frames per second.
const MAX_FRAMES: u32 = 1 << 28;

impl AnimationFormat {
    /// Width and height that frames can have, in pixels.
    pub fn side_lengths(self) -> RangeInclusive<u32> {
        match self {
            Self::Apng => 1..=i32::MAX as u32,
            Self::Gif => 1..=u32::from(u16::MAX),
            // Limits of the AV1 encoder.
            #[cfg(feature = "av1")]
            Self::Mp4 => 16..=u32::from(u16::MAX),
            Self::Webp => 1..=16_383,
        }
    }

    /// Frames per second that the format can store; GIF measures time in hundredths of a
    /// second, and browsers show frames of less than 2/100 s at a tenth of their rate.
    pub fn frame_rates(self) -> RangeInclusive<f64> {
        let most = if self == Self::Gif { 50.0 } else { *FRAME_RATES.end() };
        *FRAME_RATES.start()..=most
    }

    /// Whether the file stores how often the movie plays; otherwise the player decides.
    pub fn stores_play_count(self) -> bool {
        match self {
            Self::Apng | Self::Gif | Self::Webp => true,
            #[cfg(feature = "av1")]
            Self::Mp4 => false,
        }
    }

    /// Whether the format stores alpha, or one bit of it.
    pub fn stores_alpha(self) -> bool {
        match self {
            Self::Apng | Self::Gif | Self::Webp => true,
            #[cfg(feature = "av1")]
            Self::Mp4 => false,
        }
    }

    /// Whether the format is lossy, so that [`AnimationHeader::quality`] applies.
    pub fn has_quality(self) -> bool {
        match self {
            Self::Apng | Self::Gif | Self::Webp => false,
            #[cfg(feature = "av1")]
            Self::Mp4 => true,
        }
    }

    /// Upper bound of a writer's memory in bytes, including the frame passed to it.
    pub fn memory_needed(self, width: u32, height: u32) -> u64 {
        // Measured maxima in bytes per pixel: 23 lossless, 170 (plus 16 MiB) for AV1.
        let (bytes_per_pixel, fixed) = match self {
            // Linear pixels with alpha, quantized pixels of two frames, compressed output.
            Self::Apng | Self::Gif | Self::Webp => (48, 1 << 20),
            // Lookahead and reference frames of the encoder, at several resolutions.
            #[cfg(feature = "av1")]
            Self::Mp4 => (200, 16 << 20),
        };
        (u64::from(width) * u64::from(height)).saturating_mul(bytes_per_pixel).saturating_add(fixed)
    }

    /// Checks that the format can store such a movie; `file` names the file in messages.
    ///
    /// # Errors
    ///
    /// A message if the frame size, number of frames, frame rate or quality is out of range, or if the
    /// format cannot be transparent.
    pub fn check(self, file: &str, header: &AnimationHeader) -> Result<(), ImageError> {
        let AnimationHeader { width, height, frames, frames_per_second, quality, .. } = *header;
        let side_lengths = self.side_lengths();
        if !side_lengths.contains(&width) || !side_lengths.contains(&height) {
            let (least, most) = side_lengths.into_inner();
            let message =
                format!("its frames cannot be {width} × {height} pixels: each side of {self} is {least} to {most}");
            return Err(refused(file, message));
        }
        if frames == 0 {
            return Err(refused(file, "there are no frames to write"));
        }
        if frames > MAX_FRAMES {
            return Err(refused(file, format!("{frames} frames are more than the limit of {MAX_FRAMES}")));
        }
        let frame_rates = self.frame_rates();
        if !frame_rates.contains(&frames_per_second) {
            let (least, most) = frame_rates.into_inner();
            let message =
                format!("{self} does not support {frames_per_second} frames per second, only {least} to {most}");
            return Err(refused(file, message));
        }
        if header.has_alpha() && !self.stores_alpha() {
            return Err(refused(
                file,
                format!("{self} cannot be transparent; use .webp, .apng or .gif, or a background"),
            ));
        }
        if !(1..=100).contains(&quality) {
            return Err(refused(file, format!("its quality must be 1 to 100, it is {quality}")));
        }
        Ok(())
    }
}
