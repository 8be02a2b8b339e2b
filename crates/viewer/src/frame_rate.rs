//! Frame rate of the displayed frames.

/// Measurement interval, in seconds.
const SPAN: f64 = 0.5;

/// Frame counter.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrameRate {
    since: f64,
    frames: u32,
    last: f32,
}

impl FrameRate {
    /// Counts a frame at a time in seconds.
    pub fn count(&mut self, now: f64) {
        self.frames += 1;
        let seconds = now - self.since;
        if seconds >= SPAN {
            let after_a_pause = seconds > 4.0 * SPAN;
            self.last = if after_a_pause { 0.0 } else { (f64::from(self.frames) / seconds) as f32 };
            (self.since, self.frames) = (now, 0);
        }
    }

    /// Returns the frame rate of the last interval.
    pub fn per_second(&self) -> f32 {
        self.last
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frame_rate_is_counted_per_second() {
        let mut rate = FrameRate::default();
        for frame in 0..200 {
            rate.count(100.0 + f64::from(frame) / 50.0);
        }
        assert!((rate.per_second() - 50.0).abs() < 3.0, "{rate:?}");
        rate.count(200.0);
        assert_eq!(rate.per_second(), 0.0);
    }
}
