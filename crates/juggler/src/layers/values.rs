//! From what a film keeps to what files hold.

use super::{Aov, LayerSet, cryptomatte};
use juggler_camera::film::{Extras, Rect, Statistics, Tile};
use juggler_camera::layer::{Beside, Layer, LightGroup};
use juggler_math::Rgb;

/// Which kind of mask tells what apart.
const OBJECTS: usize = 0;
const MATERIALS: usize = 1;
const SHAPES: usize = 2;

/// What is known of one pixel.
struct Pixel<'t> {
    set: &'t LayerSet,
    tile: &'t Tile,
    extras: &'t Extras,
    number: usize,
    count: f32,
}

impl LayerSet {
    /// The rows of a band from its tiles, channel after channel: red, green and blue of the picture itself if its rows are given,
    /// then those of [`LayerSet::headers`]. Pixels that no tile holds are 0.
    pub fn band(&self, band: &Rect, tiles: &[Tile], picture: Option<&[Rgb]>) -> Vec<Vec<f32>> {
        let mut layers = vec![vec![0.0; band.area() as usize]; self.channels];
        for tile in tiles {
            layers.iter_mut().zip(self.values(tile)).for_each(|(row, values)| tile.pixels().copy(&values, band, row));
        }
        picture.map(channels_of).into_iter().flatten().chain(layers).collect()
    }

    /// The pixels of a tile with the light of each group times its gain, by number; where all are 1, the bits of the picture.
    pub fn relit(&self, tile: &Tile, gains: &[Rgb]) -> Vec<Rgb> {
        let (extras, count) = (tile.extras(), tile.count().max(1) as f32);
        let mut pixels = tile.means();
        for (number, pixel) in pixels.iter_mut().enumerate() {
            let seen = Pixel { set: self, tile, extras: &extras, number, count };
            for (group, gain) in (0..).zip(gains).filter(|(_, gain)| **gain != Rgb::WHITE) {
                *pixel += seen.mean(Layer::Group(LightGroup(group))) * (*gain - Rgb::WHITE);
            }
            // What is switched off leaves no less than nothing.
            *pixel = pixel.map(|channel| channel.max(0.0));
        }
        pixels
    }

    /// What a tile shows: channel after channel, each pixel by pixel.
    fn values(&self, tile: &Tile) -> Vec<Vec<f32>> {
        let (extras, count) = (tile.extras(), tile.count().max(1) as f32);
        let mut channels: Vec<Vec<f32>> = vec![Vec::new(); self.channels];
        let mut row = Vec::with_capacity(channels.len());
        for number in 0..tile.pixels().area() as usize {
            let pixel = Pixel { set: self, tile, extras: &extras, number, count };
            row.clear();
            self.wanted.iter().for_each(|aov| pixel.put(*aov, &mut row));
            channels.iter_mut().zip(&row).for_each(|(channel, value)| channel.push(*value));
        }
        channels
    }
}

impl Pixel<'_> {
    /// Mean of a layer.
    fn mean(&self, layer: Layer) -> Rgb {
        self.sum(layer) / self.count
    }

    fn sum(&self, layer: Layer) -> Rgb {
        let planes = self.set.layers.planes.len();
        let place = self.set.layers.place(layer).and_then(|place| self.extras.planes.get(self.number * planes + place));
        place.copied().unwrap_or(Rgb::BLACK)
    }

    /// Mean of a layer's first two numbers over what its third says.
    fn known(&self, layer: Layer) -> impl Iterator<Item = f32> {
        let sum = self.sum(layer);
        over(sum, sum.b).into_iter().take(2)
    }

    /// How much of the pixel shows things, by rising number.
    fn shares(&self, kind: usize) -> Vec<(u32, f32)> {
        let mask = self.extras.masks.get(kind).map(|mask| mask.pixel(self.number)).unwrap_or_default();
        mask.iter().map(|(thing, sum)| (*thing, (sum / self.count).clamp(0.0, 1.0))).collect()
    }

    /// The number of what shows most, counted from 1; of several the first.
    fn most(&self, kind: usize) -> f32 {
        let shares = self.shares(kind);
        let most = shares.iter().filter(|(_, share)| *share > 0.0).reduce(|a, b| if b.1 > a.1 { b } else { a });
        most.map_or(0.0, |(thing, _)| *thing as f32 + 1.0)
    }

    fn put(&self, aov: Aov, row: &mut Vec<f32>) {
        match aov {
            Aov::Alpha => row.push(self.mean(Layer::Coverage).r),
            Aov::Albedo => row.extend(self.mean(Layer::Albedo).to_array()),
            Aov::Normal => row.extend(self.mean(Layer::Normal).to_array()),
            Aov::GeometricNormal => row.extend(self.mean(Layer::GeometricNormal).to_array()),
            Aov::Depth => {
                let Rgb { r, g, .. } = self.sum(Layer::Depth);
                row.push(if g > 0.0 { r / g } else { f32::INFINITY });
            }
            Aov::Position => row.extend(over(self.sum(Layer::Position), self.sum(Layer::Coverage).r)),
            Aov::Uv => row.extend(self.known(Layer::Uv)),
            Aov::Motion => row.extend(self.known(Layer::Motion(Beside::Next))),
            Aov::MotionBack => row.extend(self.known(Layer::Motion(Beside::Previous))),
            Aov::Emission => row.extend(self.mean(Layer::Emission).to_array()),
            Aov::Direct => row.extend(self.mean(Layer::Direct).to_array()),
            Aov::Indirect => row.extend(self.mean(Layer::Indirect).to_array()),
            Aov::LightGroups => {
                for (number, _) in (0..).zip(&self.set.names.light_groups) {
                    row.extend(self.mean(Layer::Group(LightGroup(number))).to_array());
                }
            }
            Aov::ObjectId => row.push(self.most(OBJECTS)),
            Aov::MaterialId => row.push(self.most(MATERIALS)),
            Aov::InstanceId => row.push(self.most(SHAPES)),
            Aov::CryptoObject => cryptomatte::put(self.shares(OBJECTS), |number| self.set.names.object(number), row),
            Aov::CryptoMaterial => {
                cryptomatte::put(self.shares(MATERIALS), |number| self.set.names.material(number), row);
            }
            Aov::Samples => row.push(self.count),
            Aov::Variance => {
                let Statistics { variance, blocks, .. } = self.tile.statistics(self.number);
                row.extend(variance.map(|value| if blocks < 2 { f32::INFINITY } else { value as f32 }));
            }
            Aov::NotFinite => row.push(self.sum(Layer::Coverage).g),
            Aov::Clamped => row.push(self.sum(Layer::Coverage).b),
        }
    }
}

/// Red, green and blue of all pixels.
fn channels_of(pixels: &[Rgb]) -> Vec<Vec<f32>> {
    (0..3).map(|channel| pixels.iter().map(|pixel| pixel.to_array()[channel]).collect()).collect()
}

/// A mean over what shows anything; nothing where nothing does.
fn over(sum: Rgb, weight: f32) -> [f32; 3] {
    if weight > 0.0 { (sum / weight).to_array() } else { [0.0; 3] }
}
