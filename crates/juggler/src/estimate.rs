//! Pictures as estimates of what they would be without noise: means and their variances, from films.

use juggler_camera::film::{BLOCK, Film, Rect, Statistics, Tile};
use juggler_imaging::significance::Estimate;
use juggler_math::Rgb;

/// What the tiles of a picture know of it; pixels that no tile holds are not known.
pub fn of_tiles(region: Rect, tiles: impl IntoIterator<Item = Tile>) -> Estimate {
    let mut estimate = empty(region);
    tiles.into_iter().for_each(|tile| add(&mut estimate, region, &tile));
    estimate
}

/// What a film knows of its picture.
pub fn of_film(film: &Film) -> Estimate {
    of_tiles(film.layout().region(), film.tiles().map(|(_, tile)| tile))
}

/// Of which nothing is known yet.
pub fn empty(region: Rect) -> Estimate {
    let Rect { width, height, .. } = region;
    let count = region.area() as usize;
    let variance = vec![Rgb::splat(f32::INFINITY); count];
    Estimate { width, height, mean: vec![Rgb::BLACK; count], variance, blocks: vec![0; count] }
}

/// Adds what a tile of that region knows.
pub fn add(estimate: &mut Estimate, region: Rect, tile: &Tile) {
    let area = tile.pixels();
    let (mut variance, mut blocks) = (Vec::new(), Vec::new());
    for place in 0..area.area() as usize {
        let Statistics { variance: [r, g, b], blocks: own, .. } = tile.statistics(place);
        variance.push(of_mean(Rgb::new(r as f32, g as f32, b as f32), own, tile.count()));
        blocks.push(own);
    }
    area.copy(&tile.means(), &region, &mut estimate.mean);
    area.copy(&variance, &region, &mut estimate.variance);
    area.copy(&blocks, &region, &mut estimate.blocks);
}

/// The variance of the mean of all samples, where that of whole blocks is known.
pub fn of_mean(variance: Rgb, blocks: u32, samples: u32) -> Rgb {
    if blocks < 2 {
        return Rgb::splat(f32::INFINITY);
    }
    variance * (blocks as f32 * BLOCK as f32 / samples.max(1) as f32)
}
