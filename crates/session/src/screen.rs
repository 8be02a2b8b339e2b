//! Linear light → what a screen shows. Pure work on pixels, on the current rayon pool where it is much.

use juggler::camera::film::{Film, Tile};
use juggler::imaging::tone::{AnyCurve, Linear, Quantizer};
use juggler::imaging::{Primaries, Tone};
use juggler::math::Rgb;
use rayon::prelude::*;
use std::sync::Arc;

/// Pixels that are worth a thread's trip.
const PIECE: usize = 1 << 14;
/// Relative error that channel noise shows as white.
const MOST_NOISE: f64 = 0.1;

/// Shows values as they are, 0 to 1: for what is not light.
pub const PLAIN: Tone = Tone::new(AnyCurve::Linear(Linear {}));

/// From linear light to bytes of the screen. Costs a millisecond to make, and nothing to copy.
#[derive(Clone)]
pub struct Toner {
    tone: Tone,
    quantizer: Arc<Quantizer>,
}

impl Toner {
    /// By a tone. Screens are taken for sRGB, whatever the primaries of a file.
    pub fn new(tone: &Tone) -> Self {
        let shown = Tone { primaries: Primaries::Srgb, ..tone.clone() };
        Self { tone: tone.clone(), quantizer: Arc::new(Quantizer::new(&shown, 255)) }
    }

    /// One for this tone: itself, if it is.
    #[must_use]
    pub fn toned(&self, tone: &Tone) -> Self {
        if self.tone == *tone { self.clone() } else { Self::new(tone) }
    }

    /// One pixel: red, green, blue, opaque.
    pub fn rgba(&self, pixel: Rgb) -> [u8; 4] {
        let [r, g, b] = self.quantizer.levels(pixel).map(|level| level as u8);
        [r, g, b, 255]
    }

    /// A whole picture.
    pub fn picture(&self, pixels: &[Rgb]) -> Vec<u8> {
        let mut rgba = vec![0; pixels.len() * 4];
        rgba.par_chunks_mut(PIECE * 4).zip(pixels.par_chunks(PIECE)).for_each(|(rgba, pixels)| {
            for (target, pixel) in rgba.chunks_exact_mut(4).zip(pixels) {
                target.copy_from_slice(&self.rgba(*pixel));
            }
        });
        rgba
    }
}

/// A picture that waits for the film: coarse pixels, perhaps.
#[derive(Clone, Debug, Default)]
pub struct Draft {
    /// Width and height of its pixels.
    pub size: [u32; 2],
    /// Linear light, row by row from the top.
    pub pixels: Vec<Rgb>,
}

impl Draft {
    /// What it shows at a pixel of a picture of size `of`.
    pub fn at(&self, [x, y]: [u32; 2], of: [u32; 2]) -> Rgb {
        let place = |at: u32, of: u32, size: u32| (u64::from(at) * u64::from(size) / u64::from(of.max(1))) as usize;
        let (column, row) = (place(x, of[0], self.size[0]), place(y, of[1], self.size[1]));
        self.pixels.get(row * self.size[0] as usize + column).copied().unwrap_or(Rgb::BLACK)
    }
}

/// A picture on a screen that becomes better tile by tile.
pub struct Canvas {
    size: [u32; 2],
    rgba: Vec<u8>,
    /// Samples that each tile showed when it was last painted.
    shown: Vec<u32>,
}

impl Canvas {
    /// Shows a draft.
    pub fn new(draft: &Draft, size: [u32; 2], toner: &Toner) -> Self {
        let [width, height] = size;
        let coarse = toner.picture(&draft.pixels);
        if draft.size == size {
            return Self { size, rgba: coarse, shown: Vec::new() };
        }
        let mut rgba = Vec::with_capacity(width as usize * height as usize * 4);
        let place = |at: u32, of: u32, size: u32| (u64::from(at) * u64::from(size) / u64::from(of.max(1))) as usize;
        let columns: Vec<usize> = (0..width).map(|x| place(x, width, draft.size[0])).collect();
        for y in 0..height {
            let row = place(y, height, draft.size[1]) * draft.size[0] as usize;
            for column in &columns {
                let at = (row + column) * 4;
                rgba.extend_from_slice(coarse.get(at..at + 4).unwrap_or(&[0, 0, 0, 255]));
            }
        }
        Self { size, rgba, shown: Vec::new() }
    }

    /// Paints the tiles of a film of the whole picture that have become better and have at least `least` samples; with 0,
    /// those too that have none.
    pub fn paint(&mut self, film: &Film, least: u32, pixel: impl Fn(&Tile) -> Vec<[u8; 4]>) {
        self.shown.resize(film.len(), u32::MAX);
        for place in 0..film.len() {
            let Some(tile) = film.tile(place) else { continue };
            let count = tile.count();
            if count < least || self.shown.get(place) == Some(&count) {
                continue;
            }
            let (pixels, area) = (pixel(&tile), tile.pixels());
            drop(tile);
            for (row, line) in pixels.chunks_exact(area.width.max(1) as usize).enumerate() {
                let start = ((area.y as usize + row) * self.size[0] as usize + area.x as usize) * 4;
                if let Some(target) = self.rgba.get_mut(start..start + line.len() * 4) {
                    target.copy_from_slice(line.as_flattened());
                }
            }
            if let Some(shown) = self.shown.get_mut(place) {
                *shown = count;
            }
        }
    }

    /// The bytes for a frame.
    pub fn rgba(&self) -> &[u8] {
        &self.rgba
    }
}

/// Light, pixel by pixel.
pub fn light(toner: &Toner, pixels: Vec<Rgb>) -> Vec<[u8; 4]> {
    pixels.into_iter().map(|pixel| toner.rgba(pixel)).collect()
}

/// How many of the samples `wanted` a tile has, as a grey.
pub fn samples(tile: &Tile, wanted: u32) -> Vec<[u8; 4]> {
    let level = (u64::from(tile.count()) * 255 / u64::from(wanted.max(1))).min(255) as u8;
    vec![[level, level, level, 255]; tile.pixels().area() as usize]
}

/// The relative errors of a tile's pixels: black 0, white 10 % and more, and where nothing is known yet.
pub fn noise(tile: &Tile) -> Vec<[u8; 4]> {
    let level = |pixel: usize| {
        let error = relative_error(tile, pixel).unwrap_or(MOST_NOISE);
        (error / MOST_NOISE * 255.0).min(255.0) as u8
    };
    let pixels = (0..tile.pixels().area() as usize).map(level);
    pixels.map(|level| [level, level, level, 255]).collect()
}

/// The estimated relative error of a pixel, once there are two blocks of samples. Dark pixels are kept from infinity as
/// in [`Tile::relative_variance`].
pub fn relative_error(tile: &Tile, pixel: usize) -> Option<f64> {
    const DARK: f64 = 0.01;
    let known = tile.statistics(pixel);
    if known.blocks < 2 {
        return None;
    }
    let mean = |rgb: [f64; 3]| rgb.iter().sum::<f64>() / 3.0;
    Some((mean(known.variance) / (mean(known.mean).powi(2) + DARK)).sqrt())
}

/// The estimated relative error of a picture, the root mean square over its pixels; nothing before all its tiles have
/// 64 samples.
pub fn noise_of(film: &Film) -> Option<f32> {
    let (mut sum, mut pixels) = (0.0, 0.0);
    for place in 0..film.len() {
        let tile = film.tile(place)?;
        if tile.count() < 64 {
            return None;
        }
        let area = tile.pixels().area() as f64;
        sum += tile.relative_variance()? * area;
        pixels += area;
    }
    (pixels > 0.0).then(|| (sum / pixels).sqrt() as f32)
}

/// Which share of the light of a picture clamping has taken away, from 0 to 1.
pub fn clamped_of(film: &Film) -> f32 {
    let tiles = (0..film.len()).filter_map(|place| film.tile(place));
    let mean = |light: Rgb| f64::from(light.r + light.g + light.b) / 3.0;
    let left: f64 = tiles.map(|tile| tile.means().into_iter().map(mean).sum::<f64>()).sum();
    let taken = film.clamped().total();
    let all = left + taken;
    if all > 0.0 { (taken / all).clamp(0.0, 1.0) as f32 } else { 0.0 }
}

/// A colour of its own for each number.
pub fn color_of(number: u32) -> Rgb {
    let mut bits = u64::from(number).wrapping_add(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^= bits >> 31;
    let channel = |shift: u32| 0.2 + 0.8 * ((bits >> shift & 0xff) as f32 / 255.0);
    Rgb::new(channel(0), channel(8), channel(16))
}
