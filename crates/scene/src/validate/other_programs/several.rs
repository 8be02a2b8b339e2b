//! Examples from more than the value of one key: all steps of a transform that an object's keys
//! contain, and the kind that a value names.

use super::example::Written;
use super::{Entry, entries, has_field, kind_entry};
use crate::document::{Members, Node, Value};
use crate::validate::rule::{Rule, RuleId};

/// Keys of steps that are applied before all others, in this order.
const FIRST: [&str; 3] = ["{\"scale\"", "{\"rotate\"", "{\"orient\""];

impl Entry {
    /// Example for an unknown key of an object; `None` if this entry has all there is.
    pub fn whole_example(&self, rule: &'static Rule, owners: &[String], written: Written<'_>) -> Option<String> {
        match self.target.as_slice() {
            ["object", "transform"] => steps(rule, owners, written.siblings?),
            [_, field] => kind(field, rule, written.value),
            _ => None,
        }
    }
}

/// All steps of a transform that the keys of an object contain, if there are several.
fn steps(rule: &Rule, owners: &[String], members: &Members) -> Option<String> {
    let step = |key: &str, node: &Node| {
        let is_step = |entry: &&Entry| entry.target == ["object", "transform"];
        let is_here = |entry: &&Entry| entry.owners.iter().any(|own| owners.iter().any(|owner| owner == own));
        let entry = entries(false, key).filter(|_| !has_field(rule, key)).filter(is_step).find(is_here)?;
        let text = entry.advice(Some(Written { value: node, siblings: Some(members) }));
        text.strip_prefix("\"transform\": ").filter(|step| step.starts_with('{')).map(str::to_owned)
    };
    let mut steps: Vec<String> = members.iter().filter_map(|(key, member)| step(key, &member.node)).collect();
    steps.sort_by_key(|step| FIRST.iter().position(|first| step.starts_with(first)).unwrap_or(FIRST.len()));
    (steps.len() > 1).then(|| format!("\"transform\": [{}]", steps.join(", ")))
}

/// The key `field` with the kind here that a value names: `"BoxGeometry"`,
/// `{"type": "BoxGeometry", ...}` or `{"BoxGeometry": {...}}`.
fn kind(field: &str, rule: &'static Rule, value: &Node) -> Option<String> {
    let rule = rule.field(field).map(RuleId::get)?;
    let families = std::iter::once(rule).chain(rule.alternatives.iter().map(|form| form.rule.get()));
    let (word, inside) = match &value.value {
        Value::String(text) => (text.as_str(), None),
        Value::Object(members) => match members.get("type") {
            Some(tag) => (tag.node.as_str()?, None),
            None if members.len() == 1 => {
                members.iter().next().map(|(key, member)| (key.as_str(), Some(&member.node)))?
            }
            None => return None,
        },
        _ => return None,
    };
    let mut kinds = families.filter_map(|family| kind_entry(word, family));
    let kind = kinds.find(|kind| kind.target.len() == 2 && kind.is_kind)?;
    let inside = inside.map(|value| kind.advice(Some(Written { value, siblings: None })));
    Some(format!("\"{field}\": {}", inside.unwrap_or_else(|| kind.example.form())))
}
