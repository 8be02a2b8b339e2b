//! A value that changes from key to key.
//!
//! ```json
//! {"animate": {"keys": [[0, 1], [1.5, 2, "in_out"], [4, 1]], "interpolation": "smooth", "repeat": "loop"}}
//! ```

use super::keys::{Key, Keys};
use super::{Kind, blend};
use crate::animate::easing::Ease;
use crate::animate::numbers;
use crate::animate::spline::{hermite, tangent};
use crate::animate::survey::Track;
use crate::animate::walk::Walk;
use crate::document::{Node, Value};
use crate::path::Trail;
use juggler_expression::modulo;
use juggler_math::quaternion::slerp;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A value that changes from key to key: a number, an array of numbers, a colour, a rotation; by steps anything.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Animate {
    /// Times with their values, `[time, value]`, in the order of the times. All values have the same form. A third
    /// element is the ease of the stretch that begins there.
    #[schemars(length(min = 1, max = 100_000))]
    pub keys: Vec<Key>,
    /// The time that is looked up; the scene's seconds when absent. `"=seconds - 2"` begins two seconds later, `"=2 *
    /// seconds"` is twice as fast.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<f64>,
    /// What lies between the keys.
    #[serde(default)]
    pub interpolation: Interpolation,
    /// How each stretch begins and ends, unless its key says otherwise.
    #[serde(default)]
    pub ease: Ease,
    /// What lies outside of the keys.
    #[serde(default)]
    pub repeat: Repeat,
}

/// What lies between two keys.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Interpolation {
    /// The value of the key before. Values may be anything: names, whole objects.
    Step,
    /// Straight lines. Colours are mixed as light.
    #[default]
    Linear,
    /// A Catmull-Rom spline through all keys, without corners: at each key it has the slope of the parabola through it
    /// and its neighbours. Where the values are held before and after the keys, and where `ping_pong` turns back, it
    /// comes to rest; with `loop` the last key and the first are joined as neighbours.
    Smooth,
    /// Rotations at an even angular speed, the shorter way. Values are quaternions `[x, y, z, w]`, as the transform
    /// step `orient` takes them, or `{"axis": [x, y, z], "degrees": 90}`, which become some.
    Slerp,
}

/// What lies outside of the keys.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Repeat {
    /// The first value before, the last value after.
    #[default]
    Once,
    /// The same again and again; the last key falls on the first.
    Loop,
    /// Forwards, backwards, forwards.
    PingPong,
}

pub const KIND: Kind = Kind { name: "animate", value };

fn value(walk: &mut Walk<'_>, content: &Node, at: &Trail<'_>) -> Option<Node> {
    let settings = walk.read::<Animate>("Animate", content, at);
    let interpolation = interpolation_of(content);
    let list = content.get("keys")?;
    let ease = settings.as_ref().and_then(|settings| settings.ease.wrong());
    if let Some(message) = ease {
        walk.wrong(content.get("ease").unwrap_or(content), &at.key("ease"), message);
    }
    // Where settings are wrong, keys are looked at all the same.
    let keys = Keys::read(walk, list, &at.key("keys"), interpolation)?;
    let settings = settings.filter(|_| ease.is_none())?;
    note(walk, at, &settings, &keys);
    let time = settings.at.unwrap_or_else(|| walk.seconds());
    let value = keys.value(&settings, time)?;
    if interpolation == Interpolation::Step || is_finite(&value) {
        return Some(value);
    }
    walk.wrong(list, &at.key("keys"), "there is no finite value between these keys: numbers or slopes are too large");
    None
}

/// What lies between the keys, read by itself so that they can be checked where other settings are wrong. Where it is wrong
/// itself, values may be anything.
fn interpolation_of(content: &Node) -> Interpolation {
    match content.get("interpolation") {
        Some(word) => Interpolation::deserialize(word.to_json()).unwrap_or(Interpolation::Step),
        None => Interpolation::default(),
    }
}

fn note(walk: &mut Walk<'_>, at: &Trail<'_>, settings: &Animate, keys: &Keys<'_>) {
    walk.note(at, |track| Track {
        keys: Some(keys.times.len()),
        span: Some([keys.first(), keys.last()]),
        interpolation: Some(settings.interpolation),
        repeat: Some(settings.repeat),
        ..track
    });
}

/// What is too large for a number has become null.
fn is_finite(node: &Node) -> bool {
    match &node.value {
        Value::Null => false,
        Value::Array(elements) => elements.iter().all(is_finite),
        _ => true,
    }
}

impl Repeat {
    /// The time between the first and the last key where the value is looked up.
    fn fold(self, time: f64, first: f64, last: f64) -> f64 {
        let span = last - first;
        let inside = match self {
            Self::Once => return time.clamp(first, last),
            Self::Loop => modulo(time - first, span),
            Self::PingPong => {
                let way = modulo(time - first, 2.0 * span);
                if way > span { 2.0 * span - way } else { way }
            }
        };
        if inside.is_finite() { (first + inside).clamp(first, last) } else { first }
    }
}

impl Keys<'_> {
    fn first(&self) -> f64 {
        self.times.first().copied().unwrap_or_default()
    }

    fn last(&self) -> f64 {
        self.times.last().copied().unwrap_or_default()
    }

    fn time_of(&self, i: usize) -> f64 {
        self.times.get(i).copied().unwrap_or_default()
    }

    /// The value at a time.
    fn value(&self, settings: &Animate, time: f64) -> Option<Node> {
        let time = settings.repeat.fold(time, self.first(), self.last());
        let i = self.times.partition_point(|key| *key <= time).saturating_sub(1);
        let node = *self.values.get(i)?;
        let ease = self.eases.get(i).copied().flatten().unwrap_or(settings.ease);
        let last = i + 1 == self.values.len();
        let length = self.time_of(i + 1) - self.time_of(i);
        let share = if last || ease.is_step() { 0.0 } else { ease.at((time - self.time_of(i)) / length) };
        let i_next = if last { i } else { i + 1 };
        Some(match settings.interpolation {
            Interpolation::Step => node.clone(),
            Interpolation::Slerp => {
                let from = blend::rotation(node).ok()?;
                let to = blend::rotation(self.values.get(i_next)?).ok()?;
                numbers(slerp(from, to, share).to_array(), node)
            }
            Interpolation::Linear => {
                let (a, b) = (blend::flat(node), blend::flat(self.values.get(i_next)?));
                blend::formed(node, &mut a.iter().zip(&b).map(|(a, b)| a + (b - a) * share))
            }
            Interpolation::Smooth if share == 0.0 => blend::formed(node, &mut blend::flat(node).into_iter()),
            Interpolation::Smooth => self.smooth(i, share, settings.repeat)?,
        })
    }

    /// The spline at a share of the stretch that begins with key `i`.
    fn smooth(&self, i: usize, share: f64, repeat: Repeat) -> Option<Node> {
        let node = *self.values.get(i)?;
        let (a, b) = (self.flat(i), self.flat(i + 1));
        let (slopes_a, slopes_b) = (self.slopes(i, repeat), self.slopes(i + 1, repeat));
        let length = self.time_of(i + 1) - self.time_of(i);
        let at = |k: usize| {
            let pick = |numbers: &[f64]| numbers.get(k).copied().unwrap_or_default();
            hermite([pick(&a), pick(&b)], [pick(&slopes_a), pick(&slopes_b)], length, share)
        };
        Some(blend::formed(node, &mut (0..a.len()).map(at)))
    }

    fn flat(&self, i: usize) -> Vec<f64> {
        self.values.get(i).map(|node| blend::flat(node)).unwrap_or_default()
    }

    /// The slope of each number at key `i`.
    fn slopes(&self, i: usize, repeat: Repeat) -> Vec<f64> {
        let stretches = self.times.len().saturating_sub(1);
        let wraps = repeat == Repeat::Loop;
        let before = i.checked_sub(1).or_else(|| wraps.then(|| stretches.saturating_sub(1)));
        let after = if i < stretches { Some(i) } else { wraps.then_some(0) };
        let (Some(before), Some(after)) = (before, after) else { return Vec::new() };
        let (chord_before, chord_after) = (self.chord(before), self.chord(after));
        let lengths = [before, after].map(|k| self.time_of(k + 1) - self.time_of(k));
        chord_before.zip(chord_after).map(|(a, b)| tangent([a, b], lengths)).collect()
    }

    /// The slope of each number's straight line from key `i` to the next.
    fn chord(&self, i: usize) -> impl Iterator<Item = f64> + use<> {
        let length = self.time_of(i + 1) - self.time_of(i);
        self.flat(i).into_iter().zip(self.flat(i + 1)).map(move |(a, b)| (b - a) / length)
    }
}
