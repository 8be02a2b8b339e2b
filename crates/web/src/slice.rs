//! A worker's rendering, in slices of time: between two of them it hears what the page says.

use crate::patches::Patches;
use crate::share::Share;
use juggler::Picture;
use juggler::camera::film::Film;
use juggler::math::UVec2;
use juggler::render::{Control, Exposure, Job, Stop, Work};
use std::collections::BTreeSet;

/// How much the newest step counts in what is known about the speed.
const TRUST: f64 = 0.3;

/// One worker's tiles of a picture, and how long they take.
pub struct Slices {
    film: Film,
    /// Milliseconds that one sample of all pixels of a tile takes; 0 when nothing is known.
    sample: f64,
    finished: bool,
}

impl Slices {
    /// Without samples yet.
    pub fn new(picture: &Picture, share: Share) -> Self {
        let layout = picture.layout();
        let film = Film::of(layout, share.tiles(&layout).map(|number| (number, 0..picture.samples())));
        Self { film, sample: 0.0, finished: false }
    }

    /// The same tiles, as they are, for a picture that wants another number of the same samples.
    #[must_use]
    pub fn resumed(self, picture: &Picture, share: Share) -> Self {
        let more = Self { sample: self.sample, ..Self::new(picture, share) };
        for (number, tile) in self.film.tiles() {
            // Tiles of one layout fit, and the new film has no samples.
            let added = more.film.add(number, tile);
            debug_assert_eq!(added, Ok(true));
        }
        more
    }

    /// Whether all of its tiles have their samples.
    pub fn is_finished(&self) -> bool {
        self.finished
    }

    /// Renders for some `milliseconds` by the `clock`, at least one step, and gives the tiles that have become better.
    pub fn refine(&mut self, picture: &Picture, milliseconds: f64, clock: &dyn Fn() -> f64) -> Patches {
        let (job, control) = (picture.job(), Control::default());
        let exposure = Exposure::new(&job, &self.film, Stop::Evenly);
        let mut hand = exposure.hand();
        let (start, mut changed) = (clock(), BTreeSet::new());
        let mut now = start;
        while now - start < milliseconds || changed.is_empty() {
            let most = if self.sample > 0.0 { (0.5 * milliseconds / self.sample).max(1.0) as u32 } else { 1 };
            let (before, samples) = (now, control.samples());
            let Some(place) = hand.step(most, &control) else {
                self.finished = true;
                break;
            };
            now = clock();
            changed.insert(place);
            let area = self.film.tile(place).map_or(1, |tile| tile.pixels().area());
            let each = (now - before) / ((control.samples() - samples) as f64 / area as f64).max(1.0);
            self.sample += (each - self.sample) * TRUST;
        }
        let mut patches = Patches::default();
        for tile in changed.into_iter().filter_map(|place| self.film.tile(place)) {
            patches.push(tile.pixels(), tile.count(), &tile.means());
        }
        patches
    }
}

/// A worker's rows of a coarse frame of this size: one sample for each of its pixels.
pub fn coarse(picture: &Picture, share: Share, [width, height]: [u32; 2]) -> Patches {
    let job = picture.job();
    let camera = job.camera.resampled(UVec2::from(picture.size()), UVec2::new(width, height));
    let job = Job { camera: &camera, samples: 1, ..job };
    let (mut patches, control) = (Patches::default(), Control::default());
    for band in share.bands(width, height) {
        // Nobody can cancel.
        let light = job.render(&Work::first(band, 1), &control).map_or_else(|_| Vec::new(), |tile| tile.means());
        patches.push(band, 0, &light);
    }
    patches
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::board::tests::board_of;
    use juggler::Settings;
    use juggler::scene::Scene;
    use std::cell::Cell;

    fn picture(samples: u32) -> Picture {
        let scene = Scene::built_in("juggler").unwrap();
        let settings = Settings { size: Some([70, 45]), samples: Some(samples), ..Settings::default() };
        Picture::new(&scene, &settings).unwrap()
    }

    fn native(picture: &Picture) -> String {
        let film = picture.film();
        picture.expose(&film, &Control::default()).unwrap();
        picture.develop(&film, |_| Ok::<(), ()>(())).unwrap().hash
    }

    #[test]
    fn workers_together_render_the_film_of_the_program() {
        let (picture, few) = (picture(21), picture(5));
        for of in [1, 3] {
            let mut board = board_of(&picture);
            for share in (0..of).map(|index| Share { index, of }) {
                let time = Cell::new(0.0);
                let clock = || {
                    time.set(time.get() + 3.0);
                    time.get()
                };
                // Begun with fewer samples, then gone on with.
                let mut slices = Slices::new(&few, share);
                while !slices.is_finished() {
                    slices.refine(&few, 10.0, &clock);
                }
                let mut slices = slices.resumed(&picture, share);
                while !slices.is_finished() {
                    board.put(&slices.refine(&picture, 10.0, &clock));
                }
            }
            assert_eq!(board.hash(), Some(native(&picture)), "{of} workers");
        }
    }

    #[test]
    fn slices_keep_to_their_time() {
        let picture = picture(400);
        let mut slices = Slices::new(&picture, Share { index: 0, of: 1 });
        let time = Cell::new(0.0);
        // A clock that is asked after every step: each seems to take a millisecond.
        let clock = || {
            time.set(time.get() + 1.0);
            time.get()
        };
        for _ in 0..10 {
            let before = time.get();
            slices.refine(&picture, 6.0, &clock);
            assert!(time.get() - before <= 8.0);
        }
        assert!(!slices.is_finished());
    }

    #[test]
    fn a_coarse_frame_is_the_picture_in_larger_pixels() {
        let picture = picture(1);
        let size = [35, 23];
        let whole = coarse(&picture, Share { index: 0, of: 1 }, size);
        let parts: Vec<Patches> = (0..3).map(|index| coarse(&picture, Share { index, of: 3 }, size)).collect();
        let mut bands: Vec<_> = parts.iter().flat_map(|part| part.iter()).collect();
        bands.sort_by_key(|(band, ..)| band.y);
        assert!(bands.into_iter().eq(whole.iter()));
        assert_eq!(whole.light.len(), 35 * 23 * 3);
    }
}
