//! Formatting of numbers for people.

use juggler::camera::film::FilmSummary;
use juggler::film::counts::SampleCountStats;
use std::time::Duration;

/// A duration such as `12ms`, `1.21s`, `12.3s`, `9m56s` or `2h03m04s`: three digits up to a minute,
/// then whole seconds.
pub fn duration(duration: Duration) -> String {
    match duration.as_secs_f64() {
        seconds if seconds < 0.9995 => format!("{:.0}ms", seconds * 1e3),
        seconds if seconds < 9.995 => format!("{seconds:.2}s"),
        seconds if seconds < 59.95 => format!("{seconds:.1}s"),
        _ => whole_seconds(duration),
    }
}

/// A duration in whole seconds: `4s`, `9m56s`, `2h03m04s`.
pub fn whole_seconds(duration: Duration) -> String {
    let seconds = duration.as_secs().saturating_add(u64::from(duration.subsec_millis() >= 500));
    let (hours, minutes, seconds) = (seconds / 3600, seconds / 60 % 60, seconds % 60);
    match (hours, minutes) {
        (0, 0) => format!("{seconds}s"),
        (0, _) => format!("{minutes}m{seconds:02}s"),
        _ => format!("{hours}h{minutes:02}m{seconds:02}s"),
    }
}

/// `64 samples`, or `16 to 512 samples, 120.5 on average`.
pub fn samples(spread: &SampleCountStats) -> String {
    let SampleCountStats { min, mean, max } = *spread;
    if min == max { counted(max.into(), "sample") } else { format!("{min} to {max} samples, {mean:.1} on average") }
}

/// `1 sample`, `2 samples`.
pub fn counted(count: u128, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}

/// A number with three significant digits: `850`, `12.3 thousand`, `4.56 million`.
pub fn amount(value: f64) -> String {
    let units = [(1e9, " billion"), (1e6, " million"), (1e3, " thousand")];
    let (scale, unit) = units.into_iter().find(|(scale, _)| value >= *scale).unwrap_or((1.0, ""));
    let scaled = value / scale;
    let digits = match scaled {
        _ if unit.is_empty() => 0,
        scaled if scaled < 10.0 => 2,
        scaled if scaled < 100.0 => 1,
        _ => 0,
    };
    format!("{scaled:.digits$}{unit}")
}

/// `512.0 MiB`.
pub fn bytes(bytes: u64) -> String {
    let units = [(1_u64 << 40, "TiB"), (1 << 30, "GiB"), (1 << 20, "MiB"), (1 << 10, "KiB")];
    match units.into_iter().find(|(scale, _)| bytes >= *scale) {
        Some((scale, unit)) => format!("{:.1} {unit}", bytes as f64 / scale as f64),
        None => counted(bytes.into(), "byte"),
    }
}

/// Fraction of the light that clamping removed, as text.
pub fn clamping(film: &FilmSummary) -> String {
    let percent = film.clamped_fraction() * 100.0;
    match film.clamped {
        0.0 => "clamping removed no light".into(),
        _ if percent < 0.1 => "clamping removed less than 0.1 % of the light".into(),
        _ => format!("clamping removed {percent:.1} % of the light"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn durations_are_short() {
        let known = [
            (0, "0ms"),
            (999, "999ms"),
            (1_005, "1.00s"),
            (1_210, "1.21s"),
            (12_340, "12.3s"),
            (59_940, "59.9s"),
            (59_960, "1m00s"),
            (61_000, "1m01s"),
            (596_400, "9m56s"),
            (3_599_700, "1h00m00s"),
            (7_384_250, "2h03m04s"),
            (360_000_001, "100h00m00s"),
        ];
        for (milliseconds, text) in known {
            assert_eq!(duration(Duration::from_millis(milliseconds)), text);
        }
        assert_eq!(whole_seconds(Duration::from_millis(4_400)), "4s");
    }

    #[test]
    fn sample_counts_are_formatted_with_their_range() {
        assert_eq!(
            (samples(&SampleCountStats::uniform(1)), samples(&SampleCountStats::uniform(64))),
            ("1 sample".into(), "64 samples".into())
        );
        let spread = SampleCountStats { min: 16, mean: 120.51, max: 512 };
        assert_eq!(samples(&spread), "16 to 512 samples, 120.5 on average");
    }

    #[test]
    fn amounts_keep_three_digits() {
        let known = [(0.0, "0"), (850.0, "850"), (1_234.0, "1.23 thousand"), (45_600_000.0, "45.6 million")];
        for (value, words) in known {
            assert_eq!(amount(value), words);
        }
        assert_eq!(amount(7.89e11), "789 billion");
        assert_eq!((bytes(1), bytes(1 << 20), bytes(3 << 29)), ("1 byte".into(), "1.0 MiB".into(), "1.5 GiB".into()));
    }
}
