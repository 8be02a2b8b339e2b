//! Display transform from linear radiance to 8-bit pixels. Large images use the current rayon pool.

use juggler::camera::film::{Film, Rect, Tile};
use juggler::imaging::tone::{AnyCurve, Linear, Quantizer};
use juggler::imaging::{Primaries, Tone};
use juggler::math::{PixelRows, Rgb};
use rayon::prelude::*;
use std::sync::Arc;

/// Number of pixels per parallel task.
const TASK_PIXELS: usize = 1 << 14;
/// Relative error that the channel `noise` displays as white.
const WHITE_ERROR: f64 = 0.1;

/// Tone for channels that are no radiance: linear, values from 0 to 1.
pub const LINEAR_TONE: Tone = Tone::new(AnyCurve::Linear(Linear {}));

/// Edge of the squares behind transparent pixels, in pixels of the display.
const SQUARE: u32 = 8;
/// Linear grays of these squares: #999 and #666.
const SQUARE_GRAYS: [f32; 2] = [0.318_547, 0.132_868];

/// Display transform from linear radiance to 8-bit RGBA. Transparent pixels lie over the backdrop of the
/// tone, or over gray squares. Creation takes about a millisecond; clones share the tables.
#[derive(Clone)]
pub struct DisplayTransform {
    tone: Tone,
    /// For light and for dark squares; the same if the tone has a backdrop.
    quantizers: [Arc<Quantizer>; 2],
}

impl DisplayTransform {
    /// Creates the transform of a tone for an sRGB display, whatever the tone's file primaries.
    pub fn new(tone: &Tone) -> Self {
        let over = |backdrop: Rgb| {
            let srgb = Tone { primaries: Primaries::Srgb, backdrop: Some(backdrop), ..tone.clone() };
            Arc::new(Quantizer::new(&srgb, 255))
        };
        let quantizers = match tone.backdrop.map(over) {
            Some(one) => [Arc::clone(&one), one],
            None => SQUARE_GRAYS.map(|gray| over(Rgb::splat(gray))),
        };
        Self { tone: tone.clone(), quantizers }
    }

    /// Returns the transform of another tone; a clone if the tone is the same.
    #[must_use]
    pub fn for_tone(&self, tone: &Tone) -> Self {
        if self.tone == *tone { self.clone() } else { Self::new(tone) }
    }

    /// Transforms one opaque pixel to RGBA with alpha 255.
    pub fn rgba(&self, pixel: Rgb) -> [u8; 4] {
        self.rgba_over(pixel, 1.0, [0, 0])
    }

    /// Transforms one pixel, premultiplied by its alpha, at a column and row of the display.
    pub fn rgba_over(&self, pixel: Rgb, alpha: f32, [x, y]: [u32; 2]) -> [u8; 4] {
        let [light, dark] = &self.quantizers;
        let is_light = (x / SQUARE + y / SQUARE).is_multiple_of(2);
        let [r, g, b] = if is_light { light } else { dark }.levels_over(pixel, alpha).map(|level| level as u8);
        [r, g, b, 255]
    }

    /// Transforms all pixels of an image of a width.
    pub fn rgba_image(&self, rows: PixelRows, width: u32) -> Vec<u8> {
        let mut rgba = vec![0; rows.len() * 4];
        let width = width.max(1) as usize;
        let tasks = rgba.par_chunks_mut(TASK_PIXELS * 4).zip(rows.colors.par_chunks(TASK_PIXELS)).enumerate();
        tasks.for_each(|(task, (rgba, pixels))| {
            for (number, (target, pixel)) in (task * TASK_PIXELS..).zip(rgba.chunks_exact_mut(4).zip(pixels)) {
                let alpha = rows.alpha.and_then(|alpha| alpha.get(number)).copied().unwrap_or(1.0);
                let at = [number % width, number / width].map(|place| place as u32);
                target.copy_from_slice(&self.rgba_over(*pixel, alpha, at));
            }
        });
        rgba
    }
}

/// Preview image, displayed until the film has samples; it may have a lower resolution.
#[derive(Clone, Debug, Default)]
pub struct Preview {
    /// Width and height of `pixels`.
    pub size: [u32; 2],
    /// Linear radiance, row by row from the top.
    pub pixels: Vec<Rgb>,
    /// Alpha of the pixels, if the picture is transparent.
    pub alpha: Option<Vec<f32>>,
}

impl Preview {
    /// Returns color and alpha of the nearest preview pixel for a pixel of an image of size `of`.
    pub fn at(&self, [x, y]: [u32; 2], of: [u32; 2]) -> (Rgb, f32) {
        let place = |at: u32, of: u32, size: u32| (u64::from(at) * u64::from(size) / u64::from(of.max(1))) as usize;
        let (column, row) = (place(x, of[0], self.size[0]), place(y, of[1], self.size[1]));
        let pixel = row * self.size[0] as usize + column;
        let alpha = self.alpha.as_ref().and_then(|alpha| alpha.get(pixel)).copied();
        (self.pixels.get(pixel).copied().unwrap_or(Rgb::BLACK), alpha.unwrap_or(1.0))
    }

    /// The pixels with their alpha.
    pub fn rows(&self) -> PixelRows<'_> {
        PixelRows { colors: &self.pixels, alpha: self.alpha.as_deref() }
    }
}

/// RGBA image for display that is updated tile by tile.
pub struct Canvas {
    size: [u32; 2],
    rgba: Vec<u8>,
    /// Number of samples that each tile displays.
    painted_samples: Vec<u32>,
}

impl Canvas {
    /// Creates the image from a preview, scaled up to `size` by nearest neighbors.
    pub fn new(preview: &Preview, size: [u32; 2], transform: &DisplayTransform) -> Self {
        let [width, height] = size;
        let coarse = transform.rgba_image(preview.rows(), preview.size[0]);
        if preview.size == size {
            return Self { size, rgba: coarse, painted_samples: Vec::new() };
        }
        let mut rgba = Vec::with_capacity(width as usize * height as usize * 4);
        let place = |at: u32, of: u32, size: u32| (u64::from(at) * u64::from(size) / u64::from(of.max(1))) as usize;
        let columns: Vec<usize> = (0..width).map(|x| place(x, width, preview.size[0])).collect();
        for y in 0..height {
            let row = place(y, height, preview.size[1]) * preview.size[0] as usize;
            for column in &columns {
                let at = (row + column) * 4;
                rgba.extend_from_slice(coarse.get(at..at + 4).unwrap_or(&[0, 0, 0, 255]));
            }
        }
        Self { size, rgba, painted_samples: Vec::new() }
    }

    /// Repaints the tiles of the film that have new samples and at least `least` of them; 0
    /// includes tiles without samples.
    pub fn paint(&mut self, film: &Film, least: u32, pixel: impl Fn(&Tile) -> Vec<[u8; 4]>) {
        self.painted_samples.resize(film.len(), u32::MAX);
        for place in 0..film.len() {
            let Some(tile) = film.tile(place) else { continue };
            let count = tile.samples_per_pixel();
            if count < least || self.painted_samples.get(place) == Some(&count) {
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
            if let Some(painted) = self.painted_samples.get_mut(place) {
                *painted = count;
            }
        }
    }

    /// Returns the RGBA bytes for a frame.
    pub fn rgba(&self) -> &[u8] {
        &self.rgba
    }
}

/// Transforms the pixels of an area of the picture for display.
pub fn radiance_to_rgba(transform: &DisplayTransform, area: Rect, rows: PixelRows) -> Vec<[u8; 4]> {
    let places = (0..area.height).flat_map(|y| (0..area.width).map(move |x| [area.x + x, area.y + y]));
    let alpha = rows.alpha.unwrap_or_default().iter().copied().chain(std::iter::repeat(1.0));
    let pixels = rows.colors.iter().zip(alpha).zip(places);
    pixels.map(|((pixel, alpha), at)| transform.rgba_over(*pixel, alpha, at)).collect()
}

/// Returns the number of a tile's samples relative to `target`, as gray pixels.
pub fn samples(tile: &Tile, target: u32) -> Vec<[u8; 4]> {
    let level = (u64::from(tile.samples_per_pixel()) * 255 / u64::from(target.max(1))).min(255) as u8;
    vec![[level, level, level, 255]; tile.pixels().area() as usize]
}

/// Returns the relative errors of a tile's pixels: black is 0, white is 10 % or more, or unknown.
pub fn noise(tile: &Tile) -> Vec<[u8; 4]> {
    let level = |pixel: usize| {
        let error = relative_error(tile, pixel).unwrap_or(WHITE_ERROR);
        (error / WHITE_ERROR * 255.0).min(255.0) as u8
    };
    let pixels = (0..tile.pixels().area() as usize).map(level);
    pixels.map(|level| [level, level, level, 255]).collect()
}

/// Returns the estimated relative error of a pixel, or `None` for fewer than two blocks of samples.
/// A constant of 0.01 regularizes dark pixels as in [`Tile::relative_variance`].
pub fn relative_error(tile: &Tile, pixel: usize) -> Option<f64> {
    const DARK: f64 = 0.01;
    let known = tile.statistics(pixel);
    if known.blocks < 2 {
        return None;
    }
    let mean = |rgb: [f64; 3]| rgb.iter().sum::<f64>() / 3.0;
    Some((mean(known.variance) / (mean(known.mean).powi(2) + DARK)).sqrt())
}

/// Returns the estimated relative error of an image, the root mean square over its pixels, or
/// `None` before every tile has 64 samples.
pub fn relative_error_of_film(film: &Film) -> Option<f32> {
    let (mut sum, mut pixels) = (0.0, 0.0);
    for place in 0..film.len() {
        let tile = film.tile(place)?;
        if tile.samples_per_pixel() < 64 {
            return None;
        }
        let area = tile.pixels().area() as f64;
        sum += tile.relative_variance()? * area;
        pixels += area;
    }
    (pixels > 0.0).then(|| (sum / pixels).sqrt() as f32)
}

/// Returns the fraction of the image's radiance that clamping removed, 0 to 1.
pub fn clamped_fraction(film: &Film) -> f32 {
    let tiles = (0..film.len()).filter_map(|place| film.tile(place));
    let mean = |light: Rgb| f64::from(light.r + light.g + light.b) / 3.0;
    let left: f64 = tiles.map(|tile| tile.means().into_iter().map(mean).sum::<f64>()).sum();
    let removed = film.clamped().total();
    let all = left + removed;
    if all > 0.0 { (removed / all).clamp(0.0, 1.0) as f32 } else { 0.0 }
}

/// Hashes an index to a color with channels from 0.2 to 1.
pub fn index_color(number: u32) -> Rgb {
    let mut bits = u64::from(number).wrapping_add(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^= bits >> 31;
    let channel = |shift: u32| 0.2 + 0.8 * ((bits >> shift & 0xff) as f32 / 255.0);
    Rgb::new(channel(0), channel(8), channel(16))
}
