//! Progress reports: a thread reads the [`Control`] of a render and prints to standard error.

use crate::console;
use crate::format::{amount, duration, whole_seconds};
use crate::interrupt::{Interrupts, TICK};
use clap::ValueEnum;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use juggler::camera::film::Film;
use juggler::render::{Control, estimate_noise};
use serde_json::json;
use std::io::{self, IsTerminal};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::{Duration, Instant};

/// Ticks between updates of the bar, and between lines.
const TICKS: (u32, u32) = (5, 50);
/// Number of steps of the bar.
const STEPS: u64 = 1000;

/// Form of progress reports.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Progress {
    /// Bar if standard error is a terminal
    #[default]
    Auto,
    /// Bar, or a line per second if standard error is no terminal
    Bar,
    /// JSON object per line
    Json,
    /// No progress reports
    None,
}

/// Destination of progress reports.
pub enum Reporter {
    /// Bar on a terminal.
    Bar(ProgressBar),
    /// Line of text per second.
    Lines,
    /// JSON object per second.
    Json,
    /// No reports.
    Nothing,
}

impl Progress {
    /// Selects the reporter, depending on whether standard error is a terminal.
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

/// Position of a picture among the frames of a command.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameProgress {
    /// Number of the frame, from 1.
    pub number: usize,
    /// Number of frames.
    pub count: usize,
    /// Number of frames rendered so far; existing ones do not count.
    pub rendered: u32,
    /// Time spent on the rendered frames.
    pub spent: Duration,
}

impl FrameProgress {
    /// Position of the first of `count` frames.
    pub fn new(count: usize) -> Self {
        Self { number: 1, count, rendered: 0, spent: Duration::ZERO }
    }

    /// Position after a frame that took this time; `None` if it existed already.
    pub fn after(self, took: Option<Duration>) -> Self {
        let rendered = self.rendered.saturating_add(took.is_some().into());
        Self { number: self.number + 1, rendered, spent: self.spent + took.unwrap_or_default(), ..self }
    }

    /// Finished fraction of all frames; `share` is that of the current frame.
    fn fraction(&self, share: f64) -> f64 {
        ((self.number.saturating_sub(1)) as f64 + share) / self.count.max(1) as f64
    }

    /// Remaining time, from the mean time per frame. `share` is the finished fraction of the
    /// current frame and `now` the time spent on it.
    fn left(&self, share: f64, now: Duration) -> Option<Duration> {
        let rest = self.count.saturating_sub(self.number) as f64 + 1.0 - share;
        let each = (self.spent + now).as_secs_f64() / (f64::from(self.rendered) + share);
        Duration::try_from_secs_f64(each * rest).ok()
    }
}

/// Criterion that ends a render.
#[derive(Clone, Copy)]
pub enum Goal<'g> {
    /// Number of samples over all pixels.
    Samples(u64),
    /// Time limit, and number of samples over all pixels, whichever is reached first.
    Time(Duration, u64),
    /// Film and its target noise level.
    Noise(&'g Film, f32),
}

/// Progress towards a goal other than a number of samples.
#[derive(Clone, Copy, Debug, PartialEq)]
enum GoalProgress {
    /// Elapsed time and time limit.
    Time(Duration, Duration),
    /// Largest relative error of a tile, if known yet, and the target level.
    Noise(Option<f64>, f32),
}

/// Snapshot of a running render.
struct Snapshot {
    fraction: f64,
    rays: u64,
    rays_per_second: f64,
    eta: Option<Duration>,
    goal_progress: Option<GoalProgress>,
    /// Position among the frames, and the remaining time of all frames.
    frame_progress: Option<(FrameProgress, Option<Duration>)>,
}

impl Snapshot {
    fn at(control: &Control, goal: &Goal, start: Instant, frame_progress: Option<FrameProgress>) -> Self {
        let now = start.elapsed();
        let seconds = now.as_secs_f64();
        let rays = control.rays().total();
        let of_samples = |samples: u64| (control.samples() as f64 / samples.max(1) as f64).min(1.0);
        let left = |fraction: f64| Duration::try_from_secs_f64(seconds * (1.0 - fraction) / fraction).ok();
        let (fraction, eta, goal_progress) = match *goal {
            Goal::Samples(samples) => (of_samples(samples), left(of_samples(samples)), None),
            Goal::Time(limit, samples) => {
                let of_time = (seconds / limit.as_secs_f64().max(1e-9)).min(1.0);
                let fraction = of_time.max(of_samples(samples));
                let eta = limit.saturating_sub(now).min(left(of_samples(samples)).unwrap_or(limit));
                (fraction, Some(eta), Some(GoalProgress::Time(now, limit)))
            }
            Goal::Noise(film, level) => {
                let so_far = estimate_noise(film, level);
                let fraction = so_far.map_or(0.0, |so_far| so_far.fraction);
                // Samples that were resumed took no time in this run.
                let rest = film.samples() as f64 * (1.0 - fraction) / fraction;
                let eta = Duration::try_from_secs_f64(seconds * rest / control.samples() as f64).ok();
                (fraction, eta, Some(GoalProgress::Noise(so_far.map(|so_far| so_far.noise), level)))
            }
        };
        let frame_progress = frame_progress.map(|frame_progress| (frame_progress, frame_progress.left(fraction, now)));
        Self { fraction, rays, rays_per_second: rays as f64 / seconds.max(1e-9), eta, goal_progress, frame_progress }
    }

    /// Finished fraction of all frames, or of the only picture.
    fn whole(&self) -> f64 {
        self.frame_progress.map_or(self.fraction, |(frame_progress, _)| frame_progress.fraction(self.fraction))
    }

    fn text(&self) -> String {
        let frame = self
            .frame_progress
            .map(|(frame_progress, _)| format!("frame {} of {}, ", frame_progress.number, frame_progress.count));
        let percent = self.whole() * 100.0;
        let goal_progress = match self.goal_progress {
            None => String::new(),
            Some(GoalProgress::Time(now, limit)) => format!(", {} of {}", whole_seconds(now), duration(limit)),
            Some(GoalProgress::Noise(None, level)) => format!(", noise not known yet, target {level}"),
            Some(GoalProgress::Noise(Some(noise), level)) => format!(", noise {noise:.4}, target {level}"),
        };
        let rate = amount(self.rays_per_second);
        format!("{}{percent:5.1} %{goal_progress}, {rate} rays/s{}", frame.unwrap_or_default(), self.remaining_text())
    }

    /// Remaining time of all frames or of the only picture, unless the time limit shows it already.
    fn remaining_text(&self) -> String {
        let left = match (self.frame_progress, self.goal_progress) {
            (Some((_, left)), _) => left,
            (None, Some(GoalProgress::Time(..))) => None,
            (None, _) => self.eta,
        };
        let left = left.filter(|left| left.as_secs_f64() >= 0.5);
        left.map(|left| format!(", {} left", whole_seconds(left))).unwrap_or_default()
    }

    /// JSON event; the keys for several frames come last.
    fn json(&self) -> serde_json::Value {
        let seconds = |eta: Option<Duration>| eta.map(|eta| eta.as_secs_f64());
        let mut event = json!({
            "event": "progress", "fraction": self.fraction, "rays": self.rays,
            "rays_per_second": self.rays_per_second, "eta_seconds": seconds(self.eta),
        });
        match self.goal_progress {
            None => {}
            Some(GoalProgress::Time(now, limit)) => {
                event["elapsed_seconds"] = now.as_secs_f64().into();
                event["limit_seconds"] = limit.as_secs_f64().into();
            }
            Some(GoalProgress::Noise(noise, level)) => {
                event["noise"] = noise.into();
                event["noise_limit"] = f64::from(level).into();
            }
        }
        if let Some((frame_progress, left)) = self.frame_progress {
            event["frame"] = frame_progress.number.into();
            event["frames"] = frame_progress.count.into();
            event["film_fraction"] = self.whole().into();
            event["film_eta_seconds"] = seconds(left).into();
        }
        event
    }
}

impl Reporter {
    /// Reports the start of a picture; `samples` is the number per pixel, if known.
    pub fn start(&self, name: &str, size: [u32; 2], samples: Option<u32>, frame_progress: Option<FrameProgress>) {
        match self {
            Self::Bar(bar) => {
                bar.set_prefix(format!("{name} "));
                bar.set_position(
                    frame_progress.map_or(0, |frame_progress| (frame_progress.fraction(0.0) * STEPS as f64) as u64),
                );
            }
            Self::Json => {
                let mut event = json!({"event": "start", "output": name, "size": size, "samples": samples});
                if let Some(frame_progress) = frame_progress {
                    event["frame"] = frame_progress.number.into();
                    event["frames"] = frame_progress.count.into();
                }
                print_event(&event);
            }
            Self::Lines | Self::Nothing => {}
        }
    }

    fn report(&self, snapshot: &Snapshot) {
        match self {
            Self::Bar(bar) => {
                bar.set_message(snapshot.text());
                bar.set_position((snapshot.whole() * STEPS as f64) as u64);
            }
            Self::Lines => console::print_message(&snapshot.text()),
            Self::Json => print_event(&snapshot.json()),
            Self::Nothing => {}
        }
    }

    /// Reports the end of a picture.
    pub fn done(&self, name: &str, seconds: f64, rays: u64, hash: &str) {
        match self {
            Self::Bar(bar) => bar.finish_and_clear(),
            Self::Json => {
                print_event(&json!({"event": "done", "output": name, "seconds": seconds, "rays": rays, "hash": hash}));
            }
            Self::Lines | Self::Nothing => {}
        }
    }

    /// Removes the bar, before an error is printed.
    pub fn clear(&self) {
        if let Self::Bar(bar) = self {
            bar.finish_and_clear();
        }
    }

    /// Ticks between reports; noise is expensive to estimate.
    fn ticks(&self, goal: &Goal) -> Option<u32> {
        match self {
            Self::Nothing => None,
            Self::Bar(_) if !matches!(goal, Goal::Noise(..)) => Some(TICKS.0),
            Self::Bar(_) | Self::Lines | Self::Json => Some(TICKS.1),
        }
    }
}

fn print_event(event: &serde_json::Value) {
    console::print_message(&event.to_string());
}

/// A render to watch.
pub struct Watch<'w> {
    /// Destination of progress reports.
    pub reporter: &'w Reporter,
    /// Signals that cancel the render.
    pub interrupts: &'w Interrupts,
    /// Control of the render.
    pub control: &'w Control,
    /// Goal of the render; a time limit ends it.
    pub goal: Goal<'w>,
    /// Position among several frames.
    pub frame_progress: Option<FrameProgress>,
}

/// Runs `work` while another thread reports its progress, cancels it on a signal, and ends it at
/// its time limit.
pub fn with_progress<T>(watch: &Watch, work: impl FnOnce() -> T) -> T {
    std::thread::scope(|scope| {
        let (running, ended) = mpsc::channel::<()>();
        scope.spawn(move || {
            let start = Instant::now();
            let mut ticks = 0_u32;
            let Watch { reporter, interrupts, control, goal, frame_progress } = *watch;
            while ended.recv_timeout(TICK) == Err(RecvTimeoutError::Timeout) {
                ticks += 1;
                if interrupts.caught().is_some() {
                    control.cancel();
                }
                if matches!(goal, Goal::Time(limit, _) if start.elapsed() >= limit) {
                    control.finish();
                }
                if reporter.ticks(&goal).is_some_and(|each| ticks.is_multiple_of(each)) {
                    reporter.report(&Snapshot::at(control, &goal, start, frame_progress));
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
