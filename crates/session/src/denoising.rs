//! The denoised preview: what the worker shows instead of the film when nothing moves and people asked for it.

use crate::subject::Subject;
use crate::worker::Worker;
use juggler::camera::film::Film;
use juggler::denoise::Guides;
use juggler::math::Rgb;
use juggler::render::Control;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// How long samples pile up before the first of them are denoised.
const FIRST: Duration = Duration::from_millis(700);
/// The share of the time that denoising may take while the film goes on is one over this and one more.
const SPACING: u32 = 4;
/// Samples of a pixel that the filter needs: it compares halves.
const LEAST: u32 = 2;

/// A film's picture without noise.
#[derive(Default)]
pub struct Denoising {
    /// Linear light, row by row from the top; none before the first, or when it failed.
    pixels: Option<Arc<[Rgb]>>,
    /// Samples of the film that it was made of.
    samples: u64,
    /// When the last one was ready, and how long it took.
    last: Option<(Instant, Duration)>,
}

impl Worker {
    /// The picture without noise, where it is asked for and there is one. Where groups of lights are mixed there is none: the
    /// halves that the filter compares hold all lights together.
    pub fn denoised_pixels(&self, subject: &Subject) -> Option<Arc<[Rgb]>> {
        self.denoising.pixels.clone().filter(|_| subject.is_denoised())
    }

    /// Whether the film is to be denoised now: it has enough samples, others than last time, and some time has gone by, or it is
    /// finished.
    pub fn denoises(&self, subject: &Subject, film: &Film, finished: bool) -> bool {
        let due = finished
            || match self.denoising.last {
                Some((ready, took)) => ready.elapsed() >= (took * SPACING).max(FIRST),
                None => self.drawn.elapsed() >= FIRST,
            };
        due && self.status.channel.is_light()
            && subject.is_denoised()
            && film.samples() != self.denoising.samples
            && film.counts().iter().all(|count| *count >= LEAST)
    }

    /// Denoises the film and shows that, unless something else is to be done.
    pub fn denoise(&mut self, subject: &Subject, film: &Film) {
        let (began, control, samples) = (Instant::now(), Control::default(), film.samples());
        let picture = subject.picture();
        let denoised = self.run_unless_called(Duration::ZERO, &control, || {
            let mut guides = Guides::new(picture.region());
            film.tiles().for_each(|(_, tile)| guides.add(picture.layers(), &tile));
            // The filter of our own fails at nothing.
            guides.denoise(picture.layers().denoiser()?, None, &control).ok()?
        });
        if denoised.is_none() && self.shared.desk().calls() {
            return;
        }
        self.denoising = Denoising {
            pixels: denoised.map(|denoised| denoised.pixels.into()),
            samples,
            last: Some((Instant::now(), began.elapsed())),
        };
        self.repaint();
    }
}
