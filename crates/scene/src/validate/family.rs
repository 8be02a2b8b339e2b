//! Families: `{"sphere": {...}}`, or `"sphere"` where all fields have defaults; and lists of fixed words.

use super::rule::Rule;
use super::{Walk, words};
use crate::document::{Members, Node, Value as Written};
use crate::path::Trail;
use crate::report::Finding;
use crate::suggest::meant_or_all;
use serde_json::Value;

impl Walk<'_> {
    pub(super) fn family(&mut self, node: &Node, at: &Trail<'_>, family: &'static Rule) -> Option<Value> {
        match &node.value {
            Written::Object(members) if !family.kinds.is_empty() => self.kind(node, at, members, family),
            Written::String(text) => self.word(node, at, text, family),
            _ => {
                let noun = noun(family);
                let example = family.kinds.first().map(|(kind, _)| format!(" such as {{\"{kind}\": ...}}"));
                let words = || format!(": {}", words::list(family.words.iter().copied(), "or"));
                let example = example.unwrap_or_else(words);
                self.mismatch(node, at, &format!("{} {noun}{example}", words::article(&noun)))
            }
        }
    }

    fn kind(&mut self, node: &Node, at: &Trail<'_>, members: &Members, family: &'static Rule) -> Option<Value> {
        let mut entries = members.iter();
        let (Some((key, member)), None) = (entries.next(), entries.next()) else {
            return self.not_one_kind(node, at, members, family);
        };
        let Some((_, content)) = family.kinds.iter().find(|(kind, _)| kind == key) else {
            let finding = Finding::error(format!("unknown kind of {} `{key}`", noun(family))).on(member.key_place);
            self.findings.push(finding.maybe_help(meant_or_all(key, kinds(family))).at(&at.key(key)));
            return None;
        };
        let value = self.value(&member.node, &at.key(key), content.get())?;
        Some(Value::Object([(key.clone(), value)].into_iter().collect()))
    }

    /// Complains of no key or several where the name of one kind should stand.
    fn not_one_kind<T>(&mut self, node: &Node, at: &Trail<'_>, members: &Members, family: &'static Rule) -> Option<T> {
        let (noun, kinds) = (noun(family), kinds(family).collect::<Vec<_>>());
        let mut named = members.keys().filter(|key| kinds.contains(&key.as_str()));
        let a = words::article(&noun);
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
    fn word(&mut self, node: &Node, at: &Trail<'_>, text: &str, family: &'static Rule) -> Option<Value> {
        if family.words.contains(&text) {
            return Some(text.into());
        }
        match family.kinds.iter().find(|(kind, _)| *kind == text) {
            Some((kind, content)) if content.types.object && content.required.is_empty() => {
                Some(Value::Object([((*kind).to_owned(), Value::Object(Default::default()))].into_iter().collect()))
            }
            Some((kind, content)) => {
                let needed = words::list(content.required.iter().copied(), "and");
                let needed = if needed.is_empty() { "a value" } else { &needed };
                let message = format!("the {} `{kind}` needs {needed}", noun(family));
                self.report(node, at, Finding::error(message).help(format!("write {{\"{kind}\": {{...}}}}")))
            }
            None => {
                let known: Vec<&str> = kinds(family).chain(family.words.iter().copied()).collect();
                let what = if family.words.is_empty() { "kind of " } else { "" };
                let finding = Finding::error(format!("unknown {what}{} `{text}`", noun(family)));
                self.report(node, at, finding.maybe_help(meant_or_all(text, known.iter().copied())))
            }
        }
    }
}

fn noun(family: &Rule) -> String {
    words::noun(family.name.unwrap_or("kind"))
}

fn kinds(family: &Rule) -> impl Iterator<Item = &'static str> + Clone {
    family.kinds.iter().map(|(kind, _)| *kind)
}
