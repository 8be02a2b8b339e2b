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

/// One look at a running render.
struct Look {
    fraction: f64,
    rays: u64,
    rays_per_second: f64,
    eta: Option<Duration>,
}

impl Look {
    fn at(control: &Control, samples: u64, start: Instant) -> Self {
        let seconds = start.elapsed().as_secs_f64();
        let fraction = (control.samples() as f64 / samples.max(1) as f64).min(1.0);
        let rays = control.rays().total();
        let left = seconds * (1.0 - fraction) / fraction;
        let eta = Duration::try_from_secs_f64(left).ok();
        Self { fraction, rays, rays_per_second: rays as f64 / seconds.max(1e-9), eta }
    }

    fn words(&self) -> String {
        let eta = self.eta.map(|eta| Duration::from_secs(eta.as_secs_f64().round() as u64));
        let eta = eta.filter(|eta| !eta.is_zero());
        let eta = eta.map(|eta| format!(", {} left", duration(eta).replace(", 0 milliseconds", "")));
        let percent = self.fraction * 100.0;
        format!("{percent:5.1} %, {} rays/s{}", amount(self.rays_per_second), eta.unwrap_or_default())
    }
}

impl Reporter {
    /// Says that a picture begins.
    pub fn start(&self, name: &str, size: [u32; 2], samples: u32) {
        match self {
            Self::Bar(bar) => {
                bar.set_prefix(format!("{name} "));
                bar.set_position(0);
            }
            Self::Json => say(&json!({"event": "start", "output": name, "size": size, "samples": samples})),
            Self::Lines | Self::Nothing => {}
        }
    }

    fn report(&self, look: &Look) {
        match self {
            Self::Bar(bar) => {
                bar.set_message(look.words());
                bar.set_position((look.fraction * STEPS as f64) as u64);
            }
            Self::Lines => console::say(&look.words()),
            Self::Json => say(&json!({
                "event": "progress", "fraction": look.fraction, "rays": look.rays,
                "rays_per_second": look.rays_per_second, "eta_seconds": look.eta.map(|eta| eta.as_secs_f64()),
            })),
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
}

/// Does `work` while another thread reports on it, cancels it when a signal comes and ends it when its time is over.
pub fn watched<T>(watch: &Watch, work: impl FnOnce() -> T) -> T {
    std::thread::scope(|scope| {
        let (running, ended) = mpsc::channel::<()>();
        scope.spawn(move || {
            let start = Instant::now();
            let mut ticks = 0;
            let Watch { reporter, interrupts, control, samples, time } = *watch;
            while ended.recv_timeout(TICK) == Err(RecvTimeoutError::Timeout) {
                ticks += 1;
                if interrupts.caught().is_some() {
                    control.cancel();
                }
                if time.is_some_and(|time| start.elapsed() >= time) {
                    control.finish();
                }
                if ticks % reporter.ticks() == 0 {
                    reporter.report(&Look::at(control, samples, start));
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
        let look = Look { fraction: 0.255, rays: 7, rays_per_second: 1.5e6, eta: Some(Duration::from_millis(61_400)) };
        assert_eq!(look.words(), " 25.5 %, 1.50 million rays/s, 1 minute, 1 second left");
        let last = Look { fraction: 0.999, eta: Some(Duration::from_millis(4)), ..look };
        assert_eq!(last.words(), " 99.9 %, 1.50 million rays/s");
        let unknown = Look { fraction: 0.0, rays: 0, rays_per_second: 0.0, eta: None };
        assert_eq!(unknown.words(), "  0.0 %, 0 rays/s");
    }

    #[test]
    fn nothing_rendered_is_nothing_known() {
        let look = Look::at(&Control::default(), 100, Instant::now());
        assert!(look.fraction == 0.0 && look.eta.is_none());
    }
}
