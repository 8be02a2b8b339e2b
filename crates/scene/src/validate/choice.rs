//! Values that may be written in several ways: a colour or the name of a texture, a material or its name.

use super::names::Family;
use super::rule::{Rule, Way};
use super::{Walk, inline, words};
use crate::document::{Node, Value as Written};
use crate::path::Trail;
use crate::report::Finding;
use juggler_math::Rgb;
use serde_json::Value;

impl Walk<'_> {
    pub(super) fn choice(&mut self, node: &Node, at: &Trail<'_>, rule: &'static Rule) -> Option<Value> {
        let way = match &node.value {
            Written::String(text) => way_of_text(text, &rule.ways),
            _ => rule.ways.iter().find(|way| fits(node, &way.rule)),
        };
        let Some(way) = way else {
            return self.mismatch(node, at, &words::allowed(self.schema, rule));
        };
        match &node.value {
            Written::Array(channels) if way.owner == Some("Color") && channels.len() != 3 => {
                let message = format!("a colour is [red, green, blue], this array has {} elements", channels.len());
                return self.report(node, at, Finding::error(message));
            }
            Written::String(text) if way.rule.types.string => match way.owner.map(words::family) {
                Some("Input") => self.refer(Family::Texture, node, text, at),
                Some("MaterialRef") => self.refer(Family::Material, node, text, at),
                _ => {}
            },
            _ => {}
        }
        if inline::is_texture(way) { self.texture(node, at, way) } else { self.value(node, at, way.rule.get()) }
    }
}

/// Whether a value of this JSON type may stand there.
fn fits(node: &Node, rule: &Rule) -> bool {
    match &node.value {
        Written::Null => rule.types.null,
        Written::Bool(_) => rule.types.boolean,
        Written::Number(_) => rule.allows_number(),
        Written::Array(_) => rule.types.array,
        Written::Object(_) => rule.types.object || !rule.kinds.is_empty(),
        Written::String(_) | Written::Wrong => false,
    }
}

/// A text is a colour when it begins with `#`, else a name, else a kind by its name, else whatever allows texts.
fn way_of_text<'w>(text: &str, ways: &'w [Way]) -> Option<&'w Way> {
    let is_text = |way: &&Way| way.rule.types.string && !way.rule.color;
    let color = ways.iter().find(|way| way.rule.color);
    if Rgb::from_hex(text).is_some() || text.starts_with('#') && color.is_some() {
        return color.or_else(|| ways.iter().find(is_text));
    }
    ways.iter().find(is_text).or_else(|| ways.iter().find(|way| way.rule.is_family())).or(color)
}
