//! JSON form of a color: linear `[r, g, b]`, sRGB `"#rrggbb"`, a name of CSS, or one number for a gray.

use super::Rgb;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::de::{Error, IgnoredAny, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::borrow::Cow;
use std::fmt;

/// A color: linear `[red, green, blue]`, one linear number for a gray, or sRGB as `"#rrggbb"` or as a
/// name of CSS such as `"tomato"`.
#[derive(JsonSchema)]
#[serde(untagged)]
#[schemars(rename = "Color")]
#[allow(dead_code, reason = "only its schema is used")]
enum ColorForm {
    /// Linear red, green and blue: 0 to 1 for reflectances, 0 to 1e30 for light.
    Channels([f32; 3]),
    /// Linear value of all three channels.
    Gray(f32),
    /// sRGB as `#rrggbb`, as `#rgb` with each digit doubled, or as a name of CSS.
    Css(#[schemars(regex(pattern = r"^(#([0-9a-fA-F]{3}|[0-9a-fA-F]{6})|[a-zA-Z]+)$"))] String),
}

impl Serialize for Rgb {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.to_array().serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Rgb {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(Reader)
    }
}

impl JsonSchema for Rgb {
    fn schema_name() -> Cow<'static, str> {
        "Color".into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        ColorForm::json_schema(generator)
    }
}

struct Reader;

impl<'de> Visitor<'de> for Reader {
    type Value = Rgb;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a color: linear [r, g, b], sRGB \"#rrggbb\" or a name of CSS, or one number for a gray")
    }

    fn visit_f64<E: Error>(self, v: f64) -> Result<Rgb, E> {
        Ok(Rgb::splat(v as f32))
    }

    fn visit_i64<E: Error>(self, v: i64) -> Result<Rgb, E> {
        Ok(Rgb::splat(v as f32))
    }

    fn visit_u64<E: Error>(self, v: u64) -> Result<Rgb, E> {
        Ok(Rgb::splat(v as f32))
    }

    fn visit_str<E: Error>(self, v: &str) -> Result<Rgb, E> {
        // Names of CSS are replaced before: another text may be the name of a texture.
        Rgb::from_hex(v).ok_or_else(|| E::custom(format!("`{v}` is not a color; write `#rrggbb`")))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut values: A) -> Result<Rgb, A::Error> {
        let mut channels = [0f32; 3];
        for (i, channel) in channels.iter_mut().enumerate() {
            *channel = values.next_element()?.ok_or_else(|| A::Error::invalid_length(i, &self))?;
        }
        match values.next_element::<IgnoredAny>()? {
            None => Ok(channels.into()),
            Some(_) => Err(A::Error::invalid_length(4, &self)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Rgb, String> {
        serde_json::from_str(text).map_err(|e| e.to_string())
    }

    #[test]
    fn colors_are_read_from_arrays_numbers_and_hexadecimal_strings() {
        assert_eq!(read("[0.1, 2, 3e1]"), Ok(Rgb::new(0.1, 2.0, 30.0)));
        assert_eq!(read("0.5"), Ok(Rgb::splat(0.5)));
        assert_eq!(read("1"), Ok(Rgb::WHITE));
        assert_eq!(read("-1"), Ok(Rgb::splat(-1.0)));
        assert_eq!(read("\"#ff0000\""), Ok(Rgb::new(1.0, 0.0, 0.0)));
        assert_eq!(read("\"#f00\""), Ok(Rgb::new(1.0, 0.0, 0.0)));
    }

    #[test]
    fn json_round_trips() {
        let mut random = crate::testing::Random::new(41);
        for _ in 0..1000 {
            let color = random.rgb() * random.range(0.0, 1e6);
            assert_eq!(read(&serde_json::to_string(&color).unwrap()), Ok(color));
        }
    }

    #[test]
    fn color_errors_state_the_valid_forms() {
        for wrong in ["true", "{}", "[1, 2]", "[1, 2, 3, 4]"] {
            assert!(read(wrong).unwrap_err().contains("linear [r, g, b]"), "{wrong}");
        }
        assert!(read("\"red\"").unwrap_err().contains("`red` is not a color"));
        assert!(read("[1, \"a\", 2]").unwrap_err().contains("f32"));
    }
}
