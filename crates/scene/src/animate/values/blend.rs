//! Values as numbers: what can be interpolated, and back into the form of a value.

use crate::animate::{number, numbers};
use crate::document::{Node, Value};
use glam::{DQuat, DVec3};
use juggler_math::Rgb;
use juggler_math::quaternion;
use std::sync::Arc;

/// How colours become numbers: linear red, green and blue, in which they are mixed.
fn channels(text: &str) -> Option<[f64; 3]> {
    let Rgb { r, g, b } = Rgb::from_hex(text)?;
    Some([r, g, b].map(f64::from))
}

/// Whether something inside is a mistake that has been reported.
pub fn holds_mistake(node: &Node) -> bool {
    match &node.value {
        Value::Wrong => true,
        Value::Array(elements) => elements.iter().any(holds_mistake),
        Value::Object(members) => members.values().any(|member| holds_mistake(&member.node)),
        _ => false,
    }
}

/// Why there is nothing between this value and another.
pub fn unblendable(node: &Node) -> Option<String> {
    match &node.value {
        Value::Number(_) => None,
        Value::String(text) if channels(text).is_some() => None,
        Value::String(text) if text.starts_with('#') => Some(format!(
            "`{text}` is not a colour: one is written \"#rrggbb\" with six digits 0-9 or a-f, or \"#rgb\""
        )),
        Value::Array(elements) if elements.is_empty() => Some("an array without numbers cannot be interpolated".into()),
        Value::Array(elements) => elements.iter().find_map(unblendable),
        _ => Some(format!(
            "only numbers, arrays of numbers and colours can be interpolated, this is {}: write \"interpolation\": \"step\"",
            node.kind()
        )),
    }
}

/// How a value's form differs from that of the first key; both can be interpolated.
pub fn differs(node: &Node, first: &Node) -> Option<String> {
    let same = same_form(node, first);
    (!same).then(|| format!("this key's value is {}, that of the first key {}", told(node), told(first)))
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

fn told(node: &Node) -> String {
    match &node.value {
        Value::String(_) => "a colour".into(),
        Value::Array(elements) if elements.iter().any(|inner| matches!(inner.value, Value::Array(_))) => {
            let inner = elements.iter().map(|inner| inner.elements().len().to_string()).take(4).collect::<Vec<_>>();
            let more = if elements.len() > inner.len() { ", ..." } else { "" };
            format!("an array of {} arrays (of {}{more})", elements.len(), inner.join(", "))
        }
        Value::Array(elements) => format!("an array of {}", elements.len()),
        _ => node.kind().into(),
    }
}

/// The numbers of a value that can be interpolated, in order.
pub fn flat(node: &Node) -> Vec<f64> {
    let mut numbers = Vec::new();
    flatten(node, &mut numbers);
    numbers
}

fn flatten(node: &Node, numbers: &mut Vec<f64>) {
    match &node.value {
        Value::Number(number) => numbers.push(number.as_f64().unwrap_or_default()),
        Value::String(text) => numbers.extend(channels(text).unwrap_or_default()),
        Value::Array(elements) => elements.iter().for_each(|element| flatten(element, numbers)),
        _ => {}
    }
}

/// A value of the form of `node` with these numbers.
pub fn formed(node: &Node, values: &mut impl Iterator<Item = f64>) -> Node {
    let value = match &node.value {
        Value::String(_) => return numbers(values.by_ref().take(3), node),
        Value::Array(elements) => {
            Value::Array(Arc::new(elements.iter().map(|element| formed(element, values)).collect()))
        }
        _ => number(values.next().unwrap_or_default()),
    };
    Node { place: node.place, value }
}

/// The rotation of a value: four numbers, or an axis and degrees; or why it is none.
pub fn rotation(node: &Node) -> Result<DQuat, String> {
    let expected = "a rotation is a quaternion [x, y, z, w] or {\"axis\": [x, y, z], \"degrees\": ...}";
    match &node.value {
        Value::Array(elements) => {
            let written = exactly(elements).ok_or_else(|| format!("{expected}, this is {}", told(node)))?;
            quaternion::unit(written).ok_or_else(|| "a quaternion must not be all 0: it turns nowhere".into())
        }
        Value::Object(members) => {
            let axis = members.get("axis").and_then(|axis| exactly(axis.node.elements()));
            let degrees = members.get("degrees").and_then(|degrees| exactly(std::slice::from_ref(&degrees.node)));
            let (Some(axis), Some([degrees]), 2) = (axis, degrees, members.len()) else { return Err(expected.into()) };
            quaternion::turn(DVec3::from_array(axis), degrees)
                .ok_or_else(|| "`axis` must not be zero: there is nothing to turn about".into())
        }
        _ => Err(format!("{expected}, this is {}", node.kind())),
    }
}

/// The numbers of an array that has exactly so many.
fn exactly<const N: usize>(elements: &[Node]) -> Option<[f64; N]> {
    let number = |node: &Node| match &node.value {
        Value::Number(number) => number.as_f64(),
        _ => None,
    };
    elements.iter().map(number).collect::<Option<Vec<f64>>>()?.try_into().ok()
}
