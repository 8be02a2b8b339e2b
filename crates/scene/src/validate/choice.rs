//! Values that may be written in several ways: a colour or the name of a texture, a material or its name.

use super::names::Family;
use super::scalar::is_hex_color;
use super::{Walk, words};
use crate::document::{Node, Value as Written};
use crate::path::Trail;
use crate::report::Finding;
use crate::schema::{Schema, variants};
use serde_json::Value;

/// One way to write a value.
#[derive(Clone, Copy)]
struct Branch {
    /// The definition that offers it.
    owner: Option<&'static str>,
    /// What may stand there: never itself a choice.
    schema: &'static Value,
}

impl Walk<'_> {
    pub(super) fn choice(
        &mut self,
        node: &Node,
        at: &Trail<'_>,
        name: Option<&'static str>,
        branches: &'static [Value],
    ) -> Option<Value> {
        let mut ways = Vec::new();
        flatten(self.schema, name, branches, &mut ways);
        let way = match &node.value {
            Written::String(text) => self.way_of_text(text, &ways),
            _ => ways.iter().find(|way| self.fits(node, way.schema)).copied(),
        };
        let Some(way) = way else {
            return self.mismatch(node, at, &words::choice(self.schema, name, branches));
        };
        if let (Written::Array(channels), Some("Color")) = (&node.value, way.owner)
            && channels.len() != 3
        {
            let found = channels.len();
            let finding = Finding::error(format!("a colour is [red, green, blue], this array has {found} elements"));
            return self.report(node, at, finding);
        }
        if let Written::String(text) = &node.value
            && words::allows(self.schema.follow(way.schema).1, "string")
        {
            match way.owner.map(words::family) {
                Some("Input") => self.refer(Family::Texture, node, text, at),
                Some("MaterialRef") => self.refer(Family::Material, node, text, at),
                _ => {}
            }
        }
        self.value(node, at, way.schema)
    }

    /// Whether a value of this JSON type may stand there.
    fn fits(&self, node: &Node, schema: &'static Value) -> bool {
        let target = self.schema.follow(schema).1;
        match &node.value {
            Written::Null => words::allows(target, "null"),
            Written::Bool(_) => words::allows(target, "boolean"),
            Written::Number(_) => words::allows_number(target),
            Written::Array(_) => words::allows(target, "array"),
            Written::Object(_) => words::allows(target, "object") || self.schema.kinds(target).next().is_some(),
            Written::String(_) => false,
        }
    }

    /// A text is a colour when it begins with `#`, else a name, else a kind by its name, else whatever allows texts.
    fn way_of_text(&self, text: &str, ways: &[Branch]) -> Option<Branch> {
        let is_color = |way: &&Branch| way.schema.get("pattern").is_some();
        let is_text = |way: &&Branch| words::allows(self.schema.follow(way.schema).1, "string") && !is_color(way);
        let is_family = |way: &&Branch| variants(self.schema.follow(way.schema).1).next().is_some();
        let color = ways.iter().find(is_color);
        if is_hex_color(text) || text.starts_with('#') && color.is_some() {
            return color.or_else(|| ways.iter().find(is_text)).copied();
        }
        ways.iter().find(is_text).or_else(|| ways.iter().find(is_family)).or(color).copied()
    }
}

/// All ways to write a value, choices inside choices opened.
fn flatten(schema: &'static Schema, owner: Option<&'static str>, branches: &'static [Value], ways: &mut Vec<Branch>) {
    for branch in branches {
        let (name, target) = schema.follow(branch);
        match target.get("anyOf").and_then(Value::as_array) {
            Some(inner) => flatten(schema, name.or(owner), inner, ways),
            None => ways.push(Branch { owner, schema: branch }),
        }
    }
}
