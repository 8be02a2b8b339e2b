//! Rendering of a worker in time slices, between which it receives messages of the page.

use crate::pixel_rects::PixelRects;
use crate::share::WorkerShare;
use juggler::Picture;
use juggler::camera::film::Film;
use juggler::math::{PixelRows, UVec2};
use juggler::render::{Control, Job, ProgressiveRender, StopCriterion, Work};
use std::collections::BTreeSet;

/// Weight of the newest step in the speed estimate.
const STEP_WEIGHT: f64 = 0.3;

/// A worker's tiles with the estimate of their render time.
pub struct WorkerFilm {
    film: Film,
    /// Milliseconds per sample of all pixels of a tile; 0 before the first measurement.
    sample_milliseconds: f64,
    finished: bool,
}

impl WorkerFilm {
    /// Creates the worker's tiles without samples.
    pub fn new(picture: &Picture, share: WorkerShare) -> Self {
        let tiling = picture.tiling();
        let film = Film::from_tiles(tiling, share.tiles(&tiling).map(|number| (number, 0..picture.samples())));
        Self { film, sample_milliseconds: 0.0, finished: false }
    }

    /// Continues the tiles for a picture with the same samples but another number of them.
    #[must_use]
    pub fn continued(self, picture: &Picture, share: WorkerShare) -> Self {
        let more = Self { sample_milliseconds: self.sample_milliseconds, ..Self::new(picture, share) };
        for (number, tile) in self.film.tiles() {
            // The layout is the same, and the new film is empty.
            let added = more.film.add(number, tile);
            debug_assert_eq!(added, Ok(true));
        }
        more
    }

    /// Returns whether all tiles have all their samples.
    pub fn is_finished(&self) -> bool {
        self.finished
    }

    /// Renders for some `milliseconds` of the `clock`, at least one step, and returns the updated
    /// tiles.
    pub fn refine(&mut self, picture: &Picture, milliseconds: f64, clock: &dyn Fn() -> f64) -> PixelRects {
        let (job, control) = (picture.job(), Control::default());
        let render = ProgressiveRender::new(&job, &self.film, StopCriterion::Evenly);
        let mut worker = render.worker();
        let (start, mut changed) = (clock(), BTreeSet::new());
        let mut now = start;
        // Render tiles step by step until the time is over
        while now - start < milliseconds || changed.is_empty() {
            let most = if self.sample_milliseconds > 0.0 {
                (0.5 * milliseconds / self.sample_milliseconds).max(1.0) as u32
            } else {
                1
            };
            let (before, samples) = (now, control.samples());
            let Some(place) = worker.step(most, &control) else {
                self.finished = true;
                break;
            };
            now = clock();
            changed.insert(place);
            let area = self.film.tile(place).map_or(1, |tile| tile.pixels().area());
            let each = (now - before) / ((control.samples() - samples) as f64 / area as f64).max(1.0);
            self.sample_milliseconds += (each - self.sample_milliseconds) * STEP_WEIGHT;
        }
        // Collect the updated tiles
        let mut rects = PixelRects::default();
        for tile in changed.into_iter().filter_map(|place| self.film.tile(place)) {
            let alpha = picture.aovs().alpha(&tile.pixels(), std::slice::from_ref(&*tile));
            let rows = PixelRows { colors: &tile.means(), alpha: alpha.as_deref() };
            rects.push(tile.pixels(), tile.samples_per_pixel(), rows);
        }
        rects
    }
}

/// Renders a worker's rows of a coarse frame with one sample per pixel.
pub fn coarse(picture: &Picture, share: WorkerShare, [width, height]: [u32; 2]) -> PixelRects {
    let job = picture.job();
    let camera = job.camera.resampled(UVec2::from(picture.size()), UVec2::new(width, height));
    let job = Job { camera: &camera, samples: 1, ..job };
    let (mut rects, control) = (PixelRects::default(), Control::default());
    for band in share.bands(width, height) {
        // The control is private, so nothing cancels the render.
        let radiance = job.render(&Work::first(band, 1), &control).map_or_else(|_| Vec::new(), |tile| tile.means());
        rects.push(band, 0, &radiance);
    }
    rects
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compositor::tests::compositor_of;
    use juggler::Settings;
    use juggler::scene::Scene;
    use std::cell::Cell;

    fn picture(samples: u32, transparent: bool) -> Picture {
        let scene = Scene::built_in("juggler").unwrap();
        let (size, samples, transparent) = (Some([70, 45]), Some(samples), Some(transparent));
        let settings = Settings { size, samples, transparent, ..Settings::default() };
        Picture::new(&scene, &settings).unwrap()
    }

    fn native(picture: &Picture) -> String {
        let film = picture.film();
        picture.render_film(&film, &Control::default()).unwrap();
        picture.develop(&film, |_| Ok::<(), ()>(())).unwrap().hash
    }

    #[test]
    fn workers_together_render_the_film_of_the_program() {
        for (count, transparent) in [(1, false), (3, false), (2, true)] {
            let (picture, few) = (picture(21, transparent), picture(5, transparent));
            let mut compositor = compositor_of(&picture);
            for share in (0..count).map(|index| WorkerShare { index, count }) {
                let time = Cell::new(0.0);
                let clock = || {
                    time.set(time.get() + 3.0);
                    time.get()
                };
                // Start with fewer samples, then continue.
                let mut film = WorkerFilm::new(&few, share);
                while !film.is_finished() {
                    film.refine(&few, 10.0, &clock);
                }
                let mut film = film.continued(&picture, share);
                while !film.is_finished() {
                    compositor.add_tiles(&film.refine(&picture, 10.0, &clock));
                }
            }
            assert_eq!(compositor.hash(), Some(native(&picture)), "{count} workers");
        }
    }

    #[test]
    fn slices_keep_to_their_time() {
        let picture = picture(400, false);
        let mut film = WorkerFilm::new(&picture, WorkerShare { index: 0, count: 1 });
        let time = Cell::new(0.0);
        // The clock advances by a millisecond per step.
        let clock = || {
            time.set(time.get() + 1.0);
            time.get()
        };
        for _ in 0..10 {
            let before = time.get();
            film.refine(&picture, 6.0, &clock);
            assert!(time.get() - before <= 8.0);
        }
        assert!(!film.is_finished());
    }

    #[test]
    fn a_coarse_frame_is_the_picture_in_larger_pixels() {
        let picture = picture(1, false);
        let size = [35, 23];
        let whole = coarse(&picture, WorkerShare { index: 0, count: 1 }, size);
        let parts: Vec<PixelRects> =
            (0..3).map(|index| coarse(&picture, WorkerShare { index, count: 3 }, size)).collect();
        let mut bands: Vec<_> = parts.iter().flat_map(|part| part.iter()).collect();
        bands.sort_by_key(|(band, ..)| band.y);
        assert!(bands.into_iter().eq(whole.iter()));
        assert_eq!(whole.radiance.len(), 35 * 23 * 4);
    }
}
