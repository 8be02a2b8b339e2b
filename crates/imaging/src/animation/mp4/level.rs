//! AV1 levels (AV1 Bitstream & Decoding Process, A.3): minimum capabilities of a decoder.

/// Level 31, the maximum parameters level, which sets no limits.
pub(super) const MAX_PARAMETERS: u8 = 31;

/// Level index with maximum number of pixels, width, height and pixels per second.
const LEVELS: [(u8, u64, u32, u32, u64); 14] = [
    (0, 147_456, 2048, 1152, 4_423_680),
    (1, 278_784, 2816, 1584, 8_363_520),
    (4, 665_856, 4352, 2448, 19_975_680),
    (5, 1_065_024, 5504, 3096, 31_950_720),
    (8, 2_359_296, 6144, 3456, 70_778_880),
    (9, 2_359_296, 6144, 3456, 141_557_760),
    (12, 8_912_896, 8192, 4352, 267_386_880),
    (13, 8_912_896, 8192, 4352, 534_773_760),
    (14, 8_912_896, 8192, 4352, 1_069_547_520),
    (15, 8_912_896, 8192, 4352, 1_069_547_520),
    (16, 35_651_584, 16_384, 8704, 1_069_547_520),
    (17, 35_651_584, 16_384, 8704, 2_139_095_040),
    (18, 35_651_584, 16_384, 8704, 4_278_190_080),
    (19, 35_651_584, 16_384, 8704, 4_278_190_080),
];

/// Lowest level that fits the frame size and rate, if any.
pub(super) fn lowest(width: u32, height: u32, frames_per_second: f64) -> Option<u8> {
    let area = u64::from(width) * u64::from(height);
    let rate = area as f64 * frames_per_second;
    let fits = |level: &&(u8, u64, u32, u32, u64)| {
        let (_, pixels, widest, highest, most) = **level;
        area <= pixels && width <= widest && height <= highest && rate <= most as f64
    };
    LEVELS.iter().find(fits).map(|(level, ..)| *level)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn common_movies_have_their_usual_levels() {
        assert_eq!(lowest(1920, 1080, 30.0), Some(8));
        assert_eq!(lowest(1920, 1080, 60.0), Some(9));
        assert_eq!(lowest(3840, 2160, 60.0), Some(13));
        assert_eq!(lowest(320, 200, 30.0), Some(0));
        assert_eq!(lowest(20_000, 20_000, 1.0), None);
    }

    /// Each row follows from the example of its level in the specification (table in A.3): the
    /// maximum area is that of the example frame, each side may be a multiple of the frame's, and
    /// the pixel rate is that of the example.
    #[test]
    fn av1_level_limits_follow_from_the_specification() {
        // Level, width, height, frames per second, maximum side as a multiple of the frame's.
        let examples: [(u8, u32, u32, u32, u32); 14] = [
            (0, 512, 288, 30, 4),
            (1, 704, 396, 30, 4),
            (4, 1088, 612, 30, 4),
            (5, 1376, 774, 30, 4),
            (8, 2048, 1152, 30, 3),
            (9, 2048, 1152, 60, 3),
            (12, 4096, 2176, 30, 2),
            (13, 4096, 2176, 60, 2),
            (14, 4096, 2176, 120, 2),
            (15, 4096, 2176, 120, 2),
            (16, 8192, 4352, 30, 2),
            (17, 8192, 4352, 60, 2),
            (18, 8192, 4352, 120, 2),
            (19, 8192, 4352, 120, 2),
        ];
        let rows = examples.map(|(level, width, height, rate, times)| {
            let area = u64::from(width) * u64::from(height);
            (level, area, times * width, times * height, area * u64::from(rate))
        });
        assert_eq!(rows, LEVELS);
    }
}
