//! Hash of a file by its meaning: white space, the order of properties, escapes in strings and the
//! notation of numbers do not matter.
//!
//! The text is hashed while it is parsed, without a tree of its values. The properties of an object are
//! hashed one by one and sorted by their hashes.

use super::container::Container;
use super::limits::Limits;
use serde::de::{DeserializeSeed, Deserializer, Error, MapAccess, SeqAccess, Visitor};
use std::fmt;

/// BLAKE3 hash of a `.gltf` or `.glb`; a file that is not valid has the hash of its bytes.
pub fn digest(name: &str, bytes: &[u8], limits: &Limits) -> [u8; 32] {
    by_meaning(name, bytes, limits).unwrap_or_else(|| blake3::hash(bytes)).into()
}

fn by_meaning(name: &str, bytes: &[u8], limits: &Limits) -> Option<blake3::Hash> {
    let container = Container::parse(name, bytes, limits).ok()?;
    let mut hasher = blake3::Hasher::new();
    let mut json = serde_json::Deserializer::from_slice(bytes.get(container.json)?);
    Canonical(&mut hasher).deserialize(&mut json).ok()?;
    if let Some(binary) = container.binary {
        hasher.update(bytes.get(binary)?);
    }
    Some(hasher.finalize())
}

/// Feeds a JSON value to a hasher. Each value begins with a byte for its type, strings state their
/// lengths, and lists end, so that no two values have the same bytes.
struct Canonical<'h>(&'h mut blake3::Hasher);

impl Canonical<'_> {
    fn text(&mut self, text: &str) {
        self.0.update(b"\"").update(&(text.len() as u64).to_le_bytes()).update(text.as_bytes());
    }
}

impl<'de> DeserializeSeed<'de> for Canonical<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Canonical<'_> {
    type Value = ();

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("JSON")
    }

    fn visit_unit<E: Error>(self) -> Result<(), E> {
        self.0.update(b"0");
        Ok(())
    }

    fn visit_bool<E: Error>(self, value: bool) -> Result<(), E> {
        self.0.update(if value { b"t" } else { b"f" });
        Ok(())
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<(), E> {
        self.visit_f64(value as f64)
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<(), E> {
        self.visit_f64(value as f64)
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<(), E> {
        self.0.update(b"n").update(&value.to_le_bytes());
        Ok(())
    }

    fn visit_str<E: Error>(mut self, value: &str) -> Result<(), E> {
        self.text(value);
        Ok(())
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<(), A::Error> {
        self.0.update(b"[");
        while let Some(()) = list.next_element_seed(Canonical(self.0))? {}
        self.0.update(b"]");
        Ok(())
    }

    fn visit_map<A: MapAccess<'de>>(self, mut object: A) -> Result<(), A::Error> {
        let mut properties: Vec<[u8; 32]> = Vec::new();
        while let Some(key) = object.next_key::<String>()? {
            let mut hasher = blake3::Hasher::new();
            let mut property = Canonical(&mut hasher);
            property.text(&key);
            object.next_value_seed(property)?;
            properties.push(hasher.finalize().into());
        }
        properties.sort_unstable();
        self.0.update(b"{").update(&(properties.len() as u64).to_le_bytes()).update(properties.as_flattened());
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gltf::testing::glb;

    fn of(text: &str) -> [u8; 32] {
        digest("a.gltf", text.as_bytes(), &Limits::default())
    }

    #[test]
    fn the_notation_does_not_matter() {
        let plain = r#"{"asset":{"version":"2.0"},"a":[1,-2,0.5,{"b":null,"c":true}],"d":"é"}"#;
        let spread = "{ \"asset\" : { \"version\": \"2.0\" },\n\t\"a\": [1, -2, 0.5, {\"b\": null, \"c\": true}],\r\n \"d\": \"é\"}\n";
        let other = r#"{"d":"\u00e9","a":[1.0,-2e0,5e-1,{"c":true,"b":null}],"asset":{"version":"2.0"}}"#;
        assert_eq!(of(plain), of(spread));
        assert_eq!(of(plain), of(other));
        assert_eq!(of(plain), of(&format!("\u{feff}{plain}")), "a byte order mark");
    }

    #[test]
    fn every_value_matters() {
        let texts = [
            "{}",
            "[]",
            "[[]]",
            "[[],[]]",
            "[[[]]]",
            "[{}]",
            "0",
            "-1",
            "1",
            "1e300",
            "null",
            "true",
            "false",
            r#""""#,
            r#""1""#,
            r#"["a","b"]"#,
            r#"["ab"]"#,
            r#"["b","a"]"#,
            r#"[["a"],"b"]"#,
            r#"{"a":1}"#,
            r#"{"a":"1"}"#,
            r#"{"a":1,"b":2}"#,
            r#"{"a":2,"b":1}"#,
            r#"{"a":{"b":1}}"#,
            r#"{"a":[],"b":1}"#,
            "[1,2]",
            "[2,1]",
            "[12]",
        ];
        let mut hashes: Vec<[u8; 32]> = texts.iter().map(|text| of(text)).collect();
        hashes.sort_unstable();
        hashes.dedup();
        assert_eq!(hashes.len(), texts.len());
    }

    #[test]
    fn files_that_are_not_valid_have_the_hash_of_their_bytes() {
        for text in ["", "{", r#"{"a": }"#, "glTF", r#"{"a": 1e999}"#] {
            assert_eq!(of(text), <[u8; 32]>::from(blake3::hash(text.as_bytes())), "{text}");
        }
    }

    #[test]
    fn the_buffer_of_a_binary_file_matters() {
        let of = |json: &str, binary: &[u8]| digest("a.glb", &glb(json, binary), &Limits::default());
        let (spread, dense) = (r#"{"asset": {"version": "2.0"}}"#, r#"{"asset":{"version":"2.0"}}"#);
        assert_eq!(of(spread, b"1234"), of(dense, b"1234"));
        assert_ne!(of(spread, b"1234"), of(spread, b"1235"));
        assert_ne!(of(spread, b"1234"), of(spread, b""));
    }
}
