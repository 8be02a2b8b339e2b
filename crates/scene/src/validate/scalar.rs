//! Numbers and strings.

use super::names::Family;
use super::{Walk, words};
use crate::document::Node;
use crate::path::Trail;
use crate::report::Finding;
use serde_json::{Number, Value};

impl Walk<'_> {
    pub(super) fn number(
        &mut self,
        node: &Node,
        at: &Trail<'_>,
        number: &Number,
        schema: &'static Value,
    ) -> Option<Value> {
        let written = number.as_f64().unwrap_or(f64::NAN);
        let whole = !words::allows(schema, "number");
        if whole && written != written.trunc() {
            return self.wrong_number(node, at, "a whole number", number);
        }
        let single = schema.get("format").is_some_and(|format| format == "float");
        // Limits are meant for the number that will be used: 1e-60 is 0 in 32 bits.
        let value = if single { f64::from(written as f32) } else { written };
        if !value.is_finite() {
            return self.wrong_number(node, at, "between -3.4e38 and 3.4e38", number);
        }
        if matches!(at, Trail::Key(Trail::Root, "version")) && value != 1.0 {
            let message = format!("this is version {number} of the format, this program reads version 1");
            self.report::<()>(node, at, Finding::error(message));
            // The rest may be right all the same.
            return Some(1.into());
        }
        if let Some(bound) = broken_bound(schema, value) {
            if value == 0.0 && written != 0.0 {
                let message = format!("`{number}` is too small a number: in 32 bits it is 0");
                return self.report(node, at, Finding::error(message).help(format!("it must be {bound}")));
            }
            return self.wrong_number(node, at, &bound, number);
        }
        if whole && number.is_f64() {
            return Some((value as i64).into());
        }
        Some(Value::Number(number.clone()))
    }

    fn wrong_number(&mut self, node: &Node, at: &Trail<'_>, wanted: &str, number: &Number) -> Option<Value> {
        let subject = match (at, at.last_key()) {
            (Trail::Key(..), Some(key)) => format!("`{key}`"),
            (_, Some(key)) => format!("each number of `{key}`"),
            (_, None) => "the number".into(),
        };
        let mut shown = Value::Number(number.clone());
        crate::schema::tidy(&mut shown);
        self.report(node, at, Finding::error(format!("{subject} must be {wanted}, is {shown}")))
    }

    pub(super) fn string(
        &mut self,
        node: &Node,
        at: &Trail<'_>,
        text: &str,
        name: Option<&'static str>,
        schema: &'static Value,
    ) -> Option<Value> {
        let family = match name {
            Some("GroupName") => Some(Family::Group),
            Some("CameraName") => Some(Family::Camera),
            _ => None,
        };
        if let Some(family) = family {
            self.refer(family, node, text, at);
        }
        if schema.get("pattern").is_some() && !is_hex_color(text) {
            let help = "a colour is written [r, g, b], or \"#rrggbb\" with six digits 0-9 or a-f";
            return self.report(node, at, Finding::error(format!("`{text}` is not a colour")).help(help));
        }
        Some(text.into())
    }
}

/// The one pattern that the format has.
pub fn is_hex_color(text: &str) -> bool {
    text.strip_prefix('#').is_some_and(|digits| digits.len() == 6 && digits.bytes().all(|b| b.is_ascii_hexdigit()))
}

/// The bound that a value breaks, in words.
fn broken_bound(schema: &Value, value: f64) -> Option<String> {
    let bound = |key: &str| schema.get(key).and_then(Value::as_f64);
    let (least, most) = (bound("minimum"), bound("maximum").or_else(|| largest(schema)));
    if let (Some(least), Some(most)) = (least, most) {
        let broken = value < least || value > most;
        return broken.then(|| format!("between {} and {}", shown(least), shown(most)));
    }
    let rules = [
        (bound("exclusiveMinimum").filter(|b| value <= *b), "greater than"),
        (bound("exclusiveMaximum").filter(|b| value >= *b), "less than"),
        (least.filter(|b| value < *b), "at least"),
        (most.filter(|b| value > *b), "at most"),
    ];
    rules.into_iter().find_map(|(broken, words)| broken.map(|bound| format!("{words} {}", shown(bound))))
}

/// The largest number of an integer type, where the schema leaves it to the format's name.
fn largest(schema: &Value) -> Option<f64> {
    match schema.get("format").and_then(Value::as_str)? {
        "uint32" => Some(u32::MAX.into()),
        // The largest double below 2^64.
        "uint64" => Some(18_446_744_073_709_549_568.0),
        "int32" => Some(i32::MAX.into()),
        _ => None,
    }
}

fn shown(bound: f64) -> String {
    if bound.abs() >= 1.0e16 { format!("{bound:e}") } else { bound.to_string() }
}
