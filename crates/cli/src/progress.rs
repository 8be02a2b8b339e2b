//! How far a render is: read from its [`Control`] by a thread of its own, shown on standard error.

use crate::console;
use crate::format::{amount, duration, whole_seconds};
use crate::interrupt::Interrupts;
use clap::ValueEnum;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use juggler::camera::film::Film;
use juggler::render::{Control, noise_so_far};
use serde_json::json;
use std::io::{self, IsTerminal};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::{Duration, Instant};

/// How often signals are looked for.
const TICK: Duration = Duration::from_millis(20);
/// Ticks between two reports on a terminal, and between two lines.
const TICKS: (u32, u32) = (5, 50);
/// Parts that the bar moves by.
const STEPS: u64 = 1000;

/// How progress is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Progress {
    /// A bar when standard error is a terminal
    #[default]
    Auto,
    /// A bar; a line each second when standard error is no terminal
    Bar,
    /// One JSON object a line
    Json,
    /// Nothing
    None,
}

/// Where progress goes.
pub enum Reporter {
    /// A bar on a terminal.
    Bar(ProgressBar),
    /// A line for people each second.
    Lines,
    /// A line for programs each second.
    Json,
    /// Nowhere.
    Nothing,
}

impl Progress {
    /// Looks at what standard error is.
    pub fn reporter(self) -> Reporter {
        let terminal = io::stderr().is_terminal();
        match self {
            Self::Auto | Self::Bar if terminal => Reporter::Bar(bar()),
            Self::Bar => Reporter::Lines,
            Self::Json => Reporter::Json,
            Self::Auto | Self::None => Reporter::Nothing,
        }
    }
}

fn bar() -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(STEPS), ProgressDrawTarget::stderr());
    let style = ProgressStyle::with_template("{prefix}{wide_bar} {msg}").map(|style| style.progress_chars("━━┄"));
    if let Ok(style) = style {
        bar.set_style(style);
    }
    bar
}

/// Where a picture stands among the frames that one command renders.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Course {
    /// Its place, from 1.
    pub number: usize,
    /// How many there are.
    pub of: usize,
    /// How many were rendered, not found.
    pub rendered: u32,
    /// The time that took.
    pub spent: Duration,
}

impl Course {
    /// At the first of some.
    pub fn new(of: usize) -> Self {
        Self { number: 1, of, rendered: 0, spent: Duration::ZERO }
    }

    /// After one that took so long, or was there already.
    pub fn after(self, took: Option<Duration>) -> Self {
        let rendered = self.rendered.saturating_add(took.is_some().into());
        Self { number: self.number + 1, rendered, spent: self.spent + took.unwrap_or_default(), ..self }
    }

    /// How much of all frames is there, with this share of the one under way.
    fn fraction(&self, share: f64) -> f64 {
        ((self.number.saturating_sub(1)) as f64 + share) / self.of.max(1) as f64
    }

    /// How long the rest takes if each frame takes as long as those so far, with this share of the one under way, on which
    /// `now` was spent.
    fn left(&self, share: f64, now: Duration) -> Option<Duration> {
        let rest = self.of.saturating_sub(self.number) as f64 + 1.0 - share;
        let each = (self.spent + now).as_secs_f64() / (f64::from(self.rendered) + share);
        Duration::try_from_secs_f64(each * rest).ok()
    }
}

/// When a render will have enough.
#[derive(Clone, Copy)]
pub enum Goal<'g> {
    /// When all pixels together have so many samples.
    Samples(u64),
    /// After some time; or before, when all pixels together have so many samples.
    Time(Duration, u64),
    /// When a film is this free of noise.
    Noise(&'g Film, f32),
}

/// What else than samples a render goes by.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Toward {
    /// Time that has passed, of the time that there is.
    Time(Duration, Duration),
    /// The largest relative error of a tile, if it can be told yet, and what it is to become.
    Noise(Option<f64>, f32),
}

/// One look at a running render.
struct Look {
    fraction: f64,
    rays: u64,
    rays_per_second: f64,
    eta: Option<Duration>,
    toward: Option<Toward>,
    /// The same of all frames, and which one this is.
    course: Option<(Course, Option<Duration>)>,
}

impl Look {
    fn at(control: &Control, goal: &Goal, start: Instant, course: Option<Course>) -> Self {
        let now = start.elapsed();
        let seconds = now.as_secs_f64();
        let rays = control.rays().total();
        let of_samples = |samples: u64| (control.samples() as f64 / samples.max(1) as f64).min(1.0);
        let left = |fraction: f64| Duration::try_from_secs_f64(seconds * (1.0 - fraction) / fraction).ok();
        let (fraction, eta, toward) = match *goal {
            Goal::Samples(samples) => (of_samples(samples), left(of_samples(samples)), None),
            Goal::Time(limit, samples) => {
                let of_time = (seconds / limit.as_secs_f64().max(1e-9)).min(1.0);
                let fraction = of_time.max(of_samples(samples));
                let eta = limit.saturating_sub(now).min(left(of_samples(samples)).unwrap_or(limit));
                (fraction, Some(eta), Some(Toward::Time(now, limit)))
            }
            Goal::Noise(film, level) => {
                let so_far = noise_so_far(film, level);
                let fraction = so_far.map_or(0.0, |so_far| so_far.fraction);
                // What was there before took no time now.
                let rest = film.samples() as f64 * (1.0 - fraction) / fraction;
                let eta = Duration::try_from_secs_f64(seconds * rest / control.samples() as f64).ok();
                (fraction, eta, Some(Toward::Noise(so_far.map(|so_far| so_far.noise), level)))
            }
        };
        let course = course.map(|course| (course, course.left(fraction, now)));
        Self { fraction, rays, rays_per_second: rays as f64 / seconds.max(1e-9), eta, toward, course }
    }

    /// The share of all frames, or of the only picture.
    fn whole(&self) -> f64 {
        self.course.map_or(self.fraction, |(course, _)| course.fraction(self.fraction))
    }

    fn words(&self) -> String {
        let frame = self.course.map(|(course, _)| format!("frame {} of {}, ", course.number, course.of));
        let percent = self.whole() * 100.0;
        let toward = match self.toward {
            None => String::new(),
            Some(Toward::Time(now, limit)) => format!(", {} of {}", whole_seconds(now), duration(limit)),
            Some(Toward::Noise(None, level)) => format!(", noise not known yet, to become {level}"),
            Some(Toward::Noise(Some(noise), level)) => format!(", noise {noise:.4}, to become {level}"),
        };
        let rate = amount(self.rays_per_second);
        format!("{}{percent:5.1} %{toward}, {rate} rays/s{}", frame.unwrap_or_default(), self.left_in_words())
    }

    /// How long all frames, or the only picture, will take, unless that is told already.
    fn left_in_words(&self) -> String {
        let left = match (self.course, self.toward) {
            (Some((_, left)), _) => left,
            (None, Some(Toward::Time(..))) => None,
            (None, _) => self.eta,
        };
        let left = left.filter(|left| left.as_secs_f64() >= 0.5);
        left.map(|left| format!(", {} left", whole_seconds(left))).unwrap_or_default()
    }

    /// For programs; what several frames add comes last.
    fn json(&self) -> serde_json::Value {
        let seconds = |eta: Option<Duration>| eta.map(|eta| eta.as_secs_f64());
        let mut event = json!({
            "event": "progress", "fraction": self.fraction, "rays": self.rays,
            "rays_per_second": self.rays_per_second, "eta_seconds": seconds(self.eta),
        });
        match self.toward {
            None => {}
            Some(Toward::Time(now, limit)) => {
                event["elapsed_seconds"] = now.as_secs_f64().into();
                event["limit_seconds"] = limit.as_secs_f64().into();
            }
            Some(Toward::Noise(noise, level)) => {
                event["noise"] = noise.into();
                event["noise_limit"] = f64::from(level).into();
            }
        }
        if let Some((course, left)) = self.course {
            event["frame"] = course.number.into();
            event["frames"] = course.of.into();
            event["film_fraction"] = self.whole().into();
            event["film_eta_seconds"] = seconds(left).into();
        }
        event
    }
}

impl Reporter {
    /// Says that a picture begins; `samples` are those of a pixel, where that is known.
    pub fn start(&self, name: &str, size: [u32; 2], samples: Option<u32>, course: Option<Course>) {
        match self {
            Self::Bar(bar) => {
                bar.set_prefix(format!("{name} "));
                bar.set_position(course.map_or(0, |course| (course.fraction(0.0) * STEPS as f64) as u64));
            }
            Self::Json => {
                let mut event = json!({"event": "start", "output": name, "size": size, "samples": samples});
                if let Some(course) = course {
                    event["frame"] = course.number.into();
                    event["frames"] = course.of.into();
                }
                say(&event);
            }
            Self::Lines | Self::Nothing => {}
        }
    }

    fn report(&self, look: &Look) {
        match self {
            Self::Bar(bar) => {
                bar.set_message(look.words());
                bar.set_position((look.whole() * STEPS as f64) as u64);
            }
            Self::Lines => console::say(&look.words()),
            Self::Json => say(&look.json()),
            Self::Nothing => {}
        }
    }

    /// Says that a picture is there.
    pub fn done(&self, name: &str, seconds: f64, rays: u64, hash: &str) {
        match self {
            Self::Bar(bar) => bar.finish_and_clear(),
            Self::Json => {
                say(&json!({"event": "done", "output": name, "seconds": seconds, "rays": rays, "hash": hash}));
            }
            Self::Lines | Self::Nothing => {}
        }
    }

    /// Makes room for an error.
    pub fn clear(&self) {
        if let Self::Bar(bar) = self {
            bar.finish_and_clear();
        }
    }

    /// From one report to the next; noise takes long to tell.
    fn ticks(&self, goal: &Goal) -> Option<u32> {
        match self {
            Self::Nothing => None,
            Self::Bar(_) if !matches!(goal, Goal::Noise(..)) => Some(TICKS.0),
            Self::Bar(_) | Self::Lines | Self::Json => Some(TICKS.1),
        }
    }
}

fn say(event: &serde_json::Value) {
    console::say(&event.to_string());
}

/// What is watched, and what may end it.
pub struct Watch<'w> {
    /// Where progress goes.
    pub reporter: &'w Reporter,
    /// Signals that cancel it.
    pub interrupts: &'w Interrupts,
    /// The render.
    pub control: &'w Control,
    /// When it has enough. One that goes by time is asked to finish then.
    pub goal: Goal<'w>,
    /// Where it stands among several frames.
    pub course: Option<Course>,
}

/// Does `work` while another thread reports on it, cancels it when a signal comes and ends it when its time is over.
pub fn watched<T>(watch: &Watch, work: impl FnOnce() -> T) -> T {
    std::thread::scope(|scope| {
        let (running, ended) = mpsc::channel::<()>();
        scope.spawn(move || {
            let start = Instant::now();
            let mut ticks = 0_u32;
            let Watch { reporter, interrupts, control, goal, course } = *watch;
            while ended.recv_timeout(TICK) == Err(RecvTimeoutError::Timeout) {
                ticks += 1;
                if interrupts.caught().is_some() {
                    control.cancel();
                }
                if matches!(goal, Goal::Time(limit, _) if start.elapsed() >= limit) {
                    control.finish();
                }
                if reporter.ticks(&goal).is_some_and(|each| ticks.is_multiple_of(each)) {
                    reporter.report(&Look::at(control, &goal, start, course));
                }
            }
        });
        let result = work();
        drop(running);
        result
    })
}

#[cfg(test)]
mod tests;
