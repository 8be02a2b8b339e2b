//! Hold-and-modify (HAM), the Amiga's display mode (1985) with 4,096 colors at six bits per pixel:
//! each pixel either selects one of 16 palette colors or repeats the pixel to its left with one
//! channel modified (Amiga Hardware Reference Manual, 1989, chapter 3). Each row starts from
//! palette color 0.
//!
//! A pixel's code limits its successors, so the nearest color is not always the best choice. Each
//! row is encoded by beam search for the least sum of squared errors; the first of equal candidates
//! wins.

use super::bayer_offset;
use super::palette::{Color, choose_palette};

/// Beam width: number of partial rows kept.
const BEAM: usize = 16;
/// Distance between 4-bit levels in units of 8-bit levels.
const STEP: u8 = 17;
/// Perceptual weights of squared errors in red, green and blue.
pub(super) const WEIGHTS: [u32; 3] = [3, 6, 2];
/// Commands that modify red, green and blue: the upper two of the six bits of a code.
const CHANGES: [u8; 3] = [2, 3, 1];

/// An image encoded for hold-and-modify display.
///
/// ```
/// use juggler_imaging::look::HamImage;
///
/// let red_and_gray = [255, 0, 0, 119, 119, 119];
/// let image = HamImage::new(&red_and_gray, 2, false);
/// assert_eq!(image.rows().next().unwrap().collect::<Vec<_>>(), [[15, 0, 0], [7, 7, 7]]);
/// ```
#[derive(Clone, Debug)]
pub struct HamImage {
    palette: [Color; 16],
    /// Six bits per pixel: two for the command (0 palette, 1 blue, 2 red, 3 green), four for
    /// palette index or level.
    codes: Vec<u8>,
    width: usize,
}

/// Candidate encoding of a row up to some pixel.
#[derive(Clone, Copy)]
struct Candidate {
    color: Color,
    error: u64,
    /// Index of the predecessor among the candidates of the previous pixel.
    from: u8,
    code: u8,
}

impl HamImage {
    /// Encodes 8-bit RGB pixels in rows of `width`, with ordered dithering if `dithers`.
    pub fn new(bytes: &[u8], width: usize, dithers: bool) -> Self {
        let mut pixels = bytes.as_chunks::<3>().0.to_vec();
        if dithers {
            for (i, pixel) in pixels.iter_mut().enumerate() {
                let shift = bayer_offset(i % width.max(1), i / width.max(1), STEP.into());
                *pixel = pixel.map(|level| (i32::from(level) + shift).clamp(0, 255) as u8);
            }
        }
        let palette = choose_palette(&pixels, width);
        let codes = pixels.chunks(width.max(1)).flat_map(|row| encode_row(row, &palette)).collect();
        Self { palette, codes, width }
    }

    /// The 16 palette colors, 4 bits per channel.
    pub fn palette(&self) -> &[[u8; 3]; 16] {
        &self.palette
    }

    /// Six-bit codes of all pixels.
    pub fn codes(&self) -> &[u8] {
        &self.codes
    }

    /// Displayed colors, row by row, 4 bits per channel.
    pub fn rows(&self) -> impl Iterator<Item = impl Iterator<Item = [u8; 3]> + '_> + '_ {
        self.codes.chunks(self.width.max(1)).map(|row| {
            row.iter().scan(self.palette[0], |color, code| {
                *color = decoded_color(*code, *color, &self.palette);
                Some(*color)
            })
        })
    }
}

/// Displayed color of a pixel, given its code and the color to its left.
fn decoded_color(code: u8, left: Color, palette: &[Color; 16]) -> Color {
    let (value, [r, g, b]) = (code & 15, left);
    match code >> 4 & 3 {
        0 => palette[usize::from(value)],
        1 => [r, g, value],
        2 => [value, g, b],
        _ => [r, value, b],
    }
}

/// Weighted squared error of a 4-bit color against an 8-bit color.
fn error(color: Color, target: [u8; 3]) -> u64 {
    let squares = color.iter().zip(target).zip(WEIGHTS).map(|((level, target), weight)| {
        let off = u32::from((level * STEP).abs_diff(target));
        weight * off * off
    });
    u64::from(squares.sum::<u32>())
}

/// 4-bit level nearest to an 8-bit level.
fn nearest(level: u8) -> u8 {
    ((u16::from(level) + 8) / 17) as u8
}

/// Encodes a row.
fn encode_row(row: &[[u8; 3]], palette: &[Color; 16]) -> Vec<u8> {
    let mut steps: Vec<Vec<Candidate>> = Vec::with_capacity(row.len());
    let mut candidates = vec![Candidate { color: palette[0], error: 0, from: 0, code: 0 }];
    for target in row {
        let next = extend_candidates(&candidates, *target, palette);
        steps.push(std::mem::replace(&mut candidates, next));
    }
    // Trace back from the best candidate.
    let mut codes = vec![0; row.len()];
    let mut at = 0;
    steps.push(candidates);
    for (code, candidates) in codes.iter_mut().zip(steps.get(1..).unwrap_or_default()).rev() {
        if let Some(candidate) = candidates.get(usize::from(at)) {
            (*code, at) = (candidate.code, candidate.from);
        }
    }
    codes
}

/// Extends all candidates by one pixel; keeps the best per color, sorted by error.
fn extend_candidates(candidates: &[Candidate], target: [u8; 3], palette: &[Color; 16]) -> Vec<Candidate> {
    // Palette colors do not depend on the pixel to the left, so extend the best candidate only.
    let least = candidates.first().map_or(0, |candidate| candidate.error);
    let from_palette = (0..).zip(palette).map(|(code, color)| Candidate { color: *color, error: least, from: 0, code });
    let modified = (0..).zip(candidates).flat_map(|(from, candidate)| {
        (0..3).map(move |channel| {
            let (mut color, level) = (candidate.color, nearest(target[channel]));
            color[channel] = level;
            Candidate { color, error: candidate.error, from, code: CHANGES[channel] << 4 | level }
        })
    });
    let mut next: Vec<Candidate> = from_palette.chain(modified).collect();
    next.iter_mut().for_each(|candidate| candidate.error += error(candidate.color, target));
    next.sort_by_key(|candidate| candidate.error);
    let mut kept: Vec<Candidate> = Vec::with_capacity(BEAM);
    for candidate in next {
        if kept.len() < BEAM && !kept.iter().any(|known| known.color == candidate.color) {
            kept.push(candidate);
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::testing::Random;

    /// A gradient with noise and some sharp edges.
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
        colors.zip(bytes.as_chunks::<3>().0).map(|(color, target)| error(color, *target)).sum()
    }

    #[test]
    fn ham_codes_modify_one_channel_or_select_the_palette() {
        let bytes = picture(61, 40);
        for dithers in [false, true] {
            let image = HamImage::new(&bytes, 61, dithers);
            assert_eq!(image.codes().len(), 61 * 40);
            assert!(image.codes().iter().all(|code| *code < 64));
            for row in image.rows() {
                let mut left = image.palette()[0];
                for color in row {
                    let changed = (0..3).filter(|channel| color[*channel] != left[*channel]).count();
                    assert!(changed <= 1 || image.palette().contains(&color), "{left:?} {color:?}");
                    assert!(color.iter().all(|level| *level < 16));
                    left = color;
                }
            }
        }
    }

    #[test]
    fn ham_encoding_beats_the_palette_and_the_greedy_encoder() {
        let bytes = picture(80, 60);
        let image = HamImage::new(&bytes, 80, false);
        let found = total(image.rows().flatten(), &bytes);
        let pixels = bytes.as_chunks::<3>().0;
        let of_palette =
            |target: &[u8; 3]| *image.palette().iter().min_by_key(|color| error(**color, *target)).unwrap();
        let sixteen = total(pixels.iter().map(of_palette), &bytes);
        let greedy = pixels.chunks(80).flat_map(|row| {
            row.iter().scan(image.palette()[0], |left, target| {
                let start = [Candidate { color: *left, error: 0, from: 0, code: 0 }];
                *left = extend_candidates(&start, *target, image.palette())[0].color;
                Some(*left)
            })
        });
        let greedy = total(greedy, &bytes);
        assert!(found * 2 < sixteen && found < greedy, "{found}, {sixteen} with 16 colors, {greedy} greedily");
    }

    #[test]
    fn sixteen_colors_are_kept_as_they_are() {
        let colors: Vec<Color> = (0..16).map(|i| [i, 15 - i, i * 7 % 16]).collect();
        let bytes: Vec<u8> = (0..640).flat_map(|i| colors[i * 5 % 16].map(|level| level * STEP)).collect();
        let image = HamImage::new(&bytes, 64, false);
        assert_eq!(total(image.rows().flatten(), &bytes), 0);
    }

    #[test]
    fn ham_encoding_accepts_any_size() {
        for (bytes, width) in [(vec![], 0), (vec![], 5), (vec![1, 2, 3], 1), (vec![200; 3 * 7], 7)] {
            let image = HamImage::new(&bytes, width, true);
            assert_eq!(image.rows().flatten().count(), bytes.len() / 3);
        }
    }
}
