//! Images as statistical estimates: means and their variances, from films.

use juggler_camera::film::{BLOCK_SAMPLES, Film, PixelStatistics, Rect, Tile};
use juggler_imaging::significance::NoisyImage;
use juggler_math::Rgb;

/// Estimates the pixels of an image from its tiles; pixels without a tile stay unknown.
pub fn from_tiles(region: Rect, tiles: impl IntoIterator<Item = Tile>) -> NoisyImage {
    let mut estimate = empty(region);
    tiles.into_iter().for_each(|tile| add(&mut estimate, region, &tile));
    estimate
}

/// Estimates the pixels of a film.
pub fn from_film(film: &Film) -> NoisyImage {
    from_tiles(film.tiling().region(), film.tiles().map(|(_, tile)| tile))
}

/// Returns an estimate whose pixels are all unknown: their variance is infinite.
pub fn empty(region: Rect) -> NoisyImage {
    let Rect { width, height, .. } = region;
    let count = region.area() as usize;
    let variance = vec![Rgb::splat(f32::INFINITY); count];
    NoisyImage { width, height, mean: vec![Rgb::BLACK; count], variance, blocks: vec![0; count] }
}

/// Adds the estimates of a tile's pixels.
pub fn add(estimate: &mut NoisyImage, region: Rect, tile: &Tile) {
    let area = tile.pixels();
    let (mut variance, mut blocks) = (Vec::new(), Vec::new());
    for place in 0..area.area() as usize {
        let PixelStatistics { variance: [r, g, b], blocks: own, .. } = tile.statistics(place);
        variance.push(variance_of_mean(Rgb::new(r as f32, g as f32, b as f32), own, tile.samples_per_pixel()));
        blocks.push(own);
    }
    area.copy_into(&tile.means(), &region, &mut estimate.mean);
    area.copy_into(&variance, &region, &mut estimate.variance);
    area.copy_into(&blocks, &region, &mut estimate.blocks);
}

/// Converts the variance of the mean of all complete blocks to that of all samples; infinite for
/// fewer than two blocks.
pub fn variance_of_mean(variance: Rgb, blocks: u32, samples: u32) -> Rgb {
    if blocks < 2 {
        return Rgb::splat(f32::INFINITY);
    }
    variance * (blocks as f32 * BLOCK_SAMPLES as f32 / samples.max(1) as f32)
}
