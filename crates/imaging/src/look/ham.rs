//! Hold and modify, the mode in which the Amiga (1985) showed all of its 4,096 colours with six bits a pixel: each pixel
//! is one of 16 colours that are chosen for the picture, or has the colour of the pixel to its left with one channel changed
//! (Amiga Hardware Reference Manual, 1989, chapter 3). A row begins at the first of the 16.
//!
//! What a pixel is decides what its neighbours can be, so that the nearest colour is not the best choice. Each row is gone
//! through with the best few of all rows so far kept in mind (beam search), the least sum of squared errors wins; of
//! equal ones the first.

use super::palette::{Color, chosen};
use super::threshold;

/// Rows so far that are kept in mind.
const BEAM: usize = 16;
/// Levels of 8 bits from one of 4 bits to the next.
const STEP: u8 = 17;
/// How much errors in red, green and blue are seen.
pub(super) const WEIGHTS: [u32; 3] = [3, 6, 2];
/// The codes of changed channels: blue is 1, red 2, green 3.
const CHANGES: [u8; 3] = [2, 3, 1];

/// A picture as the Amiga held it.
///
/// ```
/// use juggler_imaging::look::Screen;
///
/// let red_and_grey = [255, 0, 0, 119, 119, 119];
/// let screen = Screen::new(&red_and_grey, 2, false);
/// assert_eq!(screen.rows().next().unwrap().collect::<Vec<_>>(), [[15, 0, 0], [7, 7, 7]]);
/// ```
#[derive(Clone, Debug)]
pub struct Screen {
    palette: [Color; 16],
    /// What to do, in two bits: 0 for a colour of the palette, 1, 2, 3 to change blue, red, green; and in four which colour or
    /// level.
    codes: Vec<u8>,
    width: usize,
}

/// A row so far.
#[derive(Clone, Copy)]
struct Way {
    color: Color,
    error: u64,
    /// Which of the ways at the pixel before it comes from.
    from: u8,
    code: u8,
}

impl Screen {
    /// The best that is found for a picture of 8-bit levels, three a pixel.
    pub fn new(bytes: &[u8], width: usize, dithers: bool) -> Self {
        let mut pixels = bytes.as_chunks::<3>().0.to_vec();
        if dithers {
            for (i, pixel) in pixels.iter_mut().enumerate() {
                let shift = threshold(i % width.max(1), i / width.max(1), STEP.into());
                *pixel = pixel.map(|level| (i32::from(level) + shift).clamp(0, 255) as u8);
            }
        }
        let palette = chosen(&pixels, width);
        let codes = pixels.chunks(width.max(1)).flat_map(|row| best(row, &palette)).collect();
        Self { palette, codes, width }
    }

    /// The 16 colours, four bits a channel.
    pub fn palette(&self) -> &[[u8; 3]; 16] {
        &self.palette
    }

    /// The six bits of each pixel.
    pub fn codes(&self) -> &[u8] {
        &self.codes
    }

    /// What shows, row by row: four bits a channel.
    pub fn rows(&self) -> impl Iterator<Item = impl Iterator<Item = [u8; 3]> + '_> + '_ {
        self.codes.chunks(self.width.max(1)).map(|row| {
            row.iter().scan(self.palette[0], |color, code| {
                *color = shown(*code, *color, &self.palette);
                Some(*color)
            })
        })
    }
}

/// The colour of a pixel with a code to the right of a colour.
fn shown(code: u8, left: Color, palette: &[Color; 16]) -> Color {
    let (value, [r, g, b]) = (code & 15, left);
    match code >> 4 & 3 {
        0 => palette[usize::from(value)],
        1 => [r, g, value],
        2 => [value, g, b],
        _ => [r, value, b],
    }
}

/// The error of a colour of four bits where eight are wanted.
fn error(color: Color, wanted: [u8; 3]) -> u64 {
    let squares = color.iter().zip(wanted).zip(WEIGHTS).map(|((level, wanted), weight)| {
        let off = u32::from((level * STEP).abs_diff(wanted));
        weight * off * off
    });
    u64::from(squares.sum::<u32>())
}

/// The level of four bits next to one of eight.
fn nearest(level: u8) -> u8 {
    ((u16::from(level) + 8) / 17) as u8
}

/// The codes of a row.
fn best(row: &[[u8; 3]], palette: &[Color; 16]) -> Vec<u8> {
    let mut steps: Vec<Vec<Way>> = Vec::with_capacity(row.len());
    let mut ways = vec![Way { color: palette[0], error: 0, from: 0, code: 0 }];
    for wanted in row {
        let next = steps_from(&ways, *wanted, palette);
        steps.push(std::mem::replace(&mut ways, next));
    }
    // Back along the best one.
    let mut codes = vec![0; row.len()];
    let mut at = 0;
    steps.push(ways);
    for (code, ways) in codes.iter_mut().zip(steps.get(1..).unwrap_or_default()).rev() {
        if let Some(way) = ways.get(usize::from(at)) {
            (*code, at) = (way.code, way.from);
        }
    }
    codes
}

/// The best ways to one more pixel, each with another colour, best first.
fn steps_from(ways: &[Way], wanted: [u8; 3], palette: &[Color; 16]) -> Vec<Way> {
    // To a colour of the palette one comes best from the best.
    let least = ways.first().map_or(0, |way| way.error);
    let chosen = (0..).zip(palette).map(|(code, color)| Way { color: *color, error: least, from: 0, code });
    let changed = (0..).zip(ways).flat_map(|(from, way)| {
        (0..3).map(move |channel| {
            let (mut color, level) = (way.color, nearest(wanted[channel]));
            color[channel] = level;
            Way { color, error: way.error, from, code: CHANGES[channel] << 4 | level }
        })
    });
    let mut next: Vec<Way> = chosen.chain(changed).collect();
    next.iter_mut().for_each(|way| way.error += error(way.color, wanted));
    next.sort_by_key(|way| way.error);
    let mut kept: Vec<Way> = Vec::with_capacity(BEAM);
    for way in next {
        if kept.len() < BEAM && !kept.iter().any(|known| known.color == way.color) {
            kept.push(way);
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::testing::Random;

    /// A slope with noise and some sharp edges.
    fn picture(width: usize, height: usize) -> Vec<u8> {
        let mut random = Random::new(7);
        let mut pixel = |x: usize, y: usize| {
            let noise = random.range(0.0, 20.0) as u8;
            if (x / 9 + y / 7).is_multiple_of(3) {
                [220, 40 + noise, 10]
            } else {
                [(x * 3) as u8, (y * 5) as u8, 90 + noise]
            }
        };
        (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).flat_map(|(x, y)| pixel(x, y)).collect()
    }

    fn total(colors: impl Iterator<Item = Color>, bytes: &[u8]) -> u64 {
        colors.zip(bytes.as_chunks::<3>().0).map(|(color, wanted)| error(color, *wanted)).sum()
    }

    #[test]
    fn each_pixel_holds_or_modifies() {
        let bytes = picture(61, 40);
        for dithers in [false, true] {
            let screen = Screen::new(&bytes, 61, dithers);
            assert_eq!(screen.codes().len(), 61 * 40);
            assert!(screen.codes().iter().all(|code| *code < 64));
            for row in screen.rows() {
                let mut left = screen.palette()[0];
                for color in row {
                    let changed = (0..3).filter(|channel| color[*channel] != left[*channel]).count();
                    assert!(changed <= 1 || screen.palette().contains(&color), "{left:?} {color:?}");
                    assert!(color.iter().all(|level| *level < 16));
                    left = color;
                }
            }
        }
    }

    #[test]
    fn it_is_better_than_sixteen_colours_and_than_greed() {
        let bytes = picture(80, 60);
        let screen = Screen::new(&bytes, 80, false);
        let found = total(screen.rows().flatten(), &bytes);
        let pixels = bytes.as_chunks::<3>().0;
        let of_palette =
            |wanted: &[u8; 3]| *screen.palette().iter().min_by_key(|color| error(**color, *wanted)).unwrap();
        let sixteen = total(pixels.iter().map(of_palette), &bytes);
        let greedy = pixels.chunks(80).flat_map(|row| {
            row.iter().scan(screen.palette()[0], |left, wanted| {
                let start = [Way { color: *left, error: 0, from: 0, code: 0 }];
                *left = steps_from(&start, *wanted, screen.palette())[0].color;
                Some(*left)
            })
        });
        let greedy = total(greedy, &bytes);
        assert!(found * 2 < sixteen && found < greedy, "{found}, {sixteen} with 16 colours, {greedy} greedily");
    }

    #[test]
    fn sixteen_colours_are_kept_as_they_are() {
        let colors: Vec<Color> = (0..16).map(|i| [i, 15 - i, i * 7 % 16]).collect();
        let bytes: Vec<u8> = (0..640).flat_map(|i| colors[i * 5 % 16].map(|level| level * STEP)).collect();
        let screen = Screen::new(&bytes, 64, false);
        assert_eq!(total(screen.rows().flatten(), &bytes), 0);
    }

    #[test]
    fn anything_is_a_picture() {
        for (bytes, width) in [(vec![], 0), (vec![], 5), (vec![1, 2, 3], 1), (vec![200; 3 * 7], 7)] {
            let screen = Screen::new(&bytes, width, true);
            assert_eq!(screen.rows().flatten().count(), bytes.len() / 3);
        }
    }
}
