//! RGB to Y'CbCr by ITU-R BT.709, 8 bits, limited range, 4:2:0 with chroma samples co-sited with
//! the left luma column.

/// Fractional bits of the fixed-point factors.
const BITS: u32 = 16;
/// Luma coefficients of red, green and blue.
const RED: f64 = 0.2126;
const GREEN: f64 = 1.0 - RED - BLUE;
const BLUE: f64 = 0.0722;

/// Fixed-point factors of red, green and blue that map the levels 0 to 255 to the range from 0 to
/// `range`.
const fn factors(coefficients: [f64; 3], range: f64) -> [i32; 3] {
    let one = range / 255.0 * (1 << BITS) as f64;
    [rounded(coefficients[0] * one), rounded(coefficients[1] * one), rounded(coefficients[2] * one)]
}

const fn rounded(value: f64) -> i32 {
    if value < 0.0 { (value - 0.5) as i32 } else { (value + 0.5) as i32 }
}

/// Factors of Y', whose limited range spans 219 levels.
const LUMA: [i32; 3] = factors([RED, GREEN, BLUE], 219.0);
/// Factors of Cb and Cr, whose limited range spans 224 levels.
const CHROMA: [[i32; 3]; 2] = [
    factors([-RED / (2.0 - 2.0 * BLUE), -GREEN / (2.0 - 2.0 * BLUE), 0.5], 224.0),
    factors([0.5, -GREEN / (2.0 - 2.0 * RED), -BLUE / (2.0 - 2.0 * RED)], 224.0),
];

/// Buffers for the planes Y', Cb and Cr of a frame.
pub(super) struct Planes {
    width: usize,
    height: usize,
    planes: [Vec<u8>; 3],
}

impl Planes {
    /// Buffers for frames of this size, which may be odd.
    pub fn new(width: usize, height: usize) -> Self {
        Self { width, height, planes: Default::default() }
    }

    /// Converts 8-bit RGB pixels to the planes Y', Cb and Cr, each returned with its row length.
    pub fn convert(&mut self, bytes: &[u8]) -> [(&[u8], usize); 3] {
        let pixels = bytes.as_chunks::<3>().0;
        let [luma, blue, red] = &mut self.planes;
        luma.clear();
        luma.extend(pixels.iter().map(|pixel| weighted_sum(LUMA, pixel.map(i32::from), 0, 16)));
        blue.clear();
        red.clear();
        let rows: Vec<&[[u8; 3]]> = pixels.chunks_exact(self.width).collect();
        for pair in rows.chunks(2) {
            let [upper, .., lower] = pair else {
                // An odd number of rows ends with a single one.
                pair.iter().for_each(|row| append_chroma(row, row, blue, red));
                continue;
            };
            append_chroma(upper, lower, blue, red);
        }
        debug_assert_eq!(blue.len(), self.width.div_ceil(2) * self.height.div_ceil(2));
        let half = self.width.div_ceil(2);
        [(luma, self.width), (blue, half), (red, half)]
    }
}

/// Appends the chroma of two rows: averaged vertically, filtered horizontally with weights 1/4,
/// 1/2, 1/4.
fn append_chroma(upper: &[[u8; 3]], lower: &[[u8; 3]], blue: &mut Vec<u8>, red: &mut Vec<u8>) {
    let last = upper.len().saturating_sub(1);
    for x in (0..upper.len()).step_by(2) {
        let columns = [x.saturating_sub(1), x, x, (x + 1).min(last)];
        let sum: [i32; 3] = std::array::from_fn(|channel| {
            columns.iter().map(|x| i32::from(upper[*x][channel]) + i32::from(lower[*x][channel])).sum()
        });
        blue.push(weighted_sum(CHROMA[0], sum, 3, 128));
        red.push(weighted_sum(CHROMA[1], sum, 3, 128));
    }
}

/// Weighted sum of the channels of a color, rounded, plus the level `offset`. The color is the mean
/// of 2^`samples_log2` pixels; `sum` is the sum of these pixels.
fn weighted_sum(factors: [i32; 3], sum: [i32; 3], samples_log2: u32, offset: i64) -> u8 {
    let shift = BITS + samples_log2;
    let weighted: i64 = factors.iter().zip(sum).map(|(factor, level)| i64::from(*factor) * i64::from(level)).sum();
    (((weighted + (1 << (shift - 1))) >> shift) + offset).clamp(0, 255) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    fn planes(width: usize, height: usize, bytes: &[u8]) -> [Vec<u8>; 3] {
        Planes::new(width, height).convert(bytes).map(|(plane, _)| plane.to_vec())
    }

    #[test]
    fn known_colors_have_their_known_levels() {
        for (color, expected) in [
            ([0, 0, 0], [16, 128, 128]),
            ([255, 255, 255], [235, 128, 128]),
            ([255, 0, 0], [63, 102, 240]),
            ([0, 255, 0], [173, 42, 26]),
            ([0, 0, 255], [32, 240, 118]),
            ([128, 128, 128], [126, 128, 128]),
        ] {
            let found = planes(2, 2, &color.repeat(4)).map(|plane| plane[0]);
            assert_eq!(found, expected, "{color:?}");
        }
    }

    #[test]
    fn odd_sizes_have_whole_planes() {
        for (width, height) in [(1, 1), (3, 2), (2, 3), (5, 7)] {
            let [luma, blue, red] = planes(width, height, &[90; 3].repeat(width * height));
            let quarter = width.div_ceil(2) * height.div_ceil(2);
            assert_eq!((luma.len(), blue.len(), red.len()), (width * height, quarter, quarter));
            assert!(blue.iter().chain(&red).all(|level| *level == 128));
        }
    }

    #[test]
    fn chroma_samples_are_cosited_with_the_left_column() {
        // White, white, red, red: the second chroma sample is 3/4 red, the first is neutral.
        let row = [[255; 3], [255; 3], [255, 0, 0], [255, 0, 0]].concat();
        let [_, blue, _] = planes(4, 1, &row);
        let red_alone = f64::from(128 - 102);
        assert_eq!(blue[0], 128);
        assert!((f64::from(128 - blue[1]) / red_alone - 0.75).abs() < 0.03, "{blue:?}");
    }
}
