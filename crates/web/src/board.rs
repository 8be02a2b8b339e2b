//! The page's side: what the workers render is put together, shown, hashed and saved.

use crate::patches::Patches;
use juggler::camera::film::{Digest, Layout, Rect, TILE};
use juggler::imaging::output::Destination;
use juggler::imaging::{Format, Header, Tone, writer};
use juggler::math::Rgb;
use juggler_session::screen::Toner;
use serde::{Deserialize, Serialize};
use std::io::{self, Write};
use std::sync::{Arc, Mutex, PoisonError};

/// What a worker tells about the picture that it renders.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Outline {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Samples of a pixel in the end.
    pub samples: u32,
    /// From linear light to the screen.
    pub tone: Tone,
    /// Texts for the file.
    pub metadata: Vec<(String, String)>,
}

/// Pixels, and what of them is to be shown.
#[derive(Default)]
struct Sheet {
    size: [u32; 2],
    light: Vec<Rgb>,
    rgba: Vec<u8>,
}

impl Sheet {
    fn new([width, height]: [u32; 2]) -> Self {
        let pixels = width as usize * height as usize;
        Self { size: [width, height], light: vec![Rgb::BLACK; pixels], rgba: [0, 0, 0, 255].repeat(pixels) }
    }

    /// Takes pixels over; those beyond the edges are left out.
    fn put(&mut self, pixels: Rect, light: &[f32], toner: &Toner) {
        let [width, height] = self.size.map(|edge| edge as usize);
        let (x, columns) = (pixels.x as usize, pixels.width as usize);
        for (y, row) in (pixels.y as usize..height).zip(light.chunks_exact(3 * columns.max(1))) {
            let place = y * width + x..y * width + (x + columns).min(width);
            let (Some(own), Some(rgba)) =
                (self.light.get_mut(place.clone()), self.rgba.get_mut(4 * place.start..4 * place.end))
            else {
                return;
            };
            for ((own, new), rgba) in own.iter_mut().zip(row.as_chunks().0).zip(rgba.as_chunks_mut::<4>().0) {
                let [r, g, b] = *new;
                *own = Rgb::new(r, g, b);
                *rgba = toner.rgba(*own);
            }
        }
    }

    fn show(&mut self, toner: &Toner) {
        for (rgba, light) in self.rgba.as_chunks_mut::<4>().0.iter_mut().zip(&self.light) {
            *rgba = toner.rgba(*light);
        }
    }
}

/// A picture in the making.
pub struct Board {
    outline: Outline,
    toner: Toner,
    film: Sheet,
    coarse: Sheet,
    /// Of each tile.
    samples: Vec<u32>,
    layout: Layout,
}

impl Board {
    /// For the picture of this outline, in JSON.
    pub fn new(outline: &str) -> Result<Self, String> {
        let outline: Outline = serde_json::from_str(outline).map_err(|error| error.to_string())?;
        let [width, height] = outline.size;
        let layout = Layout::new(Rect { x: 0, y: 0, width, height });
        Ok(Self {
            toner: Toner::new(&outline.tone),
            film: Sheet::new(outline.size),
            coarse: Sheet::default(),
            samples: vec![0; usize::try_from(layout.tiles()).unwrap_or_default()],
            layout,
            outline,
        })
    }

    /// The picture has another outline, of which the samples so far are samples too: another tone, more samples.
    pub fn resume(&mut self, outline: &str) -> Result<(), String> {
        let outline: Outline = serde_json::from_str(outline).map_err(|error| error.to_string())?;
        if outline.tone != self.outline.tone {
            self.toner = self.toner.toned(&outline.tone);
            self.film.show(&self.toner);
            self.coarse.show(&self.toner);
        }
        // What a board's pixels are for does not change.
        self.outline = Outline { size: self.outline.size, ..outline };
        Ok(())
    }

    /// Begins anew with a coarse frame of this size, as the camera has moved: no tile has samples.
    pub fn begin(&mut self, coarse: [u32; 2]) {
        self.samples.fill(0);
        self.film.light.fill(Rgb::BLACK);
        if self.coarse.size != coarse {
            self.coarse = Sheet::new(coarse);
        }
    }

    /// Takes rows of the coarse frame.
    pub fn put_coarse(&mut self, patches: &Patches) {
        for (pixels, _, light) in patches.iter() {
            self.coarse.put(pixels, light, &self.toner);
        }
    }

    /// Takes tiles of the picture.
    pub fn put(&mut self, patches: &Patches) {
        for (pixels, samples, light) in patches.iter() {
            self.film.put(pixels, light, &self.toner);
            let tile = (pixels.y / TILE) as usize * self.layout.columns() as usize + (pixels.x / TILE) as usize;
            if let Some(own) = self.samples.get_mut(tile) {
                *own = samples;
            }
        }
    }

    /// The tiles with samples: x, y, width, height of each.
    pub fn tiles(&self) -> Vec<u32> {
        let seen = self.samples.iter().zip(0..).filter(|(samples, _)| **samples > 0);
        let tiles = seen.filter_map(|(_, number)| self.layout.tile(number));
        tiles.flat_map(|tile| [tile.x, tile.y, tile.width, tile.height]).collect()
    }

    /// Red, green, blue, opaque, 8 bits each: the picture, row by row. What has no samples is of before.
    pub fn rgba(&self) -> &[u8] {
        &self.film.rgba
    }

    /// The same of the coarse frame.
    pub fn coarse_rgba(&self) -> &[u8] {
        &self.coarse.rgba
    }

    /// Samples of a pixel: the mean over the tiles.
    pub fn samples(&self) -> f64 {
        let sum: f64 = self.samples.iter().map(|samples| f64::from(*samples)).sum();
        sum / self.samples.len().max(1) as f64
    }

    /// Whether every tile has its samples.
    pub fn is_finished(&self) -> bool {
        self.samples.iter().all(|samples| *samples >= self.outline.samples)
    }

    /// The hash of the finished film: that of `juggler render`.
    pub fn hash(&self) -> Option<String> {
        let [width, height] = self.outline.size;
        let mut digest = Digest::new(width, height);
        digest.update(&self.film.light);
        self.is_finished().then(|| digest.finish().hash)
    }

    /// The picture as a PNG file, with the samples that it has: when finished, the file that `juggler render` writes.
    pub fn png(&self) -> Result<Vec<u8>, String> {
        let [width, height] = self.outline.size;
        let Outline { tone, metadata, .. } = self.outline.clone();
        let header = Header { tone, metadata, ..Header::new(width, height) };
        let bytes = Bytes::default();
        let failed = |error: juggler::imaging::ImageError| error.to_string();
        let mut rows =
            writer(Format::Png, Destination::stream("the picture", bytes.clone()), &header).map_err(failed)?;
        rows.write_rows(&self.film.light).map_err(failed)?;
        rows.finish().map_err(failed)?;
        Ok(bytes.take())
    }
}

/// A file in memory that can be taken when its writer is gone.
#[derive(Clone, Default)]
struct Bytes(Arc<Mutex<Vec<u8>>>);

impl Bytes {
    fn take(&self) -> Vec<u8> {
        std::mem::take(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

impl Write for Bytes {
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

    /// A board for a picture.
    pub fn board_of(picture: &juggler::Picture) -> Board {
        Board::new(&serde_json::to_string(&crate::painter::outline(picture)).unwrap()).unwrap()
    }

    fn outline(samples: u32) -> String {
        let tone = Tone::default();
        serde_json::to_string(&Outline { size: [20, 17], samples, tone, metadata: Vec::new() }).unwrap()
    }

    fn patch(x: u32, y: u32, width: u32, height: u32, samples: u32, light: f32) -> Patches {
        let (pixels, mut patches) = (Rect { x, y, width, height }, Patches::default());
        patches.push(pixels, samples, &vec![Rgb::splat(light); pixels.area() as usize]);
        patches
    }

    #[test]
    fn a_picture_is_finished_when_all_tiles_have_their_samples() {
        let mut board = Board::new(&outline(4)).unwrap();
        for (x, y, width, height) in [(0, 0, 16, 16), (16, 0, 4, 16), (0, 16, 16, 1)] {
            board.put(&patch(x, y, width, height, 4, 1.0));
        }
        assert_eq!((board.samples(), board.hash()), (3.0, None));
        board.put(&patch(16, 16, 4, 1, 2, 0.25));
        assert_eq!(board.hash(), None);
        board.put(&patch(16, 16, 4, 1, 4, 0.5));
        let mut digest = Digest::new(20, 17);
        let pixel = |i: usize| Rgb::splat(if i / 20 == 16 && i % 20 >= 16 { 0.5 } else { 1.0 });
        digest.update(&(0..20 * 17).map(pixel).collect::<Vec<_>>());
        assert_eq!(board.hash(), Some(digest.finish().hash));
        assert_eq!((&board.rgba()[..4], board.rgba()[4 * (20 * 17 - 1)]), ([255; 4].as_slice(), 188));
        assert_eq!(board.tiles(), [0, 0, 16, 16, 16, 0, 4, 16, 0, 16, 16, 1, 16, 16, 4, 1]);
        board.begin([5, 5]);
        assert_eq!((board.samples(), board.tiles().len(), board.hash()), (0.0, 0, None));
    }

    #[test]
    fn a_saved_picture_is_what_is_there() {
        let mut board = Board::new(&outline(1)).unwrap();
        board.put(&patch(0, 0, 16, 16, 1, 0.5));
        let limits = juggler::imaging::Limits::default();
        let image = juggler::imaging::decode("saved.png", io::Cursor::new(board.png().unwrap()), &limits).unwrap();
        assert_eq!((image.width(), image.height()), (20, 17));
        assert!((image.pixels()[0].r - 0.5).abs() < 0.01 && image.pixels()[19].r == 0.0);
    }

    #[test]
    fn another_tone_shows_the_same_light() {
        let mut board = Board::new(&outline(1)).unwrap();
        board.put(&patch(0, 0, 16, 16, 1, 0.25));
        let before = board.rgba()[0];
        let brighter = outline(1).replace("\"exposure_stops\":0.0", "\"exposure_stops\":2.0");
        board.resume(&brighter).unwrap();
        assert!(before < 255 && board.rgba()[0] == 255, "{before}");
        assert_eq!(board.film.light[0], Rgb::splat(0.25));
    }

    #[test]
    fn patches_that_do_not_fit_are_left_out() {
        let mut board = Board::new(&outline(1)).unwrap();
        for (x, y, width, height) in [(18, 0, 16, 16), (0, 17, 16, 16), (u32::MAX, 0, 1, 1), (0, u32::MAX, 1, 1)] {
            board.put(&patch(x, y, width, height, 1, 1.0));
        }
        board.put(&Patches { places: vec![0, 0, u32::MAX, u32::MAX, 1, 0], light: vec![1.0; 5] });
        assert_eq!(board.rgba()[4 * 18..4 * 20], [255; 8], "as far as it lies on the picture");
        assert_eq!(board.rgba()[..4], [0, 0, 0, 255]);
    }
}
