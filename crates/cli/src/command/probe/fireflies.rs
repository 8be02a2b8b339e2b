//! Fireflies, in words.

use super::words::{number, percent, vector};
use crate::format::counted;
use juggler::probe::{Fireflies, Firefly};

/// All of it.
pub fn to_words(found: &Fireflies) -> String {
    let Fireflies { size: [width, height], integrator, samples, count, excess, sure, .. } = found;
    let samples = counted((*samples).into(), "sample");
    let pixels = counted(*count as u128, "pixel");
    let stand = if *count == 1 { "stands" } else { "stand" };
    let mut lines = vec![
        format!("{width}x{height}, {integrator}, {samples}"),
        format!("{pixels} {stand} out by chance, with {} of the light", percent(*excess)),
    ];
    match sure {
        Some(0) => {}
        Some(sure) => {
            let bright = if *sure == 1 { "1 other is" } else { &format!("{sure} others are") };
            lines.push(format!("{bright} bright by what they show: their samples agree"));
        }
        None => {
            lines.push("of fewer than 32 samples a pixel it is not known which are bright by what they show".into())
        }
    }
    if let Some(clamped) = found.clamped {
        lines.push(format!("clamping removed {} of the light", percent(clamped)));
    }
    if !found.pixels.is_empty() {
        lines.push(String::new());
        lines.push(format!(
            "{:>11}  {:>9} {:>9} {:>9}  {}",
            "pixel", "luminance", "around it", "one sample", "its path"
        ));
        lines.extend(found.pixels.iter().map(row));
    }
    if !found.kinds.is_empty() {
        lines.push(String::new());
        lines.push(format!("by kinds of paths ({} looked into)", counted(found.looked_into as u128, "pixel")));
        lines.push(format!("{:>8} {:>8}  of the light that stands out", "pixels", "share"));
        lines.extend(
            found.kinds.iter().map(|kind| format!("{:>8} {:>8}  {}", kind.pixels, percent(kind.share), kind.path)),
        );
        let rest = 1.0 - found.kinds.iter().map(|kind| kind.share).sum::<f64>();
        if found.looked_into < *count {
            lines.push(format!("{:>8} {:>8}  not looked into", count - found.looked_into, percent(rest)));
        }
    }
    lines.join("\n")
}

fn row(firefly: &Firefly) -> String {
    let Firefly { pixel: [x, y], value, luminance, median, sample, share, path, .. } = firefly;
    let share = share.map(percent).unwrap_or_default();
    let path = match (path, sample) {
        (Some(path), Some(sample)) => format!("{path} (sample {sample})"),
        _ => vector(*value),
    };
    format!("{:>11}  {:>9} {:>9} {share:>10}  {path}", format!("{x},{y}"), number(*luminance), number(*median))
}
