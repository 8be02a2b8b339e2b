//! Numbers as people read them.

use juggler::tracer::film::Summary;
use std::time::Duration;

/// As the Juggler's ancestors printed it: `1 hour, 2 minutes, 1 second, 5 milliseconds`, without zeros in front.
pub fn duration(duration: Duration) -> String {
    let seconds = duration.as_secs();
    let parts = [
        (u128::from(seconds / 3600), "hour"),
        (u128::from(seconds / 60 % 60), "minute"),
        (u128::from(seconds % 60), "second"),
        (u128::from(duration.subsec_millis()), "millisecond"),
    ];
    let first = parts.iter().position(|(count, _)| *count > 0).unwrap_or(parts.len() - 1);
    let words: Vec<String> = parts.iter().skip(first).map(|(count, unit)| counted(*count, unit)).collect();
    words.join(", ")
}

/// `1 sample`, `2 samples`.
pub fn counted(count: u128, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}

/// `850`, `12.3 thousand`, `4.56 million`, with three digits.
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

/// What clamping took away, in words.
pub fn clamping(film: &Summary) -> String {
    let percent = film.clamped_share() * 100.0;
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
    fn durations_in_words() {
        let known = [
            (0, "0 milliseconds"),
            (1, "1 millisecond"),
            (1_005, "1 second, 5 milliseconds"),
            (61_000, "1 minute, 1 second, 0 milliseconds"),
            (3_600_000, "1 hour, 0 minutes, 0 seconds, 0 milliseconds"),
            (7_384_250, "2 hours, 3 minutes, 4 seconds, 250 milliseconds"),
            (360_000_001, "100 hours, 0 minutes, 0 seconds, 1 millisecond"),
        ];
        for (milliseconds, words) in known {
            assert_eq!(duration(Duration::from_millis(milliseconds)), words);
        }
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
