//! Log of refusals, one line each, with a rate limit.

use juggler::math::message::excerpt;
use std::fmt::Display;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Maximum number of lines per window.
const MAX_LINES: u32 = 20;
/// Window of the rate limit.
const WINDOW: Duration = Duration::from_secs(10);
/// Maximum length of a line, in characters.
const MAX_CHARACTERS: usize = 240;

/// Log of refusals with a rate limit.
pub struct RefusalLog {
    log: Box<dyn Fn(&str) + Send + Sync>,
    window: Mutex<Window>,
}

struct Window {
    since: Instant,
    lines: u32,
}

impl RefusalLog {
    /// Creates a log that passes lines to `log`.
    pub fn new(log: impl Fn(&str) + Send + Sync + 'static) -> Self {
        let window = Window { since: Instant::now(), lines: 0 };
        Self { log: Box::new(log), window: Mutex::new(window) }
    }

    /// Logs a refusal. `why` must not contain received data.
    pub fn log(&self, who: impl Display, why: &str) {
        let mut window = self.window.lock().unwrap_or_else(PoisonError::into_inner);
        if window.since.elapsed() > WINDOW {
            let kept_back = window.lines.saturating_sub(MAX_LINES);
            *window = Window { since: Instant::now(), lines: 0 };
            if kept_back > 0 {
                (self.log)(&format!("refused: {kept_back} more in the meantime"));
            }
        }
        window.lines = window.lines.saturating_add(1);
        if window.lines <= MAX_LINES {
            (self.log)(&format!("refused: {who}: {}", excerpt(why, MAX_CHARACTERS)));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;

    #[test]
    fn rejection_log_limits_lines_and_their_length() {
        let lines = Arc::new(Mutex::new(Vec::new()));
        let kept = Arc::clone(&lines);
        let refusals = RefusalLog::new(move |line| kept.lock().unwrap().push(line.to_owned()));
        (0..1000).for_each(|_| refusals.log("somebody", &"x\n".repeat(1000)));
        let lines = lines.lock().unwrap();
        assert_eq!(lines.len(), MAX_LINES as usize);
        assert!(lines.iter().all(|line| line.chars().count() < 300 && !line.contains('\n')));
    }
}
