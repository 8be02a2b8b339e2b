//! Whether noise explains how two pictures differ.

use super::side::Side;
use juggler::imaging::significance::{Significance, Worst, significance};
use serde_json::{Value, json};

/// What is said of noise.
#[derive(Debug, PartialEq)]
pub enum Noise {
    /// Tested against that level.
    Tested {
        /// What the test says.
        found: Significance,
        /// The chance below which they are different.
        level: f64,
        /// What makes it say less than it might.
        note: Option<&'static str>,
    },
    /// They know their variances, but there is no test.
    Untested(String),
}

impl Noise {
    /// Of pictures that both know their variances.
    pub fn of(a: &Side, b: &Side, level: f64) -> Option<Self> {
        let (one, other) = (a.estimate.as_ref()?, b.estimate.as_ref()?);
        let both = |key: &str| a.text(key).is_some() && a.text(key) == b.text(key);
        if both("Fingerprint") {
            let reason =
                "both are of the same scene and seed, so that they share samples: render one with another --seed";
            return Some(Self::Untested(reason.into()));
        }
        if a.is_denoised || b.is_denoised {
            return Some(Self::Untested("noise was taken out of a picture: its variances are those of before".into()));
        }
        let note = both("Seed").then_some("both have the same seed: their noise is alike, which may hide differences");
        Some(match significance(one, other) {
            Ok(found) => Self::Tested { found, level, note },
            Err(reason) => Self::Untested(reason.to_string()),
        })
    }

    /// Whether noise explains all; nothing where that is not known.
    pub fn is_same(&self) -> Option<bool> {
        match self {
            Self::Tested { found, level, .. } => Some(found.p >= *level),
            Self::Untested(_) => None,
        }
    }

    /// `p = 0.43`.
    pub fn chance(&self) -> Option<String> {
        let Self::Tested { found: Significance { p, .. }, .. } = self else { return None };
        Some(match p {
            p if *p < 1e-300 => "p < 1e-300".to_owned(),
            p if *p < 1e-3 => format!("p = {p:.1e}"),
            p => format!("p = {p:.3}"),
        })
    }

    /// What is to be known beside the verdict, line by line.
    pub fn to_words(&self) -> Vec<String> {
        match self {
            Self::Untested(reason) => vec![format!("noise   not tested: {reason}")],
            Self::Tested { found: Significance { blocks, worst, .. }, level, note } => {
                let mut lines = vec![format!("noise   {blocks} blocks of pixels tested at the level {level}")];
                if let Some(Worst { area: [x, y, width, height], channel, deviation }) = worst {
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
                let worst = found.worst.map(|Worst { area, channel, deviation }| {
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
