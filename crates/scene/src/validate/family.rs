//! Families: `{"sphere": {...}}`, or `"sphere"` where all fields have defaults; and lists of fixed words.

use super::{Walk, words};
use crate::document::{Members, Node, Value as Written};
use crate::path::Trail;
use crate::report::Finding;
use crate::schema::variants;
use crate::suggest::meant_or_all;
use serde_json::Value;

impl Walk<'_> {
    pub(super) fn family(&mut self, node: &Node, at: &Trail<'_>, name: &str, family: &'static Value) -> Option<Value> {
        let noun = words::noun(name);
        match &node.value {
            Written::Object(members) if self.schema.kinds(family).next().is_some() => {
                self.kind(node, at, members, &noun, family)
            }
            Written::String(text) => self.word(node, at, text, &noun, family),
            _ => {
                let example = self.schema.kinds(family).next().map(|(kind, _)| format!(" such as {{\"{kind}\": ...}}"));
                let example = example.unwrap_or_else(|| format!(": {}", words::list(fixed_words(family), "or")));
                self.mismatch(node, at, &format!("{} {noun}{example}", words::article(&noun)))
            }
        }
    }

    fn kind(
        &mut self,
        node: &Node,
        at: &Trail<'_>,
        members: &Members,
        noun: &str,
        family: &'static Value,
    ) -> Option<Value> {
        let mut entries = members.iter();
        let (Some((key, member)), None) = (entries.next(), entries.next()) else {
            return self.not_one_kind(node, at, members, noun, family);
        };
        let Some((_, content)) = self.schema.kinds(family).find(|(kind, _)| kind == key) else {
            let kinds: Vec<&str> = self.schema.kinds(family).map(|(kind, _)| kind).collect();
            let finding = Finding::error(format!("unknown kind of {noun} `{key}`"));
            let finding = finding.maybe_help(meant_or_all(key, kinds.iter().copied())).on(member.key_place);
            self.findings.push(finding.at(&at.key(key)));
            return None;
        };
        let value = self.value(&member.node, &at.key(key), content)?;
        Some(Value::Object([(key.clone(), value)].into_iter().collect()))
    }

    /// Complains of no key or several where the name of one kind should stand.
    fn not_one_kind<T>(
        &mut self,
        node: &Node,
        at: &Trail<'_>,
        members: &Members,
        noun: &str,
        family: &'static Value,
    ) -> Option<T> {
        let kinds: Vec<&str> = self.schema.kinds(family).map(|(kind, _)| kind).collect();
        let mut named = members.keys().filter(|key| kinds.contains(&key.as_str()));
        let a = words::article(noun);
        if let (Some(kind), None) = (named.next(), named.next()) {
            let others = words::list(members.keys().filter(|key| *key != kind).map(String::as_str), "and");
            let message = format!("{others} cannot stand beside `{kind}`: {a} {noun} is of exactly one kind");
            let help = format!("settings of the {noun} belong inside {{\"{kind}\": {{...}}}}, others outside of it");
            return self.report(node, at, Finding::error(message).help(help));
        }
        let found =
            if members.is_empty() { "none".into() } else { words::list(members.keys().map(String::as_str), "and") };
        let message = format!("{a} {noun} is of exactly one kind, found {found}");
        let tagged = members.get("type").and_then(|tag| tag.node.as_str()).filter(|tag| kinds.contains(tag));
        let help = tagged.map(|kind| format!("write {{\"{kind}\": {{...}}}} instead of \"type\": \"{kind}\""));
        let several = members.len() > 1 && members.keys().all(|key| kinds.contains(&key.as_str()));
        let other = || if several { "choose one".into() } else { format!("kinds: {}", words::list(kinds, "and")) };
        let help = help.unwrap_or_else(other);
        self.report(node, at, Finding::error(message).help(help))
    }

    /// A kind by its name alone, or one of a list of words.
    fn word(&mut self, node: &Node, at: &Trail<'_>, text: &str, noun: &str, family: &'static Value) -> Option<Value> {
        if fixed_words(family).any(|word| word == text) {
            return Some(text.into());
        }
        match self.schema.kinds(family).find(|(kind, _)| *kind == text) {
            Some((kind, content)) if self.schema.is_all_default(content) => {
                Some(Value::Object([(kind.to_owned(), Value::Object(Default::default()))].into_iter().collect()))
            }
            Some((kind, content)) => {
                let required = self.schema.follow(content).1.get("required").and_then(Value::as_array);
                let required = required.into_iter().flatten().filter_map(Value::as_str);
                let message = format!("the {noun} `{kind}` needs {}", words::list(required, "and"));
                self.report(node, at, Finding::error(message).help(format!("write {{\"{kind}\": {{...}}}}")))
            }
            None => {
                let kinds = self.schema.kinds(family).map(|(kind, _)| kind);
                let known: Vec<&str> = kinds.chain(fixed_words(family)).collect();
                let what = if fixed_words(family).next().is_some() { "" } else { "kind of " };
                let finding = Finding::error(format!("unknown {what}{noun} `{text}`"));
                self.report(node, at, finding.maybe_help(meant_or_all(text, known.iter().copied())))
            }
        }
    }
}

/// The words of an enum without contents.
fn fixed_words(family: &Value) -> impl Iterator<Item = &str> {
    variants(family).flat_map(|variant| {
        let one = variant.get("const").and_then(Value::as_str);
        let several = variant.get("enum").and_then(Value::as_array).into_iter().flatten().filter_map(Value::as_str);
        one.into_iter().chain(several)
    })
}
