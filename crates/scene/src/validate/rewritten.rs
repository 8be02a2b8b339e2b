//! Right forms of values in a wrong form: `"0.5"` for 0.5, `"1920x1080"` for [1920, 1080], the
//! name of a file for `{"file": ...}`.

use super::other_programs::{MAX_VALUE, is_valid_excerpt, json_line, shown};
use super::rule::Rule;
use crate::document::{FileId, Node, Value, parse};
use crate::path::PathRef;
use juggler_math::Rgb;
use std::iter::once;

/// Maximum length of a shown value, in bytes.
const MAX_TEXT: usize = 2 * MAX_VALUE;

impl Rule {
    /// Help that shows a value in the form that this rule allows; `None` if no form fits.
    pub fn rewritten(&'static self, node: &Node, at: &PathRef<'_>) -> Option<String> {
        let fits = |text: &String| parse(text, FileId::MAIN).is_ok_and(|(node, _)| is_valid_excerpt(&node, self));
        let Some(text) = candidates(node).into_iter().filter(|text| text.len() <= MAX_TEXT).find(fits) else {
            let is_list = matches!(node.value, Value::Object(_)) && self.types.array;
            let key = at.last_key().filter(|_| is_list)?;
            return Some(format!("write a list in [ ]: \"{key}\": [...]"));
        };
        let is_scalar = !text.starts_with(['[', '{']);
        Some(match (&node.value, at) {
            (Value::String(_), _) if is_scalar => format!("write {text} without quotes"),
            (_, PathRef::Key(_, key)) => format!("write \"{key}\": {text}"),
            _ => format!("write {text}"),
        })
    }

    /// Help for a color with a fourth channel: three channels, and the opacity.
    pub fn color_with_alpha(node: &Node) -> Option<String> {
        let (color, alpha) = match &node.value {
            Value::Array(channels) => {
                let channels =
                    channels.iter().map(|channel| json_line(channel, MAX_VALUE)).collect::<Option<Vec<_>>>()?;
                let [r, g, b, alpha] = channels.as_slice() else { return None };
                (format!("[{r}, {g}, {b}]"), alpha.clone())
            }
            Value::String(text) => {
                let digits = text.strip_prefix('#').filter(|digits| [4, 8].contains(&digits.len()))?;
                let (color, alpha) = digits.split_at_checked(digits.len() / 4 * 3)?;
                Rgb::from_css(&format!("#{color}"))?;
                let level = u8::from_str_radix(alpha, 16).ok()?;
                let most = if alpha.len() == 1 { 15.0 } else { 255.0 };
                (format!("\"#{color}\""), shown((f64::from(level) / most * 1000.0).round() / 1000.0))
            }
            _ => return None,
        };
        Some(format!("write {color}; opacity is no part of a color: `principled` and `mask` have \"opacity\": {alpha}"))
    }
}

/// JSON texts that a value may stand for.
fn candidates(node: &Node) -> Vec<String> {
    let list = |values: Vec<String>| format!("[{}]", values.join(", "));
    match &node.value {
        Value::String(text) => of_text(text),
        Value::Bool(value) => vec![u8::from(*value).to_string()],
        Value::Object(members) => {
            let values = members.values().map(|member| json_line(&member.node, MAX_VALUE));
            let alone = json_line(node, MAX_VALUE).filter(|_| !members.is_empty()).map(|object| list(vec![object]));
            alone.into_iter().chain(values.collect::<Option<_>>().map(list)).collect()
        }
        _ => Vec::new(),
    }
}

/// JSON texts that a string may stand for: a number, numbers, a truth value or a file.
fn of_text(text: &str) -> Vec<String> {
    if text.len() > MAX_VALUE {
        return Vec::new();
    }
    let is_separator = |c: char| c.is_whitespace() || ",;x×()[]".contains(c);
    let number = |text: &str| text.parse().ok().filter(|number: &f64| number.is_finite()).map(json_number);
    let numbers = text.split(is_separator).filter(|part| !part.is_empty()).map(number);
    let plain = number(text.trim()).or_else(|| ["true", "false"].contains(&text).then(|| text.to_owned()));
    let numbers = numbers.collect::<Option<Vec<String>>>().filter(|numbers| numbers.len() > 1);
    let numbers = numbers.map(|numbers| format!("[{}]", numbers.join(", ")));
    let files = text.contains('.').then(|| serde_json::to_string(text).ok()).flatten().into_iter().flat_map(|name| {
        let file = format!("{{\"file\": {name}}}");
        let inside = ["environment", "image", "mesh"].map(|kind| format!("{{\"{kind}\": {file}}}"));
        once(file).chain(inside)
    });
    plain.into_iter().chain(numbers).chain(files).collect()
}

/// A number as JSON: all digits of a whole one, at most six of others.
fn json_number(number: f64) -> String {
    if number == number.trunc() { number.to_string() } else { shown(number) }
}
