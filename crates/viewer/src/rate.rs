//! How many frames of the picture are shown in a second.

/// Seconds between two readings.
const SPAN: f64 = 0.5;

/// Counts frames.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rate {
    since: f64,
    frames: u32,
    shown: f32,
}

impl Rate {
    /// One more, at a time in seconds.
    pub fn count(&mut self, now: f64) {
        self.frames += 1;
        let seconds = now - self.since;
        if seconds >= SPAN {
            let after_a_pause = seconds > 4.0 * SPAN;
            self.shown = if after_a_pause { 0.0 } else { (f64::from(self.frames) / seconds) as f32 };
            (self.since, self.frames) = (now, 0);
        }
    }

    /// Frames a second, lately.
    pub fn per_second(&self) -> f32 {
        self.shown
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts() {
        let mut rate = Rate::default();
        for frame in 0..200 {
            rate.count(100.0 + f64::from(frame) / 50.0);
        }
        assert!((rate.per_second() - 50.0).abs() < 3.0, "{rate:?}");
        rate.count(200.0);
        assert_eq!(rate.per_second(), 0.0);
    }
}
