//! Integers of a document. As in JSON Schema, a number such as `3.0` is an integer.

use serde::de::{Deserialize, Deserializer, Error, Unexpected, Visitor};
use std::fmt;

/// Largest integer that every JSON reader keeps exactly: 2^53.
const MAX_EXACT: f64 = 9_007_199_254_740_992.0;

/// Index into an array of the document, or another count of 32 bits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Index(u32);

impl Index {
    /// The index as a position in a slice.
    pub fn get(self) -> usize {
        self.0 as usize
    }
}

impl From<u32> for Index {
    fn from(index: u32) -> Self {
        Self(index)
    }
}

impl fmt::Display for Index {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}", self.0)
    }
}

impl<'de> Deserialize<'de> for Index {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer
            .deserialize_u64(Integer { max: u64::from(u32::MAX), expected: "an integer from 0 to 4294967295" })
            .map(
                // The visitor has checked the range.
                |value| Self(u32::try_from(value).unwrap_or(u32::MAX)),
            )
    }
}

/// Length, offset or count of 64 bits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Size(u64);

impl Size {
    /// The value.
    pub fn get(self) -> u64 {
        self.0
    }
}

impl From<u64> for Size {
    fn from(size: u64) -> Self {
        Self(size)
    }
}

impl fmt::Display for Size {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}", self.0)
    }
}

impl<'de> Deserialize<'de> for Size {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_u64(Integer { max: u64::MAX, expected: "an integer of at least 0" }).map(Self)
    }
}

/// Reads an integer from 0 to `max`.
struct Integer {
    max: u64,
    expected: &'static str,
}

impl Visitor<'_> for Integer {
    type Value = u64;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.expected)
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<u64, E> {
        if value <= self.max { Ok(value) } else { Err(E::invalid_value(Unexpected::Unsigned(value), &self)) }
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<u64, E> {
        match u64::try_from(value) {
            Ok(value) => self.visit_u64(value),
            Err(_) => Err(E::invalid_value(Unexpected::Signed(value), &self)),
        }
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<u64, E> {
        if value.fract() == 0.0 && (0.0..=MAX_EXACT).contains(&value) {
            return self.visit_u64(value as u64);
        }
        Err(E::invalid_value(Unexpected::Float(value), &self))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integral_numbers_are_integers() {
        let index = |text: &str| serde_json::from_str::<Index>(text).map(Index::get).map_err(|error| error.to_string());
        assert_eq!([index("7"), index("7.0"), index("7e0"), index("4294967295")], [7, 7, 7, 4_294_967_295].map(Ok));
        assert_eq!(
            index("-1").unwrap_err(),
            "invalid value: integer `-1`, expected an integer from 0 to 4294967295 at line 1 column 2"
        );
        for text in ["7.5", "4294967296", "\"7\"", "1e300", "-0.5", "null", "true"] {
            assert!(index(text).is_err(), "{text}");
        }
        let size = |text: &str| serde_json::from_str::<Size>(text).map(Size::get).ok();
        assert_eq!(size("18446744073709551615"), Some(u64::MAX));
        assert_eq!(size("18446744073709551616"), None);
        assert_eq!(size("9007199254740992.0"), Some(1 << 53));
    }
}
