//! The keys of a track: read and checked, all of them, at each frame.

use super::blend;
use super::track::Interpolation;
use crate::animate::easing::Ease;
use crate::animate::walk::Walk;
use crate::document::{Node, Value};
use crate::path::Trail;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// Most keys of a track.
pub const MAX_KEYS: usize = 100_000;

/// `[time, value]` or `[time, value, ease]`. The value may be anything; the checks of its form are this module's.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Key(pub serde_json::Value);

impl JsonSchema for Key {
    fn schema_name() -> Cow<'static, str> {
        "Key".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let (number, ease) = (generator.subschema_for::<f64>(), generator.subschema_for::<Ease>());
        json_schema!({
            "description": "A time and a value, and perhaps how the stretch that begins there begins and ends.",
            "type": "array",
            "minItems": 2,
            "maxItems": 3,
            "prefixItems": [number, true, ease],
            "items": true,
        })
    }
}

/// The keys of a track in the order of their times, at least one.
pub struct Keys<'n> {
    /// The times.
    pub times: Vec<f64>,
    /// The values.
    pub values: Vec<&'n Node>,
    /// How the stretches that begin there begin and end, where they say so themselves.
    pub eases: Vec<Option<Ease>>,
}

impl<'n> Keys<'n> {
    /// Reads `list`, of which only lengths have been checked; nothing when something is wrong.
    pub fn read(walk: &mut Walk<'_>, list: &'n Node, at: &Trail<'_>, interpolation: Interpolation) -> Option<Self> {
        let mut keys = Self { times: Vec::new(), values: Vec::new(), eases: Vec::new() };
        let mut sound = !list.elements().is_empty();
        for (i, key) in list.elements().iter().enumerate() {
            let at = at.index(i);
            let [time, value, rest @ ..] = key.elements() else { return None };
            sound &= keys.time(walk, time, &at);
            keys.values.push(value);
            let ease = rest.first().map(|ease| read_ease(walk, ease, &at.index(2)));
            sound &= ease != Some(None);
            keys.eases.push(ease.flatten());
            sound &= is_sound(walk, value, &at.index(1), interpolation, keys.values.first().copied());
        }
        sound.then_some(keys)
    }

    fn time(&mut self, walk: &mut Walk<'_>, node: &Node, key: &Trail<'_>) -> bool {
        let at = key.index(0);
        let before = self.times.last().copied().unwrap_or(f64::NEG_INFINITY);
        let time = match &node.value {
            Value::Number(number) => number.as_f64().unwrap_or_default(),
            Value::Wrong => {
                // Whatever it is, the next is compared with the one before.
                self.times.push(before);
                return false;
            }
            _ => {
                walk.wrong(node, &at, format!("a key begins with its time, a number; found {}", node.kind()));
                self.times.push(before);
                return false;
            }
        };
        self.times.push(time.max(before));
        if time == before {
            walk.wrong(node, &at, format!("two keys at the time {time}"));
        } else if time < before {
            let message =
                format!("the key at {time} stands after that at {before}: keys are in the order of their times");
            walk.wrong(node, &at, message);
        }
        time > before
    }
}

fn read_ease(walk: &mut Walk<'_>, node: &Node, at: &Trail<'_>) -> Option<Ease> {
    let ease: Ease = walk.read("Ease", node, at)?;
    match ease.wrong() {
        Some(message) => {
            walk.wrong(node, at, message);
            None
        }
        None => Some(ease),
    }
}

/// Whether a value can be interpolated, and has the form of the first.
fn is_sound(
    walk: &mut Walk<'_>,
    node: &Node,
    at: &Trail<'_>,
    interpolation: Interpolation,
    first: Option<&Node>,
) -> bool {
    let wrong = match interpolation {
        _ if blend::holds_mistake(node) => return false,
        Interpolation::Step => None,
        Interpolation::Slerp => blend::rotation(node).err(),
        Interpolation::Linear | Interpolation::Smooth => {
            let sound = |first: &&Node| !blend::holds_mistake(first) && blend::unblendable(first).is_none();
            let unlike = || first.filter(sound).and_then(|first| blend::differs(node, first));
            blend::unblendable(node).or_else(unlike)
        }
    };
    let sound = wrong.is_none();
    if let Some(message) = wrong {
        walk.wrong(node, at, message);
    }
    sound
}
