//! Text report of fireflies.

use crate::format::counted;
use juggler::probe::{Fireflies, Firefly, number, percent, vector};

/// Maximum number of kinds of paths listed.
const MOST_KINDS: usize = 8;

/// Renders the whole report.
pub fn to_words(found: &Fireflies) -> String {
    let Fireflies { size: [width, height], integrator, samples, count, excess, certain, .. } = found;
    let samples = counted((*samples).into(), "sample");
    let pixels = counted(*count as u128, "pixel");
    let stand = if *count == 1 { "stands" } else { "stand" };
    let mut lines = vec![
        format!("{width}x{height}, {integrator}, {samples}"),
        format!("{pixels} {stand} out by chance, with {} of the light", percent(*excess)),
    ];
    match certain {
        Some(0) => {}
        Some(certain) => {
            let bright = if *certain == 1 { "1 other is" } else { &format!("{certain} others are") };
            lines.push(format!("{bright} bright because of the scene: their samples agree"));
        }
        None => {
            lines.push(
                "fewer than 32 samples per pixel do not tell fireflies from small bright details of the scene".into(),
            );
        }
    }
    if let Some(clamped) = found.clamped {
        lines.push(format!("clamping removed {} of the light", percent(clamped)));
    }
    if !found.pixels.is_empty() {
        lines.push(String::new());
        lines.push(format!("{:>11}  {:>9} {:>9} {:>9}  {}", "pixel", "luminance", "neighbors", "one sample", "path"));
        lines.extend(found.pixels.iter().map(row));
    }
    if !found.kinds.is_empty() {
        lines.extend(kinds(found));
    }
    lines.join("\n")
}

/// Lists the kinds of paths that cause fireflies.
fn kinds(found: &Fireflies) -> Vec<String> {
    let (first, others) = found.kinds.split_at(found.kinds.len().min(MOST_KINDS));
    let probed = counted(found.probed as u128, "pixel");
    let mut lines = vec![
        String::new(),
        format!("by kind of path ({probed} probed)"),
        format!("{:>8} {:>8}  of the light that stands out", "pixels", "share"),
    ];
    lines.extend(first.iter().map(|kind| kind_row(kind.pixels, kind.share, &kind.path)));
    if !others.is_empty() {
        let share = others.iter().map(|kind| kind.share).sum();
        let name = counted(others.len() as u128, "other kind");
        lines.push(kind_row(others.iter().map(|kind| kind.pixels).sum(), share, &name));
    }
    let reported: f64 = found.kinds.iter().map(|kind| kind.share).sum();
    if found.probed < found.count {
        lines.push(kind_row(found.count - found.probed, 1.0 - reported, "not probed"));
    }
    lines
}

fn kind_row(pixels: usize, share: f64, path: &str) -> String {
    format!("{pixels:>8} {:>8}  {path}", percent(share))
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
