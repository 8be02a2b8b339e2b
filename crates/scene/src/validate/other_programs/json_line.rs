//! JSON on one line, for messages.

use crate::document::{Node, Value};

/// A value as JSON of at most `max` bytes; `None` for a longer or an invalid one.
pub fn json_line(node: &Node, max: usize) -> Option<String> {
    let mut text = String::new();
    write(node, max, &mut text)?;
    Some(text)
}

/// A computed number with at most six significant digits.
pub fn shown(number: f64) -> String {
    // Adding zero removes the sign of a negative zero.
    let rounded: f64 = format!("{number:.5e}").parse().unwrap_or(number);
    (rounded + 0.0).to_string()
}

fn write(node: &Node, max: usize, text: &mut String) -> Option<()> {
    match &node.value {
        Value::Invalid => return None,
        Value::Array(elements) => {
            text.push('[');
            for (i, element) in elements.iter().enumerate() {
                text.push_str(if i > 0 { ", " } else { "" });
                write(element, max, text)?;
            }
            text.push(']');
        }
        Value::Object(members) => {
            text.push('{');
            for (i, (key, member)) in members.iter().enumerate() {
                text.push_str(if i > 0 { ", " } else { "" });
                text.push_str(&serde_json::to_string(key).ok()?);
                text.push_str(": ");
                write(&member.node, max, text)?;
            }
            text.push('}');
        }
        _ => text.push_str(&serde_json::to_string(&node.to_json()).ok()?),
    }
    (text.len() <= max).then_some(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_values_are_one_line_of_json() {
        let node = |json: serde_json::Value| Node::from(json);
        let value = serde_json::json!({"a \"b\"": [1, 0.5, -2e-7], "c": {"d": null, "e": true}});
        let line = r#"{"a \"b\"": [1, 0.5, -2e-7], "c": {"d": null, "e": true}}"#;
        assert_eq!(json_line(&node(value.clone()), line.len()).as_deref(), Some(line));
        assert_eq!(json_line(&node(value), line.len() - 1), None);
        assert_eq!(json_line(&Node { place: None, value: Value::Invalid }, 9), None);
    }

    #[test]
    fn computed_numbers_have_six_digits() {
        let numbers = [1.0 - 0.8, -0.0, 1000.0 / 683.0, 1.0e-9 / 3.0, 123_456.7];
        assert_eq!(numbers.map(shown), ["0.2", "0", "1.46413", "0.000000000333333", "123457"]);
    }
}
