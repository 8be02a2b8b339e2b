//! Sources of animated values, as programs write them.

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::Value;
use std::borrow::Cow;

/// Source of an animated value: an expression of time, or a value form such as
/// [`Animate`](super::Animate).
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(transparent)]
pub struct ValueSource(Value);

impl ValueSource {
    /// Creates a source that evaluates an expression such as `2*pi*frame/frames` at each frame.
    pub fn expression(expression: &str) -> Self {
        Self(format!("={expression}").into())
    }

    /// Creates a source of an array, such as a position, from an expression for each element.
    pub fn expressions<const N: usize>(expressions: [&str; N]) -> Self {
        Self(expressions.map(|expression| Self::expression(expression).0).to_vec().into())
    }

    /// Creates a source from a value form. Numbers that are not finite become null, which the scene
    /// refuses.
    pub(crate) fn from_form(form: &impl Serialize) -> Self {
        Self(serde_json::to_value(form).unwrap_or_default())
    }
}

impl From<ValueSource> for Value {
    /// JSON of the source, for edits by JSON pointer.
    fn from(source: ValueSource) -> Self {
        source.0
    }
}

/// Setting of a value form: a value, or a source that gives it at each frame.
///
/// The settings of a form that is being evaluated are values.
#[derive(Clone, Debug, PartialEq)]
pub enum Animatable<T> {
    /// Value at every frame.
    Value(T),
    /// Source of the value.
    Source(ValueSource),
}

impl<T: Copy> Animatable<T> {
    /// The value; `None` for a source.
    pub fn value(&self) -> Option<T> {
        match self {
            Self::Value(value) => Some(*value),
            Self::Source(_) => None,
        }
    }
}

impl From<f64> for Animatable<f64> {
    fn from(value: f64) -> Self {
        Self::Value(value)
    }
}

impl<const N: usize> From<[f64; N]> for Animatable<[f64; N]> {
    fn from(value: [f64; N]) -> Self {
        Self::Value(value)
    }
}

impl<T, S: Into<ValueSource>> From<S> for Animatable<T> {
    fn from(source: S) -> Self {
        Self::Source(source.into())
    }
}

impl<T: Serialize> Serialize for Animatable<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Value(value) => value.serialize(serializer),
            Self::Source(source) => source.serialize(serializer),
        }
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Animatable<T> {
    /// Reads a value: expressions and value forms are evaluated before.
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        T::deserialize(deserializer).map(Self::Value)
    }
}

impl<T: JsonSchema> JsonSchema for Animatable<T> {
    fn inline_schema() -> bool {
        T::inline_schema()
    }

    fn schema_name() -> Cow<'static, str> {
        T::schema_name()
    }

    fn schema_id() -> Cow<'static, str> {
        T::schema_id()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        T::json_schema(generator)
    }
}
