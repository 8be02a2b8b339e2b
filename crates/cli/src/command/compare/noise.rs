//! Text and JSON of the test whether noise explains the difference between two pictures.

use juggler::comparison::NoiseTest;
use juggler::imaging::significance::{LargestDifference, Significance};
use serde_json::{Value, json};

/// The p-value, such as `p = 0.430`.
pub fn p_value(test: &NoiseTest) -> Option<String> {
    Some(match test.p()? {
        p if p < 1e-300 => "p < 1e-300".to_owned(),
        p if p < 1e-3 => format!("p = {p:.1e}"),
        p => format!("p = {p:.3}"),
    })
}

/// Lines of text beside the verdict.
pub fn to_words(test: &NoiseTest) -> Vec<String> {
    match test {
        NoiseTest::Untested(reason) => vec![format!("noise   not tested: {reason}")],
        NoiseTest::Tested { found: Significance { blocks, worst, .. }, level, note } => {
            let mut lines = vec![format!("noise   {blocks} blocks of pixels tested at significance level {level}")];
            if let Some(LargestDifference { area: [x, y, width, height], channel, deviation }) = worst {
                let channel = ["red", "green", "blue"].get(*channel).copied().unwrap_or_default();
                lines.push(format!(
                    "        most at {x},{y} {width}x{height}: {channel} differs by {deviation:.1} standard errors"
                ));
            }
            lines.extend(note.map(|note| format!("        note: {note}")));
            lines
        }
    }
}

/// The result as JSON.
pub fn to_json(test: &NoiseTest) -> Value {
    match test {
        NoiseTest::Untested(reason) => json!({"same": null, "p": null, "untested": reason}),
        NoiseTest::Tested { found, level, note } => {
            let worst = found.worst.map(|LargestDifference { area, channel, deviation }| {
                json!({"area": area, "channel": channel, "deviation": deviation})
            });
            json!({
                "same": test.is_same(), "p": found.p, "significance": level, "blocks": found.blocks,
                "worst": worst, "note": note,
            })
        }
    }
}
