//! Keys of a track. All keys are read and checked at each frame.

use super::blend;
use super::track::Interpolation;
use crate::animate::easing::Ease;
use crate::animate::tree_resolver::TreeResolver;
use crate::document::{Node, Value};
use crate::path::{Path, PathRef, Step};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// Maximum number of keys of a track.
pub const MAX_KEYS: usize = 100_000;

/// Key: `[time, value]` or `[time, value, ease]`. The schema accepts any value; this module checks
/// its form.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Key(pub serde_json::Value);

impl JsonSchema for Key {
    fn schema_name() -> Cow<'static, str> {
        "Key".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let (mut time, ease) = (generator.subschema_for::<f64>(), generator.subschema_for::<Ease>());
        time.insert("x-unit".into(), "seconds".into());
        json_schema!({
            "description": "Time and value, optionally followed by the easing of the segment that begins at this key.",
            "type": "array",
            "minItems": 2,
            "maxItems": 3,
            "prefixItems": [time, true, ease],
            "items": true,
        })
    }
}

/// Keys of a track in order of time, at least one.
pub struct Keys<'n> {
    /// Times, strictly increasing.
    pub times: Vec<f64>,
    /// Values.
    pub values: Vec<&'n Node>,
    /// Easing after each key; `None` for the default of the track.
    pub easings: Vec<Option<Ease>>,
}

impl<'n> Keys<'n> {
    /// Reads and checks `list`, of which only lengths are validated. Returns `None` after an error.
    pub fn read(
        resolver: &mut TreeResolver<'_>,
        list: &'n Node,
        at: &PathRef<'_>,
        interpolation: Interpolation,
    ) -> Option<Self> {
        let mut keys = Self { times: Vec::new(), values: Vec::new(), easings: Vec::new() };
        let mut is_valid = !list.elements().is_empty();
        for (i, key) in list.elements().iter().enumerate() {
            let at = at.index(i);
            let [time, value, rest @ ..] = key.elements() else { return None };
            is_valid &= keys.time(resolver, time, &at);
            keys.values.push(value);
            let ease = rest.first().map(|ease| read_ease(resolver, ease, &at.index(2)));
            is_valid &= ease != Some(None);
            keys.easings.push(ease.flatten());
            is_valid &= is_valid_key(resolver, value, &at.index(1), interpolation, keys.values.first().copied());
        }
        is_valid.then_some(keys)
    }

    fn time(&mut self, resolver: &mut TreeResolver<'_>, node: &Node, key: &PathRef<'_>) -> bool {
        let at = key.index(0);
        let before = self.times.last().copied().unwrap_or(f64::NEG_INFINITY);
        let time = match &node.value {
            Value::Number(number) => number.as_f64().unwrap_or_default(),
            Value::Invalid => {
                // Compare the next time with the previous valid one.
                self.times.push(before);
                return false;
            }
            _ => {
                resolver.report_error(
                    node,
                    &at,
                    format!("a key must begin with its time, a number; found {}", node.kind()),
                );
                self.times.push(before);
                return false;
            }
        };
        self.times.push(time.max(before));
        if time == before {
            resolver.report_error(node, &at, format!("two keys have the time {time}"));
        } else if time < before {
            let message = format!("the key at {time} follows the key at {before}: keys must be in order of time");
            resolver.report_error(node, &at, message);
        }
        time > before
    }
}

fn read_ease(resolver: &mut TreeResolver<'_>, node: &Node, at: &PathRef<'_>) -> Option<Ease> {
    let ease: Ease = resolver.read("Ease", node, at)?;
    match ease.error() {
        Some(message) => {
            resolver.report_error(node, at, message);
            None
        }
        None => Some(ease),
    }
}

/// Checks that a value can be interpolated and has the form of the first value.
fn is_valid_key(
    resolver: &mut TreeResolver<'_>,
    node: &Node,
    at: &PathRef<'_>,
    interpolation: Interpolation,
    first: Option<&Node>,
) -> bool {
    let wrong = match interpolation {
        _ if blend::has_error(node) => return false,
        Interpolation::Step => None,
        Interpolation::Slerp => blend::rotation(node).err(),
        Interpolation::Linear | Interpolation::Smooth => {
            let is_valid = |first: &&Node| !blend::has_error(first) && blend::interpolation_error(first).is_none();
            let unlike = || first.filter(is_valid).and_then(|first| blend::form_mismatch(node, first));
            let focus = |message| format!("{message}, or animate `focus_distance` for a smooth focus pull");
            let is_focus = || Path::from(at).steps().contains(&Step::Key("focus_on".into()));
            let error = blend::interpolation_error(node);
            error.map(|message| if is_focus() { focus(message) } else { message }).or_else(unlike)
        }
    };
    let is_valid = wrong.is_none();
    if let Some(message) = wrong {
        resolver.report_error(node, at, message);
    }
    is_valid
}
