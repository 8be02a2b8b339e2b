//! Rendering by the worker: coarse frames while the camera moves, passes of increasing resolution
//! at rest, then the film.

use crate::coarse::{coarse_size, next_pass};
use crate::edit::Channel;
use crate::frame::Frame;
use crate::preview::render_preview;
use crate::screen::{self, Canvas, DisplayTransform};
use crate::status::Stage;
use crate::subject::Subject;
use crate::worker_state::Worker;
use juggler::Picture;
use juggler::camera::film::{Film, Rect, Tiling};
use juggler::math::PixelRows;
use juggler::render::{self, Control, StopCriterion};
use std::convert::Infallible;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Time after a frame for which the worker waits for another edit before it refines.
const EDIT_WAIT: Duration = Duration::from_millis(20);
/// Delay of the first displayed refinement; the interval then grows by half each time, up to
/// `LAST_SHOW`.
const FIRST_SHOW: Duration = Duration::from_millis(40);
const LAST_SHOW: Duration = Duration::from_millis(500);
/// Maximum time between two frames of one motion.
const MOTION: Duration = Duration::from_millis(500);
/// Weight of the newest frame in the moving average of the frame rate.
const RATE_WEIGHT: f32 = 0.2;

impl Worker {
    /// Renders a frame at the resolution that the frame budget allows.
    pub fn draw(&mut self) {
        let Some(subject) = self.subject.clone() else {
            self.pending.needs_preview = false;
            return;
        };
        let size = subject.picture().size();
        let coarseness = self.pending.rate.coarseness(size, self.options.budget.as_secs_f64());
        if !self.draw_by(&subject, coarseness, Stage::Moving) {
            // Cancelled by a new edit: the updated pace makes the next frame coarser.
            return;
        }
        // Render once more if the measured speed allows a finer frame.
        let finer = self.pending.rate.coarseness(size, self.options.budget.as_secs_f64());
        self.pending.needs_preview = finer < coarseness && !self.shared.mailbox().has_work();
    }

    /// Renders a frame in pixel blocks of edge `coarseness`. Returns `false` when it was cancelled.
    fn draw_by(&mut self, subject: &Subject, coarseness: u32, stage: Stage) -> bool {
        let picture = subject.picture();
        let size = coarse_size(picture.size(), coarseness);
        let (control, began) = (Control::default(), Instant::now());
        // Give the frame time to finish before an edit may cancel it.
        let patience = if self.pending.needs_preview { self.options.budget * 2 } else { Duration::ZERO };
        let (transform, gains) = (self.display_transform(picture), subject.gains());
        let (channel, scheduler) = (self.status.channel, self.threads.scheduler);
        let drawn = self.run_cancellable(patience, &control, || {
            let preview = render_preview(picture, size, channel, &gains, scheduler, &control).ok()?;
            let rgba = transform.rgba_image(preview.rows(), size[0]);
            Some((preview, rgba))
        });
        let seconds = began.elapsed().as_secs_f64();
        self.pending.rate.measure(control.samples() as f64, seconds);
        let Some((preview, rgba)) = drawn else { return false };
        self.measure(&control, seconds, stage);
        (self.display.preview, self.display.transform, self.display.canvas, self.pending.needs_repaint) =
            (Arc::new(preview), transform, None, false);
        (self.status.stage, self.status.coarseness) = (stage, coarseness);
        (self.status.samples, self.status.noise, self.status.hash) = (0.0, None, None);
        (self.status.clamped, self.status.denoised) = (None, false);
        let frame = self.frame(size, rgba, if coarseness == 1 { 1.0 } else { 0.0 });
        self.publish(Some(frame));
        true
    }

    /// Runs `work` on the pool. New work for the worker cancels `control`, but not before
    /// `patience` is over.
    pub fn run_cancellable<T: Send>(
        &self,
        patience: Duration,
        control: &Control,
        work: impl FnOnce() -> Option<T> + Send,
    ) -> Option<T> {
        let (shared, mut result) = (&self.shared, None);
        shared.mailbox().job_ended = false;
        self.threads.pool.in_place_scope(|scope| {
            scope.spawn(|_| {
                result = work();
                shared.update(|mailbox| mailbox.job_ended = true);
            });
            shared.wait_for_work(Some(patience), |mailbox| mailbox.job_ended);
            shared.wait_for_work(None, |mailbox| mailbox.job_ended || mailbox.has_work());
            if !shared.mailbox().job_ended {
                control.cancel();
            }
        });
        result
    }

    fn frame(&self, [width, height]: [u32; 2], rgba: Vec<u8>, samples: f32) -> Frame {
        let revision = self.status.revision;
        Frame { number: 0, revision, width, height, rgba, size: self.status.size, samples }
    }

    fn measure(&mut self, control: &Control, seconds: f64, stage: Stage) {
        self.status.rays_per_second = (control.rays().total() as f64 / seconds.max(1e-9)) as f32;
        let since = self.pending.drawn.elapsed();
        self.pending.drawn = Instant::now();
        if since < MOTION && stage == Stage::Moving {
            let (now, before) = ((1.0 / since.as_secs_f64().max(1e-6)) as f32, self.status.frames_per_second);
            self.status.frames_per_second = if before > 0.0 { before + (now - before) * RATE_WEIGHT } else { now };
        }
    }

    fn display_transform(&self, picture: &Picture) -> DisplayTransform {
        let of_light = self.status.channel.is_light() || self.status.channel == Channel::Albedo;
        self.display.transform.for_tone(if of_light { picture.tone() } else { &screen::LINEAR_TONE })
    }

    /// Creates a film for the current picture from the samples of the old one; only tiles in the
    /// region receive more.
    pub fn rebuild_film(&mut self) {
        let Some(subject) = &self.subject else { return };
        let picture = subject.picture();
        let (tiling, target, region) = (Tiling::new(picture.region()), picture.samples(), self.samples.region);
        let old = self.samples.film.take();
        let counts = old.as_ref().map_or_else(Vec::new, |old| old.counts());
        // Samples cannot be subtracted from a sum, so a film with too many starts over.
        let old = old.filter(|_| counts.iter().all(|count| *count <= target));
        let inside = |number: u64| {
            let tile = tiling.tile(number);
            region.is_none_or(|region| tile.is_some_and(|tile| tile.intersection(&region).area() > 0))
        };
        let have = |number: u64| old.as_ref().and_then(|_| counts.get(number as usize)).copied().unwrap_or(0);
        let share = |number: u64| (number, 0..if inside(number) { target } else { have(number) });
        let film = Film::from_tiles(tiling, (0..tiling.tile_count()).map(share));
        for (number, tile) in old.iter().flat_map(|old| old.tiles()) {
            let added = film.add(number, tile);
            debug_assert_eq!(added, Ok(true), "of the same layout, and new");
        }
        self.samples.film = Some(Arc::new(film));
    }

    /// Restricts refinement to a region; `None` refines the whole image.
    pub fn set_region(&mut self, region: Option<Rect>) {
        let [width, height] = self.status.size;
        let whole = Rect { x: 0, y: 0, width, height };
        let inside = region.map(|region| region.intersection(&whole));
        self.samples.region = inside.filter(|region| region.area() > 0 && *region != whole);
        self.update_status();
        self.rebuild_film();
    }

    /// Displays the same samples with the current tone, channel and gains.
    pub fn repaint(&mut self) {
        self.pending.needs_repaint = false;
        let Some(subject) = self.subject.clone() else { return };
        (self.display.transform, self.display.canvas) = (self.display_transform(subject.picture()), None);
        self.status.stage = if self.status.stage == Stage::Finished { Stage::Refining } else { self.status.stage };
        self.show(self.status.samples);
    }

    /// Displays the film over the preview.
    fn show(&mut self, samples: f32) {
        let Some(film) = self.samples.film.clone() else { return };
        let Some(subject) = self.subject.clone() else { return };
        let (size, target, transform) = (self.status.size, self.status.samples_wanted, &self.display.transform);
        let gains = subject.gains();
        if let Some(denoised) = self.denoised_picture(&subject).filter(|_| self.status.channel == Channel::Color) {
            let rgba = transform.rgba_image(denoised.rows(), size[0]);
            self.status.denoised = true;
            let frame = self.frame(size, rgba, samples);
            return self.publish(Some(frame));
        }
        self.status.denoised = false;
        let canvas = self.display.canvas.get_or_insert_with(|| Canvas::new(&self.display.preview, size, transform));
        // A full-resolution preview looks better than fewer than four samples per pixel.
        let least = if self.display.preview.size == size { target.min(4) } else { 1 };
        match self.status.channel {
            Channel::Color => {
                canvas.paint(&film, least, |tile| {
                    let (area, colors) = (tile.pixels(), subject.light(tile, &gains));
                    let alpha = subject.picture().aovs().alpha(&area, std::slice::from_ref(tile));
                    screen::radiance_to_rgba(transform, area, PixelRows { colors: &colors, alpha: alpha.as_deref() })
                });
            }
            Channel::Samples => canvas.paint(&film, 0, |tile| screen::samples(tile, target)),
            Channel::Noise => canvas.paint(&film, 0, screen::noise),
            _ => {}
        }
        let rgba = canvas.rgba().to_vec();
        let frame = self.frame(size, rgba, samples);
        self.publish(Some(frame));
    }

    /// Refines the image until there is new work. Returns `false` when it cannot be refined
    /// further.
    pub fn refine(&mut self) -> bool {
        let Some(subject) = self.subject.clone() else { return false };
        // Wait for further edits of a motion
        let wait = EDIT_WAIT.saturating_sub(self.pending.drawn.elapsed());
        if !wait.is_zero() && self.status.stage == Stage::Moving {
            self.shared.wait_for_work(Some(wait), |mailbox| mailbox.has_work());
        }
        // Render passes of increasing resolution until the film has samples to display.
        let has_samples = self.samples.film.as_ref().is_some_and(|film| film.samples() > 0);
        if (!self.status.channel.is_light() || !has_samples)
            && let Some(step) = next_pass(self.display.preview.size, subject.picture().size())
        {
            return self.draw_by(&subject, step, Stage::Refining) || self.shared.mailbox().has_work();
        }
        // Continue the film
        if self.samples.film.is_none() {
            self.rebuild_film();
        }
        let Some(film) = self.samples.film.clone() else { return false };
        let finished = render::is_finished(&film, StopCriterion::Evenly);
        if self.should_denoise(&subject, &film, finished) {
            self.denoise(&subject, &film);
            return true;
        }
        if finished {
            self.finish(&subject, &film);
            return false;
        }
        let control = Control::default();
        {
            let mut mailbox = self.shared.mailbox();
            if mailbox.has_work() {
                return true;
            }
            mailbox.job_ended = false;
        }
        (self.status.stage, self.status.coarseness) = (Stage::Refining, 1);
        self.render_film(&subject, &film, &control);
        true
    }

    /// Renders into the film and displays it periodically, until it is finished, is due for
    /// denoising, or there is new work.
    fn render_film(&mut self, subject: &Subject, film: &Film, control: &Control) {
        let picture = subject.picture();
        let (shared, pool) = (Arc::clone(&self.shared), Arc::clone(&self.threads.pool));
        let (began, mut interval) = (Instant::now(), FIRST_SHOW);
        pool.in_place_scope(|scope| {
            scope.spawn(|_| {
                // A cancelled render keeps the samples it has added.
                let _ = render::render_progressive(&picture.job(), film, StopCriterion::Evenly, control);
                shared.update(|mailbox| mailbox.job_ended = true);
            });
            loop {
                shared.wait_for_work(Some(interval), |mailbox| mailbox.job_ended || mailbox.has_work());
                let (job_ended, has_work) = shared.mailbox().state();
                if has_work {
                    control.cancel();
                }
                if job_ended || has_work {
                    break;
                }
                self.publish_progress(picture, film, control, began);
                if self.should_denoise(subject, film, false) {
                    control.cancel();
                    break;
                }
                interval = (interval * 3 / 2).min(LAST_SHOW);
            }
        });
    }

    fn publish_progress(&mut self, picture: &Picture, film: &Film, control: &Control, began: Instant) {
        self.count(picture, film);
        self.status.rays_per_second = (control.rays().total() as f64 / began.elapsed().as_secs_f64().max(1e-9)) as f32;
        if self.status.channel.is_light() {
            self.show(self.status.samples);
        } else {
            self.publish(None);
        }
    }

    fn count(&mut self, picture: &Picture, film: &Film) {
        let pixels = self.status.size.map(f64::from).iter().product::<f64>();
        self.status.samples = (film.samples() as f64 / pixels.max(1.0)) as f32;
        self.status.noise = screen::relative_error_of_film(film);
        self.status.clamped = picture.is_clamped().then(|| screen::clamped_fraction(film));
    }

    fn finish(&mut self, subject: &Subject, film: &Film) {
        if self.status.stage == Stage::Finished {
            return;
        }
        let picture = subject.picture();
        self.count(picture, film);
        let whole = film.samples() == picture.total_samples();
        let summary = picture.develop(film, |_| Ok::<(), Infallible>(()));
        self.status.hash = summary.ok().filter(|_| whole).map(|summary| summary.hash);
        (self.status.stage, self.status.coarseness) = (Stage::Finished, 1);
        self.show(self.status.samples);
    }
}
