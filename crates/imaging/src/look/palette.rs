//! Palette of 16 colors for hold-and-modify images: variance-based cuts of color boxes (Heckbert,
//! "Color image quantization for frame buffer display", 1982), refined by k-means iterations (Lloyd
//! 1982). A pixel's weight grows with the number of channels that differ from the pixel to its
//! left: a change of one channel, as in gradients, needs no palette color.

use super::ham::WEIGHTS;

/// Red, green and blue with 4 bits each.
pub(super) type Color = [u8; 3];

/// Maximum number of k-means iterations.
const MAX_ITERATIONS: usize = 12;
/// Weight of a pixel by the number of channels that differ from the pixel to its left.
const CHANGE_WEIGHTS: [u64; 4] = [1, 2, 12, 24];

/// A color and its weight.
type WeightedColor = (Color, u64);

/// Chooses the palette of an image; unused entries are black.
pub(super) fn choose_palette(pixels: &[[u8; 3]], width: usize) -> [Color; 16] {
    let colors = weighted_colors(pixels, width);
    let mut palette: Vec<Color> = split_boxes(colors.clone()).iter().map(|cluster| mean_color(cluster)).collect();
    for _ in 0..MAX_ITERATIONS {
        let mut clusters = vec![Vec::new(); palette.len()];
        for color in &colors {
            let nearest = (0..palette.len()).min_by_key(|index| distance(palette[*index], color.0)).unwrap_or_default();
            clusters[nearest].push(*color);
        }
        let moved: Vec<Color> =
            clusters.iter().filter(|cluster| !cluster.is_empty()).map(|cluster| mean_color(cluster)).collect();
        if moved == palette {
            break;
        }
        palette = moved;
    }
    let mut entries = palette.into_iter();
    std::array::from_fn(|_| entries.next().unwrap_or_default())
}

/// Distinct colors with their weights, in ascending order.
fn weighted_colors(pixels: &[[u8; 3]], width: usize) -> Vec<WeightedColor> {
    let mut counts = vec![0_u64; 1 << 12];
    let to_4_bits = |pixel: &[u8; 3]| pixel.map(|level| ((u16::from(level) + 8) / 17) as u8);
    for row in pixels.chunks(width.max(1)) {
        let mut left = [0; 3];
        for pixel in row {
            let color = to_4_bits(pixel);
            let changed = (0..3).filter(|channel| color[*channel] != left[*channel]).count();
            let [r, g, b] = color.map(usize::from);
            counts[r << 8 | g << 4 | b] += CHANGE_WEIGHTS[changed];
            left = color;
        }
    }
    let color = |index: usize| [index >> 8, index >> 4 & 15, index & 15].map(|level| level as u8);
    (0..).zip(counts).filter(|(_, count)| *count > 0).map(|(index, count)| (color(index), count)).collect()
}

/// Splits the colors into at most 16 boxes.
fn split_boxes(colors: Vec<WeightedColor>) -> Vec<Vec<WeightedColor>> {
    let mut clusters = vec![colors];
    while clusters.len() < 16 {
        let spreads = clusters.iter().map(|cluster| (0..3).map(|channel| (spread(cluster, channel), channel)).max());
        let widest = (0..).zip(spreads).filter_map(|(index, spread)| Some((spread?, index)));
        let Some(((spread, channel), index)) =
            widest.max_by_key(|((spread, _), index)| (*spread, std::cmp::Reverse(*index)))
        else {
            break;
        };
        if spread == 0 {
            break;
        }
        let cluster = std::mem::take(&mut clusters[index]);
        let (sum, count) = sums(&cluster, channel);
        // Split at the mean: the spread is above 0, so neither box is empty.
        let (low, high) = cluster.into_iter().partition(|(color, _)| u64::from(color[channel]) * count <= sum);
        clusters[index] = low;
        clusters.push(high);
    }
    clusters.retain(|cluster| !cluster.is_empty());
    clusters
}

/// Weighted sum of a channel's levels, and sum of weights.
fn sums(cluster: &[WeightedColor], channel: usize) -> (u64, u64) {
    cluster.iter().fold((0, 0), |(sum, total), (color, count)| (sum + u64::from(color[channel]) * count, total + count))
}

/// Weighted sum of squared deviations of a channel from its mean, times the channel's perceptual
/// weight.
fn spread(cluster: &[WeightedColor], channel: usize) -> u64 {
    let (sum, count) = sums(cluster, channel);
    let squares: u64 = cluster.iter().map(|(color, count)| u64::from(color[channel]).pow(2) * count).sum();
    let squared_sum_over_count = u128::from(sum).pow(2).checked_div(u128::from(count)).unwrap_or(0);
    squares.saturating_sub(squared_sum_over_count as u64).saturating_mul(WEIGHTS[channel].into())
}

/// Weighted mean color, rounded.
fn mean_color(cluster: &[WeightedColor]) -> Color {
    std::array::from_fn(|channel| {
        let (sum, count) = sums(cluster, channel);
        (sum + count / 2).checked_div(count).unwrap_or(0) as u8
    })
}

/// Squared distance of two colors, weighted by channel.
fn distance(a: Color, b: Color) -> u32 {
    a.iter().zip(b).zip(WEIGHTS).map(|((a, b), weight)| weight * u32::from(a.abs_diff(b)).pow(2)).sum()
}
