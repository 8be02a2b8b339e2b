//! From red, green and blue to brightness and colour differences: ITU-R BT.709, 8 bits of limited range, with one
//! colour for two by two pixels, level with the left column of them.

/// Bits behind the point.
const BITS: u32 = 16;
/// The shares of red and blue in brightness.
const RED: f64 = 0.2126;
const BLUE: f64 = 0.0722;

/// Factors of red, green and blue, in sixteenth bits: levels of 0 to 255 become 0 to `range`.
const fn factors(of: [f64; 3], range: f64) -> [i32; 3] {
    let one = range / 255.0 * (1 << BITS) as f64;
    [rounded(of[0] * one), rounded(of[1] * one), rounded(of[2] * one)]
}

const fn rounded(value: f64) -> i32 {
    if value < 0.0 { (value - 0.5) as i32 } else { (value + 0.5) as i32 }
}

const GREEN: f64 = 1.0 - RED - BLUE;
const LUMA: [i32; 3] = factors([RED, GREEN, BLUE], 219.0);
const CHROMA: [[i32; 3]; 2] = [
    factors([-RED / (2.0 - 2.0 * BLUE), -GREEN / (2.0 - 2.0 * BLUE), 0.5], 224.0),
    factors([0.5, -GREEN / (2.0 - 2.0 * RED), -BLUE / (2.0 - 2.0 * RED)], 224.0),
];

/// Room for the three planes of a frame.
pub(super) struct Planes {
    width: usize,
    height: usize,
    planes: [Vec<u8>; 3],
}

impl Planes {
    /// For frames of a size, odd ones too.
    pub fn new(width: usize, height: usize) -> Self {
        Self { width, height, planes: Default::default() }
    }

    /// The planes of a frame of three bytes a pixel, each with the length of its rows.
    pub fn of(&mut self, bytes: &[u8]) -> [(&[u8], usize); 3] {
        let pixels = bytes.as_chunks::<3>().0;
        let [luma, blue, red] = &mut self.planes;
        luma.clear();
        luma.extend(pixels.iter().map(|pixel| weigh(LUMA, pixel.map(i32::from), 0, 16)));
        blue.clear();
        red.clear();
        let rows: Vec<&[[u8; 3]]> = pixels.chunks_exact(self.width).collect();
        for pair in rows.chunks(2) {
            let [upper, .., lower] = pair else {
                // The last row of an odd number.
                pair.iter().for_each(|row| differences(row, row, blue, red));
                continue;
            };
            differences(upper, lower, blue, red);
        }
        debug_assert_eq!(blue.len(), self.width.div_ceil(2) * self.height.div_ceil(2));
        let half = self.width.div_ceil(2);
        [(luma, self.width), (blue, half), (red, half)]
    }
}

/// The colour of two rows: each is a quarter of the pixel to the left, half of its own and a quarter of that to the right.
fn differences(upper: &[[u8; 3]], lower: &[[u8; 3]], blue: &mut Vec<u8>, red: &mut Vec<u8>) {
    let last = upper.len().saturating_sub(1);
    for x in (0..upper.len()).step_by(2) {
        let columns = [x.saturating_sub(1), x, x, (x + 1).min(last)];
        let sum: [i32; 3] = std::array::from_fn(|channel| {
            columns.iter().map(|x| i32::from(upper[*x][channel]) + i32::from(lower[*x][channel])).sum()
        });
        blue.push(weigh(CHROMA[0], sum, 3, 128));
        red.push(weigh(CHROMA[1], sum, 3, 128));
    }
}

/// A weighted sum of 2^`more` pixels, rounded, with what black has.
fn weigh(factors: [i32; 3], pixel: [i32; 3], more: u32, black: i64) -> u8 {
    let shift = BITS + more;
    let sum: i64 = factors.iter().zip(pixel).map(|(factor, level)| i64::from(*factor) * i64::from(level)).sum();
    (((sum + (1 << (shift - 1))) >> shift) + black).clamp(0, 255) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    fn planes(width: usize, height: usize, bytes: &[u8]) -> [Vec<u8>; 3] {
        Planes::new(width, height).of(bytes).map(|(plane, _)| plane.to_vec())
    }

    #[test]
    fn known_colours_have_their_known_levels() {
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
    fn colour_lies_level_with_the_left_column() {
        // White, white, then red: the second colour has three quarters of red, the first a trace of none.
        let row = [[255; 3], [255; 3], [255, 0, 0], [255, 0, 0]].concat();
        let [_, blue, _] = planes(4, 1, &row);
        let red_alone = f64::from(128 - 102);
        assert_eq!(blue[0], 128);
        assert!((f64::from(128 - blue[1]) / red_alone - 0.75).abs() < 0.03, "{blue:?}");
    }
}
