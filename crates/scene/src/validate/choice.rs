//! Checks of values with several forms: a color or the name of a texture, a material or its name.

use super::names::NamedFamily;
use super::rule::{Alternative, Rule};
use super::{MAX_WARNINGS, Plain, Validator, inline, wording};
use crate::document::{Node, Value as NodeValue};
use crate::path::PathRef;
use crate::report::Finding;
use juggler_math::Rgb;

impl Validator<'_> {
    pub(super) fn choice(&mut self, node: &Node, at: &PathRef<'_>, rule: &'static Rule) -> Option<Plain> {
        let alternative = match &node.value {
            NodeValue::String(text) => self.alternative_of_text(text, &rule.alternatives),
            _ => rule.alternatives.iter().find(|form| fits(node, &form.rule) && inline::suits(node, form)),
        };
        let Some(alternative) = alternative else {
            return self.mismatch(node, at, rule, &wording::allowed(self.schema, rule));
        };
        match &node.value {
            NodeValue::Array(channels) if alternative.owner == Some("Color") && channels.len() != 3 => {
                let message = format!("a color is [red, green, blue], this array has {} elements", channels.len());
                let help = Rule::color_with_alpha(node);
                return self.report(node, at, Finding::error(message).maybe_help(help));
            }
            NodeValue::Array(channels) if alternative.owner == Some("Color") => self.check_range(node, at, channels),
            NodeValue::String(text) if alternative.rule.types.string => match alternative.owner {
                Some(owner) if wording::names_textures(owner) => {
                    self.check_reference(NamedFamily::Texture, node, text, at, rule);
                }
                Some("MaterialRef") => self.check_reference(NamedFamily::Material, node, text, at, rule),
                _ => {}
            },
            _ => {}
        }
        if inline::is_texture(alternative) {
            self.texture(node, at, alternative)
        } else {
            self.value(node, at, alternative.rule.get())
        }
    }
}

impl Validator<'_> {
    /// Chooses the form of a string: a color if it is one or begins with `#`, unless a texture has the
    /// name of the color; else a name, else a kind, else any form that allows strings.
    fn alternative_of_text<'w>(&self, text: &str, alternatives: &'w [Alternative]) -> Option<&'w Alternative> {
        let is_text = |alternative: &&Alternative| alternative.rule.types.string && !alternative.rule.is_color;
        let color = alternatives.iter().find(|alternative| alternative.rule.is_color);
        let is_color = text.starts_with('#') || Rgb::from_css(text).is_some() && !self.has_texture(text);
        color
            .filter(|_| is_color)
            .or_else(|| alternatives.iter().find(is_text))
            .or_else(|| alternatives.iter().find(|alternative| alternative.rule.is_family()))
            .or(color)
    }

    /// Warns if a color looks like 8-bit levels from 0 to 255.
    fn check_range(&mut self, node: &Node, at: &PathRef<'_>, channels: &[Node]) {
        let key = at.last_key().unwrap_or_default();
        let Some(levels) = levels(channels).filter(|levels| levels.iter().any(|level| *level >= least_level(key)))
        else {
            return;
        };
        if self.warnings.len() < MAX_WARNINGS {
            let [r, g, b] = levels;
            let message =
                format!("[{r}, {g}, {b}] is very bright: colors are linear, and reflectances are between 0 and 1");
            let help = format!("did you mean \"#{r:02x}{g:02x}{b:02x}\"?");
            self.warnings.push(Finding::warning(message).help(help).at(at).on(node.place));
        }
    }
}

/// Reads three integers from 0 to 255.
fn levels(channels: &[Node]) -> Option<[u8; 3]> {
    let level = |node: &Node| match &node.value {
        NodeValue::Number(number) => number.as_u64().and_then(|level| u8::try_from(level).ok()),
        _ => None,
    };
    let [r, g, b] = channels else { return None };
    Some([level(r)?, level(g)?, level(b)?])
}

/// Smallest level that causes a warning for a color of this key. Emitted light may exceed 1, unlike
/// reflectances.
fn least_level(key: &str) -> u8 {
    match key {
        "radiance" | "emission" | "emissive" | "scattering" | "absorption" | "eta" | "k" => u8::MAX,
        "color" | "background" | "horizon" | "zenith" | "nadir" | "top" | "bottom" => 100,
        _ => 16,
    }
}

/// Whether a rule allows the JSON type of a value that is not a string.
fn fits(node: &Node, rule: &Rule) -> bool {
    match &node.value {
        NodeValue::Null => rule.types.null,
        NodeValue::Bool(_) => rule.types.boolean,
        NodeValue::Number(_) => rule.allows_number(),
        NodeValue::Array(_) => rule.types.array,
        NodeValue::Object(_) => rule.types.object || !rule.kinds.is_empty(),
        NodeValue::String(_) | NodeValue::Invalid => false,
    }
}
