//! Plain JSON that fits the schema; `serde` deserializes the types from it.
//!
//! A scene's plain JSON is written once and read once, so keys of the schema are not copied, and
//! members are neither hashed nor looked up. `serde_json::Value` took twice the time.

use serde::de::value::{MapAccessDeserializer, MapDeserializer, SeqDeserializer};
use serde::de::{Deserializer, Error as _, IntoDeserializer, Unexpected, Visitor};
use serde::forward_to_deserialize_any;
use serde_json::{Error, Number};
use std::borrow::Cow;

/// JSON value that fits the schema.
#[derive(Clone, Debug, PartialEq)]
pub enum Plain {
    /// `null`
    Null,
    /// `true` or `false`
    Bool(bool),
    /// Any number.
    Number(Number),
    /// Text.
    String(String),
    /// Values in order.
    Array(Vec<Self>),
    /// Members in order, each key once.
    Object(Vec<(Cow<'static, str>, Self)>),
}

impl Plain {
    /// Object with one member.
    pub fn member(key: impl Into<Cow<'static, str>>, value: Self) -> Self {
        Self::Object(vec![(key.into(), value)])
    }
}

impl From<Number> for Plain {
    fn from(number: Number) -> Self {
        Self::Number(number)
    }
}

impl From<String> for Plain {
    fn from(text: String) -> Self {
        Self::String(text)
    }
}

impl<'de> IntoDeserializer<'de, Error> for &'de Plain {
    type Deserializer = Self;

    fn into_deserializer(self) -> Self {
        self
    }
}

impl<'de> Deserializer<'de> for &'de Plain {
    type Error = Error;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self {
            Plain::Null => visitor.visit_unit(),
            Plain::Bool(value) => visitor.visit_bool(*value),
            Plain::Number(number) => number.deserialize_any(visitor),
            Plain::String(text) => visitor.visit_borrowed_str(text),
            Plain::Array(elements) => SeqDeserializer::new(elements.iter()).deserialize_any(visitor),
            Plain::Object(members) => {
                MapDeserializer::new(members.iter().map(|(key, value)| (&**key, value))).deserialize_any(visitor)
            }
        }
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self {
            Plain::Null => visitor.visit_none(),
            _ => visitor.visit_some(self),
        }
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(self, _: &'static str, visitor: V) -> Result<V::Value, Error> {
        visitor.visit_newtype_struct(self)
    }

    /// Deserializes a kind from its name, or from an object whose only key is the name.
    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        match self {
            Plain::String(text) => visitor.visit_enum(text.as_str().into_deserializer()),
            Plain::Object(members) => visitor.visit_enum(MapAccessDeserializer::new(MapDeserializer::new(
                members.iter().map(|(key, value)| (&**key, value)),
            ))),
            _ => Err(Error::invalid_type(Unexpected::Other("a value without a kind"), &"a kind")),
        }
    }

    fn deserialize_ignored_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        visitor.visit_unit()
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf
        unit unit_struct seq tuple tuple_struct map struct identifier
    }
}
