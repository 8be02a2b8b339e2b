//! Checks of numbers and strings.

use super::names::NamedFamily;
use super::rule::{MAX_U64, Rule};
use super::{Plain, Validator};
use crate::document::Node;
use crate::path::PathRef;
use crate::report::Finding;
use crate::suggest::{closest, did_you_mean};
use juggler_math::Rgb;
use juggler_math::color::{color_names, hex_of_name};
use serde_json::{Number, Value};

/// How a color is written.
const COLOR_HELP: &str =
    "a color is written [r, g, b], or \"#rrggbb\" with six digits 0-9 or a-f, or \"#rgb\", or as a name of CSS";

impl Validator<'_> {
    pub(super) fn number(
        &mut self,
        node: &Node,
        at: &PathRef<'_>,
        number: &Number,
        rule: &'static Rule,
    ) -> Option<Plain> {
        let written = number.as_f64().unwrap_or(f64::NAN);
        let whole = !rule.types.number;
        if whole && written != written.trunc() {
            return self.wrong_number(node, at, "a whole number", number);
        }
        // Check limits against the number as it is used: 1e-60 is 0 in 32 bits.
        let value = if rule.numbers.single { f64::from(written as f32) } else { written };
        // Integers up to 2^64 - 1 are kept exactly; as a double the largest of them would be 2^64.
        let value = if whole && number.is_u64() { value.min(MAX_U64) } else { value };
        if !value.is_finite() {
            return self.wrong_number(node, at, "between -3.4e38 and 3.4e38", number);
        }
        if matches!(at, PathRef::Key(PathRef::Root, "version")) && value != 1.0 {
            let message = format!("unsupported version {number} of the scene format: this program reads version 1");
            self.report::<()>(node, at, Finding::error(message));
            // Continue with version 1, since the rest may be valid.
            return Some(Plain::Number(1.into()));
        }
        if let Some(bound) = rule.numbers.violated_limit(value) {
            if value == 0.0 && written != 0.0 {
                let message = format!("`{number}` is too small: it rounds to 0 in 32 bits");
                return self.report(node, at, Finding::error(message).help(format!("it must be {bound}")));
            }
            return self.wrong_number(node, at, &bound, number);
        }
        if whole && number.is_f64() {
            let number = if value < 0.0 { (value as i64).into() } else { (value as u64).into() };
            return Some(Plain::Number(number));
        }
        Some(Plain::Number(number.clone()))
    }

    fn wrong_number(&mut self, node: &Node, at: &PathRef<'_>, expected: &str, number: &Number) -> Option<Plain> {
        let subject = match (at, at.last_key()) {
            (PathRef::Key(..), Some(key)) => format!("`{key}`"),
            (_, Some(key)) => format!("each number of `{key}`"),
            (_, None) => "the number".into(),
        };
        let mut shown = Value::Number(number.clone());
        crate::schema::shorten_numbers(&mut shown);
        self.report(node, at, Finding::error(format!("{subject} must be {expected}, is {shown}")))
    }

    pub(super) fn string(&mut self, node: &Node, at: &PathRef<'_>, text: &str, rule: &'static Rule) -> Option<Plain> {
        let family = match rule.name {
            Some("GroupName") => Some(NamedFamily::Group),
            Some("CameraName") => Some(NamedFamily::Camera),
            _ => None,
        };
        if let Some(family) = family {
            self.check_reference(family, node, text, at, rule);
        }
        if rule.is_color && Rgb::from_css(text).is_none() {
            let near = || closest(text, color_names()).map(did_you_mean).filter(|_| !text.starts_with('#'));
            let alpha = || Rule::color_with_alpha(node);
            let help = self.suggestion(|| near().or_else(alpha)).unwrap_or_else(|| COLOR_HELP.to_owned());
            return self.report(node, at, Finding::error(format!("`{text}` is not a color")).help(help));
        }
        // Where textures are allowed, any other text names a texture.
        if let Some(hex) = hex_of_name(text).filter(|_| rule.is_color) {
            return Some(Plain::String(hex));
        }
        Some(Plain::String(text.to_owned()))
    }
}
