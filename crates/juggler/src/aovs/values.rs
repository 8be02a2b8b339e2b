//! Conversion of the film's sums to AOV channels.

use super::{Aov, AovSet, cryptomatte};
use juggler_camera::aov::{AdjacentFrame, FilmAov, LightGroup};
use juggler_camera::film::{AovSums, PixelStatistics, Rect, Tile};
use juggler_imaging::layered;
use juggler_math::{PixelRows, Rgb};

/// Indices of the film's coverage masks.
const OBJECTS: usize = 0;
const MATERIALS: usize = 1;
const SHAPES: usize = 2;

/// Film data of one pixel.
struct Pixel<'t> {
    set: &'t AovSet,
    tile: &'t Tile,
    aov_sums: &'t AovSums,
    /// Index of the pixel in the tile, row by row.
    number: usize,
    /// Number of samples of the pixel.
    count: f32,
}

impl AovSet {
    /// Returns the channels of a band from its tiles: red, green, blue and perhaps alpha of the
    /// rendered image if given, then those of [`AovSet::headers`]. Pixels without a tile are 0.
    pub fn band_values(&self, band: &Rect, tiles: &[Tile], picture: Option<PixelRows>) -> Vec<Vec<f32>> {
        let mut channels = vec![vec![0.0; band.area() as usize]; self.channels];
        for tile in tiles {
            channels
                .iter_mut()
                .zip(self.values(tile))
                .for_each(|(row, values)| tile.pixels().copy_into(&values, band, row));
        }
        picture.map(layered::channels).into_iter().flatten().chain(channels).collect()
    }

    /// Returns a tile's pixels with each light group scaled by its gain; `gains` are in the order
    /// of the light groups. If all gains are 1, the pixels equal those of the film bit for bit.
    pub fn relight(&self, tile: &Tile, gains: &[Rgb]) -> Vec<Rgb> {
        let (aov_sums, count) = (tile.aov_sums(), tile.samples_per_pixel().max(1) as f32);
        let mut pixels = tile.means();
        for (number, pixel) in pixels.iter_mut().enumerate() {
            let data = Pixel { set: self, tile, aov_sums: &aov_sums, number, count };
            for (group, gain) in (0..=u16::MAX).zip(gains).filter(|(_, gain)| **gain != Rgb::WHITE) {
                *pixel += data.mean(FilmAov::Group(LightGroup(group))) * (*gain - Rgb::WHITE);
            }
            // Rounding may leave small negative values.
            *pixel = pixel.map(|channel| channel.max(0.0));
        }
        pixels
    }

    /// Returns alpha of the pixels of a band from its tiles, 0 to 1; `None` if the picture is opaque.
    /// Pixels without a tile are transparent.
    pub fn alpha(&self, band: &Rect, tiles: &[Tile]) -> Option<Vec<f32>> {
        let mut alpha = self.transparent.then(|| vec![0.0; band.area() as usize])?;
        for tile in tiles {
            let values: Vec<f32> = self.coverage(tile)?.iter().map(Coverage::alpha).collect();
            tile.pixels().copy_into(&values, band, &mut alpha);
        }
        Some(alpha)
    }

    /// What the pixels of a tile see; `None` if the picture is opaque.
    pub(crate) fn coverage(&self, tile: &Tile) -> Option<Vec<Coverage>> {
        let (aov_sums, count) = (tile.aov_sums(), tile.samples_per_pixel().max(1) as f32);
        let of_pixel = |number| Pixel { set: self, tile, aov_sums: &aov_sums, number, count }.coverage();
        self.transparent.then(|| (0..tile.pixels().area() as usize).map(of_pixel).collect())
    }

    /// Returns the channels of a tile, each with its pixels row by row.
    fn values(&self, tile: &Tile) -> Vec<Vec<f32>> {
        let (aov_sums, count) = (tile.aov_sums(), tile.samples_per_pixel().max(1) as f32);
        let mut channels: Vec<Vec<f32>> = vec![Vec::new(); self.channels];
        let mut row = Vec::with_capacity(channels.len());
        for number in 0..tile.pixels().area() as usize {
            let pixel = Pixel { set: self, tile, aov_sums: &aov_sums, number, count };
            row.clear();
            self.aovs.iter().for_each(|aov| pixel.append(*aov, &mut row));
            channels.iter_mut().zip(&row).for_each(|(channel, value)| channel.push(*value));
        }
        channels
    }
}

/// What a pixel of a transparent picture sees. All weights are sums over the samples, so that alpha
/// is exactly 0 and 1 where all samples agree.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Coverage {
    /// Weight of objects.
    pub opaque: f32,
    /// Weight of the background.
    pub transmitted: f32,
    /// Weight of shadow catchers.
    pub caught: f32,
    /// Fraction of the light that shadow catchers lose, 0 to 1.
    pub lost: f32,
}

impl Coverage {
    /// Alpha: the fraction of the samples that see objects, and of the samples that see shadow
    /// catchers the fraction of the light that these lose.
    pub fn alpha(&self) -> f32 {
        let all = self.opaque + self.transmitted + self.caught;
        if all > 0.0 { ((self.opaque + self.caught * self.lost) / all).clamp(0.0, 1.0) } else { 0.0 }
    }
}

impl Pixel<'_> {
    /// Returns the mean of an AOV over all samples.
    fn mean(&self, aov: FilmAov) -> Rgb {
        self.sum(aov) / self.count
    }

    /// Returns the sum of an AOV over all samples; black if the film has no such AOV.
    fn sum(&self, aov: FilmAov) -> Rgb {
        let planes = self.set.film_aovs.planes.len();
        let place =
            self.set.film_aovs.index_of(aov).and_then(|place| self.aov_sums.planes.get(self.number * planes + place));
        place.copied().unwrap_or(Rgb::BLACK)
    }

    fn coverage(&self) -> Coverage {
        let Rgb { r: opaque, g: transmitted, b: caught } = self.sum(FilmAov::Alpha);
        let Rgb { r: lit, g: unoccluded, .. } = self.sum(FilmAov::ShadowCatcher);
        let lost = if unoccluded > 0.0 { (1.0 - lit / unoccluded).clamp(0.0, 1.0) } else { 0.0 };
        Coverage { opaque, transmitted, caught, lost }
    }

    /// Returns the first two channels of an AOV, averaged over the valid samples, which its third
    /// channel counts.
    fn mean_of_valid(&self, aov: FilmAov) -> impl Iterator<Item = f32> {
        let sum = self.sum(aov);
        divide(sum, sum.b).into_iter().take(2)
    }

    /// Returns the first channel of an AOV, averaged over the samples that hit a surface, which its
    /// second channel counts; infinity if none does.
    fn mean_distance(&self, aov: FilmAov) -> f32 {
        let Rgb { r, g, .. } = self.sum(aov);
        if g > 0.0 { r / g } else { f32::INFINITY }
    }

    /// Returns the coverage by each object of a mask, in order of the objects' indices.
    fn coverages(&self, kind: usize) -> Vec<(u32, f32)> {
        let mask = self.aov_sums.masks.get(kind).map(|mask| mask.pixel(self.number)).unwrap_or_default();
        mask.iter().map(|(id, sum)| (*id, (sum / self.count).clamp(0.0, 1.0))).collect()
    }

    /// Returns the index, counted from 1, of the object with the largest coverage: the first if
    /// several coverages are equal, 0 if no object covers the pixel.
    fn dominant(&self, kind: usize) -> f32 {
        let coverages = self.coverages(kind);
        let dominant =
            coverages.iter().filter(|(_, coverage)| *coverage > 0.0).reduce(|a, b| if b.1 > a.1 { b } else { a });
        dominant.map_or(0.0, |(id, _)| *id as f32 + 1.0)
    }

    /// Appends the channels of an AOV to `row`.
    fn append(&self, aov: Aov, row: &mut Vec<f32>) {
        match aov {
            Aov::Alpha => row.push(self.mean(FilmAov::Coverage).r),
            Aov::Albedo => row.extend(self.mean(FilmAov::Albedo).to_array()),
            Aov::Normal => row.extend(self.mean(FilmAov::Normal).to_array()),
            Aov::GeometricNormal => row.extend(self.mean(FilmAov::GeometricNormal).to_array()),
            Aov::Depth => row.push(self.mean_distance(FilmAov::Depth)),
            Aov::PlanarDepth => row.push(self.mean_distance(FilmAov::PlanarDepth)),
            Aov::Position => row.extend(divide(self.sum(FilmAov::Position), self.sum(FilmAov::Coverage).r)),
            Aov::Uv => row.extend(self.mean_of_valid(FilmAov::Uv)),
            Aov::Motion => row.extend(self.mean_of_valid(FilmAov::Motion(AdjacentFrame::Next))),
            Aov::MotionBack => row.extend(self.mean_of_valid(FilmAov::Motion(AdjacentFrame::Previous))),
            Aov::Emission => row.extend(self.mean(FilmAov::Emission).to_array()),
            Aov::Direct => row.extend(self.mean(FilmAov::Direct).to_array()),
            Aov::Indirect => row.extend(self.mean(FilmAov::Indirect).to_array()),
            Aov::LightGroups => {
                for (number, _) in (0..=u16::MAX).zip(&self.set.names.light_groups) {
                    row.extend(self.mean(FilmAov::Group(LightGroup(number))).to_array());
                }
            }
            Aov::ObjectId => row.push(self.dominant(OBJECTS)),
            Aov::MaterialId => row.push(self.dominant(MATERIALS)),
            Aov::InstanceId => row.push(self.dominant(SHAPES)),
            Aov::CryptoObject => {
                cryptomatte::append(self.coverages(OBJECTS), |number| self.set.names.object(number), row);
            }
            Aov::CryptoMaterial => {
                cryptomatte::append(self.coverages(MATERIALS), |number| self.set.names.material(number), row);
            }
            Aov::Samples => row.push(self.count),
            Aov::Variance => {
                let PixelStatistics { variance, blocks, .. } = self.tile.statistics(self.number);
                row.extend(variance.map(|value| if blocks < 2 { f32::INFINITY } else { value as f32 }));
            }
            Aov::NotFinite => row.push(self.sum(FilmAov::Coverage).g),
            Aov::Clamped => row.push(self.sum(FilmAov::Coverage).b),
        }
    }
}

/// Divides a sum by the sum of weights; returns 0 if the latter is 0.
fn divide(sum: Rgb, weight: f32) -> [f32; 3] {
    if weight > 0.0 { (sum / weight).to_array() } else { [0.0; 3] }
}
