//! Sixteen colours for a picture that is held and modified: boxes of colours are cut in two where they are widest (Heckbert,
//! "Color image quantization for frame buffer display", 1982, by variance), and then each colour moves into the middle of those
//! that are nearest to it (Lloyd 1982). Pixels count the more, the more channels differ from those to their left: along
//! slopes, holding and modifying does without any.

use super::ham::WEIGHTS;

/// Levels of red, green and blue, of four bits each.
pub(super) type Color = [u8; 3];

/// How often colours move.
const MOVES: usize = 12;
/// How much a pixel counts of which so many channels differ from those to its left.
const WORTH: [u64; 4] = [1, 2, 12, 24];

/// A colour and how much it counts.
type Counted = (Color, u64);

/// The colours of a picture; black where it has fewer.
pub(super) fn chosen(pixels: &[[u8; 3]], width: usize) -> [Color; 16] {
    let colors = counted(pixels, width);
    let mut palette: Vec<Color> = cut(colors.clone()).iter().map(|part| middle(part)).collect();
    for _ in 0..MOVES {
        let mut parts = vec![Vec::new(); palette.len()];
        for color in &colors {
            let nearest = (0..palette.len()).min_by_key(|place| distance(palette[*place], color.0)).unwrap_or_default();
            parts[nearest].push(*color);
        }
        let moved: Vec<Color> = parts.iter().filter(|part| !part.is_empty()).map(|part| middle(part)).collect();
        if moved == palette {
            break;
        }
        palette = moved;
    }
    let mut places = palette.into_iter();
    std::array::from_fn(|_| places.next().unwrap_or_default())
}

/// The different colours, in order.
fn counted(pixels: &[[u8; 3]], width: usize) -> Vec<Counted> {
    let mut counts = vec![0_u64; 1 << 12];
    let short = |pixel: &[u8; 3]| pixel.map(|level| ((u16::from(level) + 8) / 17) as u8);
    for row in pixels.chunks(width.max(1)) {
        let mut left = [0; 3];
        for pixel in row {
            let color = short(pixel);
            let changed = (0..3).filter(|channel| color[*channel] != left[*channel]).count();
            let [r, g, b] = color.map(usize::from);
            counts[r << 8 | g << 4 | b] += WORTH[changed];
            left = color;
        }
    }
    let color = |place: usize| [place >> 8, place >> 4 & 15, place & 15].map(|level| level as u8);
    (0..).zip(counts).filter(|(_, count)| *count > 0).map(|(place, count)| (color(place), count)).collect()
}

/// At most sixteen boxes of colours.
fn cut(colors: Vec<Counted>) -> Vec<Vec<Counted>> {
    let mut parts = vec![colors];
    while parts.len() < 16 {
        let spreads = parts.iter().map(|part| (0..3).map(|channel| (spread(part, channel), channel)).max());
        let widest = (0..).zip(spreads).filter_map(|(place, spread)| Some((spread?, place)));
        let Some(((spread, channel), place)) =
            widest.max_by_key(|((spread, _), place)| (*spread, std::cmp::Reverse(*place)))
        else {
            break;
        };
        if spread == 0 {
            break;
        }
        let part = std::mem::take(&mut parts[place]);
        let (sum, count) = sums(&part, channel);
        // At most the middle is low: each side has at least one.
        let (low, high) = part.into_iter().partition(|(color, _)| u64::from(color[channel]) * count <= sum);
        parts[place] = low;
        parts.push(high);
    }
    parts.retain(|part| !part.is_empty());
    parts
}

/// The sum of a channel's levels and how much they count.
fn sums(part: &[Counted], channel: usize) -> (u64, u64) {
    part.iter().fold((0, 0), |(sum, total), (color, count)| (sum + u64::from(color[channel]) * count, total + count))
}

/// How far a channel's levels lie apart, by how much they count: the sum of squares from their middle.
fn spread(part: &[Counted], channel: usize) -> u64 {
    let (sum, count) = sums(part, channel);
    let squares: u64 = part.iter().map(|(color, count)| u64::from(color[channel]).pow(2) * count).sum();
    let middle = u128::from(sum).pow(2).checked_div(u128::from(count)).unwrap_or(0);
    squares.saturating_sub(middle as u64).saturating_mul(WEIGHTS[channel].into())
}

/// The colour in the middle.
fn middle(part: &[Counted]) -> Color {
    std::array::from_fn(|channel| {
        let (sum, count) = sums(part, channel);
        (sum + count / 2).checked_div(count).unwrap_or(0) as u8
    })
}

fn distance(a: Color, b: Color) -> u32 {
    a.iter().zip(b).zip(WEIGHTS).map(|((a, b), weight)| weight * u32::from(a.abs_diff(b)).pow(2)).sum()
}
