//! How far a render is: read from its [`Control`] by a thread of its own, shown on standard error.

use crate::console;
use crate::format::{amount, duration};
use crate::interrupt::Interrupts;
use clap::ValueEnum;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use juggler::tracer::render::Control;
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

/// One look at a running render.
struct Look {
    fraction: f64,
    rays: u64,
    rays_per_second: f64,
    eta: Option<Duration>,
    /// The same of all frames, and which one this is.
    course: Option<(Course, Option<Duration>)>,
}

impl Look {
    fn at(control: &Control, samples: u64, start: Instant, course: Option<Course>) -> Self {
        let now = start.elapsed();
        let seconds = now.as_secs_f64();
        let fraction = (control.samples() as f64 / samples.max(1) as f64).min(1.0);
        let rays = control.rays().total();
        let left = seconds * (1.0 - fraction) / fraction;
        let eta = Duration::try_from_secs_f64(left).ok();
        let course = course.map(|course| (course, course.left(fraction, now)));
        Self { fraction, rays, rays_per_second: rays as f64 / seconds.max(1e-9), eta, course }
    }

    /// The share of all frames, or of the only picture.
    fn whole(&self) -> f64 {
        self.course.map_or(self.fraction, |(course, _)| course.fraction(self.fraction))
    }

    fn words(&self) -> String {
        let eta = self.course.map_or(self.eta, |(_, left)| left);
        let eta = eta.map(|eta| Duration::from_secs(eta.as_secs_f64().round() as u64));
        let eta = eta.filter(|eta| !eta.is_zero());
        let eta = eta.map(|eta| format!(", {} left", duration(eta).replace(", 0 milliseconds", "")));
        let percent = self.fraction * 100.0;
        let frame = self.course.map(|(course, _)| format!("frame {} of {}, ", course.number, course.of));
        let rate = amount(self.rays_per_second);
        format!("{}{percent:5.1} %, {rate} rays/s{}", frame.unwrap_or_default(), eta.unwrap_or_default())
    }

    /// For programs; what several frames add comes last.
    fn json(&self) -> serde_json::Value {
        let seconds = |eta: Option<Duration>| eta.map(|eta| eta.as_secs_f64());
        let mut event = json!({
            "event": "progress", "fraction": self.fraction, "rays": self.rays,
            "rays_per_second": self.rays_per_second, "eta_seconds": seconds(self.eta),
        });
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
    /// Says that a picture begins.
    pub fn start(&self, name: &str, size: [u32; 2], samples: u32, course: Option<Course>) {
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

    fn ticks(&self) -> u32 {
        if matches!(self, Self::Bar(_)) { TICKS.0 } else { TICKS.1 }
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
    /// Samples that it is to take, over all pixels.
    pub samples: u64,
    /// How long it may take before it is asked to finish.
    pub time: Option<Duration>,
    /// Where it stands among several frames.
    pub course: Option<Course>,
}

/// Does `work` while another thread reports on it, cancels it when a signal comes and ends it when its time is over.
pub fn watched<T>(watch: &Watch, work: impl FnOnce() -> T) -> T {
    std::thread::scope(|scope| {
        let (running, ended) = mpsc::channel::<()>();
        scope.spawn(move || {
            let start = Instant::now();
            let mut ticks = 0;
            let Watch { reporter, interrupts, control, samples, time, course } = *watch;
            while ended.recv_timeout(TICK) == Err(RecvTimeoutError::Timeout) {
                ticks += 1;
                if interrupts.caught().is_some() {
                    control.cancel();
                }
                if time.is_some_and(|time| start.elapsed() >= time) {
                    control.finish();
                }
                if ticks % reporter.ticks() == 0 {
                    reporter.report(&Look::at(control, samples, start, course));
                }
            }
        });
        let result = work();
        drop(running);
        result
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn looks_in_words() {
        let eta = Some(Duration::from_millis(61_400));
        let look = Look { fraction: 0.255, rays: 7, rays_per_second: 1.5e6, eta, course: None };
        assert_eq!(look.words(), " 25.5 %, 1.50 million rays/s, 1 minute, 1 second left");
        let last = Look { fraction: 0.999, eta: Some(Duration::from_millis(4)), ..look };
        assert_eq!(last.words(), " 99.9 %, 1.50 million rays/s");
        let unknown = Look { fraction: 0.0, rays: 0, rays_per_second: 0.0, eta: None, course: None };
        assert_eq!(unknown.words(), "  0.0 %, 0 rays/s");
    }

    #[test]
    fn frames_have_their_time_together() {
        let second = Course::new(4).after(Some(Duration::from_secs(10)));
        assert_eq!(second.left(0.5, Duration::from_secs(5)), Some(Duration::from_secs(25)));
        assert_eq!(second.fraction(0.5), 0.375);
        // What was there already tells nothing of how long the others take.
        let third = second.after(None);
        assert_eq!((third.number, third.left(0.5, Duration::from_secs(5))), (3, Some(Duration::from_secs(15))));
        assert_eq!(Course::new(4).left(0.0, Duration::ZERO), None);
        let course = Some((second, Some(Duration::from_secs(25))));
        let look = Look { fraction: 0.5, rays: 7, rays_per_second: 1.5e6, eta: None, course };
        assert_eq!(look.words(), "frame 2 of 4,  50.0 %, 1.50 million rays/s, 25 seconds left");
        assert_eq!((look.whole(), look.json()["film_eta_seconds"].as_f64()), (0.375, Some(25.0)));
    }

    #[test]
    fn nothing_rendered_is_nothing_known() {
        let look = Look::at(&Control::default(), 100, Instant::now(), None);
        assert!(look.fraction == 0.0 && look.eta.is_none());
    }
}
