//! Numbers and strings.

use super::names::Family;
use super::{Reference, Walk, words};
use crate::document::Node;
use crate::path::Step;
use crate::report::Finding;
use serde_json::{Number, Value};

impl Walk {
    pub(super) fn number(&mut self, node: &Node, number: &Number, schema: &'static Value) -> Option<Value> {
        let written = number.as_f64().unwrap_or(f64::NAN);
        let whole = !words::allows(schema, "number");
        if whole && written != written.trunc() {
            return self.wrong_number(node, "a whole number", number);
        }
        let single = schema.get("format").is_some_and(|format| format == "float");
        // Limits are meant for the number that will be used: 1e-60 is 0 in 32 bits.
        let value = if single { f64::from(written as f32) } else { written };
        if !value.is_finite() {
            return self.wrong_number(node, "between -3.4e38 and 3.4e38", number);
        }
        if self.path.steps() == [Step::Key("version".into())] && value != 1.0 {
            let message = format!("this is version {number} of the format, this program reads version 1");
            self.report::<()>(node, Finding::error(message));
            // The rest may be right all the same.
            return Some(1.into());
        }
        if let Some(bound) = broken_bound(schema, value) {
            return self.wrong_number(node, &bound, number);
        }
        if whole && number.is_f64() {
            return Some((value as i64).into());
        }
        Some(Value::Number(number.clone()))
    }

    fn wrong_number(&mut self, node: &Node, wanted: &str, number: &Number) -> Option<Value> {
        let subject = match self.path.steps().last() {
            Some(Step::Key(key)) => format!("`{key}`"),
            Some(Step::Index(_)) => match self.path.steps().iter().rev().find(|s| matches!(s, Step::Key(_))) {
                Some(Step::Key(key)) => format!("each number of `{key}`"),
                _ => "each number".into(),
            },
            None => "the number".into(),
        };
        let mut shown = Value::Number(number.clone());
        crate::schema::tidy(&mut shown);
        self.report(node, Finding::error(format!("{subject} must be {wanted}, is {shown}")))
    }

    pub(super) fn string(
        &mut self,
        node: &Node,
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
            self.refer(family, text);
        }
        if schema.get("pattern").is_some() && !is_hex_color(text) {
            let help = "a colour is written \"#rrggbb\": six digits 0-9 or a-f after the #";
            return self.report(node, Finding::error(format!("`{text}` is not a colour")).help(help));
        }
        Some(text.into())
    }

    /// Remembers that a name stands here for something defined elsewhere.
    pub(super) fn refer(&mut self, family: Family, name: &str) {
        self.references.push(Reference { family, name: name.to_owned(), path: self.path.clone() });
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
