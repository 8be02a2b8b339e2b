//! Test whether noise explains the difference between two pictures.

use super::side::ComparedPicture;
use juggler::imaging::significance::{LargestDifference, Significance, significance};
use serde_json::{Value, json};

/// Result of the noise test.
#[derive(Debug, PartialEq)]
pub enum NoiseTest {
    /// The test was done.
    Tested {
        /// Result of the test.
        found: Significance,
        /// Significance level.
        level: f64,
        /// Reason why the test may miss differences.
        note: Option<&'static str>,
    },
    /// Both pictures contain variances, but the test does not apply, for this reason.
    Untested(String),
}

impl NoiseTest {
    /// Tests two pictures; `None` unless both contain variances.
    pub fn from_pictures(a: &ComparedPicture, b: &ComparedPicture, level: f64) -> Option<Self> {
        let (one, other) = (a.estimate.as_ref()?, b.estimate.as_ref()?);
        let both = |key: &str| a.text(key).is_some() && a.text(key) == b.text(key);
        if both("Fingerprint") {
            let reason =
                "both pictures have the same scene and seed, so they share samples: render one with another --seed";
            return Some(Self::Untested(reason.into()));
        }
        if a.is_denoised || b.is_denoised {
            return Some(Self::Untested("a picture is denoised, but its variances are those before denoising".into()));
        }
        let note =
            both("Seed").then_some("both pictures have the same seed: their correlated noise may hide differences");
        Some(match significance(one, other) {
            Ok(found) => Self::Tested { found, level, note },
            Err(reason) => Self::Untested(reason.to_string()),
        })
    }

    /// Whether noise explains the difference; `None` if untested.
    pub fn is_same(&self) -> Option<bool> {
        match self {
            Self::Tested { found, level, .. } => Some(found.p >= *level),
            Self::Untested(_) => None,
        }
    }

    /// The p-value, such as `p = 0.430`.
    pub fn p_value(&self) -> Option<String> {
        let Self::Tested { found: Significance { p, .. }, .. } = self else { return None };
        Some(match p {
            p if *p < 1e-300 => "p < 1e-300".to_owned(),
            p if *p < 1e-3 => format!("p = {p:.1e}"),
            p => format!("p = {p:.3}"),
        })
    }

    /// Lines of text beside the verdict.
    pub fn to_words(&self) -> Vec<String> {
        match self {
            Self::Untested(reason) => vec![format!("noise   not tested: {reason}")],
            Self::Tested { found: Significance { blocks, worst, .. }, level, note } => {
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

    pub fn to_json(&self) -> Value {
        match self {
            Self::Untested(reason) => json!({"same": null, "p": null, "untested": reason}),
            Self::Tested { found, level, note } => {
                let worst = found.worst.map(|LargestDifference { area, channel, deviation }| {
                    json!({"area": area, "channel": channel, "deviation": deviation})
                });
                json!({
                    "same": self.is_same(), "p": found.p, "significance": level, "blocks": found.blocks,
                    "worst": worst, "note": note,
                })
            }
        }
    }
}
