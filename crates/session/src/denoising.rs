//! Denoised preview, which the worker displays instead of the film while the camera is at rest.

use crate::subject::Subject;
use crate::worker_state::{DenoisedFilm, Worker};
use juggler::camera::film::Film;
use juggler::denoise::DenoiserInput;
use juggler::render::Control;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Time for which samples accumulate before the first denoising.
const FIRST_DELAY: Duration = Duration::from_millis(700);
/// Pause between two runs as a multiple of the last run's duration: denoising takes at most 1 /
/// (`SPACING` + 1) of the time.
const SPACING: u32 = 4;
/// Minimum number of samples per pixel: the denoiser compares two halves.
const MIN_SAMPLES: u32 = 2;

impl Worker {
    /// Returns whether the film should be denoised now: it has enough samples, more than last time,
    /// and either it is finished or the pause is over.
    pub fn should_denoise(&self, subject: &Subject, film: &Film, finished: bool) -> bool {
        let due = finished
            || match self.samples.denoised.last {
                Some((ready, took)) => ready.elapsed() >= (took * SPACING).max(FIRST_DELAY),
                None => self.pending.drawn.elapsed() >= FIRST_DELAY,
            };
        due && self.status.channel.is_light()
            && subject.is_denoised()
            && film.samples() != self.samples.denoised.samples
            && film.counts().iter().all(|count| *count >= MIN_SAMPLES)
    }

    /// Denoises the film and displays the result; new work for the worker cancels it.
    pub fn denoise(&mut self, subject: &Subject, film: &Film) {
        let (began, control, samples) = (Instant::now(), Control::default(), film.samples());
        let picture = subject.picture();
        let denoised = self.run_cancellable(Duration::ZERO, &control, || {
            let mut input = DenoiserInput::new(picture.region());
            film.tiles().for_each(|(_, tile)| input.add(picture.aovs(), &tile));
            // The own denoiser cannot fail; it returns `None` only when cancelled.
            input.denoise(picture.aovs().denoiser()?, None, &control).ok()?
        });
        if denoised.is_none() && self.shared.mailbox().has_work() {
            return;
        }
        self.samples.denoised =
            DenoisedFilm { picture: denoised.map(Arc::new), samples, last: Some((Instant::now(), began.elapsed())) };
        self.repaint();
    }
}
