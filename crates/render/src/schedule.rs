//! Distribution of pixels among threads. It cannot change a bit of the picture.

use super::wavefront::Engine;
use super::{Cancelled, Control, Job, Work};
use juggler_camera::film::{ClampedRadiance, Rect};
use juggler_math::{NamedKind, Rgb};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};
use std::sync::{Mutex, PoisonError};

/// Default number of pixels in a band; at least one row of tiles is held in memory.
pub const BAND_PIXELS: u64 = 4 << 20;
/// Number of samples per tile that amortizes the scheduler's overhead.
const TILE_SAMPLES: u64 = 1 << 16;
/// Edge of the largest tile, in pixels.
const MAX_TILE: u32 = 32;
/// Edge of the smallest tile, in pixels.
const MIN_TILE: u32 = 4;

/// Strategy by which threads obtain pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Scheduler {
    /// Idle threads steal tiles from busy ones (as in ScalaBlitz).
    #[default]
    WorkStealing,
    /// Threads take rows from a shared counter (as in the original Juggler).
    RowQueue,
    /// Each thread renders one block of rows, without load balancing.
    StaticRows,
}

impl NamedKind for Scheduler {
    const ALL: &'static [Self] = &[Self::WorkStealing, Self::RowQueue, Self::StaticRows];

    fn name(self) -> &'static str {
        match self {
            Self::WorkStealing => "work-stealing",
            Self::RowQueue => "row-queue",
            Self::StaticRows => "static-rows",
        }
    }
}

/// Scheduling options, which have no influence on the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Schedule {
    /// Strategy by which threads obtain pixels.
    pub scheduler: Scheduler,
    /// Maximum number of pixels held in memory at once, rounded down to whole rows of tiles, at
    /// least one row.
    pub band_pixels: u64,
}

impl Default for Schedule {
    fn default() -> Self {
        Self { scheduler: Scheduler::default(), band_pixels: BAND_PIXELS }
    }
}

/// Renders all samples of `region` on the threads of the current rayon pool and passes the finished
/// rows to `rows` from top to bottom, one band of whole rows at a time; only one band is held in
/// memory. Returns the radiance that clamping removed.
///
/// # Errors
///
/// [`Cancelled`] if `control` is cancelled, and the errors of `rows`.
pub fn render<E: From<Cancelled>>(
    job: &Job,
    region: Rect,
    schedule: Schedule,
    control: &Control,
    mut rows: impl FnMut(Vec<Rgb>) -> Result<(), E>,
) -> Result<ClampedRadiance, E> {
    let (engines, clamped) = (Mutex::new(Vec::new()), Mutex::new(ClampedRadiance::default()));
    for band in bands(region, schedule.band_pixels) {
        let film = Mutex::new(vec![Rgb::BLACK; band.area() as usize]);
        let render_tile = |pixels: Rect| {
            let recycled = lock(&engines).pop();
            let mut engine: Engine = recycled.unwrap_or_else(|| Engine::new(job));
            // Compute the means before locking the film.
            let means = if job.samples == 1 {
                engine.render_single(pixels, control)
            } else {
                engine.render(&Work::first(pixels, job.samples), control).map(|tile| (tile.means(), tile.clamped()))
            };
            if let Ok((means, removed)) = means {
                pixels.copy_into(&means, &band, &mut lock(&film));
                lock(&clamped).add_all(removed);
            }
            lock(&engines).push(engine);
        };
        for_each_tile(schedule.scheduler, &band, job.samples, control, render_tile);
        if control.is_cancelled() {
            return Err(Cancelled.into());
        }
        rows(film.into_inner().unwrap_or_else(PoisonError::into_inner))?;
    }
    Ok(*lock(&clamped))
}

/// Memory that [`render`] holds for a band of `pixels` pixels, in bytes: the band and its list of
/// tiles.
pub fn band_bytes(region: Rect, pixels: u64) -> u64 {
    let tile = (size_of::<Rect>() as u64) / u64::from(MIN_TILE * MIN_TILE);
    bands(region, pixels).next().map_or(0, |band| band.area() * (size_of::<Rgb>() as u64 + tile))
}

/// Locks a mutex, poisoned or not: rayon passes on the panic of the other thread.
fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Cuts a region into bands of whole rows with at most `pixels` pixels, at least one row of tiles
/// each.
fn bands(region: Rect, pixels: u64) -> impl Iterator<Item = Rect> {
    let tile_rows = pixels / (u64::from(region.width.max(1)) * u64::from(MAX_TILE));
    let height = (tile_rows.max(1) * u64::from(MAX_TILE)).min(u64::from(u32::MAX)) as u32;
    let end = region.y + region.height;
    (region.y..end).step_by(height as usize).map(move |y| Rect { y, height: height.min(end - y), ..region })
}

/// Renders the tiles of a band on the threads of the current pool. No thread enters a tile after
/// cancellation.
fn for_each_tile(
    scheduler: Scheduler,
    band: &Rect,
    samples: u32,
    control: &Control,
    render_tile: impl Fn(Rect) + Sync + Send,
) {
    let enter = |tile: Rect| {
        if !control.is_cancelled() {
            render_tile(tile);
        }
    };
    match scheduler {
        Scheduler::WorkStealing => steal(band, samples, enter),
        Scheduler::RowQueue => row_queue(band, enter),
        Scheduler::StaticRows => static_rows(band, enter),
    }
}

fn steal(band: &Rect, samples: u32, render_tile: impl Fn(Rect) + Sync + Send) {
    let edge = tile_edge(samples);
    let columns: Vec<u32> = (0..band.width).step_by(edge as usize).collect();
    let corners = (0..band.height).step_by(edge as usize).flat_map(|y| columns.iter().map(move |x| (*x, y)));
    let tiles: Vec<Rect> = corners
        .map(|(x, y)| Rect {
            x: band.x + x,
            y: band.y + y,
            width: edge.min(band.width - x),
            height: edge.min(band.height - y),
        })
        .collect();
    tiles.into_par_iter().with_max_len(1).for_each(render_tile);
}

/// Edge of the tiles, in pixels: smaller for more samples per pixel, so that threads finish at
/// about the same time.
fn tile_edge(samples: u32) -> u32 {
    let pixels = (TILE_SAMPLES / u64::from(samples.max(1))) as u32;
    (pixels.isqrt().max(1).next_power_of_two()).clamp(MIN_TILE, MAX_TILE)
}

fn row_queue(band: &Rect, render_tile: impl Fn(Rect) + Sync + Send) {
    let next = AtomicU32::new(0);
    rayon::broadcast(|_| {
        loop {
            let row = next.fetch_add(1, Relaxed);
            if row >= band.height {
                return;
            }
            render_tile(Rect { y: band.y + row, height: 1, ..*band });
        }
    });
}

fn static_rows(band: &Rect, render_tile: impl Fn(Rect) + Sync + Send) {
    rayon::broadcast(|thread| {
        let part = |i: usize| (u64::from(band.height) * i as u64 / thread.num_threads() as u64) as u32;
        let (first, end) = (part(thread.index()), part(thread.index() + 1));
        for row in first..end {
            render_tile(Rect { y: band.y + row, height: 1, ..*band });
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bands_cover_every_row_once_and_stay_small() {
        let sizes = [(1, 1), (640, 360), (1920, 1080), (20_000, 20_000), (65_536, 3), (3, 65_536), (0, 0)];
        for (width, height) in sizes {
            let region = Rect { x: 2, y: 5, width, height };
            for pixels in [0, 1 << 16, BAND_PIXELS] {
                let mut next = region.y;
                for band in bands(region, pixels) {
                    assert_eq!((band.x, band.y, band.width), (2, next, width));
                    assert!(band.area() <= pixels.max(u64::from(width * MAX_TILE)));
                    assert!(band.area() * 12 <= band_bytes(region, pixels));
                    next += band.height;
                }
                assert_eq!(next, region.y + height, "{width}x{height}");
            }
        }
    }

    /// Number of times that each pixel of a band is rendered. The `last_tile`-th tile cancels.
    fn rendered_counts(scheduler: Scheduler, band: &Rect, samples: u32, last_tile: u32) -> (Vec<u32>, u32) {
        let (control, entered) = (Control::default(), AtomicU32::new(0));
        let counts = Mutex::new(vec![0; band.area() as usize]);
        for_each_tile(scheduler, band, samples, &control, |tile| {
            if entered.fetch_add(1, Relaxed) + 1 == last_tile {
                control.cancel();
            }
            for y in tile.y..tile.y + tile.height {
                for x in tile.x..tile.x + tile.width {
                    lock(&counts)[((y - band.y) * band.width + x - band.x) as usize] += 1;
                }
            }
        });
        (counts.into_inner().unwrap(), entered.into_inner())
    }

    #[test]
    fn every_scheduler_draws_every_pixel_once() {
        let band = Rect { x: 3, y: 7, width: 70, height: 41 };
        for scheduler in Scheduler::ALL.iter().copied() {
            for samples in [1, 64, 4096] {
                let (counts, _) = rendered_counts(scheduler, &band, samples, u32::MAX);
                assert!(counts.iter().all(|count| *count == 1), "{scheduler:?}, {samples} samples");
            }
        }
    }

    #[test]
    fn cancellation_enters_no_further_tile() {
        let band = Rect { x: 0, y: 0, width: 640, height: 360 };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build().unwrap();
        for scheduler in Scheduler::ALL.iter().copied() {
            for last in [1, 5, 100] {
                let (_, entered) = pool.install(|| rendered_counts(scheduler, &band, 100_000, last));
                // The two other threads may have passed the test for cancellation just before.
                assert!((last..=last + 2).contains(&entered), "{scheduler:?}: {entered} of {last} tiles");
            }
        }
    }
}
