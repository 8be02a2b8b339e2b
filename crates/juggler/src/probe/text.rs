//! Text report of a pixel.

use super::{Branch, FirstHit, LightOrigins, Others, PathEvent, Probe, ProbeVertex, SampleProbe, Share};
use std::fmt;

/// Column at which the numbers of the tree start.
const COLUMN: usize = 60;

/// Formats as the report of `juggler probe`.
impl fmt::Display for Probe {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&report(self))
    }
}

fn report(probe: &Probe) -> String {
    let Probe { pixel: [x, y], size: [width, height], integrator, samples, not_finite, .. } = probe;
    let samples = counted(*samples);
    let mut lines = vec![format!("pixel {x},{y} of {width}x{height}, {integrator}, {samples}")];
    lines.push(row("mean", &mean(probe)));
    if *not_finite > 0 {
        let lost = counted(*not_finite);
        lines.push(row("not finite", &format!("{lost}, counted as black")));
    }
    if probe.clamped != 0.0 {
        lines.push(row("clamped", &format!("{} removed", number(probe.clamped))));
    }
    lines.extend(first_hit(probe.first_hit.as_ref()));
    match &probe.light {
        Some(light) => lines.extend(of_light(light)),
        None => lines.push(format!("the integrator `{integrator}` traces no paths to lights")),
    }
    lines.join("\n")
}

/// `1 sample`, `2 samples`.
fn counted(samples: u32) -> String {
    format!("{samples} sample{}", if samples == 1 { "" } else { "s" })
}

fn row(key: &str, value: &str) -> String {
    format!("{key:10} {value}")
}

fn mean(probe: &Probe) -> String {
    let value = vector(probe.mean);
    match probe.standard_error {
        Some(error) => format!("{value} ± {}", error.map(number).join(" ")),
        None => value,
    }
}

fn first_hit(hit: Option<&FirstHit>) -> Vec<String> {
    let Some(hit) = hit else { return vec![row("first hit", "background")] };
    let FirstHit { object, part, shape, instance, material, point, normal, distance, uv } = hit;
    let part = part.as_ref().map(|part| format!(", {part}")).unwrap_or_default();
    let shape = shape.as_ref().map(|shape| format!(", {shape}")).unwrap_or_default();
    vec![
        row("first hit", &format!("{object}{part}{shape}, instance {instance}, material {material}")),
        row("", &format!("at {}, {} away", vector(*point), number(f64::from(*distance)))),
        row("", &format!("normal {}, uv {}", vector(*normal), uv.map(|value| number(f64::from(value))).join(" "))),
    ]
}

fn of_light(light: &LightOrigins) -> Vec<String> {
    let mut lines = vec![row("light", &shares(&light.shares.kinds))];
    lines.push(row("lights", &shares(&light.shares.lights)));
    if light.shares.groups.len() > 1 {
        lines.push(row("groups", &shares(&light.shares.groups)));
    }
    lines.push(row("segments", &shares(&light.shares.segments)));
    lines.push(String::new());
    lines.push(format!("{:COLUMN$} {:>8} {:>8}", "paths", "samples", "light"));
    branch(&light.paths, 0, &mut lines);
    if !light.brightest.is_empty() {
        lines.push(String::new());
        lines.push("brightest samples".to_owned());
        light.brightest.iter().for_each(|sample| lines.extend(of_sample(sample)));
    }
    lines
}

fn shares(shares: &[Share]) -> String {
    let reported: Vec<String> =
        shares.iter().map(|Share { name, share, .. }| format!("{name} {}", percent(*share))).collect();
    if reported.is_empty() { "none".into() } else { reported.join(", ") }
}

fn branch(branch: &Branch, depth: usize, lines: &mut Vec<String>) {
    if depth > 0 {
        let name = match (&branch.scattering, &branch.light_from) {
            (Some(PathEvent { object, event, .. }), _) => format!("{object} {event}"),
            (None, Some(light)) => format!("> {light}"),
            (None, None) => String::new(),
        };
        lines.push(line(&name, depth, Some(branch.samples), branch.share));
    }
    branch.branches.iter().for_each(|next| self::branch(next, depth + 1, lines));
    if let Some(Others { branches, share, .. }) = &branch.others {
        let name = match branches {
            0 => "longer paths".to_owned(),
            1 => "1 other branch".to_owned(),
            _ => format!("{branches} other branches"),
        };
        lines.push(line(&name, depth + 1, None, *share));
    }
}

fn line(name: &str, depth: usize, samples: Option<u32>, share: f64) -> String {
    let name = format!("{}{name}", "  ".repeat(depth));
    let samples = samples.map(|samples| samples.to_string()).unwrap_or_default();
    format!("{name:COLUMN$} {samples:>8} {:>8}", percent(share))
}

fn of_sample(sample: &SampleProbe) -> Vec<String> {
    let SampleProbe { sample: number, radiance, share, clamped, path, vertices, .. } = sample;
    let share = share.map(|share| format!(", {} of the light", percent(share))).unwrap_or_default();
    let clamped =
        if *clamped > 0.0 { format!(", {} clamped", self::number(f64::from(*clamped))) } else { String::new() };
    let mut lines = vec![format!("  sample {number}: {}{share}{clamped}: {path}", vector(*radiance))];
    lines.extend(vertices.iter().enumerate().map(|(number, vertex)| vertex_line(number + 1, vertex)));
    lines
}

fn vertex_line(number: usize, vertex: &ProbeVertex) -> String {
    let what = match &vertex.scattering {
        Some(PathEvent { object, material, event }) => format!("{object} ({material}) {event}"),
        None => "leaves the scene".to_owned(),
    };
    let at = vertex.point.map(|point| format!(" at {}", vector(point))).unwrap_or_default();
    let lights: Vec<String> = vertex
        .lights
        .iter()
        .map(|light| format!("; {} ({}): {}", light.light, light.how, vector(light.radiance)))
        .collect();
    format!("    {number:>2} {what}{at}, throughput {}{}", vector(vertex.throughput), lights.concat())
}

/// Formats three numbers with four significant digits, separated by spaces.
pub fn vector(values: [f32; 3]) -> String {
    values.map(|value| number(f64::from(value))).join(" ")
}

/// Formats a number with four significant digits: `0.1235`, `12.35`, `1.235e-5`.
pub fn number(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 || !value.is_finite() {
        return if value.is_finite() { "0".into() } else { value.to_string() };
    }
    if !(1e-3..1e5).contains(&size) {
        return format!("{value:.3e}");
    }
    let digits = [1000.0, 100.0, 10.0, 1.0, 0.1, 0.01].iter().take_while(|limit| size < **limit).count();
    let text = format!("{value:.digits$}");
    if digits == 0 { text } else { text.trim_end_matches('0').trim_end_matches('.').to_owned() }
}

/// Formats a fraction as `12.3 %`.
pub fn percent(share: f64) -> String {
    format!("{:.1} %", share * 100.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_four_digits() {
        let reported =
            [0.0, 0.123_456, 12.345_6, 1.0, -2.5, 123_456.0, 1.5e-5, 99_999.4, 0.001, f64::INFINITY].map(number);
        let expected = ["0", "0.1235", "12.35", "1", "-2.5", "1.235e5", "1.500e-5", "99999", "0.001", "inf"];
        assert_eq!(reported, expected);
    }
}
