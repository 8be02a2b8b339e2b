//! What was refused, one line each, and not more of them than somebody would read.

use juggler::math::message::excerpt;
use std::fmt::Display;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Lines in a window of time.
const MOST: u32 = 20;
/// The window.
const WINDOW: Duration = Duration::from_secs(10);
/// Characters of a line.
const LONGEST: usize = 240;

/// The log.
pub struct Refusals {
    log: Box<dyn Fn(&str) + Send + Sync>,
    window: Mutex<Window>,
}

struct Window {
    since: Instant,
    lines: u32,
}

impl Refusals {
    /// Lines go to `log`.
    pub fn new(log: impl Fn(&str) + Send + Sync + 'static) -> Self {
        let window = Window { since: Instant::now(), lines: 0 };
        Self { log: Box::new(log), window: Mutex::new(window) }
    }

    /// Says what was refused, and from whom. `why` holds nothing that was sent.
    pub fn say(&self, who: impl Display, why: &str) {
        let mut window = self.window.lock().unwrap_or_else(PoisonError::into_inner);
        if window.since.elapsed() > WINDOW {
            let kept_back = window.lines.saturating_sub(MOST);
            *window = Window { since: Instant::now(), lines: 0 };
            if kept_back > 0 {
                (self.log)(&format!("refused: {kept_back} more in the meantime"));
            }
        }
        window.lines = window.lines.saturating_add(1);
        if window.lines <= MOST {
            (self.log)(&format!("refused: {who}: {}", excerpt(why, LONGEST)));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;

    #[test]
    fn a_flood_becomes_a_few_short_lines() {
        let lines = Arc::new(Mutex::new(Vec::new()));
        let kept = Arc::clone(&lines);
        let refusals = Refusals::new(move |line| kept.lock().unwrap().push(line.to_owned()));
        (0..1000).for_each(|_| refusals.say("somebody", &"x\n".repeat(1000)));
        let lines = lines.lock().unwrap();
        assert_eq!(lines.len(), MOST as usize);
        assert!(lines.iter().all(|line| line.chars().count() < 300 && !line.contains('\n')));
    }
}
