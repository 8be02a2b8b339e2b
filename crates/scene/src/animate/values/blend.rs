//! Conversion of JSON values to numbers that can be interpolated, and back.

use crate::animate::{number, numbers};
use crate::document::{Node, Value};
use glam::{DQuat, DVec3};
use juggler_math::Rgb;
use juggler_math::quaternion;
use std::sync::Arc;

/// Linear red, green and blue of a color that is written as CSS does.
fn linear_rgb(text: &str) -> Option<[f64; 3]> {
    let Rgb { r, g, b } = Rgb::from_css(text)?;
    Some([r, g, b].map(f64::from))
}

/// Whether a value contains an error that is reported already.
pub fn has_error(node: &Node) -> bool {
    match &node.value {
        Value::Invalid => true,
        Value::Array(elements) => elements.iter().any(has_error),
        Value::Object(members) => members.values().any(|member| has_error(&member.node)),
        _ => false,
    }
}

/// Error message if a value cannot be interpolated.
pub fn interpolation_error(node: &Node) -> Option<String> {
    match &node.value {
        Value::Number(_) => None,
        Value::String(text) if linear_rgb(text).is_some() => None,
        Value::String(text) if text.starts_with('#') => Some(format!(
            "`{text}` is not a color: a color is written \"#rrggbb\" with six digits 0-9 or a-f, \"#rgb\", or as a name of CSS"
        )),
        Value::Array(elements) if elements.is_empty() => Some("an array without numbers cannot be interpolated".into()),
        Value::Array(elements) => elements.iter().find_map(interpolation_error),
        _ => Some(format!(
            "only numbers, arrays of numbers and colors can be interpolated, this is {}: write \"interpolation\": \"step\"",
            node.kind()
        )),
    }
}

/// Error message if the form of a value differs from that of the first key. Both values can be
/// interpolated.
pub fn form_mismatch(node: &Node, first: &Node) -> Option<String> {
    let same = same_form(node, first);
    (!same).then(|| {
        format!("this key's value is {}, but the value of the first key is {}", describe(node), describe(first))
    })
}

fn same_form(a: &Node, b: &Node) -> bool {
    match (&a.value, &b.value) {
        (Value::Array(a), Value::Array(b)) => {
            a.len() == b.len() && a.iter().zip(b.iter()).all(|(a, b)| same_form(a, b))
        }
        (Value::Array(a), Value::String(_)) | (Value::String(_), Value::Array(a)) => {
            a.len() == 3 && a.iter().all(|channel| matches!(channel.value, Value::Number(_)))
        }
        (Value::Number(_), Value::Number(_)) | (Value::String(_), Value::String(_)) => true,
        _ => false,
    }
}

fn describe(node: &Node) -> String {
    match &node.value {
        Value::String(_) => "a color".into(),
        Value::Array(elements) if elements.iter().any(|inner| matches!(inner.value, Value::Array(_))) => {
            let inner = elements.iter().map(|inner| inner.elements().len().to_string()).take(4).collect::<Vec<_>>();
            let more = if elements.len() > inner.len() { ", ..." } else { "" };
            format!("an array of {} arrays (of {}{more})", elements.len(), inner.join(", "))
        }
        Value::Array(elements) => format!("an array of {}", elements.len()),
        _ => node.kind().into(),
    }
}

/// Numbers of a value that can be interpolated, in order.
pub fn flat(node: &Node) -> Vec<f64> {
    let mut numbers = Vec::new();
    flatten(node, &mut numbers);
    numbers
}

fn flatten(node: &Node, numbers: &mut Vec<f64>) {
    match &node.value {
        Value::Number(number) => numbers.push(number.as_f64().unwrap_or_default()),
        Value::String(text) => numbers.extend(linear_rgb(text).unwrap_or_default()),
        Value::Array(elements) => elements.iter().for_each(|element| flatten(element, numbers)),
        _ => {}
    }
}

/// Creates a value with the form of `node` from numbers.
pub fn with_numbers(node: &Node, values: &mut impl Iterator<Item = f64>) -> Node {
    let value = match &node.value {
        Value::String(_) => return numbers(values.by_ref().take(3), node),
        Value::Array(elements) => {
            Value::Array(Arc::new(elements.iter().map(|element| with_numbers(element, values)).collect()))
        }
        _ => number(values.next().unwrap_or_default()),
    };
    Node { place: node.place, value }
}

/// Rotation from a quaternion, or from an axis and an angle in degrees; otherwise an error message.
pub fn rotation(node: &Node) -> Result<DQuat, String> {
    let expected = "a rotation is a quaternion [x, y, z, w] or {\"axis\": [x, y, z], \"degrees\": ...}";
    match &node.value {
        Value::Array(elements) => {
            let written = numbers_array(elements).ok_or_else(|| format!("{expected}, this is {}", describe(node)))?;
            quaternion::normalized(written).ok_or_else(|| "a quaternion must not be zero".into())
        }
        Value::Object(members) => {
            let axis = members.get("axis").and_then(|axis| numbers_array(axis.node.elements()));
            let degrees = members.get("degrees").and_then(|degrees| numbers_array(std::slice::from_ref(&degrees.node)));
            let (Some(axis), Some([degrees]), 2) = (axis, degrees, members.len()) else { return Err(expected.into()) };
            quaternion::from_axis_degrees(DVec3::from_array(axis), degrees)
                .ok_or_else(|| "`axis` must not be zero".into())
        }
        _ => Err(format!("{expected}, this is {}", node.kind())),
    }
}

/// Numbers of an array with exactly `N` elements.
fn numbers_array<const N: usize>(elements: &[Node]) -> Option<[f64; N]> {
    let number = |node: &Node| match &node.value {
        Value::Number(number) => number.as_f64(),
        _ => None,
    };
    elements.iter().map(number).collect::<Option<Vec<f64>>>()?.try_into().ok()
}
