//! How the worker makes pictures: coarse ones while somebody moves, finer passes over the whole picture when nobody does,
//! then the film.

use crate::coarse::{coarse_size, finer};
use crate::draw::draw;
use crate::screen::{self, Canvas, Toner};
use crate::subject::Subject;
use crate::worker::Worker;
use crate::{Channel, Frame, Stage};
use juggler::Picture;
use juggler::camera::film::{Film, Layout, Rect};
use juggler::render::{self, Control, Stop};
use std::convert::Infallible;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// How long after a frame the next edit is waited for before the picture gets better.
const LINGER: Duration = Duration::from_millis(20);
/// The first picture that gets better is shown after so long, later ones ever less often.
const FIRST_SHOW: Duration = Duration::from_millis(40);
const LAST_SHOW: Duration = Duration::from_millis(500);
/// Frames that follow each other within this time are one motion.
const MOTION: Duration = Duration::from_millis(500);
/// How much the newest frame counts for the frames a second.
const NEWEST: f32 = 0.2;

impl Worker {
    /// A frame as fine as the budget allows.
    pub fn draw(&mut self) {
        let Some(subject) = self.subject.clone() else {
            self.moved = false;
            return;
        };
        let size = subject.picture().size();
        let coarseness = self.pace.coarseness(size, self.options.budget.as_secs_f64());
        if !self.draw_by(&subject, coarseness, Stage::Moving) {
            // Too slow, and somebody goes on: the next one is coarser.
            return;
        }
        // When nothing is known of a world, the first frame is coarser than it must be.
        let finer = self.pace.coarseness(size, self.options.budget.as_secs_f64());
        self.moved = finer < coarseness && !self.shared.desk().calls();
    }

    /// A frame of squares; `false` when it was cancelled.
    fn draw_by(&mut self, subject: &Subject, coarseness: u32, stage: Stage) -> bool {
        let picture = subject.picture();
        let size = coarse_size(picture.size(), coarseness);
        let (control, began) = (Control::default(), Instant::now());
        // What is ready soon is not disturbed.
        let patience = if self.moved { self.options.budget * 2 } else { Duration::ZERO };
        let (toner, gains) = (self.toner_of(picture), subject.gains());
        let (channel, scheduler) = (self.status.channel, self.scheduler);
        let drawn = self.run_unless_called(patience, &control, || {
            let draft = draw(picture, size, channel, &gains, scheduler, &control).ok()?;
            let rgba = toner.picture(&draft.pixels);
            Some((draft, rgba))
        });
        let seconds = began.elapsed().as_secs_f64();
        self.pace.learn(control.samples() as f64, seconds);
        let Some((draft, rgba)) = drawn else { return false };
        self.measure(&control, seconds, stage);
        (self.draft, self.toner, self.canvas, self.retoned) = (Arc::new(draft), toner, None, false);
        (self.status.stage, self.status.coarseness) = (stage, coarseness);
        (self.status.samples, self.status.noise, self.status.hash) = (0.0, None, None);
        (self.status.clamped, self.status.denoised) = (None, false);
        let frame = self.frame(size, rgba, if coarseness == 1 { 1.0 } else { 0.0 });
        self.publish(Some(frame));
        true
    }

    /// Runs `work` on the pool. When something else is to be done, `control` is cancelled, though not before `patience` is over.
    pub fn run_unless_called<T: Send>(
        &self,
        patience: Duration,
        control: &Control,
        work: impl FnOnce() -> Option<T> + Send,
    ) -> Option<T> {
        let (shared, mut result) = (&self.shared, None);
        shared.desk().done = false;
        self.pool.in_place_scope(|scope| {
            scope.spawn(|_| {
                result = work();
                shared.tell(|desk| desk.done = true);
            });
            shared.rest(Some(patience), |desk| desk.done);
            shared.rest(None, |desk| desk.done || desk.calls());
            if !shared.desk().done {
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
        let since = self.drawn.elapsed();
        self.drawn = Instant::now();
        if since < MOTION && stage == Stage::Moving {
            let (now, before) = ((1.0 / since.as_secs_f64().max(1e-6)) as f32, self.status.frames_per_second);
            self.status.frames_per_second = if before > 0.0 { before + (now - before) * NEWEST } else { now };
        }
    }

    fn toner_of(&self, picture: &Picture) -> Toner {
        let of_light = self.status.channel.is_light() || self.status.channel == Channel::Albedo;
        self.toner.toned(if of_light { picture.tone() } else { &screen::PLAIN })
    }

    /// A film for the picture as it is now, with the samples that are there; only the region gets more.
    pub fn refilm(&mut self) {
        let Some(subject) = &self.subject else { return };
        let picture = subject.picture();
        let (layout, wanted, region) = (Layout::new(picture.region()), picture.samples(), self.region);
        let old = self.film.take();
        let counts = old.as_ref().map_or_else(Vec::new, |old| old.counts());
        // Fewer samples than there are: no sum can be taken apart.
        let old = old.filter(|_| counts.iter().all(|count| *count <= wanted));
        let inside = |number: u64| {
            let tile = layout.tile(number);
            region.is_none_or(|region| tile.is_some_and(|tile| tile.intersection(&region).area() > 0))
        };
        let have = |number: u64| old.as_ref().and_then(|_| counts.get(number as usize)).copied().unwrap_or(0);
        let share = |number: u64| (number, 0..if inside(number) { wanted } else { have(number) });
        let film = Film::of(layout, (0..layout.tiles()).map(share));
        for (number, tile) in old.iter().flat_map(|old| old.tiles()) {
            let added = film.add(number, tile);
            debug_assert_eq!(added, Ok(true), "of the same layout, and new");
        }
        self.film = Some(Arc::new(film));
    }

    /// Only this part gets better from now on.
    pub fn confine(&mut self, region: Option<Rect>) {
        let [width, height] = self.status.size;
        let whole = Rect { x: 0, y: 0, width, height };
        let inside = region.map(|region| region.intersection(&whole));
        self.region = inside.filter(|region| region.area() > 0 && *region != whole);
        self.describe();
        self.refilm();
    }

    /// The same samples shown otherwise.
    pub fn repaint(&mut self) {
        self.retoned = false;
        let Some(subject) = self.subject.clone() else { return };
        (self.toner, self.canvas) = (self.toner_of(subject.picture()), None);
        self.status.stage = if self.status.stage == Stage::Finished { Stage::Refining } else { self.status.stage };
        self.show(self.status.samples);
    }

    /// Shows the film as it is, over the draft.
    fn show(&mut self, samples: f32) {
        let Some(film) = self.film.clone() else { return };
        let Some(subject) = self.subject.clone() else { return };
        let (size, wanted, toner) = (self.status.size, self.status.samples_wanted, &self.toner);
        let gains = subject.gains();
        if let Some(pixels) = self.denoised_pixels(&subject).filter(|_| self.status.channel == Channel::Color) {
            let rgba = toner.picture(&pixels);
            self.status.denoised = true;
            let frame = self.frame(size, rgba, samples);
            return self.publish(Some(frame));
        }
        self.status.denoised = false;
        let canvas = self.canvas.get_or_insert_with(|| Canvas::new(&self.draft, size, toner));
        // A whole picture through the pixels' centres looks better than one through one place of each.
        let least = if self.draft.size == size { wanted.min(4) } else { 1 };
        match self.status.channel {
            Channel::Color => canvas.paint(&film, least, |tile| screen::light(toner, subject.light(tile, &gains))),
            Channel::Samples => canvas.paint(&film, 0, |tile| screen::samples(tile, wanted)),
            Channel::Noise => canvas.paint(&film, 0, screen::noise),
            _ => {}
        }
        let rgba = canvas.rgba().to_vec();
        let frame = self.frame(size, rgba, samples);
        self.publish(Some(frame));
    }

    /// Makes the picture better until something else is to be done; `false` when it cannot get better.
    pub fn refine(&mut self) -> bool {
        let Some(subject) = self.subject.clone() else { return false };
        let linger = LINGER.saturating_sub(self.drawn.elapsed());
        if !linger.is_zero() && self.status.stage == Stage::Moving {
            self.shared.rest(Some(linger), |desk| desk.calls());
        }
        // Finer passes over the whole picture, as long as no samples are there to be shown.
        let has_samples = self.film.as_ref().is_some_and(|film| film.samples() > 0);
        if (!self.status.channel.is_light() || !has_samples)
            && let Some(step) = finer(self.draft.size, subject.picture().size())
        {
            return self.draw_by(&subject, step, Stage::Refining) || self.shared.desk().calls();
        }
        if self.film.is_none() {
            self.refilm();
        }
        let Some(film) = self.film.clone() else { return false };
        let finished = render::is_finished(&film, Stop::Evenly);
        if self.denoises(&subject, &film, finished) {
            self.denoise(&subject, &film);
            return true;
        }
        if finished {
            self.finish(&subject, &film);
            return false;
        }
        let control = Control::default();
        {
            let mut desk = self.shared.desk();
            if desk.calls() {
                return true;
            }
            desk.done = false;
        }
        (self.status.stage, self.status.coarseness) = (Stage::Refining, 1);
        self.expose(&subject, &film, &control);
        true
    }

    /// Exposes the film and shows it from time to time, until it is finished, is to be denoised, or something else is to be
    /// done.
    fn expose(&mut self, subject: &Subject, film: &Film, control: &Control) {
        let picture = subject.picture();
        let (shared, pool) = (Arc::clone(&self.shared), Arc::clone(&self.pool));
        let (began, mut interval) = (Instant::now(), FIRST_SHOW);
        pool.in_place_scope(|scope| {
            scope.spawn(|_| {
                // Cancelled or not: what is there stays.
                let _ = render::expose(&picture.job(), film, Stop::Evenly, control);
                shared.tell(|desk| desk.done = true);
            });
            loop {
                shared.rest(Some(interval), |desk| desk.done || desk.calls());
                let (done, called) = shared.desk().state();
                if called {
                    control.cancel();
                }
                if done || called {
                    break;
                }
                self.tell_of(picture, film, control, began);
                if self.denoises(subject, film, false) {
                    control.cancel();
                    break;
                }
                interval = (interval * 3 / 2).min(LAST_SHOW);
            }
        });
    }

    fn tell_of(&mut self, picture: &Picture, film: &Film, control: &Control, began: Instant) {
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
        self.status.noise = screen::noise_of(film);
        self.status.clamped = picture.is_clamped().then(|| screen::clamped_of(film));
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
