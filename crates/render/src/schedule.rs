//! Distribution of pixels among threads. It cannot change a bit of the picture.

use super::wavefront::Engine;
use super::{Cancelled, Control, Job, Work};
use juggler_camera::film::{ClampedRadiance, Rect};
use juggler_math::{NamedKind, Rgb};
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering::Relaxed};
use std::sync::{Mutex, PoisonError};

/// Default number of pixels in two bands.
pub const BAND_PIXELS: u64 = 4 << 20;
/// Number of samples per tile that amortizes the scheduler's overhead.
const TILE_SAMPLES: u64 = 1 << 16;
/// Minimum number of samples of the tiles that many threads share.
const MIN_TILE_SAMPLES: u64 = 1 << 12;
/// Number of tiles for each thread, so that threads finish at about the same time.
const TILES_PER_THREAD: u64 = 32;
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
    /// Maximum number of pixels held in memory at once, in two bands of whole rows of tiles, at least
    /// one row each.
    pub band_pixels: u64,
}

impl Default for Schedule {
    fn default() -> Self {
        Self { scheduler: Scheduler::default(), band_pixels: BAND_PIXELS }
    }
}

/// Renders all samples of `region` on the threads of the current rayon pool and passes the finished
/// rows to `rows` from top to bottom, one band of whole rows at a time, while other threads render the
/// next band; only two bands are held in memory. Returns the radiance that clamping removed.
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
    // Choose the number of camera rays before all threads need it.
    job.camera_rays.count(job, control)?;
    let threads = (0..rayon::current_num_threads()).map(|_| Mutex::default()).collect();
    let workers = Workers { job, control, scheduler: schedule.scheduler, threads, rows_failed: AtomicBool::new(false) };
    let mut finished: Option<Vec<Rgb>> = None;
    for band in bands(region, schedule.band_pixels) {
        let mut film = vec![Rgb::BLACK; band.area() as usize];
        // Render the band while this thread passes on the one before.
        rayon::in_place_scope(|scope| {
            scope.spawn(|_| workers.render_band(&band, &mut film));
            let passed_on = finished.take().map_or(Ok(()), &mut rows);
            workers.rows_failed.store(passed_on.is_err(), Relaxed);
            passed_on
        })?;
        if control.is_cancelled() {
            return Err(Cancelled.into());
        }
        finished = Some(film);
    }
    finished.map_or(Ok(()), rows)?;
    Ok(workers.threads.iter().map(|thread| lock(thread).clamped).sum())
}

/// The threads that render.
struct Workers<'j> {
    job: &'j Job<'j>,
    control: &'j Control,
    scheduler: Scheduler,
    /// Each thread has a state of its own, so that no thread waits for another.
    threads: Vec<Mutex<ThreadState<'j>>>,
    /// Whether the finished rows could not be passed on, so that all other work is in vain.
    rows_failed: AtomicBool,
}

impl Workers<'_> {
    /// Renders all samples of a band into `film`, which is incomplete after cancellation.
    fn render_band(&self, band: &Rect, film: &mut [Rgb]) {
        let rows: Vec<Mutex<&mut [Rgb]>> = film.chunks_mut(band.width.max(1) as usize).map(Mutex::new).collect();
        for_each_tile(self.scheduler, band, self.job.samples, self.control, |pixels| {
            self.render_tile(pixels, band, &rows);
        });
    }

    fn render_tile(&self, pixels: Rect, band: &Rect, rows: &[Mutex<&mut [Rgb]>]) {
        let Some(thread) = self.threads.get(rayon::current_thread_index().unwrap_or_default()) else { return };
        if self.rows_failed.load(Relaxed) {
            return;
        }
        let (job, mut thread) = (self.job, lock(thread));
        let ThreadState { engine, clamped } = &mut *thread;
        let engine = engine.get_or_insert_with(|| Engine::new(job));
        let means = if job.samples == 1 {
            engine.render_single(pixels, self.control)
        } else {
            let work = Work::first(pixels, job.samples);
            engine.render(&work, self.control).map(|tile| (tile.means(), tile.clamped()))
        };
        if let Ok((means, removed)) = means {
            copy_rows(&means, pixels, band, rows);
            clamped.add_all(removed);
        }
    }
}

/// What a thread keeps between tiles.
#[derive(Default)]
struct ThreadState<'j> {
    engine: Option<Engine<'j>>,
    /// Radiance that clamping removed.
    clamped: ClampedRadiance,
}

/// Copies the colors of a tile to the rows of a band. Few threads write a row at the same time.
fn copy_rows(colors: &[Rgb], tile: Rect, band: &Rect, rows: &[Mutex<&mut [Rgb]>]) {
    let first = tile.y.saturating_sub(band.y) as usize;
    let columns = tile.x.saturating_sub(band.x) as usize..;
    for (row, colors) in rows.iter().skip(first).zip(colors.chunks(tile.width.max(1) as usize)) {
        let mut row = lock(row);
        row.get_mut(columns.clone()).into_iter().flatten().zip(colors).for_each(|(to, color)| *to = *color);
    }
}

/// Memory that [`render`] holds for two bands of together `pixels` pixels, in bytes: the bands and their
/// lists of tiles.
pub fn band_bytes(region: Rect, pixels: u64) -> u64 {
    let tile = (size_of::<Rect>() as u64) / u64::from(MIN_TILE * MIN_TILE);
    bands(region, pixels).take(2).map(|band| band.area() * (size_of::<Rgb>() as u64 + tile)).sum()
}

/// Locks a mutex, poisoned or not: rayon passes on the panic of the other thread.
fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Cuts a region into bands of whole rows, at least one row of tiles each. Two bands have at most
/// `pixels` pixels.
fn bands(region: Rect, pixels: u64) -> impl Iterator<Item = Rect> {
    let tile_rows = pixels / (2 * u64::from(region.width.max(1)) * u64::from(MAX_TILE));
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
    tiles(band, samples, rayon::current_num_threads()).into_par_iter().with_max_len(1).for_each(render_tile);
}

/// Tiles of a band for a number of threads, rows from the top.
fn tiles(band: &Rect, samples: u32, threads: usize) -> Vec<Rect> {
    let edge = tile_edge(band, samples, threads);
    let columns: Vec<u32> = (0..band.width).step_by(edge as usize).collect();
    let corners = (0..band.height).step_by(edge as usize).flat_map(|y| columns.iter().map(move |x| (*x, y)));
    let tile = |(x, y): (u32, u32)| Rect {
        x: band.x + x,
        y: band.y + y,
        width: edge.min(band.width - x),
        height: edge.min(band.height - y),
    };
    corners.map(tile).collect()
}

/// Edge of the tiles, in pixels: smaller for more samples per pixel and for more threads.
fn tile_edge(band: &Rect, samples: u32, threads: usize) -> u32 {
    let samples = u64::from(samples.max(1));
    let most = ((TILE_SAMPLES / samples) as u32).isqrt().max(1).next_power_of_two();
    let share = band.area().saturating_mul(samples) / (TILES_PER_THREAD * threads.max(1) as u64);
    let pixels = (share.max(MIN_TILE_SAMPLES) / samples).min(u64::from(u32::MAX)) as u32;
    let fair = 1 << pixels.isqrt().max(1).ilog2();
    most.min(fair).clamp(MIN_TILE, MAX_TILE)
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
                    assert!(2 * band.area() <= pixels.max(2 * u64::from(width * MAX_TILE)));
                    assert!(band.area() * 12 <= band_bytes(region, pixels));
                    next += band.height;
                }
                assert_eq!(next, region.y + height, "{width}x{height}");
            }
        }
    }

    /// Share of the threads' time that is idle if each thread takes the next tile when it is done,
    /// and some tiles take three times as long as others.
    fn idle_share(tiles: &[Rect], threads: usize) -> f64 {
        let mut ends = vec![0; threads];
        for (number, tile) in tiles.iter().enumerate() {
            let first = ends.iter_mut().min().unwrap();
            *first +=
                tile.area() * (2 + (number as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15).leading_zeros().min(4) as u64);
        }
        let last = *ends.iter().max().unwrap();
        ends.iter().map(|end| (last - end) as f64).sum::<f64>() / (last as f64 * threads as f64)
    }

    #[test]
    fn many_threads_are_hardly_idle_at_the_end() {
        for (width, height, samples) in [(640, 360, 64), (1920, 1080, 16), (1280, 720, 256), (3840, 2160, 1)] {
            let band = Rect { x: 0, y: 0, width, height };
            for (threads, most) in [(2, 0.01), (16, 0.03), (64, 0.04), (128, 0.07)] {
                let tiles = tiles(&band, samples, threads);
                let share = idle_share(&tiles, threads);
                assert!(share < most, "{width}x{height}x{samples}, {threads} threads: {share}");
                // Small tiles have to be worth the schedule.
                let least = tiles.iter().map(|tile| tile.area() * u64::from(samples)).max().unwrap();
                assert!(least >= MIN_TILE_SAMPLES / 4, "{least}");
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
