//! The page's side: assembles the workers' tiles into an image for display, hashing and saving.

use crate::pixel_rects::{PIXEL_VALUES, PixelRects};
use juggler::camera::film::{FilmDigest, Rect, TILE_EDGE, Tiling};
use juggler::imaging::output::Destination;
use juggler::imaging::{Header, ImageFormat, Tone, writer};
use juggler::math::{PixelRows, Rgb};
use juggler_session::screen::DisplayTransform;
use serde::{Deserialize, Serialize};
use std::io::{self, Write};
use std::sync::{Arc, Mutex, PoisonError};

/// Description of the image that the workers render.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RenderInfo {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Number of samples per pixel of the finished image.
    pub samples: u32,
    /// Conversion from linear radiance to the display and to files.
    pub tone: Tone,
    /// Whether the image has alpha.
    pub transparent: bool,
    /// Metadata of the image file.
    pub metadata: Vec<(String, String)>,
}

/// Framebuffer with linear radiance, its alpha, and its display pixels.
#[derive(Default)]
struct Framebuffer {
    size: [u32; 2],
    radiance: Vec<Rgb>,
    alpha: Vec<f32>,
    rgba: Vec<u8>,
}

impl Framebuffer {
    fn new([width, height]: [u32; 2]) -> Self {
        let pixels = width as usize * height as usize;
        let (radiance, alpha) = (vec![Rgb::BLACK; pixels], vec![1.0; pixels]);
        Self { size: [width, height], radiance, alpha, rgba: [0, 0, 0, 255].repeat(pixels) }
    }

    /// Copies a rectangle of pixels; parts outside of the image are ignored.
    fn copy_rect(&mut self, pixels: Rect, radiance: &[f32], transform: &DisplayTransform) {
        let [width, height] = self.size.map(|edge| edge as usize);
        let (x, columns) = (pixels.x as usize, pixels.width as usize);
        for (y, row) in (pixels.y as usize..height).zip(radiance.chunks_exact(PIXEL_VALUES * columns.max(1))) {
            let place = y * width + x..y * width + (x + columns).min(width);
            let (Some(colors), Some(alphas), Some(rgba)) = (
                self.radiance.get_mut(place.clone()),
                self.alpha.get_mut(place.clone()),
                self.rgba.get_mut(4 * place.start..4 * place.end),
            ) else {
                return;
            };
            let own = colors.iter_mut().zip(alphas).zip(rgba.as_chunks_mut::<4>().0);
            let values = own.zip(row.as_chunks::<PIXEL_VALUES>().0).zip(pixels.x..);
            for ((((color, own_alpha), rgba), [r, g, b, alpha]), x) in values {
                (*color, *own_alpha) = (Rgb::new(*r, *g, *b), *alpha);
                *rgba = transform.rgba_over(*color, *alpha, [x, y as u32]);
            }
        }
    }

    /// All pixels, with alpha if the image has it.
    fn rows(&self, transparent: bool) -> PixelRows<'_> {
        PixelRows { colors: &self.radiance, alpha: transparent.then_some(&self.alpha) }
    }

    fn redisplay(&mut self, transform: &DisplayTransform) {
        let width = self.size[0].max(1) as usize;
        let pixels = self.rgba.as_chunks_mut::<4>().0.iter_mut().zip(&self.radiance).zip(&self.alpha);
        for (number, ((rgba, radiance), alpha)) in pixels.enumerate() {
            *rgba = transform.rgba_over(*radiance, *alpha, [number % width, number / width].map(|place| place as u32));
        }
    }
}

/// Image under construction.
pub struct Compositor {
    info: RenderInfo,
    transform: DisplayTransform,
    film: Framebuffer,
    coarse: Framebuffer,
    /// Number of samples of each tile.
    samples: Vec<u32>,
    tiling: Tiling,
}

impl Compositor {
    /// Creates a compositor for an image, described by an [`RenderInfo`] in JSON.
    pub fn new(info: &str) -> Result<Self, String> {
        let info: RenderInfo = serde_json::from_str(info).map_err(|error| error.to_string())?;
        let [width, height] = info.size;
        let tiling = Tiling::new(Rect { x: 0, y: 0, width, height });
        Ok(Self {
            transform: DisplayTransform::new(&info.tone),
            film: Framebuffer::new(info.size),
            coarse: Framebuffer::default(),
            samples: vec![0; usize::try_from(tiling.tile_count()).unwrap_or_default()],
            tiling,
            info,
        })
    }

    /// Adopts another description that keeps the samples so far: another tone, or more samples.
    pub fn resume(&mut self, info: &str) -> Result<(), String> {
        let info: RenderInfo = serde_json::from_str(info).map_err(|error| error.to_string())?;
        if info.tone != self.info.tone {
            self.transform = self.transform.for_tone(&info.tone);
            self.film.redisplay(&self.transform);
            self.coarse.redisplay(&self.transform);
        }
        // The framebuffer keeps its size.
        self.info = RenderInfo { size: self.info.size, ..info };
        Ok(())
    }

    /// Starts over after a camera motion with a coarse frame of this size; no tile has samples.
    pub fn restart(&mut self, coarse: [u32; 2]) {
        self.samples.fill(0);
        self.film.radiance.fill(Rgb::BLACK);
        if self.coarse.size != coarse {
            self.coarse = Framebuffer::new(coarse);
        }
    }

    /// Copies rows of the coarse frame.
    pub fn add_coarse_rows(&mut self, rects: &PixelRects) {
        for (pixels, _, radiance) in rects.iter() {
            self.coarse.copy_rect(pixels, radiance, &self.transform);
        }
    }

    /// Copies tiles of the image.
    pub fn add_tiles(&mut self, rects: &PixelRects) {
        for (pixels, samples, radiance) in rects.iter() {
            self.film.copy_rect(pixels, radiance, &self.transform);
            let tile =
                (pixels.y / TILE_EDGE) as usize * self.tiling.columns() as usize + (pixels.x / TILE_EDGE) as usize;
            if let Some(own) = self.samples.get_mut(tile) {
                *own = samples;
            }
        }
    }

    /// Returns x, y, width and height of each tile that has samples.
    pub fn tiles(&self) -> Vec<u32> {
        let rendered = self.samples.iter().zip(0..).filter(|(samples, _)| **samples > 0);
        let tiles = rendered.filter_map(|(_, number)| self.tiling.tile(number));
        tiles.flat_map(|tile| [tile.x, tile.y, tile.width, tile.height]).collect()
    }

    /// Returns the RGBA pixels of the image with alpha 255, row by row. Tiles without samples keep
    /// their previous pixels.
    pub fn rgba(&self) -> &[u8] {
        &self.film.rgba
    }

    /// Returns the RGBA pixels of the coarse frame.
    pub fn coarse_rgba(&self) -> &[u8] {
        &self.coarse.rgba
    }

    /// Returns the mean number of samples per pixel over all tiles.
    pub fn samples(&self) -> f64 {
        let sum: f64 = self.samples.iter().map(|samples| f64::from(*samples)).sum();
        sum / self.samples.len().max(1) as f64
    }

    /// Returns whether every tile has all its samples.
    pub fn is_finished(&self) -> bool {
        self.samples.iter().all(|samples| *samples >= self.info.samples)
    }

    /// Returns the hash of the finished image, equal to that of `juggler render`; `None` before it
    /// is finished.
    pub fn hash(&self) -> Option<String> {
        let [width, height] = self.info.size;
        let mut digest = FilmDigest::new(width, height);
        digest.update(self.film.rows(self.info.transparent));
        self.is_finished().then(|| digest.finish().hash)
    }

    /// Encodes the image as a PNG file with the samples so far. The finished file equals that of
    /// `juggler render`.
    pub fn png(&self) -> Result<Vec<u8>, String> {
        let [width, height] = self.info.size;
        let RenderInfo { tone, transparent, metadata, .. } = self.info.clone();
        let header = Header { tone, transparent, metadata, ..Header::new(width, height) };
        let bytes = SharedBuffer::default();
        let failed = |error: juggler::imaging::ImageError| error.to_string();
        let mut rows =
            writer(ImageFormat::Png, Destination::stream("the picture", bytes.clone()), &header).map_err(failed)?;
        rows.write_rows(self.film.rows(transparent)).map_err(failed)?;
        rows.finish().map_err(failed)?;
        Ok(bytes.take())
    }
}

/// In-memory file that can be taken from its writer.
#[derive(Clone, Default)]
struct SharedBuffer(Arc<Mutex<Vec<u8>>>);

impl SharedBuffer {
    fn take(&self) -> Vec<u8> {
        std::mem::take(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

impl Write for SharedBuffer {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[cfg(test)]
pub mod tests {
    use super::*;

    /// Creates a compositor for a picture.
    pub fn compositor_of(picture: &juggler::Picture) -> Compositor {
        Compositor::new(&serde_json::to_string(&crate::renderer::render_info(picture)).unwrap()).unwrap()
    }

    fn info(samples: u32) -> String {
        let tone = Tone::default();
        serde_json::to_string(&RenderInfo { size: [20, 17], samples, tone, transparent: false, metadata: Vec::new() })
            .unwrap()
    }

    fn rect(x: u32, y: u32, width: u32, height: u32, samples: u32, radiance: f32) -> PixelRects {
        let (pixels, mut rects) = (Rect { x, y, width, height }, PixelRects::default());
        rects.push(pixels, samples, &vec![Rgb::splat(radiance); pixels.area() as usize]);
        rects
    }

    #[test]
    fn a_picture_is_finished_when_all_tiles_have_their_samples() {
        let mut compositor = Compositor::new(&info(4)).unwrap();
        for (x, y, width, height) in [(0, 0, 16, 16), (16, 0, 4, 16), (0, 16, 16, 1)] {
            compositor.add_tiles(&rect(x, y, width, height, 4, 1.0));
        }
        assert_eq!((compositor.samples(), compositor.hash()), (3.0, None));
        compositor.add_tiles(&rect(16, 16, 4, 1, 2, 0.25));
        assert_eq!(compositor.hash(), None);
        compositor.add_tiles(&rect(16, 16, 4, 1, 4, 0.5));
        let mut digest = FilmDigest::new(20, 17);
        let pixel = |i: usize| Rgb::splat(if i / 20 == 16 && i % 20 >= 16 { 0.5 } else { 1.0 });
        digest.update(&(0..20 * 17).map(pixel).collect::<Vec<_>>());
        assert_eq!(compositor.hash(), Some(digest.finish().hash));
        assert_eq!((&compositor.rgba()[..4], compositor.rgba()[4 * (20 * 17 - 1)]), ([255; 4].as_slice(), 188));
        assert_eq!(compositor.tiles(), [0, 0, 16, 16, 16, 0, 4, 16, 0, 16, 16, 1, 16, 16, 4, 1]);
        compositor.restart([5, 5]);
        assert_eq!((compositor.samples(), compositor.tiles().len(), compositor.hash()), (0.0, 0, None));
    }

    #[test]
    fn saved_png_contains_the_received_tiles() {
        let mut compositor = Compositor::new(&info(1)).unwrap();
        compositor.add_tiles(&rect(0, 0, 16, 16, 1, 0.5));
        let limits = juggler::imaging::Limits::default();
        let image = juggler::imaging::decode("saved.png", io::Cursor::new(compositor.png().unwrap()), &limits).unwrap();
        assert_eq!((image.width(), image.height()), (20, 17));
        assert!((image.pixels()[0].r - 0.5).abs() < 0.01 && image.pixels()[19].r == 0.0);
    }

    #[test]
    fn changed_exposure_keeps_the_radiance() {
        let mut compositor = Compositor::new(&info(1)).unwrap();
        compositor.add_tiles(&rect(0, 0, 16, 16, 1, 0.25));
        let before = compositor.rgba()[0];
        let brighter = info(1).replace("\"exposure_stops\":0.0", "\"exposure_stops\":2.0");
        compositor.resume(&brighter).unwrap();
        assert!(before < 255 && compositor.rgba()[0] == 255, "{before}");
        assert_eq!(compositor.film.radiance[0], Rgb::splat(0.25));
    }

    #[test]
    fn rectangles_that_do_not_fit_are_left_out() {
        let mut compositor = Compositor::new(&info(1)).unwrap();
        for (x, y, width, height) in [(18, 0, 16, 16), (0, 17, 16, 16), (u32::MAX, 0, 1, 1), (0, u32::MAX, 1, 1)] {
            compositor.add_tiles(&rect(x, y, width, height, 1, 1.0));
        }
        compositor.add_tiles(&PixelRects { bounds: vec![0, 0, u32::MAX, u32::MAX, 1, 0], radiance: vec![1.0; 5] });
        assert_eq!(compositor.rgba()[4 * 18..4 * 20], [255; 8], "as far as it lies on the picture");
        assert_eq!(compositor.rgba()[..4], [0, 0, 0, 255]);
    }
}
