//! Value form `animate`: value interpolated between keys.
//!
//! ```json
//! {"animate": {
//!   "keys": [[0, 1], [1.5, 2, "in_out"], [4, 1]], "interpolation": "smooth", "repeat": "loop"}}
//! ```

use super::keys::{Key, Keys};
use super::{Kind, blend};
use crate::animate::easing::Ease;
use crate::animate::numbers;
use crate::animate::spline::{hermite, tangent};
use crate::animate::survey::FormSummary;
use crate::animate::tree_resolver::TreeResolver;
use crate::animate::value_source::Animatable;
use crate::document::{Node, Value};
use crate::path::PathRef;
use juggler_expression::modulo;
use juggler_math::quaternion::slerp;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Value interpolated between keys: a number, an array of numbers, a color or a rotation. With
/// `step` interpolation, any value.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Animate {
    /// Keys `[time, value]` or `[time, value, ease]`, in the order of strictly increasing times.
    /// Times are in seconds unless `at` is set. All values have the same form. An ease applies
    /// between its key and the next.
    #[schemars(length(min = 1, max = 100_000))]
    pub keys: Vec<Key>,
    /// Time at which the keys are evaluated. Defaults to the scene's time in seconds.
    /// `"=seconds - 2"` delays the animation by two seconds, `"=2 * seconds"` doubles its speed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "seconds"))]
    pub at: Option<Animatable<f64>>,
    /// Interpolation between the keys.
    #[serde(default)]
    pub interpolation: Interpolation,
    /// Easing after each key that does not state its own easing.
    #[serde(default)]
    pub ease: Ease,
    /// Extrapolation before the first and after the last key.
    #[serde(default)]
    pub repeat: Extrapolation,
}

/// Interpolation between two keys.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Interpolation {
    /// Holds the value of the earlier key. Values may be of any type: names, whole objects.
    Step,
    /// Linear interpolation; colors in linear light.
    #[default]
    Linear,
    /// Catmull-Rom spline with a continuous rate of change: the slope at a key is that of the
    /// parabola through the key and its neighbors. At the first and the last key the slope is zero,
    /// except with `loop`, where these two keys are one.
    Smooth,
    /// Spherical linear interpolation of rotations: constant angular speed along the shorter arc.
    /// Values are quaternions `[x, y, z, w]`, as in the transform step `orient`, or
    /// `{"axis": [x, y, z], "degrees": 90}`; the result is a quaternion.
    Slerp,
}

/// Extrapolation before the first and after the last key.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(rename = "Repeat")]
pub enum Extrapolation {
    /// Holds the first and the last value.
    #[default]
    Once,
    /// Repeats the keys; the last key coincides with the first.
    Loop,
    /// Alternates between forward and backward playback.
    PingPong,
}

pub const KIND: Kind = Kind { name: "animate", value };

fn value(resolver: &mut TreeResolver<'_>, content: &Node, at: &PathRef<'_>) -> Option<Node> {
    let settings = resolver.read::<Animate>("Animate", content, at);
    let interpolation = interpolation_of(content);
    let list = content.get("keys")?;
    let ease = settings.as_ref().and_then(|settings| settings.ease.error());
    if let Some(message) = ease {
        resolver.report_error(content.get("ease").unwrap_or(content), &at.key("ease"), message);
    }
    // Check the keys even if settings are invalid.
    let keys = Keys::read(resolver, list, &at.key("keys"), interpolation)?;
    let settings = settings.filter(|_| ease.is_none())?;
    record_form(resolver, at, &settings, &keys);
    let time = settings.at.as_ref().and_then(Animatable::value).unwrap_or_else(|| resolver.seconds());
    let value = keys.value(&settings, time)?;
    if interpolation == Interpolation::Step || is_finite(&value) {
        return Some(value);
    }
    resolver.report_error(
        list,
        &at.key("keys"),
        "the value between these keys is not finite: numbers or slopes are too large",
    );
    None
}

/// Interpolation, read separately to check the keys even if other settings are invalid. An invalid
/// interpolation allows values of any type.
fn interpolation_of(content: &Node) -> Interpolation {
    match content.get("interpolation") {
        Some(word) => Interpolation::deserialize(word.to_json()).unwrap_or(Interpolation::Step),
        None => Interpolation::default(),
    }
}

fn record_form(resolver: &mut TreeResolver<'_>, at: &PathRef<'_>, settings: &Animate, keys: &Keys<'_>) {
    resolver.record_form(at, |track| FormSummary {
        keys: Some(keys.times.len()),
        time_range: Some([keys.first(), keys.last()]),
        interpolation: Some(settings.interpolation),
        repeat: Some(settings.repeat),
        ..track
    });
}

/// Whether all numbers are finite: numbers out of range became null.
fn is_finite(node: &Node) -> bool {
    match &node.value {
        Value::Null => false,
        Value::Array(elements) => elements.iter().all(is_finite),
        _ => true,
    }
}

impl Extrapolation {
    /// Maps a time to the interval between the first and the last key.
    fn wrap_time(self, time: f64, first: f64, last: f64) -> f64 {
        let time_range = last - first;
        let inside = match self {
            Self::Once => return time.clamp(first, last),
            Self::Loop => modulo(time - first, time_range),
            Self::PingPong => {
                let time = modulo(time - first, 2.0 * time_range);
                if time > time_range { 2.0 * time_range - time } else { time }
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

    /// Evaluates the keys at a time.
    fn value(&self, settings: &Animate, time: f64) -> Option<Node> {
        let time = settings.repeat.wrap_time(time, self.first(), self.last());
        let i = self.times.partition_point(|key| *key <= time).saturating_sub(1);
        let node = *self.values.get(i)?;
        let ease = self.easings.get(i).copied().flatten().unwrap_or(settings.ease);
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
                blend::with_numbers(node, &mut a.iter().zip(&b).map(|(a, b)| a + (b - a) * share))
            }
            Interpolation::Smooth if share == 0.0 => blend::with_numbers(node, &mut blend::flat(node).into_iter()),
            Interpolation::Smooth => self.smooth(i, share, settings.repeat)?,
        })
    }

    /// Evaluates the spline at the parameter `share` of the segment that begins at key `i`.
    fn smooth(&self, i: usize, share: f64, repeat: Extrapolation) -> Option<Node> {
        let node = *self.values.get(i)?;
        let (a, b) = (self.flat(i), self.flat(i + 1));
        let (slopes_a, slopes_b) = (self.slopes(i, repeat), self.slopes(i + 1, repeat));
        let length = self.time_of(i + 1) - self.time_of(i);
        let at = |k: usize| {
            let pick = |numbers: &[f64]| numbers.get(k).copied().unwrap_or_default();
            hermite([pick(&a), pick(&b)], [pick(&slopes_a), pick(&slopes_b)], length, share)
        };
        Some(blend::with_numbers(node, &mut (0..a.len()).map(at)))
    }

    fn flat(&self, i: usize) -> Vec<f64> {
        self.values.get(i).map(|node| blend::flat(node)).unwrap_or_default()
    }

    /// Slope of each number at key `i`; empty if all slopes are zero.
    fn slopes(&self, i: usize, repeat: Extrapolation) -> Vec<f64> {
        let segments = self.times.len().saturating_sub(1);
        let wraps = repeat == Extrapolation::Loop;
        let before = i.checked_sub(1).or_else(|| wraps.then(|| segments.saturating_sub(1)));
        let after = if i < segments { Some(i) } else { wraps.then_some(0) };
        let (Some(before), Some(after)) = (before, after) else { return Vec::new() };
        let (chord_before, chord_after) = (self.chord(before), self.chord(after));
        let lengths = [before, after].map(|k| self.time_of(k + 1) - self.time_of(k));
        chord_before.zip(chord_after).map(|(a, b)| tangent([a, b], lengths)).collect()
    }

    /// Slope of each number's chord from key `i` to the next.
    fn chord(&self, i: usize) -> impl Iterator<Item = f64> + use<> {
        let length = self.time_of(i + 1) - self.time_of(i);
        self.flat(i).into_iter().zip(self.flat(i + 1)).map(move |(a, b)| (b - a) / length)
    }
}
