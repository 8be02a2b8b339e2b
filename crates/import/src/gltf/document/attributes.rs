//! Attributes of primitives: semantics and the accessors of their values (glTF 2.0, section
//! 3.7.2.1).

use super::number::Index;
use serde::de::{Deserialize, Deserializer, Error, MapAccess, Visitor};
use std::fmt;

/// Meaning of an attribute.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Semantic {
    /// Position in object space.
    Position,
    /// Normal.
    Normal,
    /// Tangent and the sign of the bitangent.
    Tangent,
    /// Set of texture coordinates.
    TexCoord(u32),
    /// Set of colors.
    Color(u32),
    /// Set of joint indices.
    Joints(u32),
    /// Set of joint weights.
    Weights(u32),
    /// Another name. Names of applications begin with `_`.
    Other(String),
}

impl Semantic {
    /// Semantic of this name.
    pub fn from_name(name: &str) -> Self {
        match name {
            "POSITION" => return Self::Position,
            "NORMAL" => return Self::Normal,
            "TANGENT" => return Self::Tangent,
            _ => {}
        }
        let set = name.rsplit_once('_').and_then(|(kind, digits)| Some((kind, set_number(digits)?)));
        match set {
            Some(("TEXCOORD", set)) => Self::TexCoord(set),
            Some(("COLOR", set)) => Self::Color(set),
            Some(("JOINTS", set)) => Self::Joints(set),
            Some(("WEIGHTS", set)) => Self::Weights(set),
            _ => Self::Other(name.to_owned()),
        }
    }
}

/// Number of a set: digits without leading zeros.
fn set_number(digits: &str) -> Option<u32> {
    let is_plain = digits.bytes().all(|byte| byte.is_ascii_digit()) && (digits == "0" || !digits.starts_with('0'));
    if is_plain { digits.parse().ok() } else { None }
}

impl fmt::Display for Semantic {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Position => formatter.write_str("POSITION"),
            Self::Normal => formatter.write_str("NORMAL"),
            Self::Tangent => formatter.write_str("TANGENT"),
            Self::TexCoord(set) => write!(formatter, "TEXCOORD_{set}"),
            Self::Color(set) => write!(formatter, "COLOR_{set}"),
            Self::Joints(set) => write!(formatter, "JOINTS_{set}"),
            Self::Weights(set) => write!(formatter, "WEIGHTS_{set}"),
            Self::Other(name) => formatter.write_str(name),
        }
    }
}

/// Attributes with an index each, in the order of their semantics.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Attributes(Vec<(Semantic, Index)>);

impl Attributes {
    /// Index of an attribute.
    pub fn find(&self, semantic: &Semantic) -> Option<Index> {
        let position = self.0.binary_search_by(|(known, _)| known.cmp(semantic)).ok()?;
        self.0.get(position).map(|(_, index)| *index)
    }

    /// All attributes.
    pub fn iter(&self) -> impl Iterator<Item = (&Semantic, Index)> {
        self.0.iter().map(|(semantic, index)| (semantic, *index))
    }

    /// Whether there are no attributes.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

impl<'de> Deserialize<'de> for Attributes {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(AttributesVisitor)
    }
}

struct AttributesVisitor;

impl<'de> Visitor<'de> for AttributesVisitor {
    type Value = Attributes;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("an object of attributes and indices")
    }

    fn visit_map<M: MapAccess<'de>>(self, mut map: M) -> Result<Attributes, M::Error> {
        let mut attributes = Vec::new();
        while let Some((name, index)) = map.next_entry::<String, Index>()? {
            attributes.push((Semantic::from_name(&name), index));
        }
        attributes.sort();
        match attributes.windows(2).find(|pair| matches!(pair, [(a, _), (b, _)] if a == b)) {
            Some([(name, _), ..]) => Err(M::Error::custom(format!("duplicate attribute `{name}`"))),
            _ => Ok(Attributes(attributes)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn semantics_have_names() {
        for name in ["POSITION", "NORMAL", "TANGENT", "TEXCOORD_0", "COLOR_12", "JOINTS_1", "WEIGHTS_3"] {
            let semantic = Semantic::from_name(name);
            assert!(!matches!(semantic, Semantic::Other(_)) && semantic.to_string() == name, "{name}");
        }
        for name in ["TEXCOORD", "TEXCOORD_", "TEXCOORD_01", "COLOR_-1", "_A", "FOO_0", "TEXCOORD_99999999999"] {
            assert_eq!(Semantic::from_name(name), Semantic::Other(name.to_owned()));
        }
    }

    #[test]
    fn attributes_are_found_and_unique() {
        let attributes: Attributes = serde_json::from_str(r#"{"_X": 4, "TEXCOORD_1": 3, "POSITION": 7}"#).unwrap();
        assert_eq!(attributes.find(&Semantic::Position), Some(7.into()));
        assert_eq!(attributes.find(&Semantic::TexCoord(1)), Some(3.into()));
        assert_eq!(attributes.find(&Semantic::TexCoord(0)), None);
        let error = serde_json::from_str::<Attributes>(r#"{"A": 1, "B": 2, "A": 3}"#).unwrap_err().to_string();
        assert!(error.starts_with("duplicate attribute `A`"), "{error}");
    }
}
