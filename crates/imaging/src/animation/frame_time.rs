//! Frame durations as fractions of a second and in clock ticks.

/// Frame duration in seconds as numerator and denominator, neither above `limit`. Exact for integer
/// rates, for NTSC rates (24000/1001) and for rates with up to three decimals.
pub(super) fn duration(frames_per_second: f64, limit: u32) -> (u32, u32) {
    let max = f64::from(limit);
    if frames_per_second.fract() == 0.0 {
        return (1, frames_per_second.min(max) as u32);
    }
    // Choose the numerator of least error: 24000/1001 frames per second become 1001/24000 s.
    let scales = [1001.0, 1000.0, 500.0, 100.0, 10.0, 1.0];
    let fits = |scale: &f64| (frames_per_second * scale).round() <= max;
    let error = |scale: f64| ((frames_per_second * scale).round() / scale - frames_per_second).abs();
    let best = scales.into_iter().filter(fits).min_by(|a, b| error(*a).total_cmp(&error(*b))).unwrap_or(1.0);
    (best as u32, ((frames_per_second * best).round() as u32).max(1))
}

/// Durations of successive frames in whole ticks, whose rounding errors do not accumulate.
#[derive(Clone, Copy, Debug)]
pub(super) struct Clock {
    ticks_per_second: f64,
    frames_per_second: f64,
    frame: u32,
}

impl Clock {
    pub fn new(ticks_per_second: f64, frames_per_second: f64) -> Self {
        Self { ticks_per_second, frames_per_second, frame: 0 }
    }

    /// Duration of the next frame in ticks.
    pub fn tick(&mut self) -> u64 {
        let until = |frame: u32| ticks_until(frame, self.ticks_per_second, self.frames_per_second);
        let ticks = until(self.frame + 1) - until(self.frame);
        self.frame += 1;
        ticks
    }
}

/// Start time of a frame in ticks, rounded.
fn ticks_until(frame: u32, ticks_per_second: f64, frames_per_second: f64) -> u64 {
    (f64::from(frame) * ticks_per_second / frames_per_second).round() as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_as_exact_as_their_bits_allow() {
        let short = |rate: f64| duration(rate, 65_535);
        assert_eq!([1.0, 24.0, 30.0, 1000.0].map(short), [(1, 1), (1, 24), (1, 30), (1, 1000)]);
        assert_eq!(short(24_000.0 / 1001.0), (1001, 24_000));
        assert_eq!(duration(60_000.0 / 1001.0, u32::MAX), (1001, 60_000));
        assert_eq!(short(12.5), (1000, 12_500));
        assert_eq!(short(0.01), (1000, 10));
        for rate in [0.03, 0.7, 23.976, 29.97, 59.94, 119.88, 999.5] {
            let (numerator, denominator) = short(rate);
            assert!((f64::from(denominator) / f64::from(numerator) / rate - 1.0).abs() < 5e-3, "{rate}");
        }
    }

    #[test]
    fn rounded_frame_times_do_not_drift() {
        assert_eq!((0..4).map(|frame| ticks_until(frame, 100.0, 30.0)).collect::<Vec<_>>(), [0, 3, 7, 10]);
        assert_eq!(ticks_until(u32::MAX, 1000.0, 1000.0), u64::from(u32::MAX));
    }
}
